//! Inputs that are wrong in many ways, out of a corpus: the usual mutations of a fuzzer.

use std::hash::{BuildHasher, BuildHasherDefault, DefaultHasher};

/// The longest input.
const LONGEST: usize = 1 << 16;

/// Words that readers look for; those of the corpus are taken from its files.
const WORDS: [&[u8]; 16] = [
    b"\0\0\0\0",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"\xff\xff\xff\x7f",
    b"\0\0\0\x80",
    b"NaN",
    b"inf",
    b"1e999",
    b"-1",
    b"18446744073709551616",
    b"0x",
    b"[[[[[[[[",
    b"{\"",
    b",",
    b"\n",
    b"\xf0\x9f\x98\x80",
];

/// A source of wrong inputs, the same for the same corpus.
pub struct Mutator<'a> {
    corpus: &'a [Vec<u8>],
    state: u64,
}

impl<'a> Mutator<'a> {
    /// One for a corpus that is not empty.
    pub fn new(corpus: &'a [Vec<u8>], seed: &str) -> Self {
        let hasher = BuildHasherDefault::<DefaultHasher>::default();
        Mutator { corpus, state: hasher.hash_one(seed) | 1 }
    }

    /// The next input: a file of the corpus with one to eight mutations.
    pub fn next(&mut self) -> Vec<u8> {
        let mut input = self.file().to_vec();
        for _ in 0..1 + self.below(8) {
            self.mutate(&mut input);
        }
        input.truncate(LONGEST);
        input
    }

    fn mutate(&mut self, input: &mut Vec<u8>) {
        let at = self.place(input.len());
        let length = 1 + self.below(16.min(input.len() - at + 1));
        let range = at..(at + length).min(input.len());
        match self.below(10) {
            // A bit, a byte, a step of a number.
            0 => self.change(input, at, |byte, by| byte ^ 1 << (by % 8)),
            1 => self.change(input, at, |_, by| by),
            2 => self.change(input, at, |byte, by| byte.wrapping_add(by % 9).wrapping_sub(4)),
            // A word over what is there, or between.
            3 => {
                let word = WORDS[self.below(WORDS.len())];
                let end = (at + word.len()).min(input.len());
                input.splice(at..end, word.iter().copied());
            }
            4 => _ = input.splice(at..at, WORDS[self.below(WORDS.len())].iter().copied()),
            // A piece twice, left out, or of another file.
            5 => {
                let piece = input[range].to_vec();
                let times = 1 + self.below(8);
                let pieces = piece.iter().copied().cycle().take(piece.len() * times);
                input.splice(at..at, pieces.collect::<Vec<u8>>());
            }
            6 => _ = input.drain(range),
            7 => {
                let other = self.file();
                let from = self.place(other.len());
                let piece = &other[from..(from + 4 * length).min(other.len())];
                input.splice(range, piece.iter().copied());
            }
            // The end cut off, or another file's in its place.
            8 => input.truncate(at),
            _ => {
                let other = self.file();
                let from = self.place(other.len());
                input.splice(at.., other[from..].iter().copied());
            }
        }
    }

    fn change(&mut self, input: &mut [u8], at: usize, new: fn(u8, u8) -> u8) {
        let by = self.below(256) as u8;
        if let Some(byte) = input.get_mut(at) {
            *byte = new(*byte, by);
        }
    }

    /// A place of an input: half of them in its first bytes, where headers are.
    fn place(&mut self, length: usize) -> usize {
        let length = length + 1;
        let within = if self.below(2) == 0 { length.min(256) } else { length };
        self.below(within)
    }

    fn file(&mut self) -> &'a [u8] {
        &self.corpus[self.below(self.corpus.len())]
    }

    /// A number from 0 to `count`, exclusive (xorshift: Marsaglia 2003).
    fn below(&mut self, count: usize) -> usize {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 11) as usize % count.max(1)
    }
}

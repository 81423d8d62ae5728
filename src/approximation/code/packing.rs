//! The numbers of an approximation as words of 32 bits: number after number, of each the channels
//! side by side, the first in the lowest bits.

use crate::approximation::{Approximation, Numbers, Storage};

/// How the numbers of an approximation stand in words.
pub struct Packing<'a> {
    approximation: &'a Approximation,
    /// The storage of all of them.
    pub storage: Storage,
    /// Numbers of a channel.
    pub count: usize,
}

impl<'a> Packing<'a> {
    /// Codes stay codes where all channels have as many of the same bits. Halves, what is mixed,
    /// and what ends sooner in one channel than in the other are packed as floats: a sum of powers
    /// goes on with zeros.
    pub fn of(approximation: &'a Approximation) -> Self {
        let channels = || approximation.numbers.iter().filter(|numbers| !numbers.is_empty());
        let count = channels().map(Numbers::len).max().unwrap_or(0);
        let mut storage = channels().next().map_or(Storage::F32, Numbers::storage);
        let is_mixed =
            channels().any(|numbers| numbers.storage() != storage || numbers.len() != count);
        if is_mixed || storage == Storage::F16 {
            storage = Storage::F32;
        }
        Packing { approximation, storage, count }
    }

    /// Channels side by side.
    pub fn channels(&self) -> usize {
        self.approximation.channels.count()
    }

    /// Bits of a number.
    pub fn bits(&self) -> usize {
        8 * self.storage.bytes()
    }

    /// How many times all channels of a number fit into a word; none where a channel fills it.
    pub fn per_word(&self) -> Option<usize> {
        (self.storage != Storage::F32).then(|| 32 / (self.bits() * self.channels()))
    }

    /// The offset and the scale of a channel's codes: those of a channel without numbers are 0.
    pub fn decode(&self, channel: usize) -> Option<[f32; 2]> {
        self.storage.last()?;
        match self.approximation.numbers.get(channel) {
            Some(&Numbers::Codes { offset, scale, .. }) => Some([offset, scale]),
            _ => Some([0.0; 2]),
        }
    }

    /// The code of a number, or the bits of its float.
    fn stored(&self, index: usize, channel: usize) -> u32 {
        match self.approximation.numbers.get(channel) {
            Some(numbers) if index >= numbers.len() => 0,
            Some(Numbers::Codes { codes, .. }) if self.storage != Storage::F32 => {
                codes[index].into()
            }
            Some(numbers) => (numbers.get(index) as f32).to_bits(),
            None => 0,
        }
    }

    /// The words. The last is filled up with zeros.
    pub fn words(&self) -> Vec<u32> {
        let (bits, channels) = (self.bits(), self.channels());
        let mut words = vec![0u32; (self.count * channels * bits).div_ceil(32)];
        for place in 0..self.count * channels {
            let stored = self.stored(place / channels, place % channels);
            words[place * bits / 32] |= stored << (place * bits % 32);
        }
        words
    }
}

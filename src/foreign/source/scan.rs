//! Lists of numbers, and strings of base64, in text. Comments, brackets, commas and constructors of
//! vectors stand within a list; whatever else there is ends it.

use super::literal::{Literal, literal};
use crate::error::clean;
use crate::foreign::{Read, refuse};

/// The most numbers of a list.
const MOST_NUMBERS: usize = 1 << 24;

/// A list or a string that is shorter is no table: 2 x 2 texels.
const FEWEST: usize = 4;

/// The fewest characters of base64: a picture has that many.
const SHORTEST_BASE64: usize = 100;

/// A list of numbers.
pub struct Numbers<'a> {
    /// Whole numbers, or decimals by the bits of their f32.
    pub bits: Vec<u32>,
    /// Whether they are decimals.
    pub decimal: bool,
    /// The identifier before the list.
    pub name: Option<&'a str>,
}

/// What is found in text.
pub enum Found<'a> {
    Numbers(Numbers<'a>),
    Base64(&'a str),
}

/// The first list or string that is long enough behind the first mention of this array; without a
/// name the longest of all.
pub fn find<'a>(text: &'a str, array: Option<&'a str>) -> Read<Found<'a>> {
    let start = match array {
        None => 0,
        Some(name) => match mention(text, name) {
            Some(at) => at,
            None => return refuse(format!("an array '{}'", clean(name, 60)), "none of that name"),
        },
    };
    let mut scan = Scan { text, at: start, name: array, first: array.is_some() };
    match scan.longest()? {
        Some(found) => Ok(found),
        None => refuse("EXR, KTX2, DDS, PNG, npy, or text with an array of numbers", "no array"),
    }
}

/// The place behind an identifier.
fn mention(text: &str, name: &str) -> Option<usize> {
    let part = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '$';
    let alone = |&(at, _): &(usize, &str)| {
        !text[..at].ends_with(part) && !text[at + name.len()..].starts_with(part)
    };
    (!name.is_empty())
        .then(|| text.match_indices(name).find(alone).map(|(at, _)| at + name.len()))
        .flatten()
}

struct Scan<'a> {
    text: &'a str,
    at: usize,
    /// The last identifier outside of a list.
    name: Option<&'a str>,
    /// Whether the first that is long enough will do.
    first: bool,
}

impl<'a> Scan<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn longest(&mut self) -> Read<Option<Found<'a>>> {
        let mut longest: Option<Found> = None;
        let mut list = Numbers { bits: Vec::new(), decimal: false, name: None };
        loop {
            let ended = match self.step(&mut list)? {
                Step::Within => continue,
                Step::Outside | Step::End | Step::Base64(_) if list.bits.len() >= FEWEST => {
                    let empty = Numbers { bits: Vec::new(), decimal: false, name: None };
                    Some(Found::Numbers(std::mem::replace(&mut list, empty)))
                }
                Step::Base64(text) => Some(Found::Base64(text)),
                Step::Outside => None,
                Step::End => return Ok(longest),
            };
            list.bits.clear();
            list.decimal = false;
            let Some(ended) = ended else { continue };
            if self.first {
                return Ok(Some(ended));
            }
            if longest.as_ref().is_none_or(|longest| length(&ended) > length(longest)) {
                longest = Some(ended);
            }
        }
    }

    /// One token.
    fn step(&mut self, list: &mut Numbers<'a>) -> Read<Step<'a>> {
        let rest = self.rest();
        let Some(c) = rest.chars().next() else { return Ok(Step::End) };
        match c {
            c if c.is_whitespace() => self.at += c.len_utf8(),
            ',' | '(' | ')' | '[' | ']' | '{' | '}' => self.at += 1,
            '#' => self.skip_to("\n"),
            '/' if rest.starts_with("//") => self.skip_to("\n"),
            '/' if rest.starts_with("/*") => self.skip_to("*/"),
            // A lifetime opens no string.
            '\'' if self.text[..self.at].ends_with(['&', '<']) => self.at += 1,
            '"' | '\'' | '`' => return Ok(self.string(c)),
            // What stands before it are the lengths of an array.
            '=' => {
                self.at += 1;
                list.bits.clear();
                return Ok(Step::Outside);
            }
            '0'..='9' | '.' | '-' | '+' => match literal(rest) {
                Some((number, length)) => {
                    self.at += length;
                    add(list, number, self.name)?;
                }
                None => {
                    self.at += 1;
                    return Ok(Step::Outside);
                }
            },
            c if c.is_alphabetic() || c == '_' || c == '$' => return Ok(self.identifier()),
            other => {
                self.at += other.len_utf8();
                return Ok(Step::Outside);
            }
        }
        Ok(Step::Within)
    }

    fn skip_to(&mut self, end: &str) {
        let rest = self.rest();
        self.at += rest.find(end).map_or(rest.len(), |at| at + end.len());
    }

    /// A string: base64, or nothing.
    fn string(&mut self, quote: char) -> Step<'a> {
        self.at += 1;
        let rest = self.rest();
        let length = rest.find([quote, '\n']).unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        while !self.text.is_char_boundary(self.at) {
            self.at += 1;
        }
        let content = &rest[..length];
        let content = content.split_once(";base64,").map_or(content, |(_, content)| content);
        let is_base64 = |c: u8| c.is_ascii_alphanumeric() || matches!(c, b'+' | b'/' | b'=');
        match content.len() >= SHORTEST_BASE64 && content.bytes().all(is_base64) {
            true => Step::Base64(content),
            false => Step::Outside,
        }
    }

    /// A word: constructors of vectors and casts belong to a list.
    fn identifier(&mut self) -> Step<'a> {
        let rest = self.rest();
        let ends = |c: char| !(c.is_alphanumeric() || c == '_' || c == '$');
        let word = &rest[..rest.find(ends).unwrap_or(rest.len())];
        self.at += word.len();
        let within = ["vec", "float", "half", "f16", "f32", "f64"];
        if within.iter().any(|start| word.starts_with(start)) {
            // A number in brackets behind a type is the length of an array.
            if self.rest().starts_with('[') {
                self.skip_to("]");
            }
            return Step::Within;
        }
        if !["static", "const", "new", "pub", "let", "var", "array"].contains(&word)
            && !word.ends_with("Array")
        {
            self.name = Some(word);
        }
        Step::Outside
    }
}

enum Step<'a> {
    /// A part of a list.
    Within,
    /// What ends one.
    Outside,
    Base64(&'a str),
    End,
}

fn length(found: &Found) -> usize {
    match found {
        Found::Numbers(numbers) => numbers.bits.len(),
        // Four characters are three bytes.
        Found::Base64(text) => text.len() / 4 * 3,
    }
}

/// Adds a number to a list; the first decimal makes decimals of whole numbers before it.
fn add<'a>(list: &mut Numbers<'a>, number: Literal, name: Option<&'a str>) -> Read<()> {
    if list.bits.is_empty() {
        list.name = name;
    }
    if list.bits.len() >= MOST_NUMBERS {
        return refuse(format!("at most {MOST_NUMBERS} numbers in text"), "more");
    }
    let bits = match (number, list.decimal) {
        (Literal::Whole(whole), false) => whole,
        (Literal::Whole(whole), true) => (whole as f32).to_bits(),
        (Literal::Decimal(value), true) => value.to_bits(),
        (Literal::Decimal(value), false) => {
            list.decimal = true;
            list.bits.iter_mut().for_each(|bits| *bits = (*bits as f32).to_bits());
            value.to_bits()
        }
    };
    list.bits.push(bits);
    Ok(())
}

//! Texels alone: their layout is named.

use super::shape::{MOST_COMPONENTS, count};
use super::texel::Texel;
use super::{Foreign, Read};
use crate::error::{Error, Result};
use crate::table::precision::Precision;
use std::str::FromStr;

/// The layout of texels alone, as in `64x64,rg16f`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawLayout {
    /// Columns, rows and slices.
    pub size: [usize; 3],
    texel: Texel,
}

/// Its words, for `--help` and errors.
pub const RAW_WORDS: &str = "COLUMNSxROWS[xSLICES],COMPONENTS with COMPONENTS r, rg, rgb or rgba \
                             and 8, 16, 16f or 32f behind it, or rgb10a2; as in 64x64,rg16f";

impl RawLayout {
    /// The storage of a number.
    pub fn storage(&self) -> Precision {
        self.texel.storage
    }

    /// Components of a texel.
    pub fn components(&self) -> usize {
        self.texel.components
    }
}

pub fn read(bytes: &[u8], layout: &RawLayout) -> Read<Foreign> {
    let RawLayout { size, texel } = *layout;
    let values = texel.numbers(bytes, size)?;
    Ok(Foreign::new("raw", size, texel.components, texel.storage, values))
}

impl FromStr for RawLayout {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = || Error::bad_input("raw", RAW_WORDS, format!("'{text}'"), "use those words");
        let (size, kind) = text.split_once(',').ok_or_else(wrong)?;
        let sides: Vec<usize> = size
            .split('x')
            .map(str::parse)
            .collect::<std::result::Result<_, _>>()
            .map_err(|_| wrong())?;
        let size = match sides[..] {
            [columns, rows] => [columns, rows, 1],
            [columns, rows, slices] => [columns, rows, slices],
            _ => return Err(wrong()),
        };
        let texel = texel(kind).ok_or_else(wrong)?;
        match count(size, texel.components) {
            Ok(_) => Ok(RawLayout { size, texel }),
            Err(refusal) => {
                Err(Error::bad_input("raw", refusal.expected, refusal.got, "give a smaller size"))
            }
        }
    }
}

fn texel(kind: &str) -> Option<Texel> {
    if kind == "rgb10a2" {
        return Some(Texel::new(Precision::A2b10g10r10, 4));
    }
    let digits = kind.find(|c: char| c.is_ascii_digit())?;
    let (letters, storage) = kind.split_at(digits);
    let components = (1..=MOST_COMPONENTS).find(|&count| "rgba"[..count] == *letters)?;
    let storage = match storage {
        "8" => Precision::Unorm8,
        "16" => Precision::Unorm16,
        "16f" => Precision::F16,
        "32f" => Precision::F32,
        _ => return None,
    };
    Some(Texel::new(storage, components))
}

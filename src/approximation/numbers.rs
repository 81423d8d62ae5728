//! The numbers of a channel as they are stored.

use crate::choice::choice;
use crate::numeric::half::nearest;

/// A storage of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// Floats of 32 bits: constants in code or uniforms.
    F32,
    /// Halves.
    F16,
    /// Codes of 16 bits with an offset and a scale for the channel.
    Unorm16,
    /// Codes of 8 bits with an offset and a scale for the channel.
    Unorm8,
}

choice!(Storage, "storage", {
    F32 = "f32", "floats";
    F16 = "f16", "halves";
    Unorm16 = "unorm16", "16 bits with an offset and a scale";
    Unorm8 = "unorm8", "8 bits with an offset and a scale";
});

/// The numbers of a channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Floats.
    Floats(Vec<f32>),
    /// Floats, each of which is a half.
    Halves(Vec<f32>),
    /// offset + scale · code, with codes from 0 to the `last`, 255 or 65535.
    Codes {
        /// The value of code 0.
        offset: f32,
        /// The step from a code to the next.
        scale: f32,
        /// The largest code that the storage has.
        last: u16,
        /// The codes.
        codes: Vec<u16>,
    },
}

impl Storage {
    /// The largest code; none of floats.
    pub fn last(self) -> Option<u16> {
        match self {
            Storage::F32 | Storage::F16 => None,
            Storage::Unorm16 => Some(u16::MAX),
            Storage::Unorm8 => Some(u16::from(u8::MAX)),
        }
    }

    /// Bytes of a number.
    pub fn bytes(self) -> usize {
        match self {
            Storage::F32 => 4,
            Storage::F16 | Storage::Unorm16 => 2,
            Storage::Unorm8 => 1,
        }
    }

    /// Rounds numbers to this storage: codes span the numbers' own range.
    pub fn store(self, numbers: &[f64]) -> Numbers {
        if self == Storage::F16 {
            return Numbers::Halves(numbers.iter().map(|&n| nearest(n) as f32).collect());
        }
        let Some(last) = self.last() else {
            return Numbers::Floats(numbers.iter().map(|&number| number as f32).collect());
        };
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let offset = low as f32;
        let scale = ((high - f64::from(offset)) / f64::from(last)) as f32;
        let code = |&number: &f64| match scale {
            0.0 => 0,
            _ => ((number - f64::from(offset)) / f64::from(scale))
                .round()
                .clamp(0.0, f64::from(last)) as u16,
        };
        Numbers::Codes { offset, scale, last, codes: numbers.iter().map(code).collect() }
    }
}

impl Storage {
    /// The same as a texture has them: codes span 0 to 1.
    pub fn store_texels(self, texels: &[f64]) -> Numbers {
        let Some(last) = self.last() else { return self.store(texels) };
        let code = |&texel: &f64| (texel * f64::from(last)).round().clamp(0.0, f64::from(last));
        let codes = texels.iter().map(|texel| code(texel) as u16).collect();
        Numbers::Codes { offset: 0.0, scale: 1.0 / f32::from(last), last, codes }
    }
}

impl Numbers {
    /// How they are stored.
    pub fn storage(&self) -> Storage {
        match self {
            Numbers::Floats(_) => Storage::F32,
            Numbers::Halves(_) => Storage::F16,
            Numbers::Codes { last: u16::MAX, .. } => Storage::Unorm16,
            Numbers::Codes { .. } => Storage::Unorm8,
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Numbers::Floats(floats) | Numbers::Halves(floats) => floats.len(),
            Numbers::Codes { codes, .. } => codes.len(),
        }
    }

    /// Whether there are none: the channel is 0.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Their bytes, without offset and scale, which stand in the code.
    pub fn bytes(&self) -> usize {
        self.len() * self.storage().bytes()
    }

    /// A number as a shader decodes it.
    pub fn get(&self, index: usize) -> f64 {
        match self {
            Numbers::Floats(floats) | Numbers::Halves(floats) => floats[index].into(),
            Numbers::Codes { offset, scale, codes, .. } => {
                (offset + scale * f32::from(codes[index])).into()
            }
        }
    }
}

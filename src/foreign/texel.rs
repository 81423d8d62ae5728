//! The formats of texels in memory that GPUs have, by their words, and their numbers.

use super::shape::count;
use super::{Read, refuse};
use crate::table::precision::Precision;

/// How a texel's bytes are its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texel {
    /// The storage of a number.
    pub storage: Precision,
    /// Numbers of a texel.
    pub components: usize,
    /// Red and blue have changed places.
    pub swapped: bool,
}

impl Texel {
    /// Red first.
    pub const fn new(storage: Precision, components: usize) -> Self {
        Texel { storage, components, swapped: false }
    }

    /// Bytes of a texel.
    pub fn bytes(self) -> usize {
        match self.storage {
            Precision::A2b10g10r10 => 4,
            storage => self.components * storage.bytes(),
        }
    }

    /// The numbers of as many texels; an error where there are fewer or more bytes.
    pub fn numbers(self, bytes: &[u8], size: [usize; 3]) -> Read<Vec<f32>> {
        let count = count(size, self.components)?;
        let length = count / self.components * self.bytes();
        if bytes.len() != length {
            let [columns, rows, slices] = size;
            let expected = format!("{length} bytes of {columns} x {rows} x {slices} texels");
            return refuse(expected, format!("{}", bytes.len()));
        }
        let mut numbers = Vec::with_capacity(count);
        match self.storage {
            Precision::A2b10g10r10 => {
                let texels = bytes.as_chunks::<4>().0;
                numbers
                    .extend(texels.iter().flat_map(|&texel| unpacked(u32::from_le_bytes(texel))));
            }
            // Codes of a curve are fractions; what is on a curve is another question.
            Precision::Srgb8 | Precision::Unorm8 | Precision::Rgbd8 => {
                numbers.extend(bytes.iter().map(|&code| f32::from(code) / 255.0));
            }
            storage => {
                let values = bytes.chunks_exact(storage.bytes());
                numbers.extend(values.map(|value| storage.read(value) as f32));
            }
        }
        if self.swapped {
            numbers.chunks_exact_mut(self.components).for_each(|texel| texel.swap(0, 2));
        }
        Ok(numbers)
    }
}

/// Red in the lowest 10 bits, then green and blue, alpha in the highest 2.
fn unpacked(bits: u32) -> [f32; 4] {
    let code = |place: u32| (bits >> place & 0x3ff) as f32 / 1023.0;
    [code(0), code(10), code(20), (bits >> 30) as f32 / 3.0]
}

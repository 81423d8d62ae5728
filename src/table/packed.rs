//! Numbers as a file stores them: packed, in one precision.

use super::precision::Precision;
use crate::error::{Error, Result};

/// Numbers in the bytes that a file holds, little-endian.
#[derive(Clone, Debug, PartialEq)]
pub struct Packed {
    precision: Precision,
    bytes: Vec<u8>,
}

impl Packed {
    /// Zeros; an error where there is no memory for them.
    pub fn zeros(precision: Precision, count: usize) -> Result<Self> {
        let mut bytes = Vec::new();
        let size = count * precision.bytes();
        bytes.try_reserve_exact(size).map_err(|_| Error::out_of_memory("the table", size))?;
        bytes.resize(size, 0);
        Ok(Packed { precision, bytes })
    }

    /// Their storage.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// The number of numbers.
    pub fn len(&self) -> usize {
        self.bytes.len() / self.precision.bytes()
    }

    /// Whether it is empty.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// The number at `index`.
    #[inline]
    pub fn get(&self, index: usize) -> f64 {
        self.precision.read(&self.bytes[index * self.precision.bytes()..])
    }

    /// The numbers in order.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        self.bytes.chunks_exact(self.precision.bytes()).map(|bytes| self.precision.read(bytes))
    }

    /// Their bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Their bytes, to be written to by [`Precision::write`].
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }
}

//! What a lookup costs: bytes, loads and arithmetic, and one number of the three.

use super::candidate::Candidate;
use crate::approximation::Region;
use crate::approximation::cost::Lookup;
use crate::error::{Error, Result};

/// The cost of a lookup.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Bytes of all numbers.
    pub bytes: usize,
    /// Numbers that are read from a place that depends on n·v or roughness, in pairs of channels.
    pub loads: usize,
    /// Operations of floats; a division or a root counts as 4, a logarithm as 6, a power as 12.
    pub operations: usize,
}

/// What each part of a cost weighs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Of a byte.
    pub bytes: f64,
    /// Of a load.
    pub loads: f64,
    /// Of an operation.
    pub operations: f64,
}

impl Default for Weights {
    /// The smallest table; among those of one size the least arithmetic.
    fn default() -> Self {
        Weights { bytes: 1.0, loads: 0.01, operations: 0.001 }
    }
}

impl Weights {
    /// Weights from words such as bytes=1,loads=16,operations=1; what is not named weighs nothing.
    pub fn named(words: &str) -> Result<Self> {
        let mut weights = Weights { bytes: 0.0, loads: 0.0, operations: 0.0 };
        let wrong = |got: &str| {
            let expected = "bytes=X,loads=X,operations=X with numbers from 0 to 1e6, not all 0";
            Error::bad_input("cost", expected, format!("'{got}'"), "give such weights")
        };
        for word in words.split(',') {
            let (name, number) = word.split_once('=').ok_or_else(|| wrong(word))?;
            let number = number.parse::<f64>().ok().filter(|number| (0.0..=1e6).contains(number));
            let number = number.ok_or_else(|| wrong(word))?;
            match name.trim() {
                "bytes" => weights.bytes = number,
                "loads" => weights.loads = number,
                "operations" => weights.operations = number,
                _ => return Err(wrong(word)),
            }
        }
        if weights.bytes + weights.loads + weights.operations == 0.0 {
            return Err(wrong(words));
        }
        Ok(weights)
    }
}

impl std::fmt::Display for Weights {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Weights { bytes, loads, operations } = self;
        write!(f, "bytes={bytes},loads={loads},operations={operations}")
    }
}

impl Cost {
    /// The cost as one number.
    pub fn weighed(self, weights: &Weights) -> f64 {
        self.bytes as f64 * weights.bytes
            + self.loads as f64 * weights.loads
            + self.operations as f64 * weights.operations
    }

    /// The cost of a candidate in a region.
    pub fn of(candidate: &Candidate, region: &Region) -> Self {
        let Candidate { channels, shape, counts, storage } = *candidate;
        let lookup = Lookup { region, channels, shape, counts, storage };
        let numbers: usize = counts.iter().take(channels.count()).sum();
        Cost {
            bytes: numbers * storage.bytes(),
            loads: lookup.loads(),
            operations: lookup.operations(),
        }
    }
}

impl std::ops::Add for Cost {
    type Output = Cost;

    /// Of two materials: the bytes of both, and the lookup of the dearer.
    fn add(self, other: Cost) -> Cost {
        Cost {
            bytes: self.bytes + other.bytes,
            loads: self.loads.max(other.loads),
            operations: self.operations.max(other.operations),
        }
    }
}

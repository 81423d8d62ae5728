//! An engine's own numbers, whose error is measured, not promised.

use super::hammersley::Hammersley;
use crate::error::{Error, Result};
use std::fmt;
use std::str::FromStr;

/// How an engine gets its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// Half vectors by D at Hammersley's points.
    Hammersley(Hammersley),
    /// Glass with refractions that leave on the side of v counted as if they passed, at |n·l|: as
    /// Cycles' tables `ggx_glass_inv_E` and `ggx_glass_inv_Eavg` have it.
    WrongSide,
}

/// The word of [`Estimator::WrongSide`].
const WRONG_SIDE: &str = "wrong-side";

impl Estimator {
    /// Evaluations for a texel where they are the same for each; none of quadrature.
    pub fn count(self) -> Option<u32> {
        match self {
            Estimator::Hammersley(points) => Some(points.count),
            Estimator::WrongSide => None,
        }
    }
}

impl From<Hammersley> for Estimator {
    fn from(points: Hammersley) -> Self {
        Estimator::Hammersley(points)
    }
}

impl fmt::Display for Estimator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Estimator::Hammersley(points) => points.fmt(f),
            Estimator::WrongSide => f.write_str(WRONG_SIDE),
        }
    }
}

impl FromStr for Estimator {
    type Err = Error;

    fn from_str(words: &str) -> Result<Self> {
        match words {
            WRONG_SIDE => Ok(Estimator::WrongSide),
            _ => words.parse().map(Estimator::Hammersley),
        }
    }
}

//! The cheapest approximation for a scene, and proofs that cheaper ones fail.

pub mod banded;
pub mod bound;
pub mod candidate;
pub mod chebyshev;
pub mod check;
pub mod cost;
pub mod domain;
pub mod engines;
pub mod file;
pub mod fit;
pub mod model_errors;
pub mod page;
pub mod proof;
pub mod reach;
pub mod report;
pub mod samples;
pub mod search;
pub mod tolerance;
pub mod truth;
pub mod verify;
mod words;

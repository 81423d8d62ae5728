//! What is certified of a table's values, and how: for its file, and for its report.

use serde::Serialize;

/// A certificate. Nothing in it depends on who computed the table: the same request gives the same one.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Certificate {
    /// What is certified, in words.
    pub promise: String,
    /// The largest error that a stored value in [0, 1] can have.
    pub bound: f64,
    /// How many texels there are.
    pub texels: usize,
    /// How many were decided by quadrature or interpolation, whose error left no doubt how they round.
    pub decided_before_reference: usize,
    /// How many lay so near a boundary of rounding that the double-exponential reference had to decide them.
    pub decided_by_reference: usize,
    /// How many are not known to be rounded correctly: all, where values are stored within a tolerance.
    pub undecided: usize,
    /// What the reference may be off, at the most; of albedos above 1 relative.
    pub reference_error: f64,
    /// The smallest distance from a boundary of rounding among the values that the reference decided.
    pub smallest_distance: Option<f64>,
    /// BLAKE3 of the stored values, little-endian, row by row, the channels of a texel side by side.
    pub blake3: String,
}

/// What a stage of certification did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stage {
    /// Who computed it, by which rule.
    pub by: String,
    /// What A may be off.
    pub error_of_a: f64,
    /// What B may be off where it is 1, 0.1, …, 1e-6.
    pub error_of_b: [f64; 7],
    /// The texels for which it was asked.
    pub texels: usize,
    /// The texels that it decided; none where values are stored within their error, and there is nothing to decide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decided: Option<usize>,
}

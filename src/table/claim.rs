//! The claim of a table: how far its values are from the truth, and on what grounds. A table cannot
//! be without one.

use std::array::from_fn;

/// How far the values of a table are from the truth.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Claim {
    /// Every value is certified.
    Certificate(Certificate),
    /// The values are not certified, but integrated by a rule with a bound of its error.
    Uncertified {
        /// The quadrature rule.
        rule: &'static str,
        /// The largest error of a value before it is stored; of values above 1 relative.
        error_bound: f64,
        /// The largest error found against the double-exponential reference, and the number of
        /// points compared, in all slices by this rule with this bound: texels, and directions of
        /// averages.
        measured_error: (f64, usize),
        /// Backend, arithmetic and device.
        computed_by: String,
    },
    /// The values are control points of a fitted net: none is an integral. The promise is that of
    /// a lookup.
    Fitted {
        /// Always `fitted`: nodes are no integrals.
        nodes: &'static str,
        /// How a lookup reads them.
        filter: String,
        /// Where its promise holds.
        domain: String,
        /// The tolerance of E(F0).
        tolerance: String,
        /// The largest error of E(F0) found, and the number of places compared.
        measured_error: (f64, usize),
        /// BLAKE3 of the numbers with their scales, as the plan has it.
        blake3: String,
    },
    /// The values are those of an engine's own estimator, which has no bound.
    Estimated {
        /// The estimator.
        estimator: String,
        /// The largest error of an integral found against the double-exponential reference, and
        /// the number of texels compared.
        measured_error: (f64, usize),
    },
}

/// A certificate. Nothing in it depends on the backend: the same request gives the same
/// certificate.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Certificate {
    /// The promise in words.
    pub promise: String,
    /// The largest error of a stored value in [-1, 1].
    pub bound: f64,
    /// The number of texels.
    pub texels: usize,
    /// Texels decided by quadrature or interpolation, whose error left no doubt how they round.
    pub decided_before_reference: usize,
    /// Texels so near a boundary of rounding that the double-exponential reference had to decide
    /// them.
    pub decided_by_reference: usize,
    /// Texels that are not known to be rounded correctly: all, where values are stored within a
    /// tolerance.
    pub undecided: usize,
    /// The largest error of the reference; of albedos above 1 relative.
    pub reference_error: f64,
    /// The smallest distance from a boundary of rounding among the values that the reference
    /// decided.
    pub smallest_distance: Option<f64>,
    /// BLAKE3 of the stored values of the slice, little-endian, row by row, the channels of a texel
    /// side by side: of a2b10g10r10 as whole numbers of 16 bits, of rgbd8 as the f32 that the codes
    /// stand for.
    pub blake3: String,
}

/// The work of one stage of certification.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Stage {
    /// Backend and rule.
    pub by: String,
    /// The bounds of its errors; none where it has no bound at any roughness of the table.
    pub error: Option<StageError>,
    /// The texels for which the stage was asked.
    pub texels: usize,
    /// The texels that it decided; none where values are stored within a tolerance and there is
    /// nothing to decide.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub decided: Option<usize>,
}

/// The bounds of a stage's errors, at whichever roughness of the table they are widest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StageError {
    /// The largest of any integral.
    pub largest: f64,
    /// The largest of an integral that vanishes at normal incidence (B), where it is 1, 0.1, …,
    /// 1e-6.
    pub by_decade: [f64; 7],
}

impl StageError {
    /// The wider of both bounds.
    pub(crate) fn or_wider(self, other: StageError) -> StageError {
        StageError {
            largest: self.largest.max(other.largest),
            by_decade: from_fn(|i| self.by_decade[i].max(other.by_decade[i])),
        }
    }
}

impl Claim {
    /// The certificate, if the values are certified.
    pub fn certificate(&self) -> Option<&Certificate> {
        match self {
            Claim::Certificate(certificate) => Some(certificate),
            Claim::Uncertified { .. } | Claim::Estimated { .. } | Claim::Fitted { .. } => None,
        }
    }
}

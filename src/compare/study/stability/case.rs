//! A case that is mapped: its failure, and what is done instead.

use super::Scale;
use super::ways::Way;
use crate::brdf::{Microfacet, Ndf};
use crate::integrate::ScaleBias;

/// A failure, and its cure.
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// The failure, its reason, and the cure.
    pub about: &'static str,
    /// Along a row of the maps.
    pub x: Scale,
    /// From row to row.
    pub y: Scale,
    /// The textbook formula's error exceeds this somewhere (∞: it yields a non-finite value).
    pub fails: f64,
    /// The largest error of the last way on the CPU, which is ours in f32, and of ours on devices;
    /// they yield no fault.
    pub holds: f64,
    pub(super) kind: Kind,
}

pub(super) enum Kind {
    /// A formula with its replacement.
    Formula(Replaced),
    /// Ways of integrating GGX.
    Tables(&'static [Way]),
    /// Ways of storing a lobe's B, or its albedo.
    Storage(Microfacet, fn(ScaleBias) -> f64),
}

/// A function of the two coordinates of a map.
pub type Formula = fn(f64, f64) -> f64;

/// A formula with its replacement.
pub struct Replaced {
    /// The textbook's formula in f64 and in f32.
    pub textbook: [Formula; 2],
    /// Ours in f64 and in f32.
    pub ours: [Formula; 2],
    /// The true value.
    pub truth: Formula,
    /// Whether errors count over the truth, or over 1.
    pub relative: bool,
    /// Both in WGSL, where a device has them.
    pub wgsl: Option<Wgsl>,
}

/// The two formulas in WGSL, of `p.x` and `p.y`.
pub struct Wgsl {
    /// The distribution whose functions they take.
    pub ndf: Ndf,
    /// The textbook's.
    pub textbook: &'static str,
    /// Ours.
    pub ours: &'static str,
}

//! What a rule promises: the largest error of A and of B, for each distribution by name.
//!
//! Every bound is measured: `splitsum chart bounds` climbs towards the largest error from thousands of starts, and
//! what it finds stays below the bound over [`MARGIN`] (docs/bounds.md).

use crate::model::{Masking, Microfacet, Ndf};

/// Below this α, r = 0.07, Charlie's ring lies so near the horizon that 2e-6 is all that is promised of the
/// reference, and nothing of its coarser kin.
pub const CHARLIE_LIMIT: f64 = 0.0049;

/// A bound is at least so many times the largest error that a long search finds.
pub const MARGIN: f64 = 1.5;

/// The bound of what a rule does not serve for.
pub const NONE: f64 = f64::INFINITY;

/// The bounds of a rule: absolute, or of albedos above 1 relative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Of GGX.
    pub ggx: f64,
    /// Of Beckmann.
    pub beckmann: f64,
    /// Of Beckmann with Walter's term, which jumps: no rule over half vectors resolves that.
    pub beckmann_walter: f64,
    /// Of Blinn-Phong.
    pub blinn_phong: f64,
    /// Of Charlie over its whole domain, with the masking terms that are no fit.
    pub charlie: f64,
    /// Of Charlie over its whole domain with its fitted Λ: that is so large at small α that what is seen of the ring
    /// is its far tail, which falls faster than the rules over half vectors follow (below roughness 1e-6).
    pub charlie_fitted: f64,
    /// Of Charlie from [`CHARLIE_LIMIT`] up.
    pub charlie_above_limit: f64,
    /// What is promised of B besides, but of Charlie's.
    pub of_b: ShareOfB,
    /// The same of Charlie from [`CHARLIE_LIMIT`] up.
    pub of_b_of_charlie: ShareOfB,
}

/// A bound for every decade of B: a share of B and a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShareOfB {
    /// Of B.
    pub share: f64,
    /// What comes on top.
    pub floor: f64,
}

impl ShareOfB {
    /// No promise.
    pub const NONE: ShareOfB = ShareOfB { share: NONE, floor: NONE };

    /// At most `share` of B and `floor`.
    pub const fn of(share: f64, floor: f64) -> Self {
        ShareOfB { share, floor }
    }

    /// What B may be off, `scale` being the albedo where it is above 1.
    fn at(self, b: f64, scale: f64) -> f64 {
        // Without a promise a product with B = 0 would be NaN.
        if self.share.is_finite() { self.share * b.abs() + self.floor * scale } else { NONE }
    }
}

impl Bounds {
    /// Of a rule that serves for no specular lobe.
    pub const NONE: Bounds = Bounds::same(NONE, ShareOfB::NONE);

    /// The same for all.
    pub const fn same(bound: f64, of_b: ShareOfB) -> Self {
        Bounds {
            ggx: bound,
            beckmann: bound,
            beckmann_walter: bound,
            blinn_phong: bound,
            charlie: bound,
            charlie_fitted: bound,
            charlie_above_limit: bound,
            of_b,
            of_b_of_charlie: of_b,
        }
    }

    /// For GGX alone.
    pub const fn ggx_alone(ggx: f64, of_b: ShareOfB) -> Self {
        Bounds { ggx, ..Bounds::same(NONE, of_b) }
    }

    /// The bound over the whole domain of a lobe.
    pub fn over_domain(&self, lobe: Microfacet) -> f64 {
        match lobe.ndf {
            Ndf::Ggx => self.ggx,
            Ndf::Beckmann => self.beckmann,
            Ndf::BeckmannWalter => self.beckmann_walter,
            Ndf::BlinnPhong => self.blinn_phong,
            Ndf::Charlie if lobe.masking == Masking::HeightCorrelated => self.charlie_fitted,
            Ndf::Charlie => self.charlie,
        }
    }

    /// The bounds of A and of B at an α, for a B where the albedo, if it is above 1, is `scale`.
    pub(super) fn at(&self, lobe: Microfacet, alpha: f64, b: f64, scale: f64) -> (f64, f64) {
        let (all, of_b) = match lobe.ndf {
            Ndf::Ggx | Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong => (self.over_domain(lobe), self.of_b),
            Ndf::Charlie if alpha < CHARLIE_LIMIT => (self.over_domain(lobe), ShareOfB::NONE),
            Ndf::Charlie => (self.charlie_above_limit, self.of_b_of_charlie),
        };
        (all * scale, of_b.at(b, scale).min(all * scale))
    }
}

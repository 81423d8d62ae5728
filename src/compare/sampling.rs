//! The estimators of the field: A and B as the mean of f n·l / pdf over directions drawn at random
//! or by a point set. They are here to be compared with; bakes use quadrature.
//!
//! With x = n·l and n·l V = G/(4 n·v), f n·l / F is D x V. Of the directions that half vectors of
//! the density D n·h, or of the visible part of it, reflect, D cancels out: what is left of f n·l /
//! (F pdf) is x V times 4 v·h/n·h, or times 2 (μ + μ(1+2Λ(μ))). Everything is symmetric about the
//! plane of v and n, so that a point's azimuth enters by its cosine alone.

mod bounded_visible;
mod half_vector;
mod hemisphere;
mod spherical_cap;
mod visible;

pub use bounded_visible::bounded_visible_sample;
pub use half_vector::{HalfVector, half_vector_sample, sampled_half_vectors};
pub use hemisphere::{cosine_sample, uniform_sample};
pub use spherical_cap::spherical_cap_sample;
pub use visible::visible_sample;

use crate::brdf::fresnel::schlick_weights;
use crate::brdf::{Microfacet, Ndf};
use crate::choice::choice;
use crate::compare::point_set::Point;
use crate::integrate::{Integrals, ScaleBias};
use crate::numeric::lanes::Real;
use std::f64::consts::FRAC_1_PI;

/// A map from the unit square to directions of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampler {
    /// Every direction alike.
    Uniform,
    /// Proportional to n·l.
    Cosine,
    /// Reflected by half vectors with the density D n·h (Walter et al. 2007; Karis 2013): the
    /// natural sampler of every distribution.
    HalfVector,
    /// Reflected by the half vectors that v sees (Heitz 2018): GGX.
    Visible,
    /// The same by spherical caps (Dupuy and Benyoub 2023): GGX.
    SphericalCap,
    /// The same without most of what would be reflected below the horizon (Eto and Tokuyoshi 2023):
    /// GGX.
    BoundedVisible,
}

choice!(Sampler, "sampler", {
    Uniform = "uniform", "every direction alike";
    Cosine = "cosine", "by n.l";
    HalfVector = "half-vector", "half vectors by D (Walter et al. 2007)";
    Visible = "visible", "visible normals (Heitz 2018)";
    SphericalCap = "spherical-cap", "spherical caps (Dupuy and Benyoub 2023)";
    BoundedVisible = "bounded-visible", "bounded caps (Eto and Tokuyoshi 2023)";
});

/// The quantities that are the same for all samples of a texel.
#[derive(Clone, Copy, Debug)]
pub struct View<R> {
    lobe: Microfacet,
    alpha: R,
    /// n·v
    mu: R,
    /// sin θ_v
    sv: R,
    /// [`Microfacet::masking_projected_area`] of n·v.
    area_v: R,
    /// μ(1+2Λ(μ)) of GGX.
    visible: R,
    /// 1/width², width being the unit of slopes.
    inverse_width2: R,
    /// v in the space where the microsurface of GGX is a hemisphere: in the plane, and along the
    /// normal.
    stretched: (R, R),
}

/// A direction of light and its weight.
#[derive(Clone, Copy, Debug)]
pub struct Sample<R> {
    /// n·l; below the horizon it counts nothing.
    pub nl: R,
    /// The part of l in the plane of v and n, positive where v lies.
    pub plane: R,
    /// v·h
    pub vh: R,
    /// f n·l / (F pdf)
    pub weight: R,
}

impl Sampler {
    /// Whether a device can run it for a lobe: half vectors by their distribution are GGX's there.
    pub fn runs_on_device(self, lobe: Microfacet) -> bool {
        self.applies_to(lobe) && (self != Sampler::HalfVector || lobe.ndf == Ndf::Ggx)
    }

    /// Whether it serves for a lobe: those by what v sees are GGX's, with whatever masking.
    pub fn applies_to(self, lobe: Microfacet) -> bool {
        match self {
            Sampler::Uniform | Sampler::Cosine | Sampler::HalfVector => true,
            Sampler::Visible | Sampler::SphericalCap | Sampler::BoundedVisible => {
                lobe.ndf == Ndf::Ggx
            }
        }
    }

    /// The density of the direction of light whose half vector has the squared slope `t`, by solid
    /// angle, above the horizon.
    pub fn pdf(self, view: &View<f64>, nl: f64, vh: f64, t: f64) -> f64 {
        let d = view.distribution(t);
        match self {
            Sampler::Uniform => 0.5 * FRAC_1_PI,
            Sampler::Cosine => nl * FRAC_1_PI,
            Sampler::HalfVector => d / (1.0 + t).sqrt() / (4.0 * vh),
            Sampler::Visible | Sampler::SphericalCap => d / (2.0 * (view.mu + view.visible)),
            Sampler::BoundedVisible => {
                d / (2.0 * (bounded_visible::bound(view) * view.mu + view.visible))
            }
        }
    }
}

impl<R: Real> View<R> {
    /// The view at n·v = `mu`.
    #[inline(always)]
    pub fn seen_from(lobe: Microfacet, mu: R, alpha: R) -> Self {
        let sv = (mu.complement() * (mu + 1.0)).sqrt();
        let visible = Ndf::Ggx.projected_area(mu, alpha);
        let stretched = (alpha * sv / visible, mu / visible);
        let width = lobe.ndf.width(alpha);
        let inverse_width2 = (width * width).recip();
        View {
            lobe,
            alpha,
            mu,
            sv,
            area_v: lobe.masking_projected_area(mu, alpha),
            visible,
            inverse_width2,
            stretched,
        }
    }

    /// n·l V
    #[inline(always)]
    fn cosine_visibility(&self, nl: R) -> R {
        self.lobe.cosine_visibility_at(nl, self.mu, self.area_v, self.alpha)
    }

    /// D at the half vector with the squared slope `t` = tan² θ_h.
    #[inline(always)]
    fn distribution(&self, t: R) -> R {
        let secant2 = t + 1.0;
        self.lobe.ndf.slope_density(t * self.inverse_width2, self.alpha)
            * self.inverse_width2
            * secant2
            * secant2
    }

    /// The direction that the half vector (`x` in the plane, `z` along the normal) reflects; its
    /// weight is n·l V yet.
    #[inline(always)]
    fn reflected(&self, x: R, z: R) -> Sample<R> {
        let vh = self.sv * x + self.mu * z;
        let nl = vh * (z * 2.0) - self.mu;
        Sample { nl, plane: vh * 2.0 * x - self.sv, vh, weight: self.cosine_visibility(nl) }
    }

    /// The same where the half vector is given in the space in which the microsurface of GGX is a
    /// hemisphere, by its components in the plane, squared out of it, and along the normal, in
    /// whatever length.
    #[inline(always)]
    fn reflect_stretched(&self, (x, y2, z): (R, R, R), factor: R) -> Sample<R> {
        let shrink = (self.alpha * self.alpha * (x * x + y2) + z * z).sqrt().recip();
        let sample = self.reflected(self.alpha * x * shrink, z * shrink);
        Sample { weight: sample.weight * factor, ..sample }
    }
}

/// Terms that are added up before they join the sum of a block, and blocks before they
/// join the whole: rounding then grows with the cube root of their number.
const BLOCK: usize = 64;

/// The mean of the samples that items stand for; a macro, since a closure of this size is compiled
/// apart, without vectors.
macro_rules! mean {
    ($items:expr, $item:ident => $weight:expr, $sample:expr) => {{
        let one = R::from(1.0);
        let mut sum = Integrals::<2, R>::zero();
        for items in $items.chunks(BLOCK * BLOCK) {
            let mut blocks = Integrals::<2, R>::zero();
            for items in items.chunks(BLOCK) {
                let mut block = Integrals::<2, R>::zero();
                for $item in items {
                    let sample: Sample<R> = $sample;
                    let value =
                        R::from(0.0).select_below(sample.nl, sample.weight * $weight, R::from(0.0));
                    let [_, weight] = schlick_weights(sample.vh);
                    let b = value * weight;
                    block.add(one, [value - b, b]);
                }
                blocks.add(one, block.0);
            }
            sum.add(one, blocks.0);
        }
        ScaleBias::from(sum.0)
    }};
}

/// (A, B) as the mean over `points`, or for [`Sampler::HalfVector`] over the half vectors that they
/// choose ([`sampled_half_vectors`]).
#[inline(always)]
pub fn estimate<R: Real>(
    sampler: Sampler,
    view: &View<R>,
    points: &[Point],
    halves: &[HalfVector],
) -> ScaleBias<R> {
    match sampler {
        Sampler::Uniform => mean!(points, p => p.weight, uniform_sample(view, p)),
        Sampler::Cosine => mean!(points, p => p.weight, cosine_sample(view, p)),
        Sampler::HalfVector => mean!(halves, h => 1.0, half_vector_sample(view, h)),
        Sampler::Visible => mean!(points, p => p.weight, visible_sample(view, p)),
        Sampler::SphericalCap => mean!(points, p => p.weight, spherical_cap_sample(view, p)),
        Sampler::BoundedVisible => mean!(points, p => p.weight, bounded_visible_sample(view, p)),
    }
}

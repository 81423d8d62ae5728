//! From a lobe to numbers: the integrals of the weights of its Fresnel model over all directions of
//! light, I_k = ∫ f/F w_k n·l dω, by quadrature in five forms or by interpolation between such
//! integrals.
//!
//! With Schlick's weights (1 - w, w) they are A and B of the split sum, E(F0) = F0 A + B (Karis
//! 2013). On the edge α = 0 they are those of a mirror, whatever n·v.

pub mod average;
pub mod bent_rings;
pub mod bounds;
pub mod costs;
pub mod double_exponential;
pub mod errors;
pub mod estimator;
pub mod field;
pub mod glass;
pub mod half_vectors;
pub mod hammersley;
pub mod interpolant;
pub mod light_directions;
pub mod light_planes;
pub mod pick;
pub mod rings;
pub mod rule;
pub mod rules;
pub mod view_polar;

pub use field::{Field, ScaleBias};

use crate::brdf::fresnel::Basis;
use crate::brdf::interface::{Interface, TransmissionMasking};
use crate::brdf::{Diffuse, Fresnel, Microfacet};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use std::fmt;

/// A lobe to be integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrand {
    /// A specular lobe, to the integrals of its Fresnel model's weights.
    Specular(Microfacet, Fresnel),
    /// A rough interface of two dielectrics, to its reflection and transmission.
    Glass(Interface),
    /// A white diffuse lobe, to its albedo; the grid's α is the square of its roughness.
    Diffuse(Diffuse),
}

impl From<Microfacet> for Integrand {
    fn from(lobe: Microfacet) -> Self {
        Integrand::Specular(lobe, Fresnel::Schlick)
    }
}

impl fmt::Display for Integrand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Integrand::Specular(Microfacet { ndf, masking }, fresnel) => {
                write!(f, "{ndf}, {masking}, {fresnel}")
            }
            Integrand::Glass(interface) => write!(f, "glass, {interface}"),
            Integrand::Diffuse(diffuse) => write!(f, "{diffuse}"),
        }
    }
}

impl Integrand {
    /// The number of integrals at a point.
    pub fn count(self) -> usize {
        match self {
            Integrand::Specular(_, fresnel) => fresnel.count(),
            Integrand::Glass(_) => 2,
            Integrand::Diffuse(_) => 1,
        }
    }

    /// The names of the integrals.
    pub fn names(self) -> Vec<&'static str> {
        match self {
            Integrand::Specular(_, fresnel) => {
                fresnel.definition().integrals.iter().map(|integral| integral.name).collect()
            }
            Integrand::Glass(_) => vec!["R", "T"],
            Integrand::Diffuse(_) => vec!["E"],
        }
    }

    /// Whether an albedo can exceed 1.
    pub fn may_exceed_one(self) -> bool {
        match self {
            Integrand::Specular(lobe, _) => lobe.may_exceed_one(),
            Integrand::Glass(_) => false,
            Integrand::Diffuse(_) => true,
        }
    }

    /// Why no device can bake it: what is wrong, what was expected, what was got.
    pub fn obstacle_on_device(self) -> Option<(&'static str, &'static str, String)> {
        match self {
            Integrand::Specular(_, fresnel) => {
                fresnel.obstacle_on_device().map(|wanted| ("fresnel", wanted, fresnel.to_string()))
            }
            // Its logarithms of gamma functions cancel in f32.
            Integrand::Glass(interface) => match interface.transmission() {
                TransmissionMasking::Correlated | TransmissionMasking::Separable => None,
                TransmissionMasking::Beta => Some((
                    "transmission-masking",
                    "correlated or separable, for a device",
                    "beta".into(),
                )),
            },
            Integrand::Diffuse(_) => Some((
                "lut",
                "one that is integrated",
                "diffuse, whose closed forms the CPU has at once".into(),
            )),
        }
    }
}

/// The nodes of a rule for specular lobes, ready to use on any point.
pub trait Kernel: Send + Sync + 'static {
    /// The integrals at n·v = `mu` in [0, 1] and `alpha` above 0.
    fn integrate<const N: usize, B: Basis<N>, R: Real>(
        &self,
        lobe: Microfacet,
        basis: B,
        mu: R,
        alpha: R,
    ) -> Integrals<N, R>;
}

/// The integrals in the limit α → 0 at fixed n·v: those of a perfect mirror, times the limit of the
/// albedo; each with the bound of its error.
pub fn mirror<const N: usize, B: Basis<N>>(lobe: Microfacet, basis: B, mu: f64) -> [Ball; N] {
    basis.of_mirror(mu).map(|weight| lobe.smooth_limit(Ball::exact(mu)) * weight)
}

/// The scale of errors at a point, or at as many as R has lanes: the albedo there if it exceeds 1,
/// else 1.
#[inline(always)]
pub fn scale<R: Real>(integrals: &[R]) -> R {
    // The first two weights add up to F = 1: see Basis.
    let albedo = integrals.iter().take(2).fold(R::from(0.0), |sum, &integral| sum + integral);
    // 1 where it is no number.
    R::from(1.0).max(albedo)
}

/// The integrals of the weights at one point, or at as many as R has lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrals<const N: usize, R = f64>(pub [R; N]);

impl<const N: usize, R: Real> Integrals<N, R> {
    /// Zeros.
    #[inline(always)]
    pub fn zero() -> Self {
        Integrals([R::from(0.0); N])
    }

    /// Adds `factor` times `part`.
    #[inline(always)]
    pub fn add(&mut self, factor: R, part: [R; N]) {
        #[allow(
            clippy::needless_range_loop,
            reason = "zip keeps the sums in memory, not registers"
        )]
        for k in 0..N {
            self.0[k] = self.0[k] + factor * part[k];
        }
    }

    /// The same in the lanes where `value` is above 0, and 0 in the others.
    #[inline(always)]
    pub fn where_positive(self, value: R) -> Self {
        let zero = R::from(0.0);
        Integrals(self.0.map(|integral| zero.select_below(value, integral, zero)))
    }
}

//! Distributions of microfacet normals. All that is peculiar to one stands in its file: the
//! formulas, and a [`Definition`] with everything else that the rest of the program has to know of
//! it.

pub mod ggx;
pub mod beckmann;
pub mod blinn_phong;
pub mod charlie;

use super::masking::Masking;
use crate::choice::{Choice, choice};
use crate::numeric::lanes::Real;
use crate::units::LARGEST_ALPHA;

/// A distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ndf {
    /// Trowbridge and Reitz 1975; Walter et al. 2007, equation 33.
    Ggx,
    /// Beckmann and Spizzichino 1963, with the exact Smith term.
    Beckmann,
    /// Beckmann with the rational Smith term of Walter et al. 2007.
    BeckmannWalter,
    /// Blinn 1977, normalised: (n+2)/(2π) (n·h)^n, n = 2/α² - 2; its Smith term is Beckmann's.
    BlinnPhong,
    /// Estevez and Kulla 2017, for sheen.
    Charlie,
}

/// The properties of a distribution besides its formulas.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Its word on the command line and in metadata.
    pub word: &'static str,
    /// It in a line, with its source.
    pub about: &'static str,
    /// The masking terms that have a meaning for it, the default one first.
    pub maskings: &'static [Masking],
    /// Why it has no other: the cure of the error.
    pub why_no_other_masking: &'static str,
    /// The masking terms with which its albedo never exceeds 1.
    pub energy_conserving: &'static [Masking],
    /// α as a function of the roughness of a table's axis, for the metadata.
    pub roughness: &'static str,
    /// Whether D is a smooth function of the half vector at the normal; sin θ_h to a power is not.
    pub smooth_at_normal: bool,
    /// Whether it becomes a mirror as α → 0.
    pub becomes_mirror: bool,
    /// Its WGSL.
    pub wgsl: Wgsl,
}

/// The WGSL of a distribution: a module that defines its functions, and the expressions that a
/// kernel takes from it.
#[derive(Clone, Copy, Debug)]
pub struct Wgsl {
    /// The module.
    pub source: &'static str,
    /// [`Ndf::width`] of `alpha`.
    pub width: &'static str,
    /// [`Ndf::slope_end`] of `alpha` where f32 needs it: exp(-20) = 2e-9 of a lobe lies beyond.
    pub slope_end: &'static str,
    /// [`Ndf::slope_density`] of `y2` and `alpha`.
    pub slope_density: &'static str,
    /// [`Ndf::projected_area`] of `c` and `alpha`.
    pub projected_area: &'static str,
}

impl Ndf {
    /// All that is peculiar to it.
    pub const fn definition(self) -> &'static Definition {
        match self {
            Ndf::Ggx => &ggx::DEFINITION,
            Ndf::Beckmann => &beckmann::DEFINITION,
            Ndf::BeckmannWalter => &beckmann::WALTER,
            Ndf::BlinnPhong => &blinn_phong::DEFINITION,
            Ndf::Charlie => &charlie::DEFINITION,
        }
    }

    /// The masking term of a lobe for which none is named.
    pub fn default_masking(self) -> Masking {
        self.definition().maskings[0]
    }

    /// The largest α up to which its rules were searched. Beyond 1 only GGX's were, which an engine
    /// needs; Blinn-Phong's exponent would be negative there, and Charlie's Λ was fitted below.
    pub fn most_alpha(self) -> f64 {
        match self {
            Ndf::Ggx => LARGEST_ALPHA,
            Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong | Ndf::Charlie => 1.0,
        }
    }

    /// The unit of slopes.
    #[inline(always)]
    pub fn width<R: Real>(self, alpha: R) -> R {
        match self {
            Ndf::Ggx | Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong => alpha,
            Ndf::Charlie => charlie::charlie_width(alpha),
        }
    }

    /// P = width² P22: the density of the scaled slope y = tan(θ_h)/width, given y²; 2π ∫ y P dy =
    /// 1 over y > 0.
    #[inline(always)]
    pub fn slope_density<R: Real>(self, y2: R, alpha: R) -> R {
        match self {
            Ndf::Ggx => ggx::ggx_slope_density(y2),
            Ndf::Beckmann | Ndf::BeckmannWalter => beckmann::beckmann_slope_density(y2),
            Ndf::BlinnPhong => blinn_phong::blinn_phong_slope_density(y2, alpha),
            Ndf::Charlie => charlie::charlie_slope_density(y2, alpha),
        }
    }

    /// The scaled slope beyond which less than exp(-`depth`) of the lobe lies; 1e18 where the tail
    /// is a power of y.
    #[inline(always)]
    pub fn slope_end<R: Real>(self, alpha: R, depth: f64) -> R {
        match self {
            Ndf::Ggx | Ndf::Charlie => R::from(1e18),
            Ndf::Beckmann | Ndf::BeckmannWalter => R::from(depth.sqrt()),
            Ndf::BlinnPhong => {
                alpha.zip(alpha, |alpha, _| blinn_phong::blinn_phong_end(alpha, depth))
            }
        }
    }

    /// c (1 + 2Λ(c)) for the cosine `c`, finite at c = 0: the projected area of the microsurface
    /// towards a direction, of the facets that face it, c (1 + Λ) = c/G1, and of those that are
    /// turned away from it, c Λ (Heitz 2014, section 2.5).
    #[inline(always)]
    pub fn projected_area<R: Real>(self, c: R, alpha: R) -> R {
        match self {
            Ndf::Ggx => ggx::ggx_projected_area(c, alpha),
            Ndf::Beckmann | Ndf::BlinnPhong => c.call::<beckmann::ProjectedArea>(alpha),
            Ndf::BeckmannWalter => beckmann::walter_projected_area(c, alpha),
            Ndf::Charlie => c.call::<charlie::ProjectedArea>(alpha),
        }
    }

    /// The cosine at which [`Ndf::projected_area`] is not smooth, if there is one.
    #[inline(always)]
    pub fn break_at<R: Real>(self, alpha: R) -> Option<R> {
        match self {
            Ndf::Ggx | Ndf::Beckmann | Ndf::BlinnPhong => None,
            Ndf::BeckmannWalter => Some(alpha.zip(alpha, |alpha, _| beckmann::walter_break(alpha))),
            // The two branches of the fit meet here with the same slope.
            Ndf::Charlie => Some(R::from(0.5)),
        }
    }
}

impl Choice for Ndf {
    const WHAT: &'static str = "model";
    const ALL: &'static [Self] =
        &[Ndf::Ggx, Ndf::Beckmann, Ndf::BeckmannWalter, Ndf::BlinnPhong, Ndf::Charlie];

    fn word(self) -> &'static str {
        self.definition().word
    }

    fn about(self) -> &'static str {
        self.definition().about
    }
}

choice!(Ndf);

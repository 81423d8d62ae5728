//! Microfacet models: a distribution of normals, a masking term, Fresnel. Closed forms with their citations, no tables.
//!
//! A specular lobe is f(l, v) = F D G / (4 n·l n·v). The integrals need it split otherwise: the distribution as a
//! density of slopes y = tan(θ_h)/width, which stays smooth as α → 0, and n·l V = G / (4 n·v), which is finite at n·v
//! = 0.

pub mod fresnel;
pub mod ggx;
pub mod beckmann;
pub mod blinn_phong;
pub mod charlie;
pub mod diffuse;
pub mod masking;

use crate::lanes::{Number, Real};

/// The distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
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

/// The masking and shadowing term G.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Masking {
    /// Smith, heights correlated (Heitz 2014, equation 99).
    HeightCorrelated,
    /// Smith, G1(l) G1(v) (Heitz 2014, equation 98).
    Separable,
    /// Schlick's approximation with k = α/2 (Karis 2013).
    SchlickSmith,
    /// Unreal Engine's approximation of the height-correlated term of GGX (Hammon 2017).
    Joint,
    /// G = n·l n·v (Hoffman 2013).
    Implicit,
    /// V = 1/(4 (n·l + n·v - n·l n·v)), for sheen (Neubelt and Pettineo 2013).
    Neubelt,
}

/// A diffuse lobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Diffuse {
    /// Lambert 1760.
    Lambert,
    /// Burley 2012 ("Disney diffuse").
    Burley,
    /// Oren and Nayar 1994, the qualitative model.
    OrenNayar,
    /// The single scattering of EON (Portsmouth, Kutz and Hill 2025).
    Eon,
}

/// A distribution of normals with its masking term: everything of a specular lobe but Fresnel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Microfacet {
    /// The distribution of normals.
    pub ndf: Ndf,
    /// The masking term.
    pub masking: Masking,
}

impl Ndf {
    /// All of them.
    pub const ALL: [Ndf; 5] = [Ndf::Ggx, Ndf::Beckmann, Ndf::BeckmannWalter, Ndf::BlinnPhong, Ndf::Charlie];

    /// What it is, in a line.
    pub fn summary(self) -> &'static str {
        match self {
            Ndf::Ggx => "GGX, long tails (Trowbridge and Reitz 1975; Walter et al. 2007)",
            Ndf::Beckmann => "Gaussian slopes, exact Smith term (Beckmann and Spizzichino 1963; Heitz 2014)",
            Ndf::BeckmannWalter => "the same with Walter's rational Smith term, which jumps (Walter et al. 2007)",
            Ndf::BlinnPhong => "a power of n.h, n = 2/alpha^2 - 2 (Blinn 1977; Hoffman 2013)",
            Ndf::Charlie => "a power of sin(theta_h), for sheen (Estevez and Kulla 2017)",
        }
    }

    /// The unit of slopes.
    #[inline(always)]
    pub fn width<R: Real>(self, alpha: R) -> R {
        match self {
            Ndf::Charlie => charlie::charlie_width(alpha),
            _ => alpha,
        }
    }

    /// P = width² P22: the density of the scaled slope y = tan(θ_h)/width, given y²; 2π ∫ y P dy = 1 over y > 0.
    #[inline(always)]
    pub fn slope_density<R: Real>(self, y2: R, alpha: R) -> R {
        match self {
            Ndf::Ggx => ggx::ggx_slope_density(y2),
            Ndf::Beckmann | Ndf::BeckmannWalter => beckmann::beckmann_slope_density(y2),
            Ndf::BlinnPhong => blinn_phong::blinn_phong_slope_density(y2, alpha),
            Ndf::Charlie => charlie::charlie_slope_density(y2, alpha),
        }
    }

    /// The scaled slope beyond which less than exp(-`depth`) of the lobe lies; 1e18 where the tail is a power of y.
    #[inline(always)]
    pub fn slope_end<R: Real>(self, alpha: R, depth: f64) -> R {
        match self {
            Ndf::Ggx | Ndf::Charlie => R::from(1e18),
            Ndf::Beckmann | Ndf::BeckmannWalter => R::from(depth.sqrt()),
            Ndf::BlinnPhong => alpha.zip(alpha, |alpha, _| blinn_phong::blinn_phong_end(alpha, depth)),
        }
    }

    /// Whether the distribution is a smooth function of the half vector at the normal: sin θ_h to a power is not.
    pub fn smooth_at_normal(self) -> bool {
        self != Ndf::Charlie
    }

    /// c (1 + 2Λ(c)) for the cosine `c`: what Smith masking needs, finite at c = 0.
    #[inline(always)]
    pub fn smith<R: Real>(self, c: R, alpha: R) -> R {
        match self {
            Ndf::Ggx => ggx::ggx_smith(c, alpha),
            Ndf::Beckmann | Ndf::BlinnPhong => c.zip(alpha, beckmann::beckmann_smith),
            Ndf::BeckmannWalter => c.zip(alpha, beckmann::walter_smith),
            Ndf::Charlie => c.zip(alpha, charlie::charlie_smith),
        }
    }

    /// The masking that a lobe has when none is named: the first in each list below.
    pub fn default_masking(self) -> Masking {
        self.maskings()[0]
    }

    /// The masking terms that mean something for the distribution.
    pub fn maskings(self) -> &'static [Masking] {
        use Masking::{HeightCorrelated, Implicit, Joint, Neubelt, SchlickSmith, Separable};
        match self {
            Ndf::Ggx => &[HeightCorrelated, Separable, SchlickSmith, Joint, Implicit],
            Ndf::Beckmann => &[HeightCorrelated, Separable, SchlickSmith, Implicit],
            // It is Beckmann's but for Λ.
            Ndf::BeckmannWalter => &[HeightCorrelated, Separable],
            Ndf::BlinnPhong => &[Implicit, HeightCorrelated, Separable],
            // Height-correlated is the pair that Estevez and Kulla fitted.
            Ndf::Charlie => &[Neubelt, HeightCorrelated, Implicit],
        }
    }
}

impl Diffuse {
    /// All of them.
    pub const ALL: [Diffuse; 4] = [Diffuse::Lambert, Diffuse::Burley, Diffuse::OrenNayar, Diffuse::Eon];

    /// What it is, in a line.
    pub fn summary(self) -> &'static str {
        match self {
            Diffuse::Lambert => "the same in every direction (Lambert 1760)",
            Diffuse::Burley => "Disney's diffuse lobe (Burley 2012)",
            Diffuse::OrenNayar => "rough Lambertian facets, the qualitative model (Oren and Nayar 1994)",
            Diffuse::Eon => "the single scattering of EON (Portsmouth, Kutz and Hill 2025)",
        }
    }

    /// The directional albedo of a white surface with the roughness `r`.
    pub fn albedo(self, mu: f64, r: f64) -> f64 {
        match self {
            Diffuse::Lambert => diffuse::lambert_albedo(),
            Diffuse::Burley => diffuse::burley_albedo(mu, r),
            Diffuse::OrenNayar => diffuse::oren_nayar_albedo(mu, r),
            Diffuse::Eon => diffuse::eon_albedo(mu, r),
        }
    }
}

impl Microfacet {
    /// Every lobe that means something.
    pub fn all() -> impl Iterator<Item = Microfacet> {
        Ndf::ALL.into_iter().flat_map(|ndf| ndf.maskings().iter().map(move |&masking| Microfacet { ndf, masking }))
    }

    /// What the masking term takes of n·v: c (1 + 2Λ(c)) of the term that it is made of.
    #[inline(always)]
    pub fn masking_smith<R: Real>(self, c: R, alpha: R) -> R {
        match self.masking {
            Masking::HeightCorrelated | Masking::Separable => self.ndf.smith(c, alpha),
            Masking::Joint => masking::joint_smith(c, alpha),
            Masking::SchlickSmith | Masking::Implicit | Masking::Neubelt => c,
        }
    }

    /// n·l V(l, v) = G(l, v) / (4 n·v) for n·l = `x` and n·v = `mu`.
    #[inline(always)]
    pub fn cosine_visibility<R: Real>(self, x: R, mu: R, alpha: R) -> R {
        self.cosine_visibility_at(x, mu, self.masking_smith(mu, alpha), alpha)
    }

    /// The same with [`Microfacet::masking_smith`] of n·v, which a loop over n·l works out once.
    #[inline(always)]
    pub fn cosine_visibility_at<R: Real>(self, x: R, mu: R, smu: R, alpha: R) -> R {
        use masking::{height_correlated, implicit, neubelt, schlick_smith, separable};
        match self.masking {
            Masking::HeightCorrelated | Masking::Joint => height_correlated(x, mu, self.masking_smith(x, alpha), smu),
            Masking::Separable => separable(x, mu, self.masking_smith(x, alpha), smu),
            Masking::SchlickSmith => schlick_smith(x, mu, alpha),
            Masking::Implicit => implicit(x),
            Masking::Neubelt => neubelt(x, mu),
        }
    }

    /// E(F = 1) in the limit α → 0 at fixed n·v, as a multiple of a mirror's: G of the mirror direction, 0 for sheen.
    pub fn smooth_limit<R: Number>(self, mu: R) -> R {
        match (self.ndf, self.masking) {
            (Ndf::Charlie, _) => R::from(0.0),
            (_, Masking::Implicit) => mu * mu,
            _ => R::from(1.0),
        }
    }

    /// Whether the albedo grows beyond all bounds as n·v → 0.
    pub fn diverges_at_grazing(self) -> bool {
        self == Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated }
    }

    /// Whether the albedo can exceed 1: where the masking term is not that of the distribution's own microsurface.
    pub fn may_exceed_one(self) -> bool {
        self.ndf == Ndf::Charlie || (self.ndf == Ndf::BlinnPhong && self.masking != Masking::Implicit)
    }

    /// The n·l at which the masking term is not smooth.
    #[inline(always)]
    pub fn break_at<R: Real>(self, alpha: R) -> Option<R> {
        let smith = matches!(self.masking, Masking::HeightCorrelated | Masking::Separable);
        match self.ndf {
            Ndf::BeckmannWalter if smith => Some(alpha.zip(alpha, |alpha, _| beckmann::walter_break(alpha))),
            // The two branches of the fit meet here with the same slope.
            Ndf::Charlie if smith => Some(R::from(0.5)),
            _ => None,
        }
    }
}

//! Reflection models in closed form, with their citations: microfacet lobes (a distribution of
//! normals, a masking term, Fresnel) and diffuse lobes. They know nothing of tables.
//!
//! A specular lobe is f(l, v) = F D G / (4 n·l n·v). Its integrals need it in other parts: the
//! distribution as a density of slopes y = tan(θ_h)/width, which stays smooth as α → 0, and n·l V =
//! G / (4 n·v), which is finite at n·v = 0.

pub mod diffuse;
pub mod fresnel;
pub mod interface;
pub mod masking;
pub mod ndf;

pub use diffuse::Diffuse;
pub use fresnel::Fresnel;
pub use masking::Masking;
pub use ndf::Ndf;

use crate::choice::{Choice, words};
use crate::error::{Error, Result};
use crate::numeric::lanes::{Number, Real};

/// A distribution of normals with its masking term: a specular lobe without Fresnel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Microfacet {
    /// The distribution of normals.
    pub ndf: Ndf,
    /// The masking term.
    pub masking: Masking,
}

impl Microfacet {
    /// Every combination that has a meaning.
    pub fn all() -> impl Iterator<Item = Microfacet> {
        let of = |ndf: Ndf| {
            ndf.definition().maskings.iter().map(move |&masking| Microfacet { ndf, masking })
        };
        Ndf::ALL.iter().copied().flat_map(of)
    }

    /// The distribution with this masking term, or with its default one; an error where the
    /// combination has no meaning.
    pub fn new(ndf: Ndf, masking: Option<Masking>) -> Result<Self> {
        let lobe = Microfacet { ndf, masking: masking.unwrap_or(ndf.default_masking()) };
        lobe.check()?;
        Ok(lobe)
    }

    /// Refuses a masking term that has no meaning for the distribution.
    pub fn check(self) -> Result<()> {
        let definition = self.ndf.definition();
        if definition.maskings.contains(&self.masking) {
            return Ok(());
        }
        let what = format!("masking of {}", self.ndf);
        let cure = definition.why_no_other_masking;
        Err(Error::bad_input(what, words(definition.maskings), self.masking.word(), cure))
    }

    /// Whether a Fresnel model has a meaning for it: the exact equations belong to interfaces, and
    /// sheen is none. Where v lies on the horizon its ring leaves nothing but the layer in which
    /// they change.
    pub fn takes(self, fresnel: Fresnel) -> bool {
        self.ndf.definition().becomes_mirror || fresnel.count() > 1
    }

    /// The projected area c (1 + 2Λ(c)) of the microsurface that the masking term belongs to: see
    /// [`Ndf::projected_area`]. The terms that are not Smith's have none; there it is c.
    #[inline(always)]
    pub fn masking_projected_area<R: Real>(self, c: R, alpha: R) -> R {
        match self.masking {
            Masking::HeightCorrelated | Masking::Separable => self.ndf.projected_area(c, alpha),
            Masking::HeightCorrelatedApprox => masking::approx_projected_area(c, alpha),
            Masking::SchlickSmith | Masking::Implicit | Masking::Neubelt => c,
        }
    }

    /// n·l V(l, v) = G(l, v) / (4 n·v) for n·l = `x` and n·v = `mu`.
    #[inline(always)]
    pub fn cosine_visibility<R: Real>(self, x: R, mu: R, alpha: R) -> R {
        self.cosine_visibility_at(x, mu, self.masking_projected_area(mu, alpha), alpha)
    }

    /// The same with [`Microfacet::masking_projected_area`] of n·v given: a loop over n·l computes
    /// it once.
    #[inline(always)]
    pub fn cosine_visibility_at<R: Real>(self, x: R, mu: R, area_v: R, alpha: R) -> R {
        use masking::{height_correlated, implicit, neubelt, schlick_smith, separable};
        match self.masking {
            Masking::HeightCorrelated | Masking::HeightCorrelatedApprox => {
                height_correlated(x, mu, self.masking_projected_area(x, alpha), area_v)
            }
            Masking::Separable => separable(x, mu, self.masking_projected_area(x, alpha), area_v),
            Masking::SchlickSmith => schlick_smith(x, mu, alpha),
            Masking::Implicit => implicit(x),
            Masking::Neubelt => neubelt(x, mu),
        }
    }

    /// The limit α → 0 of E(F = 1) at fixed n·v, which for a perfect mirror is 1: G of the mirror
    /// direction, or 0 where the distribution does not become a mirror.
    pub fn smooth_limit<R: Number>(self, mu: R) -> R {
        match self.ndf.definition().becomes_mirror {
            true => self.masking.of_mirror(mu),
            false => R::from(0.0),
        }
    }

    /// Whether the albedo grows without bound as n·v → 0.
    pub fn diverges_at_grazing(self) -> bool {
        self == Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated }
    }

    /// Whether the albedo is 0 somewhere: with the implicit term where n·v is, of sheen as it
    /// becomes smooth.
    pub fn fades(self) -> bool {
        self.masking == Masking::Implicit || !self.ndf.definition().becomes_mirror
    }

    /// Whether the albedo can exceed 1, because the masking term is not that of the distribution's
    /// own microsurface.
    pub fn may_exceed_one(self) -> bool {
        !self.ndf.definition().energy_conserving.contains(&self.masking)
    }

    /// Whether the masking term jumps at its break, where Charlie's only bends.
    pub fn jumps(self) -> bool {
        let smith = matches!(self.masking, Masking::HeightCorrelated | Masking::Separable);
        self.ndf == Ndf::BeckmannWalter && smith
    }

    /// The n·l at which the masking term is not smooth, if there is one.
    #[inline(always)]
    pub fn break_at<R: Real>(self, alpha: R) -> Option<R> {
        match self.masking {
            Masking::HeightCorrelated | Masking::Separable => self.ndf.break_at(alpha),
            Masking::HeightCorrelatedApprox
            | Masking::SchlickSmith
            | Masking::Implicit
            | Masking::Neubelt => None,
        }
    }
}

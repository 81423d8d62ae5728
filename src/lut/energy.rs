//! The energy between specular and diffuse reflection: what a specular lobe leaves, and what it
//! loses between its facets.
//!
//! Radiometry: a surface that receives radiance L from everywhere (W m⁻² sr⁻¹) has the irradiance
//! E = π L (W m⁻²), and a BRDF f (sr⁻¹) reflects ∫ f L n·l dω towards v. With L = 1 (the white
//! furnace) that is the directional albedo E(μ) = ∫ f n·l dω. The reflected share of all the light
//! is the average albedo E_avg = 2 ∫ E μ dμ, since the projected solid angle is π in all.
//!
//! *Multiple scattering.* A Smith lobe with F = 1 gives back E(μ) < 1; the rest, 1-E(μ), hits other
//! facets. A reciprocal lobe that returns it has the form f_ms = k (1-E(μ_l))(1-E(μ_v)). Its albedo
//! k (1-E(μ_v)) ∫ (1-E(μ_l)) μ_l dω = k (1-E(μ_v)) π (1-E_avg) has to be 1-E(μ_v), so that
//! k = 1/(π (1-E_avg)) (Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017). Turquin 2019 scales
//! the lobe itself by 1/E at F = 1, and by 1 + F0 (1-E)/E below. Fdez-Agüera 2019 needs A and B
//! alone, which the dfg family holds.
//!
//! *The split.* A specular lobe with F0 reflects S(μ) = F0 A + B. What is left for a white diffuse
//! base is one of three:
//!
//! - (a) 1 - F(μ), as if only the mirror direction reflected;
//! - (b) 1 - S(μ_v), albedo scaling: exact in a furnace, but l and v do not play the same part, so
//!   that it is not reciprocal;
//! - (c) by the argument above with S for E, f_d = (1-S(μ_v))(1-S(μ_l)) / (π (1-S_avg)), which is
//!   both (Shirley et al. 1997; Kelemen and Szirmay-Kalos 2001; Ashikhmin and Shirley 2000
//!   approximate it by polynomials). It is the product of one factor for each direction,
//!   (1-S(μ))/√(1-S_avg), over π: that factor is what a texel holds.

use super::{MOST_CHANNELS, first};
use crate::brdf::fresnel::schlick_complement;
use crate::brdf::{Masking, Microfacet};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::units::F0;

/// A specular lobe with Schlick's Fresnel, its F0, and the numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    lobe: Microfacet,
    f0: F0,
    channels: EnergyChannels,
}

/// The numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EnergyChannels {
    /// (A_avg, B_avg, E_avg), which vary with roughness alone.
    Average,
    /// (E, E_avg), from which Kulla and Conty's lobe is made.
    KullaConty,
    /// (1-E)/E, Turquin's factor for F0 = 1.
    Turquin,
    /// The factor of a diffuse base below a lobe of the given F0: (a), (b), and for either
    /// direction (c).
    Split,
}

choice!(EnergyChannels, "channels", {
    Split = "split", "the diffuse factors 1-F, 1-E, and the reciprocal one for each direction";
    Average = "average", "A, B, E over all directions";
    KullaConty = "kulla-conty", "E, E_avg";
    Turquin = "turquin", "(1-E)/E";
});

impl Energy {
    /// Refuses the lobes for which the numbers have no meaning.
    pub fn new(lobe: Microfacet, f0: F0, channels: EnergyChannels) -> Result<Self> {
        lobe.check()?;
        if channels != EnergyChannels::Average {
            check_leaves_energy(lobe)?;
        }
        if channels == EnergyChannels::Turquin {
            check_scatters(lobe)?;
        }
        if channels == EnergyChannels::Split && f0.get() >= 1.0 {
            let cure = "give an F0 below 1";
            return Err(Error::bad_input(
                "F0",
                "less than 1, which leaves something for a base",
                "1",
                cure,
            ));
        }
        Ok(Energy { lobe, f0, channels })
    }

    /// The specular lobe.
    pub fn lobe(&self) -> Microfacet {
        self.lobe
    }

    /// Its reflectance at normal incidence; only the split depends on it.
    pub fn f0(&self) -> F0 {
        self.f0
    }

    /// The numbers.
    pub fn channels(&self) -> EnergyChannels {
        self.channels
    }

    /// The values of a texel at `mu` with these A and B, on a row with these averages; zeros for
    /// the channels that there are not.
    #[inline(never)]
    pub(super) fn values(
        &self,
        mu: f64,
        integrals: &[Ball],
        averages: &[Ball],
    ) -> [Ball; MOST_CHANNELS] {
        let one = Ball::exact(1.0);
        let e = |of: &[Ball]| of[0] + of[1];
        match self.channels {
            EnergyChannels::Average => first(&[averages[0], averages[1], e(averages)]),
            EnergyChannels::KullaConty => first(&[e(integrals), e(averages)]),
            EnergyChannels::Turquin => first(&[(one - e(integrals)) / e(integrals)]),
            EnergyChannels::Split => {
                let f0 = Ball::exact(self.f0.get());
                let at_f0 = |of: &[Ball]| f0 * of[0] + of[1];
                let left = one - at_f0(integrals);
                // 1 - F = 1 - F0 - (1 - F0) (1 - μ)^5.
                let naive = (one - f0) * schlick_complement(Ball::exact(mu));
                first(&[naive, left, left / (one - at_f0(averages)).sqrt()])
            }
        }
    }
}

/// Refuses a lobe whose albedo can exceed 1: it leaves nothing to give back or to split.
pub fn check_leaves_energy(lobe: Microfacet) -> Result<()> {
    if !lobe.may_exceed_one() {
        return Ok(());
    }
    let (got, cure) =
        (format!("{} with {}", lobe.ndf, lobe.masking), "choose another model or masking");
    Err(Error::bad_input(
        "model",
        "one whose albedo stays below 1, so that it leaves energy",
        got,
        cure,
    ))
}

/// Refuses a masking term whose loss is no multiple scattering: it is all at n·v = 0, and what is
/// scaled by 1/E is 0/0 there.
pub fn check_scatters(lobe: Microfacet) -> Result<()> {
    if lobe.masking != Masking::Implicit {
        return Ok(());
    }
    let expected = "a Smith term: only its loss is multiple scattering";
    let cure = "choose another model or masking";
    Err(Error::bad_input("masking", expected, lobe.masking.word(), cure))
}

impl EnergyChannels {
    /// The channels in order, each with its name and its meaning.
    pub fn list(self) -> &'static [(&'static str, &'static str)] {
        match self {
            EnergyChannels::Average => &[
                ("A_avg", "average of A: 2 * integral of A mu dmu"),
                ("B_avg", "average of B"),
                ("E_avg", "average albedo at F = 1"),
            ],
            EnergyChannels::KullaConty => &[
                ("E", "f_ms = (1-E(l))(1-E(v)) / (pi (1-E_avg))"),
                ("E_avg", "average albedo at F = 1"),
            ],
            EnergyChannels::Turquin => {
                &[("(1-E)/E", "the lobe times 1 + F0 (1-E)/E keeps its energy")]
            }
            EnergyChannels::Split => &[
                ("1-F", "diffuse factor (a): 1 - F(n.v)"),
                ("1-E", "diffuse factor (b): 1 - E(v) at F0"),
                ("R", "diffuse factor (c): R(l) R(v), R = (1-E)/sqrt(1-E_avg) at F0"),
            ],
        }
    }
}

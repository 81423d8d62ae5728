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
//!
//! *Between base and interface.* At the interface to a medium of index n, S is that of the exact
//! equations, and the light that a base of albedo ρ reflects meets the interface from inside, which
//! sends a share K of it back. A base in a furnace sees diffuse radiance L; by reciprocity the
//! share that leaves towards v is (1-S(v))/n², so that on average 1 - K = (1-S_avg)/n², without a
//! table of the inside (Saunderson 1942 for smooth interfaces). Whatever returns meets the base
//! again: what leaves is 1 + ρK + ρ²K² + … = 1/(1-ρK) times what a base that takes no light back
//! would send, and
//!
//! f_d = R(l) R(v) ρ_eff/π, R as in (c), ρ_eff = ρ (1-K)/(1 - ρK).
//!
//! Where ρ = 1, so is ρ_eff. Who has measured the colour from outside, ρ_eff, has a base of
//! ρ = ρ_eff / (1 - K + ρ_eff K): the convention of OpenPBR.

use super::{MOST_CHANNELS, first};
use crate::brdf::fresnel::{Basis, Dielectric, schlick_complement};
use crate::brdf::{Fresnel, Masking, Microfacet};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::units::F0;

/// A specular lobe, what it reflects, and the numbers that a texel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    lobe: Microfacet,
    reflectance: Reflectance,
    channels: EnergyChannels,
}

/// What a lobe above a base reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reflectance {
    /// Schlick's approximation from this F0 on.
    Schlick(F0),
    /// The interface to a medium.
    Interface(Dielectric),
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
        Ok(Energy { lobe, reflectance: Reflectance::Schlick(f0), channels })
    }

    /// The split of energy at the interface to a medium with index of refraction `ior`, 1 to 100.
    pub fn of_interface(lobe: Microfacet, ior: f64) -> Result<Self> {
        let medium = Dielectric::new(ior)?;
        let split = Energy::new(lobe, F0::new(0.0)?, EnergyChannels::Split)?;
        if !lobe.takes(Fresnel::Dielectric(medium)) {
            let (expected, got) = ("one that becomes a mirror, at an interface", lobe.ndf.word());
            return Err(Error::bad_input(
                "model",
                expected,
                got,
                "give an F0 in place of the index",
            ));
        }
        Ok(Energy { reflectance: Reflectance::Interface(medium), ..split })
    }

    /// The specular lobe.
    pub fn lobe(&self) -> Microfacet {
        self.lobe
    }

    /// Its reflectance at normal incidence in Schlick's approximation; only the split depends on
    /// it.
    pub fn f0(&self) -> Option<f64> {
        match self.reflectance {
            Reflectance::Schlick(f0) if self.channels == EnergyChannels::Split => Some(f0.get()),
            Reflectance::Schlick(_) | Reflectance::Interface(_) => None,
        }
    }

    /// The index of refraction of the medium below the interface.
    pub fn ior(&self) -> Option<f64> {
        match self.reflectance {
            Reflectance::Schlick(_) => None,
            Reflectance::Interface(medium) => Some(medium.ior()),
        }
    }

    /// The Fresnel model that is integrated.
    pub fn fresnel(&self) -> Fresnel {
        match self.reflectance {
            Reflectance::Schlick(_) => Fresnel::Schlick,
            Reflectance::Interface(medium) => Fresnel::Dielectric(medium),
        }
    }

    /// The channels in order, each with its name and its meaning.
    pub(super) fn list(&self) -> &'static [(&'static str, &'static str)] {
        match self.reflectance {
            Reflectance::Schlick(_) => self.channels.list(),
            Reflectance::Interface(_) => AT_INTERFACE,
        }
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
            EnergyChannels::Split => match self.reflectance {
                Reflectance::Schlick(f0) => {
                    let f0 = Ball::exact(f0.get());
                    let at_f0 = |of: &[Ball]| f0 * of[0] + of[1];
                    let left = one - at_f0(integrals);
                    // 1 - F = 1 - F0 - (1 - F0) (1 - μ)^5.
                    let naive = (one - f0) * schlick_complement(Ball::exact(mu));
                    first(&[naive, left, left / (one - at_f0(averages)).sqrt()])
                }
                Reflectance::Interface(medium) => {
                    let (left, on_average) = (one - integrals[0], one - averages[0]);
                    let [f] = medium.of_mirror(mu);
                    let n = Ball::exact(medium.ior());
                    let back = one - on_average / (n * n);
                    first(&[one - f, left, left / on_average.sqrt(), back])
                }
            },
        }
    }
}

/// The split at an interface.
const AT_INTERFACE: &[(&str, &str)] = &[
    ("1-F", "diffuse factor (a): 1 - F(n.v)"),
    ("1-S", "diffuse factor (b): 1 - S(v), S being the albedo of the interface"),
    ("R", "diffuse factor (c): R(l) R(v), R = (1-S)/sqrt(1-S_avg)"),
    (
        "K",
        "share of diffuse light that the interface reflects back to a base of albedo rho, whose \
           factor is rho (1-K)/(1 - rho K): 1 - (1-S_avg)/n^2",
    ),
];

/// The albedo that a base of albedo `rho` has below an interface that reflects a share `k` of its
/// light back: ρ (1-K)/(1 - ρK) (Saunderson 1942).
pub fn effective_albedo(rho: f64, k: f64) -> f64 {
    rho * (1.0 - k) / (1.0 - rho * k)
}

/// The albedo of the base whose effective albedo this is: the inverse of [`effective_albedo`].
pub fn base_albedo(effective: f64, k: f64) -> f64 {
    effective / (1.0 - k + effective * k)
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

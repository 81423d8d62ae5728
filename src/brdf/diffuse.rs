//! Diffuse lobes by their directional albedos for a white surface, in closed form.
//!
//! μ = n·v, r the lobe's own roughness parameter in [0, 1].

use super::fresnel::schlick_weight;
use crate::choice::choice;
use crate::numeric::special::arc_cosine;
use std::f64::consts::PI;

/// A diffuse lobe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diffuse {
    /// Lambert 1760.
    Lambert,
    /// Burley 2012 ("Disney diffuse").
    Burley,
    /// Oren and Nayar 1994, the qualitative model.
    OrenNayar,
    /// The single scattering of EON (Portsmouth, Kutz and Hill 2025).
    Eon,
    /// Lambert darkened by roughness, as Unity HDRP has it for fabric.
    FabricLambert,
}

choice!(Diffuse, "model", {
    Lambert = "lambert", "the same in every direction (Lambert 1760)";
    Burley = "burley", "Disney's diffuse lobe (Burley 2012)";
    OrenNayar = "oren-nayar", "rough Lambertian facets, the qualitative model (Oren and Nayar \
                               1994)";
    Eon = "eon", "the single scattering of EON (Portsmouth, Kutz and Hill 2025)";
    FabricLambert = "fabric-lambert", "(1 - r^2/2)/pi, of fabric in Unity HDRP";
});

impl Diffuse {
    /// The directional albedo of a white surface with the roughness `r`.
    pub fn albedo(self, mu: f64, r: f64) -> f64 {
        debug_assert!((0.0..=1.0).contains(&mu) && r >= 0.0, "{mu}, {r}");
        match self {
            Diffuse::Lambert => lambert_albedo(),
            Diffuse::Burley => burley_albedo(mu, r),
            Diffuse::OrenNayar => oren_nayar_albedo(mu, r),
            Diffuse::Eon => eon_albedo(mu, r),
            Diffuse::FabricLambert => fabric_lambert_albedo(r),
        }
    }

    /// The lobe's own roughness, for the metadata.
    pub fn roughness(self) -> &'static str {
        match self {
            Diffuse::Lambert => "none: the lobe has no roughness",
            Diffuse::Burley => "perceptual roughness r (f90 = 1/2 + 2 r cos^2 theta_d)",
            Diffuse::OrenNayar => "sigma in radians",
            Diffuse::Eon => "r of EON",
            Diffuse::FabricLambert => "perceptual roughness r",
        }
    }

    /// The lobe's definition, for the metadata.
    pub fn source(self) -> &'static str {
        match self {
            Diffuse::Lambert => "f = 1/pi (Lambert 1760)",
            Diffuse::Burley => "f of Burley 2012, Physically Based Shading at Disney",
            Diffuse::OrenNayar => "f of Oren and Nayar 1994, the qualitative model",
            Diffuse::Eon => "f of the single scattering of EON (Portsmouth, Kutz and Hill 2025)",
            Diffuse::FabricLambert => "f = (1 - r^2/2)/pi (Unity HDRP, FabricLambert)",
        }
    }
}

/// Lambert 1760: f = 1/π, E = 1.
pub fn lambert_albedo() -> f64 {
    1.0
}

/// Burley 2012, "Physically Based Shading at Disney", perceptual roughness r: f = (1 +
/// (f90-1)(1-n·l)^5)(1 + (f90-1)(1-n·v)^5)/π, f90 = 1/2 + 2 r cos²θ_d. It loses energy where smooth
/// (41/42 at normal incidence) and makes some where rough (1.56 at grazing).
pub fn burley_albedo(mu: f64, r: f64) -> f64 {
    let (h, v) = (r - 0.5, schlick_weight(mu));
    let light = 0.5 + h / 42.0 + r * mu / 168.0;
    let view = v * (0.5 * h + r * mu / 3.0);
    let both = v
        * (h * h / 42.0
            + h * r * mu / 84.0
            + r * r * (mu * mu / 504.0 + 11.0 * (1.0 - mu) * (1.0 + mu) / 1008.0));
    2.0 * (light + view + both)
}

/// Oren and Nayar 1994, the qualitative model, with σ = r radians: A = 1 - σ²/(2(σ²+0.33)), B =
/// 0.45 σ²/(σ²+0.09). It exceeds 1 by 1 % at grazing angles and small σ.
pub fn oren_nayar_albedo(mu: f64, r: f64) -> f64 {
    let s2 = r * r;
    let (a, b) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let forward = mu * (1.0 + sv * (1.0 + sv)) / (3.0 * (1.0 + sv));
    a + 2.0 * b * sv / PI * (forward + 0.5 * (arc_cosine(mu) - sv * mu))
}

/// Unity HDRP's fabric: f = (1 + (1/2 - 1) α)/π with α = r², E = 1 - r²/2.
pub fn fabric_lambert_albedo(r: f64) -> f64 {
    1.0 - 0.5 * r * r
}

/// The single scattering of EON, which is Fujii's Oren-Nayar (Portsmouth, Kutz and Hill 2025): what
/// it loses, EON's second lobe gives back, so that EON with both is white.
pub fn eon_albedo(mu: f64, r: f64) -> f64 {
    let sv = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let forward = 2.0 / 3.0 * sv * mu * (1.0 + sv * (1.0 + sv)) / (1.0 + sv);
    let g = sv * (arc_cosine(mu) - sv * mu - 2.0 / 3.0) + forward;
    (1.0 + r / PI * g) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r)
}

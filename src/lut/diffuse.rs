//! The directional albedo of a white diffuse lobe: how much of a furnace's light it gives back, and how much it should not.

use crate::model::Diffuse;
use crate::table::Channel;

/// The channel of a texel.
pub const ALBEDO: Channel =
    Channel { name: "E", meaning: "directional albedo of a white surface: integral of f(l,v) n.l" };

/// What a roughness means to the lobe.
pub fn roughness(model: Diffuse) -> &'static str {
    match model {
        Diffuse::Lambert => "none: the lobe has no roughness",
        Diffuse::Burley => "perceptual roughness r (f90 = 1/2 + 2 r cos^2 theta_d)",
        Diffuse::OrenNayar => "sigma in radians",
        Diffuse::Eon => "r of EON",
    }
}

/// Where the lobe comes from.
pub fn source(model: Diffuse) -> &'static str {
    match model {
        Diffuse::Lambert => "f = 1/pi (Lambert 1760)",
        Diffuse::Burley => "f of Burley 2012, Physically Based Shading at Disney",
        Diffuse::OrenNayar => "f of Oren and Nayar 1994, the qualitative model",
        Diffuse::Eon => "f of the single scattering of EON (Portsmouth, Kutz and Hill 2025)",
    }
}

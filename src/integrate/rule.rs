//! A quadrature rule: its method, and the lobes that it serves for.

pub use super::bounds::{CHARLIE_LIMIT, MARGIN};

use super::Integrand;
use super::bounds::{Bound, Columns};
use super::double_exponential::DoubleExponentialRule;
use super::glass::GlassRule;
use super::half_vectors::HalfVectorRule;
use super::interpolant::InterpolantRule;
use super::light_directions::LightDirectionRule;
use crate::brdf::{Fresnel, Masking, Microfacet, Ndf};

/// The method of a rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over half vectors: any lobe, CPU and device.
    HalfVectors(HalfVectorRule),
    /// Over directions of light, the azimuth in closed form: GGX, CPU.
    LightDirections(LightDirectionRule),
    /// Double exponential: any lobe, CPU.
    DoubleExponential(DoubleExponentialRule),
    /// Interpolated between integrals: GGX with three masking terms, CPU.
    Interpolant(InterpolantRule),
    /// Over half vectors with pieces at the critical angle: glass, CPU and device.
    Glass(GlassRule),
    /// No quadrature: diffuse lobes.
    ClosedForm,
}

/// A rule. Its bounds stand in [`super::bounds`].
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Its word on the command line.
    pub name: &'static str,
    /// Its method.
    pub method: Method,
    /// Its column of the bounds.
    pub(super) column: fn(&Columns) -> Bound,
    /// A promise in place of the bounds: see [`Rule::promising`].
    pub(super) promised: Option<f64>,
}

impl PartialEq for Rule {
    fn eq(&self, other: &Rule) -> bool {
        (self.name, self.method, self.promised) == (other.name, other.method, other.promised)
    }
}

impl Rule {
    /// Whether a device can run it.
    pub fn runs_on_device(&self) -> bool {
        match self.method {
            Method::HalfVectors(_) => true,
            Method::Glass(rule) => rule.fits_f32(),
            Method::LightDirections(_)
            | Method::DoubleExponential(_)
            | Method::Interpolant(_)
            | Method::ClosedForm => false,
        }
    }

    /// Whether it serves for an integrand: a list of what each method was made and measured for.
    pub fn applies_to(&self, integrand: impl Into<Integrand>) -> bool {
        match (self.method, integrand.into()) {
            (Method::ClosedForm, Integrand::Diffuse(_)) => true,
            (Method::Glass(_), Integrand::Glass(_)) => true,
            // In polar coordinates about v.
            (Method::DoubleExponential(_), Integrand::Glass(_)) => self.is_reference(),
            (Method::ClosedForm | Method::Glass(_), _)
            | (_, Integrand::Diffuse(_) | Integrand::Glass(_)) => false,
            (Method::LightDirections(_), Integrand::Specular(lobe, fresnel)) => {
                light_directions_serve(lobe) && has_smooth_complement(fresnel)
            }
            (Method::Interpolant(_), Integrand::Specular(lobe, fresnel)) => {
                interpolants_serve(lobe) && has_smooth_complement(fresnel)
            }
            (
                Method::HalfVectors(_) | Method::DoubleExponential(_),
                Integrand::Specular(lobe, fresnel),
            ) => visibility_knows_no_azimuth(lobe) && lobe.takes(fresnel),
        }
    }

    /// The same rule promising at most `bound` for every lobe and integral, for tests of what
    /// guards bounds.
    pub fn promising(self, bound: f64) -> Rule {
        Rule { promised: Some(bound), ..self }
    }
}

/// The rules over directions of light take A from E and B, and their nodes for the azimuth are
/// those that (1 - v·h)⁵ needs.
fn has_smooth_complement(fresnel: Fresnel) -> bool {
    match fresnel {
        Fresnel::Schlick | Fresnel::SchlickF82 => true,
        Fresnel::SchlickPower(_) | Fresnel::Dielectric(_) | Fresnel::Conductor(_) => false,
    }
}

/// The rules over directions of light have the azimuth of GGX in closed form, and subtract the
/// layer of the height-correlated term, which its approximation has in another form.
fn light_directions_serve(lobe: Microfacet) -> bool {
    match lobe.ndf {
        Ndf::Ggx => match lobe.masking {
            Masking::HeightCorrelated
            | Masking::Separable
            | Masking::SchlickSmith
            | Masking::Implicit => true,
            Masking::HeightCorrelatedApprox | Masking::Neubelt => false,
        },
        Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong | Ndf::Charlie => false,
    }
}

/// The interpolants follow what those rules integrate, but for the implicit term, whose albedo
/// falls with μ².
fn interpolants_serve(lobe: Microfacet) -> bool {
    let followed = match lobe.masking {
        Masking::HeightCorrelated | Masking::Separable | Masking::SchlickSmith => true,
        Masking::HeightCorrelatedApprox | Masking::Implicit | Masking::Neubelt => false,
    };
    followed && light_directions_serve(lobe)
}

/// The other rules take every term that depends on n·l and n·v alone: the double exponential ones
/// take it out of the integral over the azimuth, and those over half vectors know no other.
fn visibility_knows_no_azimuth(lobe: Microfacet) -> bool {
    match lobe.masking {
        Masking::HeightCorrelated
        | Masking::Separable
        | Masking::SchlickSmith
        | Masking::HeightCorrelatedApprox
        | Masking::Implicit
        | Masking::Neubelt => true,
    }
}

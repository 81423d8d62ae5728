//! A quadrature rule: its method, and the lobes that it serves for.

pub use super::bounds::{CHARLIE_LIMIT, CHARLIE_UNKNOWN, GRAZING, MARGIN};

use super::Integrand;
use super::bent_rings::BentRingRule;
use super::bounds::{Bound, Columns};
use super::double_exponential::DoubleExponentialRule;
use super::glass::GlassRule;
use super::half_vectors::HalfVectorRule;
use super::interpolant::InterpolantRule;
use super::light_directions::LightDirectionRule;
use super::light_planes::LightPlaneRule;
use super::rings::RingRule;
use crate::brdf::{Masking, Microfacet, Ndf};

/// The method of a rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over half vectors: any lobe, CPU and device; with crowded slopes Blinn-Phong with the
    /// implicit term, CPU.
    HalfVectors(HalfVectorRule),
    /// Over directions of light, the azimuth in closed form: GGX, CPU.
    LightDirections(LightDirectionRule),
    /// Over directions of light, a lobe that ends: Beckmann and Blinn-Phong, CPU.
    LightPlanes(LightPlaneRule),
    /// Over half vectors about a ring at the horizon: Charlie, CPU.
    Rings(RingRule),
    /// The same with a bend of the masking term: Charlie with its fitted term, CPU.
    BentRings(BentRingRule),
    /// Double exponential: any lobe, CPU.
    DoubleExponential(DoubleExponentialRule),
    /// Interpolated between integrals: every lobe, CPU.
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
            // What crowding gains is less than f32 resolves.
            Method::HalfVectors(rule) => !rule.crowded,
            Method::Glass(rule) => rule.fits_f32(),
            Method::LightDirections(_)
            | Method::LightPlanes(_)
            | Method::Rings(_)
            | Method::BentRings(_)
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
                lobe.ndf == Ndf::Ggx && fresnel.definition().smooth_complement
            }
            (Method::LightPlanes(_), Integrand::Specular(lobe, fresnel)) => {
                ends_like_gaussian(lobe.ndf) && fresnel.definition().smooth_complement
            }
            (Method::Rings(_), Integrand::Specular(lobe, fresnel)) => {
                lobe.ndf == Ndf::Charlie
                    && !lobe.diverges_at_grazing()
                    && fresnel.definition().smooth_complement
            }
            (Method::BentRings(_), Integrand::Specular(lobe, fresnel)) => {
                lobe.diverges_at_grazing() && fresnel.definition().smooth_complement
            }
            (Method::Interpolant(rule), Integrand::Specular(lobe, fresnel)) => {
                interpolant_serves(&rule, lobe) && fresnel.definition().smooth_complement
            }
            (Method::HalfVectors(rule), Integrand::Specular(lobe, fresnel)) if rule.crowded => {
                lobe.ndf == Ndf::BlinnPhong
                    && lobe.masking == Masking::Implicit
                    && fresnel.definition().smooth_complement
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

/// The rules over planes of light directions cut slopes off where a Gaussian ends.
fn ends_like_gaussian(ndf: Ndf) -> bool {
    match ndf {
        Ndf::Beckmann | Ndf::BeckmannWalter | Ndf::BlinnPhong => true,
        Ndf::Ggx | Ndf::Charlie => false,
    }
}

fn interpolant_serves(rule: &InterpolantRule, lobe: Microfacet) -> bool {
    rule.distributions.contains(&lobe.ndf) && rule.maskings.contains(&lobe.masking)
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

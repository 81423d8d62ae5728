//! The cost of a rule, by which the cheapest is chosen.

use super::Integrand;
use super::rule::{Method, Rule};
use crate::brdf::{Masking, Microfacet, Ndf};

/// Nanoseconds for an evaluation of the integrand on one thread of a server processor with AVX-512
/// (that of BENCHMARKS.md). The ratios decide between rules; the sums decide whether a device pays.
struct Costs {
    /// Over half vectors; with Smith's term, which is taken at every evaluation there, and with
    /// another.
    half_vectors: f64,
    half_vectors_without_smith: f64,
    /// Double exponential.
    double_exponential: f64,
    /// By the distribution's own method: over directions of light, over planes of them, about a
    /// ring.
    own: f64,
}

const fn costs(ndf: Ndf) -> Costs {
    let [half_vectors, half_vectors_without_smith, double_exponential, own] = match ndf {
        Ndf::Ggx => [3.4, 3.4, 2.8, 1.1],
        Ndf::Beckmann => [12.0, 3.7, 4.2, 4.3],
        // As many nodes again on the other side of the jump.
        Ndf::BeckmannWalter => [7.0, 7.0, 6.2, 8.0],
        Ndf::BlinnPhong => [12.0, 3.7, 7.0, 7.0],
        Ndf::Charlie => [19.0, 4.0, 15.0, 3.7],
    };
    Costs { half_vectors, half_vectors_without_smith, double_exponential, own }
}

/// Nanoseconds for a term of a polynomial in n·v.
const POLYNOMIAL_TERM: f64 = 0.5;

/// Nanoseconds for an evaluation of glass.
const GLASS: f64 = 10.0;

/// Nanoseconds for a diffuse lobe's closed form.
const CLOSED_FORM: f64 = 50.0;

impl Rule {
    /// Evaluations of the integrand for a table of `texels`; of the double exponential rules for a
    /// lobe without breaks.
    pub fn evaluations(&self, texels: usize) -> usize {
        match self.method {
            Method::HalfVectors(rule) => texels * rule.evaluations(),
            Method::LightDirections(rule) => texels * rule.evaluations(),
            Method::LightPlanes(rule) => texels * rule.evaluations(),
            Method::Rings(rule) => texels * rule.evaluations(),
            Method::BentRings(rule) => texels * rule.evaluations(),
            Method::DoubleExponential(rule) => texels * rule.evaluations(),
            Method::Interpolant(rule) => rule.evaluations(),
            Method::Glass(rule) => texels * rule.evaluations(),
            Method::ClosedForm => texels,
        }
    }

    /// The approximate time that a table of `texels` takes on one thread.
    pub fn seconds(&self, integrand: impl Into<Integrand>, texels: usize) -> f64 {
        let lobe = match integrand.into() {
            Integrand::Specular(lobe, _) => lobe,
            Integrand::Diffuse(_) => return 1e-9 * CLOSED_FORM * texels as f64,
            Integrand::Glass(_) => return 1e-9 * GLASS * self.evaluations(texels) as f64,
        };
        let costs = costs(lobe.ndf);
        let evaluation = match self.method {
            Method::HalfVectors(_) if has_smith(lobe) => costs.half_vectors,
            Method::HalfVectors(_) => costs.half_vectors_without_smith,
            Method::DoubleExponential(_) => costs.double_exponential,
            Method::LightDirections(_)
            | Method::LightPlanes(_)
            | Method::Rings(_)
            | Method::BentRings(_)
            | Method::Interpolant(_)
            | Method::Glass(_)
            | Method::ClosedForm => costs.own,
        };
        let polynomials = match self.method {
            Method::Interpolant(rule) => POLYNOMIAL_TERM * (rule.directions() * texels) as f64,
            Method::HalfVectors(_)
            | Method::LightDirections(_)
            | Method::LightPlanes(_)
            | Method::Rings(_)
            | Method::BentRings(_)
            | Method::DoubleExponential(_)
            | Method::Glass(_)
            | Method::ClosedForm => 0.0,
        };
        1e-9 * (evaluation * self.evaluations(texels) as f64 + polynomials)
    }
}

fn has_smith(lobe: Microfacet) -> bool {
    match lobe.masking {
        Masking::HeightCorrelated | Masking::Separable => true,
        Masking::HeightCorrelatedApprox
        | Masking::SchlickSmith
        | Masking::Implicit
        | Masking::Neubelt => false,
    }
}

//! The quadrature rules by name, each with the bound of its error: what a tolerance picks from.

use super::h_space::{HSpaceNodes, HSpaceRule, h_space};
use super::l_space::{LSpaceNodes, LSpaceRule, l_space, l_space_applies};
use super::reference::{ReferenceNodes, ReferenceRule, reference};
use super::{Integrand, ScaleBias};
use crate::error::{Error, Result};
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::slope_map::Power;

/// How a rule integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Over half vectors: any lobe, CPU and device.
    HSpace(HSpaceRule),
    /// Over directions of light, the azimuth in closed form: GGX, CPU.
    LSpace(LSpaceRule),
    /// Double exponential: any lobe, CPU.
    Reference(ReferenceRule),
    /// No quadrature: diffuse lobes.
    ClosedForm,
}

/// A rule and what it promises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// What `--rule` calls it.
    pub name: &'static str,
    /// How it integrates.
    pub method: Method,
    /// What it promises for each distribution, in the order of [`Ndf::ALL`]; infinite where it does not apply.
    bounds: [f64; Ndf::ALL.len()],
}

/// What f32 arithmetic may add to a rule's error on a device: 9e-7 (8e-7 were measured with correctly rounded ÷ and √).
/// Charlie with its fitted Λ keeps that down to roughness 1e-3; at 1e-8, where only a tail of its ring is seen, 1.5e-6 were
/// measured.
pub fn f32_arithmetic(integrand: impl Into<Integrand>) -> f64 {
    match integrand.into() {
        Integrand::Specular(Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated }) => 2e-6,
        _ => 9e-7,
    }
}

/// All rules, the ones that a tolerance picks from in order of cost.
///
/// The bounds were measured against the reference on 40,000 points (GGX) or 3,000 points (the others) crowded towards every
/// edge, for every masking, then rounded up by a third or more; `tests/quadrature.rs` repeats it. Walter's Λ jumps, which no
/// rule over half vectors resolves. Below r = 0.07 Charlie's ring lies so near the horizon that the reference itself keeps
/// only 2e-6; above, it keeps 1e-13.
pub const RULES: [Rule; 13] = [
    Rule { name: "closed-form", method: Method::ClosedForm, bounds: [f64::INFINITY; Ndf::ALL.len()] },
    h("h56", [8, 3, 8, 4], Power::Two, [1e-3, 2e-3, 3e-3, 2e-2, 4e-2]),
    h("h130", [12, 5, 14, 5], Power::Four, [1e-4, 1e-4, 5e-4, 1e-3, 2e-2]),
    h("h288", [16, 8, 20, 8], Power::Four, [1e-5, 1e-5, 1.5e-4, 4e-5, 3e-3]),
    h("h640", [32, 10, 32, 10], Power::Four, [1e-6, 1e-6, 6e-5, 3e-6, 5e-5]),
    h("h1536", [48, 16, 48, 16], Power::Four, [1e-7, 1e-7, 1.2e-5, 1e-7, 4e-6]),
    h("h2144", [64, 16, 56, 20], Power::Four, [4e-8, 1e-8, 6e-6, 8e-8, 3.5e-6]),
    h("h6144", [96, 32, 96, 32], Power::Four, [3e-9, 5e-10, 2e-6, 1e-9, 3e-6]),
    reference_rule(160, 150),
    l("l128", [16, 8], Power::Two, 5e-4),
    l("l512", [32, 16], Power::Two, 1e-5),
    l("l1536", [64, 24], Power::Four, 2e-6),
    l("l6144", [128, 48], Power::Four, 1e-7),
];

/// The rule that tables are measured against.
pub const REFERENCE: Rule = RULES[8];

/// The rule that tables by [`REFERENCE`] itself are measured against.
const FINER_REFERENCE: Rule = reference_rule(240, 220);

const fn h(name: &'static str, nodes: [usize; 4], power: Power, bounds: [f64; Ndf::ALL.len()]) -> Rule {
    let [radial, azimuth, radial_horizon, azimuth_horizon] = nodes;
    let rule = HSpaceRule { radial, azimuth, radial_horizon, azimuth_horizon, power };
    Rule { name, method: Method::HSpace(rule), bounds }
}

const fn l(name: &'static str, nodes: [usize; 2], power: Power, bound: f64) -> Rule {
    let none = f64::INFINITY;
    let rule = LSpaceRule { slope: nodes[0], azimuth: nodes[1], power };
    Rule { name, method: Method::LSpace(rule), bounds: [bound, none, none, none, none] }
}

const fn reference_rule(outer: usize, inner: usize) -> Rule {
    let bounds = [1e-13, 1e-13, 1e-13, 1e-13, 2e-6];
    Rule { name: "reference", method: Method::Reference(ReferenceRule { outer, inner }), bounds }
}

impl Rule {
    /// The rule called `name`.
    pub fn named(name: &str) -> Result<Rule> {
        let known = || RULES.map(|rule| rule.name).join(", ");
        RULES.into_iter().find(|rule| rule.name == name).ok_or_else(|| {
            Error::bad_input("rule", format!("one of {}", known()), format!("'{name}'"), "name one of these")
        })
    }

    /// The cheapest rule whose error stays within `tolerance` when the arithmetic may add `arithmetic`.
    pub fn for_tolerance(integrand: impl Into<Integrand>, tolerance: f64, arithmetic: f64) -> Option<Rule> {
        let integrand = integrand.into();
        let serves = |rule: &Rule| rule.applies_to(integrand) && rule.bound(integrand) + arithmetic <= tolerance;
        RULES[..9].iter().copied().find(serves)
    }

    /// The largest error of A and of B over the whole domain, in exact arithmetic: absolute, or of albedos above 1 relative.
    pub fn bound(&self, integrand: impl Into<Integrand>) -> f64 {
        match integrand.into() {
            Integrand::Specular(lobe) => self.bounds[lobe.ndf as usize],
            Integrand::Diffuse(_) if self.method == Method::ClosedForm => 1e-15,
            Integrand::Diffuse(_) => f64::INFINITY,
        }
    }

    /// The smallest tolerance that f32 on a device keeps.
    pub fn device_tolerance(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        let bounds = RULES.iter().filter(|rule| rule.runs_on_device()).map(|rule| rule.bound(integrand));
        bounds.fold(f64::INFINITY, f64::min) + f32_arithmetic(integrand)
    }

    /// The smallest error that any rule promises.
    pub fn sharpest_bound(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        RULES.iter().map(|rule| rule.bound(integrand)).fold(f64::INFINITY, f64::min)
    }

    /// Evaluations of the integrand for a texel; none are counted for the reference.
    pub fn evaluations(&self) -> Option<usize> {
        match self.method {
            Method::HSpace(rule) => Some(rule.evaluations()),
            Method::LSpace(rule) => Some(rule.evaluations()),
            Method::Reference(_) => None,
            Method::ClosedForm => Some(1),
        }
    }

    /// Whether a device can run it.
    pub fn runs_on_device(&self) -> bool {
        matches!(self.method, Method::HSpace(_) | Method::ClosedForm)
    }

    /// Whether it serves for an integrand.
    pub fn applies_to(&self, integrand: impl Into<Integrand>) -> bool {
        match (self.method, integrand.into()) {
            (Method::ClosedForm, Integrand::Diffuse(_)) => true,
            (Method::ClosedForm, _) | (_, Integrand::Diffuse(_)) => false,
            (Method::LSpace(_), Integrand::Specular(lobe)) => l_space_applies(lobe),
            _ => true,
        }
    }

    /// The rule that a table by this one is measured against.
    pub fn yardstick(&self) -> Rule {
        match self.method {
            Method::ClosedForm => *self,
            Method::Reference(_) => FINER_REFERENCE,
            _ => REFERENCE,
        }
    }

    /// The rule with its nodes worked out, ready to integrate.
    pub fn integrator(&self) -> Integrator {
        match self.method {
            Method::HSpace(rule) => Integrator::HSpace(rule.nodes()),
            Method::LSpace(rule) => Integrator::LSpace(rule.nodes()),
            Method::Reference(rule) => Integrator::Reference(rule.nodes()),
            Method::ClosedForm => Integrator::ClosedForm,
        }
    }
}

/// The nodes of a rule.
#[derive(Clone, Debug)]
pub enum Integrator {
    /// Of the half-vector rules.
    HSpace(HSpaceNodes),
    /// Of the light-direction rules.
    LSpace(LSpaceNodes),
    /// Of the reference.
    Reference(ReferenceNodes),
    /// None.
    ClosedForm,
}

impl Integrator {
    /// (A, B) at n·v = `mu` and `alpha`, both in [0, 1]; α = 0 is the limit of a mirror, also at n·v = 0. NaN where the rule
    /// does not apply.
    pub fn integrate(&self, integrand: impl Into<Integrand>, mu: f64, alpha: f64) -> ScaleBias {
        let lobe = match integrand.into() {
            Integrand::Diffuse(diffuse) => return ScaleBias { a: diffuse.albedo(mu, alpha.sqrt()), b: 0.0 },
            Integrand::Specular(lobe) => lobe,
        };
        if alpha == 0.0 {
            return ScaleBias::mirror(mu, lobe.smooth_limit(mu));
        }
        match self {
            Integrator::HSpace(nodes) => h_space(lobe, mu, alpha, nodes),
            Integrator::LSpace(nodes) => l_space(lobe, mu, alpha, nodes),
            Integrator::Reference(nodes) => reference(lobe, mu, alpha, nodes),
            Integrator::ClosedForm => ScaleBias { a: f64::NAN, b: f64::NAN },
        }
    }
}

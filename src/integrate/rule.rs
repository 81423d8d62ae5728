//! The quadrature rules by name, each with the bound of its error: what a tolerance picks from.

use super::h_space::{HSpaceNodes, HSpaceRule, h_space};
use super::l_space::{LSpaceNodes, LSpaceRule, l_space, l_space_applies};
use super::reference::{ReferenceNodes, ReferenceRule, reference};
use super::surrogate::SurrogateRule;
use super::{Integrand, ScaleBias};
use crate::error::{Error, Result};
use crate::lanes::{Lanes, Real, WIDTH};
use crate::model::{Masking, Microfacet, Ndf};
use crate::quadrature::slope_map::Power;

/// How a rule integrates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Over half vectors: any lobe, CPU and device.
    HSpace(HSpaceRule),
    /// Over directions of light, the azimuth in closed form: GGX, CPU.
    LSpace(LSpaceRule),
    /// Double exponential: any lobe, CPU.
    Reference(ReferenceRule),
    /// Interpolated between integrals: GGX with three maskings, CPU.
    Surrogate(SurrogateRule),
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
    /// What it promises of B besides, for every decade of it: at most `.0` B + `.1`.
    bound_of_b: (f64, f64),
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

/// Where Charlie's ring lies so near the horizon that the reference keeps 2e-6 only: below this α, r = 0.07.
pub const CHARLIE_LIMIT: f64 = 0.0049;

/// All rules.
///
/// The bounds were measured against the reference on 8,000 to 40,000 points crowded towards every edge, for every masking,
/// then rounded up by a third or more; `tests/quadrature.rs` repeats it, and `tests/coverage.rs` on a million. Walter's Λ
/// jumps, which no rule over half vectors resolves. Charlie's columns hold over its whole domain, and the reference's 1e-13
/// above [`CHARLIE_LIMIT`] alone ([`Rule::errors_at`]).
pub const RULES: [Rule; 15] = [
    Rule {
        name: "closed-form",
        method: Method::ClosedForm,
        bounds: [f64::INFINITY; Ndf::ALL.len()],
        bound_of_b: (1.0, 0.0),
    },
    h("h56", [8, 3, 8, 4], Power::Two, [1e-3, 2e-3, 3e-3, 2e-2, 4e-2]),
    h("h130", [12, 5, 14, 5], Power::Four, [1e-4, 1e-4, 5e-4, 1e-3, 2e-2]),
    h("h288", [16, 8, 20, 8], Power::Four, [1e-5, 1e-5, 1.5e-4, 4e-5, 3e-3]),
    h("h640", [32, 10, 32, 10], Power::Four, [1e-6, 1e-6, 6e-5, 3e-6, 5e-5]),
    h("h1536", [48, 16, 48, 16], Power::Four, [1e-7, 1e-7, 1.2e-5, 1e-7, 4e-6]),
    h("h6144", [96, 32, 96, 32], Power::Four, [3e-9, 5e-10, 2e-6, 1e-9, 3e-6]),
    d("d6144", [64, 48], [5e-7, 5e-7, 5e-7, 5e-7, f64::INFINITY], (1e-6, 1e-12)),
    d("d10240", [80, 64], [6e-9, 6e-9, 6e-9, 6e-9, f64::INFINITY], (4e-8, 1e-12)),
    d("reference", [160, 150], [1e-13, 1e-13, 1e-13, 1e-13, 2e-6], (3e-12, 3e-24)),
    l("l288", L288, 3e-5, (1.0, 0.0)),
    l("l512", L512, 8e-6, (1.0, 0.0)),
    l("l4608", L4608, 5e-9, (8e-8, 1e-12)),
    s("s640", [32, 20], Power::Two, L512, 8e-6, (1.0, 0.0)),
    s("s2304", [64, 36], Power::Four, L4608, 3e-8, (8e-8, 3e-11)),
];

const L288: LSpaceRule = LSpaceRule { slope: 24, azimuth: 12, power: Power::Two };
const L512: LSpaceRule = LSpaceRule { slope: 32, azimuth: 16, power: Power::Two };
const L4608: LSpaceRule = LSpaceRule { slope: 96, azimuth: 48, power: Power::Four };

/// The rule that tables are measured against.
pub const REFERENCE: Rule = RULES[9];

/// The rule that tables by [`REFERENCE`] itself are measured against.
const FINER_REFERENCE: Rule = d("reference", [240, 220], [1e-13, 1e-13, 1e-13, 1e-13, 2e-6], (3e-12, 3e-24));

const fn h(name: &'static str, nodes: [usize; 4], power: Power, bounds: [f64; Ndf::ALL.len()]) -> Rule {
    let [radial, azimuth, radial_horizon, azimuth_horizon] = nodes;
    let rule = HSpaceRule { radial, azimuth, radial_horizon, azimuth_horizon, power };
    Rule { name, method: Method::HSpace(rule), bounds, bound_of_b: (1.0, 0.0) }
}

const fn l(name: &'static str, rule: LSpaceRule, bound: f64, bound_of_b: (f64, f64)) -> Rule {
    Rule { name, method: Method::LSpace(rule), bounds: ggx_alone(bound), bound_of_b }
}

const fn s(
    name: &'static str,
    nodes: [usize; 2],
    power: Power,
    source: LSpaceRule,
    bound: f64,
    bound_of_b: (f64, f64),
) -> Rule {
    let rule = SurrogateRule { directions: nodes[0], roughnesses: nodes[1], power, source };
    Rule { name, method: Method::Surrogate(rule), bounds: ggx_alone(bound), bound_of_b }
}

const fn ggx_alone(bound: f64) -> [f64; Ndf::ALL.len()] {
    let none = f64::INFINITY;
    [bound, none, none, none, none]
}

const fn d(name: &'static str, nodes: [usize; 2], bounds: [f64; Ndf::ALL.len()], bound_of_b: (f64, f64)) -> Rule {
    let rule = ReferenceRule { outer: nodes[0], inner: nodes[1] };
    Rule { name, method: Method::Reference(rule), bounds, bound_of_b }
}

impl Rule {
    /// The rule called `name`.
    pub fn named(name: &str) -> Result<Rule> {
        let known = || RULES.map(|rule| rule.name).join(", ");
        RULES.into_iter().find(|rule| rule.name == name).ok_or_else(|| {
            Error::bad_input("rule", format!("one of {}", known()), format!("'{name}'"), "name one of these")
        })
    }

    /// The cheapest rule for a device whose error, with that of f32, stays within `tolerance`.
    pub fn for_device(integrand: impl Into<Integrand>, tolerance: f64) -> Option<Rule> {
        let integrand = integrand.into();
        let largest = tolerance - f32_arithmetic(integrand);
        Rule::cheapest(integrand, 1, |rule| rule.runs_on_device() && rule.bound(integrand) <= largest)
    }

    /// The cheapest rule for the CPU whose error on a table of `texels` stays within `tolerance`.
    pub fn for_cpu(integrand: impl Into<Integrand>, tolerance: f64, texels: usize) -> Option<Rule> {
        let integrand = integrand.into();
        Rule::cheapest(integrand, texels, |rule| rule.bound(integrand) <= tolerance)
    }

    /// The cheapest rule for the CPU that decides how nearly every value of a table of `texels` rounds: one whose error of B is
    /// a share of B.
    pub fn for_rounding(integrand: impl Into<Integrand>, texels: usize) -> Option<Rule> {
        let integrand = integrand.into();
        let closed = |rule: &Rule| rule.method == Method::ClosedForm;
        Rule::cheapest(integrand, texels, |rule| rule.bound_of_b.0 < 1e-5 || closed(rule))
    }

    fn cheapest(integrand: Integrand, texels: usize, serves: impl Fn(&Rule) -> bool) -> Option<Rule> {
        let candidates = RULES.into_iter().filter(|rule| rule.applies_to(integrand) && serves(rule));
        candidates.min_by(|a, b| a.seconds(integrand, texels).total_cmp(&b.seconds(integrand, texels)))
    }

    /// The largest error of A and of B over the whole domain, in exact arithmetic: absolute, or of albedos above 1 relative.
    pub fn bound(&self, integrand: impl Into<Integrand>) -> f64 {
        match integrand.into() {
            Integrand::Specular(lobe) => self.bounds[lobe.ndf as usize],
            // A few units in the last place of its functions.
            Integrand::Diffuse(_) if self.method == Method::ClosedForm => 4e-15,
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

    /// How far A and B of a table by the rule may be from the truth where it has the value `value`: what [`Rule::bound`] says, and
    /// for B, which spans ten decades, a share of itself.
    pub fn errors_at(&self, integrand: impl Into<Integrand>, alpha: f64, value: ScaleBias) -> ScaleBias {
        let scale = value.e().max(1.0);
        let (share, floor) = self.bound_of_b;
        let (all, of_b) = match integrand.into() {
            // A mirror, in closed form.
            Integrand::Specular(_) if alpha == 0.0 => (1e-15, 1e-15),
            Integrand::Specular(lobe) if lobe.ndf == Ndf::Charlie && alpha < CHARLIE_LIMIT => {
                (self.bound(lobe), f64::INFINITY)
            }
            Integrand::Specular(lobe) if lobe.ndf == Ndf::Charlie => {
                (self.bound_above_limit(), share * value.b.abs() + floor * scale)
            }
            integrand => (self.bound(integrand), share * value.b.abs() + floor * scale),
        };
        ScaleBias { a: all * scale, b: of_b.min(all * scale) }
    }

    /// The same of a table that a device has computed in f32.
    pub fn device_errors_at(&self, integrand: impl Into<Integrand>, alpha: f64, value: ScaleBias) -> ScaleBias {
        let integrand = integrand.into();
        let rule = self.errors_at(integrand, alpha, value);
        let scale = value.e().max(1.0);
        let f32s = scale * f32_arithmetic(integrand);
        // For rules within 3e-6: twice the largest that was measured of rule and f32 together. (1 - v·h)^5 of an f32 errs by
        // its power 4/5.
        let b = (value.b.abs() / scale).sqrt();
        let of_b = if self.bound(integrand) <= 3e-6 { scale * (2e-6 * b * b.sqrt() + 2e-9) } else { f64::INFINITY };
        ScaleBias { a: rule.a + f32s, b: if rule.b.is_finite() { of_b.min(rule.b + f32s) } else { rule.b } }
    }

    /// The bound of Charlie above [`CHARLIE_LIMIT`]: double exponential rules are as sharp there as for any other lobe.
    fn bound_above_limit(&self) -> f64 {
        let [smooth, .., charlie] = self.bounds;
        if matches!(self.method, Method::Reference(_)) { smooth } else { charlie }
    }

    /// Evaluations of the integrand for a table of `texels`; of the double exponential rules for a lobe without kinks.
    pub fn evaluations(&self, texels: usize) -> usize {
        match self.method {
            Method::HSpace(rule) => texels * rule.evaluations(),
            Method::LSpace(rule) => texels * rule.evaluations(),
            Method::Reference(rule) => texels * rule.evaluations(),
            Method::Surrogate(rule) => rule.len() * rule.source.evaluations(),
            Method::ClosedForm => texels,
        }
    }

    /// About how long a table of `texels` takes on one thread of a CPU with vectors of eight: by this rules are chosen.
    pub fn seconds(&self, integrand: impl Into<Integrand>, texels: usize) -> f64 {
        let Integrand::Specular(lobe) = integrand.into() else { return 50e-9 * texels as f64 };
        let smith = matches!(lobe.masking, Masking::HeightCorrelated | Masking::Separable);
        // Measured, for an evaluation; Smith's term of all but GGX is the dear part where it is taken at every one.
        let nanoseconds = match (self.method, lobe.ndf) {
            (Method::HSpace(_), Ndf::Beckmann | Ndf::BlinnPhong) if smith => 30.0,
            (Method::HSpace(_), Ndf::BeckmannWalter) => 9.0,
            (Method::HSpace(_), Ndf::Charlie) if smith => 90.0,
            (Method::Reference(_), Ndf::Beckmann) => 6.0,
            (Method::Reference(_), Ndf::BeckmannWalter | Ndf::BlinnPhong) => 8.0,
            (Method::Reference(_), Ndf::Charlie) => 20.0,
            _ => 2.0,
        };
        let polynomials = match self.method {
            Method::Surrogate(rule) => 0.5e-9 * (rule.directions * texels) as f64,
            _ => 0.0,
        };
        1e-9 * nanoseconds * self.evaluations(texels) as f64 + polynomials
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
            // The implicit term's albedo falls with μ², which s does not follow.
            (Method::Surrogate(_), Integrand::Specular(lobe)) => {
                l_space_applies(lobe) && lobe.masking != Masking::Implicit
            }
            _ => true,
        }
    }

    /// The rule that a table by this one is measured against.
    pub fn yardstick(&self) -> Rule {
        match self.method {
            Method::ClosedForm => *self,
            Method::Reference(_) if self.name == REFERENCE.name => FINER_REFERENCE,
            _ => REFERENCE,
        }
    }

    /// The rule with its nodes worked out, ready to integrate; of a surrogate, the rule that integrates at its nodes.
    pub fn integrator(&self) -> Integrator {
        match self.method {
            Method::HSpace(rule) => Integrator::HSpace(rule.nodes()),
            Method::LSpace(rule) => Integrator::LSpace(rule.nodes()),
            Method::Reference(rule) => Integrator::Reference(rule.nodes()),
            Method::Surrogate(rule) => Integrator::LSpace(rule.source.nodes()),
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
        self.quadrature(lobe, mu, alpha)
    }

    /// The same at as many points as there are lanes.
    #[inline(always)]
    pub fn integrate_lanes(&self, integrand: Integrand, points: [(f64, f64); WIDTH]) -> [ScaleBias; WIDTH] {
        let Integrand::Specular(lobe) = integrand else {
            return points.map(|(mu, alpha)| self.integrate(integrand, mu, alpha));
        };
        let mus = Lanes(points.map(|point| point.0));
        // Any α will do in the lanes of mirrors.
        let alphas = Lanes(points.map(|(_, alpha)| if alpha == 0.0 { 1.0 } else { alpha }));
        let ScaleBias { a, b } = self.quadrature(lobe, mus, alphas);
        std::array::from_fn(|i| match points[i] {
            (mu, 0.0) => ScaleBias::mirror(mu, lobe.smooth_limit(mu)),
            _ => ScaleBias { a: a.0[i], b: b.0[i] },
        })
    }

    /// (A, B) of a specular lobe at α > 0, in whatever arithmetic.
    #[inline(always)]
    pub fn quadrature<R: Real>(&self, lobe: Microfacet, mu: R, alpha: R) -> ScaleBias<R> {
        match self {
            Integrator::HSpace(nodes) => h_space(lobe, mu, alpha, nodes),
            Integrator::LSpace(nodes) => l_space(lobe, mu, alpha, nodes),
            Integrator::Reference(nodes) => reference(lobe, mu, alpha, nodes),
            Integrator::ClosedForm => ScaleBias { a: R::from(f64::NAN), b: R::from(f64::NAN) },
        }
    }
}

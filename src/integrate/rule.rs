//! A quadrature rule with its name and the bounds of its error: what a tolerance picks from.

pub use super::bounds::{CHARLIE_LIMIT, MARGIN};
pub use super::rules::{REFERENCE, RULES};

use super::bounds::{Bounds, ShareOfB};
use super::h_space::{HSpaceNodes, HSpaceRule, h_space};
use super::l_space::{LSpaceNodes, LSpaceRule, l_space, l_space_applies};
use super::reference::{ReferenceNodes, ReferenceRule, reference};
use super::rules::FINER_REFERENCE;
use super::surrogate::{SurrogateRule, surrogate_applies};
use super::{Integrand, ScaleBias};
use crate::error::{Error, Result};
use crate::lanes::{Lanes, Real, WIDTH};
use crate::model::{Masking, Microfacet, Ndf};
use crate::units::roughness_of;

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
    /// What it promises.
    pub(super) bounds: Bounds,
}

/// What f32 arithmetic may add to a rule's error on a device: 1.2e-6, half again as much as the 8e-7 that were
/// measured with correctly rounded ÷ and √. With its fitted Λ, at roughness 1e-8, where only a tail of its ring is
/// seen, Charlie errs by 1.5e-6.
pub fn f32_arithmetic(integrand: impl Into<Integrand>) -> f64 {
    match integrand.into() {
        Integrand::Specular(Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated }) => 2.5e-6,
        _ => 1.2e-6,
    }
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

    /// The cheapest rule for the CPU that decides how nearly every value of a table of `texels` rounds: one whose
    /// error of B is a share of B.
    pub fn for_rounding(integrand: impl Into<Integrand>, texels: usize) -> Option<Rule> {
        let integrand = integrand.into();
        let closed = |rule: &Rule| rule.method == Method::ClosedForm;
        Rule::cheapest(integrand, texels, |rule| rule.bounds.of_b.share < 1e-5 || closed(rule))
    }

    fn cheapest(integrand: Integrand, texels: usize, serves: impl Fn(&Rule) -> bool) -> Option<Rule> {
        let candidates = RULES.into_iter().filter(|rule| rule.applies_to(integrand) && serves(rule));
        candidates.min_by(|a, b| a.seconds(integrand, texels).total_cmp(&b.seconds(integrand, texels)))
    }

    /// The largest error of A and of B over the whole domain, in exact arithmetic: absolute, or of albedos above 1
    /// relative.
    pub fn bound(&self, integrand: impl Into<Integrand>) -> f64 {
        match integrand.into() {
            Integrand::Specular(lobe) => self.bounds.over_domain(lobe),
            // A few units in the last place of its functions.
            Integrand::Diffuse(_) if self.method == Method::ClosedForm => 4e-15,
            Integrand::Diffuse(_) => f64::INFINITY,
        }
    }

    /// The smallest error that a rule of those for devices promises, in exact arithmetic; 0 of closed forms, which
    /// need none.
    pub fn sharpest_device_bound(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        if let Integrand::Diffuse(_) = integrand {
            return 0.0;
        }
        let bounds = RULES.iter().filter(|rule| rule.runs_on_device()).map(|rule| rule.bound(integrand));
        bounds.fold(f64::INFINITY, f64::min)
    }

    /// The smallest tolerance that f32 on a device keeps.
    pub fn device_tolerance(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        Rule::sharpest_device_bound(integrand) + f32_arithmetic(integrand)
    }

    /// The smallest error that any rule promises.
    pub fn sharpest_bound(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        RULES.iter().map(|rule| rule.bound(integrand)).fold(f64::INFINITY, f64::min)
    }

    /// The largest error of A and of B at an α, of albedos above 1 relative: [`Rule::bound`], but sharper or infinite
    /// for Charlie.
    pub fn bound_at(&self, integrand: impl Into<Integrand>, alpha: f64) -> f64 {
        self.errors_at(integrand, alpha, ScaleBias { a: 1.0, b: 0.0 }).a
    }

    /// How far A and B of a table by the rule may be from the truth where it has the value `value`: what
    /// [`Rule::bound`] says, and for B, which spans ten decades, a share of itself.
    pub fn errors_at(&self, integrand: impl Into<Integrand>, alpha: f64, value: ScaleBias) -> ScaleBias {
        let (integrand, scale) = (integrand.into(), value.e().max(1.0));
        let (a, b) = match integrand {
            // A mirror, in closed form.
            Integrand::Specular(_) if alpha == 0.0 => (1e-15 * scale, 1e-15 * scale),
            Integrand::Specular(lobe) => self.bounds.at(lobe, alpha, value.b, scale),
            // B is 0.
            Integrand::Diffuse(_) => (self.bound(integrand) * scale, value.b.abs().min(self.bound(integrand) * scale)),
        };
        ScaleBias { a, b }
    }

    /// The same of a table that a device has computed in f32.
    pub fn device_errors_at(&self, integrand: impl Into<Integrand>, alpha: f64, value: ScaleBias) -> ScaleBias {
        let integrand = integrand.into();
        let rule = self.errors_at(integrand, alpha, value);
        let scale = value.e().max(1.0);
        let f32s = scale * f32_arithmetic(integrand);
        // For rules within 3e-6: twice the largest that was measured of rule and f32 together. (1 - v·h)^5 of an f32
        // errs by its power 4/5.
        let b = (value.b.abs() / scale).sqrt();
        let of_b = if self.bound(integrand) <= 3e-6 { scale * (2e-6 * b * b.sqrt() + 2e-9) } else { f64::INFINITY };
        ScaleBias { a: rule.a + f32s, b: if rule.b.is_finite() { of_b.min(rule.b + f32s) } else { rule.b } }
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
        matches!(self.method, Method::HSpace(_))
    }

    /// Whether it serves for an integrand.
    pub fn applies_to(&self, integrand: impl Into<Integrand>) -> bool {
        match (self.method, integrand.into()) {
            (Method::ClosedForm, Integrand::Diffuse(_)) => true,
            (Method::ClosedForm, _) | (_, Integrand::Diffuse(_)) => false,
            (Method::LSpace(_), Integrand::Specular(lobe)) => l_space_applies(lobe),
            (Method::Surrogate(_), Integrand::Specular(lobe)) => surrogate_applies(lobe),
            (Method::HSpace(_) | Method::Reference(_), Integrand::Specular(lobe)) => visibility_knows_no_azimuth(lobe),
        }
    }

    /// The same rule with a promise of its own: at most `bound` for every lobe, A and B. It is for tests of what
    /// watches over bounds.
    pub fn promising(self, bound: f64) -> Rule {
        Rule { bounds: Bounds::same(bound, ShareOfB::of(0.0, bound)), ..self }
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

/// Whether n·l V depends on n·l and n·v alone, which the reference takes out of the integral over the azimuth, and
/// the rules over half vectors out of nothing but know no other. A term that depends on v·h (of V-cavities, of
/// Kelemen) has no rule here.
fn visibility_knows_no_azimuth(lobe: Microfacet) -> bool {
    match lobe.masking {
        Masking::HeightCorrelated
        | Masking::Separable
        | Masking::SchlickSmith
        | Masking::Joint
        | Masking::Implicit
        | Masking::Neubelt => true,
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
    /// (A, B) at n·v = `mu` and `alpha`, both in [0, 1]; α = 0 is the limit of a mirror, also at n·v = 0. NaN where
    /// the rule does not apply.
    pub fn integrate(&self, integrand: impl Into<Integrand>, mu: f64, alpha: f64) -> ScaleBias {
        let lobe = match integrand.into() {
            Integrand::Diffuse(diffuse) => return ScaleBias { a: diffuse.albedo(mu, roughness_of(alpha)), b: 0.0 },
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

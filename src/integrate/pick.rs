//! Picks a rule: by its name, or the cheapest that keeps a tolerance.

use super::Integrand;
use super::bounds::Bound;
use super::errors::f32_arithmetic;
use super::rule::{Method, Rule};
use super::rules::{
    COARSE_ERROR, COARSE_REFERENCE, FINER, FINER_BY, FINER_REFERENCE, G560, REFERENCE, RULES,
};
use crate::error::{Error, Result};

impl Rule {
    /// The rule called `name`.
    pub fn named(name: &str) -> Result<Rule> {
        let known = || RULES.map(|rule| rule.name).join(", ");
        RULES.into_iter().find(|rule| rule.name == name).ok_or_else(|| {
            Error::bad_input(
                "rule",
                format!("one of {}", known()),
                format!("'{name}'"),
                "name one of these",
            )
        })
    }

    /// The cheapest rule for a device whose error, with that of f32, stays within `tolerance`.
    pub fn for_device(integrand: impl Into<Integrand>, tolerance: f64) -> Option<Rule> {
        let integrand = integrand.into();
        let largest = tolerance - f32_arithmetic(integrand);
        Rule::cheapest(integrand, 1, |rule| {
            rule.runs_on_device() && rule.bound(integrand) <= largest
        })
    }

    /// The cheapest rule for the CPU whose error on a table of `texels` stays within `tolerance`.
    pub fn for_cpu(integrand: impl Into<Integrand>, tolerance: f64, texels: usize) -> Option<Rule> {
        let integrand = integrand.into();
        Rule::cheapest(integrand, texels, |rule| rule.bound(integrand) <= tolerance)
    }

    /// The cheapest rule for the CPU that decides how nearly every value of a table of `texels`
    /// rounds, whose n·v are at least `mu`.
    pub fn for_rounding(integrand: impl Into<Integrand>, mu: f64, texels: usize) -> Option<Rule> {
        // Halves lie 5e-4 to 1e-3 of their value apart: a relative error of 1e-5 leaves at most one
        // value in 25 undecided. Without a relative bound nearly every small value would be.
        const RELATIVE: f64 = 1e-5;
        let integrand = integrand.into();
        if let Integrand::Glass(_) = integrand {
            // No rule for it is as sharp as that: this one decides four texels in ten, and the
            // finer ones cost twice as much.
            return Some(G560);
        }
        let serves = |rule: &Rule| {
            // At α = 1, above the limit below which Charlie's bounds are wider.
            rule.method == Method::ClosedForm
                || rule.bounds_at(integrand, mu, 1.0).relative < RELATIVE
        };
        let seconds = |rule: &Rule| {
            rule.seconds(integrand, texels) + rule.seconds_after_rounding(integrand, mu, texels)
        };
        Rule::least(integrand, serves, seconds)
    }

    /// The approximate time that a finer rule takes for the values that this one leaves undecided.
    fn seconds_after_rounding(&self, integrand: Integrand, mu: f64, texels: usize) -> f64 {
        // Fitted to what was measured with f16, within a factor of three: of the texels s1440,
        // which errs by 1.2e-8 and where B is small by 3e-10, leaves 0.2 %, s1248 with 1.8e-8 and
        // 6.5e-10 0.4 %, s1360 with 8e-10 and 2.4e-10 0.5 %.
        const UNDECIDED_BY_ERROR: f64 = 5e4;
        const UNDECIDED_BY_ABSOLUTE: f64 = 1e7;
        // Those of most rows: roughness 0.5.
        let bounds = |rule: &Rule| rule.bounds_at(integrand, mu, 0.25);
        let Bound { all, absolute, .. } = bounds(self);
        let finer = FINER
            .into_iter()
            .find(|rule| rule.applies_to(integrand) && FINER_BY * bounds(rule).all < all);
        let share = UNDECIDED_BY_ERROR * all + UNDECIDED_BY_ABSOLUTE * absolute;
        let undecided = share.min(1.0) * texels as f64;
        finer.map_or(0.0, |finer| undecided * finer.seconds(integrand, 1))
    }

    fn cheapest(
        integrand: Integrand,
        texels: usize,
        serves: impl Fn(&Rule) -> bool,
    ) -> Option<Rule> {
        Rule::least(integrand, serves, |rule| rule.seconds(integrand, texels))
    }

    /// The rule of the least cost among those that serve.
    fn least(
        integrand: Integrand,
        serves: impl Fn(&Rule) -> bool,
        cost: impl Fn(&Rule) -> f64,
    ) -> Option<Rule> {
        let serving = RULES.into_iter().filter(|rule| rule.applies_to(integrand) && serves(rule));
        serving.min_by(|a, b| cost(a).total_cmp(&cost(b)))
    }

    /// The smallest bound among the rules for devices, in exact arithmetic; 0 of closed forms,
    /// which need no rule.
    pub fn sharpest_device_bound(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        if let Integrand::Diffuse(_) = integrand {
            return 0.0;
        }
        let bounds =
            RULES.iter().filter(|rule| rule.runs_on_device()).map(|rule| rule.bound(integrand));
        bounds.fold(f64::INFINITY, f64::min)
    }

    /// The smallest tolerance that f32 on a device keeps.
    pub fn device_tolerance(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        Rule::sharpest_device_bound(integrand) + f32_arithmetic(integrand)
    }

    /// The smallest bound of all rules.
    pub fn sharpest_bound(integrand: impl Into<Integrand>) -> f64 {
        let integrand = integrand.into();
        RULES.iter().map(|rule| rule.bound(integrand)).fold(f64::INFINITY, f64::min)
    }

    /// Whether it is the reference, or what that is measured against.
    pub fn is_reference(&self) -> bool {
        self.name == REFERENCE.name
    }

    /// The rule that a table by this one is measured against.
    pub fn yardstick(&self) -> Rule {
        match self.method {
            Method::ClosedForm => *self,
            Method::DoubleExponential(_) if self.is_reference() => FINER_REFERENCE,
            _ => REFERENCE,
        }
    }

    /// The rule that a sample of a table by this one is measured against: the yardstick, or of
    /// glass, where that takes a millisecond for a point, one with fewer nodes that errs by no
    /// more than a hundredth of what is promised.
    pub fn gauge(&self, integrand: Integrand) -> Rule {
        match self.method {
            Method::Glass(_) if self.bound(integrand) >= 100.0 * COARSE_ERROR => COARSE_REFERENCE,
            _ => self.yardstick(),
        }
    }
}

//! Schlick's approximation with another exponent: F = F0 + (1 - F0) (1 - v·h)^p. Small exponents
//! serve indices of refraction near 1 and large ones tints, as in the generalised Schlick models of
//! Cycles and MaterialX (Schlick 1994, with p = 5; Hoffman 2019 on other exponents).

use super::{Basis, Definition, Integral};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use crate::units::short;

/// Schlick's approximation with exponent p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SchlickPower {
    pub(super) exponent: f64,
}

/// The exponents for which the rules' bounds were searched: below 1 the weight is not smooth where
/// v = h.
const EXPONENTS: std::ops::RangeInclusive<f64> = 1.0..=20.0;

impl SchlickPower {
    /// The model with exponent p from 1 to 20.
    pub fn new(exponent: f64) -> Result<Self> {
        if EXPONENTS.contains(&exponent) {
            return Ok(SchlickPower { exponent });
        }
        let cure = "give an exponent in that range";
        Err(Error::bad_input("exponent of schlick", "1 to 20", short(exponent), cure))
    }

    /// p
    pub const fn exponent(self) -> f64 {
        self.exponent
    }

    /// 2p where that is a whole number: then a power is products and a root.
    fn halves(self) -> Option<u32> {
        let halves = 2.0 * self.exponent;
        (halves.fract() == 0.0).then_some(halves as u32)
    }
}

impl Basis<2> for SchlickPower {
    const DEFINITION: Definition = Definition {
        word: "schlick",
        usage: "schlick:EXPONENT",
        about: "the same with another exponent, from 1 to 20",
        formula: "Schlick with exponent p: F = F0 + (1 - F0) (1 - v.h)^p",
        smooth_complement: false,
        integrals: &[
            super::schlick::A,
            // 1 - v·h is a few roundings of 1 off, which counts where p = 1.
            Integral { relative_error: 6.0, absolute_error: 1e-15, ..super::schlick::B },
        ],
        wgsl: (include_str!("../../../shaders/schlick_power.wgsl"), "schlick_power_weights"),
        ..super::schlick::DEFINITION
    };

    fn arguments(self) -> Vec<f64> {
        vec![self.exponent]
    }

    fn error_factor(self) -> f64 {
        // The largest that a search found is 1.1.
        1.7
    }

    fn obstacle_on_device(self) -> Option<&'static str> {
        self.halves().is_none().then_some("a whole exponent, or one half more: f32 has no power")
    }

    fn wgsl_arguments(self) -> String {
        let halves = self.halves().unwrap_or(0);
        format!(", {}u, {}u", halves / 2, halves % 2)
    }

    #[inline(always)]
    fn weights<R: Real>(self, vh: R) -> [R; 2] {
        match self.halves() {
            Some(halves) => schlick_power_weights(vh, halves / 2, halves % 2),
            None => {
                let base = vh.complement().max(R::from(0.0));
                let w = base.zip(base, |base, _| libm::pow(base, self.exponent));
                [w.complement(), w]
            }
        }
    }

    fn of_mirror(self, mu: f64) -> [Ball; 2] {
        let w = libm::pow(1.0 - mu, self.exponent);
        // 1 - (1-μ)^p without cancellation.
        let complement = -libm::expm1(self.exponent * libm::log1p(-mu));
        // p units of the base's rounding, and two of each function.
        let error = |value: f64| value * (self.exponent + 8.0) * f64::EPSILON;
        [complement, w].map(|value| Ball { value, error: error(value) })
    }
}

/// (1 - w, w) with w = (1 - v·h)^(whole + half/2), `half` being 0 or 1.
#[inline(always)]
pub fn schlick_power_weights<R: Real>(vh: R, whole: u32, half: u32) -> [R; 2] {
    let base = vh.complement().max(R::from(0.0));
    let mut w = if half == 1 { base.sqrt() } else { R::from(1.0) };
    for _ in 0..whole {
        w = w * base;
    }
    [w.complement(), w]
}

//! Fresnel's equations for unpolarised light at the surface of a conductor in air, whose index of
//! refraction is n + ik, in real numbers (Born and Wolf, "Principles of Optics", section 14.2).
//!
//! With c = v·h, s² = 1 - c², t = n² - k² - s², p = √(t² + 4n²k²) and a = √((p+t)/2):
//!
//! R_s = (p + c² - 2ac)/(p + c² + 2ac), R_p = R_s (c²p + s⁴ - 2acs²)/(c²p + s⁴ + 2acs²), F = (R_s +
//! R_p)/2.

use super::metals::measured;
use super::{Basis, Definition, Integral};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use crate::units::short;

/// Fresnel's equations for the index n + ik.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    pub(super) n: f64,
    pub(super) k: f64,
}

/// The n and k for which the rules' bounds were searched: those of metals in visible light, with
/// room to spare. With less absorption a conductor thinner than air has nearly a critical angle.
const LARGEST: f64 = 20.0;
const SMALLEST_N: f64 = 0.01;
const SMALLEST_K: f64 = 0.5;

impl Conductor {
    /// The conductor with index n + ik, n from 0.01 to 20 and k from 0.5 to 20.
    pub fn new(n: f64, k: f64) -> Result<Self> {
        if (SMALLEST_N..=LARGEST).contains(&n) && (SMALLEST_K..=LARGEST).contains(&k) {
            return Ok(Conductor { n, k });
        }
        let got = format!("n = {}, k = {}", short(n), short(k));
        let cure = "give numbers in that range, or the name of a metal";
        Err(Error::bad_input("conductor", "n from 0.01 to 20 and k from 0.5 to 20", got, cure))
    }

    /// n and k.
    pub fn index(self) -> [f64; 2] {
        [self.n, self.k]
    }
}

impl Basis<1> for Conductor {
    const DEFINITION: Definition = Definition {
        word: "conductor",
        usage: "conductor:N,K|METAL",
        about: "Fresnel's equations for an index n + ik; gold, silver, copper, aluminium, iron, \
                titanium or chromium are three slices, for red, green and blue",
        formula: "Fresnel's equations for unpolarised light, a conductor with index of refraction \
                  n + ik",
        albedo: "E = R",
        channels: "r",
        smooth_complement: false,
        integrals: &[Integral {
            name: "R",
            meaning: "directional albedo of the interface: E = R",
            relative_error: 1.0,
            absolute_error: 0.0,
        }],
        wgsl: (include_str!("../../../shaders/conductor.wgsl"), "conductor_reflectance"),
    };

    fn arguments(self) -> Vec<f64> {
        vec![self.n, self.k]
    }

    fn error_factor(self) -> f64 {
        // The largest that a search found is 1.3, for n = k = 20.
        2.0
    }

    fn source(self) -> Option<String> {
        measured(self)
    }

    fn wgsl_arguments(self) -> String {
        format!(", {:e}, {:e}", self.n, self.k)
    }

    #[inline(always)]
    fn weights<R: Real>(self, vh: R) -> [R; 1] {
        [conductor_reflectance(vh, R::from(self.n), R::from(self.k))]
    }

    fn of_mirror(self, mu: f64) -> [Ball; 1] {
        let (one, half) = (Ball::exact(1.0), Ball::exact(0.5));
        let (n, k, c) = (Ball::exact(self.n), Ball::exact(self.k), Ball::exact(mu));
        let s2 = (one - c) * (one + c);
        let nk = n * k + n * k;
        let t = (n - k) * (n + k) - s2;
        let p = (t * t + nk * nk).sqrt();
        let twice_a2 = if t.value > 0.0 { p + t } else { nk * nk / (p - t) };
        let a = (twice_a2 * half).sqrt();
        let (turned, sum) = ((a + a) * c, p + c * c);
        let s = (sum - turned) / (sum + turned);
        let (mean, turned) = (c * c * p + s2 * s2, turned * s2);
        [half * s * (one + (mean - turned) / (mean + turned))]
    }
}

/// F at c = v·h for the index n + ik.
#[inline(always)]
pub fn conductor_reflectance<R: Real>(c: R, n: R, k: R) -> R {
    let zero = R::from(0.0);
    let s2 = c.complement() * (c + 1.0);
    let nk2 = n * k * n * k * 4.0;
    let t = (n - k) * (n + k) - s2;
    let p = (t * t + nk2).sqrt();
    // (p + t) (p - t) = 4n²k²: of the two forms of p + t the one that does not cancel.
    let size = p + t.abs();
    let a = (t.select_below(zero, nk2 / size, size) * 0.5).sqrt();
    let (turned, sum) = (a * c * 2.0, p + c * c);
    let (mean, turned_p) = (c * c * p + s2 * s2, turned * s2);
    // R_s (1 + R_p/R_s)/2 with one division.
    (sum - turned) * mean / ((sum + turned) * (mean + turned_p))
}

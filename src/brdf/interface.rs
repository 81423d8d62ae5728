//! The rough interface of two dielectrics, which reflects and transmits: glass. Light arrives on
//! the side of v, where the index of refraction is 1/η of that on the other side.
//!
//! Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough Surfaces",
//! 2007: with c = v·h and x = n·l for reflection (equations 13, 14 and 20) or x = -n·l for
//! transmission (equations 16, 17 and 21),
//!
//! E = ∫ D(h) (c/μ) F G₂(μ, x) dω_h for reflection, with 1 - F for F for transmission.

use super::fresnel::{Dielectric, average_dielectric};
use super::masking::{height_correlated, separable};
use super::{Masking, Microfacet, Ndf};
use crate::choice::{Choice, choice, words};
use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use crate::numeric::special::log_beta;
use crate::units::short;
use std::fmt;

/// The side of an interface from which it is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From air, η = n.
    Outside,
    /// From the medium, η = 1/n.
    Inside,
}

impl Side {
    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Side::Outside => Side::Inside,
            Side::Inside => Side::Outside,
        }
    }
}

choice!(Side, "side", {
    Outside = "outside", "seen from air";
    Inside = "inside", "seen from the medium, with total reflection";
});

/// Masking and shadowing of transmitted light, whose directions lie on either side of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransmissionMasking {
    /// The formula of reflection, 1/(1 + Λ(v) + Λ(l)): Cycles, OSPRay.
    #[default]
    Correlated,
    /// G1(v) G1(l) (Walter et al. 2007): Adobe.
    Separable,
    /// B(1 + Λ(v), 1 + Λ(l)) for the facets that are seen from both sides (Heitz 2014).
    Beta,
}

choice!(TransmissionMasking, "transmission-masking", {
    Correlated = "correlated", "1/(1 + Lambda(v) + Lambda(l)), as in Cycles and OSPRay";
    Separable = "separable", "G1(v) G1(l) (Walter et al. 2007), as in Adobe's tables";
    Beta = "beta", "B(1 + Lambda(v), 1 + Lambda(l)), for facets seen from both sides (Heitz 2014)";
});

/// A rough interface seen from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    lobe: Microfacet,
    medium: Dielectric,
    side: Side,
    transmission: TransmissionMasking,
    /// See [`Interface::counting_wrong_side`].
    wrong_side: bool,
}

/// The distributions with a Smith term of their own that is smooth.
const DISTRIBUTIONS: [Ndf; 2] = [Ndf::Ggx, Ndf::Beckmann];
const MASKINGS: [Masking; 2] = [Masking::HeightCorrelated, Masking::Separable];

impl Interface {
    /// The interface to a medium with index of refraction `ior`, 1 to 100; an error where the lobe
    /// has no Smith term of its own.
    pub fn new(
        lobe: Microfacet,
        ior: f64,
        side: Side,
        transmission: TransmissionMasking,
    ) -> Result<Self> {
        lobe.check()?;
        let cure = "choose another one";
        if !DISTRIBUTIONS.contains(&lobe.ndf) {
            let (expected, got) = (words(&DISTRIBUTIONS), lobe.ndf.word());
            return Err(Error::bad_input("model of glass", expected, got, cure));
        }
        if !MASKINGS.contains(&lobe.masking) {
            let (expected, got) = (words(&MASKINGS), lobe.masking.word());
            return Err(Error::bad_input("masking of glass", expected, got, cure));
        }
        Ok(Interface { lobe, medium: Dielectric::new(ior)?, side, transmission, wrong_side: false })
    }

    /// Interfaces of every kind, with indices at which rules err most: what bounds are searched
    /// for.
    pub fn samples() -> Vec<Self> {
        let mut samples = Vec::new();
        let near = [1.000_001, 1.000_2, 1.001_3, 1.002, 1.05, 1.33];
        let far = [1.5, 2.749, 8.0, 11.999, 30.0, 100.0];
        for (i, ior) in near.into_iter().chain(far).enumerate() {
            for (j, side) in Side::ALL.iter().enumerate() {
                // Every kind with two of the indices.
                for (k, ndf) in DISTRIBUTIONS.into_iter().enumerate() {
                    let lobe = Microfacet { ndf, masking: MASKINGS[(i + k) % 2] };
                    let transmission = TransmissionMasking::ALL[(i + j * k) % 3];
                    samples.extend(Interface::new(lobe, ior, *side, transmission));
                }
            }
        }
        samples
    }

    /// The same interface seen from this side.
    pub fn from(self, side: Side) -> Self {
        Interface { side, ..self }
    }

    /// The same interface with refractions from inside that leave on the side of v counted as if
    /// they passed, at |n·l|: an error of Cycles' tables, for rules about n alone.
    pub fn counting_wrong_side(self) -> Self {
        Interface { wrong_side: true, ..self }
    }

    /// Whether it counts them.
    pub fn counts_wrong_side(self) -> bool {
        self.wrong_side
    }

    /// The same with another index of refraction.
    pub fn at_ior(self, ior: f64) -> Result<Self> {
        Interface::new(self.lobe, ior, self.side, self.transmission)
    }

    /// The lobe.
    pub const fn lobe(self) -> Microfacet {
        self.lobe
    }

    /// The medium.
    pub const fn medium(self) -> Dielectric {
        self.medium
    }

    /// n of the medium.
    pub const fn ior(self) -> f64 {
        self.medium.ior()
    }

    /// The side of v.
    pub fn side(self) -> Side {
        self.side
    }

    /// Masking of transmitted light.
    pub const fn transmission(self) -> TransmissionMasking {
        self.transmission
    }

    /// η, the index on the other side over that on the side of v.
    pub fn eta(self) -> f64 {
        match self.side {
            Side::Outside => self.ior(),
            Side::Inside => 1.0 / self.ior(),
        }
    }

    /// k = η² - 1.
    pub fn k(self) -> f64 {
        let k = self.medium.k();
        match self.side {
            Side::Outside => k,
            Side::Inside => -k / (self.ior() * self.ior()),
        }
    }

    /// The cosine of the critical angle; 0 on the outside, which has none.
    pub fn critical(self) -> f64 {
        (-self.k()).max(0.0).sqrt()
    }

    /// F over all directions, F_avg = 2 ∫ F c dc: from inside 1 - (1 - F_avg)/n² (Duntley 1942).
    pub fn average_reflectance(self) -> Ball {
        let outside = average_dielectric(self.medium);
        match self.side {
            Side::Outside => outside,
            Side::Inside => {
                let (one, n) = (Ball::exact(1.0), Ball::exact(self.ior()));
                one - (one - outside) / (n * n)
            }
        }
    }

    /// R and T where they are known to their last digits, each with the bound of its error.
    ///
    /// α = 0 is a mirror: F, and 1 - F. η = 1 reflects nothing, and transmits straight through: T
    /// is G₂(v, -v)/G₁(v), with S = μ(1 + 2Λ) for correlated masking (μ + S)/(2S) and for separable
    /// 2μ/(μ + S). Seen from inside at n·v = 0 nothing is transmitted, unless η = 1.
    pub fn exact(self, mu: f64, alpha: f64) -> [Option<Ball>; 2] {
        let zero = Ball::exact(0.0);
        if alpha == 0.0 {
            let [reflected, transmitted] = self.of_mirror(mu);
            return [Some(reflected), Some(transmitted)];
        }
        if self.ior() == 1.0 {
            return [Some(zero), self.straight(mu, alpha)];
        }
        match self.side {
            Side::Inside if mu == 0.0 && !self.wrong_side => [None, Some(zero)],
            Side::Inside | Side::Outside => [None, None],
        }
    }

    /// Puts what is known so in the place of integrals.
    pub fn put_exact(self, (mu, alpha): (f64, f64), integrals: &mut [f64]) {
        for (integral, exact) in integrals.iter_mut().zip(self.exact(mu, alpha)) {
            *integral = exact.map_or(*integral, |exact| exact.value);
        }
    }

    /// F and 1 - F at n·v = `mu`.
    fn of_mirror(self, mu: f64) -> [Ball; 2] {
        let (zero, one) = (Ball::exact(0.0), Ball::exact(1.0));
        if self.ior() == 1.0 {
            return [zero, one];
        }
        let (n, c) = (Ball::exact(self.ior()), Ball::exact(mu));
        let n2 = n * n;
        let (k, eta2) = match self.side {
            Side::Outside => (n2 - one, n2),
            Side::Inside => ((one - n2) / n2, one / n2),
        };
        let g2 = k + c * c;
        if g2.high() <= 0.0 {
            return [one, zero];
        }
        if g2.low() <= 0.0 {
            // 1 - F is at most 2 (g/c) (1 + 1/η²).
            let most = 2.0 * g2.high().sqrt() / mu * (1.0 + n2.value) * 1.001;
            let half = Ball { value: 0.5 * most, error: 0.5 * most };
            return [one - half, half];
        }
        let g = g2.sqrt();
        let (s, p, s2) = (g + c, eta2 * c + g, (one - c) * (one + c));
        let a = k / (s * s * (c * g + s2));
        let passed = (c * g + c * g) * (p * p + eta2 * s * s) / (s * s * p * p);
        [a * a * (c * c * g2 + s2 * s2), passed]
    }

    /// T with η = 1; none where masking has no closed form.
    fn straight(self, mu: f64, alpha: f64) -> Option<Ball> {
        let (c, a) = (Ball::exact(mu), Ball::exact(alpha));
        let one = Ball::exact(1.0);
        let area = match self.lobe.ndf {
            Ndf::Ggx if alpha == 1.0 => one,
            Ndf::Ggx => (c * c + a * a * ((one - c) * (one + c))).sqrt(),
            _ => {
                let value = self.lobe.masking_projected_area(mu, alpha);
                // A few units in the last place of its functions.
                Ball { value, error: 16.0 * f64::EPSILON * value }
            }
        };
        match self.transmission {
            TransmissionMasking::Correlated => Some((c + area) / (area + area)),
            TransmissionMasking::Separable => Some((c + c) / (c + area)),
            TransmissionMasking::Beta => None,
        }
    }

    /// G₂(μ, x)/(4μ) of transmitted light at x = -n·l, with the projected area of n·v given.
    #[inline(always)]
    pub fn transmitted_visibility<R: Real>(self, x: R, mu: R, area_v: R, alpha: R) -> R {
        let area_l = self.lobe.masking_projected_area(x, alpha);
        match self.transmission {
            TransmissionMasking::Correlated => height_correlated(x, mu, area_l, area_v),
            TransmissionMasking::Separable => separable(x, mu, area_l, area_v),
            TransmissionMasking::Beta => beta(x, mu, area_l, area_v),
        }
    }
}

impl fmt::Display for Interface {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Microfacet { ndf, masking } = self.lobe;
        let (transmission, side) = (self.transmission, self.side);
        write!(f, "{ndf}, {masking}, {transmission}, n = {}, {side}", short(self.ior()))
    }
}

/// The least cosine at which the beta function is taken: below it 1/(4μ) would overflow.
const SMALLEST: f64 = 1e-290;

/// G = B(1 + Λ(v), 1 + Λ(l)), Λ = (area/cosine - 1)/2 (Heitz 2014, section 5.3).
#[inline(always)]
pub fn beta<R: Real>(x: R, mu: R, area_l: R, area_v: R) -> R {
    let tiny = R::from(SMALLEST);
    let (x, mu) = (x.max(tiny), mu.max(tiny));
    let (v, l) = ((area_v / mu + 1.0) * 0.5, (area_l / x + 1.0) * 0.5);
    // B/μ as one exponential: either alone may leave the range of numbers.
    let log_mu = mu.zip(mu, |mu, _| libm::log(4.0 * mu));
    let log = v.zip(l, log_beta) - log_mu;
    log.zip(log, |log, _| libm::exp(log))
}

//! A number with a bound of its error, which every step of arithmetic carries on: running error
//! analysis.
//!
//! What a step rounds away is computed, not estimated: of a sum by Knuth's TwoSum, of a product,
//! quotient or root by a fused multiply-add (Ogita, Rump and Oishi 2005). So a step that rounds
//! nothing adds nothing, and only what is exact has the error 0. Higham, "Accuracy and Stability of
//! Numerical Algorithms", 2002, section 3.3; the interval around a midpoint is a ball.

use std::ops::{Add, Div, Mul, Sub};

/// A number that is at most `error` from the true one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ball {
    /// The number.
    pub value: f64,
    /// The largest distance of the true number from it.
    pub error: f64,
}

/// The bound rounded up: sums and products of a few errors, each rounded to nearest, err by less
/// than 8 units in the last place.
fn outward(error: f64) -> f64 {
    const EIGHT_UNITS: f64 = 8.0 * f64::EPSILON;
    match error {
        0.0 => 0.0,
        // Of 0 times what has no bound nothing is known.
        _ if error.is_nan() => f64::INFINITY,
        _ => (error + error * EIGHT_UNITS).next_up(),
    }
}

/// The part that a product, quotient or root may lose below the smallest normal numbers, where
/// a fused multiply-add cannot tell: nothing where one of the factors is 0.
fn underflow(value: f64) -> f64 {
    // Residues of anything above this are normal numbers, and exact.
    const SAFE: f64 = 1e-290;
    if value.abs() < SAFE { f64::MIN_POSITIVE } else { 0.0 }
}

impl Ball {
    /// The exact number.
    pub fn exact(value: f64) -> Self {
        Ball { value, error: 0.0 }
    }

    /// The least that the truth can be.
    pub fn low(self) -> f64 {
        if self.error == 0.0 { self.value } else { (self.value - self.error).next_down() }
    }

    /// The most that the truth can be.
    pub fn high(self) -> f64 {
        if self.error == 0.0 { self.value } else { (self.value + self.error).next_up() }
    }

    /// The square root; its error is infinite where the truth may be 0 or less and is not known to
    /// be 0.
    pub fn sqrt(self) -> Self {
        if self == Ball::exact(0.0) {
            return self;
        }
        let root = self.value.sqrt();
        let least = self.low();
        if least.is_nan() || least <= 0.0 {
            return Ball { value: root, error: f64::INFINITY };
        }
        // |√x - r| = |x - r²| / (√x + r).
        let residue = (-root).mul_add(root, self.value).abs();
        let error = (residue + self.error + underflow(self.value)) / (root + least.sqrt());
        Ball { value: root, error: outward(error) }
    }
}

impl From<f64> for Ball {
    fn from(value: f64) -> Self {
        Ball::exact(value)
    }
}

impl Add for Ball {
    type Output = Ball;

    fn add(self, other: Ball) -> Ball {
        let (a, b) = (self.value, other.value);
        let value = a + b;
        let part = value - a;
        let residue = ((a - (value - part)) + (b - part)).abs();
        Ball { value, error: outward(self.error + other.error + residue) }
    }
}

impl Sub for Ball {
    type Output = Ball;

    fn sub(self, other: Ball) -> Ball {
        self + Ball { value: -other.value, ..other }
    }
}

impl Mul for Ball {
    type Output = Ball;

    fn mul(self, other: Ball) -> Ball {
        let (a, b) = (self.value, other.value);
        let value = a * b;
        if a == 0.0 && self.error == 0.0 || b == 0.0 && other.error == 0.0 {
            return Ball::exact(value);
        }
        let residue = a.mul_add(b, -value).abs() + underflow(value);
        let carried = a.abs() * other.error + b.abs() * self.error + self.error * other.error;
        Ball { value, error: outward(carried + residue) }
    }
}

impl Div for Ball {
    type Output = Ball;

    /// The quotient; its error is infinite where the divisor may be 0.
    fn div(self, other: Ball) -> Ball {
        let (a, b) = (self.value, other.value);
        let value = a / b;
        let least = b.abs() - other.error;
        if least.is_nan() || least <= 0.0 {
            return Ball { value, error: f64::INFINITY };
        }
        // |x/y - q| = |x - q y| / |y|.
        let residue = (-value).mul_add(b, a).abs() + underflow(a);
        let error = (residue + self.error + value.abs() * other.error) / least;
        Ball { value, error: outward(error) }
    }
}

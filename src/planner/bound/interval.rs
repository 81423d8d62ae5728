//! Ranges of numbers, and ranges of a function with its first two derivatives along a line: a
//! result holds whatever the numbers were (Moore 1966). Ends are not rounded outward: see
//! [`super::ROUNDED`].

use std::ops::{Add, Mul, Sub};

/// Numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The least.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Interval {
    /// One number.
    pub fn point(value: f64) -> Self {
        Interval { low: value, high: value }
    }

    /// From -size to size.
    pub fn around_zero(size: f64) -> Self {
        Interval { low: -size, high: size }
    }

    /// The least that holds all of these; the whole line for none, and where one is no number.
    pub fn hull(values: impl IntoIterator<Item = f64>) -> Self {
        let empty = Interval { low: f64::INFINITY, high: f64::NEG_INFINITY };
        values.into_iter().fold(empty, |hull, value| match value.is_nan() {
            true => Interval::around_zero(f64::INFINITY),
            false => Interval { low: hull.low.min(value), high: hull.high.max(value) },
        })
    }

    /// The same, and what is this near.
    pub fn widened(self, by: f64) -> Self {
        Interval { low: self.low - by, high: self.high + by }
    }

    /// The largest size.
    pub fn size(self) -> f64 {
        let size = self.low.abs().max(self.high.abs());
        if (self.low + self.high).is_nan() { f64::INFINITY } else { size }
    }

    /// What both hold.
    pub fn and(self, other: Self) -> Self {
        Interval { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    /// x²
    fn square(self) -> Self {
        let ends = [self.low * self.low, self.high * self.high];
        let low = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { ends[0].min(ends[1]) };
        Interval { low, high: ends[0].max(ends[1]) }
    }
}

impl Add for Interval {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Interval { low: self.low + other.low, high: self.high + other.high }
    }
}

impl Sub for Interval {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Interval { low: self.low - other.high, high: self.high - other.low }
    }
}

impl Mul for Interval {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (low, high) = (self.low * other.low, self.low * other.high);
        let (third, fourth) = (self.high * other.low, self.high * other.high);
        // 0 times infinity may be anything.
        if (low + high + third + fourth).is_nan() {
            return Interval::around_zero(f64::INFINITY);
        }
        Interval {
            low: low.min(high).min(third.min(fourth)),
            high: low.max(high).max(third.max(fourth)),
        }
    }
}

impl Mul<f64> for Interval {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self * Interval::point(factor)
    }
}

/// A function along a line, and its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// f
    pub value: Interval,
    /// f'
    pub first: Interval,
    /// f''
    pub second: Interval,
}

impl Jet {
    /// A function that does not change along the line.
    pub fn fixed(value: Interval) -> Self {
        let zero = Interval::point(0.0);
        Jet { value, first: zero, second: zero }
    }

    /// The variable of the line.
    pub fn variable(value: Interval) -> Self {
        Jet { first: Interval::point(1.0), ..Jet::fixed(value) }
    }

    /// The same, where its value is known to lie between these.
    pub fn within(self, low: f64, high: f64) -> Self {
        let value = Interval {
            low: self.value.low.clamp(low, high),
            high: self.value.high.clamp(low, high),
        };
        Jet { value, ..self }
    }

    /// The function kept between these; where it is not, it does not change.
    pub fn clamped(self, low: f64, high: f64) -> Self {
        let Interval { low: least, high: largest } = self.value;
        let is_free = low <= least && largest <= high;
        let or_zero = |range: Interval| Interval::hull([range.low, range.high, 0.0]);
        let all = self.within(low, high);
        match is_free {
            true => all,
            false => Jet { first: or_zero(all.first), second: or_zero(all.second), ..all },
        }
    }

    /// The same function, of which both know something.
    pub fn and(self, other: Self) -> Self {
        Jet {
            value: self.value.and(other.value),
            first: self.first.and(other.first),
            second: self.second.and(other.second),
        }
    }

    /// f²
    pub fn square(self) -> Self {
        self * self
    }

    /// f^p of f from 0 on.
    pub fn power(self, p: f64) -> Self {
        self.through(|x| {
            let power = libm::pow(x, p - 2.0);
            [power * x * x, p * power * x, p * (p - 1.0) * power]
        })
    }

    /// √f of f from 0 on.
    pub fn sqrt(self) -> Self {
        self.through(|x| {
            let root = x.sqrt();
            [root, 0.5 / root, -0.25 / (root * x)]
        })
    }

    /// 1/f of f above 0.
    pub fn recip(self) -> Self {
        self.through(|x| {
            let one = 1.0 / x;
            [one, -one * one, 2.0 * one * one * one]
        })
    }

    /// f ln(1 + 1/f)/ln 2 of f from 0 on: its derivatives are ln(1 + 1/f) - 1/(1 + f) and
    /// -1/(f (1 + f)²), over ln 2.
    pub fn log(self) -> Self {
        self.through(|x| {
            let (log, next) = (libm::log(1.0 + 1.0 / x), 1.0 / (1.0 + x));
            let value = if x > 0.0 { x * log } else { 0.0 };
            [value, log - next, -next * next / x].map(|own| own * std::f64::consts::LOG2_E)
        })
    }

    /// φ(f) of f from 0 on, where φ and its first two derivatives are monotone.
    fn through(self, of: impl Fn(f64) -> [f64; 3]) -> Self {
        let Interval { low, high } = self.value;
        let (low, high) = (of(low.max(0.0)), of(high.max(0.0)));
        let [value, slope, curve] = [0, 1, 2].map(|i| Interval::hull([low[i], high[i]]));
        let second = curve * self.first.square() + slope * self.second;
        Jet { value, first: slope * self.first, second }
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Self {
        Jet::fixed(Interval::point(value))
    }
}

impl Add for Jet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Jet {
            value: self.value + other.value,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }
}

impl Add<f64> for Jet {
    type Output = Self;

    fn add(self, other: f64) -> Self {
        Jet { value: self.value + Interval::point(other), ..self }
    }
}

impl Sub for Jet {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other * -1.0
    }
}

impl Mul for Jet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Jet {
            value: self.value * other.value,
            first: self.first * other.value + self.value * other.first,
            second: self.second * other.value
                + self.first * other.first * 2.0
                + self.value * other.second,
        }
    }
}

impl Mul<f64> for Jet {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Jet { value: self.value * factor, first: self.first * factor, second: self.second * factor }
    }
}

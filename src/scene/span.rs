//! Closed intervals of a quantity, and their arithmetic.

use crate::error::{Error, Result};
use crate::units::short;
use std::fmt;

/// A closed interval. A constant is an interval of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The lower end.
    pub low: f64,
    /// The upper end, at least the lower.
    pub high: f64,
}

impl Span {
    /// All of [0, 1].
    pub const UNIT: Span = Span { low: 0.0, high: 1.0 };

    /// The interval of one number.
    pub const fn point(value: f64) -> Self {
        Span { low: value, high: value }
    }

    /// An interval of two finite ends in order; `what` names the quantity in the error.
    pub fn new(what: &str, low: f64, high: f64) -> Result<Self> {
        if low.is_finite() && high.is_finite() && low <= high {
            return Ok(Span { low, high });
        }
        let got = format!("{} to {}", short(low), short(high));
        let cure = "give the lower end first";
        Err(Error::bad_input(what, "two finite numbers in order", got, cure))
    }

    /// Whether it is one number.
    pub fn is_point(self) -> bool {
        self.low == self.high
    }

    /// Whether it lies in this one.
    pub fn is_in(self, outer: Span) -> bool {
        outer.low <= self.low && self.high <= outer.high
    }

    /// The smallest interval that holds both.
    pub fn hull(self, other: Span) -> Span {
        Span { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The smallest interval that holds all of these; none if there are none.
    pub fn hull_of(spans: impl IntoIterator<Item = Span>) -> Option<Span> {
        spans.into_iter().reduce(Span::hull)
    }

    /// What lies in both; none if nothing does.
    pub fn overlap(self, other: Span) -> Option<Span> {
        let both = Span { low: self.low.max(other.low), high: self.high.min(other.high) };
        (both.low <= both.high).then_some(both)
    }

    /// Both ends through a function that does not fall.
    pub fn map(self, rising: impl Fn(f64) -> f64) -> Span {
        Span { low: rising(self.low), high: rising(self.high) }
    }

    /// The products of two intervals of numbers that are not negative.
    pub fn times(self, other: Span) -> Span {
        Span { low: self.low * other.low, high: self.high * other.high }
    }

    /// 1 minus it.
    pub fn complement(self) -> Span {
        Span { low: 1.0 - self.high, high: 1.0 - self.low }
    }

    /// Both ends moved into this interval.
    pub fn clamped(self, to: Span) -> Span {
        self.map(|end| end.clamp(to.low, to.high))
    }
}

/// For reading: four decimals.
impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (decimals(self.low), decimals(self.high));
        if low == high { write!(f, "{low}") } else { write!(f, "{low}..{high}") }
    }
}

fn decimals(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

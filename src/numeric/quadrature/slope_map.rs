//! The slope map y = sinh(2p atanh w): it spreads scaled slopes y = tan(θ_h)/α over w in (-1, 1),
//! so that the peak of a lobe and its long tail both look smooth to a Gauss rule. Only + - × ÷ √
//! are needed for p = 2 and 4.
//!
//! With ρ = (1+w)/(1-w): y = (ρ^p - ρ^-p)/2 and dy/dw = p (ρ^p + ρ^-p) / ((1-w)(1+w)).

use crate::numeric::lanes::Real;

/// The exponent p of the map: 2 for rules with few nodes, 4 for many (wider strip of analyticity,
/// more nodes needed).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// y = sinh(4 atanh w)
    Two,
    /// y = sinh(8 atanh w)
    Four,
}

/// An interval of slopes as seen through the map. It lies on one side of 0 or contains 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeInterval<R = f64> {
    /// w at the lower end.
    pub w0: R,
    /// 1 + w at the lower end.
    pub plus0: R,
    /// 1 - w at the upper end.
    pub minus1: R,
    /// The length in w.
    pub width: R,
}

/// A slope and the Jacobian that carries a weight on [0, 1] to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappedSlope<R = f64> {
    /// The scaled slope.
    pub y: R,
    /// dy/du, u being the position on [0, 1] within the interval.
    pub dy: R,
}

/// 1 - w at the slope `y` ≥ 0, with full relative precision where w is near 1.
#[inline(always)]
pub fn slope_complement<R: Real>(y: R, power: Power) -> R {
    let e = (y + (y * y + 1.0).sqrt()).sqrt();
    (if power == Power::Four { e.sqrt() } else { e } + 1.0).recip() * 2.0
}

/// The interval from `y0` to `y1`, y0 ≤ y1 and 0 ≤ y1.
#[inline(always)]
pub fn slope_interval<R: Real>(y0: R, y1: R, power: Power) -> SlopeInterval<R> {
    let (c0, c1) = (slope_complement(y0.abs(), power), slope_complement(y1, power));
    let two = R::from(2.0);
    let below = |yes, no| y0.select_below(R::from(0.0), yes, no);
    SlopeInterval {
        w0: below(c0 - 1.0, c0.complement()),
        plus0: below(c0, two - c0),
        minus1: c1,
        width: below(two - c0 - c1, c0 - c1),
    }
}

/// The slope at position `u` in [0, 1] of an interval.
#[inline(always)]
pub fn slope_at<R: Real>(u: f64, interval: SlopeInterval<R>, power: Power) -> MappedSlope<R> {
    let w = interval.w0 + interval.width * u;
    let s = (interval.plus0 + interval.width * u) * (interval.minus1 + interval.width * (1.0 - u));
    let (w2, r) = (w * w, (s * s).recip());
    let sinh = w * 4.0 * (w2 + 1.0) * r;
    let cosh = (w2 * (w2 + 6.0) + 1.0) * r;
    match power {
        Power::Two => MappedSlope { y: sinh, dy: interval.width * 4.0 * cosh / s },
        Power::Four => MappedSlope {
            y: sinh * 2.0 * cosh,
            dy: interval.width * 8.0 * (sinh * 2.0 * sinh + 1.0) / s,
        },
    }
}

//! The slope map y = sinh(2p atanh w): it spreads scaled slopes y = tan(θ_h)/α over w in (-1, 1), so that the peak of a
//! lobe and its long tail both look smooth to a Gauss rule. Only + - × ÷ √ are needed for p = 2 and 4.
//!
//! With ρ = (1+w)/(1-w): y = (ρ^p - ρ^-p)/2 and dy/dw = p (ρ^p + ρ^-p) / ((1-w)(1+w)).

/// The exponent p of the map: 2 for rules with few nodes, 4 for many (wider strip of analyticity, more nodes needed).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Power {
    /// y = sinh(4 atanh w)
    Two,
    /// y = sinh(8 atanh w)
    Four,
}

/// An interval of slopes as seen through the map. It lies on one side of 0 or contains 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeInterval {
    /// w at the lower end.
    pub w0: f64,
    /// 1 + w at the lower end.
    pub plus0: f64,
    /// 1 - w at the upper end.
    pub minus1: f64,
    /// The length in w.
    pub width: f64,
}

/// A slope and the Jacobian that carries a weight on [0, 1] to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappedSlope {
    /// The scaled slope.
    pub y: f64,
    /// dy/du, u being the position on [0, 1] within the interval.
    pub dy: f64,
}

/// 1 - w at the slope `y` ≥ 0, with full relative precision where w is near 1.
pub fn slope_complement(y: f64, power: Power) -> f64 {
    let e = (y + (1.0 + y * y).sqrt()).sqrt();
    2.0 / (1.0 + if power == Power::Four { e.sqrt() } else { e })
}

/// The interval from `y0` to `y1`, y0 ≤ y1 and 0 ≤ y1.
pub fn slope_interval(y0: f64, y1: f64, power: Power) -> SlopeInterval {
    let (c0, c1) = (slope_complement(y0.abs(), power), slope_complement(y1, power));
    if y0 < 0.0 {
        SlopeInterval { w0: c0 - 1.0, plus0: c0, minus1: c1, width: 2.0 - c0 - c1 }
    } else {
        SlopeInterval { w0: 1.0 - c0, plus0: 2.0 - c0, minus1: c1, width: c0 - c1 }
    }
}

/// The slope at position `u` in [0, 1] of an interval.
pub fn slope_at(u: f64, interval: SlopeInterval, power: Power) -> MappedSlope {
    let w = interval.w0 + interval.width * u;
    let s = (interval.plus0 + interval.width * u) * (interval.minus1 + interval.width * (1.0 - u));
    let (w2, r) = (w * w, 1.0 / (s * s));
    let sinh = 4.0 * w * (1.0 + w2) * r;
    let cosh = (1.0 + w2 * (6.0 + w2)) * r;
    match power {
        Power::Two => MappedSlope { y: sinh, dy: interval.width * 4.0 * cosh / s },
        Power::Four => MappedSlope { y: 2.0 * sinh * cosh, dy: interval.width * 8.0 * (1.0 + 2.0 * sinh * sinh) / s },
    }
}

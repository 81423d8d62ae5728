//! What is asked of a value: which stored value it is, whether that is beyond doubt, and whether two of them agree.

use crate::integrate::ScaleBias;
use crate::lut::{Grid, Lut};
use crate::precision::Precision;

/// The same, but 0 for -0: no albedo is negative, though an estimate of a tiny one may be.
fn unsigned(value: f64) -> f64 {
    value + 0.0
}

/// What the arithmetic of channels may err, relative: eight units in the last place.
const ROUNDING: f64 = 2e-15;

/// What is to be certified.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The table.
    pub lut: &'a Lut,
    /// Its points.
    pub grid: &'a Grid,
    /// How it is stored.
    pub precision: Precision,
    /// The largest error of an integral that is stored in f32.
    pub tolerance: f64,
}

impl Task<'_> {
    /// The stored `values` of a texel at n·v = `mu`, from its integral and its row's average, each with what it may be off; and
    /// whether they are beyond doubt.
    pub(super) fn decide(
        &self,
        mu: f64,
        (integral, errors): (ScaleBias, ScaleBias),
        (average, average_errors): (ScaleBias, ScaleBias),
        values: &mut [f64],
    ) -> bool {
        // A channel is monotonic along this line from one end to the other.
        let at = |t: f64| {
            let integral = ScaleBias { a: integral.a + t * errors.a, b: integral.b + t * errors.b };
            let average = ScaleBias { a: average.a - t * average_errors.a, b: average.b - t * average_errors.b };
            self.lut.values(mu, integral, average)
        };
        let (one, other) = (at(-1.0), at(1.0));
        let mut decided = true;
        for (channel, stored) in values.iter_mut().enumerate() {
            let (low, high) = (one[channel].min(other[channel]), one[channel].max(other[channel]));
            // The arithmetic of a family's channels may err by a few units in the last place.
            let slack = if matches!(self.lut, Lut::Energy(_)) { ROUNDING * high.abs() } else { 0.0 };
            let (low, high) = (self.precision.nearest(low - slack), self.precision.nearest(high + slack));
            decided &= low == high;
            *stored = unsigned(low);
        }
        if !decided {
            self.store(mu, integral, average, values);
        }
        decided
    }

    /// The stored `values` of a texel from its integral and its row's average.
    #[inline]
    pub(super) fn store(&self, mu: f64, integral: ScaleBias, average: ScaleBias, values: &mut [f64]) {
        for (stored, value) in values.iter_mut().zip(self.lut.values(mu, integral, average)) {
            *stored = unsigned(self.precision.nearest(value));
        }
    }

    /// How near the nearest of a texel's values is to a boundary of rounding.
    pub(super) fn distance_to_boundary(&self, mu: f64, integral: ScaleBias, average: ScaleBias) -> f64 {
        let values = self.lut.values(mu, integral, average).into_iter().take(self.lut.channels().len());
        values.map(|value| self.precision.distance_to_boundary(value)).fold(f64::INFINITY, f64::min)
    }
}

/// Refuses two values that are farther apart than both may err.
pub(super) fn check_apart(
    theirs: ScaleBias,
    ours: ScaleBias,
    allowed: ScaleBias,
    errors: ScaleBias,
) -> Result<(), String> {
    // Written so that NaN fails.
    let close = |x: f64, y: f64, allowed: f64| (x - y).abs() <= allowed;
    if close(theirs.a, ours.a, allowed.a + errors.a) && close(theirs.b, ours.b, allowed.b + errors.b) {
        return Ok(());
    }
    Err(format!(
        "gives A = {:e} and B = {:e} where they are {:e} and {:e}: farther apart than {:e} and {:e}",
        theirs.a,
        theirs.b,
        ours.a,
        ours.b,
        allowed.a + errors.a,
        allowed.b + errors.b
    ))
}

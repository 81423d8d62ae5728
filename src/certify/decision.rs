//! What is asked of a value: which stored value it is, whether that is beyond doubt, and whether two of them agree.

use crate::ball::Ball;
use crate::integrate::ScaleBias;
use crate::lut::{Grid, Lut};
use crate::precision::Precision;

/// The same, but 0 for -0: no albedo is negative, though an estimate of a tiny one may be.
fn unsigned(value: f64) -> f64 {
    value + 0.0
}

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
    /// The stored `values` of a texel at n·v = `mu`, from its integral and its row's average; whether they are beyond
    /// doubt: whether whatever the truth may be rounds to the same; and the most that any of them may be off before it
    /// is rounded: of values above 1 relative.
    #[inline]
    pub(super) fn store(
        &self,
        mu: f64,
        integral: ScaleBias<Ball>,
        average: ScaleBias<Ball>,
        values: &mut [f64],
    ) -> (bool, f64) {
        let (mut decided, mut worst) = (true, 0.0f64);
        for (stored, channel) in values.iter_mut().zip(self.lut.values(mu, integral, average)) {
            decided &= self.precision.nearest(channel.low()) == self.precision.nearest(channel.high());
            // A division is dear, and values above 1 are few.
            let size = channel.value.abs();
            worst = worst.max(if size > 1.0 { channel.error / size } else { channel.error });
            // No channel is negative, though an estimate of what is nearly 0 may be.
            let value = if channel.value < 0.0 && channel.high() >= 0.0 { 0.0 } else { channel.value };
            *stored = unsigned(self.precision.stored(value));
        }
        (decided, worst)
    }

    /// How near the nearest of a texel's values is to a boundary of rounding.
    pub(super) fn distance_to_boundary(&self, mu: f64, integral: ScaleBias, average: ScaleBias<Ball>) -> f64 {
        let integral = integral.within(ScaleBias::zero());
        let values = self.lut.values(mu, integral, average).into_iter().take(self.lut.channels().len());
        values.map(|value| self.precision.distance_to_boundary(value.value)).fold(f64::INFINITY, f64::min)
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

//! The steps on which the numbers of a file lie, which may be coarser than its storage.

use super::channel::Channel;
use crate::foreign::Foreign;
use crate::numeric::half;
use crate::table::precision::Precision;

/// The share of numbers that a storage has to hold to be theirs.
const SHARE: f64 = 0.99;

/// The coarsest storage that holds the numbers of a file, and that of the file where none is
/// coarser.
pub fn quantisation(table: &Foreign) -> Precision {
    let held = |holds: fn(f64) -> bool| {
        let (mut held, mut all) = (0, 0);
        for value in table.values.iter().filter(|value| value.is_finite()) {
            all += 1;
            held += usize::from(holds(f64::from(*value)));
        }
        held as f64 >= SHARE * all as f64
    };
    // What f32 loses of a code is below a millionth of a step of 16 bits.
    fn on_steps(value: f64, steps: f64) -> bool {
        (0.0..=1.0).contains(&value) && ((value * steps) - (value * steps).round()).abs() < 0.02
    }
    // Codes of 8 bits are codes of 16 bits too: the coarsest first.
    if held(|value| on_steps(value, 255.0)) {
        return Precision::Unorm8;
    }
    match table.storage {
        Precision::F32 if held(|value| half::nearest(value) == value) => Precision::F16,
        Precision::F32 if held(|value| on_steps(value, 65535.0)) => Precision::Unorm16,
        storage => storage,
    }
}

/// What these steps are off by on the average, a quarter of a step, in units of each channel's
/// spread; of floats nothing.
pub fn rounding(steps: Precision, channels: &[Channel]) -> Vec<f64> {
    let error = match steps {
        Precision::Unorm8 | Precision::Unorm16 => 0.5 * steps.half_step(),
        _ => 0.0,
    };
    channels.iter().map(|channel| error / channel.spread).collect()
}

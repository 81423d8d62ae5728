//! Rows of halves whose values are the integrals themselves: both ends of the balls of eight texels
//! are rounded at a time.

use super::decider::BOTH_SIDES;
use crate::integrate::errors::RowErrors;
use crate::numeric::half::nearest_to_all;
use crate::numeric::lanes::{F64x8, Real, Vector, Work};
use std::array::from_fn;

/// A row of texels of N integrals each.
pub(super) struct Halves<'a, const N: usize> {
    pub errors: &'a RowErrors,
    /// [`BOTH_SIDES`] times these errors are added.
    pub margin: Option<&'a RowErrors>,
    pub integrals: &'a [[f64; N]],
    /// Filled in, and NaN where a half is in doubt.
    pub values: &'a mut [[f64; N]],
}

impl<const N: usize> Work for Halves<'_, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        const LANES: usize = F64x8::LANES;
        let groups = self.values.chunks_mut(LANES).zip(self.integrals.chunks(LANES));
        for (values, integrals) in groups {
            let last = integrals.len() - 1;
            let lanes: [F64x8; N] = from_fn(|k| F64x8::gather(|i| integrals[i.min(last)][k]));
            let errors = self.errors.of(&lanes);
            let margins = self.margin.map(|margin| margin.of(&lanes));
            let halves: [F64x8; N] = from_fn(|k| {
                let margin = margins.map_or(F64x8::from(0.0), |margins| margins[k] * BOTH_SIDES);
                lanes[k].zip(errors[k] + margin, nearest_to_all)
            });
            for (i, values) in values.iter_mut().enumerate() {
                *values = halves.map(|half| half.lane(i));
            }
        }
    }
}

//! The findings of the stages over all bands of a table, and the certificate that follows from
//! them.

use super::decision::Task;
use super::stages::Stages;
use crate::error::{Error, Result};
use crate::integrate::Integrand;
use crate::integrate::average::AVERAGE_ERROR;
use crate::integrate::bounds::MARGIN;
use crate::table::claim::{Certificate, Stage, StageError};

/// The findings of the stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// The number of texels.
    pub texels: usize,
    /// Texels that the reference had to decide.
    pub by_reference: usize,
    /// Texels that are left.
    pub undecided: usize,
    /// The largest error, before it is rounded, of a value that is not known to be rounded
    /// correctly; of values above 1 relative.
    pub error: f64,
    /// The smallest distance from a boundary of rounding among the values that the reference
    /// decided.
    pub smallest_distance: Option<f64>,
    /// The work of each stage.
    pub stages: Vec<Stage>,
}

impl Tally {
    /// The findings where each texel stands for so many.
    pub fn times(mut self, count: usize) -> Tally {
        self.texels *= count;
        self.by_reference *= count;
        self.undecided *= count;
        for stage in &mut self.stages {
            stage.texels *= count;
            stage.decided = stage.decided.map(|decided| decided * count);
        }
        self
    }

    /// The findings of two bands together.
    pub fn merge(mut self, other: Tally) -> Tally {
        self.texels += other.texels;
        self.by_reference += other.by_reference;
        self.undecided += other.undecided;
        self.error = self.error.max(other.error);
        self.smallest_distance = match (self.smallest_distance, other.smallest_distance) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        // Every band goes through the same stages in the same order, some no further than the
        // first.
        for (i, stage) in other.stages.into_iter().enumerate() {
            match self.stages.get_mut(i) {
                Some(own) => {
                    own.error =
                        own.error.into_iter().chain(stage.error).reduce(StageError::or_wider);
                    own.texels += stage.texels;
                    own.decided = own.decided.zip(stage.decided).map(|(a, b)| a + b);
                }
                None => self.stages.push(stage),
            }
        }
        self
    }

    /// The certificate of the table that is stored with the hash `blake3`. An error where a
    /// channel's formula leaves no bound of a value's error.
    pub fn certificate(&self, task: &Task, stages: &Stages, blake3: String) -> Result<Certificate> {
        let Tally { texels, by_reference, undecided, error, smallest_distance, .. } = *self;
        if !error.is_finite() {
            return Err(unbounded());
        }
        let integrand = task.lut.integrand();
        let averages = if task.lut.needs_averages() { AVERAGE_ERROR } else { 0.0 };
        let reference_error =
            stages.bakers.last().map_or(0.0, |baker| baker.rule.bound(integrand)).max(averages);
        // A diffuse lobe's closed form errs by its arithmetic alone.
        let measured = match integrand {
            Integrand::Diffuse(_) => String::new(),
            Integrand::Specular(..) | Integrand::Glass(_) => {
                format!("; the error bounds are measured, with a margin of {MARGIN}")
            }
        };
        let rounded = format!(
            "every value is the true integral, rounded once to the nearest, ties to even{measured}"
        );
        let at_most = rounded_up(error);
        let promise = if !stages.rounds_correctly {
            format!(
                "before it was rounded, every value was within {at_most} of the true integral (of \
                 values above 1 relative){measured}"
            )
        } else if undecided == 0 {
            rounded
        } else {
            format!(
                "{rounded}; but {undecided} texels hold a value that is known to within {at_most} \
                 only (of values above 1 relative) and may be rounded to a neighbour, or farther \
                 where steps are finer"
            )
        };
        Ok(Certificate {
            promise,
            bound: task.precision.half_step() + error,
            texels,
            decided_before_reference: texels - undecided - by_reference,
            decided_by_reference: by_reference,
            undecided,
            reference_error,
            smallest_distance,
            blake3,
        })
    }
}

/// The error of a channel whose formula leaves no bound of its error.
pub fn unbounded() -> Error {
    let got = "a channel that divides by what may be 0 within the integral's error";
    let cure = "give a smaller --tolerance, or an --f0 farther from 1, or raise the \
                min of the axis of roughness";
    Error::bad_input("accuracy", "a bound of every value's error", got, cure)
}

/// The number to two digits, rounded up.
fn rounded_up(number: f64) -> String {
    let text = format!("{number:.1e}");
    if text.parse().is_ok_and(|shown: f64| shown >= number) {
        return text;
    }
    // Half a unit of the second digit is at most 5 % of the number.
    format!("{:.1e}", number * 1.05)
}

//! A stage at work on texels: what it takes over, and what the rest of them may be off.

use super::decision::Task;
use crate::ball::Ball;
use crate::integrate::rule::Rule;
use crate::integrate::{Integrand, ScaleBias};

/// What earlier stages keep of the error of the last rule before the reference: theirs and its own may point apart,
/// and a thousandth more, since the share of B is taken of the earlier stage's B.
pub(super) const MARGIN: f64 = 2.001;

/// What a stage has decided of some texels.
#[derive(Clone, Copy, Default)]
pub(super) struct Verdict {
    /// How many.
    pub decided: usize,
    /// The most that a value of the others may be off.
    pub error: f64,
}

impl Verdict {
    /// Both together.
    pub fn with(self, other: Verdict) -> Verdict {
        Verdict { decided: self.decided + other.decided, error: self.error.max(other.error) }
    }
}

/// A stage as texels are decided by it.
pub(super) struct Decider<'a, E> {
    pub task: &'a Task<'a>,
    pub averages: &'a [ScaleBias<Ball>],
    /// What the stage's A and B may be off, by its own type: it is asked at every texel.
    pub errors_at: E,
    /// [`MARGIN`] times the error of this rule is kept.
    pub margin: Option<Rule>,
    /// Whether mirrors are in f64, and err by no more than its arithmetic.
    pub exact_mirrors: bool,
    pub rounds_correctly: bool,
}

impl<E: Fn(f64, ScaleBias) -> ScaleBias + Sync> Decider<'_, E> {
    /// The integral at (n·v, α) with what it may be off.
    fn integral(&self, mu: f64, alpha: f64, value: ScaleBias) -> ScaleBias<Ball> {
        let integrand = self.task.lut.integrand();
        if let (true, 0.0, Integrand::Specular(lobe)) = (self.exact_mirrors, alpha, integrand) {
            let mu = Ball::exact(mu);
            return ScaleBias::mirror(mu, lobe.smooth_limit(mu));
        }
        let mut errors = (self.errors_at)(alpha, value);
        if let Some(margin) = &self.margin {
            errors.add(MARGIN, margin.errors_at(integrand, alpha, value));
        }
        value.within(errors)
    }

    /// Takes over a texel's values if this stage decides them, and the best guess if it does not.
    pub fn texel(
        &self,
        (row, column): (usize, usize),
        value: ScaleBias,
        values: &mut [f64],
        open: &mut bool,
    ) -> Verdict {
        let (mu, alpha) = (self.task.grid.mus[column], self.task.grid.alphas[row]);
        let integral = self.integral(mu, alpha, value);
        let (same, error) = self.task.store(mu, integral, self.averages[row], values);
        let decided = self.rounds_correctly && same;
        *open = !decided;
        Verdict { decided: usize::from(decided), error: if decided { 0.0 } else { error } }
    }

    /// The same for the open texels of a row.
    pub fn row(&self, row: usize, integrals: &[ScaleBias], values: &mut [f64], open: &mut [bool]) -> Verdict {
        let texels = values.chunks_exact_mut(values.len() / open.len()).zip(open).zip(integrals).enumerate();
        let mut verdict = Verdict::default();
        for (column, ((values, open), &value)) in texels {
            if *open {
                verdict = verdict.with(self.texel((row, column), value, values, open));
            }
        }
        verdict
    }
}

//! A stage at work on texels: the texels that it decides, and the largest error of the others.

use super::decision::{Averages, Task};
use super::halves::Halves;
use crate::brdf::fresnel::{MOST_WEIGHTS, with_basis};
use crate::brdf::interface::Interface;
use crate::brdf::{Fresnel, Microfacet};
use crate::integrate::errors::{Errors, RowErrors};
use crate::integrate::rule::Rule;
use crate::integrate::{Integrand, mirror};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::vectorised;
use crate::table::precision::Precision;

/// The multiple of the finest rule's error before the reference that earlier stages add to their
/// own: their values and its own may err in opposite directions, and a thousandth more, since its
/// relative part is taken of their values.
pub(super) const BOTH_SIDES: f64 = 2.001;

/// The outcome of a stage for some texels.
#[derive(Clone, Copy, Default)]
pub(super) struct Verdict {
    /// The number of decided texels.
    pub decided: usize,
    /// The largest error of a value of the others.
    pub error: f64,
}

impl Verdict {
    /// Both together.
    pub fn merge(self, other: Verdict) -> Verdict {
        Verdict { decided: self.decided + other.decided, error: self.error.max(other.error) }
    }
}

/// A stage that decides texels.
pub(super) struct Decider<'a> {
    pub task: &'a Task<'a>,
    pub averages: &'a Averages,
    /// The bounds of the stage's errors.
    pub errors: Errors,
    /// The least n·v that the errors are of.
    pub least_mu: f64,
    /// [`BOTH_SIDES`] times the errors of the [`finest`] of these are added.
    pub margins: &'a [Rule],
    /// Whether mirrors are computed in f64, and err by no more than its arithmetic.
    pub exact_mirrors: bool,
    pub rounds_correctly: bool,
}

/// Whose integrals are known to the last digits.
#[derive(Clone, Copy)]
enum Known {
    /// A row of mirrors.
    Mirrors(Microfacet, Fresnel),
    /// Some points of an interface at this α.
    Points(Interface, f64),
}

/// The bounds of a row.
struct Row<'a> {
    known: Option<Known>,
    errors: RowErrors,
    margin: Option<RowErrors>,
    averages: &'a [Ball],
}

/// The bounds of the finest of these rules at an α over all n·v, if it is finer there than the
/// stage's `own`.
pub(super) fn finest(
    margins: &[Rule],
    integrand: Integrand,
    own: &Errors,
    alpha: f64,
) -> Option<Errors> {
    let largest = |errors: &Errors| errors.row(0.0, alpha).largest();
    let of_margins = margins.iter().map(|margin| margin.errors(integrand));
    let finest = of_margins.min_by(|a, b| largest(a).total_cmp(&largest(b)));
    finest.filter(|finest| largest(finest) < largest(own))
}

impl Decider<'_> {
    fn row(&self, row: usize) -> Row<'_> {
        let alpha = self.task.grid.alphas[row];
        let integrand = self.task.lut.integrand();
        let known = match integrand {
            Integrand::Specular(lobe, fresnel) if self.exact_mirrors && alpha == 0.0 => {
                Some(Known::Mirrors(lobe, fresnel))
            }
            Integrand::Glass(interface) => Some(Known::Points(interface, alpha)),
            Integrand::Specular(..) | Integrand::Diffuse(_) => None,
        };
        let errors = self.errors.row(self.least_mu, alpha);
        let margin = finest(self.margins, integrand, &self.errors, alpha);
        let margin = margin.map(|margin| margin.row(self.least_mu, alpha));
        Row { known, errors, margin, averages: self.averages.row(row) }
    }

    /// Takes over a texel's values if this stage decides them, and the best guess if it does not.
    pub fn texel(
        &self,
        (row, column): (usize, usize),
        integrals: &[f64],
        values: &mut [f64],
        open: &mut bool,
    ) -> Verdict {
        self.texel_of(&self.row(row), column, integrals, values, open)
    }

    /// The same for the open texels of a row.
    pub fn texels_of_row(
        &self,
        row: usize,
        integrals: &[f64],
        values: &mut [f64],
        open: &mut [bool],
    ) -> Verdict {
        // The loops over a texel's integrals unroll where their number is known.
        match integrals.len() / open.len() {
            1 => self.texels_of_row_with::<1>(row, integrals, values, open),
            2 => self.texels_of_row_with::<2>(row, integrals, values, open),
            3 => self.texels_of_row_with::<3>(row, integrals, values, open),
            _ => self.texels_of_row_with::<MOST_WEIGHTS>(row, integrals, values, open),
        }
    }

    fn texels_of_row_with<const N: usize>(
        &self,
        row: usize,
        integrals: &[f64],
        values: &mut [f64],
        open: &mut [bool],
    ) -> Verdict {
        let channels = values.len() / open.len();
        let row = self.row(row);
        let (integrals, _) = integrals.as_chunks::<N>();
        let mut verdict = Verdict::default();
        if self.rounds_to_halves(&row) && open.iter().all(|&open| open) {
            let (values, _) = values.as_chunks_mut::<N>();
            let (errors, margin) = (&row.errors, row.margin.as_ref());
            vectorised(Halves { errors, margin, integrals, values });
            for (open, values) in open.iter_mut().zip(values) {
                *open = values.iter().any(|value| value.is_nan());
                verdict.decided += usize::from(!*open);
            }
        }
        let texels = values.chunks_exact_mut(channels).zip(open).zip(integrals).enumerate();
        for (column, ((values, open), integrals)) in texels {
            if *open {
                verdict = verdict.merge(self.texel_of(&row, column, integrals, values, open));
            }
        }
        verdict
    }

    /// Whether [`Halves`] decides nearly all texels of a row.
    fn rounds_to_halves(&self, row: &Row) -> bool {
        let task = self.task;
        let halves = self.rounds_correctly && task.precision == Precision::F16;
        halves && task.lut.is_integrals() && row.known.is_none() && !row.errors.on_device()
    }

    #[inline(always)]
    fn texel_of(
        &self,
        row: &Row,
        column: usize,
        integrals: &[f64],
        values: &mut [f64],
        open: &mut bool,
    ) -> Verdict {
        let mu = self.task.grid.mus[column];
        let balls = balls(row, mu, integrals);
        let (same, error) = self.task.store(mu, &balls[..integrals.len()], row.averages, values);
        let decided = self.rounds_correctly && same;
        *open = !decided;
        Verdict { decided: usize::from(decided), error: if decided { 0.0 } else { error } }
    }
}

/// The integrals of a texel with the bounds of their errors.
#[inline(always)]
fn balls(row: &Row, mu: f64, integrals: &[f64]) -> [Ball; MOST_WEIGHTS] {
    let mut balls = [Ball::default(); MOST_WEIGHTS];
    if let Some(Known::Mirrors(lobe, fresnel)) = row.known {
        // Exact but for the arithmetic.
        with_basis!(fresnel, basis => {
            let integrals = mirror(lobe, basis, mu);
            balls.iter_mut().zip(integrals).for_each(|(ball, integral)| *ball = integral);
        });
        return balls;
    }
    let errors = row.errors.of(integrals);
    let margins = match &row.margin {
        Some(margin) => margin.of(integrals),
        None => [0.0; MOST_WEIGHTS],
    };
    for (k, (ball, &value)) in balls.iter_mut().zip(integrals).enumerate() {
        *ball = Ball { value, error: errors[k] + BOTH_SIDES * margins[k] };
    }
    if let Some(Known::Points(interface, alpha)) = row.known {
        let exact = interface.exact(mu, alpha);
        balls.iter_mut().zip(exact).for_each(|(ball, exact)| *ball = exact.unwrap_or(*ball));
    }
    balls
}

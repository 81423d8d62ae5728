//! The questions asked of a value: which stored value it is, whether that is beyond doubt, and
//! whether two stages agree.

use crate::integrate::Field;
use crate::lut::Part;
use crate::numeric::ball::Ball;
use crate::table::grid::Grid;
use crate::table::precision::Precision;

/// A table to be certified.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The table, or the part of one.
    pub lut: &'a Part,
    /// Its points, of one slice.
    pub grid: &'a Grid,
    /// The number of slices of the whole table.
    pub slices: usize,
    /// Its storage.
    pub precision: Precision,
    /// The largest error of an integral stored within a tolerance; of no account for storages that
    /// are rounded once.
    pub tolerance: f64,
}

impl Task<'_> {
    /// The number of points to integrate at, those of averages included.
    pub fn points(&self) -> usize {
        let rows = self.grid.alphas.len();
        let texels = if self.lut.depends_on_nov() { self.grid.len() } else { rows };
        texels + rows * self.lut.averaged_directions()
    }

    /// Fills in the stored `values` of a texel at n·v = `mu`, from its integrals and its row's
    /// averages. Returns whether they are beyond doubt, which is whether both ends of every ball
    /// round to the same, and the largest error of any of them before it is rounded: of values
    /// above 1 relative.
    #[inline(always)]
    pub(super) fn store(
        &self,
        mu: f64,
        integrals: &[Ball],
        averages: &[Ball],
        values: &mut [f64],
    ) -> (bool, f64) {
        let (mut decided, mut worst) = (true, 0.0f64);
        let channels = self.lut.values(mu, integrals, averages);
        for ((stored, channel), range) in values.iter_mut().zip(channels).zip(self.lut.ranges()) {
            decided &=
                self.precision.nearest(channel.low()) == self.precision.nearest(channel.high());
            // A division is costly, and values above 1 are few.
            let size = channel.value.abs();
            worst = worst.max(if size > 1.0 { channel.error / size } else { channel.error });
            // An estimate near the least that a channel can be, such as 0, may lie below.
            let below = channel.value < range.0 && channel.high() >= range.0;
            let value = if below { range.0 } else { channel.value };
            // Adding 0 makes 0 of -0.
            *stored = self.precision.stored(value) + 0.0;
        }
        (decided, worst)
    }

    /// The smallest distance of a texel's values from a boundary of rounding.
    pub(super) fn distance_to_boundary(
        &self,
        mu: f64,
        integrals: &[f64],
        averages: &[Ball],
    ) -> f64 {
        let integrals: Vec<Ball> =
            integrals.iter().map(|&integral| Ball::exact(integral)).collect();
        let values = self.lut.values(mu, &integrals, averages).into_iter().take(self.lut.count());
        values
            .map(|value| self.precision.distance_to_boundary(value.value))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Refuses integrals that are farther apart than the errors of both allow.
pub(super) fn check_apart(
    theirs: &[f64],
    ours: &[f64],
    their_errors: &[f64],
    our_errors: &[f64],
) -> Result<(), String> {
    let allowed = || their_errors.iter().zip(our_errors).map(|(theirs, ours)| theirs + ours);
    // Written so that NaN fails.
    let close =
        theirs.iter().zip(ours).zip(allowed()).all(|((x, y), allowed)| (x - y).abs() <= allowed);
    if close {
        return Ok(());
    }
    let listed = |values: &mut dyn Iterator<Item = f64>| {
        values.take(ours.len()).map(|value| format!("{value:e}")).collect::<Vec<_>>().join(", ")
    };
    Err(format!(
        "gives the integrals {} where they are {}: farther apart than {}",
        listed(&mut theirs.iter().copied()),
        listed(&mut ours.iter().copied()),
        listed(&mut allowed())
    ))
}

/// The averages of the rows of a table with the bounds of their errors; zeros where none are
/// needed.
#[derive(Clone, Debug)]
pub(super) struct Averages {
    count: usize,
    balls: Vec<Ball>,
}

impl Averages {
    /// Zeros: `count` averages for each of `rows` rows.
    pub fn zeros(count: usize, rows: usize) -> Self {
        Averages { count, balls: vec![Ball::default(); count * rows] }
    }

    /// The averages of a row.
    pub fn row(&self, row: usize) -> &[Ball] {
        &self.balls[row * self.count..][..self.count]
    }

    /// Sets averages of a row from the one with this index on.
    pub fn set(&mut self, row: usize, first: usize, averages: impl Iterator<Item = Ball>) {
        let balls = &mut self.balls[row * self.count..][..self.count];
        balls[first..].iter_mut().zip(averages).for_each(|(ball, average)| *ball = average);
    }
}

/// The integrals of a stage at a few texels, in ascending order of the texels, or at all.
pub(super) struct Seen {
    /// The texels; none where they are all of them.
    pub texels: Option<Vec<usize>>,
    /// Their integrals.
    pub integrals: Field,
}

impl Seen {
    /// The number of texels.
    pub fn len(&self) -> usize {
        self.integrals.len()
    }

    /// The texel with a place among them.
    pub fn texel(&self, place: usize) -> usize {
        self.texels.as_ref().map_or(place, |texels| texels[place])
    }

    /// The integrals of a texel, if it is among them.
    pub fn of(&self, texel: usize) -> Option<&[f64]> {
        let place = match &self.texels {
            None => Some(texel),
            Some(texels) => texels.binary_search(&texel).ok(),
        };
        place.map(|place| self.integrals.at(place))
    }
}

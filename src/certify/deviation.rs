//! Checks on a sample: a device's table is compared with the CPU's, and any table with the
//! reference, before it is used.

use crate::backend::cpu;
use crate::error::{Error, Result};
use crate::integrate::errors::f32_arithmetic;
use crate::integrate::rule::Rule;
use crate::integrate::{Field, Integrand, scale};
use crate::table::grid::Grid;

/// Texels for each one that the CPU repeats: a workgroup's worth, so that no workgroup can go
/// missing unnoticed.
const RUN: usize = 64;

/// Points of a table that are measured against the reference, at half a millisecond each.
pub const MEASURED: usize = 128;

/// The largest differences over a sample of points: texels, and the directions of averages.
/// Absolute, or relative where an albedo exceeds 1.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Deviation {
    /// The largest of each integral.
    pub largest: Vec<f64>,
    /// The number of points.
    pub points: usize,
}

impl Deviation {
    /// The deviation over a sample, and the (n·v, α) of the largest.
    fn between(grid: &Grid, sample: &[usize], table: &Field, truth: &Field) -> (Self, (f64, f64)) {
        let mut worst = Deviation { largest: vec![0.0; truth.count()], points: sample.len() };
        let mut at = grid.point(0);
        for (&index, truth) in sample.iter().zip(truth.iter()) {
            let scale = scale(truth);
            let differences =
                table.at(index).iter().zip(truth).map(|(x, y)| distance(*x, *y) / scale);
            let differences: Vec<f64> = differences.collect();
            if largest(&differences) > worst.max() {
                at = grid.point(index);
            }
            worst = worst.merge(Deviation { largest: differences, points: 0 });
        }
        (worst, at)
    }

    /// Both samples together.
    pub fn merge(mut self, other: Deviation) -> Deviation {
        self.largest.resize(self.largest.len().max(other.largest.len()), 0.0);
        self.largest.iter_mut().zip(other.largest).for_each(|(own, other)| *own = own.max(other));
        Deviation { points: self.points + other.points, ..self }
    }

    /// The largest of all integrals.
    pub fn max(&self) -> f64 {
        largest(&self.largest)
    }

    /// The differences of the integrals with these names, in words: `A 1.0e-6, B 2.0e-7`.
    pub fn in_words(&self, names: &[&str]) -> String {
        let word = |(name, difference): (&&str, &f64)| format!("{name} {difference:.1e}");
        names.iter().zip(&self.largest).map(word).collect::<Vec<_>>().join(", ")
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Compares a device's table with the CPU at one texel of every 64, at the corners, and every texel
/// with the range of the lobe's albedo: a device that leaves out, zeroes or mixes up anything as
/// large as a workgroup is found out.
pub fn cross_check(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    table: &Field,
) -> Result<Deviation> {
    let integrand = integrand.into();
    check_range(integrand, grid, rule, table)?;
    let allowed = f32_arithmetic(integrand);
    let sample: Vec<usize> = sample(grid).collect();
    let truth = cpu::bake_at(integrand, grid, rule, &sample);
    let (worst, (mu, alpha)) = Deviation::between(grid, &sample, table, &truth);
    if worst.max() <= allowed {
        return Ok(worst);
    }
    let differences = worst.in_words(&integrand.names());
    Err(Error::CheckFailed(format!(
        "device and CPU differ by {differences}, where {allowed:e} is allowed, worst at n.v = \
         {mu}, alpha = {alpha}; the table is thrown away; use another device, or --backend cpu"
    )))
}

/// Refuses a device's table with a value that no albedo can have.
pub(super) fn check_range(
    integrand: Integrand,
    grid: &Grid,
    rule: &Rule,
    table: &Field,
) -> Result<()> {
    let allowed = f32_arithmetic(integrand);
    let most = if integrand.may_exceed_one() {
        f64::from(f32::MAX)
    } else {
        1.0 + rule.bound(integrand) + allowed
    };
    let range = -allowed..=most;
    let Some(index) = table.values().iter().position(|value| !range.contains(value)) else {
        return Ok(());
    };
    let (value, (mu, alpha)) = (table.values()[index], grid.point(index / table.count()));
    let name = integrand.names()[index % table.count()];
    Err(Error::CheckFailed(format!(
        "at n.v = {mu}, alpha = {alpha} the device gives {name} = {value}, which no albedo can be; \
         the table is thrown away; use another device, or --backend cpu"
    )))
}

/// A texel of every 64, and the corners.
pub(super) fn sample(grid: &Grid) -> impl Iterator<Item = usize> {
    let texels = grid.len();
    let runs =
        (0..texels).step_by(RUN).map(move |first| first + scatter(first) % RUN.min(texels - first));
    corners(grid).into_iter().chain(runs)
}

/// Measures a table by `rule` against the reference at the corners and at other points scattered
/// over it, `points` in all; an error beyond the `bound` fails.
pub fn measure(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    bound: f64,
    table: &Field,
    points: usize,
) -> Result<Deviation> {
    let integrand = integrand.into();
    let points = points.max(corners(grid).len() + 1);
    let sample: Vec<usize> = if grid.len() <= points {
        (0..grid.len()).collect()
    } else {
        let strata = points - corners(grid).len();
        let stratum = |i: usize| i * grid.len() / strata;
        let scattered = |i| stratum(i) + scatter(i) % (stratum(i + 1) - stratum(i));
        corners(grid).into_iter().chain((0..strata).map(scattered)).collect()
    };
    let truth = cpu::bake_at(integrand, grid, &rule.gauge(integrand), &sample);
    let (worst, (mu, alpha)) = Deviation::between(grid, &sample, table, &truth);
    if worst.max() <= bound {
        return Ok(worst);
    }
    let errors = worst.in_words(&integrand.names());
    Err(Error::CheckFailed(format!(
        "the table errs by {errors}, where {bound:e} is promised, worst at n.v = {mu}, alpha = \
         {alpha}; please report this request"
    )))
}

fn corners(grid: &Grid) -> [usize; 4] {
    [0, grid.mus.len() - 1, grid.len() - grid.mus.len(), grid.len() - 1]
}

/// |a - b|; NaN is as far away as can be.
fn distance(a: f64, b: f64) -> f64 {
    let distance = (a - b).abs();
    if distance.is_nan() { f64::INFINITY } else { distance }
}

/// A fixed scattering of integers: the finaliser of SplitMix64 (Steele, Lea and Flood 2014).
pub(super) fn scatter(index: usize) -> usize {
    let mut z = (index as u64).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as usize
}

//! Checks on a sample: a device's table is compared with the CPU's, and any table with the reference, before it is
//! used.

use crate::backend::cpu;
use crate::error::{Error, Result};
use crate::integrate::rule::{Rule, f32_arithmetic};
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::Grid;
use serde::Serialize;

/// Texels for each one that the CPU repeats: a workgroup's worth, so that no workgroup can go missing unnoticed.
const RUN: usize = 64;

/// Texels of a table that are measured against the reference, at half a millisecond each.
pub const MEASURED: usize = 128;

/// The largest differences over a sample of texels: absolute, or of albedos above 1 relative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Deviation {
    /// Of A.
    pub a: f64,
    /// Of B.
    pub b: f64,
    /// Over so many texels.
    pub texels: usize,
}

impl Deviation {
    fn between(grid: &Grid, sample: &[usize], table: &[ScaleBias], truth: &[ScaleBias]) -> (Self, (f64, f64)) {
        let mut worst = Deviation { texels: sample.len(), ..Deviation::default() };
        let mut at = grid.point(0);
        for (&index, truth) in sample.iter().zip(truth) {
            let scale = truth.e().max(1.0);
            let (a, b) = (distance(table[index].a, truth.a) / scale, distance(table[index].b, truth.b) / scale);
            if a.max(b) > worst.largest() {
                at = grid.point(index);
            }
            worst = Deviation { a: a.max(worst.a), b: b.max(worst.b), ..worst };
        }
        (worst, at)
    }

    /// Both samples together.
    pub fn with(self, other: Deviation) -> Deviation {
        Deviation { a: self.a.max(other.a), b: self.b.max(other.b), texels: self.texels + other.texels }
    }

    /// The larger of the two.
    pub fn largest(&self) -> f64 {
        self.a.max(self.b)
    }

    fn within(&self, bound: f64) -> bool {
        self.a <= bound && self.b <= bound
    }
}

/// Compares a device's table with the CPU at one texel of every 64, at the corners, and every texel with the range
/// of the lobe's albedo: a device that leaves out, zeroes or mixes up anything as large as a workgroup is found out.
pub fn cross_check(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    table: &[ScaleBias],
) -> Result<Deviation> {
    let integrand = integrand.into();
    check_range(integrand, grid, rule, table)?;
    let allowed = f32_arithmetic(integrand);
    let sample: Vec<usize> = sample(grid).collect();
    let truth = cpu::bake_at(integrand, grid, rule, &sample);
    let (worst, (mu, alpha)) = Deviation::between(grid, &sample, table, &truth);
    if worst.within(allowed) {
        return Ok(worst);
    }
    Err(Error::CheckFailed(format!(
        "device and CPU differ by {:e} in A and {:e} in B, {allowed:e} being allowed, worst at n.v = {mu}, \
         alpha = {alpha}; the table is thrown away; use another device, or --backend cpu",
        worst.a, worst.b
    )))
}

/// Refuses a device's table with a value that no albedo can have.
pub(super) fn check_range(integrand: Integrand, grid: &Grid, rule: &Rule, table: &[ScaleBias]) -> Result<()> {
    let allowed = f32_arithmetic(integrand);
    let most = if integrand.may_exceed_one() { f64::from(f32::MAX) } else { 1.0 + rule.bound(integrand) + allowed };
    let range = -allowed..=most;
    let Some(index) = table.iter().position(|v| !range.contains(&v.a) || !range.contains(&v.b)) else { return Ok(()) };
    let (mu, alpha) = grid.point(index);
    let ScaleBias { a, b } = table[index];
    Err(Error::CheckFailed(format!(
        "at n.v = {mu}, alpha = {alpha} the device gives A = {a}, B = {b}, which no albedo can be; \
         the table is thrown away; use another device, or --backend cpu"
    )))
}

/// A texel of every 64, and the corners.
pub(super) fn sample(grid: &Grid) -> impl Iterator<Item = usize> {
    let texels = grid.len();
    let runs = (0..texels).step_by(RUN).map(move |first| first + scatter(first) % RUN.min(texels - first));
    corners(grid).into_iter().chain(runs)
}

/// Measures a table by `rule` against the reference, at the corners and at others scattered over it, so many `texels`
/// in all; an error beyond the `bound` fails.
pub fn measure(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    bound: f64,
    table: &[ScaleBias],
    texels: usize,
) -> Result<Deviation> {
    let integrand = integrand.into();
    let texels = texels.max(corners(grid).len() + 1);
    let sample: Vec<usize> = if grid.len() <= texels {
        (0..grid.len()).collect()
    } else {
        let strata = texels - corners(grid).len();
        let stratum = |i: usize| i * grid.len() / strata;
        let scattered = |i| stratum(i) + scatter(i) % (stratum(i + 1) - stratum(i));
        corners(grid).into_iter().chain((0..strata).map(scattered)).collect()
    };
    let truth = cpu::bake_at(integrand, grid, &rule.yardstick(), &sample);
    let (worst, (mu, alpha)) = Deviation::between(grid, &sample, table, &truth);
    if worst.within(bound) {
        return Ok(worst);
    }
    Err(Error::CheckFailed(format!(
        "the table is wrong by {:e} in A and {:e} in B, {bound:e} being promised, worst at n.v = {mu}, alpha = {alpha}; \
         please report this request",
        worst.a, worst.b
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

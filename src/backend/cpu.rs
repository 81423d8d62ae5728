//! The CPU: f64, eight texels at a time in its vector registers. Every texel stands on its own, so that neither threads nor
//! vectors can change a bit of the result.

use super::Progress;
use crate::integrate::rule::{Integrator, Method, Rule};
use crate::integrate::surrogate::{Surrogate, SurrogateRule};
use crate::integrate::{Integrand, ScaleBias};
use crate::lanes::{Lanes, WIDTH, vectorised};
use crate::lut::Grid;
use rayon::prelude::*;

/// Texels that a thread takes at a time: some 0.2 ms of work.
const CHUNK: usize = 64;

/// (A, B) at every point of the grid, in its order.
pub fn bake(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, progress: Progress) -> Vec<ScaleBias> {
    let integrand = integrand.into();
    match rule.method {
        Method::Surrogate(surrogate) => {
            let interpolation = Interpolation::new(integrand, &surrogate, rule);
            let mut integrals = vec![ScaleBias::default(); grid.len()];
            integrals.par_chunks_mut(grid.mus.len()).zip(&grid.alphas).for_each(|(texels, &alpha)| {
                interpolation.row(alpha, &grid.mus, texels);
                progress(texels.len());
            });
            integrals
        }
        _ => integrate(integrand, &rule.integrator(), grid.len(), &|index| grid.point(index), progress),
    }
}

/// (A, B) at the named points of the grid.
pub fn bake_at(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, indices: &[usize]) -> Vec<ScaleBias> {
    let points: Vec<(f64, f64)> = indices.iter().map(|&index| grid.point(index)).collect();
    bake_points(integrand, &points, rule)
}

/// (A, B) at these (n·v, α).
pub fn bake_points(integrand: impl Into<Integrand>, points: &[(f64, f64)], rule: &Rule) -> Vec<ScaleBias> {
    let integrand = integrand.into();
    let Method::Surrogate(surrogate) = rule.method else {
        return integrate(integrand, &rule.integrator(), points.len(), &|i| points[i], &|_| ());
    };
    let interpolation = Interpolation::new(integrand, &surrogate, rule);
    let rows: Vec<&[(f64, f64)]> = points.chunk_by(|a, b| a.1 == b.1).collect();
    let row = |points: &&[(f64, f64)]| {
        let mus: Vec<f64> = points.iter().map(|point| point.0).collect();
        let mut integrals = vec![ScaleBias::default(); mus.len()];
        interpolation.row(points[0].1, &mus, &mut integrals);
        integrals
    };
    rows.par_iter().flat_map_iter(row).collect()
}

/// A surrogate, and what integrates where it does not reach.
struct Interpolation {
    integrand: Integrand,
    rule: SurrogateRule,
    surrogate: Surrogate,
    source: Integrator,
}

impl Interpolation {
    fn new(integrand: Integrand, rule: &SurrogateRule, source: &Rule) -> Self {
        let (points, source) = (rule.points(), source.integrator());
        let surrogate = rule.fit(&points, &integrate(integrand, &source, points.len(), &|i| points[i], &|_| ()));
        Interpolation { integrand, rule: *rule, surrogate, source }
    }

    /// (A, B) at these n·v.
    fn row(&self, alpha: f64, mus: &[f64], texels: &mut [ScaleBias]) {
        if self.rule.covers(alpha) {
            return vectorised(Row { surrogate: &self.surrogate, alpha, mus, texels });
        }
        in_groups(self.integrand, &self.source, |i| (mus[i], alpha), texels);
    }
}

/// A row of a grid.
struct Row<'a> {
    surrogate: &'a Surrogate,
    alpha: f64,
    mus: &'a [f64],
    texels: &'a mut [ScaleBias],
}

impl pulp::NullaryFnOnce for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let row = self.surrogate.row(self.alpha);
        for (mus, texels) in self.mus.chunks(2 * WIDTH).zip(self.texels.chunks_mut(2 * WIDTH)) {
            let lanes = |first: usize| Lanes(std::array::from_fn(|i| mus[(first + i).min(mus.len() - 1)]));
            let [one, other] = row.at([lanes(0), lanes(WIDTH)]);
            for (i, texel) in texels.iter_mut().enumerate() {
                let ScaleBias { a, b } = if i < WIDTH { one } else { other };
                *texel = ScaleBias { a: a.0[i % WIDTH], b: b.0[i % WIDTH] };
            }
        }
    }
}

type Point<'a> = &'a (dyn Fn(usize) -> (f64, f64) + Sync);

fn integrate(
    integrand: Integrand,
    integrator: &Integrator,
    count: usize,
    point: Point,
    progress: Progress,
) -> Vec<ScaleBias> {
    let mut integrals = vec![ScaleBias::default(); count];
    integrals.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, texels)| {
        in_groups(integrand, integrator, |i| point(chunk * CHUNK + i), texels);
        progress(texels.len());
    });
    integrals
}

/// Integrates at `point(0)` and on, as many lanes at a time as there are; a group that is not full repeats its last point.
fn in_groups(
    integrand: Integrand,
    integrator: &Integrator,
    point: impl Fn(usize) -> (f64, f64),
    texels: &mut [ScaleBias],
) {
    let last = texels.len() - 1;
    for (group, texels) in texels.chunks_mut(WIDTH).enumerate() {
        let points = std::array::from_fn(|i| point((group * WIDTH + i).min(last)));
        let values = vectorised(Group { integrator, integrand, points });
        texels.copy_from_slice(&values[..texels.len()]);
    }
}

/// As many points as there are lanes.
struct Group<'a> {
    integrator: &'a Integrator,
    integrand: Integrand,
    points: [(f64, f64); WIDTH],
}

impl pulp::NullaryFnOnce for Group<'_> {
    type Output = [ScaleBias; WIDTH];

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.integrator.integrate_lanes(self.integrand, self.points)
    }
}

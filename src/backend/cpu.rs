//! The CPU: f64, eight texels at a time in its vector registers. Every texel stands on its own, so that neither
//! threads nor vectors can change a bit of the result.

use super::Progress;
use crate::integrate::rule::{Integrator, Method, Rule};
use crate::integrate::surrogate::{Surrogate, SurrogateRule};
use crate::integrate::{Integrand, ScaleBias};
use crate::lanes::{Lanes, WIDTH, vectorised};
use crate::lut::Grid;
use rayon::prelude::*;

/// Texels that a thread takes at a time: some 0.2 ms of work.
const CHUNK: usize = 64;

/// A rule made ready for an integrand: its nodes, and of a surrogate the fit.
#[derive(Clone, Debug)]
pub struct Baker {
    /// The rule.
    pub rule: Rule,
    integrand: Integrand,
    integrator: Integrator,
    fit: Option<Fit>,
}

/// A surrogate, and how far it reaches; where it does not, its source integrates.
#[derive(Clone, Debug)]
struct Fit {
    rule: SurrogateRule,
    surrogate: Surrogate,
}

impl Baker {
    /// Works out the nodes, and fits a surrogate.
    pub fn new(integrand: impl Into<Integrand>, rule: &Rule) -> Self {
        let (integrand, integrator) = (integrand.into(), rule.integrator());
        let fit = match rule.method {
            Method::Surrogate(rule) => {
                let points = rule.points();
                let values = integrate(integrand, &integrator, points.len(), &|i| points[i], &|_| ());
                Some(Fit { rule, surrogate: rule.fit(&points, &values) })
            }
            _ => None,
        };
        Baker { rule: *rule, integrand, integrator, fit }
    }

    /// (A, B) at every point of the grid, in its order.
    pub fn bake(&self, grid: &Grid, progress: Progress) -> Vec<ScaleBias> {
        if self.fit.is_none() {
            let point = |index| grid.point(index);
            return integrate(self.integrand, &self.integrator, grid.len(), &point, progress);
        }
        let mut integrals = vec![ScaleBias::default(); grid.len()];
        integrals.par_chunks_mut(grid.mus.len()).zip(&grid.alphas).for_each(|(texels, &alpha)| {
            self.row(alpha, &grid.mus, texels);
            progress(texels.len());
        });
        integrals
    }

    /// (A, B) at the named points of the grid.
    pub fn bake_at(&self, grid: &Grid, indices: &[usize]) -> Vec<ScaleBias> {
        let points: Vec<(f64, f64)> = indices.iter().map(|&index| grid.point(index)).collect();
        self.bake_points(&points)
    }

    /// (A, B) at these (n·v, α).
    pub fn bake_points(&self, points: &[(f64, f64)]) -> Vec<ScaleBias> {
        if self.fit.is_none() {
            return integrate(self.integrand, &self.integrator, points.len(), &|i| points[i], &|_| ());
        }
        let rows: Vec<&[(f64, f64)]> = points.chunk_by(|a, b| a.1 == b.1).collect();
        let row = |points: &&[(f64, f64)]| {
            let mus: Vec<f64> = points.iter().map(|point| point.0).collect();
            let mut integrals = vec![ScaleBias::default(); mus.len()];
            self.row(points[0].1, &mus, &mut integrals);
            integrals
        };
        rows.par_iter().flat_map_iter(row).collect()
    }

    /// (A, B) at these n·v of one α.
    fn row(&self, alpha: f64, mus: &[f64], texels: &mut [ScaleBias]) {
        match &self.fit {
            Some(fit) if fit.rule.covers(alpha) => {
                vectorised(Row { surrogate: &fit.surrogate, alpha, mus, texels });
            }
            _ => in_groups(self.integrand, &self.integrator, |i| (mus[i], alpha), texels),
        }
    }
}

/// (A, B) at every point of the grid, in its order.
pub fn bake(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, progress: Progress) -> Vec<ScaleBias> {
    Baker::new(integrand, rule).bake(grid, progress)
}

/// (A, B) at the named points of the grid.
pub fn bake_at(integrand: impl Into<Integrand>, grid: &Grid, rule: &Rule, indices: &[usize]) -> Vec<ScaleBias> {
    Baker::new(integrand, rule).bake_at(grid, indices)
}

/// (A, B) at these (n·v, α).
pub fn bake_points(integrand: impl Into<Integrand>, points: &[(f64, f64)], rule: &Rule) -> Vec<ScaleBias> {
    Baker::new(integrand, rule).bake_points(points)
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

/// Integrates at `point(0)` and on, as many lanes at a time as there are; a group that is not full repeats its last
/// point.
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

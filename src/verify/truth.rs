//! What is true at a texel: the channels of a table of ours.

use crate::backend::cpu::Baker;
use crate::integrate::rule::Rule;
use crate::integrate::rules::REFERENCE;
use crate::integrate::{Field, Integrand};
use crate::lut::{Lut, MOST_CHANNELS};
use crate::numeric::ball::Ball;
use crate::numeric::quadrature::gauss_legendre::gauss_legendre;
use crate::table::grid::Grid;
use crate::units::SMALLEST_COSINE;

/// The numbers of a texel of ours.
pub type Values = [f64; MOST_CHANNELS];

/// The smallest n·v of a lobe whose albedo is infinite at 0, which no table holds.
const GRAZING: f64 = 1e-4;

/// An error of integrals with which hypotheses are told apart that differ by far more: most points
/// err by far less than the bound.
pub const ROUGH: f64 = 5e-3;

/// The directions of rough averages, which err by 1e-3 at the most.
const DIRECTIONS: usize = 24;

/// A table of ours, at any texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// Its family, lobe and channels.
    pub lut: Lut,
    /// The error of its integrals that will do.
    pub tolerance: f64,
}

impl Truth {
    /// The channels at every pair of these n·v and these α, n·v varying fastest.
    pub fn on_grid(&self, mus: &[f64], alphas: &[f64]) -> Vec<Values> {
        let (mus, alphas) = (self.cosines(mus), self.widths(alphas));
        let grid = Grid::of(mus, alphas);
        let integrals = self.baker(grid.len()).bake(&grid, &|_| ());
        let averages = self.averages(&grid.alphas);
        let at = |point: usize| {
            let row = point / grid.mus.len();
            self.values(grid.point(point).0, integrals.at(point), &averages, row)
        };
        (0..grid.len()).map(at).collect()
    }

    /// The channels at these (n·v, α).
    pub fn at(&self, points: &[(f64, f64)]) -> Vec<Values> {
        let mus = self.cosines(&points.iter().map(|point| point.0).collect::<Vec<_>>());
        let alphas = self.widths(&points.iter().map(|point| point.1).collect::<Vec<_>>());
        let inside: Vec<(f64, f64)> = mus.into_iter().zip(alphas.iter().copied()).collect();
        let integrals = self.baker(inside.len()).bake_points(&inside);
        // Averages cost most, and many points lie in a row.
        let mut rows = alphas.clone();
        rows.sort_by(f64::total_cmp);
        rows.dedup();
        let averages = self.averages(&rows);
        let at = |(point, &(mu, alpha)): (usize, &(f64, f64))| {
            let row = rows.partition_point(|&row| row < alpha);
            self.values(mu, integrals.at(point), &averages, row)
        };
        inside.iter().enumerate().map(at).collect()
    }

    fn baker(&self, points: usize) -> Baker {
        let integrand = self.lut.integrand();
        let rule = Rule::for_cpu(integrand, self.tolerance, points).unwrap_or(REFERENCE);
        Baker::new(integrand, &rule)
    }

    /// The averages at each α, of each integrand that the table needs averaged.
    fn averages(&self, alphas: &[f64]) -> Vec<Field> {
        let averaged = |integrand: Integrand| {
            let rule = Rule::for_cpu(integrand, self.tolerance, alphas.len()).unwrap_or(REFERENCE);
            let baker = Baker::new(integrand, &rule);
            match self.tolerance < ROUGH {
                true => baker.averages(alphas),
                false => baker.averages_by(alphas, |_| few_directions()),
            }
        };
        self.lut.averaged().into_iter().map(averaged).collect()
    }

    fn values(&self, mu: f64, integrals: &[f64], averages: &[Field], row: usize) -> Values {
        let exact = |values: &[f64]| values.iter().map(|&value| Ball::exact(value)).collect();
        let integrals: Vec<Ball> = exact(integrals);
        let averages: Vec<Ball> =
            averages.iter().flat_map(|field| exact(field.at(row)) as Vec<Ball>).collect();
        self.lut.values(mu, &integrals, &averages).map(|ball| ball.value)
    }

    /// n·v in the domain of the lobe.
    fn cosines(&self, mus: &[f64]) -> Vec<f64> {
        let least = match self.lut.integrand() {
            Integrand::Specular(lobe, _) if lobe.diverges_at_grazing() => GRAZING,
            _ => 0.0,
        };
        let inside = |&mu: &f64| match mu.clamp(least, 1.0) {
            mu if mu < SMALLEST_COSINE => 0.0,
            mu => mu,
        };
        mus.iter().map(inside).collect()
    }

    /// α in the domain of the lobe.
    fn widths(&self, alphas: &[f64]) -> Vec<f64> {
        let most = match self.lut.integrand() {
            Integrand::Specular(lobe, _) => lobe.ndf.most_alpha(),
            Integrand::Glass(_) | Integrand::Diffuse(_) => 1.0,
        };
        alphas.iter().map(|&alpha| alpha.clamp(0.0, most)).collect()
    }
}

/// (n·v, weight) of few directions.
fn few_directions() -> Vec<(f64, f64)> {
    let nodes = gauss_legendre(DIRECTIONS).into_iter();
    nodes.map(|node| (node.at, 2.0 * node.at * node.weight)).collect()
}

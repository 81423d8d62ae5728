//! The CPU: f64, eight texels at a time in its vector registers. Every texel stands on its own, so
//! that neither threads nor vectors can change a bit of the result.

mod glass;

use self::glass::Glass;
use super::Progress;
use crate::brdf::fresnel::{Basis, with_basis};
use crate::brdf::{Diffuse, Microfacet};
use crate::integrate::average::{add_average, average_nodes_at};
use crate::integrate::interpolant::{Interpolant, InterpolantRule, Source};
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::REFERENCE_NODES;
use crate::integrate::{Field, Integrals, Integrand, Kernel, mirror};
use crate::numeric::lanes::{self, F64x8, Vector, vectorised};
use crate::table::grid::Grid;
use crate::units::{LARGEST_ALPHA, roughness_of};
use rayon::prelude::*;
use std::array::from_fn;
use std::sync::Arc;

/// Texels that a thread takes at a time: some 0.2 ms of work by a cheap rule, and of few texels an
/// eighth of its share, whole groups of lanes, since one by the reference takes milliseconds.
fn chunk(texels: usize) -> usize {
    let share = texels.div_ceil(8 * rayon::current_num_threads());
    share.next_multiple_of(LANES).clamp(LANES, 8 * LANES)
}

const LANES: usize = F64x8::LANES;

/// A rule made ready for an integrand: its nodes worked out, and of an interpolant the fit.
#[derive(Clone)]
pub struct Baker {
    /// The rule.
    pub rule: Rule,
    integrand: Integrand,
    /// The number of integrals at a point.
    count: usize,
    work: Arc<dyn Work>,
}

impl std::fmt::Debug for Baker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Baker").field("rule", &self.rule.name).finish_non_exhaustive()
    }
}

impl Baker {
    /// Works out the nodes, and fits an interpolant.
    pub fn new(integrand: impl Into<Integrand>, rule: &Rule) -> Self {
        Baker::of(integrand.into(), rule)
    }

    /// [`new`](Self::new) of one type, so that no other crate compiles the loops again.
    fn of(integrand: Integrand, rule: &Rule) -> Self {
        let work: Arc<dyn Work> = match integrand {
            Integrand::Specular(lobe, fresnel) => {
                with_basis!(fresnel, basis => specular(lobe, basis, rule))
            }
            Integrand::Glass(interface) => Arc::new(Glass::new(interface, rule)),
            Integrand::Diffuse(diffuse) => Arc::new(ClosedForm { diffuse }),
        };
        Baker { rule: *rule, integrand, count: integrand.count(), work }
    }

    /// The integrals at every point of the grid, in its order.
    pub fn bake(&self, grid: &Grid, progress: Progress) -> Field {
        let mut field = Field::zeros(self.count, grid.len());
        let (values, width) = (field.values_mut(), grid.mus.len());
        if self.work.shares_rows() {
            let rows = values.par_chunks_mut(width * self.count).zip(&grid.alphas);
            rows.for_each(|(integrals, &alpha)| {
                self.work.integrate(Points::Row { mus: &grid.mus, alpha }, integrals);
                progress(width);
            });
        } else {
            let size = chunk(grid.len());
            let chunks = values.par_chunks_mut(size * self.count).enumerate();
            chunks.for_each(|(chunk, integrals)| {
                let indices = chunk * size..chunk * size + integrals.len() / self.count;
                let points: Vec<(f64, f64)> = indices.map(|index| grid.point(index)).collect();
                self.work.integrate(Points::List(&points), integrals);
                progress(points.len());
            });
        }
        field
    }

    /// The averages over all directions at each of these α.
    pub fn averages(&self, alphas: &[f64]) -> Field {
        self.averages_by(alphas, |alpha| average_nodes_at(self.integrand, alpha))
    }

    /// The same by these (n·v, weight) at an α.
    pub fn averages_by(&self, alphas: &[f64], nodes_at: impl Fn(f64) -> Vec<(f64, f64)>) -> Field {
        let nodes: Vec<_> = alphas.iter().map(|&alpha| nodes_at(alpha)).collect();
        let at = |(nodes, &alpha): (&Vec<(f64, f64)>, &f64)| {
            nodes.iter().map(move |&(mu, _)| (mu, alpha)).collect::<Vec<_>>()
        };
        let points: Vec<(f64, f64)> = nodes.iter().zip(alphas).flat_map(at).collect();
        let integrals = self.bake_points(&points);
        let mut averages = Field::zeros(self.count, alphas.len());
        let mut integrals = integrals.iter();
        for (sum, nodes) in averages.values_mut().chunks_exact_mut(self.count).zip(&nodes) {
            add_average(nodes, integrals.by_ref(), sum);
        }
        averages
    }

    /// The integrals at the named points of the grid.
    pub fn bake_at(&self, grid: &Grid, indices: &[usize]) -> Field {
        let points: Vec<(f64, f64)> = indices.iter().map(|&index| grid.point(index)).collect();
        self.bake_points(&points)
    }

    /// The integrals at these (n·v, α).
    pub fn bake_points(&self, points: &[(f64, f64)]) -> Field {
        if !self.work.shares_rows() {
            return in_chunks(&*self.work, self.count, points);
        }
        let rows: Vec<&[(f64, f64)]> = points.chunk_by(|a, b| a.1 == b.1).collect();
        let row = |points: &&[(f64, f64)]| {
            let mut integrals = vec![0.0; points.len() * self.count];
            self.work.integrate(Points::List(points), &mut integrals);
            integrals
        };
        Field::of(self.count, rows.par_iter().flat_map_iter(row).collect())
    }
}

/// The integrals at every point of the grid, in its order.
pub fn bake(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    progress: Progress,
) -> Field {
    Baker::new(integrand, rule).bake(grid, progress)
}

/// The integrals at the named points of the grid.
pub fn bake_at(
    integrand: impl Into<Integrand>,
    grid: &Grid,
    rule: &Rule,
    indices: &[usize],
) -> Field {
    Baker::new(integrand, rule).bake_at(grid, indices)
}

/// The integrals at these (n·v, α).
pub fn bake_points(integrand: impl Into<Integrand>, points: &[(f64, f64)], rule: &Rule) -> Field {
    Baker::new(integrand, rule).bake_points(points)
}

/// Points to integrate at.
#[derive(Clone, Copy)]
enum Points<'a> {
    /// These n·v of one α.
    Row { mus: &'a [f64], alpha: f64 },
    /// These (n·v, α).
    List(&'a [(f64, f64)]),
}

impl Points<'_> {
    #[inline(always)]
    fn get(self, index: usize) -> (f64, f64) {
        match self {
            Points::Row { mus, alpha } => (mus[index], alpha),
            Points::List(points) => points[index],
        }
    }
}

/// An integrand with a rule: the one place where both are types of their own, so that the loops
/// over nodes are compiled for them.
trait Work: Send + Sync {
    /// Fills in the integrals at as many points; all are of one α where rows share work.
    fn integrate(&self, points: Points, integrals: &mut [f64]);

    /// Whether points of one α share work.
    fn shares_rows(&self) -> bool;
}

/// The `count` integrals at each of these (n·v, α), where points share no work.
fn in_chunks(work: &dyn Work, count: usize, points: &[(f64, f64)]) -> Field {
    let mut field = Field::zeros(count, points.len());
    let size = chunk(points.len());
    let chunks = field.values_mut().par_chunks_mut(size * count).zip(points.par_chunks(size));
    chunks.for_each(|(integrals, points)| work.integrate(Points::List(points), integrals));
    field
}

/// A diffuse lobe's albedo.
struct ClosedForm {
    diffuse: Diffuse,
}

impl Work for ClosedForm {
    fn integrate(&self, points: Points, integrals: &mut [f64]) {
        for (i, albedo) in integrals.iter_mut().enumerate() {
            let (mu, alpha) = points.get(i);
            *albedo = self.diffuse.albedo(mu, roughness_of(alpha));
        }
    }

    fn shares_rows(&self) -> bool {
        false
    }
}

/// A specular lobe by quadrature.
struct Quadrature<const N: usize, B, K> {
    lobe: Microfacet,
    basis: B,
    nodes: K,
}

/// A specular lobe by interpolation; where the interpolant does not reach, its source integrates.
struct Interpolated<const N: usize, B> {
    basis: B,
    rule: InterpolantRule,
    interpolant: Interpolant<N>,
    source: Arc<dyn Work>,
}

/// A specular lobe by a rule; by the reference where the rule does not serve for it.
fn specular<const N: usize, B: Basis<N>>(lobe: Microfacet, basis: B, rule: &Rule) -> Arc<dyn Work> {
    match rule.method {
        Method::HalfVectors(rule) => quadrature(lobe, basis, rule.nodes()),
        Method::DoubleExponential(rule) => quadrature(lobe, basis, rule.nodes()),
        // Not compiled for the models that these do not serve for.
        _ if B::DEFINITION.smooth_complement => smooth(lobe, basis, rule),
        _ => quadrature(lobe, basis, REFERENCE_NODES.nodes()),
    }
}

/// The same for models with a smooth complement.
fn smooth<const N: usize, B: Basis<N>>(lobe: Microfacet, basis: B, rule: &Rule) -> Arc<dyn Work> {
    match rule.method {
        Method::LightDirections(rule) => quadrature(lobe, basis, rule.nodes()),
        Method::LightPlanes(rule) => quadrature(lobe, basis, rule.nodes()),
        Method::Rings(rule) => quadrature(lobe, basis, rule.nodes()),
        Method::BentRings(rule) => quadrature(lobe, basis, rule.nodes()),
        Method::Interpolant(rule) => {
            let source = |source: Source| match source {
                Source::HalfVectors(rule) => quadrature(lobe, basis, rule.nodes()),
                Source::LightDirections(rule) => quadrature(lobe, basis, rule.nodes()),
                Source::LightPlanes(rule) => quadrature(lobe, basis, rule.nodes()),
                Source::Rings(rule) => quadrature(lobe, basis, rule.nodes()),
                Source::BentRings(rule) => quadrature(lobe, basis, rule.nodes()),
            };
            let points = rule.points(lobe);
            let pieces = points.iter().zip(rule.pieces);
            let integrals: Vec<Field> = pieces
                .map(|(points, piece)| in_chunks(&*source(piece.source), N, points))
                .collect();
            let interpolant = rule.fit(lobe, basis, &integrals);
            Arc::new(Interpolated { basis, rule, interpolant, source: source(rule.below) })
        }
        Method::HalfVectors(_)
        | Method::DoubleExponential(_)
        | Method::Glass(_)
        | Method::ClosedForm => quadrature(lobe, basis, REFERENCE_NODES.nodes()),
    }
}

fn quadrature<const N: usize, B: Basis<N>, K: Kernel>(
    lobe: Microfacet,
    basis: B,
    nodes: K,
) -> Arc<dyn Work> {
    Arc::new(Quadrature::<N, B, K> { lobe, basis, nodes })
}

/// Integrates at as many points at a time as there are lanes; a group that is not full repeats its
/// last point. `exact` puts in its place what is known to its last digits at a point.
fn in_groups<const N: usize>(
    points: Points,
    integrals: &mut [f64],
    lanes: impl Fn(F64x8, F64x8) -> Integrals<N, F64x8>,
    exact: impl Fn((f64, f64), &mut [f64]),
) {
    let last = integrals.len() / N - 1;
    for (group, integrals) in integrals.chunks_mut(LANES * N).enumerate() {
        let points: [(f64, f64); LANES] = from_fn(|i| points.get((group * LANES + i).min(last)));
        debug_assert!(points.iter().all(|&(mu, alpha)| in_domain(mu, alpha)), "{points:?}");
        // Any α will do in the lanes of mirrors.
        let alphas = points.map(|(_, alpha)| if alpha == 0.0 { 1.0 } else { alpha });
        scatter(&lanes(F64x8(points.map(|point| point.0)), F64x8(alphas)), integrals);
        for (integrals, point) in integrals.chunks_exact_mut(N).zip(points) {
            exact(point, integrals);
        }
    }
}

impl<const N: usize, B: Basis<N>, K: Kernel> Work for Quadrature<N, B, K> {
    fn integrate(&self, points: Points, integrals: &mut [f64]) {
        let lanes = |mu, alpha| vectorised(Group { work: self, mu, alpha });
        in_groups(points, integrals, lanes, |(mu, alpha), integrals| {
            if alpha == 0.0 {
                let mirror = mirror(self.lobe, self.basis, mu);
                integrals.copy_from_slice(&mirror.map(|integral| integral.value));
            }
        });
    }

    fn shares_rows(&self) -> bool {
        false
    }
}

impl<const N: usize, B: Basis<N>> Work for Interpolated<N, B> {
    fn integrate(&self, points: Points, integrals: &mut [f64]) {
        let alpha = points.get(0).1;
        match points {
            _ if !self.rule.covers(alpha) => self.source.integrate(points, integrals),
            Points::Row { mus, alpha } => vectorised(Row { work: self, alpha, mus, integrals }),
            Points::List(points) => {
                let mus: Vec<f64> = points.iter().map(|point| point.0).collect();
                vectorised(Row { work: self, alpha, mus: &mus, integrals });
            }
        }
    }

    fn shares_rows(&self) -> bool {
        true
    }
}

fn in_domain(mu: f64, alpha: f64) -> bool {
    (0.0..=1.0).contains(&mu) && (0.0..=LARGEST_ALPHA).contains(&alpha)
}

/// Writes the integrals of as many points as there are lanes, or fewer, point by point.
#[inline(always)]
fn scatter<const N: usize>(lanes: &Integrals<N, F64x8>, integrals: &mut [f64]) {
    for (i, integrals) in integrals.chunks_exact_mut(N).enumerate() {
        for (k, integral) in integrals.iter_mut().enumerate() {
            *integral = lanes.0[k].0[i];
        }
    }
}

/// A group of as many points as there are lanes.
struct Group<'a, const N: usize, B, K> {
    work: &'a Quadrature<N, B, K>,
    mu: F64x8,
    alpha: F64x8,
}

impl<const N: usize, B: Basis<N>, K: Kernel> lanes::Work for Group<'_, N, B, K> {
    type Output = Integrals<N, F64x8>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Quadrature { lobe, basis, nodes } = self.work;
        nodes.integrate(*lobe, *basis, self.mu, self.alpha)
    }
}

/// A row of points of one α.
struct Row<'a, const N: usize, B> {
    work: &'a Interpolated<N, B>,
    alpha: f64,
    mus: &'a [f64],
    integrals: &'a mut [f64],
}

impl<const N: usize, B: Basis<N>> lanes::Work for Row<'_, N, B> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Row { work, alpha, mus, integrals } = self;
        let row = work.interpolant.row(alpha);
        for (mus, integrals) in mus.chunks(2 * LANES).zip(integrals.chunks_mut(2 * LANES * N)) {
            let lanes = |first: usize| F64x8(from_fn(|i| mus[(first + i).min(mus.len() - 1)]));
            let pair = row.at(work.basis, [lanes(0), lanes(LANES)]);
            for (integrals, lanes) in integrals.chunks_mut(LANES * N).zip(&pair) {
                scatter(lanes, integrals);
            }
        }
    }
}

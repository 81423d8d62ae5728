//! The largest error of a lookup: a search over every cell of a table and over the corner n·v = α =
//! 0, then a climb from the worst places. Evenly spread places miss the largest error by up to 15
//! times, since it lies in a layer n·v ~ α that is thinner than their spacing.

use crate::backend::cpu;
use crate::brdf::Microfacet;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rule::Rule;
use crate::integrate::rules::REFERENCE;
use crate::numeric::climb::{Climber, climb};
use crate::table::axis::{Axis, Parameter};
use crate::table::grid::Grid;
use crate::units::{Alpha, PRACTICAL_NOV, PRACTICAL_ROUGHNESS, PerceptualRoughness};
use rayon::prelude::*;

/// Where lookups are judged: n·v and perceptual roughness from these on, to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// The smallest n·v.
    pub nov: f64,
    /// The smallest perceptual roughness.
    pub roughness: f64,
}

/// Everything.
pub const FULL: Domain = Domain { nov: 0.0, roughness: 0.0 };

/// The domain of renderers.
pub const PRACTICAL: Domain = Domain { nov: PRACTICAL_NOV, roughness: PRACTICAL_ROUGHNESS };

/// The largest error of an integral by which lookups are judged; the smallest error of a lookup is
/// a thousand times as large.
const TOLERANCE: f64 = 1e-6;

/// The same of lobes that no rule but the reference integrates as well: Charlie.
const LOOSE_TOLERANCE: f64 = 3e-6;

/// Places to a decade towards the corner: the layer is a decade wide.
const PER_DECADE: i32 = 6;

/// The decades below 1 that n·v is searched through; roughness through half as many, since α is its
/// square.
const DECADES: i32 = 10;

/// Rows from whose worst places the climb starts. Neighbouring rows lead to the same summit; 24
/// reach several.
const CLIMBERS: usize = 24;

/// Steps of a climb; each halves the distance between the places, which is half a texel at first.
const STEPS: usize = 8;

/// (A, B) that a renderer reads at n·v and the parameter of a table's other axis.
pub type Read<'a> = &'a (dyn Fn(f64, f64) -> ScaleBias + Sync);

/// The places of a search, one for each pair, and what is true there.
pub struct Search {
    lobe: Microfacet,
    /// Its parameter is a row's.
    y: Axis,
    mus: Vec<f64>,
    rows: Vec<f64>,
    truth: Vec<ScaleBias>,
}

/// The cheapest rule by which lookups can be judged at this number of places.
pub fn rule(lobe: Microfacet, places: usize) -> Rule {
    let within = |tolerance| Rule::for_cpu(lobe, tolerance, places);
    within(TOLERANCE).or_else(|| within(LOOSE_TOLERANCE)).unwrap_or(REFERENCE)
}

/// The error of the albedo E(F0) = F0 A + B for that F0 in [0, 1] that shows it most; of albedos
/// above 1 relative. It is linear in F0, so that it is largest at F0 = 0, where B is seen, or at F0
/// = 1, where A + B is.
pub fn seen(read: ScaleBias, truth: ScaleBias) -> f64 {
    let error = (read.b - truth.b).abs().max((read.e() - truth.e()).abs()) / truth.e().max(1.0);
    if error.is_finite() { error } else { f64::MAX }
}

impl Search {
    /// The places of a table over these axes, n·v first; none where the integrals would take a
    /// thread more than `patience` seconds.
    pub fn new(lobe: Microfacet, x: &Axis, y: &Axis, patience: f64) -> Result<Option<Self>> {
        let mut mus = cells(x, &[FULL.nov, PRACTICAL.nov]);
        mus.extend(towards_zero(DECADES));
        let least = [FULL, PRACTICAL].map(|domain| parameter(y, domain.roughness));
        let mut rows = cells(y, &least.into_iter().collect::<Result<Vec<_>>>()?);
        for roughness in towards_zero(DECADES / 2) {
            rows.push(parameter(y, roughness)?);
        }
        let (mus, rows) = (sorted(mus), sorted(rows));
        let rule = rule(lobe, mus.len() * rows.len());
        if rule.seconds(lobe, mus.len() * rows.len()) > patience {
            return Ok(None);
        }
        let alphas = rows.iter().map(|&row| alpha(y, row)).collect::<Result<Vec<_>>>()?;
        let truth = cpu::bake(lobe, &Grid::of(mus.clone(), alphas), &rule, &|_| ()).scale_bias();
        Ok(Some(Search { lobe, y: *y, mus, rows, truth }))
    }

    /// The largest error over a domain of what `read` gives.
    pub fn largest(&self, domain: Domain, read: Read) -> Result<f64> {
        let errors = |places: &[(f64, f64)]| {
            let point = |&(mu, row): &(f64, f64)| Ok((mu, alpha(&self.y, row)?));
            let points = places.iter().map(point).collect::<Result<Vec<_>>>()?;
            let rule = rule(self.lobe, points.len());
            let truth = cpu::bake_points(self.lobe, &points, &rule).scale_bias();
            let error = |(&(mu, row), truth): (&(f64, f64), ScaleBias)| seen(read(mu, row), truth);
            Ok(places.iter().zip(truth).map(error).collect())
        };
        let climbers = climb(self.starts(domain, read)?, CLIMBERS, STEPS, errors)?;
        Ok(climbers.first().map_or(0.0, |climber| climber.value))
    }

    /// The worst place of each row in the domain.
    fn starts(&self, domain: Domain, read: Read) -> Result<Vec<Climber>> {
        let least = parameter(&self.y, domain.roughness)?;
        let first = self.mus.partition_point(|&mu| mu < domain.nov);
        let first_row = self.rows.partition_point(|&row| row < least);
        let worst = |j: usize| {
            let error = |i: usize| {
                seen(read(self.mus[i], self.rows[j]), self.truth[j * self.mus.len() + i])
            };
            let errors = (first..self.mus.len()).map(|i| (i, error(i)));
            let (i, error) = errors
                .fold((first, 0.0), |worst, here| if here.1 > worst.1 { here } else { worst });
            Climber::at([&self.mus, &self.rows], [i, j], [first, first_row], error)
        };
        Ok((first_row..self.rows.len()).into_par_iter().map(worst).collect())
    }
}

/// The parameter of a table's other axis at a perceptual roughness.
pub fn parameter(y: &Axis, roughness: f64) -> Result<f64> {
    match y.spec().parameter {
        Parameter::Alpha => Ok(Alpha::from(PerceptualRoughness::new(roughness)?).get()),
        _ => Ok(roughness),
    }
}

/// α at that parameter.
fn alpha(y: &Axis, parameter: f64) -> Result<f64> {
    match y.spec().parameter {
        Parameter::Alpha => Ok(parameter),
        _ => Ok(Alpha::from(PerceptualRoughness::new(parameter)?).get()),
    }
}

/// An axis's nodes, both ends of its parameter, these others, and the middles between all of them.
fn cells(axis: &Axis, others: &[f64]) -> Vec<f64> {
    let ends = [0.0, 1.0];
    let mut places = sorted([&axis.values(), &ends[..], others].concat());
    places.extend(places.clone().windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    places
}

/// 10^(-k/[`PER_DECADE`]) down to `decades` decades below 1.
fn towards_zero(decades: i32) -> impl Iterator<Item = f64> {
    (1..=decades * PER_DECADE).map(|k| libm::exp10(-f64::from(k) / f64::from(PER_DECADE)))
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

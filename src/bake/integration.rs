//! The integrals of a table that is not certified: by one rule, on the CPU or on a device, checked
//! on a sample.

use crate::backend::cpu::Baker;
use crate::backend::device::DeviceBake;
use crate::backend::{Gpu, Progress, bake, bake_glass};
use crate::brdf::fresnel::with_basis;
use crate::brdf::{Fresnel, Microfacet};
use crate::certify::deviation::{self, Deviation};
use crate::error::{Error, Result};
use crate::integrate::average::{AVERAGE_ERROR, average_nodes, averages, averages_by_row};
use crate::integrate::errors::f32_arithmetic;
use crate::integrate::estimator::Estimator;
use crate::integrate::hammersley::{Point, estimate};
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::G4536;
use crate::integrate::{Field, Integrand, scale};
use crate::numeric::ball::Ball;
use crate::report::Seconds;
use crate::table::grid::Grid;
use rayon::prelude::*;
use std::time::Instant;

/// The rule and the device, and the findings of the checks so far.
pub(super) struct Integration<'a> {
    pub integrand: Integrand,
    pub baker: Baker,
    pub gpu: Option<&'a Gpu>,
    /// Points of each grid that are measured against the reference; none of some slices.
    pub measured_points: usize,
    pub checked: Checked,
}

/// The findings of the checks over all grids.
#[derive(Default)]
pub(super) struct Checked {
    pub cross_check: Deviation,
    pub measured: Deviation,
    pub seconds: Seconds,
    pub device_seconds: Option<f64>,
}

impl Integration<'_> {
    /// The error that arithmetic adds to the rule's: f32's on a device; the rules' bounds are
    /// rounded up by far more than f64 adds.
    fn arithmetic(&self) -> f64 {
        if self.gpu.is_some() { f32_arithmetic(self.integrand) } else { 0.0 }
    }

    /// Integrals at an α with the bounds of their errors, `besides` included: of albedos above 1
    /// relative.
    pub fn within_bound(&self, alpha: f64, integrals: &[f64], besides: f64) -> Vec<Ball> {
        let errors = self.baker.rule.errors(self.integrand).at((0.0, alpha), integrals);
        let more = (self.arithmetic() + besides) * scale(integrals);
        integrals
            .iter()
            .zip(errors)
            .map(|(&value, error)| Ball { value, error: error + more })
            .collect()
    }

    /// The averages of each row of a grid that these integrands have.
    pub fn averages(&mut self, grid: &Grid, averaged: &[Integrand]) -> Result<Vec<Vec<Ball>>> {
        if averages_by_row(self.integrand) {
            return Ok(self.averages_by_cpu(grid, averaged));
        }
        let nodes = average_nodes();
        let directions = grid.at_directions(nodes.iter().map(|node| node.0).collect());
        let averages = averages(&nodes, &self.over(&directions, &|_| ())?);
        let row =
            |(average, &alpha): (&[f64], &f64)| self.within_bound(alpha, average, AVERAGE_ERROR);
        Ok(averages.iter().zip(&grid.alphas).map(row).collect())
    }

    /// The same where directions vary with roughness: by the CPU.
    fn averages_by_cpu(&self, grid: &Grid, averaged: &[Integrand]) -> Vec<Vec<Ball>> {
        let mut averages = vec![Vec::new(); grid.alphas.len()];
        for &integrand in averaged {
            let rule = self.baker.rule;
            let errors = rule.errors(integrand);
            let values = Baker::new(integrand, &rule).averages(&grid.alphas);
            for ((row, values), &alpha) in averages.iter_mut().zip(values.iter()).zip(&grid.alphas)
            {
                let errors = errors.of_averages(alpha, values);
                let ball =
                    |(&value, error): (&f64, f64)| Ball { value, error: error + AVERAGE_ERROR };
                row.extend(values.iter().zip(errors).map(ball));
            }
        }
        averages
    }

    /// Integrates over a grid, and checks what comes out.
    pub fn over(&mut self, grid: &Grid, progress: Progress) -> Result<Field> {
        let least_mu = grid.least_mu();
        let bound_at = |&alpha: &f64| self.baker.rule.bound_at(self.integrand, least_mu, alpha);
        let bound = grid.alphas.iter().map(bound_at).fold(0.0, f64::max);
        let bound = bound + self.arithmetic();
        let Integration { integrand, baker, gpu, checked, .. } = self;
        let rule = &baker.rule;
        let start = Instant::now();
        let integrals = match gpu {
            Some(gpu) => {
                let baked = on_device(gpu, *integrand, grid, rule, progress)?;
                checked.device_seconds = sum(checked.device_seconds, baked.device_seconds);
                baked.integrals
            }
            None => baker.bake(grid, progress),
        };
        checked.seconds.integrate += start.elapsed().as_secs_f64();
        let start = Instant::now();
        if gpu.is_some() {
            let found = deviation::cross_check(*integrand, grid, rule, &integrals)?;
            checked.cross_check = std::mem::take(&mut checked.cross_check).merge(found);
        }
        if self.measured_points > 0 {
            let points = self.measured_points;
            let found = deviation::measure(*integrand, grid, rule, bound, &integrals, points)?;
            checked.measured = std::mem::take(&mut checked.measured).merge(found);
        }
        checked.seconds.check += start.elapsed().as_secs_f64();
        Ok(integrals)
    }
}

/// The device's time so far and that of the next grid; none where the device does not tell it.
pub(super) fn sum(so_far: Option<f64>, next: Option<f64>) -> Option<f64> {
    next.map(|next| so_far.unwrap_or(0.0) + next)
}

/// The integrals of a specular lobe or of an interface by a device.
pub fn on_device(
    gpu: &Gpu,
    integrand: Integrand,
    grid: &Grid,
    rule: &Rule,
    progress: Progress,
) -> Result<DeviceBake> {
    match (integrand, rule.method) {
        (Integrand::Specular(lobe, fresnel), Method::HalfVectors(nodes)) => {
            bake(gpu, (lobe, fresnel), grid, &nodes, progress)
        }
        (Integrand::Glass(interface), Method::Glass(nodes)) => {
            bake_glass(gpu, interface, grid, &nodes, progress)
        }
        _ => Err(Error::Internal(format!("rule {} on a device", rule.name))),
    }
}

/// The rule by which refractions to the wrong side are counted.
const WRONG_SIDE_RULE: Rule = G4536;

/// Evaluations of an estimator for a texel.
pub(super) fn evaluations(estimator: Estimator) -> f64 {
    estimator.count().map_or(WRONG_SIDE_RULE.evaluations(1) as f64, f64::from)
}

/// The integrals over a grid by an estimator; an error for what it does not serve for.
pub(super) fn by_estimator(
    integrand: Integrand,
    grid: &Grid,
    estimator: Estimator,
    progress: Progress,
) -> Result<Field> {
    match (integrand, estimator) {
        (Integrand::Specular(lobe, fresnel), Estimator::Hammersley(points)) => {
            Ok(sampled((lobe, fresnel), grid, &points.points(), progress))
        }
        (Integrand::Glass(interface), Estimator::WrongSide) => {
            let wrong = Integrand::Glass(interface.counting_wrong_side());
            Ok(Baker::new(wrong, &WRONG_SIDE_RULE).bake(grid, progress))
        }
        _ => Err(Error::Internal(format!("estimator {estimator} of {integrand}"))),
    }
}

/// The integrals of a specular lobe at Hammersley's points.
fn sampled(
    (lobe, fresnel): (Microfacet, Fresnel),
    grid: &Grid,
    points: &[Point],
    progress: Progress,
) -> Field {
    let (count, width) = (fresnel.count(), grid.mus.len());
    let mut field = Field::zeros(count, grid.len());
    let rows = field.values_mut().par_chunks_mut(count * width).zip(&grid.alphas);
    rows.for_each(|(integrals, &alpha)| {
        for (integrals, &mu) in integrals.chunks_exact_mut(count).zip(&grid.mus) {
            with_basis!(fresnel, basis => {
                integrals.copy_from_slice(&estimate(lobe, basis, (mu, alpha), points));
            });
        }
        progress(width);
    });
    field
}

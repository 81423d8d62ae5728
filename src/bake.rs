//! From a request to a table: planned, computed, checked. A table is baked slice by slice and in
//! bands of rows of one α each, so that it takes no more memory than its own bytes and a band's
//! numbers.

mod integration;
pub mod plan;

pub use plan::Plan;

use crate::backend::cpu::Baker;
use crate::backend::{Backend, Progress};
use crate::certify::decision::Task;
use crate::certify::deviation::MEASURED;
use crate::certify::stages::Stages;
use crate::certify::tally::{Tally, unbounded};
use crate::certify::ziv::{DeviceTable, certify_band};
use crate::error::{Error, Result};
use crate::integrate::Field;
use crate::lut::Lut;
use crate::lut::sheet::Sheet;
use crate::numeric::ball::Ball;
use crate::report::{Checks, Computed, Report, Seconds};
use crate::request::{Accuracy, Request};
use crate::table::Table;
use crate::table::claim::{Claim, Stage};
use crate::table::grid::Grid;
use crate::table::packed::Packed;
use integration::{Checked, Integration, on_device, sum};
use std::time::Instant;

/// A baked table, and a report for each of its slices.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The table.
    pub table: Table,
    /// The reports, in the order of the slices.
    pub reports: Vec<Report>,
}

/// Texels of a band: enough to fill any number of cores, and 128 MiB of numbers at the most.
const BAND: usize = 1 << 20;

/// Bakes a table. It has passed its checks when it comes back: see [`crate::certify`].
///
/// # Errors
///
/// [`Error::BadInput`] where a value does not fit the storage or a channel leaves no bound of its
/// error, [`Error::CheckFailed`] where stages or devices differ, [`Error::DeviceFailure`] and
/// [`Error::NoDevice`] from Vulkan, [`Error::Resources`] without memory.
pub fn bake(request: &Request, backend: &Backend) -> Result<Baked> {
    Plan::new(request, backend)?.bake(&|_| ())
}

impl Plan<'_> {
    /// Carries the plan out; `progress` is told of texels as they are integrated.
    pub fn bake(&self, progress: Progress) -> Result<Baked> {
        let request = self.request;
        let layout = request.layout();
        let luts = request.luts()?;
        let mut values = Packed::zeros(request.precision(), luts.len() * layout.values_of_slice())?;
        let size = layout.values_of_slice() * request.precision().bytes();
        let (mut claims, mut reports) = (Vec::new(), Vec::new());
        for (index, (lut, bytes)) in
            luts.iter().zip(values.bytes_mut().chunks_exact_mut(size)).enumerate()
        {
            let slice = Slice { plan: self, lut, progress };
            let Outcome { claim, stages, checks, computed, seconds } = slice.bake(bytes)?;
            reports.push(Report {
                command: request.to_string(),
                slice: layout.slices.as_ref().map(|slices| slices.label(index)),
                size: [layout.x.size(), layout.y.size()],
                clamped: [layout.x.clamped(), layout.y.clamped()],
                computed,
                claim: claim.clone(),
                stages,
                checks,
                seconds,
            });
            claims.push(claim);
        }
        let provenance = luts.iter().map(Lut::provenance).collect();
        let table = Table::new(layout.clone(), values, provenance, claims, request.to_string())?;
        Ok(Baked { table, reports })
    }
}

/// A slice of a table.
struct Slice<'a> {
    plan: &'a Plan<'a>,
    lut: &'a Lut,
    progress: Progress<'a>,
}

/// The outcome of a slice besides its values.
struct Outcome {
    claim: Claim,
    stages: Vec<Stage>,
    checks: Option<Checks>,
    computed: Computed,
    seconds: Seconds,
}

impl Slice<'_> {
    /// Fills in the bytes of the slice.
    fn bake(&self, bytes: &mut [u8]) -> Result<Outcome> {
        match self.plan.request.accuracy() {
            Accuracy::Rounded | Accuracy::Within(_) => self.certified(bytes),
            Accuracy::Tolerance(_) | Accuracy::Rule(_) => self.uncertified(bytes),
        }
    }

    /// The bands of the grid, each with the row of the grid at which it begins.
    fn bands(&self) -> impl Iterator<Item = (usize, Grid)> + use<'_> {
        let grid = self.plan.request.grid();
        let rows = (BAND / grid.mus.len()).max(1);
        (0..grid.alphas.len()).step_by(rows).map(move |first| (first, grid.band(first, rows)))
    }

    fn sheet<'a>(&'a self, bytes: &'a mut [u8]) -> Sheet<'a> {
        let request = self.plan.request;
        Sheet::new(self.lut, request.grid(), request.precision(), bytes)
    }

    fn computed(&self, device_seconds: Option<f64>) -> Computed {
        let reason = self.plan.reason.clone();
        match self.plan.device {
            None => Computed::Cpu { reason },
            Some((gpu, _)) => {
                Computed::Vulkan { device: gpu.info().clone(), reason, device_seconds }
            }
        }
    }

    /// Certifies every value.
    fn certified(&self, bytes: &mut [u8]) -> Result<Outcome> {
        let Plan { request, rules, device, .. } = self.plan;
        let whole = task(request, self.lut, request.grid());
        let (mut seconds, mut device_seconds, mut tally) =
            (Seconds::default(), None, Tally::default());
        let start = Instant::now();
        let stages = Stages::by(&whole, rules);
        seconds.integrate += start.elapsed().as_secs_f64();
        let mut sheet = self.sheet(bytes);
        for (first, band) in self.bands() {
            let start = Instant::now();
            let by_device = match device {
                Some((gpu, rule)) => {
                    let baked = on_device(gpu, self.lut.integrand(), &band, rule, self.progress)?;
                    device_seconds = sum(device_seconds, baked.device_seconds);
                    seconds.integrate += start.elapsed().as_secs_f64();
                    Some((gpu, rule, baked.integrals))
                }
                None => None,
            };
            let start = Instant::now();
            let by_device = by_device.as_ref().map(|(gpu, rule, integrals)| DeviceTable {
                integrals,
                rule,
                name: &gpu.info().name,
            });
            let progress = if device.is_some() { &|_| () } else { self.progress };
            let band = task(request, self.lut, &band);
            let (values, found) = certify_band(&band, &stages, by_device, progress)?;
            sheet.put(first, &values);
            let took = if device.is_some() { &mut seconds.check } else { &mut seconds.integrate };
            *took += start.elapsed().as_secs_f64();
            tally = tally.merge(found);
        }
        sheet.finish()?;
        let claim = Claim::Certificate(tally.certificate(&whole, &stages, hash(bytes))?);
        let computed = self.computed(device_seconds);
        Ok(Outcome { claim, stages: tally.stages, checks: None, computed, seconds })
    }

    /// Integrates by one rule, and checks a sample.
    fn uncertified(&self, bytes: &mut [u8]) -> Result<Outcome> {
        let Plan { request, device, .. } = self.plan;
        let integrand = self.lut.integrand();
        let rule =
            self.plan.rule().ok_or_else(|| Error::Internal("no rule for this tolerance".into()))?;
        let start = Instant::now();
        let mut integration = Integration {
            integrand,
            baker: Baker::new(integrand, &rule),
            gpu: device.map(|(gpu, _)| gpu),
            measured_points: MEASURED.div_ceil(self.bands().count()),
            checked: Checked::default(),
        };
        integration.checked.seconds.integrate += start.elapsed().as_secs_f64();
        let mut bound = 0.0f64;
        let mut sheet = self.sheet(bytes);
        for (first, band) in self.bands() {
            let points = integration.over(&band, self.progress)?;
            let averages = match self.lut.needs_averages() {
                true => integration.averages(&band)?,
                false => vec![Vec::new(); band.alphas.len()],
            };
            let (values, error) = self.channels(&integration, &band, &points, &averages);
            bound = bound.max(error);
            sheet.put(first, &values);
        }
        sheet.finish()?;
        if !bound.is_finite() {
            return Err(unbounded());
        }
        let (on_device, grid) = (integration.gpu.is_some(), request.grid());
        let Checked { cross_check, measured, seconds, device_seconds } = integration.checked;
        let computed = self.computed(device_seconds);
        let claim = Claim::Uncertified {
            rule: rule.name,
            error_bound: bound,
            measured_error: (measured.max(), measured.points),
            computed_by: computed.to_string(),
        };
        let checks = Checks {
            evaluations: rule.evaluations(plan::points(request)) as f64 / grid.len() as f64,
            cross_check: on_device.then_some(cross_check),
            measured,
            integrals: integrand.names(),
            rounding: request.precision().half_step(),
        };
        Ok(Outcome { claim, stages: Vec::new(), checks: Some(checks), computed, seconds })
    }

    /// The values of a band that is not certified, and the largest error of any of them: of values
    /// above 1 relative.
    fn channels(
        &self,
        integration: &Integration,
        band: &Grid,
        points: &Field,
        averages: &[Vec<Ball>],
    ) -> (Vec<f64>, f64) {
        let (lut, precision) = (self.lut, self.plan.request.precision());
        // No channel is negative. Where none exceeds 1 either, an estimate that does is nearer to
        // the truth at 1.
        let at_most_one = lut.at_most_one();
        let count = lut.channels().len();
        let (mut values, mut worst) = (Vec::with_capacity(points.len() * count), 0.0f64);
        for (i, integrals) in points.iter().enumerate() {
            let (mu, alpha) = band.point(i);
            let integrals = integration.within_bound(alpha, integrals, 0.0);
            let channels = lut.values(mu, &integrals, &averages[i / band.mus.len()]);
            for Ball { value, error } in channels.into_iter().take(count) {
                worst = worst.max(error / value.abs().max(1.0));
                let value =
                    precision.pulled_in(value, error, if at_most_one { error } else { 0.0 });
                values.push(precision.stored(value));
            }
        }
        (values, worst)
    }
}

/// BLAKE3 of the bytes of a slice.
pub fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// The certification of a part of a table.
fn task<'a>(request: &Request, lut: &'a Lut, grid: &'a Grid) -> Task<'a> {
    let tolerance = match request.accuracy() {
        Accuracy::Within(tolerance) | Accuracy::Tolerance(tolerance) => tolerance,
        Accuracy::Rounded | Accuracy::Rule(_) => request.precision().default_tolerance(),
    };
    Task { lut, grid, precision: request.precision(), tolerance }
}

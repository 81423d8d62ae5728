//! From a request to a table: who computes it, how, and what is checked before it comes back. A table is baked in
//! bands of rows of one α each, so that no more memory is taken than its own bytes and a band's numbers.

mod choice;
mod integration;

use crate::backend::cpu::Baker;
use crate::backend::vulkan::gpu::Gpu;
use crate::backend::{Backend, Chosen, Progress};
use crate::ball::Ball;
use crate::certificate::Certificate;
use crate::certify::decision::Task;
use crate::certify::deviation::MEASURED;
use crate::certify::stages::Stages;
use crate::certify::tally::Tally;
use crate::certify::ziv::{DeviceTable, certify_band};
use crate::error::{Error, Result};
use crate::integrate::ScaleBias;
use crate::integrate::rule::Rule;
use crate::lut::sheet::Sheet;
use crate::lut::{Grid, Lut};
use crate::report::{self, Computed, Report, Seconds};
use crate::request::{Accuracy, Request};
use crate::table::{Provenance, Table};
use choice::{device_rule, seconds_saved};
use integration::{Checked, Integration, on_device};
use std::time::Instant;

/// A baked table and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The table.
    pub table: Table,
    /// What is to be said of it.
    pub report: Report,
}

/// Texels of a band: its numbers take at most 96 MiB ([`working_bytes`]), and fill any number of cores.
const BAND: usize = 1 << 20;

/// Bytes that baking so many texels may take besides the table: of each texel of a band the integrals of two stages
/// and of a device, its values and whether it is decided.
pub fn working_bytes(texels: usize) -> usize {
    texels.min(BAND) * 96
}

/// Bakes a table. It has passed its checks when it comes back: see [`crate::certify`].
pub fn bake(request: &Request, backend: &Backend, progress: Progress) -> Result<Baked> {
    let grid = request.grid()?;
    let (rule, obstacle) = match device_rule(request) {
        Ok(rule) => (Some(rule), None),
        Err(obstacle) => (None, Some(obstacle)),
    };
    let Chosen { gpu, reason } = backend.choose(obstacle, seconds_saved(request, &grid))?;
    let job = Job { request, grid: &grid, device: gpu.zip(rule), progress };
    let mut sheet = Sheet::new(&request.lut, &grid, request.precision)?;
    let Outcome { worth, seconds, device_seconds } = match request.accuracy {
        Accuracy::Certified(tolerance) => job.certified(tolerance, &mut sheet)?,
        Accuracy::Tolerance(tolerance) => {
            let on_cpu = Rule::for_cpu(request.lut.integrand(), tolerance, grid.len());
            job.uncertified(on_cpu, &mut sheet)?
        }
        Accuracy::Rule(rule) => job.uncertified(Some(rule), &mut sheet)?,
    };
    let computed = match gpu {
        None => Computed::Cpu { reason },
        Some(gpu) => Computed::Vulkan { device: gpu.info().clone(), reason, device_seconds },
    };
    let provenance = Provenance { command: request.to_string(), ..request.lut.provenance() };
    let channels = request.lut.channels().to_vec();
    let mut table = Table { x: request.x, y: request.y, channels, values: sheet.finish()?, provenance };
    let worth = match worth {
        report::Worth::Certified { certificate, stages } => {
            let certificate = Certificate { blake3: table.hash(), ..certificate };
            table.provenance.worth = crate::table::Worth::Certificate(certificate.clone());
            report::Worth::Certified { certificate, stages }
        }
        report::Worth::Uncertified { accuracy } => {
            table.provenance.worth = crate::table::Worth::Uncertified {
                rule: accuracy.rule,
                error_bound: accuracy.bound,
                measured_error: (accuracy.measured.largest(), accuracy.measured.texels),
                computed_by: computed.to_string(),
            };
            report::Worth::Uncertified { accuracy }
        }
    };
    let report = Report {
        command: request.to_string(),
        size: [request.x.size, request.y.size],
        clamped: [request.x.clamped(), request.y.clamped()],
        computed,
        worth,
        seconds,
    };
    Ok(Baked { table, report })
}

/// A request and who does it.
struct Job<'a> {
    request: &'a Request,
    grid: &'a Grid,
    /// A device and the rule by which it integrates; `None` computes on the CPU.
    device: Option<(&'a Gpu, Rule)>,
    progress: Progress<'a>,
}

/// What comes of a job besides the values.
struct Outcome {
    worth: report::Worth,
    seconds: Seconds,
    /// The device's own time.
    device_seconds: Option<f64>,
}

impl Job<'_> {
    /// The bands of the grid, each with the row of the grid at which it begins.
    fn bands(&self) -> impl Iterator<Item = (usize, Grid)> + use<'_> {
        let rows = (BAND / self.grid.mus.len()).max(1);
        (0..self.grid.alphas.len()).step_by(rows).map(move |first| (first, self.grid.band(first, rows)))
    }

    /// A table certified value by value.
    fn certified(&self, tolerance: f64, sheet: &mut Sheet) -> Result<Outcome> {
        let Job { request, grid, progress, .. } = *self;
        let stages = Stages::of(&task(request, grid, tolerance));
        let (mut seconds, mut device_seconds, mut tally) = (Seconds::default(), None, Tally::default());
        for (first, band) in self.bands() {
            let start = Instant::now();
            let device = match &self.device {
                Some((gpu, rule)) => {
                    let baked = on_device(gpu, request.lut.integrand(), &band, rule, progress)?;
                    device_seconds = baked.device_seconds.map(|s| s + device_seconds.unwrap_or(0.0));
                    seconds.integrate += start.elapsed().as_secs_f64();
                    Some((gpu, rule, baked.integrals))
                }
                None => None,
            };
            let start = Instant::now();
            let by_device =
                device.as_ref().map(|(gpu, rule, points)| DeviceTable { points, rule, name: &gpu.info().name });
            let progress = if device.is_some() { &|_| () } else { progress };
            let (values, found) = certify_band(&task(request, &band, tolerance), &stages, by_device, progress)?;
            sheet.put(first, &values);
            let took = if device.is_some() { &mut seconds.check } else { &mut seconds.integrate };
            *took += start.elapsed().as_secs_f64();
            tally = tally.with(found);
        }
        let certificate = tally.certificate(&request.lut, request.precision, &stages)?;
        Ok(Outcome { worth: report::Worth::Certified { certificate, stages: tally.stages }, seconds, device_seconds })
    }

    /// A table by one rule, `on_cpu` where no device computes it, checked on a sample.
    fn uncertified(&self, on_cpu: Option<Rule>, sheet: &mut Sheet) -> Result<Outcome> {
        let Job { request, grid, device, progress } = *self;
        let (lut, integrand) = (&request.lut, request.lut.integrand());
        let rule = device.map(|(_, rule)| rule).or(on_cpu);
        let rule = rule.ok_or_else(|| Error::Internal("no rule for this tolerance".into()))?;
        let mut integration = Integration {
            integrand,
            baker: Baker::new(integrand, &rule),
            gpu: device.map(|(gpu, _)| gpu),
            measured_texels: MEASURED.div_ceil(self.bands().count()),
            checked: Checked::default(),
        };
        let mut bound = 0.0f64;
        for (first, band) in self.bands() {
            let points = integration.over(&band, progress)?;
            let averages = match lut.needs_averages() {
                true => integration.averages(&band)?,
                false => vec![ScaleBias::<Ball>::default(); band.alphas.len()],
            };
            let (values, error) = self.channels(&integration, &band, &points, &averages);
            bound = bound.max(error);
            sheet.put(first, &values);
        }
        if !bound.is_finite() {
            return Err(crate::certify::tally::unbounded());
        }
        let gpu = integration.gpu;
        let Checked { cross_check, measured, seconds, device_seconds } = integration.checked;
        let accuracy = report::Accuracy {
            rule: rule.name,
            evaluations: rule.evaluations(grid.len()) as f64 / grid.len() as f64,
            bound,
            cross_check: gpu.is_some().then_some(cross_check),
            measured,
            rounding: request.precision.half_step(),
        };
        Ok(Outcome { worth: report::Worth::Uncertified { accuracy }, seconds, device_seconds })
    }

    /// The values of a band that is not certified, and the most that one of them may be off: of values above 1
    /// relative.
    fn channels(
        &self,
        integration: &Integration,
        band: &Grid,
        points: &[ScaleBias],
        averages: &[ScaleBias<Ball>],
    ) -> (Vec<f64>, f64) {
        let Request { lut, precision, .. } = self.request;
        // No channel is negative. Where none is above 1 either, an estimate that is, is nearer to the truth at 1.
        let at_most_one = matches!(lut, Lut::Dfg(_)) && !integration.integrand.may_exceed_one();
        let count = lut.channels().len();
        let (mut values, mut worst) = (Vec::with_capacity(points.len() * count), 0.0f64);
        for (i, &integral) in points.iter().enumerate() {
            let (mu, alpha) = band.point(i);
            let integral = integration.within_bound(alpha, integral, 0.0);
            let channels = lut.values(mu, integral, averages[i / band.mus.len()]);
            for Ball { value, error } in channels.into_iter().take(count) {
                worst = worst.max(error / value.abs().max(1.0));
                let value = precision.pulled_in(value, error, if at_most_one { error } else { 0.0 });
                values.push(precision.stored(value));
            }
        }
        (values, worst)
    }
}

fn task<'a>(request: &'a Request, grid: &'a Grid, tolerance: f64) -> Task<'a> {
    Task { lut: &request.lut, grid, precision: request.precision, tolerance }
}

//! From a request to a table: who computes it, how, and what is checked before it comes back.

use crate::backend::vulkan::{self, gpu::Gpu};
use crate::backend::{Backend, Chosen, Progress, cpu};
use crate::certificate::Certificate;
use crate::certify::decision::Task;
use crate::certify::deviation::{self, Deviation};
use crate::certify::ziv::{self, Certified, DeviceTable};
use crate::error::{Complaint, Error, Result};
use crate::integrate::average::{average_nodes, averages};
use crate::integrate::h_space::HSpaceRule;
use crate::integrate::rule::{Method, Rule, f32_arithmetic};
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::Grid;
use crate::precision::Precision;
use crate::quadrature::slope_map::Power;
use crate::report::{self, Computed, Report, Seconds};
use crate::request::{Accuracy, Request};
use crate::table::{Provenance, Table};
use std::time::Instant;

/// A baked table and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The table: of a certified one the stored values, of another the integrals in f64, whoever computed them.
    pub table: Table,
    /// What is to be said of it.
    pub report: Report,
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
    let Outcome { values, worth, seconds, device_seconds } = match request.accuracy {
        Accuracy::Certified(tolerance) => job.certified(tolerance)?,
        Accuracy::Tolerance(tolerance) => {
            job.uncertified(Rule::for_cpu(request.lut.integrand(), tolerance, grid.len()))?
        }
        Accuracy::Rule(rule) => job.uncertified(Some(rule))?,
    };
    let computed = match gpu {
        None => Computed::Cpu { reason },
        Some(gpu) => Computed::Vulkan { device: gpu.info().clone(), reason, device_seconds },
    };
    let provenance = Provenance { command: request.to_string(), ..request.lut.provenance() };
    let mut table = grid.table(request.lut.channels(), (request.x, request.y), values, provenance);
    let worth = match worth {
        report::Worth::Certified { certificate, stages } => {
            let certificate = Certificate { blake3: table.hash(request.precision)?, ..certificate };
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

/// What comes of a job.
struct Outcome {
    /// In the order of the grid.
    values: Vec<f64>,
    worth: report::Worth,
    seconds: Seconds,
    /// The device's own time.
    device_seconds: Option<f64>,
}

impl Job<'_> {
    /// A table certified value by value.
    fn certified(&self, tolerance: f64) -> Result<Outcome> {
        let Job { request, grid, progress, .. } = *self;
        let start = Instant::now();
        let device = match &self.device {
            Some((gpu, rule)) => Some((gpu, rule, on_device(gpu, request.lut.integrand(), grid, rule, progress)?)),
            None => None,
        };
        let integrate = start.elapsed().as_secs_f64();
        let table = device.as_ref().map(|(gpu, rule, baked)| DeviceTable {
            points: &baked.integrals,
            rule,
            name: &gpu.info().name,
        });
        let start = Instant::now();
        let progress = if device.is_some() { &|_| () } else { progress };
        let Certified { values, certificate, stages } = ziv::certify(&task(request, grid, tolerance), table, progress)?;
        Ok(Outcome {
            values,
            worth: report::Worth::Certified { certificate, stages },
            seconds: match device {
                Some(_) => Seconds { integrate, check: start.elapsed().as_secs_f64() },
                None => Seconds { integrate: start.elapsed().as_secs_f64(), check: 0.0 },
            },
            device_seconds: device.and_then(|(_, _, baked)| baked.device_seconds),
        })
    }

    /// A table by one rule, `on_cpu` where no device computes it, checked on a sample.
    fn uncertified(&self, on_cpu: Option<Rule>) -> Result<Outcome> {
        let Job { request, grid, device, progress } = *self;
        let integrand = request.lut.integrand();
        // The rules' bounds are rounded up by far more than f64 adds.
        let (gpu, rule, arithmetic) = match device {
            Some((gpu, rule)) => (Some(gpu), Some(rule), f32_arithmetic(integrand)),
            None => (None, on_cpu, 0.0),
        };
        let rule = rule.ok_or_else(|| Error::Internal("no rule for this tolerance".into()))?;
        let mut integration = Integration { integrand, rule, arithmetic, gpu, checked: Checked::default() };
        let points = integration.over(grid, progress)?;
        let averages = if request.lut.needs_averages() {
            let nodes = average_nodes();
            let directions = grid.at_directions(nodes.iter().map(|node| node.0).collect());
            averages(&nodes, &integration.over(&directions, &|_| ())?)
        } else {
            vec![ScaleBias::default(); grid.alphas.len()]
        };
        let channels = request.lut.channels().len();
        let value = |(i, &integral): (usize, &ScaleBias)| {
            let values = request.lut.values(grid.point(i).0, integral, averages[i / grid.mus.len()]);
            values.into_iter().take(channels)
        };
        let Checked { cross_check, measured, seconds, device_seconds } = integration.checked;
        let accuracy = report::Accuracy {
            rule: rule.name,
            evaluations: rule.evaluations(grid.len()) as f64 / grid.len() as f64,
            bound: rule.bound(integrand) + arithmetic,
            cross_check: gpu.is_some().then_some(cross_check),
            measured,
            rounding: request.precision.half_step(),
        };
        Ok(Outcome {
            values: points.iter().enumerate().flat_map(value).collect(),
            worth: report::Worth::Uncertified { accuracy },
            seconds,
            device_seconds,
        })
    }
}

/// How the integrals of a table that is not certified are computed, and what the checks have found over all its grids.
struct Integration<'a> {
    integrand: Integrand,
    rule: Rule,
    arithmetic: f64,
    gpu: Option<&'a Gpu>,
    checked: Checked,
}

#[derive(Default)]
struct Checked {
    cross_check: Deviation,
    measured: Deviation,
    seconds: Seconds,
    device_seconds: Option<f64>,
}

impl Integration<'_> {
    /// Integrates over a grid, and checks what comes out.
    fn over(&mut self, grid: &Grid, progress: Progress) -> Result<Vec<ScaleBias>> {
        let Integration { integrand, rule, arithmetic, gpu, checked } = self;
        let start = Instant::now();
        let integrals = match gpu {
            Some(gpu) => {
                let baked = on_device(gpu, *integrand, grid, rule, progress)?;
                checked.device_seconds = baked.device_seconds.map(|s| s + checked.device_seconds.unwrap_or(0.0));
                baked.integrals
            }
            None => cpu::bake(*integrand, grid, rule, progress),
        };
        checked.seconds.integrate += start.elapsed().as_secs_f64();
        let start = Instant::now();
        if gpu.is_some() {
            let found = deviation::cross_check(*integrand, grid, rule, &integrals)?;
            checked.cross_check = checked.cross_check.with(found);
        }
        let found = deviation::measure(*integrand, grid, rule, *arithmetic, &integrals)?;
        checked.measured = checked.measured.with(found);
        checked.seconds.check += start.elapsed().as_secs_f64();
        Ok(integrals)
    }
}

/// The rule of a closed form.
const NO_NODES: HSpaceRule =
    HSpaceRule { radial: 0, azimuth: 0, radial_horizon: 0, azimuth_horizon: 0, power: Power::Two };

fn on_device(
    gpu: &Gpu,
    integrand: Integrand,
    grid: &Grid,
    rule: &Rule,
    progress: Progress,
) -> Result<vulkan::bake::DeviceBake> {
    let nodes = match rule.method {
        Method::HSpace(nodes) => nodes,
        _ => NO_NODES,
    };
    vulkan::bake::bake(gpu, integrand, grid, &nodes, progress)
}

fn task<'a>(request: &'a Request, grid: &'a Grid, tolerance: f64) -> Task<'a> {
    Task { lut: &request.lut, grid, precision: request.precision, tolerance }
}

/// The tolerance of a device's stage in certification: half of it is f32's.
const DEVICE_STAGE: f64 = 2e-6;

/// The rule by which a device can do the job, or what stands in the way.
fn device_rule(request: &Request) -> std::result::Result<Rule, Complaint> {
    let integrand = request.lut.integrand();
    let found = match request.accuracy {
        Accuracy::Rule(rule) => Some(rule),
        Accuracy::Tolerance(tolerance) => Rule::for_device(integrand, tolerance),
        // No rule keeps less than the last, so that rounding must not rule it out.
        Accuracy::Certified(_) => {
            Rule::for_device(integrand, DEVICE_STAGE.max(1.001 * Rule::device_tolerance(integrand)))
        }
    };
    match found {
        Some(rule) if rule.runs_on_device() => Ok(rule),
        Some(rule) if matches!(request.accuracy, Accuracy::Rule(_)) => {
            Err(Complaint::new("rule", "one that a device can run, beginning with h", rule.name, "use --backend cpu"))
        }
        _ => Err(Complaint::new(
            "tolerance",
            "one that f32 on a device and its finest rule can keep",
            "a smaller one",
            "use --backend cpu",
        )),
    }
}

/// The share of texels, about, that f32 on a device decides and the CPU does not repeat.
const LEFT_TO_DEVICE: f64 = 0.9;

/// About how many seconds of the CPU's work a device would take over.
fn seconds_saved(request: &Request, grid: &Grid) -> f64 {
    let (integrand, texels) = (request.lut.integrand(), grid.len());
    let whole = |rule: &Rule| rule.seconds(integrand, texels);
    let seconds = match request.accuracy {
        Accuracy::Rule(rule) => whole(&rule),
        Accuracy::Tolerance(tolerance) => Rule::for_cpu(integrand, tolerance, texels).as_ref().map_or(0.0, whole),
        // Values in f32 are the CPU's, whoever computes them too; and a surrogate checks every texel of a device.
        Accuracy::Certified(_) if request.precision == Precision::F32 => 0.0,
        Accuracy::Certified(tolerance) => match ziv::stages(&task(request, grid, tolerance)).first() {
            Some(first) if !matches!(first.method, Method::Surrogate(_)) => LEFT_TO_DEVICE * whole(first),
            _ => 0.0,
        },
    };
    seconds / rayon::current_num_threads() as f64
}

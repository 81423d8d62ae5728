//! splitsum bakes preintegrated BRDF tables, on Vulkan compute or on the CPU, and says how far each is from the truth.
//!
//! ```text
//!   Request ──► Lut + Rule over a Grid ──► backend ──► certify ──► Table ──► encode ──► bytes
//!   (request)   (lut, integrate, model)   (cpu, vulkan)                      (exr, png)    │
//!                                                          report ◄────────────────────────┘
//! ```
//!
//! A module uses only modules that stand above it in this list:
//!
//! - [`error`]: every failure, with what was expected, what was got and the cure; the exit codes
//! - [`units`]: perceptual roughness, α, cosines, index of refraction, F0; each conversion once
//! - [`axis`]: texel ↔ parameter, the only half-texel arithmetic
//! - [`table`]: values over two axes, bilinear lookup, differences
//! - [`half`]: correctly rounded binary16
//! - [`precision`]: how a value is stored
//! - [`special`]: the special functions of the models
//! - [`quadrature`]: Gauss-Legendre, the slope map, double exponential
//! - [`model`]: distributions of normals, masking, Fresnel, with their citations
//! - [`integrate`]: how a lobe becomes (A, B): over half vectors, over light directions, by the reference; the rules
//! - [`lut`]: what is baked, over which grid, into which channels
//! - [`request`]: a checked job, which prints itself as the command that repeats it
//! - [`backend`]: the CPU, the shaders, the Vulkan host
//! - [`certify`]: a device's table against the CPU, any table against the reference
//! - [`furnace`]: what a material gives back in a white furnace
//! - [`report`]: what is said of a bake; pictures
//! - [`preview`]: spheres lit with tables and with integrals
//! - [`encode`]: a table as the bytes of a file
//! - `cli`: flags and configurations to requests; files and terminals
//!
//! What is absent, and kept absent by `tests/tidy.rs`: models know no tables; backends know no files; encoders know only
//! tables; nothing but `cli` touches the disk or prints; `unsafe` stands in `backend/vulkan` alone; every WGSL function
//! has a Rust twin of the same name.
//!
//! ```
//! use splitsum::{backend::Backend, lut::{Dfg, DfgChannels, Lut}, model::{Masking, Microfacet, Ndf}};
//! use splitsum::{precision::Precision, request::Request};
//!
//! let lobe = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };
//! let lut = Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab });
//! let request = Request::with_default_axes(lut, (16, 16), Precision::F16)?;
//! let baked = splitsum::bake(&request, &Backend::cpu(), &|_| ())?;
//! assert!(baked.report.accuracy.measured.largest() <= baked.report.accuracy.bound);
//! # Ok::<(), splitsum::error::Error>(())
//! ```

pub mod error;
pub mod units;
pub mod axis;
pub mod table;
pub mod half;
pub mod precision;
pub mod special;
pub mod quadrature;
pub mod model;
pub mod integrate;
pub mod lut;
pub mod request;
pub mod backend;
pub mod certify;
pub mod furnace;
pub mod report;
pub mod preview;
pub mod encode;
pub mod cli;

use backend::vulkan::{self, gpu::Gpu};
use backend::{Backend, Progress, cpu};
use certify::Deviation;
use error::{Complaint, Error, Result};
use integrate::average::{average, average_nodes};
use integrate::h_space::HSpaceRule;
use integrate::rule::{Method, Rule, f32_arithmetic};
use integrate::{Integrand, ScaleBias};
use lut::{Grid, Integrals};
use quadrature::slope_map::Power;
use report::{Computed, Report, Seconds};
use request::{Accuracy, Request};
use std::time::Instant;
use table::{Provenance, Table};

/// A baked table and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Baked {
    /// The table, in f64 whoever computed it.
    pub table: Table,
    /// What is to be said of it.
    pub report: Report,
}

/// Bakes a table. It has passed its checks when it comes back: see [`certify`].
pub fn bake(request: &Request, backend: &Backend, progress: Progress) -> Result<Baked> {
    let (integrand, grid) = (request.lut.integrand(), request.grid()?);
    let (gpu, reason) = backend.device_unless(device_rule(request).err())?;
    // The rules' bounds are rounded up by far more than f64 adds.
    let arithmetic = if gpu.is_some() { f32_arithmetic(integrand) } else { 0.0 };
    let rule = match request.accuracy {
        Accuracy::Rule(rule) => rule,
        Accuracy::Tolerance(tolerance) => {
            let rule = Rule::for_tolerance(integrand, tolerance, arithmetic);
            rule.ok_or_else(|| Error::Internal(format!("no rule for the tolerance {tolerance}")))?
        }
    };
    let job = Job { integrand, rule, arithmetic, gpu };
    let mut checked = Checked::default();
    let mut integrals = Integrals { points: job.run(&grid, progress, &mut checked)?, averages: Vec::new() };
    if request.lut.needs_averages() {
        let nodes = average_nodes();
        let directions = grid.at_directions(nodes.iter().map(|node| node.0).collect());
        let rows = job.run(&directions, &|_| (), &mut checked)?;
        integrals.averages = rows.chunks(nodes.len()).map(|row| average(&nodes, row)).collect();
    }
    let computed = match gpu {
        None => Computed::Cpu { reason },
        Some(gpu) => Computed::Vulkan { device: gpu.info().clone(), cross_check: checked.cross_check },
    };
    let report = Report {
        command: request.to_string(),
        size: [request.x.size, request.y.size],
        clamped: [request.x.clamped(), request.y.clamped()],
        computed,
        accuracy: report::Accuracy::new(request, &rule, arithmetic, checked.measured),
        seconds: checked.seconds,
    };
    let provenance = Provenance {
        rule: rule.name,
        error_bound: report.accuracy.bound,
        measured_error: (checked.measured.largest(), checked.measured.texels),
        computed_by: report.computed.to_string(),
        command: report.command.clone(),
        ..request.lut.provenance()
    };
    let table = grid.table(&request.lut, (request.x, request.y), &integrals, provenance);
    Ok(Baked { table, report })
}

/// The rule of a closed form.
const NO_NODES: HSpaceRule =
    HSpaceRule { radial: 0, azimuth: 0, radial_horizon: 0, azimuth_horizon: 0, power: Power::Two };

/// How the integrals of a bake are computed.
struct Job<'a> {
    integrand: Integrand,
    rule: Rule,
    arithmetic: f64,
    gpu: Option<&'a Gpu>,
}

/// What the checks of a bake have found, over all its grids, and the time that it took.
#[derive(Default)]
struct Checked {
    cross_check: Deviation,
    measured: Deviation,
    seconds: Seconds,
}

impl Job<'_> {
    /// Integrates over a grid, and checks what comes out.
    fn run(&self, grid: &Grid, progress: Progress, checked: &mut Checked) -> Result<Vec<ScaleBias>> {
        let Job { integrand, rule, arithmetic, gpu } = self;
        let start = Instant::now();
        let integrals = match (gpu, rule.method) {
            (Some(gpu), Method::HSpace(nodes)) => vulkan::bake::bake(gpu, *integrand, grid, &nodes, progress)?,
            (Some(gpu), Method::ClosedForm) => vulkan::bake::bake(gpu, *integrand, grid, &NO_NODES, progress)?,
            _ => cpu::bake(*integrand, grid, rule, progress),
        };
        checked.seconds.integrate += start.elapsed().as_secs_f64();
        let start = Instant::now();
        if gpu.is_some() {
            checked.cross_check = checked.cross_check.with(certify::cross_check(*integrand, grid, rule, &integrals)?);
        }
        checked.measured = checked.measured.with(certify::measure(*integrand, grid, rule, *arithmetic, &integrals)?);
        checked.seconds.check += start.elapsed().as_secs_f64();
        Ok(integrals)
    }
}

/// The rule by which a device can do the job, or what stands in the way.
fn device_rule(request: &Request) -> std::result::Result<Rule, Complaint> {
    let integrand = request.lut.integrand();
    let found = match request.accuracy {
        Accuracy::Rule(rule) => Some(rule),
        Accuracy::Tolerance(tolerance) => Rule::for_tolerance(integrand, tolerance, f32_arithmetic(integrand)),
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

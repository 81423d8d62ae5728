//! Speed against accuracy: every method at every cost, timed against 1,024 samples in the same run,
//! and its error.

use super::lookup;
use super::{Errors, Lobe, Share, median, stored, timed};
use crate::backend::{Gpu, cpu};
use crate::brdf::Microfacet;
use crate::compare::point_set::PointSet;
use crate::compare::technique::{Arithmetic, BASELINE, Setting, Technique};
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rules::{H6144, REFERENCE};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use serde::{Deserialize, Serialize};

/// The plan of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The lobe.
    pub lobe: Lobe,
    /// Texels along either edge of the table: n·v by perceptual roughness, texel centres.
    pub size: usize,
    /// Seeds Owen's scrambling.
    pub seed: u64,
    /// Whether a rough picture within seconds will do: fewer points and repeats.
    pub quick: bool,
}

/// A backend.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Who {
    /// The CPU.
    Cpu(Arithmetic),
    /// The Vulkan device of that name, in f32.
    Device(String),
}

/// A method at one of its costs, as it was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// The method.
    pub technique: Technique,
    /// Its setting: a number of points of a set, a rule, a precision.
    pub step: String,
    /// Its backend.
    pub who: Who,
    /// Evaluations of the integrand for a texel.
    pub evaluations: f64,
    /// Median of the seconds that the table took; on a device by its own clock, where it has one.
    pub seconds: f64,
    /// The shortest and the longest.
    pub spread: [f64; 2],
    /// The median over that of the baseline, run between the same moments.
    pub ratio: f64,
    /// The errors of the table.
    #[serde(flatten)]
    pub errors: Errors,
}

/// A lower limit on the total error set by storage, arithmetic or lookup, independent of the
/// method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Floor {
    /// Its cause.
    pub name: String,
    /// The largest error that it makes, measured on the table at hand.
    pub error: f64,
}

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Speed {
    /// The plan.
    pub plan: Plan,
    /// Median seconds of the baseline over the whole run.
    pub baseline_seconds: f64,
    /// The errors of storage, arithmetic and lookup.
    pub floors: Vec<Floor>,
    /// The measurements.
    pub measurements: Vec<Measurement>,
}

/// The longest that a single table may take, in seconds, full and quick.
const PATIENCE: [f64; 2] = [0.7, 0.06];

/// The grid of a plan.
pub fn grid(size: usize) -> Result<Grid> {
    let (x, y) = lookup::axes_of(lookup::CENTRES, size)?;
    Grid::new(&x, &y)
}

/// Measures everything that the plan names on the CPU and on the devices.
pub fn measure(plan: Plan, devices: &[Gpu], share: Share) -> Result<Speed> {
    let (lobe, grid) = (Microfacet::from(plan.lobe), grid(plan.size)?);
    let truth = cpu::bake(lobe, &grid, &REFERENCE, &|_| ()).scale_bias();
    let run = Run { plan, lobe, grid: &grid, truth: &truth };
    let mut speed =
        Speed { plan, baseline_seconds: 0.0, floors: run.floors()?, measurements: Vec::new() };
    let (mut baselines, techniques) = (Vec::new(), Technique::all().collect::<Vec<_>>());
    let turns = techniques.len() * (2 + devices.len());
    let mut done = 0;
    for technique in techniques {
        let cpu = [Arithmetic::F32, Arithmetic::F64].map(Runner::Cpu);
        for runner in cpu.into_iter().chain(devices.iter().map(Runner::Device)) {
            // What a point cost in the last step: points are left when they would take too long.
            let mut each = 0.0;
            for step in technique.steps(lobe) {
                let points =
                    if let Setting::Samples(_, _, count) = step { count as f64 } else { 0.0 };
                if !run.wants(&step, runner) || each * points > run.patience() {
                    continue;
                }
                if let Some((measurement, baseline)) = run.measure(technique, &step, runner)? {
                    if points > 0.0 {
                        each = measurement.seconds / points;
                    }
                    baselines.push(baseline);
                    speed.measurements.push(measurement);
                }
            }
            done += 1;
            share(done as f64 / turns as f64);
        }
    }
    speed.baseline_seconds = median(baselines);
    Ok(speed)
}

/// A backend, ready to run.
#[derive(Clone, Copy)]
enum Runner<'a> {
    Cpu(Arithmetic),
    Device(&'a Gpu),
}

impl Runner<'_> {
    fn who(self) -> Who {
        match self {
            Runner::Cpu(arithmetic) => Who::Cpu(arithmetic),
            Runner::Device(gpu) => Who::Device(gpu.info().name.clone()),
        }
    }
}

struct Run<'a> {
    plan: Plan,
    lobe: Microfacet,
    grid: &'a Grid,
    truth: &'a [ScaleBias],
}

impl Run<'_> {
    fn patience(&self) -> f64 {
        PATIENCE[usize::from(self.plan.quick)]
    }

    /// Point sets differ in their errors, not in their costs: f64 and devices do with Hammersley's,
    /// and a quick run too.
    fn wants(&self, step: &Setting, runner: Runner) -> bool {
        let (can, all) = match runner {
            Runner::Cpu(arithmetic) => {
                (step.runs_in(arithmetic), !self.plan.quick && arithmetic == Arithmetic::F32)
            }
            Runner::Device(_) => (true, false),
        };
        can && (all || !matches!(step, Setting::Samples(_, set, _) if *set != PointSet::Hammersley))
    }

    fn measure(
        &self,
        technique: Technique,
        step: &Setting,
        runner: Runner,
    ) -> Result<Option<(Measurement, f64)>> {
        let Run { plan, lobe, grid, truth } = *self;
        let once = || -> Result<Option<(Vec<ScaleBias>, f64)>> {
            match runner {
                Runner::Cpu(arithmetic) => {
                    let (values, seconds) = timed(|| step.run(lobe, grid, arithmetic, plan.seed));
                    Ok(Some((values?, seconds)))
                }
                Runner::Device(gpu) => {
                    let (baked, wall) = timed(|| step.run_on(gpu, lobe, grid, plan.seed));
                    Ok(baked?.map(|baked| {
                        (baked.integrals.scale_bias(), baked.device_seconds.unwrap_or(wall))
                    }))
                }
            }
        };
        // The first warms up, and tells how many more are worth while; where it is long, it counts.
        let Some((values, first)) = once()? else { return Ok(None) };
        let repeats = match first {
            0.5.. => 0,
            0.2.. => 1,
            0.05.. => 3,
            _ if plan.quick => 3,
            _ => 5,
        };
        let (mut times, mut baselines) =
            (if repeats == 0 { vec![first] } else { Vec::new() }, Vec::new());
        for round in 0..=repeats {
            if round > 0
                && let Some((_, seconds)) = once()?
            {
                times.push(seconds);
            }
            baselines.push(timed(|| BASELINE.run(lobe, grid, Arithmetic::F32, plan.seed)).1);
        }
        let spread = times
            .iter()
            .fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], &t| [low.min(t), high.max(t)]);
        let (seconds, baseline) = (median(times), median(baselines));
        let errors = Errors::between(values.into_iter().zip(truth.iter().copied()));
        let evaluations = step.evaluations(lobe, grid.len());
        let (who, step, ratio) = (runner.who(), step.name(), seconds / baseline);
        Ok(Some((
            Measurement { technique, step, who, evaluations, seconds, spread, ratio, errors },
            baseline,
        )))
    }

    fn floors(&self) -> Result<Vec<Floor>> {
        let Run { plan, lobe, grid, truth } = *self;
        let floor = |name: &str, values: Vec<ScaleBias>| {
            let errors = Errors::between(values.into_iter().zip(truth.iter().copied()));
            Floor { name: name.into(), error: errors.largest() }
        };
        let finest = Setting::Rule(H6144);
        let (single, double) = (
            finest.run(lobe, grid, Arithmetic::F32, plan.seed)?,
            finest.run(lobe, grid, Arithmetic::F64, plan.seed)?,
        );
        let arithmetic = Errors::between(single.into_iter().zip(double)).largest();
        let axes = lookup::CENTRES;
        let read = lookup::practical(lobe, axes, plan.size, truth)?;
        let read = read
            .map(|error| Floor { name: format!("bilinear lookup, {0} x {0}", plan.size), error });
        let others = [
            floor("8-bit storage", stored(truth, Precision::Unorm8)),
            floor("half-float storage", stored(truth, Precision::F16)),
            Floor { name: "f32 arithmetic".into(), error: arithmetic },
        ];
        Ok(read.into_iter().chain(others).collect())
    }
}

/// How much longer a peer takes than the fastest of ours, where both are at most `error` off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtError {
    /// The largest error that is allowed.
    pub error: f64,
    /// The fastest of ours that keeps it, over the baseline.
    pub ours: Option<f64>,
    /// The peer's, over the baseline; none where it never gets there.
    pub peer: Option<f64>,
}

impl Speed {
    /// The cheapest measured step on the CPU of those techniques that keeps an error.
    pub fn cheapest(&self, error: f64, of: impl Fn(Technique) -> bool) -> Option<&Measurement> {
        let kept =
            self.measurements.iter().filter(|m| matches!(m.who, Who::Cpu(_)) && of(m.technique));
        kept.filter(|m| m.errors.largest() <= error).min_by(|a, b| a.ratio.total_cmp(&b.ratio))
    }

    /// A peer against ours at an error.
    pub fn at_error(&self, peer: Technique, error: f64) -> AtError {
        let ratio = |of: &dyn Fn(Technique) -> bool| self.cheapest(error, of).map(|m| m.ratio);
        AtError {
            error,
            ours: ratio(&Technique::is_ours),
            peer: ratio(&|technique| technique == peer),
        }
    }

    /// The measurements as lines of CSV.
    pub fn to_csv(&self) -> String {
        let mut csv = String::from(
            "technique,source,step,who,evaluations,seconds,shortest,longest,ratio,\
             max_a,max_b,rms_a,rms_b\n",
        );
        for m in &self.measurements {
            let who = match &m.who {
                Who::Cpu(Arithmetic::F32) => "CPU f32",
                Who::Cpu(Arithmetic::F64) => "CPU f64",
                Who::Device(name) => name,
            };
            let ([low, high], Errors { max, rms }) = (m.spread, m.errors);
            let (name, source, step) = (m.technique.name(), m.technique.source(), &m.step);
            let numbers =
                [m.evaluations, m.seconds, low, high, m.ratio, max[0], max[1], rms[0], rms[1]];
            let numbers = numbers.map(|number| format!("{number:.6e}")).join(",");
            csv += &format!("{name},\"{source}\",{step},\"{who}\",{numbers}\n");
        }
        csv
    }
}

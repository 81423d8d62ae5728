//! Ziv's strategy: a cheap stage with a bound of its error decides every value that lies farther from a boundary of rounding
//! than that; what is left goes to a finer stage, and at last to the reference. Whatever stages a value has passed, it is the
//! same: the true integral, rounded once (Ziv, "Fast evaluation of elementary mathematical functions with correctly rounded last
//! bit", 1991).
//!
//! The stages check each other. A value that differs from that of a finer stage by more than both may err is a fault, of the
//! device or of a bound: the table is thrown away, not mended.

use super::deviation::{check_range, sample, scatter};
use crate::backend::{Progress, cpu};
use crate::certificate::{Certificate, Stage};
use crate::error::{Error, Result};
use crate::integrate::average::{average, average_error, average_nodes};
use crate::integrate::rule::{Method, REFERENCE, Rule};
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::{Grid, Lut};
use crate::precision::Precision;
use rayon::prelude::*;

/// Texels that pass through the second stage though the first has decided them, so that one checks the other.
const AUDITED: usize = 64;

/// What the arithmetic of channels may err, relative: eight units in the last place.
const ROUNDING: f64 = 2e-15;

/// So many values, at the most, are rounded correctly to f32, whose steps are as fine as the fast stages' bounds.
const LARGEST_F32: usize = 4096;

/// What is to be certified.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The table.
    pub lut: &'a Lut,
    /// Its points.
    pub grid: &'a Grid,
    /// How it is stored.
    pub precision: Precision,
    /// The largest error of an integral that is stored in f32.
    pub tolerance: f64,
}

/// A table that a device has computed.
#[derive(Clone, Copy, Debug)]
pub struct DeviceTable<'a> {
    /// In the order of the grid.
    pub points: &'a [ScaleBias],
    /// By which rule.
    pub rule: &'a Rule,
    /// What the device calls itself.
    pub name: &'a str,
}

/// A certified table.
#[derive(Clone, Debug)]
pub struct Certified {
    /// The stored values, as many for each point as there are channels, in the order of the grid.
    pub values: Vec<f64>,
    /// What is certified; the hash is left to whoever knows the order of the file.
    pub certificate: Certificate,
    /// What the stages did, one after the other.
    pub stages: Vec<Stage>,
}

/// The rules of the CPU's stages, each finer than the one before.
pub fn stages(task: &Task) -> Vec<Rule> {
    let integrand = task.lut.integrand();
    let texels = task.grid.len();
    let first = match task.precision {
        Precision::F32 => Rule::for_cpu(integrand, task.tolerance, texels),
        _ => Rule::for_rounding(integrand, texels),
    };
    let rest = ["d10240", "reference", "closed-form"].map(|name| Rule::named(name).ok());
    let mut rules: Vec<Rule> = first.into_iter().chain(rest.into_iter().flatten()).collect();
    rules.retain(|rule| rule.applies_to(integrand));
    rules.dedup_by_key(|rule| rule.name);
    rules
}

/// Certifies every texel of a table.
pub fn certify(task: &Task, device: Option<DeviceTable>, progress: Progress) -> Result<Certified> {
    let rules = stages(task);
    let texels = task.grid.len();
    let mut run = Run {
        task,
        device,
        channels: task.lut.channels().len(),
        margin: rules.len().checked_sub(2).map(|i| rules[i]),
        values: Vec::new(),
        open: vec![true; texels],
        seen: Seen::default(),
        stages: Vec::new(),
        smallest_distance: None,
    };
    run.values = vec![0.0; texels * run.channels];
    run.decide_by_device(&rules[0])?;
    for (i, rule) in rules.iter().enumerate() {
        run.stage(i, rule, rules.len() - 1 - i, progress)?;
        if !run.open.contains(&true) || run.is_left_at_f32() {
            break;
        }
    }
    Ok(run.finish(&rules))
}

/// What has come out so far.
struct Run<'a> {
    task: &'a Task<'a>,
    device: Option<DeviceTable<'a>>,
    channels: usize,
    /// The last rule before the reference. Earlier stages keep twice its error as a margin: so whatever they decide it would have
    /// decided too, and which texels are left to the reference does not depend on them.
    margin: Option<Rule>,
    values: Vec<f64>,
    /// Which texels are not decided.
    open: Vec<bool>,
    seen: Seen,
    stages: Vec<Stage>,
    smallest_distance: Option<f64>,
}

/// What the previous stage of the CPU gave.
#[derive(Default)]
struct Seen {
    rule: Option<Rule>,
    /// In ascending order.
    texels: Vec<usize>,
    integrals: Vec<ScaleBias>,
}

/// The averages of a grid's rows by a rule, and what they may be off; zeros where none are needed.
struct Averages(Vec<(ScaleBias, ScaleBias)>);

impl Run<'_> {
    fn integrand(&self) -> Integrand {
        self.task.lut.integrand()
    }

    /// The device's stage; `averaging` is the CPU's rule for averages.
    fn decide_by_device(&mut self, averaging: &Rule) -> Result<()> {
        let Some(DeviceTable { points, rule, name }) = self.device else { return Ok(()) };
        check_range(self.integrand(), self.task.grid, rule, points)?;
        let mut decided = 0;
        // Steps of f32 are finer than a device is exact.
        if self.task.precision != Precision::F32 {
            let texels: Vec<usize> = (0..self.open.len()).collect();
            let averages = self.averages(averaging, &texels);
            let outcomes = self.outcomes(&texels, points, &averages, true, &|alpha, value| {
                rule.device_errors_at(self.integrand(), alpha, value)
            });
            decided = self.settle(&texels, outcomes);
        }
        self.stages.push(self.summary(format!("{name}, {}", rule.name), rule, true, self.open.len(), decided));
        Ok(())
    }

    /// A stage of the CPU, with `finer` stages after it.
    fn stage(&mut self, index: usize, rule: &Rule, finer: usize, progress: Progress) -> Result<()> {
        let grid = self.task.grid;
        let integrand = self.integrand();
        // A surrogate is cheap enough to check a device at every texel.
        let whole = index == 0 && (self.device.is_none() || matches!(rule.method, Method::Surrogate(_)));
        let texels = if whole { (0..grid.len()).collect() } else { self.asked(index) };
        let integrals = match whole {
            true => cpu::bake(integrand, grid, rule, progress),
            false => cpu::bake_at(integrand, grid, rule, &texels),
        };
        self.compare(&texels, &integrals, rule)?;
        let averages = self.averages(rule, &texels);
        let outcomes = self.outcomes(&texels, &integrals, &averages, finer > 1, &|alpha, value| {
            rule.errors_at(integrand, alpha, value)
        });
        if rule.name == REFERENCE.name {
            let distances = outcomes.iter().filter_map(|outcome| outcome.decided.then_some(outcome.distance));
            self.smallest_distance = distances.min_by(f64::total_cmp);
        }
        let asked = texels.iter().filter(|&&texel| self.open[texel]).count();
        let decided = self.settle(&texels, outcomes);
        self.stages.push(self.summary(format!("CPU f64, {}", rule.name), rule, false, asked, decided));
        self.seen = Seen { rule: Some(*rule), texels, integrals };
        Ok(())
    }

    /// The texels that are not decided, and a few that are.
    fn asked(&self, index: usize) -> Vec<usize> {
        let mut asked: Vec<usize> = (0..self.open.len()).filter(|&texel| self.open[texel]).collect();
        if index == 0 {
            asked.extend(sample(self.task.grid));
        } else if index == 1 {
            let seen = &self.seen.texels;
            asked.extend((0..AUDITED).map(|i| seen[scatter(i) % seen.len()]));
        }
        asked.sort_unstable();
        asked.dedup();
        asked
    }

    /// Holds values of a finer stage against the one before it, and against the device.
    fn compare(&self, texels: &[usize], integrals: &[ScaleBias], rule: &Rule) -> Result<()> {
        let integrand = self.integrand();
        let compare = |(&texel, &value): (&usize, &ScaleBias)| {
            let (mu, alpha) = self.task.grid.point(texel);
            let errors = rule.errors_at(integrand, alpha, value);
            if let Some(DeviceTable { points, rule, name }) = self.device {
                let (theirs, allowed) = (points[texel], rule.device_errors_at(integrand, alpha, value));
                check_apart(theirs, value, allowed, errors).map_err(|apart| {
                    Error::CheckFailed(format!(
                        "at n.v = {mu}, alpha = {alpha} {name} {apart}; the table is thrown away; use another device, \
                         or --backend cpu"
                    ))
                })?;
            }
            if let (Some(coarse), Ok(i)) = (self.seen.rule, self.seen.texels.binary_search(&texel)) {
                let theirs = self.seen.integrals[i];
                check_apart(theirs, value, coarse.errors_at(integrand, alpha, theirs), errors).map_err(|apart| {
                    let rules = format!("rule {} beside {}", coarse.name, rule.name);
                    Error::CheckFailed(format!("at n.v = {mu}, alpha = {alpha} {rules} {apart}; please report this"))
                })?;
            }
            Ok(())
        };
        texels.par_iter().zip(integrals).try_for_each(compare)
    }

    fn averages(&self, rule: &Rule, texels: &[usize]) -> Averages {
        let grid = self.task.grid;
        let mut averages = vec![(ScaleBias::default(), ScaleBias::default()); grid.alphas.len()];
        if self.task.lut.needs_averages() {
            let mut rows: Vec<usize> = texels.iter().map(|texel| texel / grid.mus.len()).collect();
            rows.dedup();
            let nodes = average_nodes();
            let directions =
                Grid::of(nodes.iter().map(|node| node.0).collect(), rows.iter().map(|&row| grid.alphas[row]).collect());
            let integrals = cpu::bake(self.integrand(), &directions, rule, &|_| ());
            for (integrals, &row) in integrals.chunks(nodes.len()).zip(&rows) {
                let average = average(&nodes, integrals);
                let mut errors = rule.errors_at(self.integrand(), grid.alphas[row], average);
                let quadrature = average_error(self.integrand());
                errors.add(1.0, ScaleBias { a: quadrature, b: quadrature });
                averages[row] = (average, errors);
            }
        }
        Averages(averages)
    }

    /// Whether these integrals leave no doubt about the stored values of their texels.
    fn outcomes(
        &self,
        texels: &[usize],
        integrals: &[ScaleBias],
        averages: &Averages,
        with_margin: bool,
        errors_at: &(dyn Fn(f64, ScaleBias) -> ScaleBias + Sync),
    ) -> Vec<Outcome> {
        let Task { lut, grid, precision, .. } = *self.task;
        let margin = self.margin.filter(|_| with_margin);
        let outcome = |(&texel, &value): (&usize, &ScaleBias)| {
            let (mu, alpha) = grid.point(texel);
            let mut errors = errors_at(alpha, value);
            if let Some(margin) = margin {
                errors.add(2.0, margin.errors_at(self.integrand(), alpha, value));
            }
            let (average, average_errors) = averages.0[texel / grid.mus.len()];
            // A channel is monotonic along this line from one end to the other.
            let at = |t: f64| {
                let integral = ScaleBias { a: value.a + t * errors.a, b: value.b + t * errors.b };
                let average = ScaleBias { a: average.a - t * average_errors.a, b: average.b - t * average_errors.b };
                lut.values(mu, integral, average)
            };
            let (low, middle, high) = (at(-1.0), at(0.0), at(1.0));
            // Adding 0 makes 0 of -0: no albedo is negative, though an estimate of a tiny one may be.
            let values = middle.map(|value| precision.nearest(value) + 0.0);
            let mut outcome = Outcome { values, decided: true, distance: f64::INFINITY };
            for channel in 0..self.channels {
                // The channels' own arithmetic may err by a few units in the last place.
                let slack = ROUNDING * middle[channel].abs();
                let (one, other) = (low[channel].min(high[channel]) - slack, low[channel].max(high[channel]) + slack);
                outcome.decided &= precision.nearest(one) == precision.nearest(other);
                if !with_margin {
                    outcome.distance = outcome.distance.min(precision.distance_to_boundary(middle[channel]));
                }
            }
            outcome
        };
        texels.par_iter().zip(integrals).with_min_len(256).map(outcome).collect()
    }

    /// Takes over what was decided, and the best guess of what was not; tells how many were.
    fn settle(&mut self, texels: &[usize], outcomes: Vec<Outcome>) -> usize {
        let mut decided = 0;
        for (&texel, outcome) in texels.iter().zip(outcomes) {
            if self.open[texel] {
                self.values[texel * self.channels..][..self.channels].copy_from_slice(&outcome.values[..self.channels]);
                self.open[texel] = !outcome.decided;
                decided += usize::from(outcome.decided);
            }
        }
        decided
    }

    fn summary(&self, by: String, rule: &Rule, device: bool, texels: usize, decided: usize) -> Stage {
        // At B = 1 and B = 0, and above the roughness below which Charlie's bounds are others.
        let errors = |b: f64| match device {
            true => rule.device_errors_at(self.integrand(), 1.0, ScaleBias { a: 0.0, b }),
            false => rule.errors_at(self.integrand(), 1.0, ScaleBias { a: 0.0, b }),
        };
        let (one, zero) = (errors(1.0), errors(0.0));
        Stage { by, error_of_a: one.a, error_of_b_relative: one.b - zero.b, error_of_b: zero.b, texels, decided }
    }

    /// Whether so many values of an f32 table are left that they stay within their bound instead.
    fn is_left_at_f32(&self) -> bool {
        let left = self.open.iter().filter(|&&open| open).count();
        self.task.precision == Precision::F32 && left * self.channels > LARGEST_F32
    }

    fn finish(self, rules: &[Rule]) -> Certified {
        let (texels, undecided) = (self.open.len(), self.open.iter().filter(|&&open| open).count());
        let last = self.seen.rule.unwrap_or(REFERENCE);
        let by_reference =
            self.stages.iter().filter(|stage| stage.by.ends_with(REFERENCE.name)).map(|s| s.decided).sum();
        let half_step = self.task.precision.half_step();
        let reference_error = rules.last().map_or(0.0, |rule| rule.bound(self.integrand()));
        let left_at_f32 = self.is_left_at_f32();
        let error = if left_at_f32 { last.bound(self.integrand()) } else { reference_error };
        let promise = if undecided == 0 {
            "every value is the true integral, rounded once to the nearest, ties to even".into()
        } else if left_at_f32 {
            format!(
                "before it was rounded, every value was within {error:e} of the true integral (of albedos above 1 relative)"
            )
        } else {
            format!(
                "every value is the true integral, rounded once to the nearest, ties to even; but {undecided} texels, with a value \
                 as near to a boundary of rounding as {error:e} (of albedos above 1 relative), may be the other nearest"
            )
        };
        let certificate = Certificate {
            promise,
            bound: half_step + if undecided == 0 { 0.0 } else { error },
            texels,
            decided_before_reference: texels - undecided - by_reference,
            decided_by_reference: by_reference,
            undecided,
            reference_error,
            smallest_distance: self.smallest_distance,
            blake3: String::new(),
        };
        Certified { values: self.values, certificate, stages: self.stages }
    }
}

/// What a stage says of a texel.
struct Outcome {
    values: [f64; 3],
    decided: bool,
    /// From the nearest boundary of rounding, the nearest of the channels'.
    distance: f64,
}

/// Refuses two values that are farther apart than both may err.
fn check_apart(
    theirs: ScaleBias,
    ours: ScaleBias,
    allowed: ScaleBias,
    errors: ScaleBias,
) -> std::result::Result<(), String> {
    // Written so that NaN fails.
    let close = |x: f64, y: f64, allowed: f64| (x - y).abs() <= allowed;
    if close(theirs.a, ours.a, allowed.a + errors.a) && close(theirs.b, ours.b, allowed.b + errors.b) {
        return Ok(());
    }
    Err(format!(
        "gives A = {:e} and B = {:e} where they are {:e} and {:e}: farther apart than {:e} and {:e}",
        theirs.a,
        theirs.b,
        ours.a,
        ours.b,
        allowed.a + errors.a,
        allowed.b + errors.b
    ))
}

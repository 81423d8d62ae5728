//! Ziv's strategy: a cheap stage with a bound of its error decides every value that lies farther from a boundary of
//! rounding than that; what is left goes to a finer stage, and at last to the reference. Whatever stages a value has
//! passed, it is the same: the true integral, rounded once (Ziv, "Fast evaluation of elementary mathematical
//! functions with correctly rounded last bit", 1991).
//!
//! The stages check each other. A value that differs from that of a finer stage by more than both may err is a fault,
//! of the device or of a bound: the table is thrown away, not mended.

use super::decider::{Decider, MARGIN, Verdict};
use super::decision::{Task, check_apart};
use super::deviation::{check_range, sample, scatter};
use super::stages::{ErrorsAt, Stages, summary};
use super::tally::Tally;
use crate::backend::Progress;
use crate::backend::cpu::Baker;
use crate::ball::Ball;
use crate::certificate::{Certificate, Stage};
use crate::error::{Error, Result};
use crate::integrate::average::{average_error, average_nodes, averages as row_averages};
use crate::integrate::rule::Rule;
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::Grid;
use rayon::prelude::*;

/// Texels that pass through the second stage though the first has decided them, so that one checks the other.
const AUDITED: usize = 64;

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

/// Certifies every texel of a table.
pub fn certify(task: &Task, device: Option<DeviceTable>, progress: Progress) -> Result<Certified> {
    certify_by(task, &Stages::of(task), device, progress)
}

/// The same through these stages.
pub fn certify_by(task: &Task, stages: &Stages, device: Option<DeviceTable>, progress: Progress) -> Result<Certified> {
    let (values, tally) = certify_band(task, stages, device, progress)?;
    let certificate = tally.certificate(task.lut, task.precision, stages)?;
    Ok(Certified { values, certificate, stages: tally.stages })
}

/// Certifies the texels of a band of a table through the stages of the whole: the stored values, and what was found.
pub fn certify_band(
    task: &Task,
    stages: &Stages,
    device: Option<DeviceTable>,
    progress: Progress,
) -> Result<(Vec<f64>, Tally)> {
    let texels = task.grid.len();
    let mut run = Run {
        task,
        stages,
        device,
        channels: task.lut.channels().len(),
        values: vec![0.0; texels * task.lut.channels().len()],
        open: vec![true; texels],
        seen: None,
        tally: Tally { texels, ..Tally::default() },
    };
    run.decide_by_device()?;
    for stage in 0..stages.bakers.len() {
        run.stage(stage, progress)?;
        if !run.open.contains(&true) || !stages.rounds_correctly {
            break;
        }
    }
    run.tally.undecided = run.open.iter().filter(|&&open| open).count();
    Ok((run.values, run.tally))
}

/// What has come out so far.
struct Run<'a> {
    task: &'a Task<'a>,
    stages: &'a Stages,
    device: Option<DeviceTable<'a>>,
    channels: usize,
    values: Vec<f64>,
    /// Which texels are not decided.
    open: Vec<bool>,
    seen: Option<Seen>,
    tally: Tally,
}

/// What the previous stage of the CPU gave.
struct Seen {
    rule: Rule,
    texels: Texels,
    integrals: Vec<ScaleBias>,
}

/// Texels in ascending order.
enum Texels {
    /// So many, from the first one on.
    All(usize),
    /// These.
    Some(Vec<usize>),
}

impl Texels {
    fn len(&self) -> usize {
        match self {
            Texels::All(count) => *count,
            Texels::Some(texels) => texels.len(),
        }
    }

    fn get(&self, place: usize) -> usize {
        match self {
            Texels::All(_) => place,
            Texels::Some(texels) => texels[place],
        }
    }

    fn place_of(&self, texel: usize) -> Option<usize> {
        match self {
            Texels::All(count) => (texel < *count).then_some(texel),
            Texels::Some(texels) => texels.binary_search(&texel).ok(),
        }
    }
}

impl Run<'_> {
    fn integrand(&self) -> Integrand {
        self.task.lut.integrand()
    }

    /// The device's stage.
    fn decide_by_device(&mut self) -> Result<()> {
        let Some(DeviceTable { points, rule, name }) = self.device else { return Ok(()) };
        let integrand = self.integrand();
        check_range(integrand, self.task.grid, rule, points)?;
        let texels = Texels::All(self.open.len());
        let errors_at = |alpha, value| rule.device_errors_at(integrand, alpha, value);
        let averages = self.averages(&self.stages.bakers[0], &texels, self.stages.margin());
        let decider = Decider {
            task: self.task,
            averages: &averages,
            errors_at: &errors_at,
            margin: self.stages.margin(),
            exact_mirrors: false,
            rounds_correctly: self.stages.rounds_correctly,
        };
        let decided = self.decide(&texels, points, &decider);
        self.report(format!("{name}, {}", rule.name), &errors_at, self.open.len(), decided);
        Ok(())
    }

    /// A stage of the CPU.
    fn stage(&mut self, index: usize, progress: Progress) -> Result<()> {
        let (grid, integrand, baker) = (self.task.grid, self.integrand(), &self.stages.bakers[index]);
        let whole = index == 0 && (self.device.is_none() || self.stages.interpolates(index));
        let texels = if whole { Texels::All(grid.len()) } else { Texels::Some(self.asked(index)) };
        let integrals = match &texels {
            Texels::All(_) => baker.bake(grid, progress),
            Texels::Some(texels) => baker.bake_at(grid, texels),
        };
        self.compare(&texels, &integrals, &baker.rule)?;
        let finer = self.stages.bakers.len() - 1 - index;
        let margin = self.stages.margin().filter(|_| finer > 1);
        let averages = self.averages(baker, &texels, margin);
        let errors_at = |alpha, value| baker.rule.errors_at(integrand, alpha, value);
        let decider = Decider {
            task: self.task,
            averages: &averages,
            errors_at: &errors_at,
            margin,
            exact_mirrors: true,
            rounds_correctly: self.stages.rounds_correctly,
        };
        let asked = self.open.iter().filter(|&&open| open).count();
        let open = if self.stages.is_reference(index) { self.open.clone() } else { Vec::new() };
        let decided = self.decide(&texels, &integrals, &decider);
        if self.stages.is_reference(index) {
            self.tally.by_reference = decided;
            self.tally.smallest_distance = self.smallest_distance(&texels, &integrals, &averages, &open);
        }
        self.report(format!("CPU f64, {}", baker.rule.name), &errors_at, asked, decided);
        self.seen = Some(Seen { rule: baker.rule, texels, integrals });
        Ok(())
    }

    /// The smallest distance from a boundary of rounding among the texels that were `open` and are so no more.
    fn smallest_distance(
        &self,
        texels: &Texels,
        integrals: &[ScaleBias],
        averages: &[ScaleBias<Ball>],
        open: &[bool],
    ) -> Option<f64> {
        let grid = self.task.grid;
        let decided = (0..texels.len()).filter(|&place| open[texels.get(place)] && !self.open[texels.get(place)]);
        let distance = |place: usize| {
            let texel = texels.get(place);
            let average = averages[texel / grid.mus.len()];
            self.task.distance_to_boundary(grid.point(texel).0, integrals[place], average)
        };
        decided.map(distance).min_by(f64::total_cmp)
    }

    /// Takes note of what a stage did.
    fn report(&mut self, by: String, errors_at: &ErrorsAt, texels: usize, decided: usize) {
        let decided = self.stages.rounds_correctly.then_some(decided);
        self.tally.stages.push(summary(by, errors_at, texels, decided));
    }

    /// The texels that are not decided, and a few that are.
    fn asked(&self, index: usize) -> Vec<usize> {
        let mut asked: Vec<usize> = (0..self.open.len()).filter(|&texel| self.open[texel]).collect();
        match &self.seen {
            None => asked.extend(sample(self.task.grid)),
            Some(seen) if index == 1 => {
                asked.extend((0..AUDITED).map(|i| seen.texels.get(scatter(i) % seen.texels.len())));
            }
            Some(_) => (),
        }
        asked.sort_unstable();
        asked.dedup();
        asked
    }

    /// Holds values of a finer stage against the one before it, and against the device.
    fn compare(&self, texels: &Texels, integrals: &[ScaleBias], rule: &Rule) -> Result<()> {
        if self.device.is_none() && self.seen.is_none() {
            return Ok(());
        }
        let integrand = self.integrand();
        let compare = |(place, &value): (usize, &ScaleBias)| {
            let texel = texels.get(place);
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
            let coarse =
                self.seen.as_ref().and_then(|seen| Some((&seen.rule, seen.integrals[seen.texels.place_of(texel)?])));
            if let Some((coarse, theirs)) = coarse {
                check_apart(theirs, value, coarse.errors_at(integrand, alpha, theirs), errors).map_err(|apart| {
                    let rules = format!("rule {} beside {}", coarse.name, rule.name);
                    Error::CheckFailed(format!("at n.v = {mu}, alpha = {alpha} {rules} {apart}; please report this"))
                })?;
            }
            Ok(())
        };
        integrals.par_iter().enumerate().try_for_each(compare)
    }

    /// The averages of the rows of these texels by a rule, with what they may be off; zeros where none are needed.
    fn averages(&self, baker: &Baker, texels: &Texels, margin: Option<Rule>) -> Vec<ScaleBias<Ball>> {
        let (grid, integrand) = (self.task.grid, self.integrand());
        let mut averages = vec![ScaleBias::default(); grid.alphas.len()];
        if self.task.lut.needs_averages() {
            let mut rows: Vec<usize> = (0..texels.len()).map(|place| texels.get(place) / grid.mus.len()).collect();
            rows.dedup();
            let nodes = average_nodes();
            let alphas = rows.iter().map(|&row| grid.alphas[row]).collect();
            let directions = Grid::of(nodes.iter().map(|node| node.0).collect(), alphas);
            let integrals = baker.bake(&directions, &|_| ());
            for (average, row) in row_averages(&nodes, &integrals).into_iter().zip(rows) {
                let mut errors = baker.rule.errors_at(integrand, grid.alphas[row], average);
                let quadrature = average_error(integrand);
                errors.add(1.0, ScaleBias { a: quadrature, b: quadrature });
                if let Some(margin) = &margin {
                    errors.add(MARGIN, margin.errors_at(integrand, grid.alphas[row], average));
                }
                averages[row] = average.within(errors);
            }
        }
        averages
    }

    /// Takes over what these integrals decide, and the best guess where they do not; tells how many texels they do.
    fn decide(
        &mut self,
        texels: &Texels,
        integrals: &[ScaleBias],
        decider: &Decider<impl Fn(f64, ScaleBias) -> ScaleBias + Sync>,
    ) -> usize {
        let (channels, width) = (self.channels, self.task.grid.mus.len());
        let verdict = match texels {
            Texels::All(_) => {
                let values = self.values.par_chunks_mut(channels * width);
                let rows = values.zip(self.open.par_chunks_mut(width)).zip(integrals.par_chunks(width)).enumerate();
                let verdicts = rows.map(|(row, ((values, open), integrals))| decider.row(row, integrals, values, open));
                verdicts.reduce(Verdict::default, Verdict::with)
            }
            Texels::Some(texels) => {
                let mut verdict = Verdict::default();
                for (&texel, &value) in texels.iter().zip(integrals) {
                    let (open, values) = (&mut self.open[texel], &mut self.values[texel * channels..][..channels]);
                    if *open {
                        verdict = verdict.with(decider.texel((texel / width, texel % width), value, values, open));
                    }
                }
                verdict
            }
        };
        // Whatever is open now was seen by this stage, so that only the last one's errors count.
        self.tally.error = verdict.error;
        verdict.decided
    }
}

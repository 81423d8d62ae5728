//! Ziv's strategy: a cheap stage with a bound of its error decides every value that lies farther
//! from a boundary of rounding than that; the others go to a finer stage, and at last to the
//! reference. Whatever stages a value has passed, it is the same: the true integral, rounded once
//! (Ziv, "Fast evaluation of elementary mathematical functions with correctly rounded last bit",
//! 1991).
//!
//! The stages check each other. If two differ by more than the sum of their error bounds, a device
//! or a bound is at fault: the table is thrown away, not mended.

use super::decider::{BOTH_SIDES, Decider, Verdict, finest};
use super::decision::{Averages, Seen, Task, check_apart};
use super::deviation::{check_range, sample, scatter};
use super::stages::Stages;
use super::tally::Tally;
use crate::backend::Progress;
use crate::backend::cpu::Baker;
use crate::error::{Error, Result};
use crate::integrate::average::AVERAGE_ERROR;
use crate::integrate::errors::Errors;
use crate::integrate::rule::Rule;
use crate::integrate::{Field, Integrand};
use crate::numeric::ball::Ball;
use rayon::prelude::*;

/// One texel in so many passes through the second stage though the first has decided it, so that
/// one checks the other.
const AUDITED_OF: usize = 512;

/// The most texels of a table that do, which cost a few milliseconds.
const MOST_AUDITED: usize = 64;

/// A table that a device has computed.
#[derive(Clone, Copy, Debug)]
pub struct DeviceTable<'a> {
    /// In the order of the grid.
    pub integrals: &'a Field,
    /// The rule by which it was computed.
    pub rule: &'a Rule,
    /// The device's name.
    pub name: &'a str,
}

/// The stored values of a table, as many for each point as there are channels, in the order of the
/// grid; and the findings of the stages.
pub type Certified = (Vec<f64>, Tally);

/// Certifies every texel of a table.
pub fn certify(task: &Task, device: Option<DeviceTable>, progress: Progress) -> Result<Certified> {
    certify_band(task, &Stages::of(task), device, progress)
}

/// Certifies the texels of a band of a table through the stages of the whole. Where the texels of a
/// row are alike, one stands for all of them, unless a device has computed them.
pub fn certify_band(
    task: &Task,
    stages: &Stages,
    device: Option<DeviceTable>,
    progress: Progress,
) -> Result<Certified> {
    if device.is_some() || task.lut.depends_on_nov() {
        return certify_all(task, stages, device, progress);
    }
    let width = task.grid.mus.len();
    let column = task.grid.at_directions(task.grid.mus[..1].to_vec());
    let progress = |rows: usize| progress(rows * width);
    let (values, tally) = certify_all(&Task { grid: &column, ..*task }, stages, None, &progress)?;
    let rows = values.chunks(task.lut.count());
    Ok((rows.flat_map(|row| row.repeat(width)).collect(), tally.times(width)))
}

fn certify_all(
    task: &Task,
    stages: &Stages,
    device: Option<DeviceTable>,
    progress: Progress,
) -> Result<Certified> {
    let texels = task.grid.len();
    let channels = task.lut.count();
    let mut run = Run {
        task,
        stages,
        device,
        channels,
        values: vec![0.0; texels * channels],
        open: vec![true; texels],
        seen: Vec::new(),
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

/// The state of a certification.
struct Run<'a> {
    task: &'a Task<'a>,
    stages: &'a Stages,
    device: Option<DeviceTable<'a>>,
    channels: usize,
    values: Vec<f64>,
    /// Whether each texel is not decided.
    open: Vec<bool>,
    /// The stages of the CPU so far.
    seen: Vec<(Rule, Seen)>,
    tally: Tally,
}

impl Run<'_> {
    fn integrand(&self) -> Integrand {
        self.task.lut.integrand()
    }

    /// The device's stage.
    fn decide_by_device(&mut self) -> Result<()> {
        let Some(DeviceTable { integrals, rule, name }) = self.device else { return Ok(()) };
        let integrand = self.integrand();
        check_range(integrand, self.task.grid, rule, integrals)?;
        let margins = self.stages.margins(None);
        let rows: Vec<usize> = (0..self.task.grid.alphas.len()).collect();
        let averages = self.averages(&self.stages.bakers[0], &rows, &margins)?;
        let decider = Decider {
            task: self.task,
            averages: &averages,
            errors: rule.device_errors(integrand),
            least_mu: self.stages.least_mu,
            margins: &margins,
            exact_mirrors: false,
            rounds_correctly: self.stages.rounds_correctly,
        };
        let asked = self.open.len();
        let verdict =
            decide_all(&decider, integrals, self.channels, &mut self.values, &mut self.open);
        self.note(format!("{name}, {}", rule.name), None, asked, (&decider.errors, verdict));
        Ok(())
    }

    /// A stage of the CPU.
    fn stage(&mut self, index: usize, progress: Progress) -> Result<()> {
        let (integrand, baker) = (self.integrand(), &self.stages.bakers[index]);
        let seen = self.integrate(index, progress);
        self.compare(&seen, &baker.rule)?;
        let margins = self.stages.margins(Some(index));
        let averages = self.averages(baker, &self.open_rows(), &margins)?;
        let decider = Decider {
            task: self.task,
            averages: &averages,
            errors: baker.rule.errors(integrand),
            least_mu: self.stages.least_mu,
            margins: &margins,
            exact_mirrors: true,
            rounds_correctly: self.stages.rounds_correctly,
        };
        let asked = (0..seen.len()).filter(|&place| self.open[seen.texel(place)]).count();
        let before = if self.stages.is_reference(index) { self.open.clone() } else { Vec::new() };
        let verdict = match &seen.texels {
            None => decide_all(
                &decider,
                &seen.integrals,
                self.channels,
                &mut self.values,
                &mut self.open,
            ),
            Some(_) => self.decide_some(&decider, &seen),
        };
        if self.stages.is_reference(index) {
            self.tally.by_reference = verdict.decided;
            self.tally.smallest_distance = self.smallest_distance(&seen, &averages, &before);
        }
        let by = format!("CPU f64, {}", baker.rule.name);
        self.note(by, Some(index), asked, (&decider.errors, verdict));
        self.seen.push((baker.rule, seen));
        Ok(())
    }

    /// The integrals that a stage is asked for: all of the first one, unless a device has been
    /// before it.
    fn integrate(&self, index: usize, progress: Progress) -> Seen {
        let (grid, baker) = (self.task.grid, &self.stages.bakers[index]);
        if index == 0 && (self.device.is_none() || self.stages.interpolates(index)) {
            return Seen { texels: None, integrals: baker.bake(grid, progress) };
        }
        let texels = self.asked(index);
        let integrals = baker.bake_at(grid, &texels);
        Seen { texels: Some(texels), integrals }
    }

    /// The texels that are not decided, where the stage is of use, and a few that are.
    fn asked(&self, index: usize) -> Vec<usize> {
        let alpha = |texel: usize| self.task.grid.point(texel).1;
        let is_of_use = |texel: usize| self.stages.is_of_use(index, alpha(texel));
        let mut asked: Vec<usize> =
            (0..self.open.len()).filter(|&texel| self.open[texel] && is_of_use(texel)).collect();
        // What checks a device, or the first stage, passes through the first stage from this one on
        // that is of use for it.
        let is_first = |from: usize, texel: usize| {
            let is_of_use = |stage: usize| self.stages.is_of_use(stage, alpha(texel));
            is_of_use(index) && !(from..index).any(is_of_use)
        };
        if self.device.is_some() {
            asked.extend(sample(self.task.grid).filter(|&texel| is_first(0, texel)));
        }
        if let Some((_, seen)) = self.seen.first() {
            let few = seen.len().div_ceil(AUDITED_OF).min(MOST_AUDITED);
            let audited = (0..few).map(|i| seen.texel(scatter(i) % seen.len()));
            asked.extend(audited.filter(|&texel| is_first(1, texel)));
        }
        asked.sort_unstable();
        asked.dedup();
        asked
    }

    /// The smallest distance from a boundary of rounding among the texels that were open `before`
    /// and are so no more.
    fn smallest_distance(&self, seen: &Seen, averages: &Averages, before: &[bool]) -> Option<f64> {
        let grid = self.task.grid;
        let mut smallest: Option<f64> = None;
        for (place, integrals) in seen.integrals.iter().enumerate() {
            let texel = seen.texel(place);
            if before[texel] && !self.open[texel] {
                let averages = averages.row(texel / grid.mus.len());
                let distance =
                    self.task.distance_to_boundary(grid.point(texel).0, integrals, averages);
                smallest = Some(smallest.map_or(distance, |smallest| smallest.min(distance)));
            }
        }
        smallest
    }

    /// Notes the work of a stage, none of a device, on so many texels. The last one sees whatever
    /// is open, so that only its errors count.
    fn note(&mut self, by: String, stage: Option<usize>, texels: usize, of: (&Errors, Verdict)) {
        let (errors, verdict) = of;
        let decided = self.stages.rounds_correctly.then_some(verdict.decided);
        let summary = self.stages.summary(by, stage, errors, self.task.grid, (texels, decided));
        self.tally.error = verdict.error;
        self.tally.stages.push(summary);
    }

    /// Compares the integrals of a stage with the device's, and with those of the one before it.
    fn compare(&self, seen: &Seen, rule: &Rule) -> Result<()> {
        let integrand = self.integrand();
        let ours = rule.errors(integrand);
        let device = self.device.map(|device| (device, device.rule.device_errors(integrand)));
        let earlier: Vec<_> = self
            .seen
            .iter()
            .rev()
            .map(|(rule, seen)| (rule, seen, rule.errors(integrand)))
            .collect();
        if device.is_none() && earlier.is_empty() {
            return Ok(());
        }
        let compare = |place: usize| {
            let (texel, integrals) = (seen.texel(place), seen.integrals.at(place));
            let (mu, alpha) = self.task.grid.point(texel);
            let our_errors = ours.at((mu, alpha), integrals);
            let failed = |who: &str, apart: String, cure: &str| {
                Error::CheckFailed(format!("at n.v = {mu}, alpha = {alpha} {who} {apart}; {cure}"))
            };
            if let Some((device, errors)) = &device {
                let cure = "the table is thrown away; use another device, or --backend cpu";
                let theirs = device.integrals.at(texel);
                check_apart(theirs, integrals, &errors.at((mu, alpha), integrals), &our_errors)
                    .map_err(|apart| failed(device.name, apart, cure))?;
            }
            // The last stage that has seen it.
            let last = earlier
                .iter()
                .find_map(|(rule, seen, errors)| Some((rule, seen.of(texel)?, errors)));
            if let Some((last, theirs, errors)) = last {
                let rules = format!("rule {} beside {}", last.name, rule.name);
                check_apart(theirs, integrals, &errors.at((mu, alpha), theirs), &our_errors)
                    .map_err(|apart| failed(&rules, apart, "please report this"))?;
            }
            Ok(())
        };
        (0..seen.len()).into_par_iter().try_for_each(compare)
    }

    /// The rows that have texels to decide.
    fn open_rows(&self) -> Vec<usize> {
        let rows = self.open.chunks(self.task.grid.mus.len()).enumerate();
        rows.filter(|(_, open)| open.contains(&true)).map(|(row, _)| row).collect()
    }

    /// The averages of rows by a rule with the bounds of their errors; none where none are needed.
    fn averages(&self, baker: &Baker, rows: &[usize], margins: &[Rule]) -> Result<Averages> {
        let grid = self.task.grid;
        let averaged = self.task.lut.averaged();
        let count = averaged.iter().map(|integrand| integrand.count()).sum();
        let mut averages = Averages::zeros(count, grid.alphas.len());
        let alphas: Vec<f64> = rows.iter().map(|&row| grid.alphas[row]).collect();
        let mut first = 0;
        for integrand in averaged {
            let own = integrand == self.integrand();
            let baker = if own { baker } else { &Baker::new(integrand, &baker.rule) };
            let errors = baker.rule.errors(integrand);
            for ((values, &row), &alpha) in baker.averages(&alphas).iter().zip(rows).zip(&alphas) {
                let of_rule = errors.of_averages(alpha, values);
                let of_margin = finest(margins, integrand, &errors, alpha)
                    .map_or(Default::default(), |margin| margin.of_averages(alpha, values));
                let ball = |(k, &value): (usize, &f64)| {
                    let error = of_rule[k] + AVERAGE_ERROR + BOTH_SIDES * of_margin[k];
                    Ball { value, error }
                };
                averages.set(row, first, values.iter().enumerate().map(ball));
            }
            first += integrand.count();
        }
        Ok(averages)
    }

    /// Decides the texels of a stage that has seen only some.
    fn decide_some(&mut self, decider: &Decider, seen: &Seen) -> Verdict {
        let (channels, width) = (self.channels, self.task.grid.mus.len());
        let mut verdict = Verdict::default();
        for (place, integrals) in seen.integrals.iter().enumerate() {
            let texel = seen.texel(place);
            let (open, values) =
                (&mut self.open[texel], &mut self.values[texel * channels..][..channels]);
            if *open {
                let place = (texel / width, texel % width);
                verdict = verdict.merge(decider.texel(place, integrals, values, open));
            }
        }
        verdict
    }
}

/// Decides all open texels from integrals at every texel.
fn decide_all(
    decider: &Decider,
    integrals: &Field,
    channels: usize,
    values: &mut [f64],
    open: &mut [bool],
) -> Verdict {
    let width = decider.task.grid.mus.len();
    let values = values.par_chunks_mut(channels * width);
    let integrals = integrals.values().par_chunks(integrals.count() * width);
    let rows = values.zip(open.par_chunks_mut(width)).zip(integrals).enumerate();
    let verdicts = rows.map(|(row, ((values, open), integrals))| {
        decider.texels_of_row(row, integrals, values, open)
    });
    verdicts.reduce(Verdict::default, Verdict::merge)
}

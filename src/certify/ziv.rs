//! Ziv's strategy: a cheap stage with a bound of its error decides every value that lies farther from a boundary of rounding
//! than that; what is left goes to a finer stage, and at last to the reference. Whatever stages a value has passed, it is the
//! same: the true integral, rounded once (Ziv, "Fast evaluation of elementary mathematical functions with correctly rounded last
//! bit", 1991).
//!
//! The stages check each other. A value that differs from that of a finer stage by more than both may err is a fault, of the
//! device or of a bound: the table is thrown away, not mended.

use super::decision::{Task, check_apart};
use super::deviation::{check_range, sample, scatter};
use crate::backend::{Progress, cpu};
use crate::certificate::{Certificate, Stage};
use crate::error::{Error, Result};
use crate::integrate::average::{average_error, average_nodes, averages as row_averages};
use crate::integrate::rule::{Method, REFERENCE, Rule};
use crate::integrate::{Integrand, ScaleBias};
use crate::lut::Grid;
use crate::precision::Precision;
use rayon::prelude::*;

/// Texels that pass through the second stage though the first has decided them, so that one checks the other.
const AUDITED: usize = 64;

/// So many values of a table, at the most, are rounded correctly to f32, whose steps are as fine as the fast stages' bounds.
const LARGEST_F32: usize = 4096;

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
    // At a roughness where Charlie's rules are as sharp as any lobe's.
    let error = |rule: &Rule| rule.errors_at(integrand, 1.0, ScaleBias { a: 1.0, b: 0.0 }).a;
    let rest = ["d10240", "reference", "closed-form"].into_iter().filter_map(|name| Rule::named(name).ok());
    let mut rules: Vec<Rule> = first.into_iter().collect();
    for rule in rest.filter(|rule| rule.applies_to(integrand)) {
        if rules.last().is_none_or(|last| error(&rule) < error(last)) {
            rules.push(rule);
        }
    }
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
        seen: None,
        stages: Vec::new(),
        decided_by_reference: 0,
        smallest_distance: None,
    };
    run.values = vec![0.0; texels * run.channels];
    run.decide_by_device(&rules[0])?;
    for (i, rule) in rules.iter().enumerate() {
        run.stage(i, rule, rules.len() - 1 - i, progress)?;
        if !run.open.contains(&true) || !run.rounds_correctly() {
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
    seen: Option<Seen>,
    stages: Vec<Stage>,
    decided_by_reference: usize,
    smallest_distance: Option<f64>,
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

/// What a stage's A and B may be off at (n·v, α) where it gives this value.
type ErrorsAt<'a> = dyn Fn(f64, f64, ScaleBias) -> ScaleBias + Sync + 'a;

fn summary(by: String, errors_at: &ErrorsAt, texels: usize, decided: usize) -> Stage {
    // At α = 1, above the roughness below which Charlie's bounds are others.
    let errors = |b: f64| errors_at(1.0, 1.0, ScaleBias { a: 0.0, b });
    let decades = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
    Stage { by, error_of_a: errors(1.0).a, error_of_b: decades.map(|b| errors(b).b), texels, decided }
}

impl Run<'_> {
    fn integrand(&self) -> Integrand {
        self.task.lut.integrand()
    }

    /// Whether values are rounded correctly: where steps are as fine as f32's, only if they are few or in closed form.
    fn rounds_correctly(&self) -> bool {
        let closed = matches!(self.integrand(), Integrand::Diffuse(_));
        self.task.precision != Precision::F32 || closed || self.values.len() <= LARGEST_F32
    }

    /// The device's stage; `averaging` is the CPU's rule for averages.
    fn decide_by_device(&mut self, averaging: &Rule) -> Result<()> {
        let Some(DeviceTable { points, rule, name }) = self.device else { return Ok(()) };
        let integrand = self.integrand();
        check_range(integrand, self.task.grid, rule, points)?;
        let texels = Texels::All(self.open.len());
        let errors_at = |_, alpha, value| rule.device_errors_at(integrand, alpha, value);
        // Steps of f32 are finer than a device is exact.
        let decided = if self.task.precision == Precision::F32 {
            0
        } else {
            let averages = self.averages(averaging, &texels);
            self.decide(&texels, points, &averages, self.margin, &errors_at)
        };
        self.stages.push(summary(format!("{name}, {}", rule.name), &errors_at, self.open.len(), decided));
        Ok(())
    }

    /// A stage of the CPU, with `finer` stages after it.
    fn stage(&mut self, index: usize, rule: &Rule, finer: usize, progress: Progress) -> Result<()> {
        let (grid, integrand) = (self.task.grid, self.integrand());
        // A surrogate is cheap enough to check a device at every texel.
        let whole = index == 0 && (self.device.is_none() || matches!(rule.method, Method::Surrogate(_)));
        let texels = if whole { Texels::All(grid.len()) } else { Texels::Some(self.asked(index)) };
        let integrals = match &texels {
            Texels::All(_) => cpu::bake(integrand, grid, rule, progress),
            Texels::Some(texels) => cpu::bake_at(integrand, grid, rule, texels),
        };
        self.compare(&texels, &integrals, rule)?;
        let averages = self.averages(rule, &texels);
        let errors_at = |mu, alpha, value| match integrand {
            Integrand::Specular(lobe) if alpha == 0.0 && ScaleBias::mirror_is_exact(mu, lobe.smooth_limit(mu)) => {
                ScaleBias::zero()
            }
            _ => rule.errors_at(integrand, alpha, value),
        };
        let margin = self.margin.filter(|_| finer > 1);
        let asked = self.open.iter().filter(|&&open| open).count();
        let open = if rule.name == REFERENCE.name { self.open.clone() } else { Vec::new() };
        let decided = self.decide(&texels, &integrals, &averages, margin, &errors_at);
        if rule.name == REFERENCE.name {
            self.decided_by_reference = decided;
            let distance = |(place, &integral): (usize, &ScaleBias)| {
                let texel = texels.get(place);
                let average = averages[texel / grid.mus.len()].0;
                let distance = self.task.distance_to_boundary(grid.point(texel).0, integral, average);
                (open[texel] && !self.open[texel]).then_some(distance)
            };
            self.smallest_distance = integrals.iter().enumerate().filter_map(distance).min_by(f64::total_cmp);
        }
        self.stages.push(summary(format!("CPU f64, {}", rule.name), &errors_at, asked, decided));
        self.seen = Some(Seen { rule: *rule, texels, integrals });
        Ok(())
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

    /// The averages of the rows of these texels by a rule, and what they may be off; zeros where none are needed.
    fn averages(&self, rule: &Rule, texels: &Texels) -> Vec<(ScaleBias, ScaleBias)> {
        let grid = self.task.grid;
        let mut averages = vec![(ScaleBias::default(), ScaleBias::default()); grid.alphas.len()];
        if self.task.lut.needs_averages() {
            let mut rows: Vec<usize> = (0..texels.len()).map(|place| texels.get(place) / grid.mus.len()).collect();
            rows.dedup();
            let nodes = average_nodes();
            let alphas = rows.iter().map(|&row| grid.alphas[row]).collect();
            let directions = Grid::of(nodes.iter().map(|node| node.0).collect(), alphas);
            let integrals = cpu::bake(self.integrand(), &directions, rule, &|_| ());
            for (average, row) in row_averages(&nodes, &integrals).into_iter().zip(rows) {
                let mut errors = rule.errors_at(self.integrand(), grid.alphas[row], average);
                let quadrature = average_error(self.integrand());
                errors.add(1.0, ScaleBias { a: quadrature, b: quadrature });
                averages[row] = (average, errors);
            }
        }
        averages
    }

    /// Takes over what these integrals decide, and the best guess where they do not; tells how many texels they do.
    fn decide(
        &mut self,
        texels: &Texels,
        integrals: &[ScaleBias],
        averages: &[(ScaleBias, ScaleBias)],
        margin: Option<Rule>,
        errors_at: &ErrorsAt,
    ) -> usize {
        let (channels, task, rounds, integrand) = (self.channels, self.task, self.rounds_correctly(), self.integrand());
        let Grid { mus, alphas, .. } = task.grid;
        let decide = |(row, column): (usize, usize), value: ScaleBias, values: &mut [f64], open: &mut bool| {
            let (mu, alpha, average) = (mus[column], alphas[row], averages[row]);
            if !rounds {
                task.store(mu, value, average.0, values);
                return 0;
            }
            let mut errors = errors_at(mu, alpha, value);
            if let Some(margin) = &margin {
                errors.add(2.0, margin.errors_at(integrand, alpha, value));
            }
            *open = !task.decide(mu, (value, errors), average, values);
            usize::from(!*open)
        };
        let width = mus.len();
        match texels {
            Texels::All(_) => {
                let rows = self.values.par_chunks_mut(channels * width).zip(self.open.par_chunks_mut(width));
                let decided =
                    rows.zip(integrals.par_chunks(width)).enumerate().map(|(row, ((values, open), integrals))| {
                        let texels = values.chunks_exact_mut(channels).zip(open).zip(integrals).enumerate();
                        let open = texels.filter(|(_, ((_, open), _))| **open);
                        open.map(|(i, ((values, open), &value))| decide((row, i), value, values, open)).sum::<usize>()
                    });
                decided.sum()
            }
            Texels::Some(texels) => {
                let mut count = 0;
                for (&texel, &value) in texels.iter().zip(integrals) {
                    let open = &mut self.open[texel];
                    if *open {
                        let values = &mut self.values[texel * channels..][..channels];
                        count += decide((texel / width, texel % width), value, values, open);
                    }
                }
                count
            }
        }
    }

    fn finish(self, rules: &[Rule]) -> Certified {
        let (texels, undecided) = (self.open.len(), self.open.iter().filter(|&&open| open).count());
        let half_step = self.task.precision.half_step();
        let averages = if self.task.lut.needs_averages() { average_error(self.integrand()) } else { 0.0 };
        let reference_error = rules.last().map_or(0.0, |rule| rule.bound(self.integrand())).max(averages);
        let rounds = self.rounds_correctly();
        let error = if rounds { reference_error } else { rules[0].bound(self.integrand()) };
        let promise = if undecided == 0 {
            "every value is the true integral, rounded once to the nearest, ties to even".into()
        } else if !rounds {
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
            decided_before_reference: texels - undecided - self.decided_by_reference,
            decided_by_reference: self.decided_by_reference,
            undecided,
            reference_error,
            smallest_distance: self.smallest_distance,
            blake3: String::new(),
        };
        Certified { values: self.values, certificate, stages: self.stages }
    }
}

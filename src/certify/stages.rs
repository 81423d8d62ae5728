//! The stages of certification: rules, each finer than those before on some rows, made ready for a
//! table.

use super::decision::Task;
use crate::backend::cpu::Baker;
use crate::integrate::Integrand;
use crate::integrate::errors::Errors;
use crate::integrate::rule::{Method, Rule};
use crate::integrate::rules::{FINER, FINER_BY};
use crate::table::claim::{Stage, StageError};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use rayon::prelude::*;

/// The most values of a lobe, in all slices, that are rounded correctly to f32, whose steps are as
/// fine as the fast stages' bounds: each takes the 48,000 evaluations of the reference, all of them
/// 0.2 s for GGX and 2 s for Charlie on one thread.
pub const LARGEST_F32: usize = 4096;

/// The same of glass, whose reference takes some ten times as long.
pub const LARGEST_F32_OF_GLASS: usize = 512;

/// An α of smooth rows, where Charlie's rules are as sharp as on others, and one of rough rows.
const SOME_ALPHAS: [f64; 2] = [0.1, 1.0];

/// The stages of the CPU, ready for any part of a table.
#[derive(Clone, Debug)]
pub struct Stages {
    integrand: Integrand,
    /// The least n·v of the table, from which on bounds are asked.
    pub(super) least_mu: f64,
    pub(super) bakers: Vec<Baker>,
    /// Whether values are rounded correctly: of f32 only few values, and those in closed form.
    pub(super) rounds_correctly: bool,
}

/// The rules of the CPU's stages, each finer than those before on some rows.
pub fn rules(task: &Task) -> Vec<Rule> {
    let integrand = task.lut.integrand();
    let (texels, least_mu) = (task.points(), task.grid.least_mu());
    let first = match task.precision {
        precision if precision.is_rounded_once() => Rule::for_rounding(integrand, least_mu, texels),
        _ => Rule::for_cpu(integrand, task.tolerance, texels),
    };
    // On smooth rows and on rough ones: Blinn-Phong's own rules have no bound on the latter.
    let errors = |rule: &Rule| SOME_ALPHAS.map(|alpha| rule.bound_at(integrand, least_mu, alpha));
    let mut rules: Vec<Rule> = first.into_iter().collect();
    for rule in FINER.into_iter().filter(|rule| rule.applies_to(integrand)) {
        let is_finer =
            |i: usize| rules.iter().all(|other| FINER_BY * errors(&rule)[i] < errors(other)[i]);
        if (0..SOME_ALPHAS.len()).any(is_finer) {
            rules.push(rule);
        }
    }
    rules
}

impl Stages {
    /// Those of a whole table.
    pub fn of(task: &Task) -> Self {
        Stages::by(task, &rules(task))
    }

    /// The stages of these rules, each finer than those before on some rows.
    pub fn by(task: &Task, rules: &[Rule]) -> Self {
        let integrand = task.lut.integrand();
        let values = task.grid.len() * task.lut.count() * task.slices;
        let few = match integrand {
            Integrand::Diffuse(_) => true,
            Integrand::Specular(..) => values <= LARGEST_F32,
            Integrand::Glass(_) => values <= LARGEST_F32_OF_GLASS,
        };
        Stages {
            integrand,
            least_mu: task.grid.least_mu(),
            bakers: rules.par_iter().map(|rule| Baker::new(integrand, rule)).collect(),
            rounds_correctly: task.precision.is_rounded_once()
                || task.precision == Precision::F32 && few,
        }
    }

    /// The rules between a stage, none of a device, and the reference. A stage widens its bounds of
    /// integrals and of averages by twice the error of the finest of them, row by row. Whatever it
    /// decides, that rule would decide too; hence the set of texels that reaches the reference is
    /// independent of which stages ran.
    pub(super) fn margins(&self, stage: Option<usize>) -> Vec<Rule> {
        let before_reference = match self.rounds_correctly {
            true => self.bakers.len().saturating_sub(1),
            false => 0,
        };
        let first = stage.map_or(0, |stage| stage + 1).min(before_reference);
        self.bakers[first..before_reference].iter().map(|baker| baker.rule).collect()
    }

    /// Whether the stage is of use at an α: [`FINER_BY`] times as fine as those of use before it,
    /// or the finest before the reference, whose errors are the margin of all before; the last
    /// one takes whatever is left.
    pub(super) fn is_of_use(&self, stage: usize, alpha: f64) -> bool {
        let last = self.bakers.len() - 1;
        let bound = |stage: usize| self.bound_at(stage, alpha);
        let finest = (0..last).map(bound).fold(f64::INFINITY, f64::min);
        let mut finest_so_far = f64::INFINITY;
        let mut of_use = false;
        for stage in 0..=stage {
            let finer = FINER_BY * bound(stage) < finest_so_far
                || bound(stage) == finest && finest < finest_so_far;
            of_use = stage == last || finer;
            if of_use {
                finest_so_far = finest_so_far.min(bound(stage));
            }
        }
        of_use
    }

    fn bound_at(&self, stage: usize, alpha: f64) -> f64 {
        self.bakers[stage].rule.bound_at(self.integrand, self.least_mu, alpha)
    }

    /// Whether the stage interpolates: cheap enough to check a device at every texel.
    pub(super) fn interpolates(&self, stage: usize) -> bool {
        matches!(self.bakers[stage].rule.method, Method::Interpolant(_))
    }

    /// Whether the stage is the reference.
    pub(super) fn is_reference(&self, stage: usize) -> bool {
        self.bakers[stage].rule.is_reference()
    }

    /// The work of a stage, none of a device, on a grid in numbers, for the report; its errors are
    /// those of the rows where it is of use.
    pub(super) fn summary(
        &self,
        by: String,
        stage: Option<usize>,
        errors: &Errors,
        grid: &Grid,
        (texels, decided): (usize, Option<usize>),
    ) -> Stage {
        let decades = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
        let of_row = |&alpha: &f64| {
            let row = errors.row(self.least_mu, alpha);
            let by_decade = decades.map(|b| row.of(&[0.0, b])[1]);
            StageError { largest: row.of(&[1.0])[0], by_decade }
        };
        let is_of_use = |alpha| stage.is_none_or(|stage| self.is_of_use(stage, alpha));
        let rows = grid.alphas.iter().filter(|&&alpha| is_of_use(alpha));
        let bounds = rows.map(of_row).filter(|bound| bound.largest.is_finite());
        Stage { by, error: bounds.reduce(StageError::or_wider), texels, decided }
    }
}

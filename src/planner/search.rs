//! The search: candidates from the cheapest on, each proved to fail, found to fail, or verified,
//! until one passes.

mod attempt;
mod lines;
mod nets;

use super::candidate::{Candidate, over_roughness, textures};
use super::cost::{Cost, Weights};
use super::domain::Domain;
use super::fit::Multiplier;
use super::tolerance::Tolerance;
use super::truth::Truth;
use super::verify::Worst;
use crate::approximation::{Approximation, Region, Sampler};

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Task {
    /// Where lookups have to be right.
    pub domain: Domain,
    /// How right.
    pub tolerance: Tolerance,
    /// What counts.
    pub weights: Weights,
    /// The texture that a shader reads, where it has to stay as it is.
    pub sampler: Option<Sampler>,
}

impl Task {
    /// Every candidate for all roughnesses of the domain, for a range of F0.
    pub fn candidates(&self, f0: [f64; 2]) -> Vec<Candidate> {
        // The axes of a sampler were checked.
        self.sampler.map_or_else(|| over_roughness(f0), |one| textures(&one).unwrap_or_default())
    }

    /// Whether the domain has candidates over all its roughnesses: nets need a range of them.
    pub fn is_over_roughness(&self, region: &Region) -> bool {
        self.sampler.is_some() || region.roughness[0] < region.roughness[1]
    }
}

/// What became of a candidate.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// No numbers whatever meet the tolerance: the largest error over it is at least `bound`.
    Fails {
        /// At least 1.
        bound: f64,
        /// The proof.
        proof: Vec<Multiplier>,
    },
    /// The numbers that were found miss it; others may not.
    NotFound(Worst),
    /// It meets the tolerance; what costs no less than another one that does was only measured.
    Passes(Worst),
}

/// A candidate and what became of it.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The candidate.
    pub candidate: Candidate,
    /// Its region.
    pub region: Region,
    /// Its range of F0.
    pub f0: [f64; 2],
    /// Its cost.
    pub cost: Cost,
    /// The outcome.
    pub verdict: Verdict,
}

impl Trial {
    /// A trial, and what the candidate costs in its region.
    pub fn new(candidate: &Candidate, region: Region, f0: [f64; 2], verdict: Verdict) -> Self {
        let cost = Cost::of(candidate, &region);
        Trial { candidate: *candidate, region, f0, cost, verdict }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// One approximation for all, or one for each piece of the domain.
    pub choice: Vec<(Approximation, Worst)>,
    /// Its cost.
    pub cost: Cost,
    /// Everything that was tried.
    pub trials: Vec<Trial>,
    /// A lower bound of the error over its tolerance that fails a candidate.
    pub fails: f64,
}

/// Most roughnesses that have a polynomial each; real scenes have up to 40.
const MOST_CONSTANTS: usize = 64;

/// Most numbers of a polynomial in n·v.
pub const MOST_POWERS: usize = 14;

/// An error over its tolerance that passes where it is only measured: below roughness 0.001, where
/// nothing bounds it. Between the points it is larger than at them by 1.4 % at the most.
pub const PASSES: f64 = 0.98;

/// A lower bound of the error over its tolerance that fails a candidate: proofs are rounded.
const FAILS: f64 = 1.001;

/// The cheapest choice that meets the tolerance; none among the candidates is an empty choice.
pub fn search(task: &Task, truth: &Truth) -> Outcome {
    let whole = task.domain.whole();
    let truth_error = whole.map_or(0.0, |(region, f0)| truth.error(&region, f0, task.tolerance));
    let search = Search { task, truth, truth_error };
    let mut trials = Vec::new();
    let is_constant = task.domain.is_constant() && task.domain.pieces.len() <= MOST_CONSTANTS;
    let may_be_lines = is_constant && task.sampler.is_none();
    let lines = if may_be_lines { search.lines(&mut trials) } else { None };
    let limit = lines.as_ref().map(|(_, cost)| cost.weighed(&task.weights));
    let chosen = search.over_roughness(limit, &mut trials).or(lines);
    let (choice, cost) = chosen.unwrap_or_default();
    Outcome { choice, cost, trials, fails: search.fails() }
}

/// A choice and its cost.
type Choice = (Vec<(Approximation, Worst)>, Cost);

struct Search<'a> {
    task: &'a Task,
    truth: &'a Truth,
    /// The error of the truth over the tolerance.
    truth_error: f64,
}

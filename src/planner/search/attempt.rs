//! An attempt at candidates of one shape: they are proved to fail, found to fail, or verified.

use super::{FAILS, PASSES, Search, Trial, Verdict};
use crate::approximation::{Approximation, Region};
use crate::planner::bound::bound;
use crate::planner::candidate::Candidate;
use crate::planner::cost::Cost;
use crate::planner::fit::{Effort, Fit, Problem};
use crate::planner::samples::Sample;
use crate::planner::verify::{self, Worst};
use std::cell::LazyCell;
use std::ops::Deref;

/// Steps of a fit.
pub const STEPS: usize = 24;

/// An error over its tolerance that rounding of the numbers leaves within it.
const ENOUGH: f64 = 0.6;

/// A candidate that passes, and its cost.
pub type Passed = (Approximation, Worst, Cost);

/// A trial, with its numbers where they meet the tolerance at all points.
pub type Tried = (Trial, Option<Approximation>);

/// Attempts in a region, for a range of F0.
#[derive(Clone, Copy)]
pub struct Attempts<'a> {
    pub search: &'a Search<'a>,
    pub region: Region,
    pub f0: [f64; 2],
}

impl Attempts<'_> {
    /// The cost as one number.
    fn weighed(&self, cost: Cost) -> f64 {
        cost.weighed(&self.search.task.weights)
    }

    /// What the best so far costs; infinite where there is none.
    pub fn least(&self, best: Option<&Passed>) -> f64 {
        best.map_or(f64::INFINITY, |(_, _, cost)| self.weighed(*cost))
    }

    /// What a candidate costs.
    pub fn cost(&self, candidate: &Candidate) -> f64 {
        self.weighed(Cost::of(candidate, &self.region))
    }

    /// The fit, until it is proved to fail or its error is small enough.
    fn fit(
        &self,
        candidate: &Candidate,
        samples: &[Sample],
        steps: usize,
        enough: f64,
    ) -> Option<Fit> {
        let Candidate { channels, shape, counts, .. } = *candidate;
        let (region, f0, tolerance) = (self.region, self.f0, self.search.task.tolerance);
        let problem = Problem { region, f0, tolerance, channels, shape, counts, samples };
        problem.fit(Effort { steps, fails: self.search.fails(), enough })
    }

    fn trial(&self, candidate: &Candidate, verdict: Verdict) -> Trial {
        Trial::new(candidate, self.region, self.f0, verdict)
    }

    /// The trials of candidates that this fit proves to fail; none where it does not.
    fn failing(&self, same: &[Candidate], fit: &Fit) -> Vec<Tried> {
        if fit.bound <= self.search.fails() {
            return Vec::new();
        }
        let verdict = || Verdict::Fails { bound: fit.bound, proof: fit.proof.clone() };
        same.iter().map(|candidate| (self.trial(candidate, verdict()), None)).collect()
    }

    /// The trials of candidates that differ in storage, where a fit to these samples proves within
    /// so many steps that they fail; none where it does not.
    pub fn refuted(&self, same: &[Candidate], samples: &[Sample], steps: usize) -> Vec<Tried> {
        // Numbers that meet the tolerance at the samples end it.
        let fit = same.first().and_then(|first| self.fit(first, samples, steps, 1.0));
        fit.map(|fit| self.failing(same, &fit)).unwrap_or_default()
    }

    /// Fits candidates that differ in storage to samples, and measures them at these places.
    pub fn attempt<P: Deref<Target = [Sample]>>(
        &self,
        same: &[Candidate],
        samples: &[Sample],
        places: impl FnOnce() -> P,
    ) -> Vec<Tried> {
        let Some(first) = same.first() else { return Vec::new() };
        let (truth, tolerance) = (self.search.truth, self.search.task.tolerance);
        let places = LazyCell::new(places);
        let mut tried = Vec::new();
        // Where the cheapest storage of a net loses the tolerance by rounding, it is fitted anew.
        for enough in [ENOUGH, 0.0] {
            let Some(mut fit) = self.fit(first, samples, STEPS, enough) else {
                let unsolved = || Verdict::NotFound(Worst::unknown(self.f0[0]));
                return same.iter().map(|one| (self.trial(one, unsolved()), None)).collect();
            };
            let failing = self.failing(same, &fit);
            if !failing.is_empty() {
                return failing;
            }
            first.fill(&mut fit, truth, &self.region, samples);
            let measured = |candidate: &Candidate| {
                let approximation = candidate.with(&fit, truth.lobe(), self.region);
                let worst = verify::measure(&approximation, self.f0, tolerance, &places);
                self.tried(candidate, approximation, worst)
            };
            tried = same.iter().map(measured).collect();
            // A better fit takes off no more than what it is above its bound.
            let gain = fit.error - fit.bound;
            let gains = match tried.first().map(|(trial, _)| &trial.verdict) {
                // Within the tolerance at points alone it may be beyond it between them.
                Some(Verdict::NotFound(worst) | Verdict::Passes(worst)) => {
                    worst.share > PASSES - self.search.truth_error && worst.share - gain <= 1.0
                }
                _ => false,
            };
            let has_ended = fit.is_finished() || fit.error > enough;
            if !gains || has_ended || first.shape.net().is_none() {
                break;
            }
        }
        tried
    }

    /// The trial of numbers with this error at points.
    pub fn tried(
        &self,
        candidate: &Candidate,
        approximation: Approximation,
        worst: Worst,
    ) -> Tried {
        match worst.share <= self.search.limit() {
            true => (self.trial(candidate, Verdict::Passes(worst)), Some(approximation)),
            false => (self.trial(candidate, Verdict::NotFound(worst)), None),
        }
    }

    /// Of all that was tried the cheapest that meets the tolerance between the points too, where it
    /// costs less than the best so far. What costs no less than that is not looked at.
    pub fn settle(
        &self,
        tried: Vec<Tried>,
        best: Option<Passed>,
        trials: &mut Vec<Trial>,
    ) -> Option<Passed> {
        let first = trials.len();
        let mut passing = Vec::new();
        for (index, (trial, approximation)) in tried.into_iter().enumerate() {
            passing.extend(approximation.map(|approximation| (first + index, approximation)));
            trials.push(trial);
        }
        passing.sort_by(|(a, _), (b, _)| {
            self.weighed(trials[*a].cost).total_cmp(&self.weighed(trials[*b].cost))
        });
        for (index, approximation) in passing {
            let trial = &mut trials[index];
            if self.weighed(trial.cost) >= self.least(best.as_ref()) {
                break;
            }
            let Verdict::Passes(worst) = trial.verdict else { continue };
            trial.verdict = self.judged(&approximation, worst);
            if let Verdict::Passes(worst) = trial.verdict {
                return Some((approximation, worst, trial.cost));
            }
        }
        best
    }

    /// Whether numbers that meet the tolerance at points meet it anywhere.
    fn judged(&self, approximation: &Approximation, worst: Worst) -> Verdict {
        let Search { task, truth, truth_error } = *self.search;
        let bound = bound(approximation, self.f0, task.tolerance, worst.share, truth);
        let [smoothest, _] = approximation.region.roughness;
        let is_whole = bound.is_some_and(|bound| bound.from <= smoothest);
        let is_bounded = bound.is_none_or(|bound| bound.share <= self.search.limit());
        let is_within = is_whole || worst.share <= PASSES - truth_error;
        let worst = Worst { bound, ..worst };
        if is_bounded && is_within { Verdict::Passes(worst) } else { Verdict::NotFound(worst) }
    }
}

impl Search<'_> {
    /// A lower bound of the error over its tolerance that fails a candidate.
    pub(super) fn fails(&self) -> f64 {
        FAILS + self.truth_error
    }

    /// The largest error over its tolerance that passes.
    fn limit(&self) -> f64 {
        1.0 - self.truth_error
    }
}

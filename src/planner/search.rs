//! The search: candidates from the cheapest on, each proved to fail, found to fail, or verified,
//! until one passes.

mod lines;

use super::bound::bound;
use super::candidate::{Candidate, over_roughness, textures};
use super::cost::{Cost, Weights};
use super::domain::Domain;
use super::fit::{Effort, Fit, Multiplier, Problem};
use super::reach::out_of_reach;
use super::samples::{BESIDE_THE_LAYER, ON_THE_LAYER, Sample, Spread, on_grid, samples};
use super::tolerance::Tolerance;
use super::truth::Truth;
use super::verify::{self, Worst};
use crate::approximation::{Approximation, Region, Sampler, Shape, Texels};
use rayon::prelude::*;

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
    /// It meets the tolerance.
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
}

/// Most roughnesses that have a polynomial each; real scenes have up to 40.
const MOST_CONSTANTS: usize = 64;

/// Most numbers of a polynomial in n·v.
pub const MOST_POWERS: usize = 14;

/// Samples of a surface.
const ON_A_SURFACE: [Spread; 2] = [Spread::Crowded(33), Spread::Crowded(25)];

/// Samples in a span of a spline.
const IN_A_SPAN: [Spread; 2] = [Spread::Crowded(6); 2];

/// Samples between the texels of a texture.
const IN_A_TEXEL: [Spread; 2] = [Spread::Crowded(3); 2];

/// Places where exact textures are tried first.
const SCREEN: [Spread; 2] = [Spread::Even(96), Spread::Even(64)];

/// Further samples, in coordinates that do not follow the layer at grazing angles: next to a mirror
/// those that do are all at n·v near 0 or at 1.
const BESIDE: [Spread; 2] = [Spread::Crowded(17), Spread::Crowded(13)];

/// Steps of a fit.
const STEPS: usize = 24;

/// An error over its tolerance that rounding of the numbers leaves within it.
const ENOUGH: f64 = 0.6;

/// An error over its tolerance that passes where it is only measured: below roughness 0.001, where
/// nothing bounds it. Between the points it is larger than at them by 1.4 % at the most.
pub const PASSES: f64 = 0.98;

/// A lower bound of the error over its tolerance that fails a candidate: proofs are rounded.
pub const FAILS: f64 = 1.001;

/// Candidates that are tried at a time.
const AT_A_TIME: usize = 16;

/// Turns after which the largest candidates are tried: most plans are found before.
const TURNS: usize = 4;

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
    Outcome { choice, cost, trials }
}

/// A choice and its cost.
type Choice = (Vec<(Approximation, Worst)>, Cost);

struct Search<'a> {
    task: &'a Task,
    truth: &'a Truth,
    /// The error of the truth over the tolerance.
    truth_error: f64,
}

impl Search<'_> {
    /// The cheapest spline or surface over all roughnesses, cheaper than the limit.
    fn over_roughness(&self, limit: Option<f64>, trials: &mut Vec<Trial>) -> Option<Choice> {
        let (region, f0) = self.task.domain.whole()?;
        if !self.task.is_over_roughness(&region) {
            return None;
        }
        let weights = &self.task.weights;
        let cost = |candidate: &Candidate| Cost::of(candidate, &region).weighed(weights);
        let mut candidates = self.task.candidates(f0);
        candidates.retain(|candidate| limit.is_none_or(|limit| cost(candidate) < limit));
        // The storages of one shape stand side by side: they are tried together, with the cheapest.
        let is_same = |a: &Candidate, b: &Candidate| a.shape == b.shape && a.counts == b.counts;
        let mut queue: Vec<&[Candidate]> = candidates.chunk_by(is_same).collect();
        queue.sort_by(|a, b| cost(&a[0]).total_cmp(&cost(&b[0])));
        let beside = on_grid(self.truth, &region, BESIDE_THE_LAYER, (BESIDE, [1, 1]));
        // Where exact textures are tried first: most miss the tolerance at one of these.
        let screen = match self.task.sampler {
            Some(_) => on_grid(self.truth, &region, ON_THE_LAYER, (SCREEN, [1, 1])),
            None => Vec::new(),
        };
        let mut best: Option<(Choice, f64)> = None;
        for (turn, batch) in queue.chunks(AT_A_TIME).enumerate() {
            // A choice with a cost below a limit needs proofs of all that costs less.
            let may_end = self.task.sampler.is_none() && limit.is_none();
            if turn == TURNS && best.is_none() && may_end {
                let largest = out_of_reach(self.task, self.truth, self.truth_error);
                if let Some(largest) = largest {
                    trials.extend(largest);
                    return None;
                }
            }
            if best.as_ref().is_some_and(|(_, least)| cost(&batch[0][0]) >= *least) {
                break;
            }
            let attempts = batch.par_iter().map(|&same| {
                let spread = match same[0].shape {
                    Shape::Texture { texels: Texels::Exact, .. } => {
                        return self.exact(same, region, f0, &screen);
                    }
                    Shape::Texture { .. } => IN_A_TEXEL,
                    Shape::Spline { .. } => IN_A_SPAN,
                    _ => ON_A_SURFACE,
                };
                let shape = &same[0].shape;
                let mut points = samples(self.truth, &region, shape, spread);
                points.extend(&beside);
                let places = || verify::points(self.truth, &region, shape);
                self.attempt(same, region, f0, &points, places)
            });
            let attempts: Vec<_> = attempts.collect();
            for (trial, approximation) in attempts.into_iter().flatten() {
                if let (Verdict::Passes(worst), Some(approximation)) =
                    (&trial.verdict, approximation)
                {
                    let own = trial.cost.weighed(weights);
                    if best.as_ref().is_none_or(|(_, least)| own < *least) {
                        best = Some(((vec![(approximation, *worst)], trial.cost), own));
                    }
                }
                trials.push(trial);
            }
        }
        best.map(|(choice, _)| choice)
    }

    /// Tries textures of integrals, which differ in storage: a place where one errs by more than
    /// the tolerance is a witness that it fails.
    fn exact(
        &self,
        same: &[Candidate],
        region: Region,
        f0: [f64; 2],
        screen: &[Sample],
    ) -> Vec<(Trial, Option<Approximation>)> {
        let made = |candidate: &Candidate| {
            let approximation = candidate.exact(self.truth, region)?;
            let measure = |places: &[Sample]| {
                verify::measure(&approximation, f0, self.task.tolerance, places)
            };
            let mut worst = measure(screen);
            if worst.share <= 1.0 {
                worst = measure(&verify::points(self.truth, &region, &candidate.shape));
            }
            Some((approximation, worst))
        };
        self.verified(same, region, f0, made)
    }

    fn problem<'b>(
        &self,
        candidate: &Candidate,
        region: Region,
        f0: [f64; 2],
        samples: &'b [Sample],
    ) -> Problem<'b> {
        let Candidate { channels, shape, counts, .. } = *candidate;
        Problem { region, f0, tolerance: self.task.tolerance, channels, shape, counts, samples }
    }

    /// The fit, until it is proved to fail or its error is small enough.
    fn fit(&self, problem: &Problem, enough: f64) -> Option<Fit> {
        problem.fit(Effort { steps: STEPS, fails: FAILS + self.truth_error, enough })
    }

    /// The trials of candidates that this fit proves to fail; none where it does not.
    fn failing(&self, same: &[Candidate], region: Region, f0: [f64; 2], fit: &Fit) -> Vec<Trial> {
        if fit.bound <= FAILS + self.truth_error {
            return Vec::new();
        }
        let verdict = || Verdict::Fails { bound: fit.bound, proof: fit.proof.clone() };
        same.iter().map(|candidate| Trial::new(candidate, region, f0, verdict())).collect()
    }

    /// Tries candidates of one shape, which differ in storage, and verifies them at these places
    /// until one passes: the cheaper storage comes first.
    fn attempt(
        &self,
        same: &[Candidate],
        region: Region,
        f0: [f64; 2],
        points: &[Sample],
        places: impl FnOnce() -> Vec<Sample>,
    ) -> Vec<(Trial, Option<Approximation>)> {
        let Some(first) = same.first() else { return Vec::new() };
        let problem = self.problem(first, region, f0, points);
        let places = std::cell::LazyCell::new(places);
        let mut tried = Vec::new();
        // Where the cheapest storage of a net loses the tolerance by rounding, the fit goes on.
        for enough in [ENOUGH, 0.0] {
            let Some(mut fit) = self.fit(&problem, enough) else {
                let unsolved = Verdict::NotFound(Worst::unknown(f0[0]));
                let trial = |one: &Candidate| Trial::new(one, region, f0, unsolved.clone());
                return same.iter().map(|candidate| (trial(candidate), None)).collect();
            };
            let failing = self.failing(same, region, f0, &fit);
            if !failing.is_empty() {
                return failing.into_iter().map(|trial| (trial, None)).collect();
            }
            first.fill(&mut fit, self.truth, &region, points);
            tried = self.verified(same, region, f0, |candidate| {
                let approximation = candidate.with(&fit, self.truth.lobe(), region);
                let worst = verify::measure(&approximation, f0, self.task.tolerance, &places);
                Some((approximation, worst))
            });
            // A better fit takes off no more than what it is above its bound.
            let gain = fit.error - fit.bound;
            let may_pass = match tried.first().map(|(trial, _)| &trial.verdict) {
                Some(Verdict::NotFound(worst)) => worst.share - gain <= 1.0,
                _ => false,
            };
            if !may_pass || fit.is_finished() || first.shape.net().is_none() {
                break;
            }
        }
        tried
    }

    /// Verifies what is made of candidates that differ in storage, and its error at points, until
    /// one passes.
    fn verified(
        &self,
        same: &[Candidate],
        region: Region,
        f0: [f64; 2],
        made: impl Fn(&Candidate) -> Option<(Approximation, Worst)>,
    ) -> Vec<(Trial, Option<Approximation>)> {
        let mut tried = Vec::new();
        for candidate in same {
            let Some((approximation, worst)) = made(candidate) else { continue };
            let verdict = self.judged(&approximation, f0, worst);
            let passes = matches!(verdict, Verdict::Passes(_));
            let approximation = passes.then_some(approximation);
            tried.push((Trial::new(candidate, region, f0, verdict), approximation));
            if passes {
                break;
            }
        }
        tried
    }

    /// Whether numbers with this error at points meet the tolerance anywhere.
    fn judged(&self, approximation: &Approximation, f0: [f64; 2], worst: Worst) -> Verdict {
        let limit = 1.0 - self.truth_error;
        if worst.share > limit {
            return Verdict::NotFound(worst);
        }
        let bound = bound(approximation, f0, self.task.tolerance, worst.share, self.truth);
        let [smoothest, _] = approximation.region.roughness;
        let is_whole = bound.is_some_and(|bound| bound.from <= smoothest);
        let is_bounded = bound.is_none_or(|bound| bound.share <= limit);
        let is_within = is_whole || worst.share <= PASSES - self.truth_error;
        let worst = Worst { bound, ..worst };
        if is_bounded && is_within { Verdict::Passes(worst) } else { Verdict::NotFound(worst) }
    }
}

//! Shapes over all roughnesses, from the cheapest on: nets of control points, surfaces, textures.

use super::attempt::{Attempts, Passed, Tried};
use super::{Choice, Search, Trial};
use crate::approximation::{Shape, Texels};
use crate::planner::candidate::Candidate;
use crate::planner::reach::out_of_reach;
use crate::planner::samples::{BESIDE_THE_LAYER, ON_THE_LAYER, Sample, Spread, on_grid, samples};
use crate::planner::verify;
use rayon::prelude::*;
use std::cell::LazyCell;

/// Samples of a surface.
const ON_A_SURFACE: [Spread; 2] = [Spread::Crowded(33), Spread::Crowded(25)];

/// Samples in a span of a spline.
const IN_A_SPAN: [Spread; 2] = [Spread::Crowded(6); 2];

/// Samples between the texels of a texture.
const IN_A_TEXEL: [Spread; 2] = [Spread::Crowded(3); 2];

/// Samples in a span of a spline where most are proved to fail: a bound at some of the points is
/// one at all of them. Of 2 to 4, 3 is the fastest.
const FEW_IN_A_SPAN: [Spread; 2] = [Spread::Crowded(3); 2];

/// Steps of a fit at few samples.
const FEW_STEPS: usize = 6;

/// Places where exact textures are tried first.
const SCREEN: [Spread; 2] = [Spread::Even(96), Spread::Even(64)];

/// Further samples, in coordinates that do not follow the layer at grazing angles: next to a mirror
/// those that do are all at n·v near 0 or at 1.
const BESIDE: [Spread; 2] = [Spread::Crowded(17), Spread::Crowded(13)];

/// Candidates that are tried at a time.
const AT_A_TIME: usize = 16;

/// Turns after which the largest candidates are tried: most plans are found before.
const TURNS: usize = 16;

impl Search<'_> {
    /// The cheapest shape over all roughnesses, cheaper than the limit.
    pub(super) fn over_roughness(
        &self,
        limit: Option<f64>,
        trials: &mut Vec<Trial>,
    ) -> Option<Choice> {
        let (region, f0) = self.task.domain.whole()?;
        if !self.task.is_over_roughness(&region) {
            return None;
        }
        let attempts = Attempts { search: self, region, f0 };
        let cost = |candidate: &Candidate| attempts.cost(candidate);
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
        let mut best: Option<Passed> = None;
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
            if cost(&batch[0][0]) >= attempts.least(best.as_ref()) {
                break;
            }
            let of_shape = |&same: &&[Candidate]| match same[0].shape {
                Shape::Texture { texels: Texels::Exact, .. } => attempts.exact(same, &screen),
                _ => attempts.fitted(same, &beside),
            };
            let tried: Vec<Vec<Tried>> = batch.par_iter().map(of_shape).collect();
            best = attempts.settle(tried.into_iter().flatten().collect(), best, trials);
        }
        best.map(|(approximation, worst, cost)| (vec![(approximation, worst)], cost))
    }
}

impl Attempts<'_> {
    /// Fits a shape, which differs in storage.
    fn fitted(&self, same: &[Candidate], beside: &[Sample]) -> Vec<Tried> {
        let (truth, region, shape) = (self.search.truth, &self.region, &same[0].shape);
        let spread = match shape {
            Shape::Texture { .. } => IN_A_TEXEL,
            Shape::Spline { .. } => IN_A_SPAN,
            _ => ON_A_SURFACE,
        };
        if let Shape::Spline { .. } = shape {
            let few = samples(truth, region, shape, FEW_IN_A_SPAN);
            let failing = self.refuted(same, &few, FEW_STEPS);
            if !failing.is_empty() {
                return failing;
            }
        }
        let mut points = samples(truth, region, shape, spread);
        points.extend(beside);
        self.attempt(same, &points, || verify::points(truth, region, shape))
    }

    /// Measures textures of integrals, which differ in storage: a place where one errs by more than
    /// the tolerance is a witness that it fails.
    fn exact(&self, same: &[Candidate], screen: &[Sample]) -> Vec<Tried> {
        let (truth, tolerance) = (self.search.truth, self.search.task.tolerance);
        let integrals = same[0].integrals(truth).unwrap_or_default();
        let places = LazyCell::new(|| verify::points(truth, &self.region, &same[0].shape));
        let measured = |candidate: &Candidate| {
            let approximation = candidate.of_integrals(&integrals, truth.lobe(), self.region);
            let measure =
                |places: &[Sample]| verify::measure(&approximation, self.f0, tolerance, places);
            let mut worst = measure(screen);
            if worst.share <= 1.0 {
                worst = measure(&places);
            }
            self.tried(candidate, approximation, worst)
        };
        same.iter().map(measured).collect()
    }
}

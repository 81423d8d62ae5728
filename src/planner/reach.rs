//! Whether a tolerance is out of reach of all candidates over a range of roughness: found out from
//! the largest ones, before the many between are tried.

use super::candidate::{Candidate, over_roughness};
use super::fit::{Effort, Fit, Problem};
use super::samples::{Spread, samples};
use super::search::{Task, Trial, Verdict};
use super::truth::Truth;
use crate::approximation::{Region, Shape};
use rayon::prelude::*;

/// The largest error over the tolerance that the largest candidates have at the least, where
/// smaller ones are not tried. Of cubic nets of 28 x 42, 28 x 36, 27 x 41, 26 x 40 and 24 x 36
/// control points over roughness from 0, 0.045 and 0.3 to 1, with each k and each coordinate of
/// roughness, the largest always had the least bound; this leaves a tenth to spare.
const FAR: f64 = 1.1;

/// Steps of a fit. After twelve a bound has come to within 5 % of that after 24.
const STEPS: usize = 12;

/// Samples in a span: fewer than those of a fit whose numbers are used, since a bound holds at any.
const IN_A_SPAN: [Spread; 2] = [Spread::Crowded(5); 2];

/// Samples of a surface.
const ON_A_SURFACE: [Spread; 2] = [Spread::Crowded(33), Spread::Crowded(25)];

/// The largest candidates of each kind with proofs that they miss the tolerance by far; none where
/// one of them may meet it.
pub fn out_of_reach(task: &Task, truth: &Truth, truth_error: f64) -> Option<Vec<Trial>> {
    let (region, f0) = task.domain.whole()?;
    if region.roughness[0] == region.roughness[1] {
        return None;
    }
    let largest = largest(&over_roughness(f0));
    let shapes: Vec<&[Candidate]> = largest.chunk_by(|a, b| a.shape == b.shape).collect();
    let of_shape = |same: &&[Candidate]| {
        let Fit { bound, proof, .. } = far(task, truth, truth_error, &same[0], (region, f0))?;
        let verdict = || Verdict::Fails { bound, proof: proof.clone() };
        let trial = |candidate: &Candidate| Trial::new(candidate, region, f0, verdict());
        Some(same.iter().map(trial).collect::<Vec<Trial>>())
    };
    let trials: Vec<Vec<Trial>> = shapes.par_iter().map(of_shape).collect::<Option<_>>()?;
    Some(trials.into_iter().flatten().collect())
}

/// The fit of a candidate, where it proves that the tolerance is far away.
fn far(
    task: &Task,
    truth: &Truth,
    truth_error: f64,
    candidate: &Candidate,
    (region, f0): (Region, [f64; 2]),
) -> Option<Fit> {
    let Candidate { channels, shape, counts, .. } = *candidate;
    let spread = match shape {
        Shape::Spline { .. } => IN_A_SPAN,
        _ => ON_A_SURFACE,
    };
    let points = samples(truth, &region, &shape, spread);
    let Task { tolerance, .. } = *task;
    let problem = Problem { region, f0, tolerance, channels, shape, counts, samples: &points };
    let fails = FAR + truth_error;
    // Numbers that meet the tolerance are mostly found at once, and end the fit.
    problem.fit(Effort { steps: STEPS, fails, enough: 1.0 }).filter(|fit| fit.bound > fails)
}

/// Those with the most numbers of each kind, in their order.
fn largest(candidates: &[Candidate]) -> Vec<Candidate> {
    let mut largest: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        let is_other = |own: &Candidate| !is_of_kind(&own.shape, &candidate.shape);
        let best = largest.iter().find(|own| !is_other(own)).map(|own| own.counts);
        if best.is_some_and(|best| best < candidate.counts) {
            largest.retain(is_other);
        }
        if best.is_none_or(|best| best <= candidate.counts) {
            largest.push(*candidate);
        }
    }
    largest
}

/// Whether two shapes differ in their sizes alone.
fn is_of_kind(one: &Shape, other: &Shape) -> bool {
    match (*one, *other) {
        (
            Shape::Spline { x, y, degree, .. },
            Shape::Spline { x: other_x, y: other_y, degree: other_degree, .. },
        ) => (x, y, degree) == (other_x, other_y, other_degree),
        (Shape::Surface { x, y, .. }, Shape::Surface { x: other_x, y: other_y, .. }) => {
            (x, y) == (other_x, other_y)
        }
        _ => false,
    }
}

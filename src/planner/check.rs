//! Verifies a plan from scratch: its numbers by the reference rule at points of their own, and
//! every proof.

use super::bound::bound;
use super::candidate::{self, Candidate};
use super::cost::Cost;
use super::domain::Piece;
use super::file::{Chosen, PlanFile, Rejected};
use super::fit::Multiplier;
use super::proof::Claim;
use super::samples::{Sample, Spread};
use super::search::{MOST_POWERS, PASSES, Task};
use super::tolerance::Tolerance;
use super::truth::Truth;
use super::verify::{self, Worst};
use crate::approximation::{Approximation, Region, Shape, Texels};
use crate::error::{Error, Result};
use rayon::prelude::*;

/// What was verified.
#[derive(Clone, Debug, PartialEq)]
pub struct Checked {
    /// The largest error of each part of the choice.
    pub worst: Vec<Worst>,
    /// Candidates that were proved to fail, by a proof of their own or as part of another.
    pub proved: usize,
    /// Points and multipliers of all proofs.
    pub multipliers: usize,
    /// Candidates of which no good numbers were found.
    pub not_found: usize,
}

/// Points in each span and between texels: others than those at which plans are made.
const IN_A_SPAN: [Spread; 2] = [Spread::Even(9), Spread::Even(2)];

/// Points of a shape without spans.
const IN_ALL: [Spread; 2] = [Spread::Even(211), Spread::Even(53)];

/// Bounds are the same to the last digits that a file keeps.
const ROUNDED: f64 = 1.0 + 1e-9;

/// A failure of the check.
fn failed<T>(text: String) -> Result<T> {
    Err(Error::CheckFailed(format!("{text}; repeat the plan")))
}

/// Verifies a plan.
///
/// # Errors
///
/// [`Error::CheckFailed`] for an error beyond the tolerance, numbers that are not those that were
/// written, a proof that does not hold, or a cheaper candidate that is missing;
/// [`Error::BadInput`] for a file that makes no sense.
pub fn check(file: &PlanFile) -> Result<Checked> {
    let (task, lobe) = file.task()?;
    task.domain.pieces.iter().try_for_each(|piece| part_for(file, piece).map(drop))?;
    answers(file, &task)?;
    let truth = Truth::new(lobe);
    let worst = file
        .choice
        .iter()
        .map(|chosen| measured(chosen, &task, &truth))
        .collect::<Result<Vec<Worst>>>()?;
    // Bounds are written as the truth of the plan gives them.
    let whole = task.domain.whole();
    let error = whole.map_or(0.0, |(region, f0)| truth.error(&region, f0, task.tolerance));
    let slack = 1e-3 + 2.0 * error;
    let proofs = file.rejected.par_iter().enumerate();
    let proofs: Vec<Option<usize>> =
        proofs.map(|entry| proved(file, entry, &task, &truth, slack)).collect::<Result<_>>()?;
    is_complete(file, &task)?;
    Ok(Checked {
        worst,
        proved: proofs.iter().flatten().count(),
        multipliers: proofs.iter().flatten().sum(),
        not_found: proofs.iter().filter(|proof| proof.is_none()).count(),
    })
}

/// The number of the part of the choice in whose region a piece lies.
///
/// # Errors
///
/// [`Error::CheckFailed`] where there is none.
pub fn part_for(file: &PlanFile, piece: &Piece) -> Result<usize> {
    let within = |inner: [f64; 2], outer: [f64; 2]| outer[0] <= inner[0] && inner[1] <= outer[1];
    let holds =
        |chosen: &Chosen| within(piece.roughness, chosen.roughness) && within(piece.f0, chosen.f0);
    let [low, high] = piece.roughness;
    let none = || failed(format!("nothing in the choice is for roughness {low} to {high}"));
    file.choice.iter().position(holds).map_or_else(none, Ok)
}

/// Whether the choice is one for the whole domain, or one for each piece, of what was asked for.
fn answers(file: &PlanFile, task: &Task) -> Result<()> {
    let whole = task.domain.whole();
    let parts: Vec<([f64; 2], [f64; 2])> =
        file.choice.iter().map(|chosen| (chosen.roughness, chosen.f0)).collect();
    let pieces: Vec<([f64; 2], [f64; 2])> =
        task.domain.pieces.iter().map(|piece| (piece.roughness, piece.f0)).collect();
    let is_whole = whole.is_some_and(|(region, f0)| parts == [(region.roughness, f0)]);
    if !is_whole && parts != pieces {
        return failed("the choice is neither for the whole domain nor for each piece".into());
    }
    for chosen in &file.choice {
        let own = Candidate::named(&chosen.candidate)?;
        let texels = match own.shape {
            Shape::Texture { texels, .. } => texels,
            _ => Texels::Fitted,
        };
        let is_asked = task.sampler.is_none() || task.candidates(chosen.f0).contains(&own);
        if file.nodes != texels || !is_asked {
            return failed(format!("{own} is not what was asked for, or not {}", file.nodes));
        }
    }
    Ok(())
}

/// Whether texels that are said to be integrals are those.
fn has_integrals(approximation: &Approximation, truth: &Truth) -> bool {
    let own = Candidate::of(approximation);
    own.exact(truth, approximation.region)
        .is_none_or(|exact| exact.numbers == approximation.numbers)
}

/// The largest error of a part of the choice.
fn measured(chosen: &Chosen, task: &Task, truth: &Truth) -> Result<Worst> {
    let approximation = chosen.checked(task, truth.lobe())?;
    let worst = by_reference(&approximation, chosen.f0, task.tolerance, truth);
    if worst.share > 1.0 {
        let Worst { error, nov, roughness, f0, .. } = worst;
        return failed(format!(
            "E(F0) errs by {error:.2e} at n.v = {nov}, roughness {roughness}, F0 = {f0}: {:.3} of \
             the tolerance",
            worst.share
        ));
    }
    if !has_integrals(&approximation, truth) {
        return failed("a texel is not the integral at its place".into());
    }
    let own = bound(&approximation, chosen.f0, task.tolerance, chosen.worst, truth);
    let Some(stated) = chosen.bound else {
        return match own {
            None if worst.share <= PASSES * ROUNDED => Ok(worst),
            _ => failed("the bound of the error is missing".into()),
        };
    };
    match own {
        Some(own) if own.share <= stated.share.min(1.0) * ROUNDED && own.from <= stated.from => {
            Ok(Worst { bound: Some(own), ..worst })
        }
        own => failed(format!(
            "the bound of the error is {:.4} of the tolerance, not {:.4}",
            own.map_or(f64::INFINITY, |bound| bound.share),
            stated.share
        )),
    }
}

/// The largest error of an approximation at points of their own, by the reference rule.
pub fn by_reference(
    approximation: &Approximation,
    f0: [f64; 2],
    tolerance: Tolerance,
    truth: &Truth,
) -> Worst {
    let Approximation { region, shape, .. } = approximation;
    let mut points = verify::points_at(truth, region, shape, IN_A_SPAN, IN_ALL);
    let places: Vec<(f64, f64)> = points.iter().map(|point| (point.nov, point.roughness)).collect();
    let truths = Truth::by_reference(truth.lobe(), &places);
    let with_truth = |(point, truth): (&mut Sample, _)| point.truth = truth;
    points.iter_mut().zip(truths).for_each(with_truth);
    verify::measure(approximation, f0, tolerance, &points)
}

/// Verifies why a candidate was rejected: the number of multipliers, or none where no numbers were
/// found.
fn proved(
    file: &PlanFile,
    (index, rejected): (usize, &Rejected),
    task: &Task,
    truth: &Truth,
    slack: f64,
) -> Result<Option<usize>> {
    let own = Candidate::named(&rejected.candidate)?;
    match (rejected.bound, rejected.part_of, rejected.found) {
        (Some(bound), None, None) => {
            let proof: Vec<Multiplier> =
                rejected.proof.iter().map(|point| Multiplier::of(*point)).collect();
            let region = Region::new(task.domain.least_nov, rejected.roughness);
            let is_good = |point: &Multiplier| {
                let place = [point.nov, point.roughness, point.f0];
                is_inside(place, &region, rejected.f0) && point.weight.is_finite()
            };
            if !proof.iter().all(is_good) {
                return failed(format!("rejected {index}: a point lies outside of its region"));
            }
            let places: Vec<(f64, f64)> =
                proof.iter().map(|point| (point.nov, point.roughness)).collect();
            let truths = Truth::by_reference(truth.lobe(), &places);
            let claim = Claim { candidate: &own, region: &region, tolerance: task.tolerance };
            let holds = claim.bound(&proof, &truths);
            if holds <= 1.0 || holds < bound * (1.0 - slack) {
                return failed(format!(
                    "rejected {index}, {own}: the multipliers prove {holds:.4} of the tolerance \
                     at the least, not {bound:.4}"
                ));
            }
            Ok(Some(proof.len()))
        }
        (None, Some(other), None) => {
            let other = file.rejected.get(other).filter(|other| {
                other.bound.is_some()
                    && other.roughness == rejected.roughness
                    && other.f0 == rejected.f0
            });
            let includes = |other: &Rejected| -> Result<bool> {
                Ok(Candidate::named(&other.candidate)?.includes(&own))
            };
            match other.map(includes).transpose()? {
                Some(true) => Ok(Some(0)),
                _ => failed(format!("rejected {index}, {own}: it is no part of a failing entry")),
            }
        }
        (None, None, Some(_)) => match rejected.witness {
            None => Ok(None),
            Some(place) => witnessed(&own, rejected, place, task, truth).map(Some),
        },
        _ => failed(format!("rejected {index}, {own}: expected one of bound, part_of and found")),
    }
}

/// Whether n·v, roughness and F0 lie in a region and a range of F0; what is no number does not.
fn is_inside([nov, roughness, own]: [f64; 3], region: &Region, f0: [f64; 2]) -> bool {
    let within = |value: f64, [low, high]: [f64; 2]| low <= value && value <= high;
    within(nov, [region.least_nov, 1.0]) && within(roughness, region.roughness) && within(own, f0)
}

/// Verifies that a texture of integrals errs by more than the tolerance at a place: one point.
fn witnessed(
    candidate: &Candidate,
    rejected: &Rejected,
    [nov, roughness, f0]: [f64; 3],
    task: &Task,
    truth: &Truth,
) -> Result<usize> {
    let region = Region::new(task.domain.least_nov, rejected.roughness);
    if !is_inside([nov, roughness, f0], &region, rejected.f0) {
        return failed(format!("{candidate}: its witness lies outside of its region"));
    }
    let own = Truth::by_reference(truth.lobe(), &[(nov, roughness)])[0];
    let sample = Sample { nov, roughness, truth: own };
    let worst = candidate
        .exact(truth, region)
        .map(|approximation| verify::measure(&approximation, [f0, f0], task.tolerance, &[sample]));
    match worst {
        Some(worst) if worst.share > 1.0 => Ok(1),
        _ => failed(format!("{candidate}: n.v = {nov}, roughness {roughness} is no witness")),
    }
}

/// Whether every candidate that costs less than the choice is among the rejected.
fn is_complete(file: &PlanFile, task: &Task) -> Result<()> {
    let rejected: Vec<(Candidate, &Rejected)> = file
        .rejected
        .iter()
        .map(|entry| Ok((Candidate::named(&entry.candidate)?, entry)))
        .collect::<Result<_>>()?;
    let missing = |candidate: &Candidate| {
        failed(format!("{candidate} costs less than the choice, and is not among the rejected"))
    };
    let cost =
        |candidate: &Candidate, region: &Region| Cost::of(candidate, region).weighed(&task.weights);
    let limit = file.cost()?.weighed(&task.weights);
    let whole = task.domain.whole().filter(|(region, _)| task.is_over_roughness(region));
    if let Some((region, f0)) = whole {
        let known: std::collections::HashSet<String> = rejected
            .iter()
            .filter(|(_, entry)| entry.roughness == region.roughness && entry.f0 == f0)
            .map(|(candidate, _)| candidate.to_string())
            .collect();
        let candidates = task.candidates(f0);
        let cheaper = candidates.iter().filter(|candidate| cost(candidate, &region) < limit);
        for candidate in cheaper {
            if !known.contains(&candidate.to_string()) {
                return missing(candidate);
            }
        }
    }
    // One choice for several pieces is one over all roughnesses.
    let pieces = file.choice.iter().zip(&task.domain.pieces);
    let lines = pieces.filter(|(chosen, piece)| {
        let is_line = piece.roughness[0] == piece.roughness[1] && task.sampler.is_none();
        chosen.roughness == piece.roughness && is_line
    });
    for (chosen, piece) in lines {
        let region = task.domain.region_of(piece);
        let limit = chosen.cost(task.domain.least_nov)?.weighed(&task.weights);
        let own: Vec<&(Candidate, &Rejected)> =
            rejected.iter().filter(|(_, entry)| is_of(entry, piece)).collect();
        let covers = |(other, entry): &&(Candidate, &Rejected), candidate: &Candidate| {
            // Numbers that were not found say nothing of another storage.
            let is_same_storage = other.storage == candidate.storage;
            other.includes(candidate) && (entry.found.is_none() || is_same_storage)
        };
        let is_line = |candidate: &&Candidate| cost(candidate, &region) < limit;
        for candidate in all_lines(&region, piece.f0).iter().filter(is_line) {
            if !own.iter().any(|other| covers(other, candidate)) {
                return missing(candidate);
            }
        }
    }
    Ok(())
}

/// Whether an entry is about a piece.
fn is_of(entry: &Rejected, piece: &Piece) -> bool {
    entry.roughness == piece.roughness && entry.f0 == piece.f0
}

/// Every polynomial in n·v for a region and a range of F0.
fn all_lines(region: &Region, f0: [f64; 2]) -> Vec<Candidate> {
    let mut lines = Vec::new();
    for channels in candidate::channels(f0) {
        for x in candidate::along(region) {
            let second = if channels.count() == 2 { MOST_POWERS } else { 0 };
            for first in 0..=MOST_POWERS {
                for second in 0..=second {
                    if first + second > 0 {
                        lines.extend(Candidate::polynomials(channels, x, [first, second]));
                    }
                }
            }
        }
    }
    lines
}

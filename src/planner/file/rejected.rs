//! Why a candidate that costs less than the choice is not taken.

use crate::approximation::{Shape, Texels};
use crate::error::{Error, Result};
use crate::planner::fit::Multiplier;
use crate::planner::proof::Claim;
use crate::planner::search::{Outcome, Task, Trial, Verdict};
use crate::planner::truth::Truth;
use crate::planner::verify::Worst;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A candidate that costs less and does not do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rejected {
    /// What it is.
    pub candidate: String,
    /// The roughnesses that it would be for.
    pub roughness: [f64; 2],
    /// The F0 that it would be for.
    pub f0: [f64; 2],
    /// No numbers have a smaller largest error over its tolerance: more than 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<f64>,
    /// Its functions are among those of this entry, counted from 0, which fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part_of: Option<usize>,
    /// The numbers that were found have this largest error over its tolerance; others may have a
    /// smaller one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub found: Option<f64>,
    /// Where a texture of integrals errs by that: n·v, roughness and F0. It fails.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub witness: Option<[f64; 3]>,
    /// The proof of the bound: n·v, roughness, F0 and multiplier of each point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub proof: Vec<[f64; 4]>,
}

/// What costs less than the choice and was rejected.
pub(super) fn rejected(task: &Task, truth: &Truth, outcome: &Outcome) -> Result<Vec<Rejected>> {
    let limit = outcome.cost.weighed(&task.weights);
    let counts = |trial: &&Trial| match trial.verdict {
        // Polynomials with more numbers prove that those with fewer fail.
        Verdict::Fails { .. } => {
            let is_line = trial.region.roughness[0] == trial.region.roughness[1];
            is_line || trial.cost.weighed(&task.weights) < limit
        }
        Verdict::NotFound(_) => trial.cost.weighed(&task.weights) < limit,
        Verdict::Passes(_) => false,
    };
    let trials: Vec<&Trial> = outcome.trials.iter().filter(counts).collect();
    let includer = |index: usize| {
        let own = trials[index];
        let includes = |(place, other): (usize, &&Trial)| {
            let is_same = other.region == own.region && other.f0 == own.f0;
            let includes = place != index
                && is_same
                && matches!(other.verdict, Verdict::Fails { .. })
                && other.candidate.includes(&own.candidate)
                // Of two of the same shape the first has the proof.
                && (place < index || !own.candidate.includes(&other.candidate));
            includes.then_some(place)
        };
        trials.iter().enumerate().find_map(includes)
    };
    let includers: Vec<Option<usize>> = (0..trials.len()).into_par_iter().map(includer).collect();
    // What includes an entry may be part of another one: the last of them has the proof.
    let last_includer =
        |index: usize| std::iter::successors(includers[index], |&other| includers[other]).last();
    let text = |(index, trial): (usize, &&Trial)| {
        let mut text = Rejected {
            candidate: trial.candidate.to_string(),
            roughness: trial.region.roughness,
            f0: trial.f0,
            bound: None,
            part_of: None,
            found: None,
            witness: None,
            proof: Vec::new(),
        };
        match &trial.verdict {
            Verdict::Fails { proof, .. } => match last_includer(index) {
                Some(other) => text.part_of = Some(other),
                None => {
                    let claim = Claim {
                        candidate: &trial.candidate,
                        region: &trial.region,
                        tolerance: task.tolerance,
                    };
                    let Some((proof, bound)) = claim.shortened(proof, truth) else {
                        let text = format!("the proof that {} fails is lost", trial.candidate);
                        return Err(Error::Internal(text));
                    };
                    text.bound = Some(bound);
                    text.proof = proof.iter().map(Multiplier::array).collect();
                }
            },
            Verdict::NotFound(worst) | Verdict::Passes(worst) => {
                let bound = worst.bound.map_or(0.0, |bound| bound.share);
                text.found = Some(worst.share.max(bound));
                let is_exact =
                    matches!(trial.candidate.shape, Shape::Texture { texels: Texels::Exact, .. });
                let Worst { nov, roughness, f0, .. } = *worst;
                // Nearer to the tolerance the truth itself may be on the other side.
                text.witness =
                    (is_exact && worst.share > outcome.fails).then_some([nov, roughness, f0]);
            }
        }
        Ok(text)
    };
    trials.par_iter().enumerate().map(text).collect()
}

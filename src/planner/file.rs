//! A plan as a file: the question, the answer with its numbers, and why nothing cheaper is taken.

use super::bound::Bound;
use super::candidate::Candidate;
use super::cost::{Cost, Weights};
use super::domain::{Domain, Piece};
use super::fit::Multiplier;
use super::proof::Claim;
use super::search::{Outcome, Task, Trial, Verdict};
use super::tolerance::Tolerance;
use super::truth::Truth;
use super::verify::Worst;
use crate::approximation::{Approximation, Numbers, Region, Storage};
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::error::{Error, Result};
use crate::numeric::half::nearest;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    /// The tool and its version.
    pub tool: String,
    /// The command that repeats it.
    pub command: String,
    /// Control points and coefficients are fitted: they are no integrals at nodes.
    pub nodes: String,
    /// The question.
    pub question: Question,
    /// Files that are made of the choice, relative to the plan's folder.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outputs: Vec<Output>,
    /// One approximation for all roughnesses, or one for each.
    pub choice: Vec<Chosen>,
    /// Candidates that cost less.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rejected: Vec<Rejected>,
}

/// A file that is made of the choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Its name; its extension says what it is.
    pub file: String,
    /// What begins the names in code.
    pub prefix: String,
}

/// What was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    /// The distribution of normals.
    pub model: Ndf,
    /// The masking term.
    pub masking: Masking,
    /// The tolerance of E(F0).
    pub tolerance: String,
    /// The least n·v.
    pub least_nov: f64,
    /// What a byte, a load and an operation weigh.
    pub cost: String,
    /// The roughnesses and the F0 of the scene.
    pub pieces: Vec<PieceText>,
}

/// Lobes of one roughness or of one range of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PieceText {
    /// From the smoothest to the roughest.
    pub roughness: [f64; 2],
    /// F0 over F90, from the least to the largest.
    pub f0: [f64; 2],
    /// The materials.
    pub materials: Vec<String>,
}

/// An approximation with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chosen {
    /// What it is.
    pub candidate: String,
    /// The roughnesses that it is for.
    pub roughness: [f64; 2],
    /// The F0 that it is for.
    pub f0: [f64; 2],
    /// Bytes of its numbers.
    pub bytes: usize,
    /// The largest error of E(F0) over its tolerance that was measured.
    pub worst: f64,
    /// That error.
    pub error: f64,
    /// Its n·v, roughness and F0.
    pub place: [f64; 3],
    /// The number of points where it was measured.
    pub points: usize,
    /// What no lookup exceeds; none below the roughness where the truth is interpolated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<Bound>,
    /// BLAKE3 of the numbers: see [`Approximation::blake3`].
    pub blake3: String,
    /// The numbers of each channel.
    pub channels: Vec<ChannelText>,
}

/// The numbers of a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, deny_unknown_fields)]
pub enum ChannelText {
    /// offset + scale · code
    Codes {
        /// The value of code 0.
        offset: f32,
        /// The step from a code to the next.
        scale: f32,
        /// The codes.
        codes: Vec<u16>,
    },
    /// Floats.
    Floats {
        /// The numbers.
        floats: Vec<f32>,
    },
    /// Halves.
    Halves {
        /// The numbers.
        halves: Vec<f32>,
    },
}

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
    /// The proof of the bound: n·v, roughness, F0 and multiplier of each point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub proof: Vec<[f64; 4]>,
}

impl Chosen {
    fn new(approximation: &Approximation, worst: &Worst, f0: [f64; 2]) -> Self {
        let text = |numbers: &Numbers| match numbers {
            Numbers::Floats(floats) => ChannelText::Floats { floats: floats.clone() },
            Numbers::Halves(halves) => ChannelText::Halves { halves: halves.clone() },
            Numbers::Codes { offset, scale, codes, .. } => {
                ChannelText::Codes { offset: *offset, scale: *scale, codes: codes.clone() }
            }
        };
        Chosen {
            candidate: Candidate::of(approximation).to_string(),
            roughness: approximation.region.roughness,
            f0,
            bytes: approximation.bytes(),
            worst: worst.share,
            error: worst.error,
            place: [worst.nov, worst.roughness, worst.f0],
            points: worst.points,
            bound: worst.bound,
            blake3: approximation.blake3(),
            channels: approximation.numbers.iter().map(text).collect(),
        }
    }
}

impl PlanFile {
    /// The file of an outcome: proofs are shortened, and left out where another one includes them.
    pub fn new(task: &Task, truth: &Truth, outcome: &Outcome, command: String) -> Result<Self> {
        let lobe = truth.lobe();
        let piece = |piece: &Piece| PieceText {
            roughness: piece.roughness,
            f0: piece.f0,
            materials: piece.materials.clone(),
        };
        let question = Question {
            model: lobe.ndf,
            masking: lobe.masking,
            tolerance: task.tolerance.words(),
            least_nov: task.domain.least_nov,
            cost: task.weights.to_string(),
            pieces: task.domain.pieces.iter().map(piece).collect(),
        };
        let f0_of = |region: &Region| {
            let piece = task.domain.pieces.iter().find(|piece| piece.roughness == region.roughness);
            match (piece, task.domain.whole()) {
                (Some(piece), _) if outcome.choice.len() > 1 => piece.f0,
                (_, Some((_, f0))) => f0,
                (_, None) => [0.0, 1.0],
            }
        };
        let chosen = |(approximation, worst): &(Approximation, Worst)| {
            Chosen::new(approximation, worst, f0_of(&approximation.region))
        };
        Ok(PlanFile {
            tool: crate::lookup::TOOL.to_owned(),
            command,
            nodes: "fitted".into(),
            question,
            outputs: Vec::new(),
            choice: outcome.choice.iter().map(chosen).collect(),
            rejected: rejected(task, truth, outcome)?,
        })
    }

    /// The question.
    pub fn task(&self) -> Result<(Task, Microfacet)> {
        let Question { model, masking, tolerance, least_nov, cost, pieces } = &self.question;
        let within = |range: &[f64; 2]| {
            range[0] <= range[1] && range.iter().all(|end| (0.0..=1.0).contains(end))
        };
        let piece = |text: &PieceText| {
            if within(&text.roughness) && within(&text.f0) {
                let PieceText { roughness, f0, materials } = text.clone();
                return Ok(Piece { materials, roughness, f0 });
            }
            let got = format!("roughness {:?}, F0 {:?}", text.roughness, text.f0);
            Err(Error::bad_input("pieces", "ranges within [0, 1]", got, "repeat the plan"))
        };
        if !(0.0..1.0).contains(least_nov) || pieces.is_empty() {
            let got = format!("{least_nov} and {} pieces", pieces.len());
            let expected = "least_nov from 0 to below 1, and at least one piece";
            return Err(Error::bad_input("question", expected, got, "repeat the plan"));
        }
        let pieces = pieces.iter().map(piece).collect::<Result<_>>()?;
        let task = Task {
            domain: Domain { least_nov: *least_nov, pieces },
            tolerance: Tolerance::named(tolerance)?,
            weights: Weights::named(cost)?,
        };
        Ok((task, Microfacet::new(*model, Some(*masking))?))
    }

    /// The approximations of the choice. An error where their numbers are not those that were
    /// written.
    pub fn approximations(&self) -> Result<Vec<Approximation>> {
        let (task, lobe) = self.task()?;
        self.choice.iter().map(|chosen| chosen.checked(&task, lobe)).collect()
    }
}

impl Chosen {
    /// The approximation, with the numbers that were written.
    pub fn checked(&self, task: &Task, lobe: Microfacet) -> Result<Approximation> {
        let approximation = self.approximation(task, lobe)?;
        let hash = approximation.blake3();
        if self.blake3 == hash {
            return Ok(approximation);
        }
        Err(Error::CheckFailed(format!(
            "the numbers of the choice are not those that were written: their BLAKE3 is {hash}, \
             not {}; repeat the plan",
            self.blake3
        )))
    }

    /// The approximation.
    pub fn approximation(&self, task: &Task, lobe: Microfacet) -> Result<Approximation> {
        let Candidate { channels, shape, counts, storage } = Candidate::named(&self.candidate)?;
        let region = Region::new(task.domain.least_nov, self.roughness);
        let wrong = |expected: String, got: String| {
            Err(Error::bad_input("choice", expected, got, "repeat the plan"))
        };
        if self.channels.len() != channels.count() {
            return wrong(
                format!("{} channels", channels.count()),
                self.channels.len().to_string(),
            );
        }
        let numbers = self.channels.iter().map(|text| match (text, storage.last()) {
            (ChannelText::Floats { floats }, None) if storage == Storage::F32 => {
                Some(Numbers::Floats(floats.clone()))
            }
            (ChannelText::Halves { halves }, None) if storage == Storage::F16 => {
                let is_half = |half: &f32| nearest(f64::from(*half)) == f64::from(*half);
                halves.iter().all(is_half).then(|| Numbers::Halves(halves.clone()))
            }
            (ChannelText::Codes { offset, scale, codes }, Some(last))
                if codes.iter().all(|code| *code <= last) =>
            {
                let codes = codes.clone();
                Some(Numbers::Codes { offset: *offset, scale: *scale, last, codes })
            }
            _ => None,
        });
        let Some(numbers) = numbers.collect::<Option<Vec<Numbers>>>() else {
            return wrong(format!("numbers in {storage}"), "others".into());
        };
        if numbers.iter().zip(counts).any(|(numbers, count)| numbers.len() != count) {
            let got = numbers.iter().map(|numbers| numbers.len().to_string());
            let got = got.collect::<Vec<_>>().join(" and ");
            return wrong(format!("{} and {} numbers", counts[0], counts[1]), got);
        }
        Ok(Approximation { lobe, region, channels, shape, numbers })
    }
}

/// What costs less than the choice and was rejected.
fn rejected(task: &Task, truth: &Truth, outcome: &Outcome) -> Result<Vec<Rejected>> {
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
            let is_failing = matches!(other.verdict, Verdict::Fails { .. });
            let is_same = other.region == own.region && other.f0 == own.f0;
            // Of two of the same shape the first has the proof.
            let is_back = own.candidate.includes(&other.candidate) && place > index;
            let includes = other.candidate.includes(&own.candidate);
            (place != index && is_failing && is_same && includes && !is_back).then_some(place)
        };
        trials.iter().enumerate().find_map(includes)
    };
    // What includes an entry may be part of another one: the last of them has the proof.
    let last_includer =
        |index: usize| std::iter::successors(includer(index), |&other| includer(other)).last();
    let text = |(index, trial): (usize, &&Trial)| {
        let mut text = Rejected {
            candidate: trial.candidate.to_string(),
            roughness: trial.region.roughness,
            f0: trial.f0,
            bound: None,
            part_of: None,
            found: None,
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
            }
        }
        Ok(text)
    };
    trials.par_iter().enumerate().map(text).collect()
}

impl PlanFile {
    /// The cost of the choice.
    pub fn cost(&self) -> Result<Cost> {
        let least_nov = self.question.least_nov;
        let cost = |chosen: &Chosen| chosen.cost(least_nov);
        self.choice.iter().try_fold(Cost::default(), |sum, chosen| Ok(sum + cost(chosen)?))
    }
}

impl Chosen {
    /// The cost of this part alone.
    pub fn cost(&self, least_nov: f64) -> Result<Cost> {
        let region = Region::new(least_nov, self.roughness);
        Ok(Cost::of(&Candidate::named(&self.candidate)?, &region))
    }
}

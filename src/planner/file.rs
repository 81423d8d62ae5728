//! A plan as a file: the question, the answer with its numbers, and why nothing cheaper is taken.

mod rejected;

pub use rejected::Rejected;

use super::bound::Bound;
use super::candidate::Candidate;
use super::cost::{Cost, Weights};
use super::domain::{Domain, Piece};
use super::search::{Outcome, Task};
use super::tolerance::Tolerance;
use super::truth::Truth;
use super::verify::Worst;
use crate::approximation::{
    Approximation, Channels, Numbers, Region, Sampler, Shape, Storage, Texels,
};
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::error::{Error, Result};
use crate::numeric::half::nearest;
use serde::{Deserialize, Serialize};

/// A plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    /// The tool and its version.
    pub tool: String,
    /// The command that repeats it.
    pub command: String,
    /// Control points, coefficients and texels are fitted, or integrals at their nodes.
    pub nodes: Texels,
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
    /// The texture that a shader reads, where it has to stay as it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sampler: Option<SamplerText>,
    /// The roughnesses and the F0 of the scene.
    pub pieces: Vec<PieceText>,
}

/// The texture that a shader reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SamplerText {
    /// Its channels.
    pub channels: Channels,
    /// Its axes.
    pub axes: [String; 2],
    /// Its storage, where one is wished for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub storage: Option<Storage>,
}

impl SamplerText {
    fn new(sampler: &Sampler) -> Self {
        let Sampler { channels, axes, storage } = *sampler;
        SamplerText { channels, axes: axes.map(|axis| axis.to_string()), storage }
    }

    fn sampler(&self) -> Result<Sampler> {
        let [x, y] = &self.axes;
        Sampler::new(self.channels, [x.parse()?, y.parse()?], self.storage)
    }
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
            sampler: task.sampler.as_ref().map(SamplerText::new),
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
            nodes: match outcome.choice.first().map(|(approximation, _)| approximation.shape) {
                Some(Shape::Texture { texels, .. }) => texels,
                _ => Texels::Fitted,
            },
            question,
            outputs: Vec::new(),
            choice: outcome.choice.iter().map(chosen).collect(),
            rejected: rejected::rejected(task, truth, outcome)?,
        })
    }

    /// The question.
    pub fn task(&self) -> Result<(Task, Microfacet)> {
        let Question { model, masking, tolerance, least_nov, cost, sampler, pieces } =
            &self.question;
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
            sampler: sampler.as_ref().map(SamplerText::sampler).transpose()?,
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

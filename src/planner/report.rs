//! A plan in lines for people.

use super::bound::Bound;
use super::candidate::Candidate;
use super::engines::Engine;
use super::file::{PlanFile, Rejected};
use super::model_errors::{EXACT_FRESNEL, JOINT_TERM, MULTIPLE_SCATTERING, ModelError};
use super::tolerance::Tolerance;
use crate::approximation::{Along, Channels, Region, Shape, Storage, Texels};
use crate::error::Result;
use crate::scene::{Lobe, Scene};
use serde::Serialize;
use std::fmt::Write;

/// Everything that is said of a plan.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scenes, as they were read.
    pub scenes: Vec<SceneText>,
    /// The plan.
    pub plan: PlanFile,
    /// What the model leaves out.
    pub model_errors: Vec<ModelError>,
    /// What the tables of engines give for the same.
    pub engines: Vec<Engine>,
    /// Seconds of the search, with its proofs.
    pub seconds: f64,
}

/// A scene as it was read.
#[derive(Clone, Debug, Serialize)]
pub struct SceneText {
    /// The file.
    pub name: String,
    /// Its lobes.
    pub lobes: Vec<LobeText>,
    /// What was assumed, or could not be read.
    pub notes: Vec<String>,
}

/// A lobe as it was read.
#[derive(Clone, Debug, Serialize)]
pub struct LobeText {
    /// The material.
    pub material: String,
    /// The layer.
    pub layer: crate::scene::Layer,
    /// Perceptual roughness.
    pub roughness: [f64; 2],
    /// F0.
    pub f0: [f64; 2],
    /// F90.
    pub f90: [f64; 2],
    /// Of texels by sixteenths of roughness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub histogram: Option<[u64; 16]>,
    /// What was read from where.
    pub from: Vec<String>,
}

impl SceneText {
    /// The text of a scene.
    pub fn new(scene: &Scene) -> Self {
        let lobe = |lobe: &Lobe| LobeText {
            material: lobe.material.clone(),
            layer: lobe.layer,
            roughness: [lobe.roughness.low, lobe.roughness.high],
            f0: [lobe.f0.low, lobe.f0.high],
            f90: [lobe.f90.low, lobe.f90.high],
            histogram: lobe.histogram,
            from: lobe.from.clone(),
        };
        SceneText {
            name: scene.name.clone(),
            lobes: scene.lobes.iter().map(lobe).collect(),
            notes: scene.notes.clone(),
        }
    }
}

impl Bound {
    /// What it says, of a choice from this roughness on.
    pub fn text(&self, smoothest: f64) -> String {
        let share = (1e4 * self.share).ceil() * 1e-4;
        let from = match self.from > smoothest {
            true => format!(" from roughness {:.4} on", self.from),
            false => String::new(),
        };
        format!("proved: no lookup{from} errs by more than {share:.4} of the tolerance")
    }
}

/// A range in short.
pub fn range([low, high]: [f64; 2]) -> String {
    let short = |value: f64| {
        let text = format!("{value:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    if low == high { short(low) } else { format!("{}..{}", short(low), short(high)) }
}

/// A coordinate along n·v in a formula.
fn along(x: Along) -> String {
    match x {
        Along::Nov => "n.v".into(),
        Along::Sqrt => "sqrt(n.v)".into(),
        Along::Cbrt => "cbrt(n.v)".into(),
        Along::Log => "n.v log2(1 + 1/n.v)".into(),
        Along::Layer(k) => format!("T = sqrt(n.v (1 + {k} alpha)/(n.v + {k} alpha))"),
    }
}

/// The variable of a polynomial in n·v.
fn centred(x: Along) -> String {
    match x {
        Along::Layer(_) => format!("2 T - 1, {}", along(x)),
        _ => format!("2 {} - 1", along(x)),
    }
}

/// A candidate in words.
pub fn in_words(candidate: &Candidate) -> String {
    let Candidate { channels, shape, counts, storage } = candidate;
    let numbers = match channels.count() {
        1 => format!("{}", counts[0]),
        _ => format!("{} + {}", counts[0], counts[1]),
    };
    let channels = match channels {
        Channels::Albedo => "E(F0)",
        Channels::Ratio => "W, E(F0) = F W",
        Channels::EnergyRest => "(E, R), E(F0) = F E + (1 - F0) R",
        Channels::ScaleBias => "(A, B), E(F0) = F0 A + B",
        Channels::BiasEnergy => "(B, E), E(F0) = (1 - F0) B + F0 E",
    };
    let bits = match storage {
        Storage::F32 => "floats",
        Storage::F16 => "halves",
        Storage::Unorm16 => "numbers of 16 bits",
        Storage::Unorm8 => "numbers of 8 bits",
    };
    match *shape {
        Shape::Polynomial { x } => {
            format!("polynomial in {} of {channels}: {numbers} {bits}", centred(x))
        }
        Shape::Surface { x, y, columns } => format!(
            "polynomial in {} and {} of {channels}: {columns} x {} powers, {numbers} {bits}",
            along(x),
            y.word(),
            counts[0] / columns
        ),
        Shape::Texture { x, y, texels } => {
            let texels = if texels == Texels::Exact { "integrals at its texels" } else { "fitted" };
            let (size, axes) = ([x.size(), y.size()], [x.spec(), y.spec()]);
            format!(
                "texture of {} x {} over {} and {}, {texels}; {channels}: {bits}",
                size[0], size[1], axes[0], axes[1]
            )
        }
        Shape::Spline { x, y, size: [columns, rows], degree } => {
            let kind = ["bilinear net", "quadratic B-spline", "cubic B-spline"][degree - 1];
            let across = match y.word().as_str() {
                "sqrt" => "sqrt(roughness)".to_owned(),
                word => word.to_owned(),
            };
            format!(
                "{kind} of {columns} x {rows} control points over {} and {across}; {channels}: \
                 {bits}",
                along(x)
            )
        }
    }
}

/// Lines of scenes that are shown; the JSON has all.
const MOST_LINES: usize = 24;

impl Report {
    /// The report in lines.
    pub fn text(&self) -> Result<String> {
        let mut text = String::new();
        for scene in &self.scenes {
            scene.write(&mut text);
        }
        let question = &self.plan.question;
        let tolerance = Tolerance::named(&question.tolerance)?;
        let pieces = &question.pieces;
        let shown = |part: fn(&super::file::PieceText) -> [f64; 2]| {
            let mut ranges: Vec<String> = pieces.iter().map(|piece| range(part(piece))).collect();
            ranges.dedup();
            let more = ranges.len().saturating_sub(8);
            ranges.truncate(8);
            let list = ranges.join(", ");
            if more == 0 { list } else { format!("{list} and {more} more") }
        };
        let least = question.least_nov;
        let lines = &mut text;
        let (roughness, f0) = (shown(|piece| piece.roughness), shown(|piece| piece.f0));
        let _ = writeln!(lines, "domain    roughness {roughness}; F0 {f0}; n.v from {least}");
        let _ = writeln!(lines, "tolerance {tolerance} in E(F0)");
        for chosen in &self.plan.choice {
            let candidate = Candidate::named(&chosen.candidate)?;
            let region = Region::new(least, chosen.roughness);
            let every = if region.least_nov < least { ", every n.v" } else { "" };
            let roughness = range(chosen.roughness);
            let words = in_words(&candidate);
            let _ = writeln!(lines, "choice    roughness {roughness}{every}: {words}");
            let [nov, at, f0] = chosen.place;
            let _ = writeln!(
                lines,
                "          {} bytes; error {:.2e} at the most, {:.2} of the tolerance, measured \
                 at {} points; the worst is at n.v = {nov:.4}, roughness {at:.4}, F0 = {f0}",
                chosen.bytes,
                chosen.error.abs(),
                chosen.worst,
                chosen.points
            );
            if let Some(bound) = chosen.bound {
                let _ = writeln!(lines, "          {}", bound.text(chosen.roughness[0]));
            }
        }
        let cost = self.plan.cost()?;
        let _ = writeln!(
            lines,
            "cost      {} bytes, {} loads, {} operations for a lookup; weighed {}",
            cost.bytes, cost.loads, cost.operations, question.cost
        );
        let _ = writeln!(lines, "cheaper   {}", self.cheaper());
        for error in &self.model_errors {
            error.write(lines, tolerance);
        }
        for engine in &self.engines {
            let _ = writeln!(lines, "beside    {engine}");
        }
        let _ = write!(lines, "time      {:.0} ms", 1e3 * self.seconds);
        Ok(text)
    }

    /// What became of cheaper candidates.
    pub fn cheaper(&self) -> String {
        let rejected = &self.plan.rejected;
        let is_open = |entry: &&Rejected| entry.found.is_some() && entry.witness.is_none();
        let not_found = rejected.iter().filter(is_open).count();
        let failing = rejected.len() - not_found;
        let found = match not_found {
            0 => String::new(),
            count => format!("; of {count} the numbers that were found miss it, others may not"),
        };
        format!(
            "{failing} candidates are proved to miss the tolerance whatever their numbers \
             are{found}"
        )
    }
}

impl SceneText {
    fn write(&self, lines: &mut String) {
        let materials: std::collections::BTreeSet<&str> =
            self.lobes.iter().map(|lobe| &*lobe.material).collect();
        let (materials, lobes) = (materials.len(), self.lobes.len());
        let _ = writeln!(lines, "scene     {}: {materials} materials, {lobes} lobes", self.name);
        for lobe in self.lobes.iter().take(MOST_LINES) {
            let (roughness, f0) = (range(lobe.roughness), range(lobe.f0));
            let f90 = match lobe.f90 {
                [1.0, 1.0] => String::new(),
                f90 => format!(", F90 {}", range(f90)),
            };
            let LobeText { material, layer, .. } = lobe;
            let _ = writeln!(
                lines,
                "          {material}, {layer}: roughness {roughness}, F0 {f0}{f90}"
            );
            for from in &lobe.from {
                let _ = writeln!(lines, "            {from}");
            }
        }
        if self.lobes.len() > MOST_LINES {
            let _ = writeln!(lines, "          and {} more", self.lobes.len() - MOST_LINES);
        }
        for note in &self.notes {
            let _ = writeln!(lines, "note      {note}");
        }
    }
}

impl ModelError {
    fn write(&self, lines: &mut String, tolerance: Tolerance) {
        let ModelError { what, error, nov, roughness, f0 } = self;
        let advice = self.advice(tolerance);
        let _ = writeln!(
            lines,
            "model     without {what}: E(F0) errs by {error:+.4} at n.v = {nov:.3}, roughness \
             {roughness:.3}, F0 = {f0:.3}; {advice}"
        );
    }

    /// What follows.
    pub fn advice(&self, tolerance: Tolerance) -> &'static str {
        let is_small = match tolerance {
            Tolerance::Absolute(allowed) => self.error.abs() <= allowed,
            // A share, or steps at some radiance: what is left out is compared with a step.
            _ => self.error.abs() <= 2e-3,
        };
        match (self.what, is_small) {
            (_, true) => "within the tolerance, leave it out",
            (MULTIPLE_SCATTERING, false) => "add it (Turquin 2019; Fdez-Aguera 2019)",
            (EXACT_FRESNEL, false) => {
                "a smaller tolerance of the table gains nothing unless the model is exact too"
            }
            (JOINT_TERM, false) => "keep the correlated term",
            _ => "it matters more than the table",
        }
    }
}

//! Where the choice errs: a map over n·v and roughness, or lines along n·v for constants.

use super::super::file::{Chosen, PieceText};
use super::super::report::{Report, range};
use super::super::samples::{Sample, Spread, on_grid};
use super::super::search::Outcome;
use super::super::tolerance::Tolerance;
use super::super::truth::Truth;
use super::svg::{Frame, Svg, apart};
use crate::approximation::{Across, Along, Approximation, Region};
use crate::error::Result;
use crate::html::{address_of, cut, escape, list, short};
use crate::image::{Picture, diverging};
use crate::numeric::lanes::{F32x16, Vector};
use rayon::prelude::*;

/// Pixels along either side of a map, and places along a line.
const PIXELS: usize = 256;

/// Charts of constants.
const MOST_CHARTS: usize = 12;

/// Both show the corner at grazing angles and small roughness.
const COORDINATES: (Along, Across) = (Along::Cbrt, Across::Sqrt);

/// A place that is marked: n·v, roughness and F0.
type Place = [f64; 3];

/// An approximation and what a picture of it needs.
struct Shown<'a> {
    approximation: &'a Approximation,
    chosen: &'a Chosen,
    tolerance: Tolerance,
}

/// The section of errors.
pub fn section(report: &Report, outcome: &Outcome, truth: &Truth) -> Result<String> {
    let plan = &report.plan;
    let tolerance = Tolerance::named(&plan.question.tolerance)?;
    let pairs = outcome.choice.iter().zip(&plan.choice);
    let mut shown: Vec<Shown> = pairs
        .map(|((approximation, _), chosen)| Shown { approximation, chosen, tolerance })
        .collect();
    let mut text = "<h2>Where it errs</h2>\n".to_owned();
    let is_constant = |shown: &Shown| shown.chosen.roughness[0] == shown.chosen.roughness[1];
    if !shown.iter().all(is_constant) {
        for part in &shown {
            text += &part.maps(&plan.question.pieces, truth)?;
        }
        return Ok(text);
    }
    let count = shown.len();
    shown.sort_by(|a, b| b.chosen.worst.total_cmp(&a.chosen.worst));
    shown.truncate(MOST_CHARTS);
    shown.sort_by(|a, b| a.chosen.roughness[0].total_cmp(&b.chosen.roughness[0]));
    text += "<p>The error of E(F0) in units of the tolerance, against n·v, spaced by its cube \
             root so that grazing angles are seen: below 0 the lookup is too dark, above 0 too \
             bright. Dashed lines are the tolerance; <span style=\"color:var(--blue)\">blue</span> \
             is the least F0, <span style=\"color:var(--orange)\">orange</span> the largest. The \
             ring is the worst place.</p>\n";
    if count > shown.len() {
        text += &format!(
            "<p class=\"dim\">Shown are the {MOST_CHARTS} of {count} with the largest errors.</p>\n"
        );
    }
    text += "<div class=\"row\">\n";
    for part in &shown {
        text += &part.chart(&plan.question.pieces, truth);
    }
    Ok(text + "</div>\n")
}

/// The share of the way along n·v where it lies.
fn share_of_nov(region: &Region, nov: f64) -> f64 {
    let share: f64 = COORDINATES.0.at(region.least_nov, nov, 1.0);
    share.clamp(0.0, 1.0)
}

/// Ticks of n·v on an axis of this length.
fn ticks_of_nov(region: &Region, length: f64) -> Vec<(f64, String)> {
    let wished = [region.least_nov, 1.0, 0.1, 0.01, 0.5, 0.001, 0.2, 0.05, 0.02, 0.7, 0.3];
    let within: Vec<f64> = wished.into_iter().filter(|&nov| nov >= region.least_nov).collect();
    let place = |nov: f64| length * share_of_nov(region, nov);
    let kept = apart(&within, place, 34.0);
    kept.into_iter().map(|nov| (share_of_nov(region, nov), short(nov))).collect()
}

impl Shown<'_> {
    /// The errors at points, over the tolerance: the approximation less the truth.
    fn errors(&self, f0: f64, points: &[Sample]) -> Vec<f64> {
        let of_chunk = |chunk: &[Sample]| -> Vec<f64> {
            let last = chunk.len() - 1;
            let nov = F32x16::gather(|i| chunk[i.min(last)].nov);
            let roughness = F32x16::gather(|i| chunk[i.min(last)].roughness);
            let albedo = self.approximation.albedo(nov, roughness, F32x16::from(f0));
            let of_lane = |(i, sample): (usize, &Sample)| {
                let truth = sample.truth.at(f0);
                (albedo.lane(i) - truth) / self.tolerance.at(truth)
            };
            chunk.iter().enumerate().map(of_lane).collect()
        };
        points.par_chunks(16).flat_map_iter(of_chunk).collect()
    }

    fn points(&self, truth: &Truth) -> Vec<Sample> {
        let spread = [Spread::Even(PIXELS - 1); 2];
        on_grid(truth, &self.approximation.region, COORDINATES, (spread, [1, 1]))
    }

    /// Both ends of the range of F0, or its one value.
    fn f0(&self) -> Vec<f64> {
        let [low, high] = self.chosen.f0;
        if low == high { vec![low] } else { vec![low, high] }
    }

    /// Maps at both ends of the range of F0.
    fn maps(&self, pieces: &[PieceText], truth: &Truth) -> Result<String> {
        let points = self.points(truth);
        let mut text = "<p>The error of E(F0) in units of the tolerance. Blue is too dark, orange \
                        too bright, white is right. n·v is spaced by its cube root and roughness \
                        by its square root, so that the corner of grazing angles and smooth \
                        surfaces is seen. Values of F0 between these have no larger errors.</p>\n\
                        <figure>\n<div class=\"row\">\n"
            .to_owned();
        for f0 in self.f0() {
            text += &self.map(f0, &self.errors(f0, &points), pieces)?;
        }
        text += "</div>\n";
        text += &scale()?;
        let [nov, roughness, f0] = self.chosen.place;
        text += &format!(
            "<figcaption>The ring is the worst place that was measured: {} of the tolerance at \
             n·v = {}, roughness {}, F0 = {}. Marks at the right edge of a map are the roughnesses \
             that the scene has.</figcaption>\n</figure>\n",
            short(self.chosen.worst),
            short(nov),
            short(roughness),
            short(f0)
        );
        Ok(text)
    }

    fn map(&self, f0: f64, errors: &[f64], pieces: &[PieceText]) -> Result<String> {
        let region = &self.approximation.region;
        let mut picture = Picture::new(PIXELS, PIXELS, [0; 3]);
        for (i, &error) in errors.iter().enumerate() {
            picture.set(i % PIXELS, PIXELS - 1 - i / PIXELS, diverging(error));
        }
        let frame = Frame { left: 52.0, top: 28.0, width: 340.0, height: 340.0 };
        let mut svg = Svg::new(430.0, 412.0);
        svg.image(frame, &address_of(&picture)?);
        let share = |roughness: f64| COORDINATES.1.at(region, roughness).clamp(0.0, 1.0);
        let [low, high] = region.roughness;
        let wished = [low, high, 0.1, 0.5, 0.2, 0.3, 0.05, 0.7, 0.02, 0.4, 0.6, 0.8];
        let within: Vec<f64> = wished.into_iter().filter(|r| (low..=high).contains(r)).collect();
        let kept = apart(&within, |r| frame.height * share(r), 24.0);
        let ticks: Vec<(f64, String)> = kept.into_iter().map(|r| (share(r), short(r))).collect();
        svg.ticks_beside(frame, &ticks, false);
        svg.ticks_below(frame, &ticks_of_nov(region, frame.width), false);
        svg.frame(frame);
        svg.text([frame.left - 34.0, 16.0], "d", "roughness");
        svg.text([frame.left + 0.5 * frame.width, 16.0], "m b", &format!("F0 = {}", short(f0)));
        svg.text([frame.left + 0.5 * frame.width, 404.0], "d m", "n·v");
        for piece in pieces.iter().take(64) {
            let ends = piece.roughness.map(|r| frame.at([1.0, share(r)])[1]);
            let x = frame.left + frame.width + 6.0;
            let size = [4.0, (ends[0] - ends[1]).max(3.0)];
            let title = format!("roughness {}", range(piece.roughness));
            svg.rectangle([x, ends[1].min(ends[0] - 1.5)], size, "ink", &title);
        }
        let [nov, roughness, worst_f0]: Place = self.chosen.place;
        if worst_f0 == f0 {
            svg.ring(frame.at([share_of_nov(region, nov), share(roughness)]));
        }
        Ok(svg.finish(&format!("Map of the error at F0 = {}", short(f0))))
    }

    /// A chart for a constant roughness.
    fn chart(&self, pieces: &[PieceText], truth: &Truth) -> String {
        let region = &self.approximation.region;
        let points = self.points(truth);
        let frame = Frame { left: 34.0, top: 26.0, width: 240.0, height: 120.0 };
        let mut svg = Svg::new(286.0, 184.0);
        let share = |error: f64| (0.5 + error / 2.5).clamp(0.0, 1.0);
        let level = |error: f64| [frame.at([0.0, share(error)]), frame.at([1.0, share(error)])];
        let ticks = [-1.0, 0.0, 1.0].map(|error| (share(error), format!("{error}")));
        svg.ticks_beside(frame, &ticks, false);
        svg.ticks_below(frame, &ticks_of_nov(region, frame.width), true);
        for error in [-1.0, 1.0] {
            let [from, to] = level(error);
            svg.line("limit", from, to);
        }
        let [from, to] = level(0.0);
        svg.line("grid", from, to);
        let [nov, _, worst_f0]: Place = self.chosen.place;
        for (f0, class) in self.f0().into_iter().zip(["lines blues", "lines oranges"]) {
            let errors = self.errors(f0, &points);
            let place = |(point, error): (&Sample, f64)| {
                frame.at([share_of_nov(region, point.nov), share(error)])
            };
            svg.lines(class, points.iter().zip(errors).map(place));
            if worst_f0 == f0 {
                let signed = self.chosen.worst.copysign(self.chosen.error);
                svg.ring(frame.at([share_of_nov(region, nov), share(signed)]));
            }
        }
        svg.frame(frame);
        let own = pieces.iter().filter(|piece| piece.roughness == self.chosen.roughness);
        let names: Vec<&str> = own.flat_map(|piece| &piece.materials).map(|name| &**name).collect();
        let title = format!("roughness {}, F0 {}", range([region.roughness[0]; 2]), {
            range(self.chosen.f0)
        });
        svg.text([frame.left, 16.0], "b", &title);
        svg.text([frame.left + 0.5 * frame.width, 181.0], "d m", "n·v");
        format!(
            "<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n",
            svg.finish(&format!("Error against n·v at {title}")),
            escape(&cut(&list(&names, 3), 48))
        )
    }
}

/// The scale of colours of the maps.
fn scale() -> Result<String> {
    let mut picture = Picture::new(201, 1, [0; 3]);
    for x in 0..=200 {
        picture.set(x, 0, diverging((x as f64 - 100.0) / 100.0));
    }
    let frame = Frame { left: 52.0, top: 4.0, width: 340.0, height: 14.0 };
    let mut svg = Svg::new(430.0, 52.0);
    svg.image(frame, &address_of(&picture)?);
    svg.frame(frame);
    let ticks = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|at| (0.5 + 0.5 * at, format!("{at}")));
    svg.ticks_below(frame, &ticks, false);
    let [middle, bottom] = frame.at([0.5, 0.0]);
    svg.text([middle, bottom + 32.0], "d m", "error / tolerance");
    Ok(svg.finish("Scale of colours from -1 to 1 times the tolerance"))
}

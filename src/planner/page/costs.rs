//! Cost against error: every candidate that was tried, the choice, and the tables of engines.

use super::super::engines::Engine;
use super::super::report::Report;
use super::super::search::{Outcome, Trial, Verdict};
use super::svg::{Frame, Svg, apart};
use crate::error::Result;
use crate::html::{escape, short, whole};
use std::collections::BTreeSet;

/// Errors over the tolerance below this are drawn there.
const LEAST: f64 = 0.01;

/// The height of the parts.
const HEIGHT: f64 = 380.0;

/// Bytes, and the largest error over the tolerance.
type Point = [f64; 2];

/// How points of a kind are drawn.
#[derive(Clone, Copy)]
enum Mark {
    /// Nothing is better than this.
    Triangle,
    Cross,
    Dot,
}

impl Mark {
    fn class(self) -> &'static str {
        match self {
            Mark::Triangle => "orange",
            Mark::Cross => "lines dims",
            Mark::Dot => "blue",
        }
    }

    fn path(self, [x, y]: [f64; 2]) -> String {
        match self {
            Mark::Triangle => format!("M{:.1} {:.1}l3.4 6h-6.8z", x, y - 4.0),
            Mark::Cross => format!("M{:.1} {:.1}l6 6m0 -6l-6 6", x - 3.0, y - 3.0),
            Mark::Dot => format!("M{:.1} {y:.1}a3.4 3.4 0 1 0 6.8 0a3.4 3.4 0 1 0 -6.8 0", x - 3.4),
        }
    }
}

/// Two logarithmic axes in a frame.
struct Axes {
    frame: Frame,
    bytes: [f64; 2],
    errors: [f64; 2],
}

fn share([low, high]: [f64; 2], value: f64) -> f64 {
    ((value / low).ln() / (high / low).ln()).clamp(0.0, 1.0)
}

/// The ends of values on an axis, with a margin.
fn ends(values: impl Iterator<Item = f64> + Clone, margin: f64) -> [f64; 2] {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    let high = values.fold(low, f64::max);
    if low.is_finite() { [low / margin, high * margin] } else { [1.0 / margin, margin] }
}

impl Axes {
    fn at(&self, [bytes, error]: Point) -> [f64; 2] {
        self.frame.at([share(self.bytes, bytes), share(self.errors, error)])
    }

    /// Draws the axes and the tolerance; numbers of errors where there is no other part beside.
    fn draw(&self, svg: &mut Svg, name: &str, has_numbers: bool) {
        let frame = self.frame;
        let of_bytes = |value: f64| whole(value.round() as usize);
        let of_errors = |value: f64| if has_numbers { short(value) } else { String::new() };
        svg.ticks_below(frame, &ticks(self.bytes, frame.width / 48.0, of_bytes), true);
        svg.ticks_beside(frame, &ticks(self.errors, frame.height / 24.0, of_errors), true);
        svg.frame(frame);
        let [left, y] = self.at([self.bytes[0], 1.0]);
        svg.line("limit", [left, y], [left + frame.width, y]);
        let [middle, bottom] = frame.at([0.5, 0.0]);
        svg.text([middle, bottom + 36.0], "d m", name);
    }
}

/// At most about so many ticks: powers of ten, and between them where there is room.
fn ticks([low, high]: [f64; 2], most: f64, text: impl Fn(f64) -> String) -> Vec<(f64, String)> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let times = |factor: f64| powers.clone().map(move |power| factor * 10f64.powi(power));
    let values = [1.0, 2.0, 5.0, 3.0, 1.5, 7.0].into_iter().flat_map(times);
    let within: Vec<f64> = values.filter(|value| (low..=high).contains(value)).collect();
    let kept = apart(&within, |value| share([low, high], value), 1.0 / most);
    kept.into_iter().map(|value| (share([low, high], value), text(value))).collect()
}

/// What a trial is drawn as.
fn point(trial: &Trial) -> (Mark, Point) {
    let (mark, error) = match &trial.verdict {
        Verdict::Fails { bound, .. } => (Mark::Triangle, *bound),
        Verdict::NotFound(worst) => (Mark::Cross, worst.share),
        Verdict::Passes(worst) => (Mark::Dot, worst.share),
    };
    (mark, [trial.cost.bytes.max(1) as f64, error.max(LEAST)])
}

/// The section of costs.
pub fn section(report: &Report, outcome: &Outcome) -> Result<String> {
    let plan = &report.plan;
    let trials: Vec<(Mark, Point)> =
        outcome.trials.iter().map(point).filter(|(_, point)| point[1].is_finite()).collect();
    let chosen: Vec<Point> = (plan.choice.iter())
        .map(|chosen| [chosen.bytes.max(1) as f64, chosen.worst.max(LEAST)])
        .collect();
    let of_engine = |engine: &Engine| [engine.bytes as f64, engine.worst.max(LEAST)];
    let engines: Vec<Point> = report.engines.iter().map(of_engine).collect();
    let own = || trials.iter().map(|(_, point)| *point).chain(chosen.iter().copied());
    let all = own().chain(engines.iter().copied()).map(|point| point[1]);
    let errors = ends(all.chain([1.0]), 1.6);
    let part = |left, width, bytes| Axes {
        frame: Frame { left, top: 36.0, width, height: HEIGHT },
        bytes,
        errors,
    };
    let axes = part(56.0, 560.0, ends(own().map(|point| point[0]), 1.15));
    let beside = part(640.0, 232.0, ends(engines.iter().map(|point| point[0]), 2.0));
    let mut svg = Svg::new(900.0, 36.0 + HEIGHT + 44.0);
    axes.draw(&mut svg, "bytes of a candidate", true);
    beside.draw(&mut svg, "bytes of an engine's table", false);
    svg.text([6.0, 14.0], "d", "largest error / tolerance");
    let [x, y] = axes.at([axes.bytes[0], 1.0]);
    svg.text([x + 6.0, y + 16.0], "b", "tolerance");
    for mark in [Mark::Triangle, Mark::Cross, Mark::Dot] {
        let of_kind = trials.iter().filter(|(own, _)| own.class() == mark.class());
        // Marks at the same place are drawn once.
        let places: BTreeSet<[i64; 2]> =
            of_kind.map(|(_, point)| axes.at(*point).map(|at| (2.0 * at).round() as i64)).collect();
        let path: String =
            places.iter().map(|place| mark.path(place.map(|at| at as f64 / 2.0))).collect();
        if !path.is_empty() {
            svg.path(mark.class(), &path);
        }
    }
    for (i, place) in chosen.iter().map(|&point| axes.at(point)).enumerate().take(64) {
        svg.circle(place, 3.4, "blue");
        svg.circle(place, 8.0, "lines inks");
        if i == 0 && chosen.len() == 1 {
            let text = format!("the choice: {} bytes", plan.choice[0].bytes);
            svg.text([place[0], place[1] + 23.0], "m b", &text);
        }
    }
    let names = report.engines.iter().map(|engine| engine.name);
    let places = engines.iter().map(|&point| beside.at(point)).zip(names).collect();
    label(&mut svg, beside.frame, places);
    legend(&mut svg);
    Ok(format!(
        "<h2>Cost against error</h2>\n<figure>\n<div class=\"wide\">{}</div>\n\
         <figcaption>{}</figcaption>\n</figure>\n",
        svg.finish("Bytes and largest errors of the candidates that were tried"),
        caption(report, outcome)
    ))
}

/// A box: left, top, right and bottom.
type Extent = [f64; 4];

fn overlap(a: &Extent, b: &Extent) -> bool {
    (0..2).all(|k| a[k] < b[k + 2] && b[k] < a[k + 2])
}

/// Tables of engines with their names, each beside its mark where there is room.
fn label(svg: &mut Svg, frame: Frame, places: Vec<([f64; 2], &str)>) {
    let mark = |[x, y]: [f64; 2]| [x - 6.0, y - 6.0, x + 6.0, y + 6.0];
    let mut taken: Vec<Extent> = places.iter().map(|(place, _)| mark(*place)).collect();
    for ([x, y], name) in places {
        svg.path("ink", &format!("M{x:.1} {:.1}l5 5l-5 5l-5 -5z", y - 5.0));
        let width = 6.7 * name.chars().count() as f64;
        let ways = [(x - 12.0 - width, 0.0), (x + 12.0, 0.0), (x - 0.5 * width, 1.0)];
        let lines = [0.0, 15.0, -15.0, 30.0, -30.0];
        let boxes = lines.iter().flat_map(|line| ways.map(|way| (line, way)));
        let boxes = boxes.map(|(line, (left, is_beyond))| {
            let left = left.clamp(frame.left + 3.0, frame.left + frame.width - width - 3.0);
            let middle = y + line + is_beyond * 15.0;
            [left, middle - 7.0, left + width, middle + 7.0]
        });
        let boxes: Vec<Extent> = boxes.collect();
        let is_free = |own: &&Extent| taken.iter().all(|other| !overlap(own, other));
        let Some(&place) = boxes.iter().find(is_free).or(boxes.first()) else { continue };
        let middle = 0.5 * (place[1] + place[3]);
        if (middle - y).abs() > 16.0 {
            let end = x.clamp(place[0], place[2]);
            svg.line("grid", [x, y], [end, if middle > y { place[1] } else { place[3] }]);
        }
        svg.text([place[0], place[3] - 3.0], "", name);
        taken.push(place);
    }
}

/// What the marks mean.
fn legend(svg: &mut Svg) {
    let mut x = 256.0;
    for (mark, text) in [
        (Mark::Triangle, "proved to err by at least this"),
        (Mark::Cross, "the best numbers found"),
        (Mark::Dot, "within it at points"),
    ] {
        svg.path(mark.class(), &mark.path([x, 10.0]));
        svg.text([x + 9.0, 14.0], "d", text);
        x += 28.0 + 6.1 * text.len() as f64;
    }
    svg.path("ink", &format!("M{x:.1} 5l5 5l-5 5l-5 -5z"));
    svg.text([x + 9.0, 14.0], "d", "table of an engine");
}

fn caption(report: &Report, outcome: &Outcome) -> String {
    let count = |of: fn(&Verdict) -> bool| {
        whole(outcome.trials.iter().filter(|trial| of(&trial.verdict)).count())
    };
    let mut text = format!(
        "{} candidates were tried, from the cheapest on: {} are proved to miss the tolerance \
         whatever their numbers are (the triangle is the lower bound of their error), for {} no \
         good numbers were found, {} are within it where they were measured. Both axes are \
         logarithmic. What counts for the cost is {}.",
        whole(outcome.trials.len()),
        count(|verdict| matches!(verdict, Verdict::Fails { .. })),
        count(|verdict| matches!(verdict, Verdict::NotFound(_))),
        count(|verdict| matches!(verdict, Verdict::Passes(_))),
        escape(&report.plan.question.cost)
    );
    let is_line = |trial: &Trial| trial.region.roughness[0] == trial.region.roughness[1];
    if report.plan.question.pieces.len() > 1 && outcome.trials.iter().any(is_line) {
        text += " Polynomials for a constant roughness are drawn with the bytes of one roughness \
                 alone.";
    }
    let mut engines = report.engines.iter().map(|engine| engine.worst);
    if engines.any(|worst| worst < LEAST)
        || outcome.trials.iter().any(|trial| point(trial).1[1] == LEAST)
    {
        text += &format!(" Errors below {LEAST} of the tolerance are drawn there.");
    }
    text
}

//! A bound of what a lookup errs by anywhere in its region, not at points alone.
//!
//! Where a function has second derivatives of at most M along both sides of a rectangle, it is
//! nowhere larger than at the corners by more than (h_u² M_u + h_t² M_t)/8: the error of bilinear
//! interpolation between them. Over cells of (u, t) the derivatives of a lookup are bounded by
//! intervals, and those of the truth by norms of its interpolant; each cell is then divided until
//! that remainder is a small share of the tolerance.

mod interval;
mod pieces;
mod place;
mod rounding;

use super::tolerance::Tolerance;
use super::truth::{Albedo, Truth};
use crate::approximation::{Approximation, Channels, Numbers, Region};
use crate::brdf::fresnel::schlick_weight;
use crate::integrate::interpolant::SMOOTHEST;
use crate::integrate::interpolant::norms::Norms;
use crate::numeric::lanes::{F64x8, Vector};
use interval::{Interval, Jet};
use pieces::Pieces;
use place::{Cell, Coordinates, Direction, Place};
use rayon::prelude::*;
use rounding::rounding;
use serde::{Deserialize, Serialize};

/// What no lookup in a region exceeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The error over its tolerance; where it exceeds 1, the rest of the region was not looked at.
    pub share: f64,
    /// The smoothest roughness that it holds for: the interpolant of the truth begins there.
    pub from: f64,
    /// The points where it was evaluated.
    pub points: usize,
}

/// Cells along n·v and across roughness at the beginning.
const CELLS: [usize; 2] = [16, 16];

/// The share of the tolerance by which a bound may exceed the largest error that was measured.
const BEYOND: f64 = 4e-3;

/// A bound that is near enough, however small the largest error is.
const NEAR: f64 = 0.9;

/// Steps of a cell along a direction before it is divided: parts have smaller derivatives.
const STEPS: usize = 8;

/// Points of a cell after which it is divided no more: what is then between its points counts as it
/// is.
const MOST_POINTS: usize = 60_000;

/// Bounds are raised by this share for the roundings of intervals, which are not rounded outward:
/// their ends are off by a few hundred units of 2^-53 at the most.
const ROUNDED: f64 = 1.0 + 1e-9;

/// Bounds the error of a lookup at both ends of a range of F0, the largest of which is `measured`
/// as a share of the tolerance; none where the interpolant of the truth covers nothing of its
/// region.
pub fn bound(
    approximation: &Approximation,
    f0: [f64; 2],
    tolerance: Tolerance,
    measured: f64,
    truth: &Truth,
) -> Option<Bound> {
    let [low, high] = approximation.region.roughness;
    if high == 0.0 {
        return mirror(approximation, f0, tolerance);
    }
    if high < SMOOTHEST {
        return None;
    }
    // n·v is an f32, and so is the least of them in a shader.
    let least_nov = (approximation.region.least_nov as f32).into();
    let region = Region { least_nov, ..approximation.region };
    let approximation = Approximation { region, ..approximation.clone() };
    let question = Question {
        coordinates: Coordinates::new(&region, &approximation.shape),
        rounding: rounding(&approximation),
        approximation: &approximation,
        f0,
        tolerance,
        aim: measured.max(NEAR) + BEYOND,
        truth,
    };
    let from = low.max(SMOOTHEST);
    let ends = [from, high].map(Coordinates::t);
    let strips = if low == high { 1 } else { CELLS[1] };
    let part = |index: usize, count: usize| index as f64 / count as f64;
    let t = |index: usize| ends[0] + (ends[1] - ends[0]) * part(index, strips);
    let cell = |index: usize| {
        let (i, j) = (index % CELLS[0], index / CELLS[0]);
        Cell { u: [part(i, CELLS[0]), part(i + 1, CELLS[0])], t: [t(j), t(j + 1)] }
    };
    let cells: Vec<Cell> = (0..CELLS[0] * strips).map(cell).collect();
    let mut found = Found::default();
    for strip in cells.chunks(CELLS[0]) {
        let of_cell = |cell| question.cell(cell, MOST_POINTS);
        let all: Vec<Found> = strip.par_iter().map(of_cell).collect();
        found = all.into_iter().fold(found, Found::and);
        if found.misses() {
            break;
        }
    }
    let Found { share, points } = found;
    Some(Bound { share, from, points })
}

/// The bound of constants for a mirror, whose E(F0) is F: E = 1 and R = 0.
fn mirror(approximation: &Approximation, f0: [f64; 2], tolerance: Tolerance) -> Option<Bound> {
    let Approximation { channels, numbers, .. } = approximation;
    let is_factor_of_f = matches!(channels, Channels::EnergyRest | Channels::Ratio);
    if !is_factor_of_f || numbers.iter().any(|numbers| numbers.len() > 1) {
        return None;
    }
    let truths = [1.0, 0.0];
    let off = |(numbers, truth): (&Numbers, f64)| {
        let constant = if numbers.is_empty() { 0.0 } else { numbers.get(0) };
        (constant - truth).abs()
    };
    let error: f64 = numbers.iter().zip(truths).map(off).sum();
    let share = (error + rounding(approximation)) / tolerance.at(f0[0]);
    Some(Bound { share, from: 0.0, points: 0 })
}

/// The largest error over its tolerance in some cells, and their points.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    share: f64,
    points: usize,
}

impl Found {
    /// Whether a bound exceeds the tolerance: no other cell changes that.
    fn misses(&self) -> bool {
        self.share > 1.0
    }

    /// In both.
    fn and(self, other: Found) -> Found {
        // What is no number counts as the largest.
        let share = if other.share <= self.share { self.share } else { other.share };
        let share = if share.is_nan() { f64::INFINITY } else { share };
        Found { share, points: self.points + other.points }
    }
}

struct Question<'a> {
    coordinates: Coordinates<'a>,
    approximation: &'a Approximation,
    /// What f32 adds.
    rounding: f64,
    f0: [f64; 2],
    tolerance: Tolerance,
    /// The bound that is near enough.
    aim: f64,
    truth: &'a Truth,
}

/// How fast the error and the truth bend in a cell along a direction.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// The second derivative of the error, for the F0 where it is larger.
    error: f64,
    /// That of the truth.
    truth: f64,
    place: Place,
}

impl Question<'_> {
    /// Bounds the error in a cell, with about so many points.
    fn cell(&self, cell: &Cell, most_points: usize) -> Found {
        let place = |direction| self.coordinates.place(cell, direction);
        let places = [place(Direction::Nov), place(Direction::Roughness)];
        let corners = self.rows(cell, [1, 1]);
        let pieces = self.pieces(&places[0]);
        let truths = truths(self.truth.norms(), places[0].s.value, cell.t, &corners);
        let bends = places.map(|place| self.bend(place, &pieces, &truths));
        let at_corners = self.largest(&corners, [0.0; 2]);
        let allowed = 0.5 * (self.aim - at_corners.share).max(BEYOND) * at_corners.allowed;
        let widths = [cell.u[1] - cell.u[0], cell.t[1] - cell.t[0]];
        let steps = [0, 1].map(|k| {
            let between = |steps: usize| self.between(&bends[k], &pieces, widths[k] / steps as f64);
            let doubled = std::iter::successors(Some(1), |steps| Some(2 * steps));
            doubled.take_while(|steps| *steps <= STEPS).find(|&steps| between(steps) <= allowed)
        });
        let may_divide = most_points > 2 * STEPS * STEPS;
        if may_divide && steps.contains(&None) {
            let divided = steps.map(|steps| steps.is_none());
            return self.halves(cell, divided, at_corners.points, most_points);
        }
        let steps = steps.map(|steps| steps.unwrap_or(STEPS));
        let of = |k: usize| self.between(&bends[k], &pieces, widths[k] / steps[k] as f64);
        let dip = |k: usize| (widths[k] / steps[k] as f64).powi(2) / 8.0 * bends[k].truth;
        let between = of(0) + of(1);
        // A sampler is off by a share of a texel.
        let filter = self.approximation.shape.filter();
        let sampler: f64 = pieces.iter().map(|channel| channel.moved(filter)).sum();
        let beyond = [between + sampler + self.rounding, (dip(0) + dip(1)) * ROUNDED];
        let Largest { share, points, loosest, .. } = self.largest(&self.rows(cell, steps), beyond);
        let points = points + at_corners.points;
        // Its corners said too little of what is between them.
        let is_loose = between > BEYOND * at_corners.allowed || loosest > 1.0 + BEYOND;
        if may_divide && share > self.aim && is_loose {
            return self.halves(cell, [true, cell.t[0] < cell.t[1]], points, most_points);
        }
        Found { share, points }
    }

    /// Bounds the error in the halves of a cell, which had these points already.
    fn halves(&self, cell: &Cell, divided: [bool; 2], points: usize, most_points: usize) -> Found {
        let parts = cell.halves(divided);
        let mut found = Found { share: 0.0, points };
        for (index, part) in parts.iter().enumerate() {
            let left = most_points.saturating_sub(found.points) / (parts.len() - index);
            found = found.and(self.cell(part, left));
            if found.misses() {
                break;
            }
        }
        found
    }

    /// The ranges of the lookup's channels in a cell.
    fn pieces(&self, place: &Place) -> [Pieces; 2] {
        let Approximation { shape, numbers, .. } = self.approximation;
        std::array::from_fn(|channel| match numbers.get(channel) {
            Some(numbers) => Pieces::new(shape, numbers, place.along.value, place.across.value),
            None => Pieces::of(&Norms::default()),
        })
    }

    /// How fast the error bends.
    fn bend(&self, place: Place, pieces: &[Pieces; 2], truths: &[Pieces; 2]) -> Bend {
        let Place { s, t, nov, along, across } = place;
        let lookups = pieces.map(|channel| channel.along(along, across));
        let truths = truths.map(|truth| truth.along(s, t));
        let channels = self.approximation.channels;
        let of = |f0: f64| {
            let f0 = Jet::from(f0);
            let sum = |weights: [Jet; 2], values: [Jet; 2]| {
                weights[0] * values[0] + weights[1] * values[1]
            };
            let weights = Channels::EnergyRest.weights(nov, f0);
            let truth = sum(weights, truths);
            let error = match channels {
                // F times what is small is small, however F bends.
                Channels::EnergyRest | Channels::Ratio => {
                    sum(weights, [lookups[0] - truths[0], lookups[1] - truths[1]])
                }
                _ => sum(channels.weights(nov, f0), lookups) - truth,
            };
            (error.second.size(), truth.second.size())
        };
        let [first, last] = self.f0.map(of);
        Bend { error: first.0.max(last.0), truth: first.1.max(last.1), place }
    }

    /// How much larger the error may be between points a step apart than at them.
    fn between(&self, bend: &Bend, pieces: &[Pieces; 2], step: f64) -> f64 {
        let Place { along, across, .. } = bend.place;
        let kinks: f64 = pieces.iter().map(|one| one.kinks(along, across, step)).sum();
        (step * step / 8.0 * bend.error + kinks) * ROUNDED
    }

    /// The points at the ends of so many steps of a cell, row by row.
    fn rows(&self, cell: &Cell, steps: [usize; 2]) -> Vec<Vec<Point>> {
        let along = self.places(cell.u, steps[0]);
        let across = match cell.t[0] < cell.t[1] {
            true => self.places(cell.t, steps[1]),
            false => vec![cell.t[0]],
        };
        across.iter().map(|&t| self.row(&along, t)).collect()
    }

    /// The largest error over its tolerance in the rectangles between points: the error is larger
    /// there by `beyond[0]`, and the truth smaller by `beyond[1]`.
    fn largest(&self, rows: &[Vec<Point>], beyond: [f64; 2]) -> Largest {
        let points = rows.iter().map(Vec::len).sum();
        let mut result = Largest { share: 0.0, allowed: f64::INFINITY, loosest: 1.0, points };
        for j in 0..rows.len().max(2) - 1 {
            let pair = [&rows[j], &rows[(j + 1).min(rows.len() - 1)]];
            for (i, end) in (0..rows[0].len() - 1).flat_map(|i| [(i, 0), (i, 1)]) {
                let corners = [pair[0][i], pair[0][i + 1], pair[1][i], pair[1][i + 1]];
                let errors = corners.map(|corner| corner.errors[end]);
                let albedos = corners.map(|corner| corner.truth.at(self.f0[end]));
                let error = errors.into_iter().fold(0.0, f64::max);
                let albedo = albedos.into_iter().fold(f64::INFINITY, f64::min);
                let allowed = self.tolerance.at((albedo - beyond[1]).max(0.0));
                let share = (error + beyond[0]) / allowed;
                // What is no number counts as the largest.
                result.share = if share <= result.share { result.share } else { share };
                result.allowed = result.allowed.min(allowed);
                result.loosest = result.loosest.max(self.tolerance.at(albedo) / allowed);
            }
        }
        result
    }

    /// Places in a range, at the ends of so many steps.
    fn places(&self, [low, high]: [f64; 2], steps: usize) -> Vec<f64> {
        let place = |i: usize| match i == steps {
            true => high,
            false => low + (high - low) * (i as f64 / steps as f64),
        };
        (0..=steps).map(place).collect()
    }

    /// The points at these places of a row.
    fn row(&self, places: &[f64], t: f64) -> Vec<Point> {
        let roughness = self.coordinates.roughness(t);
        let row = self.coordinates.row(roughness);
        let novs: Vec<f64> = places.iter().map(|&u| row.nov(u)).collect();
        let truths = self.truth.row(roughness, &novs);
        let mut points = Vec::with_capacity(places.len());
        for first in (0..places.len()).step_by(F64x8::LANES) {
            let count = F64x8::LANES.min(places.len() - first);
            let nov = F64x8::gather(|i| novs[first + i.min(count - 1)]);
            let lookups = self
                .f0
                .map(|f0| self.approximation.albedo(nov, F64x8::from(roughness), F64x8::from(f0)));
            for i in 0..count {
                let truth = truths[first + i];
                let error = |end: usize| {
                    let error = (lookups[end].lane(i) - truth.at(self.f0[end])).abs();
                    // The largest of some numbers skips what is none.
                    if error.is_nan() { f64::INFINITY } else { error }
                };
                let (nov, s) = (novs[first + i], row.s(places[first + i]));
                points.push(Point { s, nov, truth, errors: [error(0), error(1)] });
            }
        }
        points
    }
}

/// What is known of E and R of the truth in a cell, from its corners: a derivative is a slope
/// between corners somewhere, and changes by no more than second derivatives allow.
fn truths(norms: &[Norms; 2], s: Interval, t: [f64; 2], corners: &[Vec<Point>]) -> [Pieces; 2] {
    let widths = [s.high - s.low, t[1] - t[0]];
    let channel = |k: usize| {
        let norms = &norms[k];
        let value = |point: &Point| {
            let rest = point.truth.b - schlick_weight(point.nov) * point.truth.e;
            if k == 0 { point.truth.e } else { rest }
        };
        let slope = |row: &Vec<Point>| (value(&row[1]) - value(&row[0])) / (row[1].s - row[0].s);
        let [ss, st, tt] = norms.second;
        let by_s = Interval::hull(corners.iter().map(slope))
            .widened(widths[0] * ss + widths[1] * st)
            .and(Interval::around_zero(norms.first[0]));
        let rise = |i: usize| {
            let (low, high) = (&corners[0][i], &corners[1][i]);
            let moved = by_s * (high.s - low.s);
            (Interval::point(value(high) - value(low)) - moved) * (1.0 / widths[1])
        };
        let by_t = Interval::around_zero(norms.first[1]);
        let by_t = match corners.len() {
            1 => by_t,
            _ => {
                let rises = [rise(0), rise(1)].map(|rise| [rise.low, rise.high]);
                Interval::hull(rises.into_iter().flatten())
                    .widened(widths[0] * st + widths[1] * tt)
                    .and(by_t)
            }
        };
        let near = widths[0] * by_s.size() + widths[1] * by_t.size();
        let value = Interval::hull(corners.iter().flatten().map(value)).widened(near);
        Pieces::of(norms).known(value, [by_s, by_t])
    };
    [channel(0), channel(1)]
}

/// The largest error over its tolerance between points of a cell, and the least tolerance there.
struct Largest {
    share: f64,
    allowed: f64,
    /// The largest ratio of the tolerance at the points to that between them.
    loosest: f64,
    points: usize,
}

/// A point: the truth, and what a lookup errs by at both ends of F0.
#[derive(Clone, Copy, Debug)]
struct Point {
    s: f64,
    nov: f64,
    truth: Albedo,
    errors: [f64; 2],
}

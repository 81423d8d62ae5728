//! Spheres in a furnace for the materials of a plan: E(F0) by the plan's lookup, by the integral,
//! and their difference times 100, at either end of the range of F0.
//!
//! A pixel is the mean of four samples. With u and v their places from the middle of the cell, in
//! quarters of a pixel, both odd, n·v depends on u² + v² alone, which is 2 + 8k: a sphere takes as
//! many integrals as there are such sums, each at the very n·v of its samples.

use super::{rule_of_picture, srgb};
use crate::approximation::Approximation;
use crate::approximation::code::check;
use crate::backend::{Progress, cpu};
use crate::brdf::Microfacet;
use crate::error::Result;
use crate::image::Picture;
use crate::integrate::ScaleBias;
use crate::numeric::lanes::{F32x16, Vector};
use crate::planner::check::part_for;
use crate::planner::domain::Piece;
use crate::planner::file::PlanFile;
use crate::units::alpha_of;
use rayon::prelude::*;

/// Spheres beside each other at the most; more are too small to see anything.
pub const MOST_COLUMNS: usize = 8;

/// Spheres of a range of roughness at the most.
const MOST_OF_A_RANGE: usize = 4;

/// The sphere's edge lies at this share of its cell: a twin of the one in `shade`.
const MARGIN: f64 = 1.06;

/// How bright it is around a sphere: of differences, and of all else.
const AROUND: [f64; 2] = [0.02, 1.0];

/// A sphere's material.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Perceptual roughness, in the range of its piece.
    pub roughness: f64,
    /// The range of F0 of its piece.
    pub f0: [f64; 2],
    /// The materials of its piece.
    pub materials: Vec<String>,
    /// What the plan has for it.
    pub approximation: Approximation,
}

/// The spheres of a column: E(F0) by both, at each k.
struct Spheres {
    novs: Vec<f64>,
    least_nov: f64,
    /// By lookup and by the integral, of either F0.
    albedos: [[Vec<f64>; 2]; 2],
}

/// What is on a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Show {
    Lookup,
    Integral,
    Difference,
}

/// The columns of a plan, from smooth to rough: both ends of the roughness of each piece, and
/// between them what there is room for; or as many of the ends, evenly, as there is room for.
///
/// # Errors
///
/// Those of a plan whose numbers are not those that were written or make no sense, or that has none
/// for a piece.
pub fn columns(plan: &PlanFile) -> Result<Vec<Column>> {
    let approximations = plan.approximations()?;
    approximations.iter().try_for_each(check)?;
    let (task, _) = plan.task()?;
    let pieces = &task.domain.pieces;
    let of_a_range = (MOST_COLUMNS / pieces.len()).clamp(2, MOST_OF_A_RANGE);
    // A plan may have many pieces: each is a column only once it is known to be shown.
    let mut places: Vec<(f64, &Piece, usize)> = Vec::new();
    for piece in pieces {
        let part = part_for(plan, piece)?;
        let [low, high] = piece.roughness;
        let count = if low < high { of_a_range } else { 1 };
        let at = |i: usize| low + (high - low) * (i as f64 / (count - 1).max(1) as f64);
        places.extend((0..count).map(|i| (at(i).min(high), piece, part)));
    }
    places.sort_by(|a, b| a.0.total_cmp(&b.0));
    let column = |(roughness, piece, part): (f64, &Piece, usize)| Column {
        roughness,
        f0: piece.f0,
        materials: piece.materials.clone(),
        approximation: approximations[part].clone(),
    };
    Ok(evenly(places).into_iter().map(column).collect())
}

/// The first, the last, and those evenly between them, [`MOST_COLUMNS`] in all.
fn evenly<T: Copy>(all: Vec<T>) -> Vec<T> {
    let last = all.len() - 1;
    if last < MOST_COLUMNS {
        return all;
    }
    (0..MOST_COLUMNS).map(|i| all[i * last / (MOST_COLUMNS - 1)]).collect()
}

/// The ends of F0 that the columns have rows for: both, or one where no column has a range.
pub fn ends(columns: &[Column]) -> usize {
    if columns.iter().any(|column| column.f0[0] < column.f0[1]) { 2 } else { 1 }
}

/// A picture and the largest difference that each of its columns shows, over n·v and F0.
pub type Rendered = (Picture, Vec<f64>);

/// Three rows for each end of F0, `cell` pixels for each sphere; `progress` is told of pixels.
pub fn render(columns: &[Column], cell: usize, progress: Progress) -> Result<Rendered> {
    let rows: Vec<(usize, Show)> = (0..ends(columns))
        .flat_map(|end| [Show::Lookup, Show::Integral, Show::Difference].map(|show| (end, show)))
        .collect();
    let mut picture = Picture::new(cell * columns.len(), cell * rows.len(), [0; 3]);
    let mut largest = Vec::new();
    for (i, column) in columns.iter().enumerate() {
        let spheres = Spheres::new(column, cell);
        for (j, &(end, show)) in rows.iter().enumerate() {
            spheres.draw((end, show), cell, (i * cell, j * cell), &mut picture);
        }
        largest.push(spheres.largest());
        progress(cell * cell * rows.len());
    }
    Ok((picture, largest))
}

/// The n·v of the samples with u² + v² = 2 + 8k, for each k on the sphere; there are as many as
/// there are radii.
fn novs(cell: usize) -> Vec<f64> {
    let scale = MARGIN / (2.0 * cell as f64);
    let squared = |k: usize| (2 + 8 * k) as f64 * scale * scale;
    (0..).map(squared).take_while(|r2| *r2 < 1.0).map(|r2| (1.0 - r2).sqrt()).collect()
}

/// E(F0) at these n·v as the shader computes it, in f32.
fn by_lookup(column: &Column, novs: &[f64], f0: f64) -> Vec<f64> {
    let Column { roughness, approximation, .. } = column;
    let of_chunk = |chunk: &[f64]| {
        let nov = F32x16::gather(|i| chunk[i.min(chunk.len() - 1)]);
        let albedo = approximation.albedo(nov, F32x16::from(*roughness), F32x16::from(f0));
        (0..chunk.len()).map(|i| albedo.lane(i)).collect::<Vec<f64>>()
    };
    novs.chunks(16).flat_map(of_chunk).collect()
}

/// (A, B) at these n·v by the cheapest rule that is right to the picture's eye.
fn integrals(lobe: Microfacet, roughness: f64, novs: &[f64]) -> Vec<ScaleBias> {
    let rule = rule_of_picture(lobe, novs.len());
    let alpha = alpha_of(roughness);
    let chunks = novs.par_chunks(512).flat_map(|chunk| {
        let points: Vec<(f64, f64)> = chunk.iter().map(|&nov| (nov, alpha)).collect();
        cpu::bake_points(lobe, &points, &rule).scale_bias()
    });
    chunks.collect()
}

impl Spheres {
    fn new(column: &Column, cell: usize) -> Self {
        let novs = novs(cell);
        let integrals = integrals(column.approximation.lobe, column.roughness, &novs);
        let albedos = column.f0.map(|f0| {
            let exact = integrals.iter().map(|integral| integral.at_f0(f0)).collect();
            [by_lookup(column, &novs, f0), exact]
        });
        let least_nov = column.approximation.region.least_nov;
        Spheres { novs, least_nov, albedos }
    }

    /// The largest difference of the lookup from the integral, where the plan promises something.
    fn largest(&self) -> f64 {
        let mut largest = 0.0;
        for [lookup, integral] in &self.albedos {
            for ((nov, own), exact) in self.novs.iter().zip(lookup).zip(integral) {
                let difference = (own - exact).abs();
                // What is no number counts as the largest.
                let difference = if difference.is_nan() { f64::INFINITY } else { difference };
                if *nov >= self.least_nov {
                    largest = f64::max(largest, difference);
                }
            }
        }
        largest
    }

    /// Draws a sphere with its cell's corner at `place`.
    fn draw(&self, what: (usize, Show), cell: usize, place: (usize, usize), to: &mut Picture) {
        for j in 0..cell {
            for i in 0..cell {
                let sum: f64 = (0..4)
                    .map(|s| self.sample(what, radius(cell, (2 * i + s % 2, 2 * j + s / 2))))
                    .sum();
                to.set(place.0 + i, place.1 + j, [srgb(0.25 * sum); 3]);
            }
        }
    }

    /// The light of a sample at this k.
    fn sample(&self, (end, show): (usize, Show), k: usize) -> f64 {
        let [lookup, integral] = &self.albedos[end];
        let Some((own, exact)) = lookup.get(k).zip(integral.get(k)) else {
            return if show == Show::Difference { AROUND[0] } else { AROUND[1] };
        };
        let value = match show {
            Show::Lookup => *own,
            Show::Integral => *exact,
            Show::Difference => 100.0 * (own - exact).abs(),
        };
        value.min(1.0)
    }
}

/// The k of a sample in this half column and half row.
fn radius(cell: usize, (i, j): (usize, usize)) -> usize {
    let from_middle = |at: usize| (2 * at + 1).abs_diff(2 * cell);
    let (u, v) = (from_middle(i), from_middle(j));
    (u * u + v * v - 2) / 8
}

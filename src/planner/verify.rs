//! What a lookup errs by, in the arithmetic of a shader, at points that it was not fitted to.

use super::bound::Bound;
use super::samples::{BESIDE_THE_LAYER, Sample, Spread, on_grid, samples};
use super::tolerance::Tolerance;
use super::truth::Truth;
use crate::approximation::{Approximation, Region, Shape};
use crate::numeric::lanes::{F32x16, Vector};
use rayon::prelude::*;

/// The largest error over its tolerance, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The error over its tolerance.
    pub share: f64,
    /// The error of E(F0), the approximation less the truth.
    pub error: f64,
    /// n·v
    pub nov: f64,
    /// Perceptual roughness.
    pub roughness: f64,
    /// F0
    pub f0: f64,
    /// The points that were measured.
    pub points: usize,
    /// What no point exceeds, where that was worked out.
    pub bound: Option<Bound>,
}

impl Worst {
    /// Of numbers that were not found.
    pub fn unknown(f0: f64) -> Self {
        let share = f64::INFINITY;
        Worst { share, error: share, nov: 1.0, roughness: 1.0, f0, points: 0, bound: None }
    }
}

/// Points in each span of a spline, and between the texels of a texture, along either axis: what
/// lies between them is bounded.
const IN_A_SPAN: [Spread; 2] = [Spread::Even(8), Spread::Even(3)];

/// Points in coordinates that do not follow the layer at grazing angles, along n·v and across
/// roughness; of a shape without spans as many again in coordinates that do.
const IN_ALL: [Spread; 2] = [Spread::Even(193), Spread::Even(61)];

/// The points where an approximation is verified.
pub fn points(truth: &Truth, region: &Region, shape: &Shape) -> Vec<Sample> {
    points_at(truth, region, shape, IN_A_SPAN, IN_ALL)
}

/// The same with so many points in each span, between texels, or in all.
pub fn points_at(
    truth: &Truth,
    region: &Region,
    shape: &Shape,
    [in_a_span, between_texels]: [Spread; 2],
    in_all: [Spread; 2],
) -> Vec<Sample> {
    let spread = match shape {
        Shape::Spline { .. } => [in_a_span; 2],
        Shape::Texture { .. } => [between_texels; 2],
        Shape::Polynomial { .. } | Shape::Surface { .. } => in_all,
    };
    let mut points = samples(truth, region, shape, spread);
    points.extend(on_grid(truth, region, BESIDE_THE_LAYER, (in_all, [1, 1])));
    points
}

/// Measures an approximation at these points, at both ends of a range of F0: the error is linear in
/// F0, and the tolerance concave, so that nothing between is worse. A sampler is as far off as it
/// may be along either axis: its lookup is linear in that too.
pub fn measure(
    approximation: &Approximation,
    f0: [f64; 2],
    tolerance: Tolerance,
    points: &[Sample],
) -> Worst {
    let none = Worst {
        share: 0.0,
        error: 0.0,
        nov: 1.0,
        roughness: 1.0,
        f0: f0[0],
        points: 0,
        bound: None,
    };
    let [x, y] = approximation.shape.filter();
    let shifts: &[[f64; 2]] = match x > 0.0 {
        true => &[[-x, -y], [x, -y], [-x, y], [x, y]],
        false => &[[0.0; 2]],
    };
    let of_chunk = |chunk: &[Sample]| {
        let last = chunk.len() - 1;
        let nov = F32x16::gather(|i| chunk[i.min(last)].nov);
        let roughness = F32x16::gather(|i| chunk[i.min(last)].roughness);
        let mut worst = none;
        let all = f0.iter().flat_map(|f0| shifts.iter().map(move |shift| (*f0, *shift)));
        for (f0, shift) in all {
            let albedo = approximation.albedo_beside(nov, roughness, F32x16::from(f0), shift);
            for (i, sample) in chunk.iter().enumerate() {
                let truth = sample.truth.at(f0);
                let error = albedo.lane(i) - truth;
                let share = error.abs() / tolerance.at(truth);
                // What is no number counts as the worst.
                if share.is_nan() || share > worst.share {
                    let share = if share.is_nan() { f64::INFINITY } else { share };
                    let Sample { nov, roughness, .. } = *sample;
                    worst = Worst { share, error, nov, roughness, f0, ..none };
                }
            }
        }
        worst
    };
    let larger = |a: Worst, b: Worst| if b.share > a.share { b } else { a };
    let worst = points.par_chunks(16).map(of_chunk).reduce(|| none, larger);
    Worst { points: points.len(), ..worst }
}

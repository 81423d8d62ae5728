//! What the tables of engines give for a scene: exact values at their nodes, bilinear between them.

use super::domain::Domain;
use super::samples::{Sample, Spread, on_grid};
use super::tolerance::Tolerance;
use super::truth::{Albedo, Truth};
use crate::approximation::{Across, Along};
use crate::error::Result;
use crate::table::axis::{Axis, AxisSpec};
use crate::table::bilinear;
use serde::Serialize;
use std::fmt;

/// The table of an engine over a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Engine {
    /// The engine.
    pub name: &'static str,
    /// Bytes of its table, of A and B in half.
    pub bytes: usize,
    /// The largest error of E(F0) over its tolerance.
    pub worst: f64,
    /// That error.
    pub error: f64,
    /// n·v, roughness and F0 there.
    pub place: [f64; 3],
}

/// Name, size and axes: three.js r187 (DFGLUTData.js), Bevy 0.17 (dfg.bin as baked, linear), Unreal
/// 5 (PreIntegratedGF), Filament 1.5x (DFG), HDRP (PreIntegratedFGD, sqrt of n·v at the edges).
const ENGINES: [(&str, [usize; 2], [&str; 2]); 5] = [
    ("three.js, 16 x 16", [16, 16], ["nov", "roughness"]),
    ("Bevy, 64 x 64", [64, 64], ["nov", "roughness"]),
    ("Unreal, 128 x 32", [128, 32], ["nov", "roughness"]),
    ("Filament, 128 x 128", [128, 128], ["nov", "roughness"]),
    ("HDRP's axes, 64 x 64", [64, 64], ["nov,sqrt,edges", "roughness,edges"]),
];

/// Places that are looked at: across roughness and along n·v.
const PLACES: [Spread; 2] = [Spread::Even(160), Spread::Even(96)];

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Engine { name, bytes, worst, error, place: [nov, roughness, f0] } = self;
        write!(
            f,
            "{name} exact nodes, {bytes} bytes: error {:.2e}, {worst:.1} of the tolerance, at n.v \
             = {nov:.4}, roughness {roughness:.4}, F0 = {f0}",
            error.abs()
        )
    }
}

/// The engines' tables over a domain, at points and nowhere between.
pub fn engines(domain: &Domain, tolerance: Tolerance, truth: &Truth) -> Result<Vec<Engine>> {
    let mut points: Vec<(Sample, [f64; 2])> = Vec::new();
    for piece in domain.some_pieces() {
        let region = domain.region_of(piece);
        let layer = (Along::Layer(3.0), Across::Sqrt);
        let samples = on_grid(truth, &region, layer, (PLACES, [1, 1]));
        points.extend(samples.into_iter().map(|sample| (sample, piece.f0)));
    }
    let engine = |(name, size, axes): (&'static str, [usize; 2], [&str; 2])| {
        let axis = |k: usize| Axis::new(axes[k].parse::<AxisSpec>()?, size[k]);
        let (x, y) = (axis(0)?, axis(1)?);
        let row = |roughness: f64| truth.row(roughness.min(1.0), &x.values());
        let table: Vec<Vec<Albedo>> = y.values().into_iter().map(row).collect();
        let mut worst =
            Engine { name, bytes: 4 * size[0] * size[1], worst: 0.0, error: 0.0, place: [0.0; 3] };
        for (sample, f0) in &points {
            let place = bilinear(&x, &y, sample.nov, sample.roughness);
            let read = |of: fn(Albedo) -> f64| place.read(|i, j| of(table[j][i]));
            let read = Albedo { e: read(|albedo| albedo.e), b: read(|albedo| albedo.b) };
            for &f0 in f0 {
                let truth = sample.truth.at(f0);
                let error = read.at(f0) - truth;
                let share = error.abs() / tolerance.at(truth);
                if share > worst.worst {
                    let place = [sample.nov, sample.roughness, f0];
                    worst = Engine { worst: share, error, place, ..worst };
                }
            }
        }
        Ok(worst)
    };
    ENGINES.into_iter().map(engine).collect()
}

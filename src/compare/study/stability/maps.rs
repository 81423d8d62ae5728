//! The maps of a case: its ways over a grid of points, against what is true.

use super::case::{Case, Formula, Kind, Replaced};
use super::ways::{GGX, Way};
use super::{Family, Fault, Map, points};
use crate::backend::Gpu;
use crate::backend::cpu;
use crate::backend::vulkan::evaluate::evaluate;
use crate::choice::Choice;
use crate::compare::device::formula_source;
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::rules::REFERENCE;
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::units::alpha_of;

impl Case {
    /// Its maps on the CPU.
    pub fn maps(&self, size: [usize; 2]) -> Vec<Map> {
        let (x, y) = (&self.x, &self.y);
        let points = points(x, y, size);
        let map = |variant: &str, cells: Vec<Cell>| {
            Map::of((self.family(), self.name, variant), (x, y), size, &cells)
        };
        let truth = |lobe| cpu::bake(lobe, &self.grid(size), &REFERENCE, &|_| ()).scale_bias();
        match &self.kind {
            Kind::Formula(Replaced { textbook, ours, truth, relative, .. }) => {
                let variants = [
                    ("textbook, f64", textbook[0]),
                    ("textbook, f32", textbook[1]),
                    ("ours, f64", ours[0]),
                    ("ours, f32", ours[1]),
                ];
                let of = |(name, f): (&str, Formula)| {
                    map(
                        name,
                        points
                            .iter()
                            .map(|&(x, y)| cell(f(x, y), truth(x, y), *relative))
                            .collect(),
                    )
                };
                variants.map(of).into()
            }
            Kind::Tables(ways) => {
                let truth = truth(GGX);
                let of = |way: &Way| {
                    let values = way.bake(&self.grid(size), &truth);
                    map(
                        way.name,
                        values
                            .into_iter()
                            .zip(&truth)
                            .map(|(value, truth)| cell_of(value, *truth))
                            .collect(),
                    )
                };
                ways.iter().map(of).collect()
            }
            Kind::Storage(lobe, value) => {
                let truth = truth(*lobe);
                let of = |precision: Precision| {
                    let stored = |truth: &ScaleBias| {
                        cell(precision.nearest(value(*truth)), value(*truth), true)
                    };
                    map(precision.word(), truth.iter().map(stored).collect())
                };
                [Precision::Unorm8, Precision::Unorm16, Precision::F16, Precision::F32]
                    .map(of)
                    .into()
            }
        }
    }

    /// Its maps on a device: of formulas that a device has.
    pub fn maps_on(&self, gpu: &Gpu, size: [usize; 2]) -> Result<Vec<Map>> {
        let Kind::Formula(Replaced { truth, relative, wgsl: Some(wgsl), .. }) = &self.kind else {
            return Ok(Vec::new());
        };
        let (x, y) = (&self.x, &self.y);
        let points = points(x, y, size);
        let arguments: Vec<[f32; 4]> =
            points.iter().map(|&(x, y)| [x as f32, y as f32, 0.0, 0.0]).collect();
        let of = |(way, formula): (&str, &str)| {
            let expression = format!("vec4({formula}, 0.0, 0.0, 0.0)");
            let results = evaluate(gpu, &formula_source(wgsl.ndf), &expression, &[], &arguments)?;
            let cells = results
                .iter()
                .zip(&points)
                .map(|(result, &(x, y))| cell(result[0].into(), truth(x, y), *relative));
            let variant = format!("{way}, {}", gpu.info().name);
            Ok(Map::of(
                (Family::Devices, self.name, &variant),
                (x, y),
                size,
                &cells.collect::<Vec<_>>(),
            ))
        };
        [("textbook", wgsl.textbook), ("ours", wgsl.ours)].into_iter().map(of).collect()
    }

    fn grid(&self, [columns, rows]: [usize; 2]) -> Grid {
        let mus = (0..columns).map(|i| self.x.value(i, columns)).collect();
        Grid::of(mus, (0..rows).map(|j| alpha_of(self.y.value(j, rows))).collect())
    }
}

type Cell = std::result::Result<f64, Fault>;

fn cell(value: f64, truth: f64, relative: bool) -> Cell {
    match value {
        _ if value.is_nan() => Err(Fault::Nan),
        _ if value.is_infinite() => Err(Fault::Infinite),
        _ if value < 0.0 => Err(Fault::Negative),
        _ if relative => Ok(((value - truth) / truth).abs()),
        _ => Ok((value - truth).abs()),
    }
}

/// The cell of A and B. A negative value and an albedo above 1 by rounding alone are no faults.
fn cell_of(value: ScaleBias, truth: ScaleBias) -> Cell {
    const ROUNDING: f64 = 1e-5;
    match value {
        _ if value.e().is_nan() => Err(Fault::Nan),
        _ if value.e().is_infinite() => Err(Fault::Infinite),
        _ if value.a.min(value.b) < -ROUNDING => Err(Fault::Negative),
        _ if value.e() > 1.0 + ROUNDING => Err(Fault::AboveOne),
        _ => Ok((value.a - truth.a).abs().max((value.b - truth.b).abs())),
    }
}

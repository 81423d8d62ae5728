//! The white furnace: a surface under light from everywhere, radiance 1. A material that keeps its
//! energy gives back 1 at every angle and roughness; this computes what a combination of specular
//! lobe, multiple scattering, diffuse base and split gives back instead.

pub mod coat;

use crate::backend::cpu;
use crate::brdf::fresnel::{average_schlick, schlick_complement};
use crate::brdf::{Diffuse, Microfacet};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};
use crate::integrate::average::{average_nodes, averages};
use crate::integrate::rule::Rule;
use crate::integrate::{Field, ScaleBias};
use crate::lut::energy::{check_leaves_energy, check_scatters};
use crate::numeric::quadrature::tanh_sinh::tanh_sinh;
use crate::table::grid::Grid;
use crate::units::roughness_of;

/// The compensation of the energy that a Smith lobe loses between its facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MultipleScattering {
    /// None.
    None,
    /// Kulla and Conty 2017, with the Fresnel factor F_avg² E_avg / (1 - F_avg (1-E_avg)) (Hill
    /// 2018).
    KullaConty,
    /// Turquin 2019: the lobe times 1 + F0 (1-E)/E.
    Turquin,
    /// Fdez-Agüera 2019, from A and B alone.
    FdezAguera,
}

choice!(MultipleScattering, "multiple scattering", {
    None = "none", "none";
    KullaConty = "kulla-conty", "Kulla and Conty 2017";
    Turquin = "turquin", "Turquin 2019";
    FdezAguera = "fdez-aguera", "Fdez-Agüera 2019";
});

/// The fraction of the light that reaches the diffuse base and comes back: see
/// [`crate::lut::energy`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// 1 - F(n·v).
    Naive,
    /// 1 - S(v), S being the specular albedo at F0.
    Albedo,
    /// (1-S(l))(1-S(v))/(1-S_avg), on a Lambertian base.
    Reciprocal,
}

choice!(Split, "split", {
    Naive = "naive", "1 - F(n.v)";
    Albedo = "albedo", "1 - S(v)";
    Reciprocal = "reciprocal", "(1-S(l))(1-S(v))/(1-S_avg)";
});

/// A material: its parts, for any F0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The specular lobe.
    pub lobe: Microfacet,
    /// The compensation of its loss.
    pub multiple_scattering: MultipleScattering,
    /// The white base.
    pub base: Diffuse,
}

/// The energy that comes back at each angle and roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct Furnace {
    /// F0 of the specular lobe.
    pub f0: f64,
    /// The weight of the base.
    pub split: Split,
    /// The energy at each point of the grid, in its order; 1 is all of it.
    pub energy: Vec<f64>,
}

/// The extremes of a furnace, and where they are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Extremes {
    /// The least energy.
    pub least: f64,
    /// Its (n·v, α).
    pub least_at: (f64, f64),
    /// The most energy.
    pub most: f64,
    /// Its (n·v, α).
    pub most_at: (f64, f64),
    /// The mean over the grid.
    pub mean: f64,
}

impl MultipleScattering {
    /// The specular albedo with the loss given back, at F0 for the integrals of a direction and of
    /// the average.
    pub fn albedo(self, f0: f64, integral: ScaleBias, average: ScaleBias) -> f64 {
        let (single, lost) = (integral.at_f0(f0), 1.0 - integral.e());
        let f_avg = average_schlick(f0);
        match self {
            MultipleScattering::None => single,
            MultipleScattering::KullaConty => {
                let e_avg = average.e();
                single + f_avg * f_avg * e_avg / (1.0 - f_avg * (1.0 - e_avg)) * lost
            }
            MultipleScattering::Turquin => single * (1.0 + f0 * lost / integral.e()),
            MultipleScattering::FdezAguera => single + single * f_avg / (1.0 - lost * f_avg) * lost,
        }
    }
}

/// The furnaces of a material over a grid: for every F0 each split. An error for a lobe that may
/// give back more than it receives, and for a reciprocal split on a base that is not Lambert's.
pub fn furnaces(
    material: Material,
    f0s: &[f64],
    splits: &[Split],
    grid: &Grid,
    rule: &Rule,
) -> Result<Vec<Furnace>> {
    check_leaves_energy(material.lobe)?;
    match material.multiple_scattering {
        MultipleScattering::None | MultipleScattering::KullaConty => (),
        MultipleScattering::Turquin | MultipleScattering::FdezAguera => {
            check_scatters(material.lobe)?;
        }
    }
    if splits.contains(&Split::Reciprocal) && material.base != Diffuse::Lambert {
        let (got, cure) =
            (material.base.word(), "choose lambert, or leave the reciprocal split out");
        return Err(Error::bad_input(
            "diffuse",
            "lambert, on which the reciprocal split stands",
            got,
            cure,
        ));
    }
    let integrals = Integrals::new(material, grid, rule);
    let combinations = f0s.iter().flat_map(|&f0| splits.iter().map(move |&split| (f0, split)));
    Ok(combinations.map(|(f0, split)| integrals.furnace(f0, split)).collect())
}

/// The integrals of a material, whatever its F0 and split.
struct Integrals<'a> {
    material: Material,
    grid: &'a Grid,
    /// At the points of the grid.
    points: Vec<ScaleBias>,
    /// The average of each row, as a table would carry it.
    averages: Vec<ScaleBias>,
    /// At the directions of that average, and at others, so that the integral over light closes
    /// honestly or not.
    averaging: Rows,
    light: Rows,
}

/// Integrals at the same directions for each row of a grid.
struct Rows {
    /// (n·v, weight)
    nodes: Vec<(f64, f64)>,
    integrals: Vec<ScaleBias>,
}

impl<'a> Integrals<'a> {
    fn new(material: Material, grid: &'a Grid, rule: &Rule) -> Self {
        let bake = |grid: &Grid| cpu::bake(material.lobe, grid, rule, &|_| ());
        let over = |nodes: &[(f64, f64)]| {
            bake(&grid.at_directions(nodes.iter().map(|node| node.0).collect()))
        };
        let rows =
            |nodes: Vec<(f64, f64)>, field: &Field| Rows { nodes, integrals: field.scale_bias() };
        let (averaging, light) = (average_nodes(), light_nodes());
        let (at_averaging, at_light) = (over(&averaging), over(&light));
        Integrals {
            material,
            grid,
            points: bake(grid).scale_bias(),
            averages: averages(&averaging, &at_averaging).scale_bias(),
            averaging: rows(averaging, &at_averaging),
            light: rows(light, &at_light),
        }
    }

    /// The specular albedo S for integrals of a row.
    fn specular(&self, f0: f64, integral: ScaleBias, row: usize) -> f64 {
        self.material.multiple_scattering.albedo(f0, integral, self.averages[row])
    }

    /// ∫ (1-S(l)) 2 μ dμ of a row by the nodes of `rows`.
    fn left_over(&self, f0: f64, rows: &Rows, row: usize) -> f64 {
        let integrals = &rows.integrals[row * rows.nodes.len()..][..rows.nodes.len()];
        let left = |(&(_, weight), &integral): (&(f64, f64), &ScaleBias)| {
            weight * (1.0 - self.specular(f0, integral, row))
        };
        rows.nodes.iter().zip(integrals).map(left).sum()
    }

    /// The share of the base that the reciprocal split multiplies 1 - S(v) with: 1 but for errors
    /// of the averages.
    fn closure(&self, f0: f64, row: usize) -> f64 {
        // Where nothing is left on average nothing reaches the base: S_avg = 1 to the digits that
        // its errors leave.
        const NOTHING: f64 = 1e-9;
        let left = self.left_over(f0, &self.averaging, row);
        if left < NOTHING { 0.0 } else { self.left_over(f0, &self.light, row) / left }
    }

    fn furnace(&self, f0: f64, split: Split) -> Furnace {
        let closures: Vec<f64> = match split {
            Split::Reciprocal => {
                (0..self.averages.len()).map(|row| self.closure(f0, row)).collect()
            }
            Split::Naive | Split::Albedo => Vec::new(),
        };
        let energy = |index: usize| {
            let ((mu, alpha), row) = (self.grid.point(index), index / self.grid.mus.len());
            let s = self.specular(f0, self.points[index], row);
            let albedo = self.material.base.albedo(mu, roughness_of(alpha));
            s + match split {
                Split::Naive => (1.0 - f0) * schlick_complement(mu) * albedo,
                Split::Albedo => (1.0 - s) * albedo,
                Split::Reciprocal => (1.0 - s) * closures[row],
            }
        };
        Furnace { f0, split, energy: (0..self.grid.len()).map(energy).collect() }
    }
}

/// (n·l, weight) of the directions of light, crowded at both ends.
fn light_nodes() -> Vec<(f64, f64)> {
    tanh_sinh(64)
        .into_iter()
        .map(|node| (node.from_start, 2.0 * node.weight * node.from_start))
        .collect()
}

impl Furnace {
    /// The extremes over the grid.
    pub fn extremes(&self, grid: &Grid) -> Extremes {
        let pick = |better: fn(f64, f64) -> bool| {
            let best = |best: usize, i: usize| {
                if better(self.energy[i], self.energy[best]) { i } else { best }
            };
            (0..self.energy.len()).fold(0, best)
        };
        let (least, most) = (pick(|a, b| a < b), pick(|a, b| a > b));
        Extremes {
            least: self.energy[least],
            least_at: grid.point(least),
            most: self.energy[most],
            most_at: grid.point(most),
            mean: self.energy.iter().sum::<f64>() / self.energy.len() as f64,
        }
    }
}

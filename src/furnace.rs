//! The white furnace: a surface under light from everywhere, radiance 1. A material that keeps its energy gives back
//! 1 at every angle and roughness; this tells what a combination of specular lobe, multiple scattering, diffuse base
//! and split gives back instead.

use crate::backend::cpu;
use crate::error::{Error, Result};
use crate::integrate::ScaleBias;
use crate::integrate::average::{average_nodes, averages};
use crate::integrate::rule::Rule;
use crate::lut::Grid;
use crate::lut::energy::check_leaves_energy;
use crate::model::fresnel::schlick_complement;
use crate::model::{Diffuse, Microfacet};
use crate::quadrature::double_exponential::tanh_sinh;
use crate::units::{roughness_of, word};
use serde::{Deserialize, Serialize};

/// What gives back the energy that a Smith lobe loses between its facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MultipleScattering {
    /// Nothing.
    None,
    /// Kulla and Conty 2017, with the Fresnel factor F_avg² E_avg / (1 - F_avg (1-E_avg)) (Hill 2018).
    KullaConty,
    /// Turquin 2019: the lobe times 1 + F0 (1-E)/E.
    Turquin,
    /// Fdez-Agüera 2019, from A and B alone.
    FdezAguera,
}

/// What of the light reaches the diffuse base and comes back: see [`crate::lut::energy`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Split {
    /// 1 - F(n·v).
    Naive,
    /// 1 - S(v), S being the specular albedo at F0.
    Albedo,
    /// (1-S(l))(1-S(v))/(1-S_avg), on a Lambertian base.
    Reciprocal,
}

impl Split {
    /// All of them.
    pub const ALL: [Split; 3] = [Split::Naive, Split::Albedo, Split::Reciprocal];
}

/// A material: its parts, for any F0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The specular lobe.
    pub lobe: Microfacet,
    /// What gives back its loss.
    pub multiple_scattering: MultipleScattering,
    /// The white base.
    pub base: Diffuse,
}

/// What comes back at each angle and roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct Furnace {
    /// F0 of the specular lobe.
    pub f0: f64,
    /// How the base is weighted.
    pub split: Split,
    /// The energy at each point of the grid, in its order; 1 is all of it.
    pub energy: Vec<f64>,
}

/// The extremes of a furnace, and where they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// The specular albedo with the loss given back, at F0 for the integrals of a direction and of the average.
    pub fn albedo(self, f0: f64, integral: ScaleBias, average: ScaleBias) -> f64 {
        let (single, lost) = (integral.at_f0(f0), 1.0 - integral.e());
        // ∫ of Schlick's F against 2 μ dμ: F0 + (1-F0)/21.
        let f_avg = f0 + (1.0 - f0) / 21.0;
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

/// The furnaces of a material over a grid: for every F0 each split.
pub fn furnaces(material: Material, f0s: &[f64], splits: &[Split], grid: &Grid, rule: &Rule) -> Result<Vec<Furnace>> {
    let Material { lobe, base, .. } = material;
    check_leaves_energy(lobe)?;
    if splits.contains(&Split::Reciprocal) && base != Diffuse::Lambert {
        let cure = "choose lambert, or leave the reciprocal split out";
        return Err(Error::bad_input("diffuse", "lambert, on which the reciprocal split stands", word(base), cure));
    }
    let points = cpu::bake(lobe, grid, rule, &|_| ());
    // The averages that a table would carry, and for the integral over light other nodes, so that it closes honestly
    // or not.
    let (averaging, light) = (average_nodes(), light_nodes());
    let over = |nodes: &[(f64, f64)]| {
        let directions = grid.at_directions(nodes.iter().map(|node| node.0).collect());
        cpu::bake(lobe, &directions, rule, &|_| ())
    };
    let (averaging_rows, light_rows) = (over(&averaging), over(&light));
    let averages = averages(&averaging, &averaging_rows);
    let furnace = |(f0, split)| {
        let specular = |integral, row: usize| material.multiple_scattering.albedo(f0, integral, averages[row]);
        // For each α: 1 - S_avg as the shader has it, and the ∫ (1-S(l)) 2 μ dμ that it should cancel.
        let left_over = |nodes: &[(f64, f64)], integrals: &[ScaleBias], row: usize| -> f64 {
            let integrals = &integrals[row * nodes.len()..][..nodes.len()];
            nodes.iter().zip(integrals).map(|(&(_, weight), &v)| weight * (1.0 - specular(v, row))).sum()
        };
        let left = |row| (left_over(&averaging, &averaging_rows, row), left_over(&light, &light_rows, row));
        let left: Vec<(f64, f64)> = (0..averages.len()).map(left).collect();
        let energy = |index: usize| {
            let ((mu, alpha), row) = (grid.point(index), index / grid.mus.len());
            let s = specular(points[index], row);
            let albedo = base.albedo(mu, roughness_of(alpha));
            s + match split {
                Split::Naive => (1.0 - f0) * schlick_complement(mu) * albedo,
                Split::Albedo => (1.0 - s) * albedo,
                // Where nothing is left on average nothing reaches the base.
                Split::Reciprocal if left[row].0 < 1e-9 => 0.0,
                Split::Reciprocal => (1.0 - s) / left[row].0 * left[row].1,
            }
        };
        Furnace { f0, split, energy: (0..grid.len()).map(energy).collect() }
    };
    let combinations = f0s.iter().flat_map(|&f0| splits.iter().map(move |&split| (f0, split)));
    Ok(combinations.map(furnace).collect())
}

/// (n·l, weight) of the directions of light, crowded at both ends.
fn light_nodes() -> Vec<(f64, f64)> {
    tanh_sinh(64).into_iter().map(|node| (node.from_start, 2.0 * node.weight * node.from_start)).collect()
}

impl Furnace {
    /// The extremes over the grid.
    pub fn extremes(&self, grid: &Grid) -> Extremes {
        let pick = |better: fn(f64, f64) -> bool| {
            let best = |best: usize, i: usize| if better(self.energy[i], self.energy[best]) { i } else { best };
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

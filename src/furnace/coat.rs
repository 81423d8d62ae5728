//! Seven formulas for a Lambertian base of albedo ρ below a rough dielectric interface, in the
//! white furnace: what each gives back, and whether it is the same for light that goes the other
//! way.
//!
//! Each is f_d = ρ' a(v) b(l)/π beside the interface's own reflection S(v), and gives back
//!
//! E(v) = S(v) + ρ' a(v) 2 ∫ b(l) μ dμ.
//!
//! The last is what follows from reciprocity alone: see [`crate::lut::energy`].

use crate::backend::cpu;
use crate::brdf::fresnel::{Basis, Dielectric};
use crate::brdf::{Fresnel, Microfacet};
use crate::choice::{Choice, choice};
use crate::error::Result;
use crate::integrate::Integrand;
use crate::integrate::average::average_nodes;
use crate::integrate::rule::Rule;
use crate::lut::Energy;
use crate::lut::energy::effective_albedo;
use crate::table::grid::Grid;

/// A formula for the base; the last is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coat {
    /// ρ: specular and diffuse are added.
    Sum,
    /// ρ (1 - F(v)).
    Naive,
    /// ρ (1 - F(v)) (1 - F(l)), as in Disney's BRDF.
    BothWays,
    /// 28 ρ/23 (1 - F0) (1 - (1 - μ_v/2)⁵) (1 - (1 - μ_l/2)⁵) (Ashikhmin and Shirley 2000).
    AshikhminShirley,
    /// ρ (1 - S(v)): OpenPBR, MaterialX, Arnold, Cycles.
    AlbedoScaling,
    /// ρ (1 - S(v)) (1 - S(l)) / (1 - S_avg) (Shirley et al. 1997; Kelemen and Szirmay-Kalos 2001).
    Reciprocal,
    /// The same with ρ (1-K)/(1 - ρK) for ρ (Saunderson 1942; Wolff 1994).
    Interreflecting,
}

choice!(Coat, "coat", {
    Sum = "sum", "rho + S, no split";
    Naive = "naive", "rho (1-F(v))";
    BothWays = "both-ways", "rho (1-F(v)) (1-F(l)), as in Disney's";
    AshikhminShirley = "ashikhmin-shirley", "Ashikhmin and Shirley 2000";
    AlbedoScaling = "albedo-scaling", "rho (1-S(v)): OpenPBR, MaterialX, Arnold, Cycles";
    Reciprocal = "reciprocal", "rho (1-S(v)) (1-S(l)) / (1-S_avg): OSPRay, Adobe";
    Interreflecting = "interreflecting", "the same with rho (1-K) / (1 - rho K)";
});

/// The energy that comes back from a coated base.
#[derive(Clone, Debug, PartialEq)]
pub struct Coated {
    /// The formula.
    pub coat: Coat,
    /// The albedo of the base.
    pub rho: f64,
    /// The energy at each point of the grid, in its order.
    pub energy: Vec<f64>,
    /// Its average over all directions, of each row.
    pub averages: Vec<f64>,
    /// The largest |f(l,v) - f(v,l)| π/ρ over the grid's directions.
    pub asymmetry: f64,
}

/// A rough interface above a base.
struct Interface {
    medium: Dielectric,
    /// S at the points of a grid and at the directions of averages, row by row.
    points: Vec<f64>,
    directions: Vec<f64>,
    /// (n·v, weight) of these.
    nodes: Vec<(f64, f64)>,
}

/// The albedo of a direction in a row of a grid.
#[derive(Clone, Copy)]
struct Direction {
    mu: f64,
    /// S
    specular: f64,
    /// S_avg of the row.
    average: f64,
}

/// Every formula with every albedo of the base over a grid, for the interface to a medium with
/// index of refraction `ior`. An error for a lobe that has no such split.
pub fn coated(
    lobe: Microfacet,
    ior: f64,
    rhos: &[f64],
    grid: &Grid,
    rule: &Rule,
) -> Result<Vec<Coated>> {
    Energy::of_interface(lobe, ior)?;
    let medium = Dielectric::new(ior)?;
    let integrand = Integrand::Specular(lobe, Fresnel::Dielectric(medium));
    let bake = |grid: &Grid| cpu::bake(integrand, grid, rule, &|_| ()).values().to_vec();
    let nodes = average_nodes();
    let directions = bake(&grid.at_directions(nodes.iter().map(|node| node.0).collect()));
    let interface = Interface { medium, points: bake(grid), directions, nodes };
    let every = |&rho: &f64| Coat::ALL.iter().map(move |&coat| (coat, rho));
    Ok(rhos.iter().flat_map(every).map(|(coat, rho)| interface.coated(coat, rho, grid)).collect())
}

impl Interface {
    fn reflectance(&self, mu: f64) -> f64 {
        let [f] = self.medium.weights(mu);
        f
    }

    /// a(v).
    fn of_view(&self, coat: Coat, v: Direction) -> f64 {
        match coat {
            Coat::Sum => 1.0,
            Coat::Naive | Coat::BothWays => 1.0 - self.reflectance(v.mu),
            Coat::AshikhminShirley => {
                28.0 / 23.0 * (1.0 - self.reflectance(1.0)) * ashikhmin_shirley(v.mu)
            }
            Coat::AlbedoScaling => 1.0 - v.specular,
            Coat::Reciprocal | Coat::Interreflecting => (1.0 - v.specular) / (1.0 - v.average),
        }
    }

    /// b(l).
    fn of_light(&self, coat: Coat, l: Direction) -> f64 {
        match coat {
            Coat::Sum | Coat::Naive | Coat::AlbedoScaling => 1.0,
            Coat::BothWays => 1.0 - self.reflectance(l.mu),
            Coat::AshikhminShirley => ashikhmin_shirley(l.mu),
            Coat::Reciprocal | Coat::Interreflecting => 1.0 - l.specular,
        }
    }

    /// ρ'.
    fn albedo(&self, coat: Coat, rho: f64, average: f64) -> f64 {
        let n = self.medium.ior();
        match coat {
            Coat::Interreflecting => effective_albedo(rho, 1.0 - (1.0 - average) / (n * n)),
            _ => rho,
        }
    }

    fn coated(&self, coat: Coat, rho: f64, grid: &Grid) -> Coated {
        let (width, count) = (grid.mus.len(), self.nodes.len());
        let mut coated =
            Coated { coat, rho, energy: Vec::new(), averages: Vec::new(), asymmetry: 0.0 };
        for row in 0..grid.alphas.len() {
            let (specular, of_nodes) =
                (&self.points[row * width..][..width], &self.directions[row * count..][..count]);
            let mean = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
                let nodes = self.nodes.iter().zip(of_nodes);
                nodes.map(|(&(mu, weight), &s)| weight * of(mu, s)).sum()
            };
            let average = mean(&|_, s| s);
            let at = |mu, specular| Direction { mu, specular, average };
            let albedo = self.albedo(coat, rho, average);
            let light = mean(&|mu, s| self.of_light(coat, at(mu, s)));
            let view = mean(&|mu, s| self.of_view(coat, at(mu, s)));
            coated.averages.push(average + albedo * view * light);
            let directions = grid.mus.iter().zip(specular).map(|(&mu, &s)| at(mu, s));
            let mut factors: Vec<(f64, f64)> = Vec::with_capacity(width);
            for v in directions {
                let (a, b) = (self.of_view(coat, v), self.of_light(coat, v));
                coated.energy.push(v.specular + albedo * a * light);
                for (other_a, other_b) in &factors {
                    coated.asymmetry = coated.asymmetry.max((a * other_b - other_a * b).abs());
                }
                factors.push((a, b));
            }
        }
        coated
    }
}

fn ashikhmin_shirley(mu: f64) -> f64 {
    1.0 - libm::pow(1.0 - 0.5 * mu, 5.0)
}

//! Spheres of glass, of a coated base and of a metal in a white furnace and under the sky: by a
//! table, by the integral, and their difference times 100.
//!
//! In the furnace the table is held against the integrals that its texels hold. Under the sky the
//! table's numbers scale a prefiltered sky, as engines do; the integral has no such split. What is
//! refracted sees the sky as if the ball had no far side.

mod optics;

use self::optics::{IOR, LOBE, Lobe, Optics, optics};
use super::moments::Moments;
use super::shade::{AROUND_DIFFERENCE, BASE, SKY0, SKY1, SKY2, normal, sky};
use super::{Column, ROUGHNESSES, pixel, srgb};
use crate::backend::Progress;
use crate::error::Result;
use crate::image::Picture;
use crate::lut::energy::effective_albedo;
use crate::units::PerceptualRoughness;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// What the spheres are made of; the lobe is GGX.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Material {
    /// Glass, n = 1.5, seen from outside.
    Glass,
    /// A red base below an interface, n = 1.5.
    Coat,
    /// Gold, by its measured n + ik.
    Metal,
}

/// Where the light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// Everywhere.
    Furnace,
    /// The sky.
    Sky,
}

/// How a sphere is lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// By numbers read from a table.
    Table,
    /// By the integral itself.
    Integral,
}

/// One sphere.
pub struct Sphere {
    optics: Optics,
    column: Column,
}

/// The rows of the picture.
pub const ROWS: [(Light, Option<Way>); 6] = [
    (Light::Furnace, Some(Way::Table)),
    (Light::Furnace, Some(Way::Integral)),
    (Light::Furnace, None),
    (Light::Sky, Some(Way::Table)),
    (Light::Sky, Some(Way::Integral)),
    (Light::Sky, None),
];

/// The rows below each other, a column for each roughness, `cell` pixels for each sphere; a row
/// without a way shows a hundred times the difference of both. `progress` is told of pixels.
pub fn render(material: Material, cell: usize, progress: Progress) -> Result<Picture> {
    let width = cell * ROUGHNESSES.len();
    let mut picture = Picture::new(width, cell * ROWS.len(), [0; 3]);
    for (i, sphere) in spheres(material)?.iter().enumerate() {
        for (j, &(light, way)) in ROWS.iter().enumerate() {
            let line = |y: usize| {
                let at = |x| pixel((x, y), cell, |p| sphere.shade(light, way, p));
                (0..cell).map(at).collect::<Vec<_>>()
            };
            let pixels: Vec<[f64; 3]> = (0..cell).into_par_iter().flat_map_iter(line).collect();
            for (k, colour) in pixels.into_iter().enumerate() {
                picture.set(i * cell + k % cell, j * cell + k / cell, colour.map(srgb));
            }
            progress(cell * cell);
        }
    }
    Ok(picture)
}

/// A sphere for each roughness.
pub fn spheres(material: Material) -> Result<Vec<Sphere>> {
    let columns =
        ROUGHNESSES.map(|r| PerceptualRoughness::new(r).map(|r| Column::new(LOBE.ndf, r)));
    let columns: Vec<Column> = columns.into_iter().collect::<Result<_>>()?;
    Ok(optics(material, &columns)?
        .into_iter()
        .zip(columns)
        .map(|(optics, column)| Sphere { optics, column })
        .collect())
}

/// The sky by brute force: the moments of light about n, for v along z.
pub fn lit(moments: Moments, n: DVec3) -> DVec3 {
    let [e, along_n, along_t, nn, nt, tt] = moments;
    // The height axis has n.y along n, forward/sin θ_v along t = (v - μn)/sin θ_v, and the rest
    // across both.
    let (up, forward) = (n.y, -n.z * n.y);
    let forward2 = forward * forward / (n.x * n.x + n.y * n.y).max(f64::MIN_POSITIVE);
    let across2 = 1.0 - up * up - forward2;
    let first = up * along_n + forward * along_t;
    let second = up * up * nn + 2.0 * up * forward * nt + forward2 * tt + across2 * (e - nn - tt);
    SKY0 * e + SKY1 * first + SKY2 * (1.5 * second - 0.5 * e)
}

impl Lobe {
    /// Its light at a place with this normal.
    fn light(&self, way: Way, n: DVec3, means: (f64, f64)) -> DVec3 {
        match way {
            Way::Table => mirrored(self.albedo.table.at(n.z)[0], n, means),
            Way::Integral => lit(self.moments.at(n.z), n),
        }
    }
}

/// The sky around the mirror direction of v, whose height is 2 n·v n.y.
fn mirrored(albedo: f64, n: DVec3, means: (f64, f64)) -> DVec3 {
    albedo * sky(2.0 * n.z * n.y, means.0, means.1)
}

impl Sphere {
    /// The colour at a place of the unit square; without a way a hundredfold difference.
    fn shade(&self, light: Light, way: Option<Way>, p: DVec2) -> DVec3 {
        let (n, beyond) = normal(p);
        match (light, way) {
            (_, None) if beyond => AROUND_DIFFERENCE,
            (Light::Furnace, _) if beyond => DVec3::ONE,
            (Light::Sky, _) if beyond => sky(n.y.clamp(-1.0, 1.0), 1.0, 1.0),
            (_, Some(way)) => self.radiance(light, way, n),
            (_, None) => {
                let [table, integral] =
                    [Way::Table, Way::Integral].map(|way| self.radiance(light, way, n));
                100.0 * (table - integral).abs()
            }
        }
    }

    /// The radiance towards v = (0, 0, 1) at a place with this normal.
    pub fn radiance(&self, light: Light, way: Way, n: DVec3) -> DVec3 {
        match light {
            Light::Furnace => self.furnace(way, n.z),
            Light::Sky => self.sky(way, n),
        }
    }

    fn furnace(&self, way: Way, mu: f64) -> DVec3 {
        match &self.optics {
            Optics::Glass { albedos, .. } => DVec3::splat(albedos.at(way, mu).iter().sum()),
            Optics::Coat { interface, averages, .. } => {
                let [s] = interface.albedo.at(way, mu);
                s + (1.0 - s) * coloured(by(way, averages))
            }
            Optics::Metal(lobes) => each(lobes, |lobe| DVec3::splat(lobe.albedo.at(way, mu)[0])),
        }
    }

    fn sky(&self, way: Way, n: DVec3) -> DVec3 {
        let (mu, means) = (n.z, self.column.means);
        match &self.optics {
            Optics::Glass { albedos, moments: [reflected, transmitted], means: refracted } => {
                match way {
                    Way::Table => {
                        let [r, t] = albedos.table.at(mu);
                        // l = (-v + (μ - g) n)/η.
                        let turn = mu - (IOR * IOR - 1.0 + mu * mu).sqrt();
                        let height = turn * n.y / IOR;
                        mirrored(r, n, means) + t * sky(height, refracted.0, refracted.1)
                    }
                    Way::Integral => lit(reflected.at(mu), n) + lit(transmitted.at(mu), n),
                }
            }
            Optics::Coat { interface, averages, passed } => {
                let [s] = interface.albedo.at(way, mu);
                // What falls on the base, as if it were Lambert's, or as it does.
                let (p1, p2) = by(way, passed);
                let base = sky(n.y, p1, p2);
                interface.light(way, n, means) + (1.0 - s) * coloured(by(way, averages)) * base
            }
            Optics::Metal(lobes) => each(lobes, |lobe| lobe.light(way, n, means)),
        }
    }
}

/// Each channel by its own lobe.
fn each(lobes: &[Lobe], of: impl Fn(&Lobe) -> DVec3) -> DVec3 {
    let channels = lobes.iter().zip(DVec3::AXES);
    channels.map(|(lobe, channel)| channel * of(lobe)).sum()
}

/// What is by the table, or what is by the integral.
fn by<T: Copy>(way: Way, &[by_table, by_integral]: &[T; 2]) -> T {
    match way {
        Way::Table => by_table,
        Way::Integral => by_integral,
    }
}

/// The base's albedo as it is seen through the interface.
fn coloured(average: f64) -> DVec3 {
    let k = 1.0 - (1.0 - average) / (IOR * IOR);
    DVec3::from_array(BASE.to_array().map(|rho| effective_albedo(rho, k)))
}

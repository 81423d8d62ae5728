//! Spheres that show what tables and lobes look like: a row for each lobe, a column for each roughness.
//!
//! *Punctual.* A light without extent, and the rendering equation of games: L = (c_diff + π D V F) ⊗ c_light (n·l), where c_light
//! is the radiance that a white Lambertian surface facing the light sends out. That is the convention which makes the π go:
//! L = f E with irradiance E = π c_light n·l, so that c_diff/π and D V F are both times π. With Blinn-Phong's D and V = 1/4,
//! π D V F is (n+2)/8 (n·h)^n F (Hoffman 2013).
//!
//! *Furnace.* Light from everywhere: a gold sphere by the split sum with a baked table, by the integral itself, and their
//! difference times 100.
//!
//! *Sky.* L(y) = s0 + s1 P1(y) + s2 P2(y) of the height y of a direction. Prefiltering it by a kernel around a direction scales
//! s1 and s2 by the kernel's means of P1 and P2 (Funk and Hecke), so that both factors of the split sum are exact.

use crate::backend::shader::preview_kernel;
use crate::backend::vulkan::render::{RowData, render_row};
use crate::backend::{Backend, cpu};
use crate::error::Result;
use crate::integrate::ScaleBias;
use crate::integrate::h_space::{HSpaceNodes, HSpaceRule, h_space};
use crate::integrate::rule::{REFERENCE, Rule};
use crate::lut::{Dfg, DfgChannels, Lut};
use crate::model::fresnel::schlick_weight;
use crate::model::{Microfacet, Ndf};
use crate::precision::Precision;
use crate::quadrature::gauss_legendre::gauss_legendre;
use crate::quadrature::slope_map::Power;
use crate::report::map::Picture;
use crate::request::Request;
use crate::table::Table;
use crate::units::{Alpha, PerceptualRoughness};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// What lights the spheres. The numbers are those of the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    /// One punctual light.
    Punctual = 0,
    /// A furnace, by the table.
    FurnaceTable = 1,
    /// A furnace, by the integral.
    FurnaceIntegral = 2,
    /// 100 times their difference.
    FurnaceDifference = 3,
    /// A sky.
    Sky = 4,
}

/// A row of spheres.
#[derive(Clone, Debug)]
pub struct Row {
    /// The lobe.
    pub lobe: Microfacet,
    /// What lights it.
    pub scene: Scene,
    columns: Vec<Column>,
    table: Table,
}

/// A sphere's roughness and what follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column {
    alpha: f64,
    roughness: f64,
    /// The means of P1 and P2 over the prefiltering kernel.
    means: (f64, f64),
}

/// Perceptual roughness of the columns.
pub const ROUGHNESSES: [f64; 6] = [0.15, 0.3, 0.45, 0.6, 0.8, 1.0];

/// Texels along the edge of the rows' tables.
const TABLE: usize = 64;

/// The rule of the furnace's integral, that of `h288`: what it leaves is a hundredth of what the table's texels do.
const RULE: HSpaceRule =
    HSpaceRule { radial: 16, azimuth: 8, radial_horizon: 20, azimuth_horizon: 8, power: Power::Four };

const BASE: DVec3 = DVec3::new(0.5, 0.08, 0.06);
const GOLD: DVec3 = DVec3::new(1.0, 0.78, 0.34);
const DIELECTRIC: f64 = 0.04;
const LIGHT: DVec3 = DVec3::new(0.48, 0.6, 0.64);
const LIGHT_COLOUR: f64 = 1.6;
const SKY0: DVec3 = DVec3::new(0.55, 0.6, 0.7);
const SKY1: DVec3 = DVec3::new(0.3, 0.42, 0.6);
const SKY2: DVec3 = DVec3::new(-0.22, -0.12, 0.0);

impl Row {
    /// The row, its table baked.
    pub fn new(lobe: Microfacet, scene: Scene) -> Result<Self> {
        let lut = Lut::Dfg(Dfg { lobe, channels: DfgChannels::Ab });
        let request = Request::with_default_axes(lut, (TABLE, TABLE), Precision::F32)?;
        let grid = request.grid()?;
        let rule = Rule::for_cpu(lobe, Precision::F16.default_tolerance(), grid.len()).unwrap_or(REFERENCE);
        let values: Vec<f64> = cpu::bake(lobe, &grid, &rule, &|_| ()).iter().flat_map(|v| [v.a, v.b]).collect();
        let values = grid.stored(&lut, Precision::F64, &values)?;
        let channels = lut.channels().to_vec();
        let table = Table { x: request.x, y: request.y, channels, values, provenance: lut.provenance() };
        let column = |&r: &f64| PerceptualRoughness::new(r).map(|r| Column::new(lobe.ndf, r));
        Ok(Row { lobe, scene, columns: ROUGHNESSES.iter().map(column).collect::<Result<_>>()?, table })
    }

    /// What the shader needs of it.
    fn data(&self, cell: usize) -> RowData {
        let column = |c: &Column| [c.alpha, c.roughness, c.means.0, c.means.1].map(|value| value as f32);
        RowData {
            columns: self.columns.iter().map(column).collect(),
            table: self
                .table
                .plane(0)
                .into_iter()
                .zip(self.table.plane(1))
                .map(|(a, b)| [a as f32, b as f32])
                .collect(),
            cell,
            scene: self.scene as u32,
        }
    }
}

impl Column {
    /// The kernel is that of Karis 2013: half vectors by D n·h with n = v, light weighted by n·l.
    fn new(ndf: Ndf, roughness: PerceptualRoughness) -> Self {
        let alpha = Alpha::from(roughness).get();
        let (mut weight, mut p1, mut p2) = (0.0, 0.0, 0.0);
        // θ_h from 0 to π/4, where n·l = cos 2θ_h is 0, in the slope: y = tan θ_h/width.
        let end = 1.0 / ndf.width(alpha);
        for node in gauss_legendre(256) {
            let y = end * node.at;
            let t = (y / end) * (y / end);
            let x = (1.0 - t) / (1.0 + t);
            let w = node.weight * y * ndf.slope_density(y * y, alpha) * x;
            (weight, p1, p2) = (weight + w, p1 + w * x, p2 + w * (1.5 * x * x - 0.5));
        }
        Column { alpha, roughness: roughness.get(), means: (p1 / weight, p2 / weight) }
    }
}

/// The rows below each other, `cell` pixels for each sphere, by whoever `backend` is.
pub fn render(rows: &[Row], cell: usize, backend: &Backend) -> Result<Picture> {
    let width = cell * ROUGHNESSES.len();
    let mut picture = Picture::new(width, cell * rows.len(), [0; 3]);
    for (index, row) in rows.iter().enumerate() {
        let pixels = match backend.device() {
            Some(gpu) => render_row(gpu, &preview_kernel(row.lobe, RULE.power)?, &row.data(cell), &RULE)?,
            None => render_row_on_cpu(row, cell),
        };
        for (i, colour) in pixels.into_iter().enumerate() {
            picture.set(i % width, index * cell + i / width, colour.map(srgb));
        }
    }
    Ok(picture)
}

/// The same row as the shader's, in f64.
fn render_row_on_cpu(row: &Row, cell: usize) -> Vec<[f64; 3]> {
    let (width, nodes) = (cell * row.columns.len(), RULE.nodes());
    let pixel = |index: usize| {
        let (i, j) = (index % width, index / width);
        let column = row.columns[i / cell];
        let mut sum = DVec3::ZERO;
        for s in 0..4 {
            let place = |at: usize, part: usize| (at as f64 + 0.25 + 0.5 * part as f64) / cell as f64;
            let p = DVec2::new(place(i % cell, s % 2), place(j, s / 2));
            sum += 0.25 * shade(row, p, column, &nodes).min(DVec3::ONE);
        }
        sum.to_array()
    };
    (0..width * cell).into_par_iter().map(pixel).collect()
}

/// π D V: what a lobe contributes to L = (c_diff + π D V F) c_light n·l.
pub fn pi_d_v(lobe: Microfacet, x: f64, mu: f64, nh: f64, alpha: f64) -> f64 {
    let (c2, width) = (nh * nh, lobe.ndf.width(alpha));
    let y2 = (1.0 - nh) * (1.0 + nh) / (c2 * width * width);
    PI * lobe.ndf.slope_density(y2, alpha) / (width * width * c2 * c2) * lobe.cosine_visibility(x, mu, alpha) / x
}

/// The table as a renderer reads it.
fn lookup(row: &Row, mu: f64, roughness: f64) -> ScaleBias {
    let texel = row.table.bilinear(mu, roughness);
    ScaleBias { a: texel[0], b: texel[1] }
}

/// The sky in the direction of height y, its first and second coefficients scaled by a kernel's means.
pub fn sky(y: f64, p1: f64, p2: f64) -> DVec3 {
    SKY0 + SKY1 * (p1 * y) + SKY2 * (p2 * (1.5 * y * y - 0.5))
}

fn punctual(row: &Row, n: DVec3, column: Column) -> DVec3 {
    let x = n.dot(LIGHT);
    if x <= 0.0 {
        return DVec3::ZERO;
    }
    let h = (LIGHT + DVec3::Z).normalize();
    let f = DIELECTRIC + (1.0 - DIELECTRIC) * schlick_weight(h.z);
    let specular = f * pi_d_v(row.lobe, x, n.z.max(1e-4), n.dot(h).clamp(1e-4, 1.0), column.alpha);
    (BASE + specular) * (LIGHT_COLOUR * x)
}

fn furnace(row: &Row, n: DVec3, column: Column, nodes: &HSpaceNodes) -> DVec3 {
    let mu = n.z.max(0.0);
    let gold = |v: ScaleBias| GOLD * v.a + v.b;
    let (a, b) = (gold(lookup(row, mu, column.roughness)), gold(h_space(row.lobe, mu, column.alpha, nodes)));
    match row.scene {
        Scene::FurnaceTable => a,
        Scene::FurnaceIntegral => b,
        _ => 100.0 * (a - b).abs(),
    }
}

fn daylight(row: &Row, n: DVec3, column: Column) -> DVec3 {
    let mu = n.z.max(0.0);
    let e = lookup(row, mu, column.roughness).at_f0(DIELECTRIC);
    // The reflected direction of v = (0, 0, 1) has the height 2 n·v n.y.
    let specular = e * sky(2.0 * mu * n.y, column.means.0, column.means.1);
    specular + (1.0 - e) * BASE * sky(n.y, 2.0 / 3.0, 0.25)
}

/// The colour at a place of the unit square around a sphere; y runs down.
fn shade(row: &Row, p: DVec2, column: Column, nodes: &HSpaceNodes) -> DVec3 {
    let (x, y) = ((2.0 * p.x - 1.0) * 1.06, (1.0 - 2.0 * p.y) * 1.06);
    let r2 = x * x + y * y;
    let n = DVec3::new(x, y, (1.0 - r2).max(0.0).sqrt());
    match row.scene {
        Scene::Punctual | Scene::FurnaceDifference if r2 >= 1.0 => DVec3::splat(0.02),
        Scene::Sky if r2 >= 1.0 => sky(y.clamp(-1.0, 1.0), 1.0, 1.0),
        _ if r2 >= 1.0 => DVec3::ONE,
        Scene::Punctual => punctual(row, n, column),
        Scene::Sky => daylight(row, n, column),
        _ => furnace(row, n, column, nodes),
    }
}

/// A linear value as a byte of sRGB (IEC 61966-2-1).
fn srgb(value: f64) -> u8 {
    let v = value.clamp(0.0, 1.0);
    let encoded = if v <= 0.0031308 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

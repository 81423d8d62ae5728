//! Spheres that show what tables and lobes look like: a row for each lobe, a column for each
//! roughness.
//!
//! *Punctual.* A light without extent, and the rendering equation of games:
//! L = (c_diff + π D V F) ⊗ c_light (n·l), where c_light is the radiance that a white Lambertian
//! surface facing the light sends out. That is the convention which makes the π go: L = f E with
//! irradiance E = π c_light n·l, so that c_diff/π and D V F are both times π. With Blinn-Phong's D
//! and V = 1/4, π D V F is (n+2)/8 (n·h)^n F (Hoffman 2013).
//!
//! *Furnace.* Light from everywhere: a gold sphere by the split sum with a baked table, by the
//! integral itself, and their difference times 100.
//!
//! *Sky.* L(y) = s0 + s1 P1(y) + s2 P2(y) of the height y of a direction. Prefiltering it by a
//! kernel around a direction scales s1 and s2 by the kernel's means of P1 and P2 (Funk and Hecke),
//! so that both factors of the split sum are exact.

pub mod curve;
pub mod material;
pub mod moments;
#[cfg(feature = "vulkan")]
mod on_device;
pub mod planned;
mod shade;

use crate::backend::{Backend, Progress, cpu};
use crate::brdf::{Microfacet, Ndf};
use crate::error::Result;
use crate::image::Picture;
use crate::integrate::Integrand;
use crate::integrate::rule::Rule;
use crate::integrate::rules::{H288, REFERENCE};
use crate::numeric::quadrature::gauss_legendre::{Node, gauss_legendre};
use crate::table::axis::{Axis, AxisSpec, Parameter};
use crate::table::grid::Grid;
use crate::table::precision::Precision;
use crate::units::{Alpha, PerceptualRoughness};
use curve::{Curve, Samples, points};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use shade::{Sphere, shade};

/// Light on the spheres. The numbers are those of the shader.
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

impl Scene {
    /// The scene in words.
    pub fn about(self) -> &'static str {
        match self {
            Scene::Punctual => "in one light",
            Scene::FurnaceTable => "in a furnace by the table",
            Scene::FurnaceIntegral => "by the integral",
            Scene::FurnaceDifference => "their difference times 100",
            Scene::Sky => "under a sky",
        }
    }
}

/// A row of spheres.
#[derive(Clone, Debug)]
pub struct Row {
    /// The lobe.
    pub lobe: Microfacet,
    /// Its light.
    pub scene: Scene,
    columns: Vec<Column>,
    table: Samples<2>,
}

/// A sphere's roughness, and the prefiltering that follows from it.
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

/// Half a step of 8 bits where sRGB is steepest, 12.92 steps to one of light, of a difference that
/// is shown a hundredfold: 1 / (2 · 255 · 12.92 · 100), rounded.
const TOLERANCE: f64 = 1.5e-6;

/// The cheapest rule for so many points that is right to a picture's eye.
fn rule_of_picture(of: impl Into<Integrand>, points: usize) -> Rule {
    Rule::for_cpu(of, TOLERANCE, points).unwrap_or(REFERENCE)
}

/// The axes of the tables.
fn axes() -> Result<(Axis, Axis)> {
    let axis = |parameter| Axis::new(AxisSpec::of(parameter), TABLE);
    Ok((axis(Parameter::Nov)?, axis(Parameter::Roughness)?))
}

/// The rule of the furnace's integral, a hundred times as accurate as the lookup in the table.
pub const RULE: Rule = H288;

impl Row {
    /// The row, its table baked.
    pub fn new(lobe: Microfacet, scene: Scene) -> Result<Self> {
        let (x, y) = axes()?;
        let grid = Grid::new(&x, &y)?;
        let rule = Rule::for_cpu(lobe, Precision::F16.default_tolerance(), grid.len())
            .unwrap_or(REFERENCE);
        let table = Samples { x, y, values: points(&cpu::bake(lobe, &grid, &rule, &|_| ())) };
        let column = |&r: &f64| PerceptualRoughness::new(r).map(|r| Column::new(lobe.ndf, r));
        Ok(Row {
            lobe,
            scene,
            columns: ROUGHNESSES.iter().map(column).collect::<Result<_>>()?,
            table,
        })
    }

    /// Its spheres, ready for the CPU.
    fn spheres(&self) -> Result<Vec<Sphere>> {
        let integrates = matches!(self.scene, Scene::FurnaceIntegral | Scene::FurnaceDifference);
        let sphere = |&column: &Column| -> Result<Sphere> {
            let table = Curve::of_table(&self.table, column.roughness);
            let integral = integrates
                .then(|| Curve::of_integral(self.lobe, column.alpha, &RULE))
                .transpose()?;
            Ok(Sphere {
                lobe: self.lobe,
                column,
                integral: integral.unwrap_or_else(|| table.clone()),
                table,
            })
        };
        self.columns.iter().map(sphere).collect()
    }
}

impl Column {
    /// The kernel is that of Karis 2013: half vectors by D n·h with n = v, light weighted by n·l.
    fn new(ndf: Ndf, roughness: PerceptualRoughness) -> Self {
        let alpha = Alpha::from(roughness).get();
        // θ_h from 0 to π/4, where n·l = cos 2θ_h is 0, in the slope: y = tan θ_h/width.
        let end = 1.0 / ndf.width(alpha);
        let kernel = |node: Node| {
            let y = end * node.at;
            let t = (y / end) * (y / end);
            let x = (1.0 - t) / (1.0 + t);
            (node.weight * y * ndf.slope_density(y * y, alpha) * x, x)
        };
        let means = means(gauss_legendre(256).into_iter().map(kernel));
        Column { alpha, roughness: roughness.get(), means }
    }
}

/// The means of P1(x) and P2(x) over a kernel of weights and cosines x.
fn means(kernel: impl Iterator<Item = (f64, f64)>) -> (f64, f64) {
    let add = |(weight, p1, p2), (w, x): (f64, f64)| {
        (weight + w, p1 + w * x, p2 + w * (1.5 * x * x - 0.5))
    };
    let (weight, p1, p2) = kernel.fold((0.0, 0.0, 0.0), add);
    (p1 / weight, p2 / weight)
}

/// The rows below each other, `cell` pixels for each sphere, on a backend; `progress` is told of
/// pixels.
pub fn render(rows: &[Row], cell: usize, backend: &Backend, progress: Progress) -> Result<Picture> {
    let width = cell * ROUGHNESSES.len();
    let mut picture = Picture::new(width, cell * rows.len(), [0; 3]);
    for (index, row) in rows.iter().enumerate() {
        let pixels = render_row(row, cell, backend, progress)?;
        for (i, colour) in pixels.into_iter().enumerate() {
            picture.set(i % width, index * cell + i / width, colour.map(srgb));
        }
    }
    Ok(picture)
}

/// The pixels of a row in linear R, G, B.
#[cfg(feature = "vulkan")]
fn render_row(
    row: &Row,
    cell: usize,
    backend: &Backend,
    progress: Progress,
) -> Result<Vec<[f64; 3]>> {
    match backend.device() {
        Some(gpu) => {
            let pixels = on_device::render_row_on_device(gpu, row, cell)?;
            progress(pixels.len());
            Ok(pixels)
        }
        None => render_row_on_cpu(row, cell, progress),
    }
}

/// The pixels of a row in linear R, G, B.
#[cfg(not(feature = "vulkan"))]
fn render_row(row: &Row, cell: usize, _: &Backend, progress: Progress) -> Result<Vec<[f64; 3]>> {
    render_row_on_cpu(row, cell, progress)
}

/// The same row as the shader's, in f64.
fn render_row_on_cpu(row: &Row, cell: usize, progress: Progress) -> Result<Vec<[f64; 3]>> {
    let spheres = row.spheres()?;
    let width = cell * spheres.len();
    let line = |j: usize| {
        let pixels: Vec<_> = (0..width)
            .map(|i| {
                let sphere = &spheres[i / cell];
                pixel((i % cell, j), cell, |p| shade(row.scene, sphere, p))
            })
            .collect();
        progress(width);
        pixels
    };
    Ok((0..cell).into_par_iter().flat_map_iter(line).collect())
}

/// A pixel of a sphere's cell: the mean of four samples of a shade.
fn pixel((i, j): (usize, usize), cell: usize, shade: impl Fn(DVec2) -> DVec3) -> [f64; 3] {
    let place = |at: usize, part: usize| (at as f64 + 0.25 + 0.5 * part as f64) / cell as f64;
    let mut sum = DVec3::ZERO;
    for s in 0..4 {
        let p = DVec2::new(place(i, s % 2), place(j, s / 2));
        sum += 0.25 * shade(p).min(DVec3::ONE);
    }
    sum.to_array()
}

/// A linear value as a byte of sRGB (IEC 61966-2-1).
fn srgb(value: f64) -> u8 {
    let v = value.clamp(0.0, 1.0);
    let encoded = if v <= 0.0031308 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

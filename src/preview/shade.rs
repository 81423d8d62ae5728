//! The colour of a place around a sphere, scene by scene: the twin of shaders/preview.wgsl, whose
//! `shade` it is.

use super::curve::Curve;
use super::{Column, Scene};
use crate::brdf::Microfacet;
use crate::brdf::fresnel::schlick_weight;
use crate::integrate::ScaleBias;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// The albedo of a red base.
pub const BASE: DVec3 = DVec3::new(0.5, 0.08, 0.06);
const GOLD: DVec3 = DVec3::new(1.0, 0.78, 0.34);
const DIELECTRIC: f64 = 0.04;
const LIGHT: DVec3 = DVec3::new(0.48, 0.6, 0.64);
const LIGHT_COLOUR: f64 = 1.6;
/// The sky's coefficients.
pub const SKY0: DVec3 = DVec3::new(0.55, 0.6, 0.7);
/// Of P1.
pub const SKY1: DVec3 = DVec3::new(0.3, 0.42, 0.6);
/// Of P2.
pub const SKY2: DVec3 = DVec3::new(-0.22, -0.12, 0.0);

/// The means of P1 and P2 over Lambert's kernel.
pub const LAMBERT: (f64, f64) = (2.0 / 3.0, 0.25);

/// A sphere, ready for the CPU.
pub struct Sphere {
    /// Its lobe.
    pub lobe: Microfacet,
    /// Its roughness.
    pub column: Column,
    /// The split sum by the table.
    pub table: Curve<2>,
    /// The same by the integral; the table once more where the scene does not show the integral.
    pub integral: Curve<2>,
}

/// π D V: what a lobe contributes to L = (c_diff + π D V F) c_light n·l.
fn pi_d_v(lobe: Microfacet, x: f64, mu: f64, nh: f64, alpha: f64) -> f64 {
    let (c2, width) = (nh * nh, lobe.ndf.width(alpha));
    let y2 = (1.0 - nh) * (1.0 + nh) / (c2 * width * width);
    PI * lobe.ndf.slope_density(y2, alpha) / (width * width * c2 * c2)
        * lobe.cosine_visibility(x, mu, alpha)
        / x
}

/// The table as a renderer reads it.
fn lookup(sphere: &Sphere, mu: f64) -> ScaleBias {
    sphere.table.at(mu).into()
}

/// The sky in the direction of height y, its first and second coefficients scaled by a kernel's
/// means.
pub fn sky(y: f64, p1: f64, p2: f64) -> DVec3 {
    SKY0 + SKY1 * (p1 * y) + SKY2 * (p2 * (1.5 * y * y - 0.5))
}

fn punctual(sphere: &Sphere, n: DVec3) -> DVec3 {
    let x = n.dot(LIGHT);
    if x <= 0.0 {
        return DVec3::ZERO;
    }
    let h = (LIGHT + DVec3::Z).normalize();
    let f = DIELECTRIC + (1.0 - DIELECTRIC) * schlick_weight(h.z);
    let specular =
        f * pi_d_v(sphere.lobe, x, n.z.max(1e-4), n.dot(h).clamp(1e-4, 1.0), sphere.column.alpha);
    (BASE + specular) * (LIGHT_COLOUR * x)
}

/// The albedo of gold.
fn gold(value: ScaleBias) -> DVec3 {
    GOLD * value.a + value.b
}

fn furnace(scene: Scene, sphere: &Sphere, n: DVec3) -> DVec3 {
    let mu = n.z.max(0.0);
    match scene {
        Scene::FurnaceTable => gold(lookup(sphere, mu)),
        Scene::FurnaceIntegral => gold(sphere.integral.at(mu).into()),
        _ => 100.0 * (gold(lookup(sphere, mu)) - gold(sphere.integral.at(mu).into())).abs(),
    }
}

fn daylight(sphere: &Sphere, n: DVec3) -> DVec3 {
    let (mu, means) = (n.z.max(0.0), sphere.column.means);
    let e = lookup(sphere, mu).at_f0(DIELECTRIC);
    // The reflected direction of v = (0, 0, 1) has the height 2 n·v n.y.
    let specular = e * sky(2.0 * mu * n.y, means.0, means.1);
    specular + (1.0 - e) * BASE * sky(n.y, LAMBERT.0, LAMBERT.1)
}

/// The colour around a sphere of differences.
pub const AROUND_DIFFERENCE: DVec3 = DVec3::splat(0.02);

/// The normal at a place of the unit square around a sphere, y running down, and whether the place
/// lies beyond its edge, where x² + y² >= 1.
pub fn normal(p: DVec2) -> (DVec3, bool) {
    let (x, y) = ((2.0 * p.x - 1.0) * 1.06, (1.0 - 2.0 * p.y) * 1.06);
    let r2 = x * x + y * y;
    (DVec3::new(x, y, (1.0 - r2).max(0.0).sqrt()), r2 >= 1.0)
}

/// The colour at a place of the unit square around a sphere.
pub fn shade(scene: Scene, sphere: &Sphere, p: DVec2) -> DVec3 {
    let (n, beyond) = normal(p);
    match scene {
        Scene::Punctual | Scene::FurnaceDifference if beyond => AROUND_DIFFERENCE,
        Scene::Sky if beyond => sky(n.y.clamp(-1.0, 1.0), 1.0, 1.0),
        _ if beyond => DVec3::ONE,
        Scene::Punctual => punctual(sphere, n),
        Scene::Sky => daylight(sphere, n),
        _ => furnace(scene, sphere, n),
    }
}

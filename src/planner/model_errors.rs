//! What a scene's model leaves out: often more than any table errs by.

use super::domain::{Domain, Piece};
use super::truth::{Albedo, Truth};
use crate::approximation::Along;
use crate::backend::cpu::bake_points;
use crate::brdf::fresnel::{average_schlick, schlick_weight};
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::integrate::ScaleBias;
use crate::integrate::average::average_nodes;
use crate::integrate::rules::H288;
use crate::units::alpha_of;
use serde::Serialize;
use std::f64::consts::PI;

/// Something that a model leaves out, and what that costs in E(F0) at the most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelError {
    /// What it is.
    pub what: &'static str,
    /// The largest error of E(F0) without it: what has it less what has not.
    pub error: f64,
    /// n·v there.
    pub nov: f64,
    /// Perceptual roughness there.
    pub roughness: f64,
    /// F0 there.
    pub f0: f64,
}

/// Largest F0 of a surface that is taken for a dielectric: an index of refraction of 2.6.
const DIELECTRIC: f64 = 0.2;

/// Roughnesses of a piece and n·v at each that are looked at.
const PLACES: [usize; 2] = [9, 24];

/// Half vectors along either coordinate.
const HALF_VECTORS: usize = 40;

/// What is left out over a domain, the largest error of each.
pub fn model_errors(domain: &Domain, truth: &Truth) -> Vec<ModelError> {
    let mut errors: Vec<ModelError> = Vec::new();
    let found = domain.some_pieces().flat_map(|piece| of_piece(domain.least_nov, piece, truth));
    for error in found {
        match errors.iter_mut().find(|other| other.what == error.what) {
            Some(other) if error.error.abs() > other.error.abs() => *other = error,
            Some(_) => {}
            None => errors.push(error),
        }
    }
    errors
}

fn of_piece(least: f64, piece: &Piece, truth: &Truth) -> Vec<ModelError> {
    let [low, high] = piece.roughness;
    let roughnesses = if low == high { 1 } else { PLACES[0] };
    let mut errors = Vec::new();
    for step in 0..roughnesses {
        let roughness =
            low + (high - low) * step as f64 / PLACES[0].max(2).saturating_sub(1) as f64;
        let place = |i: usize| {
            Along::Layer(3.0).inverse(least, i as f64 / (PLACES[1] - 1) as f64, roughness)
        };
        let novs: Vec<f64> = (0..PLACES[1]).map(place).collect();
        errors.extend(lost_energy(roughness, &novs, piece, truth));
        if truth.lobe() == LOBE && roughness > 0.0 {
            // Of visible normals: at n·v = 0 they have no distribution.
            for &nov in novs.iter().filter(|nov| **nov > 0.0) {
                errors.extend(fresnel_error(nov, roughness, piece));
            }
            errors.extend(joint_error(roughness, &novs, piece, truth));
        }
    }
    errors
}

/// The name of what `joint_error` finds.
pub const JOINT_TERM: &str = "the correlated masking term, by Unreal's approximation of it";

/// The term of correlated heights less Unreal's approximation (Hammon 2017).
fn joint_error(roughness: f64, novs: &[f64], piece: &Piece, truth: &Truth) -> Vec<ModelError> {
    let joint = Microfacet { masking: Masking::HeightCorrelatedApprox, ..LOBE };
    let alpha = alpha_of(roughness);
    let points: Vec<(f64, f64)> = novs.iter().map(|&nov| (nov, alpha)).collect();
    let field = bake_points(joint, &points, &H288);
    let others = field.scale_bias();
    let of_place = |((&nov, own), other): ((&f64, Albedo), &ScaleBias)| {
        piece.f0.map(|f0| ModelError {
            what: JOINT_TERM,
            error: own.at(f0) - other.at_f0(f0),
            nov,
            roughness,
            f0,
        })
    };
    novs.iter().zip(truth.row(roughness, novs)).zip(&others).flat_map(of_place).collect()
}

/// The lobe whose visible normals are known here.
const LOBE: Microfacet = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };

/// What facets reflect more than once: F_ms (1 - E) with F_ms = F_avg² E_avg / (1 - F_avg (1 -
/// E_avg)) (Kulla and Conty 2017; Fdez-Agüera 2019).
fn lost_energy(roughness: f64, novs: &[f64], piece: &Piece, truth: &Truth) -> Vec<ModelError> {
    let nodes = average_nodes();
    let directions: Vec<f64> = nodes.iter().map(|node| node.0).collect();
    let albedos = truth.row(roughness, &directions);
    let average: f64 = nodes.iter().zip(&albedos).map(|(node, albedo)| node.1 * albedo.e).sum();
    let f0 = piece.f0[1];
    let fresnel = average_schlick(f0);
    let factor = fresnel * fresnel * average / (1.0 - fresnel * (1.0 - average));
    let of_direction = |(&nov, e): (&f64, f64)| ModelError {
        what: MULTIPLE_SCATTERING,
        error: factor * (1.0 - e).max(0.0),
        nov,
        roughness,
        f0,
    };
    let albedos = truth.row(roughness, novs);
    novs.iter().zip(albedos.iter().map(|albedo| albedo.e)).map(of_direction).collect()
}

/// The name of what `lost_energy` finds.
pub const MULTIPLE_SCATTERING: &str = "multiple scattering";

/// The name of what `fresnel_error` finds.
pub const EXACT_FRESNEL: &str = "exact Fresnel reflectance of dielectrics, instead of Schlick's";

/// Exact reflectance less Schlick's at the ends of the range of F0 that dielectrics have.
fn fresnel_error(nov: f64, roughness: f64, piece: &Piece) -> Vec<ModelError> {
    let [low, high] = piece.f0;
    if low > DIELECTRIC || low <= 0.0 {
        return Vec::new();
    }
    let of_f0 = |f0: f64| {
        let error = dielectric_less_schlick(f0, nov, alpha_of(roughness));
        ModelError { what: EXACT_FRESNEL, error, nov, roughness, f0 }
    };
    [low, high.min(DIELECTRIC)].map(of_f0).to_vec()
}

/// Fresnel's equations for unpolarised light (Walter et al. 2007, equation 22).
fn dielectric(ior: f64, cosine: f64) -> f64 {
    let g = (cosine * cosine + (ior * ior - 1.0)).sqrt();
    let ratio = (g - cosine) / (g + cosine);
    let second = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    0.5 * ratio * ratio * (1.0 + second * second)
}

/// E with exact reflectance less E with Schlick's, over the visible normals of GGX (Dupuy and
/// Benyoub 2023) with G2/G1 of correlated heights.
fn dielectric_less_schlick(f0: f64, nov: f64, alpha: f64) -> f64 {
    let root = f0.sqrt();
    let ior = (1.0 + root) / (1.0 - root);
    let view = [(1.0 - nov * nov).max(0.0).sqrt(), nov];
    let length = (alpha * view[0]).hypot(view[1]);
    let [x, z] = [alpha * view[0] / length, view[1] / length];
    let lambda = |cosine: f64| {
        let tangent2 = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        0.5 * ((1.0 + alpha * alpha * tangent2).sqrt() - 1.0)
    };
    let area = 1.0 + lambda(nov);
    let mut sum = 0.0;
    for i in 0..HALF_VECTORS {
        let height = (1.0 - (i as f64 + 0.5) / HALF_VECTORS as f64) * (1.0 + z) - z;
        let radius = (1.0 - height * height).max(0.0).sqrt();
        for j in 0..HALF_VECTORS {
            // The other half of the circle is its mirror image.
            let azimuth = PI * (j as f64 + 0.5) / HALF_VECTORS as f64;
            let (sine, cosine) = azimuth.sin_cos();
            let half = [alpha * (radius * cosine + x), alpha * radius * sine, height + z];
            let length = half.iter().map(|part| part * part).sum::<f64>().sqrt();
            let voh = (half[0] * view[0] + half[2] * view[1]) / length;
            let nol = 2.0 * voh * half[2] / length - view[1];
            if nol > 0.0 {
                let schlick = f0 + (1.0 - f0) * schlick_weight(voh);
                sum += (dielectric(ior, voh) - schlick) * area / (area + lambda(nol));
            }
        }
    }
    sum / (HALF_VECTORS * HALF_VECTORS) as f64
}

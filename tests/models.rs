//! Models: theorems about distributions and masking, and the textbook form in vectors as an independent oracle.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Random, ggx};
use glam::DVec3;
use splitsum::model::fresnel::schlick_weight;
use splitsum::model::ggx::{ggx_d, ggx_slope_density, ggx_smith};
use splitsum::model::{Masking, Ndf};
use splitsum::quadrature::double_exponential::tanh_sinh;
use splitsum::quadrature::gauss_legendre::gauss_legendre;
use splitsum::units::{Alpha, F0, Ior, PerceptualRoughness};
use std::f64::consts::{FRAC_PI_2, PI};

const ALPHAS: [f64; 5] = [1e-4, 0.01, 0.25, 0.7, 1.0];

#[test]
fn the_distribution_of_normals_is_normalised() {
    // ∫ D n·h dω_h = 1; in slopes 2π ∫ y P dy, the tail folded in by y = u/(1-u).
    let nodes = tanh_sinh(200);
    for ndf in Ndf::ALL {
        let sum: f64 = nodes
            .iter()
            .map(|n| {
                let y = n.from_start / n.to_end;
                n.weight * 2.0 * PI * y * ndf.slope_density(y * y) / (n.to_end * n.to_end)
            })
            .sum();
        assert!((sum - 1.0).abs() < 1e-13, "{ndf:?}: {sum}");
    }
}

#[test]
fn the_slope_density_is_the_distribution_of_normals() {
    // P22 = D cos⁴ θ_h (Heitz 2014, equation 10), and α² P22 is what the slope density is.
    for alpha in ALPHAS {
        for y in [0.0, 0.1, 1.0, 30.0] {
            let t = (alpha * y) * (alpha * y);
            let from_d = alpha * alpha * ggx_d(t, alpha) / ((1.0 + t) * (1.0 + t));
            assert!((from_d / ggx_slope_density(y * y) - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn the_distribution_is_walters() {
    // Walter 2007, equation 33, in cosines; at these α that form keeps 12 digits.
    for alpha in [0.25, 0.7, 1.0] {
        for c in [0.1, 0.5, 0.9, 1.0] {
            let (a2, c2): (f64, f64) = (alpha * alpha, c * c);
            let textbook = a2 / (PI * (c2 * (a2 - 1.0) + 1.0).powi(2));
            assert!((ggx_d(1.0 / c2 - 1.0, alpha) / textbook - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn visible_normals_project_to_the_view() {
    // The weak white furnace: ∫ G1(v) max(0, v·h) D dω_h = n·v (Heitz 2014, equation 12). In slopes (p, q), v in the p
    // plane: v·h/n·h = μ - sv p, and the q integral of P22 is done in closed form, P2(p) = 1/(2 α (1 + p²/α²)^1.5); then
    // p = α tan ψ, up to the slope μ/sv where normals turn away.
    let nodes = gauss_legendre(32);
    for alpha in ALPHAS {
        for mu in [1e-3, 0.1, 0.5, 0.9, 0.999_f64] {
            let sv = (1.0 - mu * mu).sqrt();
            let end = (mu / (sv * alpha)).atan();
            let visible = |psi: f64| 0.5 * (mu * psi.cos() - sv * alpha * psi.sin());
            let range = end + FRAC_PI_2;
            let sum: f64 = nodes.iter().map(|n| n.weight * range * visible(range * n.at - FRAC_PI_2)).sum();
            let g1 = 2.0 * mu / (mu + ggx_smith(mu, alpha));
            assert!((g1 * sum / mu - 1.0).abs() < 1e-12, "alpha {alpha}, n.v {mu}: {}", g1 * sum / mu);
        }
    }
}

/// A direction of the upper hemisphere.
fn direction(random: &mut Random) -> DVec3 {
    let (z, phi) = (random.next(), 2.0 * PI * random.next());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// f / F as papers write it, in vectors: D G / (4 n·l n·v), with Λ of GGX in its usual form.
fn textbook(l: DVec3, v: DVec3, alpha: f64, masking: Masking) -> f64 {
    let h = (l + v).normalize();
    let a2 = alpha * alpha;
    let d = a2 / (PI * (h.z * h.z * (a2 - 1.0) + 1.0).powi(2));
    let lambda = |c: f64| 0.5 * ((1.0 + a2 * (1.0 / (c * c) - 1.0)).sqrt() - 1.0);
    let k = 0.5 * alpha;
    let g = match masking {
        Masking::HeightCorrelated => 1.0 / (1.0 + lambda(l.z) + lambda(v.z)),
        Masking::Separable => 1.0 / ((1.0 + lambda(l.z)) * (1.0 + lambda(v.z))),
        Masking::SchlickSmith => l.z / (l.z * (1.0 - k) + k) * v.z / (v.z * (1.0 - k) + k),
    };
    d * g / (4.0 * l.z * v.z)
}

#[test]
fn lobes_are_the_textbooks_and_reciprocal() {
    let mut random = Random(7);
    for masking in Masking::ALL {
        let lobe = ggx(masking);
        for _ in 0..500 {
            let (l, v) = (direction(&mut random), direction(&mut random));
            let alpha = 0.1 + 0.9 * random.next();
            let h = (l + v).normalize();
            let ours = |x: f64, mu: f64| {
                let t = (1.0 - h.z) * (1.0 + h.z) / (h.z * h.z);
                ggx_d(t, alpha) * lobe.cosine_visibility(x, mu, alpha) / x
            };
            let truth = textbook(l, v, alpha, masking);
            // 1 - (n·h)² loses digits near the peak: up to 1/α² of them.
            assert!((ours(l.z, v.z) / truth - 1.0).abs() < 1e-10, "{masking:?} {l} {v} {alpha}");
            assert!((ours(l.z, v.z) / ours(v.z, l.z) - 1.0).abs() < 1e-13, "not reciprocal: {masking:?}");
        }
    }
}

#[test]
fn masking_is_finite_on_the_closed_domain() {
    for lobe in Masking::ALL.map(ggx) {
        for alpha in [5e-19, 1e-9, 1e-3, 1.0] {
            for (x, mu) in [(0.0, 0.5), (0.5, 0.0), (1e-300, 0.0), (0.0, 1.0), (1.0, 1.0), (1e-12, 1e-12)] {
                let value = lobe.cosine_visibility(x, mu, alpha);
                assert!(value.is_finite() && value >= 0.0, "{lobe:?} alpha {alpha} x {x} mu {mu}: {value}");
            }
        }
    }
}

#[test]
fn schlicks_weight_runs_from_grazing_to_normal() {
    assert_eq!((schlick_weight(0.0), schlick_weight(1.0)), (1.0, 0.0));
    assert_eq!(schlick_weight(0.5), 1.0 / 32.0);
}

#[test]
fn units_convert_once_and_check_their_range() {
    // Glass of n = 1.5 reflects 4 %.
    assert!((F0::from(Ior::new(1.5).unwrap()).get() - 0.04).abs() < 1e-16);
    assert_eq!(F0::from(Ior::new(1.0).unwrap()).get(), 0.0);
    assert_eq!(Alpha::from(PerceptualRoughness::new(0.5).unwrap()).get(), 0.25);
    assert!(Ior::new(0.9).is_err() && Ior::new(f64::INFINITY).is_err() && Ior::new(f64::NAN).is_err());
    assert!(PerceptualRoughness::new(1.1).is_err() && Alpha::new(1e-30).is_err() && F0::new(-0.0).is_ok());
}

//! Models: theorems about distributions and masking, and the textbook form in vectors as an
//! independent oracle.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::Random;
use glam::DVec3;
use splitsum::brdf::fresnel::schlick_weight;
use splitsum::brdf::ndf::ggx::{ggx_d, ggx_projected_area, ggx_slope_density};
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::numeric::quadrature::gauss_legendre::gauss_legendre;
use splitsum::numeric::quadrature::tanh_sinh::tanh_sinh;
use splitsum::numeric::special::{atanh_ratio, ierfc, log1p_ratio};
use splitsum::units::alpha_of_exponent;
use splitsum::units::{Alpha, F0, Ior, PerceptualRoughness};
use std::f64::consts::{FRAC_PI_2, PI};

const ALPHAS: [f64; 5] = [1e-4, 0.01, 0.25, 0.7, 1.0];

#[test]
fn the_distributions_of_normals_are_normalised() {
    // ∫ D n·h dω_h = 1; in slopes 2π ∫ y P dy, the tail folded in by y = u/(1-u).
    let nodes = tanh_sinh(300);
    for &ndf in Ndf::ALL {
        for alpha in ALPHAS {
            let sum: f64 = nodes
                .iter()
                .map(|n| {
                    let y = n.from_start / n.to_end;
                    n.weight * 2.0 * PI * y * ndf.slope_density(y * y, alpha)
                        / (n.to_end * n.to_end)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-12, "{ndf:?} at alpha {alpha}: {sum}");
        }
    }
}

#[test]
fn the_slope_density_is_the_distribution_of_normals() {
    // P22 = D cos⁴ θ_h (Heitz 2014), and α² P22 is what the slope density is.
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
    // The weak white furnace: ∫ G1(v) max(0, v·h) D dω_h = n·v (Heitz 2014). In slopes (p, q), v in
    // the p plane: v·h/n·h = μ - sv p, and the q integral of P22 is done in closed form, P2(p) =
    // 1/(2 α (1 + p²/α²)^1.5); then p = α tan ψ, up to the slope μ/sv where normals turn away.
    let nodes = gauss_legendre(32);
    for alpha in ALPHAS {
        for mu in [1e-3, 0.1, 0.5, 0.9, 0.999_f64] {
            let sv = (1.0 - mu * mu).sqrt();
            let end = (mu / (sv * alpha)).atan();
            let visible = |psi: f64| 0.5 * (mu * psi.cos() - sv * alpha * psi.sin());
            let range = end + FRAC_PI_2;
            let sum: f64 =
                nodes.iter().map(|n| n.weight * range * visible(range * n.at - FRAC_PI_2)).sum();
            let g1 = 2.0 * mu / (mu + ggx_projected_area(mu, alpha));
            assert!(
                (g1 * sum / mu - 1.0).abs() < 1e-12,
                "alpha {alpha}, n.v {mu}: {}",
                g1 * sum / mu
            );
        }
    }
}

#[test]
fn visible_normals_of_beckmann_project_to_the_view() {
    // The same with P2(p) = exp(-p²/α²)/(α√π), to 8 of its widths.
    let nodes = gauss_legendre(64);
    for alpha in ALPHAS {
        for mu in [1e-3, 0.1, 0.5, 0.9, 0.999_f64] {
            let sv = (1.0 - mu * mu).sqrt();
            let end = (mu / (sv * alpha)).min(8.0);
            let visible = |p: f64| (mu - sv * alpha * p) * (-p * p).exp() / PI.sqrt();
            let range = end + 8.0;
            let sum: f64 =
                nodes.iter().map(|n| n.weight * range * visible(range * n.at - 8.0)).sum();
            let g1 = 2.0 * mu / (mu + Ndf::Beckmann.projected_area(mu, alpha));
            assert!(
                (g1 * sum / mu - 1.0).abs() < 1e-12,
                "alpha {alpha}, n.v {mu}: {}",
                g1 * sum / mu
            );
        }
    }
}

/// A direction of the upper hemisphere.
fn direction(random: &mut Random) -> DVec3 {
    let (z, phi) = (random.next(), 2.0 * PI * random.next());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// D as papers write it, in cosines.
fn textbook_d(ndf: Ndf, h: DVec3, alpha: f64) -> f64 {
    let (a2, c2) = (alpha * alpha, h.z * h.z);
    match ndf {
        Ndf::Ggx => a2 / (PI * (c2 * (a2 - 1.0) + 1.0).powi(2)),
        Ndf::Beckmann | Ndf::BeckmannWalter => ((c2 - 1.0) / (a2 * c2)).exp() / (PI * a2 * c2 * c2),
        Ndf::BlinnPhong => {
            let n = 2.0 / a2 - 2.0;
            (n + 2.0) / (2.0 * PI) * h.z.powf(n)
        }
        Ndf::Charlie => (2.0 + 1.0 / alpha) / (2.0 * PI) * (1.0 - c2).sqrt().powf(1.0 / alpha),
    }
}

/// Smith's Λ as papers write it.
fn textbook_lambda(ndf: Ndf, c: f64, alpha: f64) -> f64 {
    let a = c / (alpha * (1.0 - c * c).sqrt());
    match ndf {
        Ndf::Ggx => 0.5 * ((1.0 + 1.0 / (a * a)).sqrt() - 1.0),
        Ndf::Beckmann | Ndf::BlinnPhong => {
            0.5 * (libm::erf(a) - 1.0) + (-a * a).exp() / (2.0 * a * PI.sqrt())
        }
        Ndf::BeckmannWalter if a >= 1.6 => 0.0,
        Ndf::BeckmannWalter => (1.0 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a),
        Ndf::Charlie => {
            let p = |smooth: f64, rough: f64| {
                (1.0 - alpha).powi(2) * smooth + (1.0 - (1.0 - alpha).powi(2)) * rough
            };
            let l = |x: f64| {
                p(25.3245, 21.5473) / (1.0 + p(3.32435, 3.82987) * x.powf(p(0.16801, 0.19823)))
                    + p(-1.27393, -1.97760) * x
                    + p(-4.85967, -4.32054)
            };
            if c < 0.5 { l(c).exp() } else { (2.0 * l(0.5) - l(1.0 - c)).exp() }
        }
    }
}

/// f / F as papers write it, in vectors: D G / (4 n·l n·v).
fn textbook(lobe: Microfacet, l: DVec3, v: DVec3, alpha: f64) -> f64 {
    let lambda = |c: f64| textbook_lambda(lobe.ndf, c, alpha);
    let k = 0.5 * alpha;
    let over_cosines = 1.0 / (4.0 * l.z * v.z);
    let visibility = match lobe.masking {
        Masking::HeightCorrelated => over_cosines / (1.0 + lambda(l.z) + lambda(v.z)),
        Masking::Separable => over_cosines / ((1.0 + lambda(l.z)) * (1.0 + lambda(v.z))),
        Masking::SchlickSmith => {
            over_cosines * l.z / (l.z * (1.0 - k) + k) * v.z / (v.z * (1.0 - k) + k)
        }
        Masking::HeightCorrelatedApprox => {
            0.5 / (l.z * (v.z * (1.0 - alpha) + alpha) + v.z * (l.z * (1.0 - alpha) + alpha))
        }
        Masking::Implicit => 0.25,
        Masking::Neubelt => 1.0 / (4.0 * (l.z + v.z - l.z * v.z)),
    };
    textbook_d(lobe.ndf, (l + v).normalize(), alpha) * visibility
}

#[test]
fn lobes_are_the_textbooks_and_reciprocal() {
    let mut random = Random(7);
    for lobe in Microfacet::all() {
        for _ in 0..300 {
            let (l, v) = (direction(&mut random), direction(&mut random));
            let alpha = 0.1 + 0.9 * random.next();
            let h = (l + v).normalize();
            let ours = |x: f64, mu: f64| {
                let (t, width) = ((h.x * h.x + h.y * h.y) / (h.z * h.z), lobe.ndf.width(alpha));
                let density = lobe.ndf.slope_density(t / (width * width), alpha) / (width * width);
                density / h.z.powi(4) * lobe.cosine_visibility(x, mu, alpha) / x
            };
            let truth = textbook(lobe, l, v, alpha);
            // 1 - (n·h)² loses digits near the peak: up to 1/α² of them; an exponent of up to
            // 100/α² as many again.
            assert!(
                (ours(l.z, v.z) - truth).abs() < 1e-10 * truth + 1e-30,
                "{lobe:?} {l} {v} {alpha}"
            );
            assert!(
                (ours(l.z, v.z) / ours(v.z, l.z) - 1.0).abs() < 1e-12 || truth < 1e-290,
                "not reciprocal: {lobe:?}"
            );
        }
    }
}

#[test]
fn special_functions_have_their_published_values() {
    // Abramowitz and Stegun, tables 7.1 and 7.3: erfc(1) = 0.1572992071, i1erfc(0) = 1/√π,
    // i1erfc(1) = 0.0502545.
    assert!((ierfc(0.0) - 0.564_189_583_547_756_3).abs() < 1e-16);
    assert!((ierfc(1.0) - ((-1f64).exp() / PI.sqrt() - 0.157_299_207_050_285_1)).abs() < 1e-16);
    assert!((log1p_ratio(1.0) - std::f64::consts::LN_2).abs() < 1e-16 && log1p_ratio(0.0) == 1.0);
    assert!(
        (atanh_ratio(1.0 / 9.0) - 1.5 * std::f64::consts::LN_2).abs() < 1e-15
            && atanh_ratio(0.0) == 1.0
    );
}

#[test]
fn blinn_phong_tends_to_beckmann() {
    for y2 in [0.1, 1.0, 4.0] {
        let difference =
            Ndf::BlinnPhong.slope_density(y2, 1e-4) / Ndf::Beckmann.slope_density(y2, 1e-4) - 1.0;
        // The next order is α² times a polynomial in y².
        assert!(difference.abs() < 1e-7, "{difference}");
    }
    assert!(
        (alpha_of_exponent(0.0) - 1.0).abs() < 1e-16
            && (alpha_of_exponent(1e7) - 4.472e-4).abs() < 1e-7
    );
}

#[test]
fn masking_is_finite_on_the_closed_domain() {
    for lobe in Microfacet::all() {
        for alpha in [5e-19, 1e-9, 1e-3, 1.0] {
            for (x, mu) in
                [(0.0, 0.5), (0.5, 0.0), (1e-300, 0.0), (0.0, 1.0), (1.0, 1.0), (1e-12, 1e-12)]
            {
                let value = lobe.cosine_visibility(x, mu, alpha);
                let sound =
                    value.is_finite() && value >= 0.0 || lobe.diverges_at_grazing() && mu == 0.0;
                assert!(sound, "{lobe:?} alpha {alpha} x {x} mu {mu}: {value}");
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
    assert!(
        Ior::new(0.9).is_err() && Ior::new(f64::INFINITY).is_err() && Ior::new(f64::NAN).is_err()
    );
    assert!(
        PerceptualRoughness::new(1.1).is_err()
            && Alpha::new(1e-30).is_err()
            && F0::new(-0.0).is_ok()
    );
}

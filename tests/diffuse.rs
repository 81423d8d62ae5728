//! Diffuse lobes: reference figures, and the closed forms against the integral of each lobe as its
//! paper writes it.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{figures, number};
use splitsum::brdf::Diffuse;
use splitsum::choice::Choice;
use splitsum::numeric::quadrature::gauss_legendre::gauss_legendre;
use std::f64::consts::PI;

#[test]
fn albedos_are_those_of_the_figures() {
    let rows = figures(include_str!("figures/diffuse_albedo.csv"));
    assert_eq!(rows.len(), 76);
    for row in rows {
        let model = Diffuse::named(row[0]).unwrap();
        let e = model.albedo(number(row[1]), number(row[2]));
        assert!((e - number(row[3])).abs() < 1e-14, "{row:?}: {e}");
    }
}

/// π f(l, v) for n·l = x, n·v = μ and the azimuth φ between them.
fn lobe(model: Diffuse, x: f64, mu: f64, phi: f64, r: f64) -> f64 {
    let sines = ((1.0 - x * x) * (1.0 - mu * mu)).sqrt();
    let lv = x * mu + sines * phi.cos();
    // s = l·v - n·l n·v, over max(n·l, n·v) where it is positive: the backward term of Oren and
    // Nayar.
    let s = lv - x * mu;
    match model {
        Diffuse::Lambert => 1.0,
        Diffuse::Burley => {
            let f90 = 0.5 + 2.0 * r * 0.5 * (1.0 + lv);
            (1.0 + (f90 - 1.0) * (1.0 - x).powi(5)) * (1.0 + (f90 - 1.0) * (1.0 - mu).powi(5))
        }
        Diffuse::OrenNayar => {
            let s2 = r * r;
            let (a, b) = (1.0 - 0.5 * s2 / (s2 + 0.33), 0.45 * s2 / (s2 + 0.09));
            a + b * s.max(0.0) / x.max(mu)
        }
        // lerp(1, 0.5, alpha) of HDRP's BSDF.hlsl.
        Diffuse::FabricLambert => (1.0 - r * r) + 0.5 * r * r,
        Diffuse::Eon => {
            let t = if s > 0.0 { x.max(mu) } else { 1.0 };
            (1.0 + r * s / t) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r)
        }
    }
}

#[test]
fn closed_forms_are_the_integrals_of_their_lobes() {
    // Each lobe is smooth where cos φ keeps its sign and n·l stays on one side of n·v: Gauss rules
    // on those pieces. At the ends √(1-x²) is not, which n·l = 1 - u² takes care of.
    let nodes = gauss_legendre(40);
    for &model in Diffuse::ALL {
        for (mu, r) in [(0.02_f64, 1.0), (0.3, 0.6), (0.7, 0.2), (0.99, 0.9)] {
            let split = (1.0 - mu).sqrt();
            let mut sum = 0.0;
            for (u0, u1) in [(0.0, split), (split, 1.0)] {
                for node in &nodes {
                    let u = u0 + (u1 - u0) * node.at;
                    let x = 1.0 - u * u;
                    for half in [0.0, 0.5] {
                        for angle in &nodes {
                            let phi = PI * (half + 0.5 * angle.at);
                            let weight = node.weight * (u1 - u0) * 2.0 * u * angle.weight;
                            sum += weight * x * lobe(model, x, mu, phi, r);
                        }
                    }
                }
            }
            // 2 ∫∫ f x dφ dx over half the azimuths is ∫∫ π f x dx, averaged over them; each half
            // has weight 1/2.
            assert!(
                (sum - model.albedo(mu, r)).abs() < 1e-9,
                "{model:?} {mu} {r}: {sum} for {}",
                model.albedo(mu, r)
            );
        }
    }
}

#[test]
fn the_energy_that_they_lose_or_make_is_what_the_docs_say() {
    assert!((Diffuse::Burley.albedo(0.0, 1.0) - 1.5575396825396825).abs() < 1e-15);
    assert!((Diffuse::Burley.albedo(1.0, 0.0) - 41.0 / 42.0).abs() < 1e-15);
    let at = |model: Diffuse, mu, r, e: f64| {
        assert!((model.albedo(mu, r) - e).abs() < 1e-14, "{model:?}")
    };
    at(Diffuse::Burley, 0.3, 0.6, 1.045_255_534_738_095_2);
    at(Diffuse::Eon, 0.3, 0.6, 0.946_961_839_761_036_9);
    at(Diffuse::OrenNayar, 0.3, 0.5, 0.912_390_172_389_349_7);
    let average = |model: Diffuse, r: f64| -> f64 {
        gauss_legendre(48)
            .iter()
            .map(|node| 2.0 * node.weight * node.at * model.albedo(node.at, r))
            .sum()
    };
    for (r, e) in
        [(0.0, 0.952_947_845_804_988_7), (0.5, 1.0081786186696901), (1.0, 1.0651691232048375)]
    {
        assert!((average(Diffuse::Burley, r) - e).abs() < 1e-14);
    }
    for r in [0.0, 0.3, 1.0] {
        assert_eq!(Diffuse::Lambert.albedo(0.3, r), 1.0);
        let exact =
            (1.0 + r * (2.0 / 3.0 - 28.0 / (15.0 * PI))) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
        // The square root at grazing angles leaves 1e-6 to a Gauss rule in n·v.
        assert!((average(Diffuse::Eon, r) - exact).abs() < 1e-6);
        assert!((0..=100).all(|i| Diffuse::Eon.albedo(f64::from(i) / 100.0, r) <= 1.0 + 1e-15));
    }
    assert!(Diffuse::OrenNayar.albedo(0.0, 0.25) > 1.01);
}

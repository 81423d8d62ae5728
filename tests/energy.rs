//! Albedos: reference figures, closed forms, limits and bounds of E(F0) = F0 A + B.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{domain, figures, ggx, masking_named, number};
use rayon::prelude::*;
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::{REFERENCE, RULES, Rule};
use splitsum::model::Masking;
use splitsum::quadrature::gauss_legendre::gauss_legendre;
use std::f64::consts::LN_2;

const ALBEDO: &str = include_str!("figures/ggx_albedo.csv");
const AVERAGE: &str = include_str!("figures/ggx_average_albedo.csv");

fn reference(masking: Masking, mu: f64, r: f64) -> ScaleBias {
    REFERENCE.integrator().integrate(ggx(masking), mu, r * r)
}

#[test]
fn every_rule_meets_the_reference_figures_within_its_bound() {
    let rows = figures(ALBEDO);
    assert_eq!(rows.len(), 62);
    for rule in RULES {
        let integrator = rule.integrator();
        for row in &rows {
            let (mu, r, a, b) = (number(row[1]), number(row[2]), number(row[3]), number(row[4]));
            let value = integrator.integrate(ggx(masking_named(row[0])), mu, r * r);
            let error = (value.a - a).abs().max((value.b - b).abs());
            // All the figures are below 1, so that absolute and relative to max(1, value) are the same.
            assert!(error <= rule.bound, "{} at {row:?}: {error:e}, {:e} promised", rule.name, rule.bound);
        }
    }
}

#[test]
fn closed_forms_hold() {
    let close = |got: f64, exact: f64| assert!((got - exact).abs() < 1e-13, "{got} for {exact}");
    let correlated = Masking::HeightCorrelated;
    // α = 1, height-correlated: E = 1 - μ ln(1 + 1/μ).
    for mu in [1e-3, 0.1, 0.5, 0.9, 1.0] {
        close(reference(correlated, mu, 1.0).e(), 1.0 - mu * libm::log(1.0 + 1.0 / mu));
    }
    close(reference(correlated, 1.0, 1.0).e(), 1.0 - LN_2);
    // Grazing, height-correlated: E = 1 for every α > 0.
    for r in [1e-3, 0.1, 0.5, 1.0] {
        close(reference(correlated, 0.0, r).e(), 1.0);
    }
    close(reference(correlated, 0.0, 1.0).b, 1.0 / 21.0);
    close(reference(correlated, 0.0, 0.5).b, 0.192_936_446_756_802_76);
    close(reference(correlated, 1.0, 0.5).e(), 0.915_812_430_249_750_4);
    close(reference(correlated, 1.0, 0.75).e(), 0.626_885_656_723_411);
    // Grazing, then α → 0: the limits do not commute, and separable masking loses energy there.
    close(reference(Masking::Separable, 0.0, 1e-4).e(), 0.936_134_853_903_934_1);
}

#[test]
fn average_albedos_are_the_published_ones() {
    // E_avg = 2 ∫ E μ dμ, Gauss-Legendre in q = √μ: 4 ∫ E q³ dq. 24 nodes leave less than 1e-10 (α = 0.01 is the worst).
    let integrator = REFERENCE.integrator();
    for row in figures(AVERAGE) {
        let (lobe, r) = (ggx(masking_named(row[0])), number(row[1]));
        let (mut e, mut b) = (0.0, 0.0);
        for node in gauss_legendre(24) {
            let value = integrator.integrate(lobe, node.at * node.at, r * r);
            let weight = 4.0 * node.weight * node.at * node.at * node.at;
            (e, b) = (e + weight * value.e(), b + weight * value.b);
        }
        assert!((b - number(row[2])).abs() < 1e-9 && (e - number(row[3])).abs() < 1e-9, "{row:?}: {b} {e}");
    }
    // And the closed form at α = 1: (4/3)(1 - ln 2).
    let published = figures(AVERAGE).into_iter().find(|row| row[0] == "height-correlated" && row[1] == "1").unwrap();
    assert!((number(published[3]) - 4.0 / 3.0 * (1.0 - LN_2)).abs() < 1e-15);
}

#[test]
fn smooth_is_a_mirror() {
    for rule in RULES {
        let integrator = rule.integrator();
        for mu in [0.0, 1e-6, 0.3, 1.0_f64] {
            let value = integrator.integrate(ggx(Masking::HeightCorrelated), mu, 0.0);
            let b = (1.0 - mu).powi(5);
            assert!((value.b - b).abs() < 1e-15 && (value.a - (1.0 - b)).abs() < 1e-15);
        }
        // And the lobe tends to it: away from grazing the difference is of the order of α².
        for mu in [0.3, 1.0] {
            let value = integrator.integrate(ggx(Masking::HeightCorrelated), mu, 1e-8);
            assert!((value.e() - 1.0).abs() <= 2.0 * rule.bound, "{} at {mu}: {}", rule.name, value.e());
        }
    }
}

#[test]
fn a_passive_lobe_gives_back_no_more_than_it_gets() {
    // Smith masking: 0 ≤ B ≤ E ≤ 1. The reference may err by its bound.
    let slack = REFERENCE.bound;
    let integrator = REFERENCE.integrator();
    for lobe in Masking::ALL.map(ggx) {
        domain(600).par_iter().for_each(|&(mu, alpha)| {
            let value = integrator.integrate(lobe, mu, alpha);
            let passive = value.b >= 0.0 && value.a >= -slack && value.e() <= 1.0 + slack;
            assert!(passive, "{lobe:?} at n.v {mu}, alpha {alpha}: {value:?}");
        });
    }
}

#[test]
fn edges_are_the_limits_of_the_inside() {
    // n·v → 0, n·v → 1 and α → 1 are approached without a jump, at the rate of the distance (times its logarithm).
    let finest = Rule::named("h6144").unwrap().integrator();
    for lobe in Masking::ALL.map(ggx) {
        for alpha in [0.01, 0.25, 1.0] {
            for (edge, near) in [(0.0, 1e-9), (1.0, 1.0 - 1e-9)] {
                let (at, beside) = (finest.integrate(lobe, edge, alpha), finest.integrate(lobe, near, alpha));
                // |dE/dμ| is of the order of ln(1/μ)/α at grazing.
                let slack = 1e-9 * 50.0 / alpha + 1e-8;
                assert!((at.a - beside.a).abs() < slack && (at.b - beside.b).abs() < slack, "{lobe:?} {alpha} {edge}");
            }
        }
        for mu in [0.0, 0.3, 1.0] {
            let (at, beside) = (finest.integrate(lobe, mu, 1.0), finest.integrate(lobe, mu, 1.0 - 1e-9));
            assert!((at.a - beside.a).abs() < 2e-8 && (at.b - beside.b).abs() < 2e-8);
        }
    }
}

//! The bounds by which values are certified, for A and for every decade of B, over many random
//! points against the reference: none is violated, and one that is too small is noticed.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Random, errors_at};
use rayon::prelude::*;
use splitsum::backend::cpu;
use splitsum::brdf::{Microfacet, Ndf};
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::{CHARLIE_UNKNOWN, Rule};
use splitsum::integrate::rules::REFERENCE;
use splitsum::integrate::rules::{
    B2544, B5920, D10240, H1152, L2048, L4608, P480, P1024, R456, R976, R1776, R6080, S896, S960,
    S1008, S1120, S1248, S1344, S1360, S1440, S1616, S1792, S2080, S2304, S2560,
};

/// The rules that decide how values round.
const STAGES: [Rule; 25] = [
    S960, S1344, S1440, S2304, S2080, S2560, S1792, S1616, S896, S1120, S1008, S1248, S1360, L2048,
    L4608, P480, P1024, R456, R976, R1776, R6080, B2544, B5920, D10240, H1152,
];

/// Points in all: 100,000, or what SPLITSUM_COVERAGE says (.ci/run: a million).
fn points_in_all() -> usize {
    std::env::var("SPLITSUM_COVERAGE").map_or(100_000, |count| count.parse().unwrap())
}

/// The share of a lobe in the points: each gets about as much time, but for the lobe that everyone
/// bakes.
fn share(lobe: Microfacet) -> f64 {
    match lobe.ndf {
        Ndf::Ggx if lobe.masking == lobe.ndf.default_masking() => 0.3,
        Ndf::Ggx => 0.1,
        Ndf::Charlie => 0.01,
        _ => 0.033,
    }
}

/// Points (n·v, α) of which three eighths are spread evenly over n·v and perceptual roughness, as a
/// table's are, up to the largest of an unclamped axis, and the others crowd at the edges: n·v down
/// to 1e-12 from 0 and 1, roughness down to 1e-9 and up to 1.
fn points(lobe: Microfacet, count: usize) -> Vec<(f64, f64)> {
    let mut random = Random(20261123);
    let edge = |u: f64, decades: f64| 10f64.powf(-decades * u);
    (0..count)
        .map(|i| {
            let (u, v) = (random.next(), random.next());
            let (mu, r) = match i % 8 {
                0..3 => (u, v * lobe.ndf.most_alpha().sqrt()),
                3 => (edge(u, 12.0), v),
                4 => (u, edge(v, 9.0)),
                5 => (1.0 - edge(u, 12.0), v),
                6 => (u, 1.0 - edge(v, 6.0)),
                // Also where both are small, down to the smoothest row of an interpolant.
                _ => (edge(u, 8.0), edge(v, 3.01)),
            };
            let least = match lobe.ndf {
                Ndf::Charlie => CHARLIE_UNKNOWN,
                _ => 0.0,
            };
            let alpha = least + (1.0 - least) * r * r;
            (if lobe.diverges_at_grazing() { mu.max(1e-30) } else { mu }, alpha)
        })
        .collect()
}

/// Values of A and of B that lie beyond `scale` times the bounds of a rule.
fn violations(
    lobe: Microfacet,
    rule: &Rule,
    points: &[(f64, f64)],
    truth: &[ScaleBias],
    scale: f64,
) -> usize {
    let values = cpu::bake_points(lobe, points, rule).scale_bias();
    let beyond = |((&point, truth), value): ((&(f64, f64), &ScaleBias), &ScaleBias)| {
        let (errors, reference) =
            (errors_at(rule, lobe, point, *value), errors_at(&REFERENCE, lobe, point, *truth));
        // Written so that NaN is a violation.
        let within =
            |x: f64, y: f64, error: f64, reference: f64| (x - y).abs() <= scale * error + reference;
        usize::from(!within(value.a, truth.a, errors.a, reference.a))
            + usize::from(!within(value.b, truth.b, errors.b, reference.b))
    };
    points.par_iter().zip(truth).zip(&values).map(beyond).sum()
}

#[test]
fn no_bound_is_violated_and_one_too_small_is_noticed() {
    let mut tested = 0;
    for lobe in Microfacet::all() {
        let points = points(lobe, (share(lobe) * points_in_all() as f64) as usize);
        let truth = cpu::bake_points(lobe, &points, &REFERENCE).scale_bias();
        tested += points.len();
        for rule in STAGES.iter().filter(|rule| rule.applies_to(lobe)) {
            let found = violations(lobe, rule, &points, &truth, 1.0);
            assert_eq!(
                found, 0,
                "{} of {lobe:?} errs by more than its bound at so many values",
                rule.name
            );
        }
    }
    assert!(tested as f64 > 0.95 * points_in_all() as f64, "{tested} points");
    // The same test with bounds that are planted too small; h1152 errs by less than the reference
    // may.
    for rule in STAGES.into_iter().filter(|rule| *rule != H1152) {
        let lobe = Microfacet::all().find(|lobe| rule.applies_to(*lobe)).unwrap();
        let points = points(lobe, 4000);
        let truth = cpu::bake_points(lobe, &points, &REFERENCE).scale_bias();
        assert!(
            violations(lobe, &rule, &points, &truth, 0.05) > 0,
            "{} with a twentieth of its bound",
            rule.name
        );
    }
}

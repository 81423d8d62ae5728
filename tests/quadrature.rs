//! Quadrature: theorems about the rules, and the bounds that the rules claim.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::domain_of;
use splitsum::backend::cpu;
use splitsum::brdf::fresnel::Schlick;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::integrate::rule::{Method, Rule};
use splitsum::integrate::rules::{REFERENCE, RULES};
use splitsum::integrate::{Kernel, ScaleBias};
use splitsum::numeric::quadrature::gauss_legendre::{gauss_legendre, half_gauss};
use splitsum::numeric::quadrature::slope_map::{Power, slope_at, slope_interval};
use splitsum::numeric::quadrature::tanh_sinh::{half_line, tanh_sinh};
use std::f64::consts::{FRAC_PI_2, PI};

#[test]
fn gauss_legendre_is_exact_to_degree_2n_minus_1() {
    for n in [1, 2, 3, 8, 16, 48, 160] {
        let nodes = gauss_legendre(n);
        assert_eq!(nodes.len(), n);
        for degree in [0, 1, n, 2 * n - 1] {
            let sum: f64 = nodes.iter().map(|node| node.weight * node.at.powi(degree as i32)).sum();
            let exact = 1.0 / (degree as f64 + 1.0);
            // n terms of at most 1, each rounded.
            assert!(
                (sum - exact).abs() < 1e-15 * n.max(4) as f64,
                "n = {n}, degree {degree}: {sum} for {exact}"
            );
        }
    }
}

#[test]
fn gauss_legendre_has_the_published_nodes() {
    // Abramowitz and Stegun, table 25.4, n = 5, on [-1, 1].
    let published = [
        (0.0, 0.568888888888889),
        (0.538469310105683, 0.478628670499366),
        (0.906179845938664, 0.236926885056189),
    ];
    for (node, (x, weight)) in gauss_legendre(5)[2..].iter().zip(published) {
        assert!(
            (2.0 * node.at - 1.0 - x).abs() < 1e-15 && (2.0 * node.weight - weight).abs() < 1e-15
        );
    }
}

#[test]
fn half_gauss_is_worth_twice_its_nodes_on_even_functions() {
    for degree in [0, 2, 8, 14] {
        let sum: f64 = half_gauss(4).iter().map(|node| node.weight * node.at.powi(degree)).sum();
        assert!((sum - 1.0 / (f64::from(degree) + 1.0)).abs() < 1e-15);
    }
}

#[test]
fn the_slope_map_is_the_hyperbolic_sine_it_says() {
    for (power, p) in [(Power::Two, 2.0), (Power::Four, 4.0)] {
        for (y0, y1) in [(0.0, 1.0), (0.3, 1e6), (1e9, 1e12), (-40.0, 7.0)] {
            let interval = slope_interval(y0, y1, power);
            let at = |u| slope_at(u, interval, power);
            let scale = 1.0 + f64::abs(y1);
            assert!(
                (at(0.0).y - y0).abs() < 1e-12 * (1.0 + f64::abs(y0))
                    && (at(1.0).y - y1).abs() < 1e-12 * scale
            );
            for u in [0.1, 0.5, 0.9] {
                let angle = 2.0 * p * libm::atanh(interval.w0 + interval.width * u);
                // atanh near 1 turns a rounding of w into a large one; the map itself has 1 - w
                // exactly.
                let slack = 1e-14 / (1.0 - interval.w0 - interval.width * u);
                assert!(
                    (at(u).y - libm::sinh(angle)).abs() <= slack * (1.0 + at(u).y.abs()),
                    "{power:?} {y0} {y1} {u}"
                );
            }
            // dy is the derivative: central differences over 2e-6, whose error is below 1e-6 of it
            // at these u.
            for u in [0.1, 0.5, 0.9] {
                let difference = (at(u + 1e-6).y - at(u - 1e-6).y) / 2e-6;
                assert!((at(u).dy / difference - 1.0).abs() < 1e-6, "{power:?} {y0} {y1} {u}");
            }
        }
    }
}

#[test]
fn double_exponential_integrates_singular_endpoints() {
    let nodes = tanh_sinh(160);
    let integral = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
        nodes.iter().map(|node| node.weight * f(node.from_start, node.to_end)).sum()
    };
    assert!((integral(&|_, _| 1.0) - 1.0).abs() < 1e-14);
    assert!((integral(&|x, _| x.ln()) + 1.0).abs() < 1e-14);
    // The cut at a distance of 1e-21 leaves out its square root.
    assert!((integral(&|x, y| 1.0 / (x * y).sqrt()) - PI).abs() < 3e-10);
    let line: f64 = half_line(150, 4.085).iter().map(|&(z, weight)| weight / (1.0 + z * z)).sum();
    assert!((line - FRAC_PI_2).abs() < 1e-14);
}

/// The largest error of A and of B by `rule` over `points`, relative to albedos above 1; NaN counts
/// as infinite.
fn worst(
    lobe: Microfacet,
    rule: &Rule,
    points: &[(f64, f64)],
    truth: &[ScaleBias],
) -> (f64, (f64, f64)) {
    let values = cpu::bake_points(lobe, points, rule).scale_bias();
    let error = |((&(mu, alpha), truth), value): ((&(f64, f64), &ScaleBias), ScaleBias)| {
        let error = (value.a - truth.a).abs().max((value.b - truth.b).abs()) / truth.e().max(1.0);
        let sound = value.a.is_finite() && value.b.is_finite();
        (if sound { error } else { f64::INFINITY }, (mu, alpha))
    };
    let errors = points.iter().zip(truth).zip(values).map(error);
    errors.fold((0.0, (0.0, 0.0)), |a, b| if a.0 >= b.0 { a } else { b })
}

#[test]
fn every_rule_keeps_its_bound_over_the_whole_domain_and_no_bound_is_idle() {
    // A bound a hundred times too large would hide a broken rule: with some masking each rule errs
    // by a twentieth of its own. Charlie's are left out of that: its reference is no sharper than
    // its finer rules.
    let mut largest = std::collections::HashMap::new();
    for lobe in Microfacet::all() {
        let points = domain_of(lobe, if lobe.ndf == Ndf::Ggx { 900 } else { 300 });
        let truth = cpu::bake_points(lobe, &points, &REFERENCE).scale_bias();
        for rule in
            RULES.iter().filter(|rule| rule.applies_to(lobe) && rule.bound(lobe).is_finite())
        {
            let ((error, at), bound) = (worst(lobe, rule, &points, &truth), rule.bound(lobe));
            assert!(
                error <= bound,
                "{} of {lobe:?}: {error:e} at {at:?}, {bound:e} promised",
                rule.name
            );
            let known: &mut f64 = largest.entry((lobe.ndf.word(), rule.name)).or_insert(0.0);
            *known = known.max(error / bound);
        }
        let (error, at) = worst(lobe, &REFERENCE.yardstick(), &points[..100], &truth);
        assert!(
            error <= REFERENCE.bound(lobe),
            "the reference of {lobe:?} moves by {error:e} at {at:?} when refined"
        );
    }
    for ((ndf, rule), share) in largest {
        // Double exponential rules have one bound for all lobes, the largest.
        let exempt = rule.starts_with('d') || rule == REFERENCE.name || ndf == Ndf::Charlie.word();
        assert!(exempt || share >= 0.05, "{rule} of {ndf} errs by {share} of its bound only");
    }
}

#[test]
fn two_formulas_agree_over_a_dense_grid() {
    // Half vectors and light directions share no mechanism; each may err by its bound.
    let (h, l) = (Rule::named("h6144").unwrap(), Rule::named("l4608").unwrap());
    let grid: Vec<(f64, f64)> = (0..64 * 64)
        .map(|i| (f64::from(i % 64) / 63.0, (f64::from(i / 64) + 1.0) / 64.0))
        .map(|(mu, r)| (mu, r * r))
        .collect();
    for lobe in Microfacet::all().filter(|lobe| l.applies_to(*lobe)) {
        let truth = cpu::bake_points(lobe, &grid, &h).scale_bias();
        let (error, at) = worst(lobe, &l, &grid, &truth);
        assert!(error <= h.bound(lobe) + l.bound(lobe), "{lobe:?}: {error:e} at {at:?}");
    }
}

#[test]
fn few_evaluations_reach_each_error_on_a_table_of_64_by_64() {
    let lobe = Microfacet { ndf: Ndf::Ggx, masking: Masking::HeightCorrelated };
    let centre = |i: u32| (f64::from(i) + 0.5) / 64.0;
    let grid: Vec<(f64, f64)> =
        (0..64 * 64).map(|i| (centre(i % 64), centre(i / 64).powi(2))).collect();
    let truth = cpu::bake_points(lobe, &grid, &REFERENCE).scale_bias();
    for (name, evaluations, largest) in
        [("h56", 64, 1e-3), ("s640", 160, 1e-5), ("s640", 320, 1e-6)]
    {
        let rule = Rule::named(name).unwrap();
        let (error, at) = worst(lobe, &rule, &grid, &truth);
        assert!(error <= largest, "{name} errs by {error:e} at {at:?}");
        assert!(
            rule.evaluations(grid.len()) <= evaluations * grid.len(),
            "{name}: {}",
            rule.evaluations(grid.len())
        );
    }
}

/// A kernel in single numbers.
fn single<K: Kernel>(nodes: K, lobe: Microfacet, (mu, alpha): (f64, f64)) -> ScaleBias {
    nodes.integrate(lobe, Schlick, mu, alpha).0.into()
}

#[test]
fn a_lane_holds_the_bits_of_a_single_number() {
    // Groups of eight share instructions, not results: neither neighbours nor their number may
    // change a bit.
    for lobe in Microfacet::all() {
        let points = domain_of(lobe, 37);
        let names = [
            "h56", "l288", "p480", "r456", "b2544", "d6144", "s640", "s2080", "s2560", "s1792",
            "s1616", "s896", "s1120", "s1008", "s1248", "s1360",
        ];
        for name in names {
            let rule = Rule::named(name).unwrap();
            if !rule.applies_to(lobe) || (name == "d6144" && lobe.ndf == Ndf::Charlie) {
                continue;
            }
            let all = cpu::bake_points(lobe, &points, &rule).scale_bias();
            for (i, &point) in points.iter().enumerate().step_by(5) {
                let alone = match rule.method {
                    Method::HalfVectors(rule) => single(rule.nodes(), lobe, point),
                    Method::LightDirections(rule) => single(rule.nodes(), lobe, point),
                    Method::LightPlanes(rule) => single(rule.nodes(), lobe, point),
                    Method::Rings(rule) => single(rule.nodes(), lobe, point),
                    Method::BentRings(rule) => single(rule.nodes(), lobe, point),
                    Method::DoubleExponential(rule) => single(rule.nodes(), lobe, point),
                    Method::Interpolant(_) | Method::Glass(_) | Method::ClosedForm => {
                        cpu::bake_points(lobe, &[point], &rule).scale_bias()[0]
                    }
                };
                let bits = |value: ScaleBias| (value.a.to_bits(), value.b.to_bits());
                assert_eq!(bits(alone), bits(all[i]), "{name} of {lobe:?} at {point:?}");
            }
        }
    }
}

#[test]
fn a_tolerance_takes_the_cheapest_rule_that_keeps_it() {
    for lobe in Microfacet::all() {
        for texels in [16, 16384, 1 << 24] {
            for tolerance in [0.1, 1e-3, 1e-5, 1e-7, 2e-6, 1e-13] {
                let seconds = |rule: &Rule| rule.seconds(lobe, texels);
                let serves = |rule: &&Rule| rule.applies_to(lobe) && rule.bound(lobe) <= tolerance;
                let least = RULES.iter().filter(serves).map(seconds).fold(f64::INFINITY, f64::min);
                let chosen =
                    Rule::for_cpu(lobe, tolerance, texels).as_ref().map_or(f64::INFINITY, seconds);
                assert_eq!(chosen, least, "{lobe:?}, {tolerance:e} on {texels} texels");
            }
        }
        assert!(
            Rule::for_cpu(lobe, 1e-14, 64).is_none() && Rule::for_cpu(lobe, f64::NAN, 64).is_none()
        );
        let on_device = Rule::for_device(lobe, 1.001 * Rule::device_tolerance(lobe)).unwrap();
        assert!(
            on_device.runs_on_device()
                && Rule::for_device(lobe, 0.9 * Rule::device_tolerance(lobe)).is_none()
        );
    }
}

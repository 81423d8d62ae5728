//! Rough interfaces of two dielectrics: reflection and transmission on either side, beside
//! published figures, theorems and each other.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::{Random, figures, ggx, number};
use program::{ok, run, stderr};
use splitsum::backend::{Backend, cpu};
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::integrate::Integrand;
use splitsum::integrate::double_exponential::DoubleExponentialRule;
use splitsum::integrate::rules::{COARSE_ERROR, G112, G560, G904, G2240, G4536, REFERENCE};
use splitsum::integrate::view_polar::{ViewPolarNodes, view_polar};
use splitsum::numeric::special::log_beta;
use splitsum::{Glass, GlassChannels, Lut, Precision, Request};
use tempfile::tempdir;

const INTERFACES: &str = include_str!("figures/interfaces.csv");

/// The interface of a row of the figures.
fn interface(row: &[&str]) -> Interface {
    let ndf = if row[1] == "ggx" { Ndf::Ggx } else { Ndf::Beckmann };
    let masking = match row[2] {
        "corr" => Masking::HeightCorrelated,
        _ => Masking::Separable,
    };
    let side = if row[4] == "inside" { Side::Inside } else { Side::Outside };
    let transmission = match row[3] {
        "corr" => TransmissionMasking::Correlated,
        "sep" => TransmissionMasking::Separable,
        _ => TransmissionMasking::Beta,
    };
    Interface::new(Microfacet { ndf, masking }, number(row[8]), side, transmission).unwrap()
}

#[test]
fn albedos_in_polar_coordinates_about_v_are_the_published_figures() {
    let nodes = ViewPolarNodes::of(DoubleExponentialRule { outer: 160, inner: 160 });
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[0] == "dielectric") {
        let (interface, mu, r) = (interface(row), number(row[5]), number(row[6]));
        let got = view_polar(interface, mu, mu - interface.critical(), r * r, &nodes).0;
        for (got, truth) in got.into_iter().zip([number(row[11]), number(row[12])]) {
            // The figures' two methods agree within 1e-12.
            assert!((got - truth).abs() < 2e-12, "{row:?}: {got}");
        }
        rows += 1;
    }
    assert_eq!(rows, 239);
}

#[test]
fn the_logarithm_of_the_beta_function_keeps_its_digits() {
    // B(1, q) = 1/q, and B(2, q) = 1/(q (q + 1)).
    for q in [1.0, 3.7, 15.9, 16.0, 1e3, 1e9, 1e150] {
        let one = (log_beta(1.0, q) + f64::ln(q)).abs();
        let two = (log_beta(q, 2.0) + f64::ln(q) + f64::ln(q + 1.0)).abs();
        let allowed = 1e-14 * (1.0 + f64::ln(q));
        assert!(one < allowed && two < 2.0 * allowed, "{q}: {one} {two}");
    }
    // B(p, p+1) = B(p, p)/2, on both sides of where the formulas change.
    for p in [1.5, 15.2, 15.9, 17.0, 250.0, 1e6] {
        let halved = log_beta(p, p) - std::f64::consts::LN_2;
        assert!((log_beta(p, p + 1.0) - halved).abs() < 1e-14 * (1.0 + halved.abs()), "{p}");
    }
}

/// Interfaces of every kind with indices from 1 to 4, crowded at 1.
fn interfaces(count: usize, random: &mut Random) -> Vec<Interface> {
    let kinds = |i: usize| {
        let ndf = [Ndf::Ggx, Ndf::Beckmann][i / 2 % 2];
        let masking = [Masking::HeightCorrelated, Masking::Separable][i / 4 % 2];
        let transmission = TransmissionMasking::ALL[i / 8 % 3];
        (Microfacet { ndf, masking }, Side::ALL[i % 2], transmission)
    };
    let mut of = |i: usize| {
        let (lobe, side, transmission) = kinds(i);
        let ior = match i / 24 % 2 {
            0 => 1.0 + 3.0 * random.next(),
            _ => 1.0 + 10f64.powf(-6.0 * random.next()),
        };
        Interface::new(lobe, ior, side, transmission).unwrap()
    };
    (0..count).map(&mut of).collect()
}

/// Points (n·v, α) crowded at the edges of the domain, and at the critical angle and its like.
fn points(interface: Interface, count: usize, random: &mut Random) -> Vec<(f64, f64)> {
    let critical = interface.critical().max(0.3);
    let mut point = |i: usize| {
        let off = 1.0 + (random.next() - 0.5) * 10f64.powf(-9.0 * random.next());
        let mu = match i % 6 {
            0 => random.next(),
            1 => 10f64.powf(-30.0 * random.next()),
            2 => 1.0 - 10f64.powf(-16.0 * random.next()),
            3 => critical * off,
            4 => 2.0 * critical * off,
            _ => 10f64.powf(-4.0 * random.next()),
        };
        let r = match i % 4 {
            0 | 1 => random.next().max(5e-10),
            2 => 10f64.powf(-9.3 * random.next()),
            _ => 1.0 - 10f64.powf(-5.0 * random.next()),
        };
        (mu.min(1.0), (r * r).max(2.5e-19))
    };
    (0..count).map(&mut point).collect()
}

#[test]
fn the_coarse_reference_serves_to_measure_samples() {
    let mut random = Random(16);
    for interface in Interface::samples() {
        let points = points(interface, 24, &mut random);
        let integrand = Integrand::Glass(interface);
        let [coarse, truth] = [G560.gauge(integrand), REFERENCE]
            .map(|rule| cpu::bake_points(integrand, &points, &rule));
        for (coarse, truth) in coarse.values().iter().zip(truth.values()) {
            assert!((coarse - truth).abs() <= COARSE_ERROR, "{interface:?}: {coarse} {truth}");
        }
        assert!(cpu::bake_points(integrand, &[], &G560).values().is_empty());
    }
}

#[test]
fn every_rule_keeps_its_bounds_near_the_critical_angle_and_at_every_edge() {
    let mut random = Random(15);
    for interface in interfaces(48, &mut random) {
        let points = points(interface, 20, &mut random);
        let integrand = Integrand::Glass(interface);
        let truth = cpu::bake_points(integrand, &points, &REFERENCE);
        for rule in [G112, G560, G904, G2240, G4536] {
            let values = cpu::bake_points(integrand, &points, &rule);
            for ((&point, truth), values) in points.iter().zip(truth.iter()).zip(values.iter()) {
                let errors = rule.errors(integrand).at(point, values);
                for k in 0..2 {
                    let close = (values[k] - truth[k]).abs() <= errors[k] + 3e-12;
                    assert!(close, "{} {interface:?} {point:?}: {values:?} {truth:?}", rule.name);
                }
            }
        }
        // No masking term makes light (Heitz 2014), and what is transmitted is no less than 0.
        for integrals in truth.iter() {
            assert!(integrals.iter().sum::<f64>() < 1.0 + 1e-11 && integrals[1] >= 0.0);
        }
    }
}

#[test]
fn reflection_is_that_of_the_split_sums_lobe_with_exact_fresnel() {
    let mut random = Random(4);
    for ior in [1.02, 1.5, 4.0] {
        for lobe in [ggx(Masking::HeightCorrelated), ggx(Masking::Separable)] {
            let interface =
                Interface::new(lobe, ior, Side::Outside, TransmissionMasking::Separable).unwrap();
            let points = points(interface, 48, &mut random);
            let fresnel: Fresnel = format!("dielectric:{ior}").parse().unwrap();
            let lobe = Integrand::Specular(lobe, fresnel);
            let glass = cpu::bake_points(Integrand::Glass(interface), &points, &REFERENCE);
            let lobe = cpu::bake_points(lobe, &points, &REFERENCE);
            for ((point, glass), lobe) in points.iter().zip(glass.iter()).zip(lobe.iter()) {
                // Each of the two forms about v and over directions of light keeps 1e-12.
                assert!((glass[0] - lobe[0]).abs() < 3e-12, "{ior} {point:?}: {glass:?} {lobe:?}");
            }
        }
    }
}

#[test]
fn limits_are_those_of_theory() {
    let lobe = ggx(Masking::HeightCorrelated);
    let at = |ior, side, mu, alpha, rule| {
        let interface = Interface::new(lobe, ior, side, TransmissionMasking::Correlated).unwrap();
        let values = cpu::bake_points(Integrand::Glass(interface), &[(mu, alpha)], &rule);
        [values.values()[0], values.values()[1]]
    };
    for rule in [G2240, REFERENCE] {
        // A mirror, and a surface so smooth that it is nearly one.
        for (side, mu, f) in [(Side::Outside, 1.0, 0.04), (Side::Inside, 0.5, 1.0)] {
            for alpha in [0.0, 1e-9] {
                let [reflected, transmitted] = at(1.5, side, mu, alpha, rule);
                assert!((reflected - f).abs() < 1e-6 && (transmitted - (1.0 - f)).abs() < 1e-6);
            }
        }
        // η = 1 reflects nothing: T = (μ + S)/(2S), which for α = 1 is (1 + μ)/2.
        for side in [Side::Outside, Side::Inside] {
            assert_eq!(at(1.0, side, 0.3, 1.0, rule), [0.0, 0.65]);
            let nearly = at(1.0 + 1e-9, side, 0.3, 1.0, rule);
            assert!(nearly[0] < 1e-6 && (nearly[1] - 0.65).abs() < 1e-6, "{nearly:?}");
        }
        // Grazing light is not transmitted from inside, and from outside nothing is lost.
        assert_eq!(at(1.5, Side::Inside, 0.0, 0.3, rule)[1], 0.0);
        let [reflected, transmitted] = at(1.5, Side::Outside, 0.0, 0.3, rule);
        assert!((reflected + transmitted - 1.0).abs() < 1e-6);
    }
}

#[test]
fn a_table_of_both_sides_is_certified_to_the_last_bit() {
    let outside = Interface::new(
        ggx(Masking::HeightCorrelated),
        1.5,
        Side::Outside,
        TransmissionMasking::Correlated,
    )
    .unwrap();
    let packing = Glass::both_sides(outside, GlassChannels::Rt).unwrap();
    let request = Request::with_default_axes(packing, (12, 12), Precision::F16).unwrap();
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    let names: Vec<&str> = table.channels().iter().map(|channel| &*channel.name).collect();
    assert_eq!(names, ["R", "T", "R_inside", "T_inside"]);
    for (first, side) in [(0, Side::Outside), (2, Side::Inside)] {
        assert_eq!(table.parts(0)[first / 2].claim.certificate().unwrap().undecided, 0);
        let glass = Lut::Glass(Glass::new(outside.from(side), GlassChannels::Rt));
        let truth = cpu::bake(glass.integrand(), request.grid(), &REFERENCE, &|_| ());
        for (texel, truth) in truth.iter().enumerate() {
            let stored = table.texel(0, texel % 12, texel / 12);
            for k in 0..2 {
                assert_eq!(stored[first + k], Precision::F16.nearest(truth[k]), "{side} {texel}");
            }
        }
    }
}

#[test]
fn glass_is_baked_with_its_words_and_refused_with_reasons() {
    let folder = tempdir().unwrap();
    ok(&folder, "bake -q --lut glass --side both --size 4 --ior 1.33,1.5 -o glass.exr");
    let printed = String::from_utf8(
        ok(&folder, "bake --lut glass --channels total --size 4 --dry-run -o a.exr").stdout,
    );
    assert!(printed.unwrap().contains("R+T in f16"));
    for (arguments, said) in [
        ("--lut glass --masking schlick-smith", "height-correlated, separable"),
        ("--lut glass --model charlie", "ggx, beckmann"),
        ("--lut glass --ior 0.9", "index of refraction"),
        ("--lut glass --ior 100.5", "1 to 100"),
        ("--lut glass --ior 1.5,1.5", "different values"),
        ("--lut glass --fresnel f82", "schlick for energy, glass"),
        ("--side inside", "add --lut glass"),
        ("--lut glass --f0 0.04", "the split of energy"),
        ("--ior 1.5", "glass or the split"),
    ] {
        let output = run(&folder, &format!("bake {arguments} -o a.exr"));
        assert_eq!(output.status.code(), Some(4), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments}: {}", stderr(&output));
    }
    // With a device or without one.
    let output = run(&folder, "bake --size 4 --lut glass --transmission-masking beta -o b.exr");
    assert!(output.status.success() && stderr(&output).contains("correlated or separable"));
}

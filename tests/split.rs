//! The energy between specular and diffuse reflection: averages, what multiple scattering gives
//! back, what a base may get.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Integrator, average_in_pieces, figures, ggx, lobe_of, number};
use splitsum::backend::Backend;
use splitsum::backend::cpu::bake_points;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::integrate::average::{
    AVERAGE_ERROR, average_nodes, average_nodes_at, averages, averages_by_row,
};
use splitsum::integrate::rule::{CHARLIE_LIMIT, Rule};
use splitsum::integrate::rules::REFERENCE;
use splitsum::lut::{Energy, EnergyChannels, Lut};
use splitsum::numeric::quadrature::tanh_sinh::tanh_sinh;
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::table::axis::Axis;
use splitsum::table::precision::Precision;
use splitsum::units::F0;

fn bake(
    lobe: Microfacet,
    f0: f64,
    channels: EnergyChannels,
    rule: Rule,
    (mus, roughnesses): (usize, usize),
) -> Table {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let lut = Lut::Energy(Energy::new(lobe, F0::new(f0).unwrap(), channels).unwrap());
    let (x, y) = (axis("nov,edges", mus), axis("roughness,edges", roughnesses));
    let request = Request::new(lut, x, y, Accuracy::Rule(rule), Precision::F64).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

fn h6144() -> Rule {
    Rule::named("h6144").unwrap()
}

#[test]
fn averages_are_those_of_the_figures_to_1e_10() {
    let rows = figures(include_str!("figures/average_albedo.csv"));
    assert_eq!(rows.len(), 27);
    for row in &rows {
        let lut = Lut::Energy(
            Energy::new(lobe_of(row), F0::new(0.04).unwrap(), EnergyChannels::Average).unwrap(),
        );
        let axis = |words: &str| Axis::new(words.parse().unwrap(), 1).unwrap();
        // One texel at an edge is 0, and the min raises it to the roughness of the row.
        let (x, y) = (axis("nov"), axis(&format!("roughness,edges,min={}", row[2])));
        let request = Request::new(lut, x, y, Accuracy::Rule(REFERENCE), Precision::F64).unwrap();
        let texel = splitsum::bake(&request, &Backend::cpu()).unwrap().table.texel(0, 0, 0);
        let error = (texel[1] - number(row[3])).abs().max((texel[2] - number(row[4])).abs());
        assert!(error < 1e-10, "{row:?}: {texel:?}");
    }
}

#[test]
fn averages_are_within_their_bound_of_those_on_other_nodes() {
    for lobe in Microfacet::all() {
        for r in [1e-4, 1e-3, 0.02, 0.1, 0.3, 0.6, 1.0] {
            let alpha = r * r;
            if lobe.diverges_at_grazing() && alpha < CHARLIE_LIMIT {
                // No rule is as sharp there.
                continue;
            }
            // The layer at grazing angles is as wide as α, Charlie's far wider.
            let layers: &[f64] = match lobe.ndf {
                Ndf::Charlie if r < 0.1 => &[0.4, 4.0, 40.0, 400.0],
                _ => &[0.4],
            };
            let middles = layers.iter().map(|layer| layer * r).filter(|&middle| middle < 0.4);
            let middles: Vec<f64> = middles.chain(lobe.break_at(alpha)).collect();
            let truth = average_in_pieces(lobe, alpha, &middles);
            let check = |nodes: &[(f64, f64)]| {
                let directions: Vec<_> = nodes.iter().map(|node| (node.0, alpha)).collect();
                let integrals = bake_points(lobe, &directions, &REFERENCE);
                let got = averages(nodes, &integrals).scale_bias()[0];
                let error = (got.a - truth.a).abs().max((got.b - truth.b).abs());
                assert!(error <= AVERAGE_ERROR, "{lobe:?} at {r}: {error:e}");
            };
            check(&average_nodes_at(lobe.into(), alpha));
            if !averages_by_row(lobe.into()) {
                check(&average_nodes());
            }
        }
    }
}

#[test]
fn a_mirror_averages_to_20_21sts() {
    let table =
        bake(ggx(Masking::HeightCorrelated), 0.04, EnergyChannels::Average, h6144(), (3, 2));
    assert!(
        (table.texel(0, 1, 0)[0] - 20.0 / 21.0).abs() < 1e-14
            && (table.texel(0, 1, 0)[1] - 1.0 / 21.0).abs() < 1e-14
    );
    assert_eq!(table.texel(0, 0, 1), table.texel(0, 2, 1), "averages vary with roughness alone");
}

/// ∫ over directions of light of factor(μ) 2 μ dμ, by other nodes than the baker's.
fn over_light(factor: impl Fn(f64) -> f64) -> f64 {
    tanh_sinh(80)
        .iter()
        .map(|node| 2.0 * node.weight * node.from_start * factor(node.from_start))
        .sum()
}

#[test]
fn kulla_and_conty_give_back_what_is_lost() {
    let integrator = Integrator(h6144());
    for ndf in [Ndf::Ggx, Ndf::Beckmann] {
        let lobe = Microfacet { ndf, masking: Masking::HeightCorrelated };
        let table = bake(lobe, 0.04, EnergyChannels::KullaConty, h6144(), (5, 5));
        for (i, j) in [(0, 2), (2, 1), (4, 4), (1, 3)] {
            let (e, e_avg, r) =
                (table.texel(0, i, j)[0], table.texel(0, i, j)[1], table.y().value(j));
            let lost = over_light(|mu| 1.0 - integrator.integrate(lobe, mu, r * r).e());
            let returned = (1.0 - e) * lost / (1.0 - e_avg);
            assert!((e + returned - 1.0).abs() < 1e-6, "{ndf:?} at {i} {j}: {}", e + returned);
        }
    }
}

#[test]
fn turquins_factor_restores_the_lobe() {
    let lobe = ggx(Masking::Separable);
    let table = bake(lobe, 0.04, EnergyChannels::Turquin, h6144(), (9, 9));
    let integrator = Integrator(h6144());
    for (i, j) in [(0, 3), (3, 8), (8, 5)] {
        let r = table.y().value(j);
        let e = integrator.integrate(lobe, table.x().value(i), r * r).e();
        assert!(((1.0 + table.texel(0, i, j)[0]) * e - 1.0).abs() < 1e-14);
    }
}

#[test]
fn the_reciprocal_split_closes_in_a_white_furnace_and_the_naive_one_does_not() {
    let lobe = ggx(Masking::HeightCorrelated);
    let integrator = Integrator(h6144());
    let mut worst_naive = 0.0f64;
    for f0 in [0.02, 0.04, 0.08, 0.5] {
        let table = bake(lobe, f0, EnergyChannels::Split, h6144(), (9, 5));
        let average = |r: f64| over_light(|mu| integrator.integrate(lobe, mu, r * r).at_f0(f0));
        for j in 0..5 {
            let r = table.y().value(j);
            let e_avg = average(r);
            let factor = |mu: f64| {
                (1.0 - integrator.integrate(lobe, mu, r * r).at_f0(f0)) / (1.0 - e_avg).sqrt()
            };
            let light = over_light(factor);
            for i in 0..9 {
                let [naive, albedo, reciprocal] = table.texel(0, i, j)[..] else {
                    panic!("three channels")
                };
                let specular = integrator.integrate(lobe, table.x().value(i), r * r).at_f0(f0);
                assert!((specular + albedo - 1.0).abs() < 1e-12);
                let total = specular + reciprocal * light;
                assert!((total - 1.0).abs() < 1e-6, "F0 {f0} at {i} {j}: {total}");
                worst_naive = worst_naive.max((specular + naive - 1.0).abs());
            }
        }
    }
    // At grazing angles a rough lobe reflects far less than F says.
    assert!(worst_naive > 0.3, "{worst_naive}");
}

#[test]
fn what_leaves_no_energy_or_makes_some_is_refused() {
    let f0 = |value| F0::new(value).unwrap();
    let sheen = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    let implicit = Microfacet { ndf: Ndf::BlinnPhong, masking: Masking::Implicit };
    assert!(Energy::new(sheen, f0(0.04), EnergyChannels::Split).is_err());
    assert!(Energy::new(implicit, f0(0.04), EnergyChannels::Turquin).is_err());
    assert!(Energy::new(implicit, f0(0.04), EnergyChannels::Split).is_ok());
    assert!(
        Energy::new(ggx(Masking::HeightCorrelatedApprox), f0(1.0), EnergyChannels::Split).is_err()
    );
    assert!(
        Energy::new(ggx(Masking::HeightCorrelatedApprox), f0(1.0), EnergyChannels::Average).is_ok()
    );
}

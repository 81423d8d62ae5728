//! Tables of glass and of the energy at an interface: averages, multiple scattering, the index of
//! refraction as the third axis, and the tables that Cycles ships.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::{figures, ggx, number};
use program::{run, stderr};
use splitsum::backend::Backend;
use splitsum::backend::cpu::Baker;
use splitsum::brdf::interface::{Interface, Side, TransmissionMasking};
use splitsum::brdf::{Fresnel, Masking, Microfacet, Ndf};
use splitsum::choice::Choice;
use splitsum::furnace::coat::{Coat, coated};
use splitsum::integrate::Integrand;
use splitsum::integrate::estimator::Estimator;
use splitsum::integrate::rules::{G4536, REFERENCE};
use splitsum::lut::energy::{base_albedo, effective_albedo};
use splitsum::request::Accuracy;
use splitsum::table::Table;
use splitsum::table::axis::Axis;
use splitsum::table::grid::Grid;
use splitsum::table::slices::Slices;
use splitsum::{Energy, Glass, GlassChannels, Lut, Precision, Request};
use tempfile::tempdir;

const INTERFACES: &str = include_str!("figures/interfaces.csv");
const CYCLES: &str = include_str!("figures/cycles_glass_16.csv");
const CYCLES_AVERAGES: &str = include_str!("figures/cycles_glass_average_16.csv");

const CORRELATED: TransmissionMasking = TransmissionMasking::Correlated;

fn glass(ior: f64, side: Side) -> Interface {
    Interface::new(ggx(Masking::HeightCorrelated), ior, side, CORRELATED).unwrap()
}

/// The averages of the integrals of an interface at an α, by the reference.
fn averages(interface: Interface, alpha: f64) -> [f64; 2] {
    let averages = Baker::new(Integrand::Glass(interface), &REFERENCE).averages(&[alpha]);
    [averages.values()[0], averages.values()[1]]
}

fn side(word: &str) -> Side {
    Side::named(word).unwrap()
}

#[test]
fn averages_are_the_published_figures() {
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[0] == "average") {
        let ndf = if row[1] == "ggx" { Ndf::Ggx } else { Ndf::Beckmann };
        let (masking, transmission) = match row[2] {
            "corr" => (Masking::HeightCorrelated, CORRELATED),
            _ => (Masking::Separable, TransmissionMasking::Separable),
        };
        let lobe = Microfacet { ndf, masking };
        let interface = Interface::new(lobe, number(row[8]), side(row[4]), transmission).unwrap();
        let r = number(row[6]);
        let got = averages(interface, r * r);
        for (got, truth) in got.into_iter().zip([number(row[11]), number(row[12])]) {
            // The figures' second method differs from the first by up to 1.5e-10.
            assert!((got - truth).abs() < 1e-9, "{row:?}: {got}");
        }
        rows += 1;
    }
    assert_eq!(rows, 26);
}

#[test]
fn reflectances_over_all_directions_are_the_published_figures() {
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[0] == "fresnel-average") {
        if row[7] != "dielectric" {
            continue;
        }
        let got = glass(number(row[8]), side(row[4])).average_reflectance();
        let truth = number(row[11]);
        // The index of the figures is a decimal: f64 moves it by 1e-16.
        assert!((got.value - truth).abs() <= got.error + 4e-16, "{row:?}: {got:?}");
        assert!(got.error < 1e-13 * truth.max(0.1), "{row:?}: {got:?}");
        rows += 1;
    }
    assert!(rows > 20, "{rows}");
}

#[test]
fn transmission_is_reciprocal_on_average() {
    // T_avg(η) = η² T_avg(1/η): what passes the one way passes the other.
    for (ndf, masking, transmission) in [
        (Ndf::Ggx, Masking::HeightCorrelated, TransmissionMasking::Correlated),
        (Ndf::Ggx, Masking::Separable, TransmissionMasking::Separable),
        (Ndf::Ggx, Masking::HeightCorrelated, TransmissionMasking::Beta),
        (Ndf::Beckmann, Masking::HeightCorrelated, TransmissionMasking::Correlated),
    ] {
        for ior in [1.001, 1.33, 4.0] {
            for alpha in [0.0, 0.09, 1.0] {
                let lobe = Microfacet { ndf, masking };
                let outside = Interface::new(lobe, ior, Side::Outside, transmission).unwrap();
                let there = averages(outside, alpha)[1];
                let back = averages(outside.from(Side::Inside), alpha)[1] * ior * ior;
                // The directions of averages leave 1e-12 each, of which one counts n² times.
                let allowed = 1e-12 * (1.0 + ior * ior);
                assert!((there - back).abs() < allowed, "{outside} {alpha}: {there} {back}");
            }
        }
    }
}

#[test]
fn the_split_at_an_interface_is_the_published_one() {
    let mut rows = 0;
    for row in figures(INTERFACES).iter().filter(|row| row[0] == "coated-diffuse") {
        let ndf = if row[1] == "ggx" { Ndf::Ggx } else { Ndf::Beckmann };
        let masking = if row[2] == "corr" { Masking::HeightCorrelated } else { Masking::Separable };
        let (mu, r, ior) = (number(row[5]), number(row[6]), number(row[8]));
        let (rho, k) = (number(row[9]), number(row[10]));
        let energy = Energy::of_interface(Microfacet { ndf, masking }, ior).unwrap();
        let axis = |words: String| Axis::new(words.parse().unwrap(), 1).unwrap();
        let request = Request::new(
            Lut::Energy(energy),
            axis(format!("nov,edges,min={mu}")),
            axis(format!("roughness,edges,min={r}")),
            Accuracy::Rule(REFERENCE),
            Precision::F64,
        )
        .unwrap();
        let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
        let [_, left, factor, back] = table.texel(0, 0, 0)[..] else {
            unreachable!("four channels")
        };
        assert!((1.0 - left - number(row[11])).abs() < 1e-11, "{row:?}: S = {}", 1.0 - left);
        // The figures' averages are good to 1e-10.
        let close = |got: f64, truth: f64| (got - truth).abs() < 1e-9;
        assert!(close(factor, number(row[17])), "{row:?}: R = {factor}");
        assert!(close(back, k), "{row:?}: K = {back}");
        let effective = effective_albedo(rho, back);
        assert!(close(effective, number(row[16])), "{row:?}: {effective}");
        assert!((base_albedo(effective, back) - rho).abs() < 1e-14);
        rows += 1;
    }
    assert_eq!(rows, 22);
}

#[test]
fn of_seven_formulas_for_a_coated_base_the_last_alone_is_right_for_a_grey_one() {
    let alphas = vec![0.0, 0.0625, 1.0];
    let grid = Grid::of(vec![0.1, 0.5, 1.0], alphas);
    let lobe = ggx(Masking::HeightCorrelated);
    let all = coated(lobe, 1.5, &[1.0, 0.5], &grid, &REFERENCE).unwrap();
    let of = |coat, rho| all.iter().find(|of| of.coat == coat && of.rho == rho).unwrap();
    // All that a white base receives comes back, for whoever closes.
    for coat in [Coat::AlbedoScaling, Coat::Reciprocal, Coat::Interreflecting] {
        for energy in &of(coat, 1.0).energy {
            assert!((energy - 1.0).abs() < 1e-11, "{coat}: {energy}");
        }
    }
    let reciprocal: Vec<Coat> =
        Coat::ALL.iter().copied().filter(|coat| of(*coat, 0.5).asymmetry < 1e-12).collect();
    let expected = [
        Coat::Sum,
        Coat::BothWays,
        Coat::AshikhminShirley,
        Coat::Reciprocal,
        Coat::Interreflecting,
    ];
    assert_eq!(reciprocal, expected);
    // A smooth interface: Saunderson's 1942, with F_avg = 0.0917780 and 0.5963458 from inside.
    let (f, inside) = (0.091_777_959_342_351_2, 0.596_345_759_707_712);
    let saunderson = f + (1.0 - f) * (1.0 - inside) * 0.5 / (1.0 - 0.5 * inside);
    let smooth = of(Coat::Interreflecting, 0.5).averages[0];
    assert!((smooth - saunderson).abs() < 1e-11, "{smooth} {saunderson}");
    // Albedo scaling is 1.55 times too bright there.
    let scaled = of(Coat::AlbedoScaling, 0.5).averages[0];
    assert!((scaled / smooth - 1.546).abs() < 1e-3, "{scaled} {smooth}");
}

#[test]
fn what_is_lost_between_facets_comes_back_reciprocally() {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let (x, y) = (axis("nov", 1), axis("roughness,edges,min=0.3", 3));
    let bake = |ior, side, channels| {
        let lut = Lut::Glass(Glass::new(glass(ior, side), channels));
        let request = Request::new(lut, x, y, Accuracy::Rule(REFERENCE), Precision::F64).unwrap();
        splitsum::bake(&request, &Backend::cpu()).unwrap().table
    };
    for ior in [1.2, 1.6, 2.5] {
        let [outside, inside] = [Side::Outside, Side::Inside].map(|side| {
            let q = bake(ior, side, GlassChannels::LostShare);
            let e = bake(ior, side, GlassChannels::KullaConty);
            (0..3).map(|j| (q.value(0, 0, j, 0), e.value(0, 0, j, 1))).collect::<Vec<_>>()
        });
        for (&(q_o, e_o), &(q_i, e_i)) in outside.iter().zip(&inside) {
            // f_t/f_t' = n².
            let ratio = (1.0 - q_o) / (1.0 - e_i) / ((1.0 - q_i) / (1.0 - e_o));
            assert!((ratio / (ior * ior) - 1.0).abs() < 1e-9, "{ior}: {q_o} {q_i}");
        }
        // Lobes.md of the field: 0.385 at n = 1.6 with separable masking; here it is correlated.
        assert!(outside.iter().all(|&(q, _)| (0.0..1.0).contains(&q)));
    }
    // Both lobes scaled keep all: (R + T) (1 + (1-E)/E) = 1.
    let (scale, kept) = (
        bake(1.5, Side::Inside, GlassChannels::Turquin),
        bake(1.5, Side::Inside, GlassChannels::Total),
    );
    for j in 0..3 {
        let whole = kept.value(0, 0, j, 0) * (1.0 + scale.value(0, 0, j, 0));
        assert!((whole - 1.0).abs() < 1e-14, "{whole}");
    }
}

/// R + T in slices of the index of refraction, as Cycles' tables lay them out.
fn like_cycles(side: Side, channels: GlassChannels, accuracy: Accuracy) -> Table {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let z = axis("ior,sqrt-f0,edges", 16);
    let (y, rows) = match channels {
        GlassChannels::Average => ("nov", 1),
        _ => ("nov,edges,min=1e-4", 16),
    };
    let lut = Lut::Glass(Glass::new(glass(1.5, side), channels));
    let x = axis("roughness,edges,min=1e-4", 16);
    let request = Request::new(lut, x, axis(y, rows), accuracy, Precision::F64).unwrap();
    let request = request.with_slices(Slices::along(&z).unwrap()).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

/// The largest difference of R + T from a column of Cycles' figures, and the mean; of the first
/// slice, n = 1, Cycles says 1, since there it takes no surface to be there.
fn difference(table: &Table, column: usize) -> (f64, f64) {
    let (mut largest, mut sum, mut rows) = (0.0f64, 0.0, 0.0);
    for row in figures(CYCLES).iter().filter(|row| row[0] != "0") {
        let [z, y, x] = [0, 1, 2].map(|k| row[k].parse::<usize>().unwrap());
        let difference = (table.value(z, x, y, 0) - number(row[column])).abs();
        largest = largest.max(difference);
        sum += difference;
        rows += 1.0;
    }
    assert_eq!(rows, 3840.0);
    (largest, sum / rows)
}

#[test]
fn the_glass_of_cycles_is_ours_but_for_refractions_to_the_wrong_side() {
    let rule = Accuracy::Rule(G4536);
    let outside = like_cycles(Side::Outside, GlassChannels::Total, rule);
    let (largest, mean) = difference(&outside, 3);
    // Monte Carlo with 2²³ samples: its standard error is up to 3e-6, of which the largest of so
    // many is some 4.4.
    assert!(largest < 1.4e-5 && mean < 2e-6, "{largest} {mean}");
    let inside = like_cycles(Side::Inside, GlassChannels::Total, rule);
    let (largest, mean) = difference(&inside, 4);
    assert!(largest > 0.9 && mean > 0.015, "{largest} {mean}");
    let wrong = Accuracy::Estimator(Estimator::WrongSide);
    let counted = like_cycles(Side::Inside, GlassChannels::Total, wrong);
    let (largest, mean) = difference(&counted, 4);
    // Noise again: three of them are off by more than 2e-5.
    assert!(largest < 2.5e-5 && mean < 3e-6, "{largest} {mean}");
    // The tables themselves say so: what is wrong lies below the critical angle alone.
    for row in figures(CYCLES).iter().filter(|row| row[0] != "0") {
        let [z, y, x] = [0, 1, 2].map(|k| row[k].parse::<usize>().unwrap());
        let (mu, z) = ((y as f64 / 15.0).max(1e-4), (z as f64 / 15.0).min(0.99));
        let n = (1.0 + z * z) / (1.0 - z * z);
        let off = (inside.value(row[0].parse().unwrap(), x, y, 0) - number(row[4])).abs();
        let critical = ((n - 1.0) * (n + 1.0)).sqrt() / n;
        assert!(off < 2.5e-5 || mu < critical, "{row:?}: {off}");
    }
    // Its averages, the wrong ones with a bias that is smaller than they are wide.
    let average = like_cycles(Side::Outside, GlassChannels::Average, rule);
    for row in figures(CYCLES_AVERAGES).iter().filter(|row| row[0] != "0") {
        let [z, x] = [0, 1].map(|k| row[k].parse::<usize>().unwrap());
        let got = average.value(z, x, 0, 0) + average.value(z, x, 0, 1);
        assert!((got - number(row[2])).abs() < 2e-5, "{row:?}: {got}");
    }
}

#[test]
fn an_index_of_refraction_runs_along_the_third_axis() {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let close = |got: Vec<f64>, truth: &[f64]| {
        assert!(got.len() == truth.len());
        assert!(got.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-14), "{got:?} {truth:?}");
    };
    close(axis("ior,edges", 3).values(), &[1.0, 2.0, 3.0]);
    close(axis("ior,edges,min=1.2,max=1.6", 3).values(), &[1.2, 1.4, 1.6]);
    // z = √((n-1)/(n+1)): n = 5/3 at z = ½, 1.133… at z = ¼, and 99.5 at z = 0.99.
    close(axis("ior,sqrt-f0,edges", 3).values(), &[1.0, 5.0 / 3.0, 1.9801 / 0.0199]);
    close(
        axis("ior,sqrt-f0,edges,max=1.6666666666666667", 3).values(),
        &[1.0, 17.0 / 15.0, 5.0 / 3.0],
    );
    close(axis("ior,piecewise,edges,max=2.5", 5).values(), &[0.4, 0.7, 1.0, 1.75, 2.5]);
    // Places between texels, and the way back.
    for words in ["ior,max=4", "ior,sqrt,max=3", "ior,sqrt-f0,max=9", "ior,piecewise,max=2.5"] {
        let axis = axis(words, 7);
        for i in 0..60 {
            let texel = f64::from(i) * 0.1;
            let ior = axis.value_at(texel);
            // Beyond its max the axis is clamped.
            if ior < axis.spec().max {
                assert!((axis.texel(ior) - texel).abs() < 1e-12, "{words} {texel}: {ior}");
            }
        }
    }
    // Below 1 glass is seen from inside.
    let lut = Lut::Glass(Glass::new(glass(1.5, Side::Outside), GlassChannels::Rt));
    let request = Request::with_default_axes(lut, (4, 4), Precision::F16).unwrap();
    let z = Slices::along(&axis("ior,piecewise,edges,max=2", 3)).unwrap();
    let table = splitsum::bake(&request.clone().with_slices(z).unwrap(), &Backend::cpu()).unwrap();
    let seen = |slice: usize| table.table.parts(slice)[0].provenance.interface.clone().unwrap();
    assert_eq!((seen(0).side, seen(0).ior), ("inside", 2.0));
    assert_eq!((seen(1).side, seen(1).ior), ("outside", 1.0));
    assert_eq!((seen(2).side, seen(2).ior), ("outside", 2.0));
    let inside = Lut::Glass(Glass::new(glass(2.0, Side::Inside), GlassChannels::Rt));
    let alone = Request::with_default_axes(inside, (4, 4), Precision::F16).unwrap();
    let alone = splitsum::bake(&alone, &Backend::cpu()).unwrap().table;
    assert_eq!(table.table.bytes(0), alone.bytes(0));
}

#[test]
fn a_table_can_be_centred_on_the_critical_angle() {
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let lut = Lut::Glass(Glass::new(glass(2.0, Side::Inside), GlassChannels::Rt));
    let (x, y) = (axis("critical,edges", 5), axis("roughness", 3));
    let request = Request::new(lut, x, y, Accuracy::Rounded, Precision::F16).unwrap();
    let request =
        request.with_slices(Slices::along(&axis("ior,edges,min=1.5,max=2", 2)).unwrap()).unwrap();
    for (grid, n) in request.grids().iter().zip([1.5, 2.0f64]) {
        let c = (1.0 - 1.0 / (n * n)).sqrt();
        let truth = [0.0, 0.5 * c, c, 0.5 + 0.5 * c, 1.0];
        assert!(grid.mus.iter().zip(truth).all(|(a, b)| (a - b).abs() < 1e-15), "{grid:?}");
    }
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    // On the critical angle of a nearly smooth surface about half is let through.
    assert_eq!(table.texel(0, 0, 0)[1], 0.0);
    assert!(table.texel(1, 4, 0)[1] > 0.88);
}

#[test]
fn models_that_have_no_such_tables_are_refused() {
    let folder = tempdir().unwrap();
    for (arguments, said) in [
        ("--lut glass --x critical --size 4", "add --lut glass --side inside"),
        ("--lut glass --side both --x critical --size 4", "add --lut glass --side inside"),
        ("--lut glass --side inside --z ior,piecewise --size 4x4x4", "indices below 1"),
        ("--lut glass --z ior,max=1000 --size 4x4x4", "1 to 100"),
        ("--lut glass --z ior,sqrt-f0,max=0.5 --size 4x4x4", "min and max from 1 up"),
        ("--lut glass --x nov,sqrt-f0 --size 4", "of ior sqrt-f0"),
        ("--lut glass --z ior", "as in 64x64x16"),
        ("--lut glass --side both --channels rt --z ior,edges,max=1 --size 4x4x2", "from 1 up"),
        (
            "--lut energy --z ior --size 4x4x2 --channels average",
            "a parameter that the table varies",
        ),
        ("--lut energy --ior 0.5", "at least 1"),
        ("--lut energy --model charlie --ior 1.5", "albedo"),
        ("--estimator wrong-side", "R and T of glass"),
        ("--lut glass --estimator hammersley,n=8,frame=cos", "integrals of ggx"),
        (
            "--lut glass --side both --channels lost-share --y roughness,edges --size 4",
            "the min of",
        ),
    ] {
        let output = run(&folder, &format!("bake {arguments} -o a.exr"));
        assert_eq!(output.status.code(), Some(4), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments}: {}", stderr(&output));
    }
}

#[test]
fn the_albedo_of_a_table_at_an_interface_is_that_of_its_fresnel_model() {
    let lobe = ggx(Masking::HeightCorrelated);
    let energy = Energy::of_interface(lobe, 1.5).unwrap();
    let model: Fresnel = "dielectric:1.5".parse().unwrap();
    assert_eq!(Lut::Energy(energy).integrand(), Integrand::Specular(lobe, model));
    // Nothing reflects where there is no interface, and all light comes back.
    let none = Lut::Energy(Energy::of_interface(lobe, 1.0).unwrap());
    let request = Request::with_default_axes(none, (3, 3), Precision::F16).unwrap();
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    assert_eq!(table.texel(0, 1, 1), [1.0, 1.0, 1.0, 0.0]);
}

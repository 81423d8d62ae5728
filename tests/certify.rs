//! Certification: every value is the correctly rounded integral, whoever computes it, and what
//! disagrees is found out.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{ab, certify, field, ggx, part};
use splitsum::backend::{Backend, cpu};
use splitsum::brdf::{Diffuse, Masking, Microfacet, Ndf};
use splitsum::certify::decision::Task;
use splitsum::certify::stages::rules;
use splitsum::certify::ziv::DeviceTable;
use splitsum::choice::Choice;
use splitsum::error::{Error, ExitCode};
use splitsum::integrate::ScaleBias;
use splitsum::integrate::rule::Rule;
use splitsum::integrate::rules::REFERENCE;
use splitsum::lut::{Energy, EnergyChannels, Lut, Part};
use splitsum::request::Request;
use splitsum::table::axis::Axis;
use splitsum::table::grid::Grid;
use splitsum::table::precision::Precision;
use splitsum::units::F0;

fn grid(x: &str, y: &str, size: usize) -> Grid {
    let axis = |words: &str| Axis::new(words.parse().unwrap(), size).unwrap();
    Grid::new(&axis(x), &axis(y)).unwrap()
}

fn task<'a>(lut: &'a Part, grid: &'a Grid, precision: Precision) -> Task<'a> {
    Task { lut, grid, slices: 1, precision, tolerance: precision.default_tolerance() }
}

#[test]
fn every_value_of_every_lobe_is_the_reference_rounded() {
    for lobe in Microfacet::all() {
        let (lut, grid) = (part(lobe), grid("nov", "roughness", 64));
        let truth = cpu::bake(lobe, &grid, &REFERENCE, &|_| ()).scale_bias();
        for precision in [Precision::F16, Precision::Unorm16, Precision::Unorm8] {
            let certified = certify(&task(&lut, &grid, precision), None).unwrap();
            assert_eq!(certified.certificate.undecided, 0, "{lobe:?}");
            for (value, truth) in
                certified.values.iter().zip(truth.iter().flat_map(|value| [value.a, value.b]))
            {
                let rounded = precision.nearest(truth);
                if precision.holds(rounded) {
                    assert_eq!(*value, rounded, "{lobe:?} in {precision:?}");
                } else {
                    // It is left as it is, for the error that names it; a stage's error is at most
                    // 1e-7 of it.
                    assert!(
                        (value - truth).abs() < 1e-7 * truth,
                        "{lobe:?} in {precision:?}: {value} for {truth}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_hardest_texels_of_the_largest_usual_table_round_correctly() {
    let (lut, grid) = (part(ggx(Masking::HeightCorrelated)), grid("nov", "roughness", 512));
    let lobe = ggx(Masking::HeightCorrelated);
    let certified = certify(&task(&lut, &grid, Precision::F16), None).unwrap();
    // Whatever lies within 1e-8 of a boundary, by the reference with more nodes.
    let rule = Rule::named("l4608").unwrap();
    let values = cpu::bake(lobe, &grid, &rule, &|_| ()).scale_bias();
    let hard =
        |v: &ScaleBias| [v.a, v.b].iter().any(|&v| Precision::F16.distance_to_boundary(v) < 1e-8);
    let hard: Vec<usize> = (0..values.len()).filter(|&texel| hard(&values[texel])).collect();
    assert!(hard.len() > 100, "{} are hard", hard.len());
    let truth = cpu::bake_at(lobe, &grid, &REFERENCE.yardstick(), &hard).scale_bias();
    let mut nearest = f64::INFINITY;
    for (&texel, truth) in hard.iter().zip(truth) {
        let truth = [truth.a, truth.b];
        let expected = truth.map(|value| Precision::F16.nearest(value));
        assert_eq!(certified.values[2 * texel..][..2], expected, "texel {texel}");
        let distances = truth.map(|value| Precision::F16.distance_to_boundary(value));
        nearest = distances.into_iter().fold(nearest, f64::min);
    }
    // By an independent computation the distance of the nearest value from a boundary is 8.2e-13.
    assert!((8.15e-13..8.25e-13).contains(&nearest), "{nearest:e}");
    // The certificate knows those alone that the reference had to decide.
    let known = certified.certificate.smallest_distance;
    assert!(known.is_none_or(|known| known > 0.999 * nearest), "{known:?}");
}

/// Whether or not an interpolant comes first, and however coarse a device is.
fn stages_change_nothing(lobe: Microfacet, grid: &Grid, part: &Part) {
    let task = task(part, grid, Precision::F16);
    assert_eq!(rules(&task)[0].name, "s1344");
    let whole = certify(&task, None).unwrap();
    let rule = Rule::named("h640").unwrap();
    let mut points = cpu::bake(lobe, grid, &rule, &|_| ()).scale_bias();
    for shift in [0.0, 8e-7, -8e-7] {
        points.iter_mut().for_each(|value| value.a += shift);
        let device = DeviceTable { integrals: &field(&points), rule: &rule, name: "a device" };
        let through = certify(&task, Some(device)).unwrap();
        assert_eq!((&through.values, &through.certificate), (&whole.values, &whole.certificate));
    }
}

#[test]
fn stages_that_have_no_bound_somewhere_are_passed_over_there() {
    // Charlie's fitted term below roughness 0.07, where only the reference has a bound; Blinn-Phong
    // on either side of roughness 0.7, beyond which p1024 has none.
    let sheen = Microfacet { ndf: Ndf::Charlie, masking: Masking::HeightCorrelated };
    let phong = Microfacet { ndf: Ndf::BlinnPhong, masking: Masking::Separable };
    let cases = [
        (sheen, grid("nov,edges,min=0.2", "roughness,edges,min=0.03,max=0.06", 4)),
        (phong, grid("nov", "roughness,edges,min=0.5", 24)),
    ];
    for (lobe, grid) in cases {
        let lut = part(lobe);
        let task = task(&lut, &grid, Precision::F16);
        let whole = certify(&task, None).unwrap();
        let rule = Rule::named("h6144").unwrap();
        let integrals = cpu::bake(lobe, &grid, &rule, &|_| ());
        let device = DeviceTable { integrals: &integrals, rule: &rule, name: "a device" };
        let through = certify(&task, Some(device)).unwrap();
        assert_eq!((&through.values, &through.certificate), (&whole.values, &whole.certificate));
    }
}

#[test]
fn stages_do_not_change_a_value_and_the_reference_sees_the_same_texels() {
    let lobe = ggx(Masking::HeightCorrelated);
    let large = grid("nov", "roughness", 96);
    stages_change_nothing(lobe, &large, &part(lobe));
    let energy =
        |channels| Lut::Energy(Energy::new(lobe, F0::new(0.04).unwrap(), channels).unwrap());
    stages_change_nothing(lobe, &large, &energy(EnergyChannels::KullaConty).into());
    stages_change_nothing(lobe, &large, &energy(EnergyChannels::Split).into());
    let lut = part(lobe);
    let task = task(&lut, &large, Precision::F16);
    let whole = certify(&task, None).unwrap();
    for (row, &alpha) in large.alphas.iter().enumerate().step_by(20) {
        let small = Grid::of(large.mus.clone(), vec![alpha]);
        let alone = certify(&Task { grid: &small, ..task }, None).unwrap();
        assert_eq!(alone.stages[0].by, "CPU f64, l2048");
        assert_eq!(alone.values[..], whole.values[2 * 96 * row..][..2 * 96]);
    }
}

#[test]
fn exact_ties_of_a_mirror_go_to_even() {
    // (1-n.v)^5 = 3125/2^25 at n.v = 1 - 5/32: twelve bits, the last of which is half a step.
    let (lut, grid) =
        (part(ggx(Masking::HeightCorrelated)), grid("nov,edges", "roughness,edges", 65));
    let certified = certify(&task(&lut, &grid, Precision::F16), None).unwrap();
    assert_eq!(certified.certificate.undecided, 0);
    let texel = grid.mus.iter().position(|&mu| mu == 1.0 - 5.0 / 32.0).unwrap();
    let tie = 3125.0 / 2f64.powi(25);
    let steps = certified.values[2 * texel + 1] / splitsum::numeric::half::step(tie);
    assert_eq!((Precision::F16.distance_to_boundary(tie), steps % 2.0), (0.0, 0.0));
}

/// The failure of certification when a good device's table is spoiled.
fn found_out(lobe: Microfacet, spoil: fn(&mut [ScaleBias])) -> Option<Error> {
    let (lut, grid, rule) =
        (part(lobe), grid("nov", "roughness", 64), Rule::named("h640").unwrap());
    let mut points = cpu::bake(lobe, &grid, &rule, &|_| ()).scale_bias();
    spoil(&mut points);
    let device = DeviceTable { integrals: &field(&points), rule: &rule, name: "a device" };
    certify(&task(&lut, &grid, Precision::F16), Some(device)).err()
}

#[test]
fn a_device_that_errs_beyond_its_bound_is_found_out() {
    let (covered, other) =
        (ggx(Masking::Separable), Microfacet { ndf: Ndf::Beckmann, masking: Masking::Separable });
    for lobe in [covered, other] {
        assert!(found_out(lobe, |_| ()).is_none(), "{lobe:?}");
        let faults: [fn(&mut [ScaleBias]); 6] = [
            |table| table.fill(ScaleBias::default()),
            |table| table[7 * 64..8 * 64].fill(ScaleBias::default()),
            |table| table[1234].a = f64::NAN,
            |table| table[1234].b = 1.5,
            |table| (0..64).for_each(|i| table.swap(i, 64 + i)),
            |table| table.iter_mut().for_each(|value| value.b += 4e-6),
        ];
        for (i, fault) in faults.into_iter().enumerate() {
            let error =
                found_out(lobe, fault).unwrap_or_else(|| panic!("fault {i} of {lobe:?} passed"));
            assert_eq!(error.exit_code(), ExitCode::CheckFailed);
        }
    }
    // Where an interpolant checks every texel, a single one is enough.
    let wrong_texels: [fn(&mut [ScaleBias]); 4] = [
        |table| table[0].a += 1e-5,
        |table| table[777].b -= 1e-5,
        |table| table[1234].a -= 1e-5,
        |table| table[4095].b += 1e-5,
    ];
    for (texel, wrong) in wrong_texels.into_iter().enumerate() {
        let error = found_out(covered, wrong);
        let text = error.unwrap_or_else(|| panic!("a wrong texel {texel} passed")).to_string();
        assert!(text.contains("a device") && text.contains("farther apart"), "{text}");
    }
}

#[test]
fn every_family_is_certified() {
    let energy =
        |lobe, channels| Lut::Energy(Energy::new(lobe, F0::new(0.04).unwrap(), channels).unwrap());
    let (smith, beckmann) = (
        ggx(Masking::HeightCorrelated),
        Microfacet { ndf: Ndf::Beckmann, masking: Masking::Separable },
    );
    let mut luts: Vec<Lut> = Diffuse::ALL.iter().copied().map(Lut::Diffuse).collect();
    for channels in [
        EnergyChannels::Average,
        EnergyChannels::KullaConty,
        EnergyChannels::Turquin,
        EnergyChannels::Split,
    ] {
        luts.extend([smith, beckmann].map(|lobe| energy(lobe, channels)));
    }
    let grid = grid("nov,edges", "roughness,edges", 24);
    for lut in luts {
        for precision in [Precision::F16, Precision::F32] {
            let certified = certify(&task(&lut.into(), &grid, precision), None).unwrap();
            // What a smooth lobe loses or leaves tends to 0, where f32 has finer steps than the
            // reference.
            let vanishes = ["(1-E)/E", "1-F"].contains(&&*lut.channels()[0].name);
            let fine = precision == Precision::F32 && vanishes;
            assert!(
                fine || certified.certificate.undecided == 0,
                "{lut:?}: {}",
                certified.certificate.promise
            );
        }
    }
}

#[test]
fn f32_is_rounded_correctly_where_that_is_cheap_and_else_within_its_bound() {
    let lobe = ggx(Masking::HeightCorrelated);
    let lut = part(lobe);
    for (size, correct) in [(24, true), (96, false)] {
        let grid = grid("nov", "roughness", size);
        let certified = certify(&task(&lut, &grid, Precision::F32), None).unwrap();
        let truth = cpu::bake(lobe, &grid, &REFERENCE, &|_| ()).scale_bias();
        let pairs =
            || certified.values.iter().zip(truth.iter().flat_map(|value| [value.a, value.b]));
        assert_eq!(certified.certificate.undecided == 0, correct);
        assert_eq!(pairs().all(|(value, truth)| *value == f64::from(truth as f32)), correct);
        // The certificate's bound holds, and it is the tolerance and half a step.
        let bound = certified.certificate.bound;
        assert!(pairs().all(|(value, truth)| (value - truth).abs() <= bound), "{size}");
        let most = Precision::F32.default_tolerance() + Precision::F32.half_step();
        assert!(bound <= most, "{size}: {bound:e}, {most:e} allowed");
    }
}

#[test]
fn where_the_reference_is_worse_the_certificate_says_so() {
    let lobe = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    let sheen = |smooth| Grid::of(vec![0.2, 0.5, 0.9], vec![smooth, 0.5]);
    let lut = part(lobe);
    // From a roughness of 1e-5 on the reference is as sharp as for any lobe.
    let certified = certify(&task(&lut, &sheen(1e-10), Precision::F16), None).unwrap();
    assert_eq!(certified.certificate.undecided, 0);
    let grid = sheen(0.9e-10);
    let certified = certify(&task(&lut, &grid, Precision::F16), None).unwrap();
    let promise = &certified.certificate.promise;
    assert!(
        (1..=3).contains(&certified.certificate.undecided) && promise.contains("2.0e-6"),
        "{promise}"
    );
}

#[test]
fn distances_to_boundaries_are_those_of_rounding() {
    for precision in [Precision::F16, Precision::F32, Precision::Unorm16, Precision::Unorm8] {
        let mut random = common::Random(7);
        for i in 0..20_000 {
            // Some just above a power of two, where the boundary below belongs to finer steps.
            let power = 2f64.powi(-(i % 12));
            let value = if i % 3 == 0 {
                0.999f64.min(power * (1.0 + 1e-4 * random.next()))
            } else {
                0.999 * random.next()
            };
            let distance = precision.distance_to_boundary(value);
            let at = |d: f64| precision.nearest(value + d);
            let near = 0.999 * distance;
            assert!(
                at(near) == at(0.0) && at(-near) == at(0.0),
                "{precision:?}: {value} is nearer than {distance:e}"
            );
            let far = 1.001 * distance + 1e-17;
            assert!(
                at(far) != at(0.0) || at(-far) != at(0.0),
                "{precision:?}: {value} is farther than {distance:e}"
            );
        }
    }
}

#[test]
fn stages_report_a_bound_for_every_decade_of_b() {
    let lobe = ggx(Masking::HeightCorrelated);
    let (lut, grid) = (part(lobe), grid("nov", "roughness", 96));
    for stage in certify(&task(&lut, &grid, Precision::F16), None).unwrap().stages {
        let bound = stage.error.unwrap();
        // The sharper bound takes over where it is below the general one.
        let falls =
            bound.by_decade.windows(2).all(|pair| pair[1] < pair[0] || pair == [bound.largest; 2]);
        assert!(falls && bound.by_decade[6] < 0.1 * bound.largest, "{stage:?}");
    }
}

#[test]
fn a_certificate_stands_in_the_file_and_is_the_same_for_the_same_request() {
    let request =
        Request::with_default_axes(ab(ggx(Masking::HeightCorrelated)), (16, 8), Precision::F16)
            .unwrap();
    let baked = || splitsum::bake(&request, &Backend::cpu()).unwrap();
    let (one, other) = (baked(), baked());
    assert_eq!(one.table, other.table);
    let texels = (0..8).flat_map(|j| (0..16).map(move |i| (i, j)));
    let values = texels.flat_map(|(i, j)| one.table.texel(0, i, j));
    let bytes = values.flat_map(|value| splitsum::numeric::half::round(value).to_le_bytes());
    let hash = blake3::hash(&bytes.collect::<Vec<u8>>()).to_hex().to_string();
    assert_eq!(one.reports[0].claim.certificate().unwrap().blake3, hash);
    assert_eq!(one.table.claim(0), &one.reports[0].claim);
}

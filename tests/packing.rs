//! Channels of several lobes in one texel: each is what its own table holds, scaled and rounded
//! once, with a certificate of its own.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::ggx;
use splitsum::backend::Backend;
use splitsum::backend::cpu;
use splitsum::brdf::{Diffuse, Fresnel, Masking, Microfacet, Ndf};
use splitsum::error::Result;
use splitsum::integrate::rules::REFERENCE;
use splitsum::lut::{Lut, Packing, terms};
use splitsum::request::Request;
use splitsum::table::Table;
use splitsum::table::precision::Precision;

const SIZE: (usize, usize) = (9, 7);

fn packing(words: &str, fresnel: Fresnel) -> Result<Packing> {
    terms::packing(ggx(Masking::HeightCorrelated), fresnel, words)
}

fn baked(words: &str, precision: Precision) -> Table {
    let packing = packing(words, Fresnel::Schlick).unwrap();
    let request = Request::with_default_axes(packing, SIZE, precision).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

/// The truth of a term at (n·v, roughness): by the reference, and closed forms.
fn truth(term: &str, mu: f64, r: f64) -> f64 {
    let of = |lobe: Microfacet| cpu::bake_points(lobe, &[(mu, r * r)], &REFERENCE).scale_bias()[0];
    let own = ggx(Masking::HeightCorrelated);
    match term {
        "a" => of(own).a,
        "b" => of(own).b,
        "e" => of(own).e(),
        "1-e" => 1.0 - of(own).e(),
        "e*-2+0.5" => 0.5 - 2.0 * of(own).e(),
        "charlie" => of(Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt }).e(),
        "ggx/separable" => of(ggx(Masking::Separable)).e(),
        "burley*0.9655212-0.5" => 0.9655212 * Diffuse::Burley.albedo(mu, r) - 0.5,
        "roughness" => r,
        "nov-0.25" => mu - 0.25,
        number => number.parse().unwrap(),
    }
}

#[test]
fn every_channel_is_its_integral_rounded_once() {
    for words in [
        "b,e,charlie",
        "1-e,burley*0.9655212-0.5,roughness,1",
        "e,e,ggx/separable,nov-0.25",
        "e*-2+0.5,a,0.5",
    ] {
        for precision in [Precision::F16, Precision::F32] {
            let table = baked(words, precision);
            for (channel, term) in words.split(',').enumerate() {
                for (i, j) in (0..SIZE.1).flat_map(|j| (0..SIZE.0).map(move |i| (i, j))) {
                    let (mu, r) = (table.x().value(i), table.y().value(j));
                    let truth = truth(term, mu, r);
                    let stored = table.value(0, i, j, channel);
                    // f32 of so few values is rounded correctly but where the reference leaves a
                    // doubt: its steps are finer than the reference of small values.
                    let slack = if precision == Precision::F32 { 1e-11 } else { 0.0 };
                    let nearest = precision.nearest(truth);
                    assert!((stored - nearest).abs() <= slack, "{term} at {mu}, {r}: {stored}");
                }
            }
        }
    }
}

#[test]
fn each_lobe_has_its_own_certificate_and_the_hash_is_of_all() {
    let table = baked("b,charlie,burley,1", Precision::F16);
    let parts = table.parts(0);
    let channels: Vec<&[usize]> = parts.iter().map(|part| &part.channels[..]).collect();
    assert_eq!(channels, [&[0][..], &[1], &[2]]);
    let models: Vec<&str> = parts.iter().map(|part| part.provenance.model).collect();
    assert_eq!(models, ["ggx", "charlie", "burley"]);
    let hash = blake3::hash(table.bytes(0)).to_string();
    for part in parts {
        assert_eq!(part.claim.certificate().unwrap().blake3, hash);
    }
}

#[test]
fn a_list_that_is_a_table_is_that_table() {
    for (words, name) in [("a,b", "ab"), ("b,e", "be"), ("e", "e")] {
        let packing = packing(words, Fresnel::Schlick).unwrap();
        assert!(packing.flags().ends_with(&format!("--channels {name}")), "{}", packing.flags());
    }
    let three = packing("a,b,c", Fresnel::SchlickF82).unwrap();
    assert!(matches!(three.main(), Lut::Dfg(dfg) if dfg.word() == "abc"));
}

#[test]
fn an_estimate_beyond_what_a_channel_can_be_is_stored_at_that_end() {
    // 1 - E of smooth rows is 0 to within the rules' errors, on either side of it.
    for precision in [Precision::Unorm8, Precision::Rgbd8, Precision::F32] {
        let packing = packing("1-e,e,charlie*0.01", Fresnel::Schlick).unwrap();
        let (x, y) = ("nov,edges".parse().unwrap(), "roughness,edges".parse().unwrap());
        let axis = |spec| splitsum::table::axis::Axis::new(spec, 33).unwrap();
        let accuracy = splitsum::request::Accuracy::by_default(&packing, precision);
        let request = Request::new(packing.clone(), axis(x), axis(y), accuracy, precision);
        let table = splitsum::bake(&request.unwrap(), &Backend::cpu()).unwrap().table;
        assert!(table.plane(0, 0).iter().all(|value| *value >= 0.0), "{precision}");
        // The same by a rule that errs by 1e-2.
        let rough = splitsum::request::Accuracy::Tolerance(6e-2);
        let request = Request::new(packing, axis(x), axis(y), rough, precision).unwrap();
        assert!(splitsum::bake(&request, &Backend::cpu()).is_ok(), "{precision}");
    }
}

#[test]
fn two_maskings_of_one_lobe_have_two_names() {
    let packing = packing("charlie,charlie/height-correlated", Fresnel::Schlick).unwrap();
    let names: Vec<String> = packing.channels().into_iter().map(|channel| channel.name).collect();
    assert_eq!(names, ["E", "E_charlie_height-correlated"]);
}

#[test]
fn wrong_lists_are_refused() {
    for words in [
        "",
        "x",
        "a,,b",
        "a b",
        "c",
        "a,b,e,1,1",
        "0,1",
        "roughness",
        "e*0",
        "e*nan",
        "e*inf",
        "e+inf",
        "e*",
        "e+",
        "e-",
        "charlie/separable",
        "charlie/x",
        "nan",
        "e*2*3",
        "1-e*2",
        "e*1e-50",
    ] {
        assert!(packing(words, Fresnel::Schlick).is_err(), "'{words}' was taken");
    }
}

#[test]
fn what_does_not_fit_its_storage_is_an_error_and_names_the_channel() {
    for (words, precision, channel) in [
        ("b,e,charlie", Precision::Unorm16, "E_charlie"),
        ("e,burley-0.9", Precision::Unorm8, "E_burley - 0.9"),
        ("e,1.5", Precision::A2b10g10r10, "1.5"),
        ("e,-0.01", Precision::Srgb8, "-0.01"),
        ("e*300", Precision::Rgbd8, "300 E"),
        ("e,1e6", Precision::F16, "1000000"),
    ] {
        let request = packing(words, Fresnel::Schlick)
            .and_then(|packing| Request::with_default_axes(packing, SIZE, precision))
            .unwrap();
        let error = splitsum::bake(&request, &Backend::cpu()).unwrap_err().to_string();
        assert!(error.contains(&format!("channel {channel} at")), "{error}");
    }
    // A fourth of 2 bits, or beside a divisor.
    for (words, precision) in [
        ("a,b,e,e", Precision::A2b10g10r10),
        ("a,b,e,0.5", Precision::Srgb8),
        ("a,b,e,1", Precision::Rgbd8),
    ] {
        let packing = packing(words, Fresnel::Schlick).unwrap();
        assert!(Request::with_default_axes(packing, SIZE, precision).is_err(), "{words}");
    }
}

#[test]
fn a_plan_says_which_rules_decide_which_channels() {
    let packing = packing("b,e,burley", Fresnel::Schlick).unwrap();
    let request = Request::with_default_axes(packing, SIZE, Precision::F16).unwrap();
    let backend = Backend::cpu();
    let plan = splitsum::Plan::new(&request, &backend).unwrap().to_string();
    assert!(
        plan.contains("certified B, E: by ") && plan.contains("E_burley: by closed-form"),
        "{plan}"
    );
}

//! The estimator of engines: their own numbers again.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Difference, ab, figures, ggx, number};
use splitsum::backend::Backend;
use splitsum::brdf::{Masking, Microfacet, Ndf};
use splitsum::integrate::hammersley::{Frame, Hammersley};
use splitsum::lut::Lut;
use splitsum::request::{Accuracy, Request};
use splitsum::table::axis::Axis;
use splitsum::table::claim::Claim;
use splitsum::table::precision::Precision;

fn request(lut: Lut, estimator: Hammersley, x: &str, y: &str) -> splitsum::Result<Request> {
    let axis = |words: &str| Axis::new(words.parse().unwrap(), 16).unwrap();
    Request::new(lut, axis(x), axis(y), Accuracy::Estimator(estimator.into()), Precision::F32)
}

#[test]
fn it_repeats_three_js_to_half_precision_and_no_other_does() {
    let rows = figures(include_str!("figures/threejs_r187_dfg_16.csv"));
    let difference = |count, frame| {
        let estimator = Hammersley { count, frame };
        let lut = ab(ggx(Masking::HeightCorrelated));
        let request = request(lut, estimator, "roughness", "nov").unwrap();
        let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
        Difference::between(rows.iter().flat_map(|row| {
            let texel = table.texel(0, row[1].parse().unwrap(), row[0].parse().unwrap());
            [(texel[0], number(row[2])), (texel[1], number(row[3]))]
        }))
    };
    // Half a step of halves between 1/2 and 1 is 2.4e-4, and they compute in f32.
    let theirs = difference(4096, Frame::Sin);
    assert!(theirs.max < 2.5e-4, "{theirs:?}");
    for (count, frame) in [(4096, Frame::Cos), (2048, Frame::Sin), (1024, Frame::Cos)] {
        assert!(difference(count, frame).max > 1e-3, "{count} {frame}");
    }
}

#[test]
fn its_table_is_not_certified_and_says_how_far_it_is_off() {
    let estimator: Hammersley = "hammersley,n=64,frame=cos".parse().unwrap();
    let request = request(ab(ggx(Masking::Separable)), estimator, "nov", "roughness").unwrap();
    assert!(request.to_string().ends_with("--estimator hammersley,n=64,frame=cos"), "{request}");
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    let Claim::Estimated { estimator, measured_error: (error, points) } = table.claim(0) else {
        unreachable!("{:?}", table.claim(0))
    };
    assert_eq!((estimator.as_str(), *points), ("hammersley,n=64,frame=cos", 128));
    assert!(*error > 1e-3, "{error}");
}

#[test]
fn more_points_come_nearer() {
    let error = |count| {
        let estimator = Hammersley { count, frame: Frame::Cos };
        let request =
            request(ab(ggx(Masking::HeightCorrelated)), estimator, "nov", "roughness").unwrap();
        let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
        let Claim::Estimated { measured_error, .. } = table.claim(0) else { unreachable!() };
        measured_error.0
    };
    let errors: Vec<f64> = [64, 1024, 16384].map(error).to_vec();
    assert!(errors.is_sorted_by(|a, b| *a > 3.0 * b), "{errors:?}");
}

#[test]
fn what_it_does_not_serve_for_is_refused() {
    for words in [
        "",
        "hammersley",
        "hammersley,n=0,frame=cos",
        "hammersley,n=2000000,frame=cos",
        "hammersley,n=8,frame=tan",
        "hammersley,n=8",
        "sobol,n=8,frame=cos",
        "hammersley,n=8,frame=cos,x",
    ] {
        assert!(words.parse::<Hammersley>().is_err(), "{words}");
    }
    let estimator = Hammersley { count: 8, frame: Frame::Cos };
    let charlie = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };
    assert!(request(ab(charlie), estimator, "nov", "roughness").is_err());
    let smith = ab(ggx(Masking::HeightCorrelated));
    assert!(request(smith, estimator, "nov,edges", "roughness").is_err());
    let lambert = Lut::Diffuse(splitsum::brdf::Diffuse::Lambert);
    assert!(request(lambert, estimator, "nov", "roughness").is_err());
}

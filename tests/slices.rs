//! Tables of three axes: each slice is the table of its F0, and an OpenEXR file has it as a layer.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use common::ggx;
use exr::prelude::{ReadChannels, ReadLayers, read};
use program::{ok, run, stderr};
use splitsum::brdf::Masking;
use splitsum::lut::energy::{Energy, EnergyChannels};
use splitsum::table::axis::{Axis, Parameter};
use splitsum::table::claim::Claim;
use splitsum::units::F0;
use splitsum::{Backend, Lut, Precision, Request, Slices};
use tempfile::tempdir;

const LAYERS: &str = "bake --backend cpu -q --lut energy -o split.exr";

fn energy(f0: f64) -> Lut {
    let lobe = ggx(Masking::HeightCorrelated);
    Lut::Energy(Energy::new(lobe, F0::new(f0).unwrap(), EnergyChannels::Split).unwrap())
}

/// One layer: its name and R, G, B of each texel.
type LayerRead = (String, Vec<[f32; 3]>);

fn layers(file: &std::path::Path) -> Vec<LayerRead> {
    let image = read().no_deep_data().largest_resolution_level().all_channels().all_layers();
    let image = image.all_attributes().from_file(file).unwrap();
    let layer = |layer: &exr::prelude::Layer<exr::prelude::AnyChannels<_>>| {
        let channels: Vec<Vec<f32>> = layer
            .channel_data
            .list
            .iter()
            .map(|channel: &exr::prelude::AnyChannel<exr::prelude::FlatSamples>| {
                channel.sample_data.values_as_f32().collect()
            })
            .collect();
        // The file has them by name: B, G, R.
        let texels = (0..channels[0].len()).map(|i| [2, 1, 0].map(|c| channels[c][i])).collect();
        (layer.attributes.layer_name.as_ref().unwrap().to_string(), texels)
    };
    image.layer_data.iter().map(layer).collect()
}

#[test]
fn each_layer_of_a_file_is_the_table_of_its_f0() {
    let folder = tempdir().unwrap();
    for (slices, f0s) in [
        ("--size 8 --f0 0.04,0.5", vec![0.04, 0.5]),
        ("--z f0,sqrt --size 8x8x2", vec![0.0625, 0.5625]),
    ] {
        ok(&folder, &format!("{LAYERS} {slices}"));
        let layers = layers(&folder.path().join("split.exr"));
        assert_eq!(layers.len(), f0s.len());
        for ((name, texels), f0) in layers.iter().zip(f0s) {
            assert_eq!(*name, format!("F0 = {f0}"));
            let request = Request::with_default_axes(energy(f0), (8, 8), Precision::F16).unwrap();
            let alone = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
            for (i, texel) in texels.iter().enumerate() {
                let expected = alone.texel(0, i % 8, i / 8);
                assert_eq!(texel.map(f64::from)[..], expected[..], "{name}, texel {i}");
            }
        }
    }
}

#[test]
fn a_slice_has_a_claim_of_its_own() {
    let axis = Axis::new("f0,edges".parse().unwrap(), 2).unwrap();
    // F0 = 1 leaves nothing for a diffuse base: the whole request is refused.
    let request = Request::with_default_axes(energy(0.5), (4, 4), Precision::F16).unwrap();
    assert!(request.clone().with_slices(Slices::along(&axis).unwrap()).is_err());
    let slices = Slices::at_f0s(&[0.02, 0.5].map(|f0| F0::new(f0).unwrap())).unwrap();
    let request = request.with_slices(slices).unwrap();
    assert_eq!((request.texels(), request.bytes()), (32, 32 * 3 * 2));
    let table = splitsum::bake(&request, &Backend::cpu()).unwrap().table;
    let (parameter, _) = table.layout().slices.as_ref().unwrap().parameter().unwrap();
    assert_eq!(parameter, Parameter::F0);
    for (slice, f0) in [0.02, 0.5].into_iter().enumerate() {
        assert_eq!(table.parts(slice)[0].provenance.f0, Some(f0));
        let Claim::Certificate(certificate) = table.claim(slice) else { panic!("no certificate") };
        let hash = blake3::hash(table.bytes(slice)).to_string();
        assert_eq!(certificate.blake3, hash);
        assert_ne!(table.bytes(slice), table.bytes(1 - slice));
    }
}

#[test]
fn a_sample_speaks_for_the_slices_of_its_rule_and_keeps_their_bound() {
    let folder = tempdir().unwrap();
    // n = 1.01 has the bound of a layer of its own; the others are told apart by nothing. Four
    // points are corners.
    let iors: Vec<String> = (0..40).map(|i| (1.4 + 0.01 * f64::from(i)).to_string()).collect();
    let bake = "bake --backend cpu --lut glass --size 8 --precision f32 --rule g560 -o g.exr";
    let text = ok(&folder, &format!("{bake} --json --ior 1.01,{}", iors.join(","))).stdout;
    let reports: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let reports = reports["tables"].as_array().unwrap();
    assert_eq!(reports.len(), 41);
    let of = |report: &serde_json::Value| {
        let claim = &report["uncertified"];
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let measured = &claim["measured_error"];
        let of_checks = &report["checks"]["measured"];
        assert_eq!(measured[1], of_checks["points"]);
        (number(&measured[0]), number(&measured[1]), number(&claim["error_bound"]))
    };
    let [layer, first, last] = [0, 1, 40].map(|i| of(&reports[i]));
    for (error, points, bound) in [layer, first, last] {
        assert!(error > 0.0 && error <= bound && points > 4.0, "{error} {points} {bound}");
    }
    assert!(layer.2 > 10.0 * first.2 && first == last && layer.1 < first.1);
}

#[test]
fn slices_that_no_table_or_file_has_are_refused() {
    let folder = tempdir().unwrap();
    for (arguments, said) in [
        ("bake --z f0 --size 4x4x2 -o a.exr", "bake the split of energy"),
        ("bake --lut energy --z nov --size 4x4x2 -o a.exr", "lay n.v and roughness along x and y"),
        ("bake --lut energy --z f0 --size 4 -o a.exr", "slices"),
        ("bake --lut energy --channels turquin --z f0 --size 4x4x2 -o a.exr", "bake the split"),
        ("bake --lut energy --z f0 --size 4x4x65 -o a.exr", "1 to 64 slices, got 65"),
        ("bake --lut energy --size 4x4x2 -o a.exr", "add a z axis"),
        ("bake --lut energy --x f0 -o a.exr", "x = f0"),
        ("bake --lut energy --z f0 --size 4x4x2 -o a.png", "one slice"),
    ] {
        let output = run(&folder, arguments);
        assert_eq!(output.status.code(), Some(4), "{arguments}: {}", stderr(&output));
        assert!(stderr(&output).contains(said), "{arguments}: {}", stderr(&output));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert!(Slices::at_f0s(&[F0::new(0.04).unwrap()]).is_err());
}

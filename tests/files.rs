//! Files read back by other people's readers, and what the metadata in them says.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::ggx;
use exr::meta::attribute::AttributeValue;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text, read};
use splitsum::backend::Backend;
use splitsum::encode::{Format, encode};
use splitsum::lut::{Dfg, DfgChannels, Energy, EnergyChannels, Lut};
use splitsum::model::Masking;
use splitsum::precision::Precision;
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::units::F0;
use splitsum::{bake, half};
use std::io::Cursor;

fn table(channels: DfgChannels, precision: Precision) -> Table {
    let lut = Lut::Dfg(Dfg { lobe: ggx(Masking::HeightCorrelated), channels });
    let request = Request::with_default_axes(lut, (12, 5), precision).unwrap();
    bake(&request, &Backend::cpu(), &|_| ()).unwrap().table
}

/// Size, (name, values) of each channel, and the metadata of an EXR file.
fn read_exr(bytes: &[u8]) -> ((usize, usize), Vec<(String, FlatSamples)>, serde_json::Value) {
    let reader = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
    let layer = reader.from_buffered(Cursor::new(bytes)).unwrap().layer_data;
    let AttributeValue::Text(text) = &layer.attributes.other[&Text::from("splitsum")] else { panic!("no text") };
    assert_eq!(layer.attributes.other.len(), 1, "two custom attributes would make the bytes vary");
    let channels = layer.channel_data.list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data));
    (layer.size.into(), channels.collect(), serde_json::from_str(&text.to_string()).unwrap())
}

#[test]
fn exr_halves_are_the_correctly_rounded_values_row_by_row() {
    let table = table(DfgChannels::Ab, Precision::F16);
    let (size, channels, _) = read_exr(&encode(std::slice::from_ref(&table), Format::Exr, Precision::F16).unwrap());
    assert_eq!(size, (12, 5));
    let names: Vec<_> = channels.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["B", "G", "R"]);
    let plane = |letter: &str| match &channels.iter().find(|(name, _)| name == letter).unwrap().1 {
        FlatSamples::F16(values) => values.iter().map(|value| value.to_bits()).collect::<Vec<u16>>(),
        other => panic!("{other:?}"),
    };
    let (red, green, blue) = (plane("R"), plane("G"), plane("B"));
    for j in 0..5 {
        for i in 0..12 {
            let texel = table.texel(i, j);
            assert_eq!((red[12 * j + i], green[12 * j + i]), (half::round(texel[0]), half::round(texel[1])));
            assert_eq!(blue[12 * j + i], 0);
        }
    }
}

#[test]
fn exr_floats_are_on_request() {
    let table = table(DfgChannels::Be, Precision::F32);
    let (_, channels, metadata) = read_exr(&encode(std::slice::from_ref(&table), Format::Exr, Precision::F32).unwrap());
    let FlatSamples::F32(red) = &channels[2].1 else { panic!("not f32") };
    assert_eq!(red[7], table.values[14] as f32);
    assert_eq!(metadata["stored"], "f32");
    assert_eq!(metadata["channels"][1], "G = E (directional albedo at F = 1: E = A + B)");
}

#[test]
fn metadata_names_every_convention() {
    let table = table(DfgChannels::E, Precision::F16);
    let (.., metadata) = read_exr(&encode(std::slice::from_ref(&table), Format::Exr, Precision::F16).unwrap());
    assert_eq!(metadata["tool"], concat!("splitsum ", env!("CARGO_PKG_VERSION")));
    assert_eq!((&metadata["model"], &metadata["masking"]), (&"ggx".into(), &"height-correlated".into()));
    assert_eq!(metadata["roughness"], "alpha = roughness^2");
    assert_eq!(metadata["x"]["texel"], "nov = t, t = clamp((i + 0.5)/12, 0, 1)");
    assert_eq!(metadata["y"]["parameter"], "roughness");
    assert_eq!(metadata["channels"][1], "G = 0 (unused)");
    let certificate = &metadata["certificate"];
    assert_eq!((&certificate["texels"], &certificate["undecided"]), (&60.into(), &0.into()));
    assert_eq!(certificate["bound"].as_f64().unwrap(), Precision::F16.half_step());
    assert_eq!(certificate["blake3"], table.hash(Precision::F16).unwrap());
    assert!(certificate["promise"].as_str().unwrap().contains("rounded once"));
    assert!(metadata.get("computed_by").is_none(), "the same file, whoever computed it");
    assert!(metadata["command"].as_str().unwrap().starts_with("splitsum bake --lut dfg --model ggx"));
}

#[test]
fn a_table_that_is_not_certified_says_so_and_what_is_known_instead() {
    let lut = Lut::Dfg(Dfg { lobe: ggx(Masking::HeightCorrelated), channels: DfgChannels::Ab });
    let axes = Request::with_default_axes(lut, (12, 5), Precision::F16).unwrap();
    let uncertified = Accuracy::uncertified(&lut, Precision::F16);
    let request = Request::new(lut, axes.x, axes.y, uncertified, Precision::F16).unwrap();
    let table = bake(&request, &Backend::cpu(), &|_| ()).unwrap().table;
    let (.., metadata) = read_exr(&encode(std::slice::from_ref(&table), Format::Exr, Precision::F16).unwrap());
    assert!(metadata.get("certificate").is_none());
    let known = &metadata["uncertified"];
    assert_eq!(known["computed_by"], "CPU, f64");
    assert!(known["error_bound"].as_f64().unwrap() <= Precision::F16.default_tolerance());
    assert!(known["measured_error"][0].as_f64().unwrap() <= known["error_bound"].as_f64().unwrap());
    assert!(metadata["command"].as_str().unwrap().contains("--certify off"));
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    for (format, precision) in [(Format::Exr, Precision::F16), (Format::Png, Precision::Unorm16)] {
        let bytes = || encode(&[table(DfgChannels::Ab, precision)], format, precision).unwrap();
        assert!((0..8).all(|_| bytes() == bytes()));
    }
}

#[test]
fn png_holds_unorms() {
    let table = table(DfgChannels::Ab, Precision::Unorm16);
    let bytes = encode(std::slice::from_ref(&table), Format::Png, Precision::Unorm16).unwrap();
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    assert_eq!((info.width, info.height, info.bit_depth), (12, 5, png::BitDepth::Sixteen));
    let sample = |i: usize| f64::from(u16::from_be_bytes([data[2 * i], data[2 * i + 1]]));
    for (i, texel) in table.values.chunks(2).enumerate() {
        assert_eq!(sample(3 * i), (65535.0 * texel[0]).round());
        assert_eq!((sample(3 * i + 1), sample(3 * i + 2)), ((65535.0 * texel[1]).round(), 0.0));
    }
}

#[test]
fn several_f0_are_layers_of_one_exr() {
    let table = |f0| {
        let channels = EnergyChannels::Split;
        let energy = Energy::new(ggx(Masking::HeightCorrelated), F0::new(f0).unwrap(), channels).unwrap();
        let request = Request::with_default_axes(Lut::Energy(energy), (4, 3), Precision::F32).unwrap();
        bake(&request, &Backend::cpu(), &|_| ()).unwrap().table
    };
    let tables = [table(0.5), table(0.02)];
    let bytes = encode(&tables, Format::Exr, Precision::F32).unwrap();
    let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers().all_attributes();
    let image = reader.from_buffered(Cursor::new(bytes)).unwrap();
    let names: Vec<_> = image.layer_data.iter().map(|l| l.attributes.layer_name.clone().unwrap().to_string()).collect();
    assert_eq!(names, ["F0 = 0.5", "F0 = 0.02"]);
    for (layer, table) in image.layer_data.iter().zip(&tables) {
        let FlatSamples::F32(green) = &layer.channel_data.list[1].sample_data else { panic!("not f32") };
        let expected: Vec<f32> = table.values.chunks(3).map(|texel| texel[1] as f32).collect();
        assert_eq!(*green, expected);
    }
    assert!(encode(&tables, Format::Png, Precision::Unorm16).is_err());
}

#[test]
fn values_that_a_precision_cannot_hold_are_refused() {
    let mut table = table(DfgChannels::Ab, Precision::F16);
    for bad in [f64::NAN, f64::INFINITY, 1e6] {
        table.values[3] = bad;
        assert!(encode(std::slice::from_ref(&table), Format::Exr, Precision::F16).is_err(), "{bad} was stored");
    }
    table.values[3] = 1.1;
    assert!(encode(std::slice::from_ref(&table), Format::Exr, Precision::F16).is_ok());
    assert!(encode(std::slice::from_ref(&table), Format::Png, Precision::Unorm8).is_err());
    // Within the table's own error of 1, 1 is meant.
    table.values[3] = 1.0 + 0.5 * table.provenance.worth.error_bound();
    assert!(encode(std::slice::from_ref(&table), Format::Png, Precision::Unorm8).is_ok());
}

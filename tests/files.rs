//! Files read back by other people's readers, and what the metadata in them says.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{ab, ggx};
use exr::meta::attribute::AttributeValue;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, Text, read};
use splitsum::backend::Backend;
use splitsum::bake;
use splitsum::brdf::{Fresnel, Masking};
use splitsum::error::Result;
use splitsum::format::metadata::metadata;
use splitsum::format::texels::Texels;
use splitsum::format::{Encoding, Format, encode};
use splitsum::lut::sheet::Sheet;
use splitsum::lut::{Dfg, DfgChannels, Energy, EnergyChannels, Lut, Packing};
use splitsum::numeric::half;
use splitsum::request::{Accuracy, Request};
use splitsum::table::Table;
use splitsum::table::grid::Grid;
use splitsum::table::packed::Packed;
use splitsum::table::precision::Precision;
use splitsum::table::slices::Slices;
use splitsum::units::F0;
use std::io::Cursor;

fn dfg(channels: DfgChannels) -> Lut {
    Lut::Dfg(Dfg::new(ggx(Masking::HeightCorrelated), Fresnel::Schlick, channels).unwrap())
}

fn table(channels: DfgChannels, precision: Precision) -> Table {
    let request = Request::with_default_axes(dfg(channels), (12, 5), precision).unwrap();
    bake(&request, &Backend::cpu()).unwrap().table
}

/// A table as the bytes of a file with this extension.
fn encoded(table: &Table, extension: &str) -> Result<Vec<u8>> {
    encode(table, Format::named(extension)?)
}

/// The texels of a table in a file with this extension.
fn texels<'a>(table: &'a Table, extension: &str) -> Texels<'a> {
    Texels::new(table, Encoding::of(table, Format::named(extension).unwrap()).unwrap())
}

/// Size, (name, values) of each channel, and the metadata of an EXR file.
fn read_exr(bytes: &[u8]) -> ((usize, usize), Vec<(String, FlatSamples)>, serde_json::Value) {
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes();
    let layer = reader.from_buffered(Cursor::new(bytes)).unwrap().layer_data;
    let AttributeValue::Text(text) = &layer.attributes.other[&Text::from("splitsum")] else {
        panic!("no text")
    };
    assert_eq!(layer.attributes.other.len(), 1, "two custom attributes would make the bytes vary");
    let channels = layer
        .channel_data
        .list
        .into_iter()
        .map(|channel| (channel.name.to_string(), channel.sample_data));
    (layer.size.into(), channels.collect(), serde_json::from_str(&text.to_string()).unwrap())
}

#[test]
fn exr_halves_are_the_correctly_rounded_values_row_by_row() {
    let table = table(DfgChannels::All, Precision::F16);
    let (size, channels, _) = read_exr(&encoded(&table, "exr").unwrap());
    assert_eq!(size, (12, 5));
    let names: Vec<_> = channels.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["B", "G", "R"]);
    let plane = |letter: &str| match &channels.iter().find(|(name, _)| name == letter).unwrap().1 {
        FlatSamples::F16(values) => {
            values.iter().map(|value| value.to_bits()).collect::<Vec<u16>>()
        }
        other => panic!("{other:?}"),
    };
    let (red, green, blue) = (plane("R"), plane("G"), plane("B"));
    for j in 0..5 {
        for i in 0..12 {
            let texel = table.texel(0, i, j);
            assert_eq!(
                (red[12 * j + i], green[12 * j + i]),
                (half::round(texel[0]), half::round(texel[1]))
            );
            assert_eq!(blue[12 * j + i], 0);
        }
    }
}

#[test]
fn exr_floats_are_on_request() {
    let table = table(DfgChannels::Be, Precision::F32);
    let (_, channels, metadata) = read_exr(&encoded(&table, "exr").unwrap());
    let FlatSamples::F32(red) = &channels[2].1 else { panic!("not f32") };
    assert_eq!(red[7], table.value(0, 7, 0, 0) as f32);
    assert_eq!(metadata["stored"], "f32");
    assert_eq!(metadata["channels"][1], "G = E (directional albedo at F = 1: E = A + B)");
}

#[test]
fn metadata_names_every_convention() {
    let table = table(DfgChannels::E, Precision::F16);
    let (.., metadata) = read_exr(&encoded(&table, "exr").unwrap());
    assert_eq!(metadata["tool"], concat!("splitsum ", env!("CARGO_PKG_VERSION")));
    assert_eq!(
        (&metadata["model"], &metadata["masking"]),
        (&"ggx".into(), &"height-correlated".into())
    );
    assert_eq!(metadata["roughness"], "alpha = roughness^2");
    assert_eq!(metadata["x"]["texel"], "nov = t, t = clamp((i + 0.5)/12, 0, 1)");
    assert_eq!(metadata["y"]["parameter"], "roughness");
    assert_eq!(metadata["channels"][1], "G = 0 (unused)");
    let certificate = &metadata["certificate"];
    assert_eq!((&certificate["texels"], &certificate["undecided"]), (&60.into(), &0.into()));
    assert_eq!(certificate["bound"].as_f64().unwrap(), Precision::F16.half_step());
    assert_eq!(certificate["blake3"], blake3::hash(table.bytes(0)).to_hex().as_str());
    assert!(certificate["promise"].as_str().unwrap().contains("rounded once"));
    assert!(metadata.get("computed_by").is_none(), "the same file, whoever computed it");
    assert!(
        metadata["command"].as_str().unwrap().starts_with("splitsum bake --lut dfg --model ggx")
    );
}

#[test]
fn a_table_that_is_not_certified_says_so_and_what_is_known_instead() {
    let lut = ab(ggx(Masking::HeightCorrelated));
    let axes = table(DfgChannels::All, Precision::F16);
    let uncertified = Accuracy::uncertified(&lut.into(), Precision::F16);
    let request = Request::new(lut, *axes.x(), *axes.y(), uncertified, Precision::F16).unwrap();
    let table = bake(&request, &Backend::cpu()).unwrap().table;
    let (.., metadata) = read_exr(&encoded(&table, "exr").unwrap());
    assert!(metadata.get("certificate").is_none());
    let known = &metadata["uncertified"];
    assert_eq!(known["computed_by"], "CPU, f64");
    assert!(known["error_bound"].as_f64().unwrap() <= Precision::F16.default_tolerance());
    assert!(known["measured_error"][0].as_f64().unwrap() <= known["error_bound"].as_f64().unwrap());
    assert!(metadata["command"].as_str().unwrap().contains("--certify off"));
}

#[test]
fn metadata_tell_what_rounding_may_cost() {
    // Half a step of each storage, where values are between 1/2 and 1.
    for (precision, format, half_step) in [
        (Precision::F16, "exr", 2f64.powi(-12)),
        (Precision::F32, "exr", 2f64.powi(-25)),
        (Precision::Unorm16, "png", 0.5 / 65535.0),
        (Precision::Unorm8, "png", 0.5 / 255.0),
    ] {
        let table = table(DfgChannels::All, precision);
        assert_eq!(table.precision(), precision);
        let metadata: serde_json::Value =
            serde_json::from_str(&metadata(&texels(&table, format), 0).unwrap()).unwrap();
        assert_eq!(metadata["rounding_error"].as_f64().unwrap(), half_step, "{precision:?}");
        assert!(encoded(&table, format).is_ok());
    }
}

#[test]
fn the_same_table_gives_the_same_bytes() {
    for (format, precision) in [("exr", Precision::F16), ("png", Precision::Unorm16)] {
        let bytes = || encoded(&table(DfgChannels::All, precision), format).unwrap();
        assert!((0..8).all(|_| bytes() == bytes()));
    }
}

#[test]
fn png_holds_unorms() {
    let table = table(DfgChannels::All, Precision::Unorm16);
    let bytes = encoded(&table, "png").unwrap();
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut data).unwrap();
    assert_eq!((info.width, info.height, info.bit_depth), (12, 5, png::BitDepth::Sixteen));
    let sample = |i: usize| f64::from(u16::from_be_bytes([data[2 * i], data[2 * i + 1]]));
    for i in 0..60 {
        let texel = table.texel(0, i % 12, i / 12);
        assert_eq!(sample(3 * i), (65535.0 * texel[0]).round());
        assert_eq!((sample(3 * i + 1), sample(3 * i + 2)), ((65535.0 * texel[1]).round(), 0.0));
    }
}

#[test]
fn several_f0_are_layers_of_one_exr() {
    let f0 = |f0| F0::new(f0).unwrap();
    let request = |f0, precision| {
        let energy =
            Energy::new(ggx(Masking::HeightCorrelated), f0, EnergyChannels::Split).unwrap();
        Request::with_default_axes(Lut::Energy(energy), (4, 3), precision).unwrap()
    };
    let bake = |request: Request| bake(&request, &Backend::cpu()).unwrap().table;
    let tables = [0.5, 0.02].map(|value| bake(request(f0(value), Precision::F32)));
    let sliced = |f0s: &[F0], precision| {
        let slices = Slices::at_f0s(f0s).unwrap();
        bake(request(f0s[0], precision).with_slices(slices).unwrap())
    };
    let bytes = encoded(&sliced(&[f0(0.5), f0(0.02)], Precision::F32), "exr").unwrap();
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes();
    let image = reader.from_buffered(Cursor::new(bytes)).unwrap();
    let names: Vec<_> = image
        .layer_data
        .iter()
        .map(|l| l.attributes.layer_name.clone().unwrap().to_string())
        .collect();
    assert_eq!(names, ["F0 = 0.5", "F0 = 0.02"]);
    for (layer, table) in image.layer_data.iter().zip(&tables) {
        let FlatSamples::F32(green) = &layer.channel_data.list[1].sample_data else {
            panic!("not f32")
        };
        let expected: Vec<f32> = table.plane(0, 1).into_iter().map(|value| value as f32).collect();
        assert_eq!(*green, expected);
    }
    // Two F0 at which no factor exceeds 1, for a storage of a PNG.
    let table = sliced(&[f0(0.5), f0(0.4)], Precision::Unorm16);
    let error = encoded(&table, "png").unwrap_err();
    assert!(error.to_string().contains("one slice"), "{error}");
}

/// These values as a table of one channel stores them.
fn stored(precision: Precision, values: &[f64]) -> Result<Packed> {
    let packing = Packing::from(dfg(DfgChannels::E));
    let grid = Grid::of(vec![0.5; values.len()], vec![0.25]);
    let mut packed = Packed::zeros(precision, values.len())?;
    let mut sheet = Sheet::new(&packing, &grid, precision, packed.bytes_mut());
    let part = &packing.parts()[0];
    sheet.put(part, 0, &values.iter().map(|&value| precision.stored(value)).collect::<Vec<_>>());
    sheet.finish()?;
    Ok(packed)
}

#[test]
fn values_that_a_precision_cannot_hold_are_refused() {
    for (precision, bad) in [
        (Precision::F16, [f64::NAN, f64::INFINITY, 65520.0, -1e6]),
        (Precision::F32, [f64::NAN, f64::INFINITY, 1e39, -1e39]),
        (Precision::Unorm16, [f64::NAN, f64::INFINITY, 1.00001, -0.00001]),
        (Precision::Unorm8, [f64::NAN, f64::INFINITY, 1.002, -0.002]),
    ] {
        for bad in bad {
            assert!(stored(precision, &[0.5, bad]).is_err(), "{bad} was stored as {precision:?}");
        }
    }
    // What rounds to the end of the range is the end of the range.
    for (precision, value, end) in [
        (Precision::F16, 65519.9, 65504.0),
        (Precision::Unorm16, 1.0 + 0.49 / 65535.0, 1.0),
        (Precision::Unorm8, -0.49 / 255.0, 0.0),
    ] {
        assert_eq!(stored(precision, &[value]).unwrap().get(0), end);
    }
}

#[test]
fn stored_values_read_back() {
    for precision in
        [Precision::F16, Precision::F32, Precision::F64, Precision::Unorm16, Precision::Unorm8]
    {
        let values: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 1000.0).collect();
        let stored = stored(precision, &values).unwrap();
        assert_eq!(stored.bytes().len(), values.len() * precision.bytes());
        for (got, value) in stored.iter().zip(values) {
            assert_eq!(got, precision.nearest(value), "{precision:?}");
            assert!((got - value).abs() <= precision.half_step());
        }
    }
}

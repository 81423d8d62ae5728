//! Storages and containers by what is published of them: the curve of sRGB, Babylon.js' RGBD, the
//! descriptor of KTX2, the headers of DDS and NumPy, decimals that read back.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{Random, ab, ggx};
use splitsum::backend::Backend;
use splitsum::brdf::Masking;
use splitsum::format::encoding::{Notation, Supercompress};
use splitsum::format::{Encoding, Format, Style};
use splitsum::request::Request;
use splitsum::table::precision::Precision;
use splitsum::table::{Table, rgbd, srgb};
use std::io::Cursor;

fn table(precision: Precision) -> Table {
    let lut = ab(ggx(Masking::HeightCorrelated));
    let request = Request::with_default_axes(lut, (8, 4), precision).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

fn encoded(table: &Table, extension: &str, style: Style) -> Vec<u8> {
    let format = Format::named(extension).unwrap();
    let encoding = Encoding::new(format, style, table.layout(), table.precision()).unwrap();
    let mut file = Cursor::new(Vec::new());
    encoding.write(table, &mut file).unwrap();
    file.into_inner()
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(*bytes[at..].first_chunk().unwrap())
}

#[test]
fn the_curve_of_srgb_is_the_standards_and_codes_are_the_nearest() {
    // IEC 61966-2-1: 12.92 below 0.0031308, and the ends.
    assert_eq!((srgb::value(0), srgb::value(255)), (0.0, 1.0));
    assert!((srgb::value(10) - 10.0 / 255.0 / 12.92).abs() < 1e-17);
    // Of the middle grey 18.4 %, a figure of every table of it.
    assert!((srgb::value(119) - 0.184_474_995).abs() < 1e-8, "{}", srgb::value(119));
    for code in 0..=255 {
        assert_eq!(srgb::code(srgb::value(code)), code);
        assert_eq!(Precision::Srgb8.nearest(srgb::value(code)), srgb::value(code));
    }
    let mut random = Random(1);
    for _ in 0..100_000 {
        let value = 1.2 * random.next() - 0.1;
        let distance = |code: u8| (srgb::value(code) - value).abs();
        let nearest = (0..=255).map(distance).fold(f64::INFINITY, f64::min);
        assert_eq!(distance(srgb::code(value)), nearest, "{value}");
        let held = Precision::Srgb8.holds(Precision::Srgb8.nearest(value));
        let half = Precision::Srgb8.half_step();
        assert!(held || value > 1.0 + half || value < 0.0, "{value}");
        assert!(!held || (Precision::Srgb8.nearest(value) - value).abs() <= 1.000_001 * half);
        // Short of the boundary the code is the same on both sides, and beyond it is another on
        // one.
        let inside = value.clamp(0.0, 1.0);
        let boundary = Precision::Srgb8.distance_to_boundary(inside);
        let at =
            |share: f64| [inside - share * boundary, inside + share * boundary].map(srgb::code);
        let here = srgb::code(inside);
        assert_eq!(at(0.99), [here; 2], "{inside}");
        assert!(at(1.01).iter().any(|code| *code != here), "{inside}");
    }
}

#[test]
fn rgbd_finds_what_it_stored_and_is_as_near_as_codes_are() {
    let mut random = Random(2);
    for i in 0..50_000 {
        let scale = 10f64.powf(2.4 * random.next() - if i % 2 == 0 { 2.4 } else { 0.0 });
        let mut texel = [0.0; 3].map(|_| scale * random.next());
        let wanted = texel;
        rgbd::round(&mut texel);
        // Stored as f32, they give the same codes again.
        let stored = texel.map(|value| f64::from(value as f32));
        let (codes, divisor) = rgbd::codes(&stored);
        assert_eq!((&codes, divisor), (&rgbd::codes(&texel).0, rgbd::codes(&texel).1));
        // Babylon.js' fromRGBD: (code/255)^2.2 over the divisor.
        for ((value, code), wanted) in texel.iter().zip(codes).zip(wanted) {
            let decoded = (f64::from(code) / 255.0).powf(2.2) / (f64::from(divisor) / 255.0);
            assert!((decoded - value).abs() <= 1e-12 * value.abs(), "{wanted:?}");
            // Half a step at the top of the codes, over the divisor, or over the next one below,
            // from which the largest value may have come.
            let divisor = f64::from(divisor.saturating_sub(1).max(1));
            let half = 0.5 * (1.0 - (254f64 / 255.0).powf(2.2)) * 255.0 / divisor;
            assert!((value - wanted).abs() <= 1.001 * half, "{value} for {wanted} by {divisor}");
        }
    }
}

#[test]
fn the_bound_of_rgbd_counts_what_a_large_value_costs_the_others() {
    let lobe = ggx(Masking::HeightCorrelated);
    let fresnel = splitsum::brdf::Fresnel::Schlick;
    let packing = splitsum::lut::terms::packing(lobe, fresnel, "b,e,charlie").unwrap();
    let bake = |precision| {
        let request = Request::with_default_axes(packing.clone(), (24, 24), precision).unwrap();
        splitsum::bake(&request, &Backend::cpu()).unwrap().table
    };
    let (coded, exact) = (bake(Precision::Rgbd8), bake(Precision::F32));
    let bound = coded.claim(0).certificate().unwrap().bound;
    let mut worst = 0.0f64;
    for (i, j) in (0..24).flat_map(|j| (0..24).map(move |i| (i, j))) {
        for channel in 0..3 {
            let (value, truth) = (coded.value(0, i, j, channel), exact.value(0, i, j, channel));
            if truth <= 1.0 {
                worst = worst.max((value - truth).abs());
            }
        }
    }
    assert!(worst <= bound && worst > 0.9 * bound, "{worst} of {bound}");
    assert!(bound > 1.3 * Precision::Rgbd8.half_step(), "{bound}");
}

#[test]
fn the_descriptor_of_rg16f_is_that_of_bevys_own_file() {
    let file = encoded(&table(Precision::F16), "ktx2", Style::default());
    assert_eq!(&file[..12], b"\xabKTX 20\xbb\r\n\x1a\n");
    // VK_FORMAT_R16G16_SFLOAT, 8 x 4, no depth, no layers, one face, one level, not compressed.
    let header: Vec<u32> = (0..9).map(|i| word(&file, 12 + 4 * i)).collect();
    assert_eq!(header, [83, 2, 8, 4, 0, 0, 1, 1, 0]);
    let published = "3c000000 00000000 02003800 01010100 00000000 04000000 00000000 00000fc0 \
                     00000000 000080bf 0000803f 10000fc1 00000000 000080bf 0000803f";
    let descriptor = &file[104..][..60];
    let hex: Vec<String> = descriptor
        .chunks(4)
        .map(|word| word.iter().map(|b| format!("{b:02x}")).collect())
        .collect();
    assert_eq!(hex.join(" "), published);
    // The level is the last, and begins at a multiple of its texel.
    let level = u64::from_le_bytes(*file[80..].first_chunk().unwrap()) as usize;
    assert_eq!((level % 4, file.len() - level), (0, 8 * 4 * 4));
    assert_eq!(&file[level..], encoded(&table(Precision::F16), "raw", Style::default()));
}

#[test]
fn keys_of_ktx2_are_sorted_padded_and_hold_the_metadata() {
    let file = encoded(&table(Precision::F16), "ktx2", Style::default());
    let (mut at, end) = (word(&file, 56) as usize, (word(&file, 56) + word(&file, 60)) as usize);
    let mut keys = Vec::new();
    while at < end {
        let length = word(&file, at) as usize;
        let entry = &file[at + 4..][..length];
        let (key, value) = entry.split_at(entry.iter().position(|b| *b == 0).unwrap());
        keys.push((
            String::from_utf8(key.to_vec()).unwrap(),
            value[1..length - key.len() - 1].to_vec(),
        ));
        at += (4 + length).next_multiple_of(4);
    }
    let names: Vec<&str> = keys.iter().map(|(key, _)| key.as_str()).collect();
    assert_eq!(names, ["KTXorientation", "KTXwriter", "splitsum"]);
    assert_eq!(keys[0].1, b"rd");
    let metadata: serde_json::Value = serde_json::from_slice(&keys[2].1).unwrap();
    assert_eq!(metadata["channels"][0], "R = A (scale: E(F0) = F0*A + B)");
    assert!(metadata["command"].as_str().unwrap().ends_with("--precision f16 --format ktx2"));
}

#[test]
fn headers_of_dds_and_numpy_are_as_published() {
    let file = encoded(&table(Precision::F16), "dds", Style::default());
    let words: Vec<u32> = (0..37).map(|i| word(&file, 4 * i)).collect();
    assert_eq!(&file[..4], b"DDS ");
    assert_eq!((words[1], words[2], words[3], words[4], words[5]), (124, 0x100f, 4, 8, 64));
    assert_eq!((words[19], words[20], &file[84..88]), (32, 4, &b"DX10"[..]));
    // DXGI_FORMAT_R16G16B16A16_FLOAT, Texture2D, one surface.
    assert_eq!((words[27], &words[32..]), (0x1000, &[10, 3, 0, 1, 0][..]));
    assert_eq!(file.len(), 148 + 8 * 4 * 8);
    let two = Style { components: Some(2), ..Style::default() };
    assert_eq!(word(&encoded(&table(Precision::F16), "dds", two), 128), 34);
    let file = encoded(&table(Precision::Unorm16), "npy", Style::default());
    let text = "{'descr': '<u2', 'fortran_order': False, 'shape': (4, 8, 2), }";
    assert!(file.starts_with(b"\x93NUMPY\x01\x00") && file[10..].starts_with(text.as_bytes()));
    assert_eq!((file.len() - 8 * 4 * 2 * 2) % 64, 0);
}

#[test]
fn zstandard_gives_back_the_texels() {
    let style = Style { supercompress: Supercompress::Zstd, ..Style::default() };
    let file = encoded(&table(Precision::F16), "ktx2", style);
    assert_eq!(word(&file, 44), 2);
    let number = |at: usize| u64::from_le_bytes(*file[at..].first_chunk().unwrap()) as usize;
    let level = &file[number(80)..][..number(88)];
    let mut decoder = ruzstd::decoding::StreamingDecoder::new(level).unwrap();
    let mut texels = Vec::new();
    std::io::Read::read_to_end(&mut decoder, &mut texels).unwrap();
    assert_eq!(texels.len(), number(96));
    assert_eq!(texels, encoded(&table(Precision::F16), "raw", Style::default()));
}

/// The numbers between the brackets of an array.
fn members(code: &[u8]) -> Vec<String> {
    let code = String::from_utf8(code.to_vec()).unwrap();
    let begin = code.find("= {\n").map(|at| at + 4).unwrap();
    let end = begin + code[begin..].find('}').unwrap();
    code[begin..end].split(',').map(|word| word.trim().to_owned()).collect()
}

#[test]
fn numbers_in_source_code_read_back_to_what_is_stored() {
    for precision in [Precision::F16, Precision::F32, Precision::Unorm8, Precision::Unorm16] {
        let table = table(precision);
        let values: Vec<f64> = (0..4)
            .flat_map(|j| (0..8).map(move |i| (i, j)))
            .flat_map(|(i, j)| table.texel(0, i, j))
            .collect();
        let decimals = Style { numbers: Notation::Decimals, ..Style::default() };
        for (text, value) in members(&encoded(&table, "h", decimals)).iter().zip(&values) {
            let expected = *value as f32;
            // Directly, and by way of a double as in JavaScript.
            assert_eq!(text.parse::<f32>().unwrap(), expected);
            assert_eq!(text.parse::<f64>().unwrap() as f32, expected);
        }
        let bits = Style { numbers: Notation::Bits, ..Style::default() };
        let stored = members(&encoded(&table, "h", bits));
        assert_eq!(stored.len(), values.len());
        for (text, value) in stored.iter().zip(&values) {
            let number = match text.strip_prefix("0x") {
                Some(hex) => u32::from_str_radix(hex, 16).unwrap(),
                None => text.parse().unwrap(),
            };
            let decoded = precision.read(&number.to_le_bytes());
            assert_eq!(decoded, *value, "{precision}");
        }
    }
}

#[test]
fn styles_that_a_format_does_not_follow_are_refused() {
    let table = table(Precision::F16);
    let refused = |extension: &str, style: Style| {
        let format = Format::named(extension).unwrap();
        Encoding::new(format, style, table.layout(), table.precision()).unwrap_err().to_string()
    };
    let zstd = Style { supercompress: Supercompress::Zstd, ..Style::default() };
    assert!(refused("dds", zstd).contains("expected .ktx2"));
    let bits = Style { numbers: Notation::Bits, ..Style::default() };
    assert!(refused("exr", bits).contains(".h, .rs"));
    for components in [0, 1, 3, 5] {
        let style = Style { components: Some(components), ..Style::default() };
        assert!(refused("ktx2", style).contains("components: expected 2 or 4 for 2 channels"));
    }
    for symbol in ["", "1a", "a-b", "_a", "a__b", "é", "table", "float", &"a".repeat(65)] {
        let style = Style { symbol: Some(symbol.into()), ..Style::default() };
        assert!(refused("h", style).contains("symbol: expected a letter"), "{symbol}");
    }
}

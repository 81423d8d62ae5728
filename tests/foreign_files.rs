//! Readers of foreign files: what our own encoders write comes back value by value, and hostile
//! files are refused without a panic.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use splitsum::foreign::{Foreign, Reading};
use splitsum::format::texels::Texels;
use splitsum::lut::terms::packing;
use splitsum::{
    Accuracy, Axis, Backend, Encoding, FORMATS, Format, Fresnel, Microfacet, Ndf, Precision,
    Request, Style, Supercompress, Table,
};
use std::io::Cursor;

/// A table of so many channels, 6 x 4 texels.
fn table(channels: &str, precision: Precision) -> Table {
    let lobe = Microfacet::new(Ndf::Ggx, None).unwrap();
    let packing = packing(lobe, Fresnel::Schlick, channels).unwrap();
    let axis = |words: &str, size| Axis::new(words.parse().unwrap(), size).unwrap();
    let (x, y) = (axis("nov", 6), axis("roughness", 4));
    let accuracy = Accuracy::by_default(&packing, precision);
    let request = Request::new(packing, x, y, accuracy, precision).unwrap();
    splitsum::bake(&request, &Backend::cpu()).unwrap().table
}

/// The bytes of a file, and the components of its texels.
fn encoded(table: &Table, format: &'static Format, style: Style) -> Option<(Vec<u8>, usize)> {
    let encoding = Encoding::new(format, style, table.layout(), table.precision()).ok()?;
    let components = Texels::new(table, encoding.clone()).components();
    let mut file = Cursor::new(Vec::new());
    encoding.write(table, &mut file).unwrap();
    Some((file.into_inner(), components))
}

/// How a file has to be read that does not say its layout.
fn reading(format: &Format, table: &Table, components: usize) -> Reading {
    let kind = match table.precision() {
        Precision::F16 => "16f",
        Precision::F32 => "32f",
        Precision::Unorm16 => "16",
        _ => "8",
    };
    let texel = match table.precision() {
        Precision::A2b10g10r10 => "rgb10a2".to_owned(),
        _ => format!("{}{kind}", &"rgba"[..components]),
    };
    let alone = ["raw", "h", "rs", "js", "ts", "wgsl", "glsl", "hlsl", "metal", "txt"];
    let raw = alone.contains(&format.extension());
    let layout = format!("6x4,{texel}");
    let is_text = raw && format.extension() != "raw";
    // The file is text, in which the longest list is the table.
    let array = is_text.then(|| "splitsum_table".to_owned());
    let array =
        array.map(|name| if format.extension() == "rs" { name.to_uppercase() } else { name });
    let array = array.filter(|_| format.extension() != "txt");
    Reading { raw: raw.then(|| layout.parse().unwrap()), array }
}

/// A code of a storage on a curve as readers have it, a fraction, as a value; alpha is on none.
fn value(precision: Precision, texel: &[f32], component: usize) -> f64 {
    let code = f64::from(texel[component]);
    match precision {
        Precision::Srgb8 if component < 3 => splitsum::table::srgb::linear(code),
        Precision::Rgbd8 => code.powf(2.2) / f64::from(texel[3]),
        _ => code,
    }
}

#[test]
fn every_file_of_ours_comes_back_value_by_value() {
    let mut files = 0;
    for format in FORMATS {
        for &precision in format.precisions() {
            for channels in ["e", "a,b", "a,b,e", "a,b,e,1"] {
                if precision == Precision::Rgbd8 && channels.ends_with('1') {
                    continue;
                }
                let table = table(channels, precision);
                let Some((bytes, components)) = encoded(&table, format, Style::default()) else {
                    continue;
                };
                // Decimals have no divisor, and no codes.
                let text = ["wgsl", "glsl", "hlsl", "metal"].contains(&format.extension());
                let packed = precision == Precision::A2b10g10r10;
                // Numbers of 32 bits hold three values each: no array of values.
                if packed && !["ktx2", "dds", "raw"].contains(&format.extension()) {
                    continue;
                }
                let count = if text && precision == Precision::Rgbd8 {
                    table.channels().len()
                } else {
                    components
                };
                let reading = reading(format, &table, count);
                let what = format!(".{}, {precision}, {channels}", format.extension());
                let read = match format.extension() {
                    // Text without a name: the layout is that of the list.
                    "txt" => {
                        let named = format!("numbers {}", String::from_utf8(bytes).unwrap());
                        let array = Some("numbers".to_owned());
                        Foreign::read(&what, named.as_bytes(), &Reading { array, ..reading })
                    }
                    _ => Foreign::read(&what, &bytes, &reading),
                };
                let read = read.map_err(|error| format!("{what}: {error}")).unwrap();
                assert_eq!(read.size, [6, 4, 1], "{what}");
                assert_eq!(read.components(), count, "{what}");
                let texels: Vec<&[f32]> = read.values.chunks_exact(count).collect();
                for (k, texel) in texels.iter().enumerate() {
                    let ours = table.texel(0, k % 6, k / 6);
                    for (channel, &ours) in ours.iter().enumerate() {
                        let theirs = match text {
                            true => f64::from(texel[channel]),
                            false => value(precision, texel, channel),
                        };
                        // Of curves f32 has the last digits another way.
                        let close = (theirs - ours).abs() <= 1e-6 * ours.abs().max(1e-3);
                        assert!(close, "{what}: {theirs} in place of {ours}");
                    }
                }
                files += 1;
            }
        }
    }
    assert!(files > 150, "{files}");
}

#[test]
fn zstandard_is_unpacked_and_metadata_are_found() {
    let table = table("a,b", Precision::F16);
    let style = Style { supercompress: Supercompress::Zstd, ..Style::default() };
    let (bytes, _) = encoded(&table, Format::named("ktx2").unwrap(), style).unwrap();
    let plain = encoded(&table, Format::named("ktx2").unwrap(), Style::default()).unwrap().0;
    let read = |bytes: &[u8]| Foreign::read("t", bytes, &Reading::default()).unwrap();
    assert_eq!(read(&bytes).values, read(&plain).values);
    for format in ["ktx2", "exr"] {
        let (bytes, _) = encoded(&table, Format::named(format).unwrap(), Style::default()).unwrap();
        let own = read(&bytes).own;
        assert_eq!(own.len(), 1, "{format}");
        assert!(own[0].contains("\"command\":\"splitsum bake "), "{format}: {own:?}");
        assert!(read(&bytes).faults.is_empty());
    }
}

/// A small file of every container that is not text.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let mut samples = Vec::new();
    for (extension, precision, style) in [
        ("exr", Precision::F16, Style::default()),
        ("ktx2", Precision::F16, Style::default()),
        ("ktx2", Precision::F16, Style { supercompress: Supercompress::Zstd, ..Style::default() }),
        ("dds", Precision::F16, Style::default()),
        ("png", Precision::Unorm8, Style::default()),
        ("npy", Precision::F32, Style::default()),
        ("js", Precision::F16, Style::default()),
    ] {
        let table = table("a,b", precision);
        samples.push((
            extension,
            encoded(&table, Format::named(extension).unwrap(), style).unwrap().0,
        ));
    }
    samples
}

#[test]
fn files_that_are_cut_off_are_refused() {
    for (extension, bytes) in samples() {
        // An array of source code that is cut off is a shorter one.
        if extension == "js" {
            continue;
        }
        for length in 0..bytes.len() {
            let read = Foreign::read("t", &bytes[..length], &Reading::default());
            // What a PNG or a KTX2 has behind its texels is no texel.
            if let Ok(read) = read {
                let whole = Foreign::read("t", &bytes, &Reading::default()).unwrap();
                assert_eq!(read.values, whole.values, "{extension} of {length} bytes");
            }
        }
    }
}

#[test]
fn absurd_sizes_are_refused_before_they_are_allocated() {
    let refused = |bytes: &[u8]| Foreign::read("t", bytes, &Reading::default()).unwrap_err();
    let file =
        |extension: &str| samples().into_iter().find(|(known, _)| *known == extension).unwrap().1;
    // KTX2: width and height; DDS: height and width.
    for (extension, at) in [("ktx2", 20), ("ktx2", 24), ("dds", 12), ("dds", 16)] {
        let mut bytes = file(extension);
        bytes[at..at + 4].copy_from_slice(&[0xff; 4]);
        assert!(refused(&bytes).to_string().contains("sides of 1 to 16384"), "{extension}");
    }
    let npy = |shape: &str| {
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes
    };
    for shape in ["(99999999999, 4, 2)", "(16384, 16384, 4)", "(4, 4, 0)", "(4, 4, 5, 6, 7)", "()"]
    {
        assert_eq!(refused(&npy(shape)).exit_code() as u8, 4, "{shape}");
    }
    // Zstandard that unpacks to more than the size says is refused, not read.
    let mut bytes = file("ktx2");
    bytes[20..24].copy_from_slice(&1u32.to_le_bytes());
    assert_eq!(refused(&bytes).exit_code() as u8, 4);
    for text in ["", "no numbers", "1, 2, 3", "\u{0}", "[1e999999, 2, 3, 4]"] {
        let _ = Foreign::read("t", text.as_bytes(), &Reading::default());
    }
}

//! OpenEXR, OpenImageIO, NumPy, Pillow and Panda3D.

use crate::common::printed;
use crate::files::{File, write_all};
use libtest_mimic::Failed;
use splitsum::table::precision::Precision;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// The readers of a file, those left out that are known to refuse it or to err.
fn readers(file: &File) -> Vec<&'static str> {
    let eight_bits =
        matches!(file.precision, Precision::Unorm8 | Precision::Srgb8 | Precision::Rgbd8);
    match file.kind() {
        "exr" => vec!["openexr", "openimageio"],
        "npy" => vec!["numpy"],
        // Pillow cuts 16 bits of colour to 8.
        "png" if eight_bits || file.components == 1 => vec!["openimageio", "pillow"],
        "png" => vec!["openimageio"],
        // Panda3D ends the process on two components of 8 bits, and refuses one, 10:10:10:2 and the
        // curve of sRGB.
        "dds" => match (file.precision, file.components) {
            (Precision::Unorm8, 2) | (_, 1) | (Precision::A2b10g10r10 | Precision::Srgb8, _) => {
                Vec::new()
            }
            _ => vec!["panda3d"],
        },
        _ => Vec::new(),
    }
}

/// What a reader finds: what it says of the file, and the values.
fn read(python: &Path, reader: &str, path: &Path) -> Result<(serde_json::Value, Vec<f64>), Failed> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/readers/read.py");
    let output = printed(Command::new(python).arg(script).arg(reader).arg(path))?;
    let line = output.iter().position(|byte| *byte == b'\n').ok_or("no line")?;
    let told = serde_json::from_slice(&output[..line])?;
    let values = output[line + 1..].as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes));
    Ok((told, values.collect()))
}

pub fn read_everything(python: &Path) -> Result<(), Failed> {
    let folder = tempdir()?;
    let mut counts = std::collections::BTreeMap::new();
    for file in write_all(folder.path()) {
        for reader in readers(&file) {
            let (told, values) = read(python, reader, &file.path)?;
            let shape: Vec<usize> = serde_json::from_value(told["shape"].clone())?;
            assert_eq!(shape, [file.slices, file.size.1, file.size.0, file.components], "{file:?}");
            // Codes are given as they are stored.
            let most = match told["dtype"].as_str() {
                Some("uint8") => 255.0,
                Some("uint16") => 65535.0,
                _ => 1.0,
            };
            for (place, (got, expected)) in values.iter().zip(&file.values).enumerate() {
                assert_eq!(got / most, *expected, "{reader}, {:?}, value {place}", file.path);
            }
            assert_eq!(values.len(), file.values.len());
            *counts.entry(reader).or_insert(0) += 1;
        }
    }
    assert_eq!(counts.len(), 5, "{counts:?}");
    assert!(counts.values().all(|&count| count >= 8), "{counts:?}");
    Ok(())
}

/// The nodes along x, in the words of the metadata: of tables of integrals and of nets.
fn nodes(columns: usize) -> String {
    match columns {
        32 => "nov = t, t = clamp((i + 0.5)/32, 0, 1)".into(),
        columns => format!("control = t, t = clamp(i/{}, 0, 1)", columns - 1),
    }
}

pub fn metadata_is_found(python: &Path) -> Result<(), Failed> {
    let folder = tempdir()?;
    let mut found = 0;
    for file in write_all(folder.path()) {
        let reader = match file.kind() {
            "exr" => "openexr",
            "png" => "openimageio",
            _ => continue,
        };
        let (told, _) = read(python, reader, &file.path)?;
        for slice in 0..file.slices {
            let text = told["splitsum"][slice].as_str().ok_or("no metadata")?;
            let metadata: serde_json::Value = serde_json::from_str(text)?;
            assert_eq!(metadata["x"]["texel"], nodes(file.size.0));
            assert_eq!(metadata["channels"].as_array().map(Vec::len), Some(file.components));
            found += 1;
        }
    }
    assert!(found > 15, "{found}");
    Ok(())
}

//! ktx-parse in Node.js; three.js and Babylon.js in Chromium.

use crate::common::printed;
use crate::files::{File, write_all};
use libtest_mimic::Failed;
use serde_json::{Value, json};
use splitsum::format::encoding::Supercompress;
use splitsum::table::precision::Precision;
use splitsum::table::slices::SlicesAs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// Whether a reader reads a file; the others are known to refuse it or to err, as docs/files.md
/// says.
fn reads(reader: &str, file: &File) -> bool {
    let float = matches!(file.precision, Precision::F16 | Precision::F32);
    match reader {
        // It is a container's reader, and leaves Zstandard to others.
        "ktx-parse" => file.style.supercompress == Supercompress::None,
        // It knows no layers, no 16 bits without an extension and no 10 bits.
        "three" if file.kind() == "ktx2" => {
            let sixteen = file.precision == Precision::Unorm16;
            file.slices == 1 && !sixteen && file.precision != Precision::A2b10g10r10
        }
        "three" => file.slices == 1 && file.components >= 3,
        // It rounds sizes to powers of two.
        _ => {
            let is_power_of_two = file.size.0.is_power_of_two() && file.size.1.is_power_of_two();
            float && file.components == 4 && file.slices == 1 && is_power_of_two
        }
    }
}

pub fn read_everything() -> Result<(), Failed> {
    let folder = tempdir()?;
    let files = write_all(folder.path());
    let kinds = ["ktx2", "exr", "dds"];
    let files: Vec<&File> = files.iter().filter(|file| kinds.contains(&file.kind())).collect();
    // A reader that leaves a broken texture behind would take the page with it.
    let readable = |file: &&&File| {
        let readers: &[&str] = match file.kind() {
            "ktx2" => &["ktx-parse", "three"],
            "exr" => &["three"],
            _ => &["babylon"],
        };
        readers.iter().all(|reader| reads(reader, file))
    };
    let (good, rest): (Vec<&File>, Vec<&File>) = files.iter().partition(readable);
    let rest: Vec<&File> = rest.into_iter().filter(|file| file.kind() == "ktx2").collect();
    let lines = run(folder.path(), &good)?;
    for line in &lines {
        assert_eq!(line["ok"], true, "{line}");
    }
    // Two readers of a texture, and one of the others.
    assert!(lines.len() > 40, "{}", lines.len());
    // What three.js does not read, ktx-parse does.
    let mut parsed = 0;
    for line in run(folder.path(), &rest)? {
        let file = rest.iter().find(|file| line["file"] == file.path.to_str().unwrap_or_default());
        let file = file.ok_or("a line of no file")?;
        let reader = line["reader"].as_str().unwrap_or_default();
        if reads(reader, file) {
            assert_eq!(line["ok"], true, "{line}");
            parsed += 1;
        } else {
            assert_eq!(line["ok"], false, "{reader} reads what the docs say it does not: {line}");
        }
    }
    assert!(parsed > 3, "{parsed}");
    Ok(())
}

fn layered(file: &File) -> bool {
    file.slices > 1 && file.style.slices == SlicesAs::Layers
}

/// The lines of the readers of these files.
fn run(folder: &Path, files: &[&File]) -> Result<Vec<Value>, Failed> {
    let entry = |file: &&File| {
        // The tolerance of a GPU's own curve of sRGB, which the standards leave to it.
        let tolerance = if file.precision == Precision::Srgb8 { 1e-5 } else { 2e-7 };
        json!({
            "path": file.path, "kind": file.kind(), "width": file.size.0, "height": file.size.1,
            "components": file.components, "expected": decoded(file), "bytes": file.beside("raw"),
            "layers": if layered(file) { file.slices } else { 0 }, "tolerance": tolerance,
        })
    };
    let manifest = folder.join("readers.json");
    let entries: Vec<Value> = files.iter().map(entry).collect();
    std::fs::write(&manifest, json!({ "files": entries }).to_string())?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web/readers.mjs");
    let output = printed(Command::new("node").arg(script).arg(&manifest))?;
    String::from_utf8(output)?.lines().map(|line| Ok(serde_json::from_str(line)?)).collect()
}

/// The file of the values that hardware gives: of the curve of sRGB the linear ones.
fn decoded(file: &File) -> std::path::PathBuf {
    if file.precision != Precision::Srgb8 {
        return file.beside("f64");
    }
    let linear = |(place, code): (usize, &f64)| {
        let alpha = file.components == 4 && place % 4 == 3;
        if alpha { *code } else { splitsum::table::srgb::value((255.0 * code).round() as u8) }
    };
    let values = file.values.iter().enumerate().map(linear);
    let bytes: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
    let path = file.beside("linear.f64");
    let _ = std::fs::write(&path, bytes);
    path
}

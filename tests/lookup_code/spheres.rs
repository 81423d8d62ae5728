//! Metal spheres by three.js with our table in place of its own: what a viewer sees of the
//! exchange.

use crate::cases::splitsum;
use crate::common::printed;
use libtest_mimic::Failed;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

/// The mean and the largest difference of 70,000 pixels of spheres in steps of 8 bits.
fn difference(folder: &Path, flags: &str) -> Result<(f64, f64), Failed> {
    let web = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web");
    let own = web.join("node_modules/three/src/renderers/shaders/DFGLUTData.js");
    splitsum(folder, &format!("bake -q --preset threejs {flags} -o data.js"))?;
    // Their module with our array in it, as the preset says.
    let (own, ours) = (fs::read_to_string(own)?, fs::read_to_string(folder.join("data.js"))?);
    let array = |text: &str| -> Option<(usize, usize)> {
        let begin = text.find("DATA = new Uint16Array(")?;
        Some((begin, begin + text[begin..].find(");")?))
    };
    let ((begin, end), (from, to)) = array(&own).zip(array(&ours)).ok_or("no array DATA")?;
    let replaced = format!("{}{}{}", &own[..begin], &ours[from..to], &own[end..]);
    fs::write(folder.join("replacement.js"), replaced)?;
    let mut node = Command::new("node");
    node.arg(web.join("spheres.mjs")).args(["picture.png", "replacement.js"]).current_dir(folder);
    let found: Value = serde_json::from_slice(&printed(&mut node)?)?;
    let number = |name: &str| found[name].as_f64().ok_or_else(|| format!("no {name}: {found}"));
    Ok((number("mean")?, number("largest")?))
}

pub fn are_the_same() -> Result<(), Failed> {
    let folder = tempdir()?;
    // Their table errs by 0.014 at the most, at a roughness where hardly a pixel shows it.
    let (mean, largest) = difference(folder.path(), "")?;
    assert!(mean < 0.05 && largest <= 4.0, "{mean}, {largest}");
    // And a table that is turned over is seen at once.
    let (mean, largest) = difference(folder.path(), "--x roughness,flip")?;
    assert!(mean > 1.0 && largest > 20.0, "{mean}, {largest}");
    Ok(())
}

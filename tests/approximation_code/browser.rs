//! Every case in Chromium: the generated GLSL on WebGL2 and the generated WGSL on WebGPU, at 65,536
//! points.

use crate::cases::{Case, allowed, cases};
use crate::common::printed;
use libtest_mimic::Failed;
use serde_json::{Value, json};
use splitsum::lookup::Language;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

const POINTS: usize = 65_536;

pub fn every_case() -> Result<(), Failed> {
    let folder = tempdir()?;
    let cases = cases();
    let made: Result<Vec<(Value, f64)>, Failed> =
        cases.iter().map(|case| entry(case, folder.path())).collect();
    let (entries, scales): (Vec<Value>, Vec<f64>) = made?.into_iter().unzip();
    let manifest = folder.path().join("lookup.json");
    fs::write(&manifest, json!({ "cases": entries }).to_string())?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web/lookup.mjs");
    let output = printed(Command::new("node").arg(script).arg(&manifest))?;
    let found: Value = serde_json::from_slice(&output)?;
    let results = found["results"].as_array().ok_or("no results")?;
    assert_eq!(results.len(), 2 * cases.len());
    for result in results {
        let at = cases.iter().position(|case| result["case"] == *case.name).ok_or("no case")?;
        let largest = result["largest"].as_f64().ok_or("no difference")?;
        assert_eq!(result["points"], POINTS);
        let allowed = allowed(&cases[at]) * scales[at];
        assert!(largest <= allowed, "{allowed:e} allowed: {result}");
    }
    Ok(())
}

/// Writes code, points and expected values, and names them; the largest sum of weighted numbers.
fn entry(case: &Case, folder: &Path) -> Result<(Value, f64), Failed> {
    let name = &case.name;
    let mut values = json!({});
    for (language, word, int, vec4) in
        [(Language::Glsl, "glsl", "int", "vec4"), (Language::Wgsl, "wgsl", "i32", "vec4f")]
    {
        fs::write(folder.join(format!("{name}.{word}")), case.code(language)?)?;
        let material = format!("{int}(point.w)");
        let [place, all] = case.arguments(["point.x", "point.y", &material, "point.z"]);
        values[word] = match case.has_scale_bias() {
            true => format!("{vec4}({name}_scale_bias({place}), {name}_albedo({all}), 0.0)"),
            false => format!("{vec4}({name}_albedo({all}), 0.0, 0.0, 0.0)"),
        }
        .into();
    }
    let points = case.points(POINTS);
    let (mut floats, mut expected, mut scale) = (Vec::new(), Vec::new(), 1.0f64);
    for (point, found) in points.iter().zip(case.expected(&points)) {
        floats.extend([point.nov, point.roughness, point.f0, point.material as f32]);
        let mut values = found.values;
        values.resize(4, 0.0);
        expected.extend(values.iter().map(|&value| value as f32));
        scale = scale.max(found.scale);
    }
    let bytes = |numbers: &[f32]| -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    };
    fs::write(folder.join(format!("{name}.points")), bytes(&floats))?;
    fs::write(folder.join(format!("{name}.expected")), bytes(&expected))?;
    let fields = if case.has_scale_bias() { json!(["A", "B", "E"]) } else { json!(["E"]) };
    let entry = json!({
        "name": name, "glsl": format!("{name}.glsl"), "wgsl": format!("{name}.wgsl"),
        "values": values, "fields": fields, "points": format!("{name}.points"),
        "expected": format!("{name}.expected"),
    });
    Ok((entry, scale))
}

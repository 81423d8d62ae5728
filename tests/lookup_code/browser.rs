//! Every preset's table in Chromium: the generated GLSL on WebGL2 and the generated WGSL on WebGPU,
//! at 65,536 points.

use crate::cases::{Case, splitsum};
use crate::common::printed;
use libtest_mimic::Failed;
use serde_json::{Value, json};
use splitsum::preset::presets;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

const POINTS: usize = 65_536;

/// Fields in one picture of four components.
const FIELDS: usize = 4;

/// The flags of a preset without its file, in a storage that a browser has: 16 bits of unorm need
/// an extension that SwiftShader lacks.
fn flags(preset: &str) -> String {
    let own = presets().find(|known| known.name == preset).map(|preset| preset.flags);
    let mut kept = Vec::new();
    let mut words = own.unwrap_or_default().split_whitespace();
    while let Some(word) = words.next() {
        let value = words.next().unwrap_or_default();
        if !["--format", "--symbol", "--components", "--numbers"].contains(&word) {
            kept.extend([word, value]);
        }
    }
    kept.join(" ").replace("unorm16", "f16")
}

pub fn every_preset() -> Result<(), Failed> {
    let folder = tempdir()?;
    let (mut entries, mut cases) = (Vec::new(), Vec::new());
    for preset in presets() {
        let case = Case::bake(folder.path(), preset.name, &flags(preset.name))?;
        entries.push(entry(&case)?);
        cases.push(case);
    }
    let slices = "--lut energy --z f0,sqrt --size 16x12x5 --precision f16";
    let case = Case::bake(folder.path(), "slices", slices)?;
    entries.push(entry(&case)?);
    cases.push(case);
    let manifest = folder.path().join("lookup.json");
    fs::write(&manifest, json!({ "cases": entries }).to_string())?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/web/lookup.mjs");
    let output = printed(Command::new("node").arg(script).arg(&manifest))?;
    let found: Value = serde_json::from_slice(&output)?;
    let results = found["results"].as_array().ok_or("no results")?;
    // Two languages, two functions; of RGBD codes, which no sampler may blend, one.
    let expected = cases.iter().map(|case| if filters(case) { 4 } else { 2 }).sum::<usize>();
    assert_eq!(results.len(), expected);
    for result in results {
        let case = cases.iter().find(|case| result["case"] == *case.name).ok_or("no case")?;
        let largest = result["largest"].as_f64().ok_or("no difference")?;
        assert_eq!(result["points"], POINTS);
        // A GPU blends by weights of 8 bits and more: half a step of those, of the largest step
        // between texels.
        let allowed = match result["function"].as_str() {
            Some("exact") => exact(case),
            _ => case.step() / 512.0 + exact(case),
        };
        assert!(largest <= allowed, "{allowed:e} allowed: {result}");
    }
    Ok(())
}

fn filters(case: &Case) -> bool {
    !case.flags.contains("rgbd8")
}

/// The largest difference of the exact function. 1e-6 where values change by no more than 1 from
/// texel to texel, as A, B and E do: a coordinate in f32 is off by 2^-24 of the table's width, and
/// so is the sum of four shares. Charlie's albedo changes by tens; a power of 2.2 in f32 is off by
/// 1e-6 of its value.
fn exact(case: &Case) -> f64 {
    let largest = case.values.iter().fold(1.0f64, |a, b| a.max(b.abs()));
    let powers = if filters(case) { 0.0 } else { 2e-6 * largest };
    1e-6 * case.step().max(1.0) + powers
}

/// Writes table, code, points and expected values, and names them.
fn entry(case: &Case) -> Result<Value, Failed> {
    let Case { name, flags, folder, .. } = case;
    splitsum(folder, &format!("bake -q {flags} --format ktx2 -o {name}.ktx2"))?;
    for language in ["glsl", "wgsl"] {
        splitsum(folder, &format!("lookup {name}.ktx2 -o {name}.{language}"))?;
    }
    let third = case.layout.slices.is_some();
    let (mut points, mut expected) = (Vec::new(), Vec::new());
    for [nov, roughness, f0] in case.points(POINTS) {
        let f0 = if third { f0 } else { 0.0 };
        points.extend([nov, roughness, f0, 0.0]);
        let mut values = case.expected([nov, roughness, f0].map(f64::from));
        values.resize(FIELDS, 0.0);
        expected.extend(values.iter().map(|&value| value as f32));
    }
    let bytes = |numbers: &[f32]| -> Vec<u8> {
        numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
    };
    fs::write(folder.join(format!("{name}.points")), bytes(&points))?;
    fs::write(folder.join(format!("{name}.expected")), bytes(&expected))?;
    let fields: Vec<&str> = case.fields.iter().take(FIELDS).map(|field| &*field.name).collect();
    let functions = if filters(case) { json!(["filtered", "exact"]) } else { json!(["exact"]) };
    Ok(json!({
        "name": name, "table": format!("{name}.ktx2"), "glsl": format!("{name}.glsl"),
        "wgsl": format!("{name}.wgsl"), "fields": fields, "functions": functions,
        "third": if third { json!("f0") } else { Value::Null },
        "points": format!("{name}.points"), "expected": format!("{name}.expected"),
    }))
}

//! Lookup code in C, C++, Rust and Metal's words, compiled here and run at many points.

use crate::cases::{CASES, Case, splitsum};
use crate::common::printed;
use libtest_mimic::Failed;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

const POINTS: usize = 4096;

/// Writes the points of a case as (n·v, roughness, F0) in f32.
fn write_points(case: &Case) -> Result<(), Failed> {
    let points = case.points(POINTS);
    let bytes: Vec<u8> = points.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    Ok(fs::write(case.folder.join("points"), bytes)?)
}

/// Compares what a program prints, all fields of a point as f32, with what is expected.
fn compare(case: &Case, program: &Path) -> Result<(), Failed> {
    let output = printed(Command::new(program).current_dir(&case.folder))?;
    let found = output.as_chunks().0.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes)));
    let found: Vec<f64> = found.collect();
    let fields = case.fields.len();
    assert_eq!(found.len(), POINTS * fields, "{}", case.name);
    let third = case.layout.slices.is_some();
    for (point, found) in case.points(POINTS).into_iter().zip(found.chunks(fields)) {
        let mut place = point.map(f64::from);
        place[2] = if third { place[2] } else { 0.0 };
        for (found, expected) in found.iter().zip(case.expected(place)) {
            // A coordinate in f32 is off by 2^-24 of the table's width; log2 and powers in f32 by a
            // few units more, which the steps between texels multiply.
            let allowed = 2e-6 * case.step().max(1.0) * expected.abs().max(1.0);
            assert!(
                (found - expected).abs() <= allowed,
                "{} at {point:?}: {found} for {expected}",
                case.name
            );
        }
    }
    Ok(())
}

/// Bakes all cases, writes for each the text of a program around the lookup of its texels and of
/// its array, compiles both, and compares what they print.
fn try_all(
    extension: &str,
    program: impl Fn(&Case, bool) -> String,
    compile: impl Fn(&Path, &Path) -> Result<(), Failed>,
) -> Result<(), Failed> {
    let folder = tempdir()?;
    for (name, flags) in CASES {
        let case = Case::bake(folder.path(), name, flags)?;
        write_points(&case)?;
        splitsum(folder.path(), &format!("bake -q {flags} --format raw -o table.raw"))?;
        splitsum(folder.path(), &format!("lookup {flags} --format raw -o passed.{extension}"))?;
        splitsum(folder.path(), &format!("bake -q {flags} -o above.{extension}"))?;
        for above in [false, true] {
            let source = folder.path().join(format!("main_{above}.{extension}.txt"));
            fs::write(&source, program(&case, above))?;
            let binary = folder.path().join("program");
            compile(&source, &binary)?;
            compare(&case, &binary)?;
        }
    }
    Ok(())
}

/// The arguments of a lookup at point `p`.
fn arguments(case: &Case, above: bool, table: &str) -> String {
    let third = if case.layout.slices.is_some() { ", p[2]" } else { "" };
    let table = if above { String::new() } else { format!("{table}, ") };
    format!("{table}p[0], p[1]{third}")
}

fn c_program(case: &Case, above: bool) -> String {
    let include = if above { "above.h" } else { "passed.h" };
    let call = arguments(case, above, "(const void *)texels");
    let call = match (above, call.strip_prefix("(const void *)texels")) {
        (false, Some(rest)) => format!("(const TABLE *)(const void *)texels{rest}"),
        _ => call,
    };
    let table = ["uint8_t", "uint16_t", "uint32_t", "float"][element(case)];
    format!(
        "#define TABLE {table}
#include \"{include}\"
#include <stdio.h>
static unsigned char texels[1 << 22];
int main(void) {{
    FILE *file = fopen(\"table.raw\", \"rb\");
    if (!file || !fread(texels, 1, sizeof texels, file)) return 1;
    file = fopen(\"points\", \"rb\");
    float p[3];
    while (file && fread(p, sizeof p, 1, file)) {{
        SplitSum numbers = splitsum_exact({call});
        fwrite(&numbers, sizeof numbers, 1, stdout);
    }}
    return 0;
}}
"
    )
}

/// The place of the type of a stored number among those of 8, 16, 32 bits and floats.
fn element(case: &Case) -> usize {
    let precision = case.flags.split("--precision ").nth(1).unwrap_or_default();
    match precision.split(' ').next() {
        Some("f16" | "unorm16") => 1,
        Some("a2b10g10r10") => 2,
        Some("f32") => 3,
        _ => 0,
    }
}

pub fn c() -> Result<(), Failed> {
    try_all("h", c_program, |source, binary| {
        let flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-x", "c"];
        let mut gcc = Command::new("gcc");
        gcc.args(flags).arg(source).arg("-I").arg(source.parent().unwrap_or(source));
        printed(gcc.arg("-o").arg(binary).arg("-lm")).map(drop)
    })
}

pub fn cpp() -> Result<(), Failed> {
    try_all("h", c_program, |source, binary| {
        let flags = ["-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror", "-x", "c++"];
        let mut gpp = Command::new("g++");
        gpp.args(flags).arg(source).arg("-I").arg(source.parent().unwrap_or(source));
        printed(gpp.arg("-o").arg(binary)).map(drop)
    })
}

pub fn rust() -> Result<(), Failed> {
    let program = |case: &Case, above: bool| {
        let include = if above { "above.rs" } else { "passed.rs" };
        let [size, from] = [
            ["1", "<[u8; 1]>::try_from(bytes).unwrap()[0]"],
            ["2", "u16::from_le_bytes(bytes.try_into().unwrap())"],
            ["4", "u32::from_le_bytes(bytes.try_into().unwrap())"],
            ["4", "f32::from_le_bytes(bytes.try_into().unwrap())"],
        ][element(case)];
        let call = arguments(case, above, "&table");
        let fields: Vec<String> =
            case.fields.iter().map(|field| format!("numbers.{}", field.name)).collect();
        format!(
            "mod lookup {{ include!(\"{include}\"); }}
use std::io::Write;
fn main() {{
    let texels = std::fs::read(\"table.raw\").unwrap();
    let table: Vec<_> = texels.chunks_exact({size}).map(|bytes| {from}).collect();
    let _ = &table;
    let points = std::fs::read(\"points\").unwrap();
    let mut out = std::io::stdout().lock();
    for point in points.chunks_exact(12) {{
        let number = |i: usize| f32::from_le_bytes(point[4 * i..][..4].try_into().unwrap());
        let p = [number(0), number(1), number(2)];
        let numbers = lookup::splitsum_exact({call});
        for number in [{}] {{ out.write_all(&number.to_le_bytes()).unwrap(); }}
    }}
}}
",
            fields.join(", ")
        )
    };
    try_all("rs", program, |source, binary| {
        let mut rustc = Command::new("rustc");
        rustc.args([
            "--edition",
            "2024",
            "--crate-name",
            "program",
            "-A",
            "dead_code",
            "-C",
            "opt-level=1",
        ]);
        printed(rustc.arg("-D").arg("warnings").arg(source).arg("-o").arg(binary)).map(drop)
    })
}

pub fn metal() -> Result<(), Failed> {
    let shim = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/metal");
    let folder = tempdir()?;
    // Its textures are of two dimensions, or arrays of such.
    for (name, flags) in CASES {
        let case = Case::bake(folder.path(), name, flags)?;
        write_points(&case)?;
        // The shim's textures hold what hardware gives: values, or the codes of RGBD.
        let texels: Vec<String> =
            case.values.chunks(case.components).map(|texel| texel_text(&case, texel)).collect();
        let extras = if name == "plain" { "--with turquin,fdez-aguera" } else { "" };
        let passed = format!("lookup {flags} {extras} --format raw -o passed.metal");
        splitsum(folder.path(), &passed)?;
        splitsum(folder.path(), &format!("bake -q {flags} -o above.metal"))?;
        for above in [false, true] {
            let include = if above { "above.metal" } else { "passed.metal" };
            let layered = case.layout.slices.is_some();
            let (kind, plane) = match layered {
                true => ("texture2d_array<float>", "table.slices[slice]"),
                false => ("texture2d<float>", "table"),
            };
            let depth = case.layout.slice_count();
            let slices =
                if layered { format!("table.slices.resize({depth});") } else { String::new() };
            let source = folder.path().join("main.cc");
            fs::write(
                &source,
                format!(
                    "#include <metal_stdlib>
using namespace metal;
#include \"{include}\"
#include <cstdio>
int main() {{
    {kind} table;
    {slices}
    const float values[] = {{{}}};
    const float *v = values;
    for (int slice = 0; slice < {depth}; slice++) {{
        {plane}.width = {width};
        {plane}.height = {height};
        for (int i = 0; i < {width} * {height}; i++, v += 4)
            {plane}.texels.push_back(float4(v[0], v[1], v[2], v[3]));
    }}
    std::FILE *file = std::fopen(\"points\", \"rb\");
    float p[3];
    while (file && std::fread(p, sizeof p, 1, file)) {{
        SplitSum numbers = splitsum_exact({});
        std::fwrite(&numbers, sizeof numbers, 1, stdout);
    }}
}}
",
                    texels.join(","),
                    arguments(&case, above, "table"),
                    width = case.layout.x.size(),
                    height = case.layout.y.size(),
                ),
            )?;
            let binary = folder.path().join("program");
            let mut gpp = Command::new("g++");
            gpp.args(["-std=c++17", "-O1", "-Wall", "-Werror", "-Wno-attributes"]);
            gpp.arg("-I").arg(&shim).arg("-I").arg(folder.path());
            printed(gpp.arg(&source).arg("-o").arg(&binary))?;
            compare(&case, &binary)?;
        }
    }
    Ok(())
}

/// A texel as a texture of hardware holds it.
fn texel_text(case: &Case, texel: &[f64]) -> String {
    let mut components = texel.to_vec();
    if case.flags.contains("rgbd8") {
        // (code/255)^2.2 / D is the value, with any D: one that keeps the code in range.
        let largest = texel[..3].iter().fold(1.0f64, |a, b| a.max(*b));
        components = texel[..3].iter().map(|v| (v / largest).powf(1.0 / 2.2)).collect();
        components.push(1.0 / largest);
    }
    components.resize(4, 0.0);
    components.iter().map(|value| format!("{value:?}f")).collect::<Vec<_>>().join(",")
}

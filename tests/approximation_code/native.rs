//! The code in C, C++, Rust and Metal's words, compiled here and run at many points.

use crate::cases::{Case, Expected, Point, cases};
use crate::common::printed;
use libtest_mimic::Failed;
use splitsum::lookup::Language;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::tempdir;

const POINTS: usize = 4096;

/// The points of a case, some of them at the least of all.
fn points(case: &Case) -> Vec<Point> {
    let mut points = case.points(POINTS);
    for (_, point) in points.iter_mut().enumerate().filter(|(i, _)| is_least(*i)) {
        (point.nov, point.roughness) = (0.0, 0.0);
    }
    points
}

/// Whether a point is one of those.
fn is_least(i: usize) -> bool {
    i % 64 == 5
}

/// Compiles a program around the code of all cases, which prints A, B and E(F0) of each at each of
/// its points, and compares. Where `nan` says so, the code makes the least of what is no number.
fn try_all(
    nan: bool,
    program: impl Fn(&[Case]) -> Result<String, Failed>,
    compile: impl Fn(&Path, &Path) -> Result<(), Failed>,
) -> Result<(), Failed> {
    let folder = tempdir()?;
    let cases = cases();
    let mut bytes = Vec::new();
    for (i, point) in cases.iter().flat_map(|case| points(case).into_iter().enumerate()) {
        let place = match nan && is_least(i) {
            true => [f32::NAN; 2],
            false => [point.nov, point.roughness],
        };
        for number in place.into_iter().chain([point.f0, point.material as f32]) {
            bytes.extend(number.to_le_bytes());
        }
    }
    fs::write(folder.path().join("points"), bytes)?;
    let (source, binary) = (folder.path().join("main.txt"), folder.path().join("program"));
    fs::write(&source, program(&cases)?)?;
    compile(&source, &binary)?;
    let output = printed(Command::new(&binary).current_dir(folder.path()))?;
    let mut found = output.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
    for case in &cases {
        let points = points(case);
        for (point, Expected { values, scale }) in points.iter().zip(case.expected(&points)) {
            for value in values {
                let found = f64::from(found.next().ok_or("too few numbers")?);
                let name = &case.name;
                let right = (found - value).abs() <= 2e-6 * scale;
                assert!(right, "{name} at {point:?}: {found} for {value}");
            }
        }
    }
    assert!(found.next().is_none());
    Ok(())
}

/// A function for each case that prints its lookup at p.
fn c_program(cases: &[Case], language: Language, head: &str) -> Result<String, Failed> {
    let mut text = String::from(head);
    let mut calls = String::new();
    for case in cases {
        let name = &case.name;
        text += &case.code(language)?;
        let [place, all] = case.arguments(["p[0]", "p[1]", "(int)p[3]", "p[2]"]);
        let scale_bias = match (case.has_scale_bias(), language) {
            (false, _) => String::new(),
            (_, Language::C) => format!(
                "    {name}_float2 ab = {name}_scale_bias({place});\n    put(ab.x);\n    \
                 put(ab.y);\n"
            ),
            _ => format!(
                "    float2 ab = {name}_scale_bias({place});\n    put(ab.x);\n    put(ab.y);\n"
            ),
        };
        write!(
            text,
            "\nstatic void print_{name}(const float *p) {{\n{scale_bias}    \
             put({name}_albedo({all}));\n}}\n\n"
        )?;
        let _ = writeln!(calls, "    for (int i = 0; i < {POINTS}; ++i) print_{name}(next(file));");
    }
    write!(
        text,
        "int main(void) {{\n    FILE *file = fopen(\"points\", \"rb\");\n    if (!file) return 1;\n\
         {calls}    return 0;\n}}\n"
    )?;
    Ok(text)
}

const HEAD: &str = "#include <stdio.h>
#include <stdlib.h>
static void put(float value) { fwrite(&value, sizeof value, 1, stdout); }
static const float *next(FILE *file) {
    static float p[4];
    if (!fread(p, sizeof p, 1, file)) exit(2);
    return p;
}
";

pub fn c() -> Result<(), Failed> {
    try_all(
        true,
        |cases| c_program(cases, Language::C, HEAD),
        |source, binary| {
            let flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-x", "c"];
            let mut gcc = Command::new("gcc");
            printed(gcc.args(flags).arg(source).arg("-o").arg(binary).arg("-lm")).map(drop)
        },
    )
}

pub fn cpp() -> Result<(), Failed> {
    try_all(
        true,
        |cases| c_program(cases, Language::C, HEAD),
        |source, binary| {
            let flags = ["-std=c++17", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];
            let mut gpp = Command::new("g++");
            gpp.args(flags).args(["-x", "c++"]).arg(source).arg("-o").arg(binary);
            printed(&mut gpp).map(drop)
        },
    )
}

pub fn metal() -> Result<(), Failed> {
    let shim = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/metal");
    let head = format!("#include <metal_stdlib>\n{HEAD}using namespace metal;\n");
    // Metal computes without regard to what is no number, unless told otherwise.
    try_all(
        false,
        |cases| c_program(cases, Language::Msl, &head),
        |source, binary| {
            let flags = ["-std=c++17", "-O1", "-Wall", "-Werror", "-Wno-attributes", "-x", "c++"];
            let mut gpp = Command::new("g++");
            gpp.args(flags).arg("-I").arg(&shim).arg(source).arg("-o").arg(binary);
            printed(&mut gpp).map(drop)
        },
    )
}

fn rust_program(cases: &[Case]) -> Result<String, Failed> {
    let (mut text, mut calls) = (String::new(), String::new());
    for case in cases {
        let name = &case.name;
        text += &case.code(Language::Rust)?;
        text += "\n";
        let [place, all] = case.arguments(["nov", "roughness", "material as i32", "f0"]);
        let scale_bias = match case.has_scale_bias() {
            true => format!("{name}_scale_bias({place}).into_iter().for_each(&mut put);\n        "),
            false => String::new(),
        };
        write!(
            calls,
            "    for _ in 0..{POINTS} {{
        let [nov, roughness, f0, material] = next();
        let _ = (nov, roughness, f0, material);
        {scale_bias}put({name}_albedo({all}));
    }}
"
        )?;
    }
    Ok(format!(
        "{text}fn main() {{
    let points = std::fs::read(\"points\").unwrap();
    let mut numbers = points.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes));
    let mut next = || [(); 4].map(|_| numbers.next().unwrap());
    let mut out = Vec::new();
    let mut put = |value: f32| out.extend(value.to_le_bytes());
{calls}    std::io::Write::write_all(&mut std::io::stdout(), &out).unwrap();
}}
"
    ))
}

pub fn rust() -> Result<(), Failed> {
    try_all(true, rust_program, |source, binary| {
        let mut rustc = Command::new("rustc");
        rustc.args(["--edition", "2024", "--crate-name", "program", "-C", "opt-level=1"]);
        printed(rustc.args(["-D", "warnings"]).arg(source).arg("-o").arg(binary)).map(drop)
    })
}

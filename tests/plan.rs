//! The plan of a bake: what `--dry-run` prints is what a bake does.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;
#[path = "common/program.rs"]
mod program;

use program::{ok, stderr};
use serde_json::Value;
use tempfile::tempdir;

/// The requests: certified, of one rule, closed, with several stages, with slices.
const REQUESTS: [&str; 6] = [
    "--size 16",
    "--size 16 --model beckmann --masking separable",
    "--size 16 --certify off --tolerance 1e-4",
    "--size 16 --lut diffuse",
    "--size 12 --precision f32",
    "--size 8 --lut energy --f0 0.04,0.5",
];

#[test]
fn a_dry_run_names_the_stages_that_a_bake_then_takes_and_writes_nothing() {
    let folder = tempdir().unwrap();
    for request in REQUESTS {
        let plan = ok(&folder, &format!("bake --backend cpu --dry-run -o a.exr {request}"));
        let plan = String::from_utf8(plan.stdout).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{request}");
        let report = ok(&folder, &format!("bake --backend cpu --json -o a.exr {request}"));
        let report: Value = serde_json::from_slice(&report.stdout).unwrap();
        for table in report["tables"].as_array().unwrap() {
            // "CPU f64, l4608", or the one rule of an uncertified table.
            let stages = table["stages"].as_array().into_iter().flatten();
            let mut rules: Vec<&str> = stages.map(|stage| stage["by"].as_str().unwrap()).collect();
            rules.extend(table["uncertified"]["rule"].as_str());
            assert!(!rules.is_empty(), "{request}");
            let mut from = 0;
            for rule in rules {
                // In the order in which they decide.
                let rule = rule.rsplit(' ').next().unwrap();
                let found = plan[from..].find(rule);
                from += found.unwrap_or_else(|| panic!("{request}: no {rule} in {plan}"));
            }
            let command = table["command"].as_str().unwrap();
            assert!(plan.contains(command), "{request}: {plan}");
        }
        std::fs::remove_file(folder.path().join("a.exr")).unwrap();
    }
}

#[test]
fn a_command_that_a_plan_prints_can_be_given_again() {
    let folder = tempdir().unwrap();
    for given in [
        "--lut energy --f0 -0",
        "--lut energy --f0 -0,1e-300,0.04",
        "--lut energy --ior 1.5",
        "--y roughness,offset=-0",
        "--precision unorm16",
    ] {
        let plan = ok(&folder, &format!("bake --backend cpu --dry-run --size 4 {given}")).stdout;
        let plan = String::from_utf8(plan).unwrap();
        let command =
            plan.lines().find_map(|line| line.strip_prefix("command   splitsum ")).unwrap();
        let again = ok(&folder, &format!("{command} --backend cpu --dry-run")).stdout;
        assert_eq!(String::from_utf8(again).unwrap(), plan, "{given}");
    }
}

#[test]
fn a_dry_run_says_how_large_the_table_is() {
    let folder = tempdir().unwrap();
    let plan = ok(&folder, "bake --dry-run --backend cpu --size 512x256 --channels be");
    assert!(stderr(&plan).is_empty());
    let plan = String::from_utf8(plan.stdout).unwrap();
    // 512 · 256 texels of two halves.
    for said in ["output    out/dfg.exr", "512 x 256", "512 KiB", "CPU", "time"] {
        assert!(plan.contains(said), "no '{said}' in {plan}");
    }
    assert!(!folder.path().join("out").exists());
}

//! The build files of docs/pipelines.md, as they stand there: built once, then again after nothing
//! and after a change of the configuration. A tool that is not installed is reported as ignored,
//! with the reason; where SPLITSUM_REQUIRE_READERS is set, that is a failure instead.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{printed, with_program};
use libtest_mimic::{Arguments, Failed};
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};
use tempfile::tempdir;

fn main() {
    let what =
        |tool: &str| format!("{tool} rebuilds after a change of the configuration, and only then");
    let trials = vec![
        with_program("make", &what("make"), || rebuilds("make", "Makefile", &[&["make", "-s"]])),
        with_program("ninja", &what("ninja"), || {
            rebuilds("ninja", "build.ninja", &[&["ninja", "--quiet"]])
        }),
        with_program("cmake", &what("cmake"), || {
            let configure = ["cmake", "-S", ".", "-B", "build", "-G", "Ninja"];
            rebuilds("cmake", "CMakeLists.txt", &[&configure, &["cmake", "--build", "build"]])
        }),
    ];
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// The contents of the page's first code block of a language.
fn block(language: &str) -> &'static str {
    let page = include_str!("../docs/pipelines.md");
    let start = format!("```{language}\n");
    page.split(&start).nth(1).and_then(|rest| rest.split("```").next()).unwrap()
}

/// Runs the steps in a folder, the program being on the path.
fn build(folder: &Path, steps: &[&[&str]]) -> Result<(), Failed> {
    let program = Path::new(env!("CARGO_BIN_EXE_splitsum")).parent().unwrap();
    let mut path = OsString::from(program);
    path.push(":");
    path.push(std::env::var_os("PATH").unwrap_or_default());
    for step in steps {
        printed(Command::new(step[0]).args(&step[1..]).current_dir(folder).env("PATH", &path))?;
    }
    Ok(())
}

fn time_of(folder: &Path) -> SystemTime {
    fs::metadata(folder.join("dfg.ktx2")).unwrap().modified().unwrap()
}

fn rebuilds(language: &str, file: &str, steps: &[&[&str]]) -> Result<(), Failed> {
    let folder = tempdir()?;
    let folder = folder.path();
    // Older than what is built, so that no clock's resolution matters.
    let config = folder.join("luts.toml");
    let write_config = |text: &str, age: u64| {
        fs::write(&config, text).unwrap();
        let time = SystemTime::now() - Duration::from_secs(age);
        fs::File::options().write(true).open(&config).unwrap().set_modified(time).unwrap();
    };
    write_config(block("toml"), 60);
    fs::write(folder.join(file), block(language))?;
    build(folder, steps)?;
    let (first, bytes) = (time_of(folder), fs::read(folder.join("dfg.ktx2"))?);
    assert!(fs::read_to_string(folder.join("dfg.wgsl"))?.contains("splitsum_exact"));
    build(folder, steps)?;
    assert_eq!(time_of(folder), first, "built again though nothing had changed");
    // Ahead of the table, as a later edit is; ninja compares with what it wrote down.
    std::thread::sleep(Duration::from_millis(20));
    write_config(&format!("{}size = 32\n", block("toml")), 0);
    build(folder, steps)?;
    assert!(time_of(folder) > first, "not built again");
    assert!(fs::read(folder.join("dfg.ktx2"))?.len() < bytes.len() / 2);
    Ok(())
}

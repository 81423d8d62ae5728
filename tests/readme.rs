//! The README's commands work as they stand there, in its order, in an empty folder.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;
use std::process::Command;

/// The contents of the README's code blocks of a language.
fn blocks<'a>(readme: &'a str, language: &'a str) -> impl Iterator<Item = &'a str> {
    readme
        .split("```")
        .skip(1)
        .step_by(2)
        .filter_map(move |block| block.strip_prefix(language)?.strip_prefix('\n'))
}

#[test]
fn the_commands_of_the_readme_and_of_its_pages_work() {
    let readme = [include_str!("../README.md"), include_str!("../docs/models.md")].join("\n");
    let readme = readme.as_str();
    let folder = tempfile::tempdir().unwrap();
    let config = blocks(readme, "toml").next().unwrap();
    std::fs::write(folder.path().join("luts.toml"), config).unwrap();
    let commands = blocks(readme, "sh")
        .flat_map(str::lines)
        .map(|line| line.split(" #").next().unwrap_or(line).trim_end());
    let mut count = 0;
    for command in commands.filter(|line| !line.is_empty()) {
        let program = Path::new(env!("CARGO_BIN_EXE_splitsum"));
        if let Some(example) = command.strip_prefix("cargo run --release --example ") {
            // Examples are built with the tests.
            let example = program.with_file_name("examples").join(example);
            assert!(Command::new(example).current_dir(&folder).status().unwrap().success());
            continue;
        }
        let Some(arguments) = command.strip_prefix("cargo run --release -- ") else {
            assert!(command == "cargo test --release", "cannot try '{command}'");
            continue;
        };
        // A list of devices needs a device; everything else falls back to the CPU.
        let arguments: Vec<_> = arguments.split_whitespace().collect();
        let output = Command::new(program).current_dir(&folder).args(&arguments).output().unwrap();
        let may_fail = arguments[0] == "devices" && output.status.code() == Some(5);
        assert!(
            output.status.success() || may_fail,
            "{command}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        count += 1;
    }
    assert!(count >= 24, "only {count} commands found");
    assert!(folder.path().join("out/dfg.exr").exists());
}

#[test]
fn figures_in_the_readme_are_those_of_the_run() {
    let (readme, page) = (include_str!("../README.md"), include_str!("../docs/charts/speed.md"));
    let begin = readme.find("| largest error |").unwrap();
    let table = readme[begin..].lines().take_while(|line| line.starts_with('|'));
    assert!(table.clone().count() > 5);
    for line in table {
        assert!(page.contains(line), "docs/charts/speed.md has no line '{line}'");
    }
}

#[test]
fn charts_are_drawn_from_the_measurements_beside_them() {
    let charts = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/charts");
    let folder = tempfile::tempdir().unwrap();
    for study in ["speed", "stability"] {
        let saved = charts.join(format!("{study}.json"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_splitsum"));
        command.current_dir(&folder).args(["chart", study, "-q", "-o", ".", "--from"]).arg(saved);
        assert!(command.output().unwrap().status.success());
    }
    let mut count = 0;
    for entry in std::fs::read_dir(folder.path()).unwrap() {
        let name = entry.unwrap().file_name();
        let read = |folder: &Path| std::fs::read(folder.join(&name)).unwrap();
        // The edges of what is painted may differ by a shade where vector instructions do.
        let painted = name.to_string_lossy().ends_with(".png");
        let (drawn, kept) = (read(folder.path()), read(&charts));
        assert!(painted || drawn == kept, "{name:?} is not what its measurements give");
        count += 1;
    }
    assert!(count > 20, "{count}");
}

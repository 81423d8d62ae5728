//! The README's commands work as they stand there, in its order, in an empty folder.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::process::Command;

/// The contents of the README's code blocks of a language.
fn blocks<'a>(readme: &'a str, language: &'a str) -> impl Iterator<Item = &'a str> {
    readme.split("```").skip(1).step_by(2).filter_map(move |block| block.strip_prefix(language)?.strip_prefix('\n'))
}

#[test]
fn the_commands_of_the_readme_work() {
    let readme = include_str!("../README.md");
    let folder = tempfile::tempdir().unwrap();
    let config = blocks(readme, "toml").next().unwrap();
    std::fs::write(folder.path().join("luts.toml"), config).unwrap();
    let commands =
        blocks(readme, "sh").flat_map(str::lines).map(|line| line.split(" #").next().unwrap_or(line).trim_end());
    let mut count = 0;
    for command in commands.filter(|line| !line.is_empty()) {
        let Some(arguments) = command.strip_prefix("cargo run --release -- ") else {
            assert!(["cargo test --release", "cargo install --path ."].contains(&command), "cannot try '{command}'");
            continue;
        };
        // A list of devices needs a device; everything else falls back to the CPU.
        let arguments: Vec<_> = arguments.split_whitespace().collect();
        let output =
            Command::new(env!("CARGO_BIN_EXE_splitsum")).current_dir(&folder).args(&arguments).output().unwrap();
        let may_fail = arguments[0] == "devices" && output.status.code() == Some(5);
        assert!(output.status.success() || may_fail, "{command}: {}", String::from_utf8_lossy(&output.stderr));
        count += 1;
    }
    assert!(count >= 5, "only {count} commands found");
    assert!(folder.path().join("out/dfg.exr").exists());
}

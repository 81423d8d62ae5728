//! What the program says about itself: help, manual pages, completions.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/program.rs"]
mod program;

use program::{ok, run, stderr};
use splitsum::brdf::fresnel::KINDS;
use splitsum::integrate::rules::RULES;
use splitsum::{BackendChoice, Choice, Diffuse, EnergyChannels, FORMATS, Masking, Ndf};
use tempfile::{TempDir, tempdir};

fn said(folder: &TempDir, arguments: &str) -> String {
    String::from_utf8(ok(folder, arguments).stdout).unwrap()
}

#[test]
fn help_tells_the_exit_codes() {
    let folder = tempdir().unwrap();
    for command in ["", "bake", "furnace", "preview", "devices", "man", "completions"] {
        let text = said(&folder, &format!("{command} --help"));
        for (code, meaning) in splitsum::error::ExitCode::MEANINGS {
            assert!(text.contains(&format!("{}  {meaning}", code as u8)), "{command}: {meaning}");
        }
    }
    assert_eq!(run(&folder, "").status.code(), Some(2));
    assert!(said(&folder, "--version").starts_with("splitsum "));
}

fn words<C: Choice>() -> impl Iterator<Item = &'static str> {
    C::ALL.iter().map(|choice| choice.word())
}

#[test]
fn help_lists_every_word_that_a_flag_takes() {
    let folder = tempdir().unwrap();
    let text = said(&folder, "bake --help");
    let words = words::<Ndf>()
        .chain(words::<Diffuse>())
        .chain(words::<Masking>())
        .chain(KINDS.iter().map(|kind| kind.usage))
        .chain(words::<EnergyChannels>())
        .chain(words::<BackendChoice>())
        .chain(FORMATS.iter().flat_map(|format| format.precisions()).map(|storage| storage.word()))
        .chain(FORMATS.iter().map(|format| format.extension()));
    for word in words {
        let entry = |line: &str| line.trim_start().starts_with(&format!("- {word}: "));
        // Of reflected and of transmitted light.
        let flags = if word == "separable" { 2 } else { 1 };
        assert_eq!(text.lines().filter(|line| entry(line)).count(), flags, "{word}");
    }
    // Words that explain themselves stand in a list, which runs over several lines.
    let flat = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let lists = flat.split("[possible values: ").skip(1).filter_map(|rest| rest.split(']').next());
    let listed: Vec<&str> = lists.flat_map(|list| list.split(", ")).collect();
    let rules = RULES.iter().map(|rule| rule.name);
    for word in rules {
        assert!(listed.contains(&word), "{word} is not in {listed:?}");
    }
}

#[test]
fn completions_know_commands_and_words() {
    let folder = tempdir().unwrap();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let text = said(&folder, &format!("completions {shell}"));
        for word in ["splitsum", "furnace", "dry-run"] {
            assert!(text.contains(word), "{shell}: no {word}");
        }
        // clap gives these two no values.
        let values = !["elvish", "powershell"].contains(&shell);
        assert_eq!(text.contains("f82"), values, "{shell}");
    }
    assert_eq!(run(&folder, "completions tcsh").status.code(), Some(2));
}

#[test]
fn a_manual_page_has_the_commands_and_their_flags() {
    let folder = tempdir().unwrap();
    assert!(said(&folder, "man").contains("splitsum\\-bake(1)"));
    for page in ["man bake", "man chart speed"] {
        let text = said(&folder, page);
        assert!(text.contains(".TH splitsum\\-") || text.contains(".TH splitsum-"), "{page}");
        assert!(text.contains("\\-\\-output"), "{page}");
    }
    let output = run(&folder, "man bread");
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("bake"), "{}", stderr(&output));
}

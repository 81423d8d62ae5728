//! `splitsum presets`

use crate::error::Result;
use crate::preset::{Preset, presets};

#[derive(clap::Args)]
pub struct PresetsArgs {
    /// The preset to describe [default: a list of all]
    #[arg(value_parser = super::choices::preset(), hide_possible_values = true)]
    name: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &PresetsArgs) -> Result<()> {
    super::standard_output::check()?;
    match (&arguments.name, arguments.json) {
        (Some(name), true) => super::print_json(Preset::named(name)?),
        (Some(name), false) => super::print(&page(Preset::named(name)?)),
        (None, true) => super::print_json(&presets().collect::<Vec<_>>()),
        (None, false) => super::print(&list()),
    }
}

/// All presets, a line each.
fn list() -> String {
    let lines: Vec<String> =
        presets().map(|preset| format!("{:16} {}", preset.name, preset.about)).collect();
    let hint = "'splitsum presets NAME' describes one; 'splitsum bake --preset NAME' bakes it.";
    format!("{}\n\n{hint}", lines.join("\n"))
}

/// A preset in full.
fn page(preset: &Preset) -> String {
    let parts = [
        ("stored", preset.stored.to_owned()),
        ("lookup", preset.lookup.to_owned()),
        ("import", preset.import.to_owned()),
        ("faults", format!("of the engine's own table: {}", preset.faults)),
        ("source", preset.source.to_owned()),
    ];
    let parts = parts.map(|(name, text)| format!("{name:8}  {}", wrapped(&text)));
    // On one line, to be pasted.
    let bake = format!("bake      {}", preset.command());
    format!("{}: {}\n\n{bake}\n\n{}", preset.name, preset.about, parts.join("\n\n"))
}

/// Columns of a line.
const COLUMNS: usize = 90;

/// Text in lines that begin below the first.
fn wrapped(text: &str) -> String {
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split(' ') {
        if !line.is_empty() && line.len() + 1 + word.len() > COLUMNS - 10 {
            lines.push(std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    lines.push(line);
    lines.join("\n          ")
}

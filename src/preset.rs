//! Presets: the table that an engine expects, as flags. A preset bakes the true integral at the
//! nodes that the engine's own lookup reads: a replacement of the table that it ships or computes.

mod offline;
mod realtime;
mod tools;

use crate::error::{Error, Result};

/// The table of an engine.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct Preset {
    /// Its word.
    pub name: &'static str,
    /// It in a line.
    pub about: &'static str,
    /// The flags of `splitsum bake`.
    pub flags: &'static str,
    /// The name of its file.
    pub file: &'static str,
    /// Whether the engine reads a table of the size that the flags name alone: it checks the size,
    /// or its shader or array has it as a constant.
    pub only_size: bool,
    /// Where the convention was read.
    pub source: &'static str,
    /// What a texel holds, and in which order.
    pub stored: &'static str,
    /// The coordinates at which the engine reads it.
    pub lookup: &'static str,
    /// What a user has to set or patch in the engine.
    pub import: &'static str,
    /// What is wrong with the engine's own table, with figures: errors of A, B or E.
    pub faults: &'static str,
}

/// All presets.
pub fn presets() -> impl Iterator<Item = &'static Preset> {
    realtime::PRESETS.iter().chain(tools::PRESETS).chain(offline::PRESETS)
}

impl Preset {
    /// The preset with this word.
    pub fn named(word: &str) -> Result<&'static Preset> {
        presets().find(|preset| preset.name == word).ok_or_else(|| {
            let known = presets().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
            Error::bad_input("preset", known, format!("'{word}'"), "name one of these")
        })
    }

    /// The command without a preset.
    pub fn command(&self) -> String {
        // A shell expands a bare *.
        let quoted = |word: &str| match word.contains('*') {
            true => format!("'{word}'"),
            false => word.to_owned(),
        };
        let flags: Vec<String> = self.flags.split_whitespace().map(quoted).collect();
        format!("splitsum bake {} -o {}", flags.join(" "), self.file)
    }
}

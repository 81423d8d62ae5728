//! What was assumed or could not be read, in lines.

use std::collections::{BTreeMap, BTreeSet};

/// The result of reading a part of a scene that it can do without: the part, or why not.
pub type Read<T> = Result<T, String>;

/// More notes than these help nobody.
const MOST: usize = 1000;

/// The notes of a scene, each once.
#[derive(Default)]
pub struct Notes {
    lines: Vec<String>,
    known: BTreeSet<String>,
    left_out: usize,
    counts: BTreeMap<&'static str, usize>,
}

impl Notes {
    /// Adds a note, unless it is known.
    pub fn add(&mut self, note: String) {
        if self.known.contains(&note) {
            return;
        }
        if self.lines.len() < MOST {
            self.known.insert(note.clone());
            self.lines.push(note);
        } else {
            self.left_out += 1;
        }
    }

    /// Counts a material that this holds for.
    pub fn count(&mut self, what: &'static str) {
        *self.counts.entry(what).or_default() += 1;
    }

    /// All lines.
    pub fn lines(self) -> Vec<String> {
        let mut lines = self.lines;
        for (what, count) in self.counts {
            let noun = if count == 1 { "material" } else { "materials" };
            lines.push(format!("{count} {noun}: {what}"));
        }
        if self.left_out > 0 {
            lines.push(format!("{} further notes are left out", self.left_out));
        }
        lines
    }
}

//! What was assumed or could not be read, in lines; and foreign text made fit to print.

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

/// Text of a file as a part of a line: no control characters, none that turn the direction of
/// writing, and at most so many characters.
pub fn clean(text: &str, most: usize) -> String {
    let visible = |c: char| {
        let turns = matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}')
            || matches!(c, '\u{2066}'..='\u{2069}' | '\u{feff}');
        if c.is_control() || turns { ' ' } else { c }
    };
    let mut characters = text.trim().chars().map(visible);
    let mut cleaned: String = characters.by_ref().take(most).collect();
    if characters.next().is_some() {
        cleaned.pop();
        cleaned.push('…');
    }
    cleaned
}

//! Dependency files in Make's syntax, for make, ninja, CMake and meson; with the flags that
//! compilers have for them.
//!
//! The escapes are those that GNU make 4.3 and ninja 1.11 were seen to read, which is more than any
//! manual says; where the two differ, make is right. tests/depfiles.rs asks both of them.

use crate::error::Complaint;
use std::ffi::OsString;

/// -MD, -MF and -MT, as compilers spell them, in the long form that the parser takes.
pub fn long_flag(argument: OsString) -> OsString {
    match argument.to_str() {
        Some("-MD") => "--md".into(),
        Some("-MF") => "--mf".into(),
        Some("-MT") => "--mt".into(),
        _ => argument,
    }
}

/// The side of the colon that a name stands on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Target,
    Dependency,
}

/// The obstacle that keeps make from reading a name, however it is escaped.
pub fn complain(what: &str, name: &str, side: Side) -> Option<Complaint> {
    let expected = if name.is_empty() {
        "a name"
    } else if name.contains(['\n', '\r', '\x0b', '\x0c']) {
        "no line break in a name"
    } else if name.starts_with('~') {
        "no ~ at the beginning of a name, which make takes for a home"
    } else if name.ends_with(')') && name.chars().skip(1).any(|c| c == '(') {
        "no bracket at the end of a name, which make takes for a member of an archive"
    } else if side == Side::Target && name.contains('%') && is_pattern(name) {
        "no % beside *, ? or [ in a name"
    } else if side == Side::Target && is_special(name) {
        "no name of capitals after a dot, which make takes for an order"
    } else if side == Side::Dependency && name.ends_with([' ', '\t']) {
        "no blank at the end of a name"
    } else {
        return None;
    };
    let cure = "rename it, or leave out the dependency file, which make could not read";
    Some(Complaint::new(what, expected, format!("{name:?}"), cure))
}

/// `targets: dependency`, escaped.
pub fn rule(targets: &[&str], dependency: Option<&str>) -> String {
    let targets: Vec<String> = targets.iter().map(|name| escape(name, Side::Target)).collect();
    let dependency = dependency.map(|name| {
        // Without something before it, make takes a name with an = for a variable, and these words
        // for the beginning or the end of one. The guards are empty, and nothing to ninja.
        let definition = matches!(name, "define" | "undefine");
        let guard = if definition || name.contains('=') { "$< $< " } else { "" };
        format!(" {guard}{}", escape(name, Side::Dependency))
    });
    format!("{}:{}\n", targets.join(" "), dependency.unwrap_or_default())
}

/// Whether the name is like that of a special target: `.PHONY`.
fn is_special(name: &str) -> bool {
    let capitals =
        |rest: &str| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_uppercase() || c == '_');
    name.strip_prefix('.').is_some_and(capitals)
}

/// Whether make looks for files that match the name.
fn is_pattern(name: &str) -> bool {
    name.contains(['*', '?', '['])
}

fn escape(name: &str, side: Side) -> String {
    let literal = if is_pattern(name) { escape_pattern(name) } else { name.to_owned() };
    let mut text = String::new();
    let (mut run, mut equals) = (0, false);
    for c in literal.chars() {
        if c == '\\' {
            run += 1;
            continue;
        }
        text.push_str(&escape_one(c, run, side, equals));
        equals |= c == '=';
        run = 0;
    }
    text + &escape_end(run, literal.ends_with('&'), side)
}

/// A pattern that nothing but the name itself matches, as long as there is such a file.
fn escape_pattern(name: &str) -> String {
    let literal =
        |c| if matches!(c, '\\' | '*' | '?' | '[') { format!("\\{c}") } else { String::from(c) };
    name.chars().map(literal).collect()
}

/// A character behind a run of backslashes; `equals` where an = came before. Backslashes count only
/// before a character that has a meaning: there, two stand for one.
fn escape_one(c: char, run: usize, side: Side, equals: bool) -> String {
    let as_they_are = "\\".repeat(run);
    let doubled = "\\".repeat(2 * run);
    let target = side == Side::Target;
    match c {
        ' ' | '#' | ':' => format!("{doubled}\\{c}"),
        '$' => format!("{as_they_are}$$"),
        '%' if target => format!("{doubled}\\%"),
        '|' if !target => format!("{doubled}\\|"),
        ';' => format!("{doubled}$(or \\;)"),
        '\t' if target => format!("{doubled}$(subst x,\\\t,x)"),
        '\t' => format!("{doubled}\\\t"),
        '=' if target => format!("{as_they_are}$(or =)"),
        // The first = ends make's search for one.
        '=' if !equals => format!("{doubled}="),
        _ => format!("{as_they_are}{c}"),
    }
}

/// The backslashes at the end of a name, and what keeps `&:` and a line's last backslash from
/// having a meaning.
fn escape_end(run: usize, ampersand: bool, side: Side) -> String {
    match side {
        Side::Target if ampersand => "$()".into(),
        Side::Target => "\\".repeat(2 * run),
        Side::Dependency if run % 2 == 1 => "\\".repeat(run) + "$()",
        Side::Dependency => "\\".repeat(run),
    }
}

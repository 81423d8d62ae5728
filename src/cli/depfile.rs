//! Dependency files in Make's syntax, for make, ninja, CMake and meson; with the flags that compilers have for them.

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

/// `targets: dependencies`, escaped.
pub fn rule(targets: &[&str], dependencies: &[&str]) -> String {
    let join = |names: &[&str]| names.iter().map(|name| escape(name)).collect::<Vec<_>>().join(" ");
    format!("{}: {}", join(targets), join(dependencies)).trim_end().to_owned() + "\n"
}

fn escape(name: &str) -> String {
    name.replace('\\', "\\\\").replace(' ', "\\ ").replace('#', "\\#").replace('$', "$$")
}

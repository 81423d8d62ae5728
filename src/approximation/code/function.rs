//! Functions and sums as text.

use super::dialect::Dialect;
use crate::lookup::Language;

/// A function.
pub struct Function<'a> {
    /// What it is.
    pub about: &'a str,
    /// Whether it is called from outside.
    pub public: bool,
    /// The type of what it returns.
    pub kind: &'a str,
    /// Its name.
    pub name: &'a str,
    /// Its parameters: name and type.
    pub parameters: &'a [(&'a str, &'a str)],
    /// Its lines.
    pub lines: Vec<String>,
}

impl Function<'_> {
    /// Its text.
    pub fn text(&self, dialect: &Dialect) -> String {
        let syntax = dialect.syntax;
        let Function { about, public, kind, name, parameters, lines } = self;
        let parameters: Vec<String> =
            parameters.iter().map(|(name, kind)| (syntax.parameter)(name, kind)).collect();
        let mut head = match *kind {
            "void" => format!("static inline void {name}({}) {{", parameters.join(", ")),
            kind => (syntax.function)(kind, name, &parameters.join(", ")),
        };
        let mut mark = "//";
        if dialect.language == Language::Rust {
            mark = "///";
            if !public {
                head = head.replacen("pub ", "", 1);
            }
            if name.to_lowercase() != *name {
                let attribute = "#[allow(non_snake_case, reason = \"it begins as you wished\")]";
                head = format!("{attribute}\n{head}");
            }
        }
        let end = lines.len().saturating_sub(1);
        let line = |(i, line): (usize, &String)| match line.strip_prefix("return ") {
            // In Rust the last expression is what a function returns.
            Some(value) if dialect.language == Language::Rust && i == end => {
                format!("    {}\n", value.trim_end_matches(';'))
            }
            _ => format!("    {line}\n"),
        };
        let lines: String = lines.iter().enumerate().map(line).collect();
        format!("{mark} {about}\n{head}\n{lines}}}")
    }
}

/// Σ term x^i by Horner's rule, in a variable: the lines before, and the last step as an
/// expression.
pub fn horner(variable: String, name: &str, terms: &[String], x: &str) -> (Vec<String>, String) {
    let [first, middle @ .., _] = terms else {
        return (Vec::new(), terms.concat());
    };
    let step = |term: &String| format!("{name} = {name} * {x} + {term};");
    let mut lines = vec![variable];
    lines.extend(middle.iter().rev().map(step));
    (lines, format!("{name} * {x} + {first}"))
}

/// Terms with plus signs, a line each.
pub fn sum(terms: &[String]) -> String {
    terms.join("\n        + ")
}

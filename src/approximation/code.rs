//! Code that looks E(F0) up in approximations: in shading languages, C and Rust. The numbers stand
//! in it.

mod channels;
mod dialect;
mod function;
mod functions;
mod numbers;
pub mod packing;
mod place;
mod results;
mod sums;

use super::{Approximation, Numbers, Region, Shape};
use crate::error::{Error, Result};
use crate::lookup::{Language, check_name};
use dialect::Dialect;
use function::Function;
use functions::Functions;
use packing::Packing;
use results::{ALBEDO, SCALE_BIAS, has_fresnel};

/// Code that looks E(F0) up in approximations: one, or one for each of several materials of
/// constant roughness.
///
/// Two channels give the functions `PREFIX_scale_bias`, of A and B, and `PREFIX_albedo`, of E(F0);
/// one channel gives the latter alone. They take n·v, the roughness where it is not constant, the
/// material where there are several, and F0 where the channels leave it free.
#[derive(Clone, Debug)]
pub struct Code<'a> {
    /// What it looks up; several are polynomials.
    pub approximations: &'a [Approximation],
    /// What begins all names.
    pub prefix: &'a str,
    /// What is said of the approximations, line by line.
    pub about: Vec<String>,
}

/// The numbers of an approximation as the code has them, in words of 32 bits, the lowest bits
/// first: number after number, and of each its channels side by side. They are floats by their
/// bits, or codes.
pub fn words(approximation: &Approximation) -> Vec<u32> {
    Packing::of(approximation).words()
}

impl Code<'_> {
    /// The code.
    ///
    /// # Errors
    ///
    /// [`Error::BadInput`] where the prefix is none, numbers do not fit their shape, or several
    /// approximations are not all polynomials.
    pub fn write(&self, language: Language) -> Result<String> {
        check_name("prefix", self.prefix)?;
        if self.prefix.ends_with('_') {
            return Err(refused(
                "prefix",
                "no underscore at its end, where one follows",
                self.prefix,
            ));
        }
        self.check()?;
        let dialect = dialect::of(language);
        let several = self.approximations.len() > 1;
        let functions = |(i, approximation)| Functions {
            dialect,
            approximation,
            packing: Packing::of(approximation),
            prefix: self.prefix,
            suffix: if several { format!("_{i}") } else { String::new() },
        };
        let padded: Vec<Approximation> = self.approximations.iter().map(padded).collect();
        let all: Vec<Functions> = padded.iter().enumerate().map(functions).collect();
        let mut parts = vec![self.heading(language)];
        parts.extend(self.shared(dialect, &all));
        for functions in &all {
            parts.push(functions.array());
            parts.push(functions.number());
            parts.extend(functions.helpers());
            parts.extend(functions.results(!several));
        }
        if several && all.iter().all(|one| one.packing.channels() > 1) {
            parts.push(dispatch(&all, SCALE_BIAS, &all[0].pair(), &|_| false));
        }
        if several {
            parts.push(dispatch(&all, ALBEDO, dialect.syntax.float, &|one| one.takes_f0()));
        }
        Ok(parts.join("\n\n") + "\n")
    }

    /// Refuses what has no code.
    fn check(&self) -> Result<()> {
        if self.approximations.is_empty() {
            return Err(refused("approximations", "one or several", "none"));
        }
        self.approximations.iter().try_for_each(check)?;
        if self.approximations.iter().any(|one| matches!(one.shape, Shape::Texture { .. })) {
            let cure = "write the texture with --table, and its lookup with splitsum lookup";
            return Err(Error::bad_input("code", "numbers that stand in it", "a texture", cure));
        }
        let is_line = |one: &Approximation| matches!(one.shape, Shape::Polynomial { .. });
        if self.approximations.len() > 1 && !self.approximations.iter().all(is_line) {
            return Err(refused("approximations", "polynomials of constant roughness", "others"));
        }
        Ok(())
    }

    /// What is said of all of it, as a comment, and what C needs.
    fn heading(&self, language: Language) -> String {
        let mut lines: Vec<String> =
            self.about.iter().map(|line| format!("// {line}").trim_end().to_owned()).collect();
        if self.approximations.iter().any(|one| has_fresnel(one.channels)) {
            lines.push("// F is Schlick's: F0 + (1 - F0) (1 - n.v)^5.".into());
        }
        match language {
            Language::Glsl => {
                lines.push("// ES takes it below `precision highp float;`.".into());
            }
            Language::C => {
                lines.push("\n#include <math.h>\n#include <stdint.h>".into());
            }
            _ => (),
        }
        lines.join("\n")
    }

    /// What all of them use.
    fn shared(&self, dialect: &'static Dialect, all: &[Functions]) -> Vec<String> {
        let mut parts = Vec::new();
        if dialect.language == Language::C && all.iter().any(|one| one.packing.channels() == 2) {
            parts.push(format!("typedef struct {{\n    float x, y;\n}} {};", all[0].pair()));
        }
        if self.approximations.iter().any(|one| has_fresnel(one.channels)) {
            let float = dialect.syntax.float;
            let one = dialect.number(1.0);
            let lines = vec![
                dialect.local(float, "c", &format!("{one} - {}", dialect.clamped("nov", 0.0, 1.0))),
                "return c * c * (c * c) * c;".into(),
            ];
            let name = format!("{}_grazing", self.prefix);
            let about = "(1 - n.v)^5";
            let parameters = &[("nov", float)];
            let function =
                Function { about, public: false, kind: float, name: &name, parameters, lines };
            parts.push(function.text(dialect));
        }
        parts
    }
}

/// A function that calls that of a material, the last where there is none of that number.
fn dispatch(
    all: &[Functions],
    (about, name): (&str, &str),
    kind: &str,
    takes_f0: &dyn Fn(&Functions) -> bool,
) -> String {
    let dialect = all[0].dialect;
    let (last, others) = (all.len() - 1, &all[..all.len() - 1]);
    let call = |one: &Functions| {
        let f0 = if takes_f0(one) { ", f0" } else { "" };
        format!("return {}(nov{f0});", one.name(name))
    };
    let condition = |i: usize| match dialect.language {
        Language::Rust => format!("material == {i}"),
        _ => format!("(material == {i})"),
    };
    let line = |(i, one)| format!("if {} {{ {} }}", condition(i), call(one));
    let mut lines: Vec<String> = others.iter().enumerate().map(line).collect();
    lines.push(call(&all[last]));
    let float = dialect.syntax.float;
    let mut parameters = vec![("nov", float), ("material", dialect.syntax.int)];
    parameters.extend(all.iter().any(takes_f0).then_some(("f0", float)));
    let name = format!("{}_{name}", all[0].prefix);
    let about = format!("{about} The material is one from 0 to {last}.");
    Function { about: &about, public: true, kind, name: &name, parameters: &parameters, lines }
        .text(dialect)
}

/// A constant as a polynomial with a second number, 0, so that its function uses n·v.
fn padded(approximation: &Approximation) -> Approximation {
    let mut padded = approximation.clone();
    if let Shape::Polynomial { .. } = padded.shape {
        let longest = padded.numbers.iter().map(Numbers::len).max();
        if let (Some(1), Some(Numbers::Floats(floats) | Numbers::Halves(floats))) =
            (longest, padded.numbers.first_mut())
        {
            floats.resize(2, 0.0);
        }
    }
    padded
}

/// A refusal.
fn refused(what: &str, expected: &str, got: &str) -> Error {
    Error::bad_input(what, expected, got, "make it anew")
}

/// Refuses numbers that do not fit their shape.
pub fn check(approximation: &Approximation) -> Result<()> {
    let Approximation { region, shape, numbers, channels, .. } = approximation;
    let Region { least_nov, roughness: [low, high] } = *region;
    let inside = |value: f64| (0.0..=1.0).contains(&value);
    if !(inside(low) && inside(high) && low <= high && inside(least_nov) && least_nov < 1.0) {
        return Err(refused("region", "n.v below 1 and roughness in [0, 1]", "others"));
    }
    let lengths = || numbers.iter().filter(|numbers| !numbers.is_empty()).map(Numbers::len);
    let longest = lengths().max().unwrap_or(0);
    let fits = match *shape {
        Shape::Polynomial { .. } => low == high,
        Shape::Surface { columns, .. } => {
            // A constant along a coordinate would not need it.
            let rows = longest.checked_div(columns).unwrap_or(0);
            columns > 1 && rows > 1 && lengths().all(|length| length.is_multiple_of(columns))
        }
        Shape::Spline { size: [columns, rows], degree, .. } => {
            let is_spline = (1..=3).contains(&degree) && columns.min(rows) > degree && low < high;
            is_spline && lengths().all(|length| length == columns * rows)
        }
        Shape::Texture { x, y, .. } => lengths().all(|length| length == x.size() * y.size()),
    };
    let finite = |numbers: &Numbers| match numbers {
        Numbers::Floats(floats) | Numbers::Halves(floats) => {
            floats.iter().all(|float| float.is_finite())
        }
        Numbers::Codes { offset, scale, .. } => offset.is_finite() && scale.is_finite(),
    };
    let any = numbers.len() == channels.count() && longest > 0;
    if fits && any && numbers.iter().all(finite) {
        return Ok(());
    }
    Err(refused("approximation", "finite numbers that fit its shape and its region", "others"))
}

//! Further functions for shaders: specular reflection that keeps its energy, and the reciprocal
//! factor of a diffuse base.

use super::fields::Field;
use super::{Language, Lookup, syntax};
use crate::choice::{Choice, choice};
use crate::error::{Error, Result};

/// A further function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// The albedo of a lobe scaled so that it loses nothing at F = 1: Turquin, "Practical multiple
    /// scattering compensation for microfacet models", 2019; Filament's is the same.
    Turquin,
    /// The albedo of a lobe with what its facets reflect more than once: Fdez-Agüera, "A
    /// Multiple-Scattering Microfacet Model for Real-Time Image Based Lighting", 2019.
    FdezAguera,
    /// The reciprocal factor of a diffuse base below the lobe (Kelemen and Szirmay-Kalos 2001).
    Diffuse,
}

choice!(Extra, "with", {
    Turquin = "turquin", "specular albedo that keeps its energy (Turquin 2019; Filament)";
    FdezAguera = "fdez-aguera", "specular albedo with multiple scattering (Fdez-Aguera 2019)";
    Diffuse = "diffuse", "the reciprocal factor of a diffuse base, of the split of energy";
});

impl Extra {
    /// The function in a language.
    pub(super) fn code(
        self,
        lookup: &Lookup,
        fields: &[Field],
        language: Language,
    ) -> Result<String> {
        let needed: &[&str] = match self {
            Extra::Turquin | Extra::FdezAguera => &["A", "B", "E"],
            Extra::Diffuse => &["R"],
        };
        let known = |name: &&str| fields.iter().any(|field| field.name == **name);
        if !needed.iter().all(known) {
            let got = fields.iter().map(|field| &*field.name).collect::<Vec<_>>().join(", ");
            let expected = format!("a table with {}", needed.join(", "));
            let cure = match self {
                Extra::Diffuse => "take one of --lut energy --channels split",
                Extra::Turquin | Extra::FdezAguera => "take one with --channels ab or be",
            };
            return Err(Error::bad_input(format!("with {}", self.word()), expected, got, cure));
        }
        Ok(match self {
            Extra::Turquin | Extra::FdezAguera => self.specular(lookup, language),
            Extra::Diffuse => diffuse(lookup, language),
        })
    }

    /// A function of the numbers and F0, a channel at a time.
    fn specular(self, lookup: &Lookup, language: Language) -> String {
        let (name, about, lines): (_, _, &[(&str, &str)]) = match self {
            Extra::FdezAguera => (
                "fdez_aguera",
                "The albedo at F0 with what facets reflect more than once (Fdez-Aguera 2019).",
                &[
                    ("single", "f0 * numbers.A + numbers.B"),
                    // 1/21 is the average of (1 - c)^5 over the hemisphere.
                    ("average", "f0 + (1.0 - f0) / 21.0"),
                    ("lost", "1.0 - numbers.E"),
                    ("", "single + single * average * lost / (1.0 - average * lost)"),
                ],
            ),
            _ => (
                "turquin",
                "The albedo at F0, scaled so that nothing is lost at F0 = 1 (Turquin 2019).",
                &[
                    ("single", "f0 * numbers.A + numbers.B"),
                    ("", "single * (1.0 + f0 * (1.0 / numbers.E - 1.0))"),
                ],
            ),
        };
        function(lookup, language, (name, about), &[("numbers", true), ("f0", false)], lines)
    }
}

/// The factor of a diffuse base for two directions: divided by pi it is the BRDF of a white one.
fn diffuse(lookup: &Lookup, language: Language) -> String {
    let about = "The factor of a diffuse base below the lobe, from the numbers at n.v and at n.l; \
                 times albedo/pi it is the BRDF (Kelemen and Szirmay-Kalos 2001).";
    let parameters = [("view", true), ("light", true)];
    function(lookup, language, ("diffuse", about), &parameters, &[("", "view.R * light.R")])
}

/// A function of floats and structs of numbers; the line without a name is what it returns.
fn function(
    lookup: &Lookup,
    language: Language,
    (name, about): (&str, &str),
    parameters: &[(&str, bool)],
    lines: &[(&str, &str)],
) -> String {
    let (name, numbers) = (format!("{}_{name}", lookup.prefix), lookup.numbers());
    let syntax = syntax::of(language);
    let mark = if language == Language::Rust { "///" } else { "//" };
    let parameter = |&(name, is_numbers): &(&str, bool)| {
        (syntax.parameter)(name, if is_numbers { &numbers } else { syntax.float })
    };
    let parameters = parameters.iter().map(parameter).collect::<Vec<_>>().join(", ");
    let head = (syntax.function)(syntax.float, &name, &parameters);
    let line = |&(name, value): &(&str, &str)| {
        let with_suffix = matches!(language, Language::C | Language::Msl);
        let value = if with_suffix { in_c(value) } else { value.to_owned() };
        match name {
            "" => format!("    return {value};\n"),
            name => format!("    {}\n", (syntax.local)(syntax.float, name, &value)),
        }
    };
    let lines: String = lines.iter().map(line).collect();
    format!("\n{mark} {about}\n{head}\n{lines}}}\n")
}

/// Numbers as floats of C, which are doubles without a suffix.
fn in_c(expression: &str) -> String {
    // The end of 21.0 too.
    expression.replace("1.0", "1.0f")
}

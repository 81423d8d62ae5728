//! Fresnel reflectance as a basis: F = Σ c_k w_k(v·h), where the coefficients c_k belong to a
//! material and the weights w_k to the model. Reflection is linear in F, so that a table of the
//! integrals of the weights serves every material. The exact equations have no finite basis: they
//! are one weight, F itself, with its numbers fixed.
//!
//! A model is a type that implements [`Basis`], in a file of its own, and a line in the lists
//! below.

mod conductor;
mod dielectric;
mod metals;
mod schlick;
mod schlick_f82;
mod schlick_power;

pub use conductor::{Conductor, conductor_reflectance};
pub use dielectric::{
    Dielectric, SMALLEST_ROOT, average_dielectric, dielectric_reflectance, reflectance_from,
};
pub use metals::{metal, names as metal_names};
pub use schlick::{Schlick, average_schlick, schlick_complement, schlick_weight, schlick_weights};
pub use schlick_f82::{SchlickF82, schlick_f82_weights};
pub use schlick_power::{SchlickPower, schlick_power_weights};

use crate::error::{Error, Result};
use crate::numeric::ball::Ball;
use crate::numeric::lanes::Real;
use crate::units::short;
use std::fmt;
use std::str::FromStr;

/// The most weights that a basis has: the components of a vector in WGSL.
pub const MOST_WEIGHTS: usize = 4;

/// A Fresnel model with N weights.
///
/// Where N is 2 or more, the first two weights add up to 1, and all but the first vanish at normal
/// incidence: the integrators take A = E - B from it, and the bounds of errors are sharper for what
/// vanishes.
pub trait Basis<const N: usize>: Copy + Send + Sync + 'static {
    /// Everything of it but the formulas.
    const DEFINITION: Definition;

    /// Its numbers, in the order of its words.
    fn arguments(self) -> Vec<f64> {
        Vec::new()
    }

    /// Where its numbers were measured, if they were.
    fn source(self) -> Option<String> {
        None
    }

    /// The error of every rule over that with Schlick's weights, at the most: measured by `splitsum
    /// chart bounds`.
    fn error_factor(self) -> f64 {
        1.0
    }

    /// Whether F changes faster at grazing incidence than rules resolve.
    fn has_layer(self) -> bool {
        false
    }

    /// What a device would need that it has not, if anything.
    fn obstacle_on_device(self) -> Option<&'static str> {
        None
    }

    /// The arguments of its WGSL function behind v·h.
    fn wgsl_arguments(self) -> String {
        String::new()
    }

    /// The weights at the cosine v·h.
    fn weights<R: Real>(self, vh: R) -> [R; N];

    /// The same at n·v = `mu` where the half vector is the normal, each with the bound of its
    /// error, which is a few of its own last digits for every `mu`.
    fn of_mirror(self, mu: f64) -> [Ball; N];
}

/// The properties of a Fresnel model besides its formulas.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Its word on the command line and in metadata.
    pub word: &'static str,
    /// The word with what follows it, as in `dielectric:IOR`.
    pub usage: &'static str,
    /// It in a line, with its source.
    pub about: &'static str,
    /// F, for the metadata.
    pub formula: &'static str,
    /// The albedo as a sum of the integrals, for the metadata.
    pub albedo: &'static str,
    /// The word of a table's channels that are all integrals: their letters.
    pub channels: &'static str,
    /// Whether the first weight is 1 less the second, and the others fifth and sixth powers of 1 -
    /// v·h: the rules over directions of light take A from E and B, and those of a distribution's
    /// own were measured with such weights alone.
    pub smooth_complement: bool,
    /// The integrals of the weights, in order.
    pub integrals: &'static [Integral],
    /// A module that defines `weights`, and that function's name.
    pub wgsl: (&'static str, &'static str),
}

/// The integral of a weight.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    /// Its letter.
    pub name: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
    /// The relative error of a rule in it over that in Schlick's B, at the most: measured by
    /// `splitsum chart bounds`. Of no account for the first one.
    pub relative_error: f64,
    /// What the rounding of v·h adds to its error.
    pub absolute_error: f64,
}

/// A Fresnel model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Schlick 1994.
    Schlick,
    /// Schlick 1994 with another exponent.
    SchlickPower(SchlickPower),
    /// Schlick 1994 with the F82 tint of metals (Kutz, Hašan and Edmondson 2021).
    SchlickF82,
    /// The exact equations of a dielectric.
    Dielectric(Dielectric),
    /// The exact equations of a conductor.
    Conductor(Conductor),
}

/// Evaluates an expression with the basis of a [`Fresnel`] as a value of its own type.
macro_rules! with_basis {
    ($fresnel:expr, $basis:ident => $work:expr) => {{
        use $crate::brdf::fresnel as models;
        match $fresnel {
            models::Fresnel::Schlick => {
                let $basis = models::Schlick;
                $work
            }
            models::Fresnel::SchlickF82 => {
                let $basis = models::SchlickF82;
                $work
            }
            models::Fresnel::SchlickPower($basis) => $work,
            models::Fresnel::Dielectric($basis) => $work,
            models::Fresnel::Conductor($basis) => $work,
        }
    }};
}
pub(crate) use with_basis;

/// Every kind of model, for help and errors.
pub const KINDS: [Definition; 5] = [
    Schlick::DEFINITION,
    SchlickPower::DEFINITION,
    SchlickF82::DEFINITION,
    Dielectric::DEFINITION,
    Conductor::DEFINITION,
];

impl Fresnel {
    /// Everything of it but the formulas.
    pub fn definition(self) -> Definition {
        with_basis!(self, basis => definition_of(basis))
    }

    /// The number of its weights, and so of the integrals of a table's texel.
    pub fn count(self) -> usize {
        with_basis!(self, basis => count_of(basis))
    }

    /// Every kind of model, with numbers at which rules err most: what bounds and tests go through.
    pub fn samples() -> Vec<Fresnel> {
        let power = |exponent| Fresnel::SchlickPower(SchlickPower { exponent });
        let dielectric = |ior| Fresnel::Dielectric(Dielectric { ior });
        let conductor = |n, k| Fresnel::Conductor(Conductor { n, k });
        vec![
            Fresnel::Schlick,
            power(1.0),
            power(2.5),
            power(20.0),
            Fresnel::SchlickF82,
            dielectric(1.000_000_001),
            dielectric(1.000_001),
            dielectric(1.0001),
            dielectric(1.001),
            dielectric(1.02),
            dielectric(1.05),
            dielectric(1.5),
            dielectric(4.0),
            dielectric(12.0),
            dielectric(100.0),
            conductor(0.05, 4.483),
            conductor(1.38, 1.914),
            conductor(0.01, 0.5),
            conductor(0.7, 0.5),
            conductor(20.0, 20.0),
        ]
    }

    /// Its numbers, in the order of its words.
    pub fn arguments(self) -> Vec<f64> {
        with_basis!(self, basis => basis.arguments())
    }

    /// The error of every rule over that with Schlick's weights, at the most.
    pub fn error_factor(self) -> f64 {
        with_basis!(self, basis => basis.error_factor())
    }

    /// Whether F changes faster at grazing incidence than rules resolve.
    pub fn has_layer(self) -> bool {
        with_basis!(self, basis => basis.has_layer())
    }

    /// What a device would need that it has not, if anything.
    pub fn obstacle_on_device(self) -> Option<&'static str> {
        with_basis!(self, basis => basis.obstacle_on_device())
    }

    /// The arguments of its WGSL function behind v·h.
    pub fn wgsl_arguments(self) -> String {
        with_basis!(self, basis => basis.wgsl_arguments())
    }

    /// F with its numbers and their source, for the metadata.
    pub fn formula(self) -> String {
        let formula = self.definition().formula;
        let source = with_basis!(self, basis => basis.source());
        match (self.arguments().is_empty(), source) {
            (true, _) => formula.to_owned(),
            (false, None) => format!("{formula}: {self}"),
            (false, Some(source)) => format!("{formula}: {self}, {source}"),
        }
    }

    /// The models of a list with commas between; a metal is three.
    pub fn list(words: &str) -> Result<Vec<Fresnel>> {
        let mut models: Vec<String> = Vec::new();
        for word in words.split(',').map(str::trim) {
            match models.last_mut() {
                // The second number of a conductor.
                Some(last) if word.parse::<f64>().is_ok() && lacks_k(last) => {
                    *last = format!("{last},{word}");
                }
                _ => models.push(word.to_owned()),
            }
        }
        let mut list = Vec::new();
        for model in &models {
            match model.strip_prefix("conductor:").and_then(metal) {
                Some(metal) => list.extend(metal.map(Fresnel::Conductor)),
                None => list.push(model.parse()?),
            }
        }
        Ok(list)
    }
}

/// Whether a word is a conductor with its n alone.
fn lacks_k(word: &str) -> bool {
    word.strip_prefix("conductor:").is_some_and(|n| n.parse::<f64>().is_ok())
}

impl fmt::Display for Fresnel {
    /// Its word, as in `dielectric:1.5`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let arguments: Vec<String> = self.arguments().into_iter().map(short).collect();
        let word = self.definition().word;
        if arguments.is_empty() {
            return f.pad(word);
        }
        f.pad(&format!("{word}:{}", arguments.join(",")))
    }
}

impl FromStr for Fresnel {
    type Err = Error;

    /// One model; a metal by name is three, and [`Fresnel::list`] reads it.
    fn from_str(text: &str) -> Result<Self> {
        let wrong = || {
            let usages = KINDS.map(|kind| kind.usage).join(", ");
            let expected = format!("{usages}, METAL being {}", metals::names());
            Error::bad_input("fresnel", expected, format!("'{text}'"), "use those words")
        };
        let (word, arguments) = match text.split_once(':') {
            None => (text, Vec::new()),
            Some((word, arguments)) => {
                let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
                (word, arguments.split(',').map(number).collect::<Result<Vec<f64>>>()?)
            }
        };
        match (word, &arguments[..]) {
            ("schlick", [] | [5.0]) => Ok(Fresnel::Schlick),
            ("schlick", &[exponent]) => SchlickPower::new(exponent).map(Fresnel::SchlickPower),
            ("f82", []) => Ok(Fresnel::SchlickF82),
            ("dielectric", &[ior]) => Dielectric::new(ior).map(Fresnel::Dielectric),
            ("conductor", &[n, k]) => Conductor::new(n, k).map(Fresnel::Conductor),
            _ => Err(wrong()),
        }
    }
}

fn definition_of<const N: usize, B: Basis<N>>(_: B) -> Definition {
    B::DEFINITION
}

fn count_of<const N: usize, B: Basis<N>>(_: B) -> usize {
    const { assert!(N >= 1 && N <= MOST_WEIGHTS && N == B::DEFINITION.integrals.len()) }
    N
}

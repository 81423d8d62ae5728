//! Fresnel reflectance as a basis: F = Σ c_k w_k(v·h), where the coefficients c_k belong to a
//! material and the weights w_k to the model. Reflection is linear in F, so that a table of the
//! integrals of the weights serves every material.
//!
//! A model is a type that implements [`Basis`], in a file of its own, and a line in the list below.

mod schlick;
mod schlick_f82;

pub use schlick::{Schlick, average_schlick, schlick_complement, schlick_weight, schlick_weights};
pub use schlick_f82::{SchlickF82, schlick_f82_weights};

use crate::choice::{Choice, choice};
use crate::numeric::lanes::{Number, Real};

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

    /// The weights at the cosine v·h.
    fn weights<R: Real>(self, vh: R) -> [R; N];

    /// The same at n·v = `mu` where the half vector is the normal, accurate to its last digits for
    /// every `mu`.
    fn of_mirror<R: Number>(self, mu: R) -> [R; N];
}

/// The properties of a Fresnel model besides its formulas.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Its word on the command line and in metadata.
    pub word: &'static str,
    /// It in a line, with its source.
    pub about: &'static str,
    /// F, for the metadata.
    pub formula: &'static str,
    /// The albedo as a sum of the integrals, for the metadata.
    pub albedo: &'static str,
    /// The word of a table's channels that are all integrals: their letters.
    pub channels: &'static str,
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
}

macro_rules! fresnel_models {
    ($d:tt $($(#[$about:meta])* $name:ident,)+) => {
        /// A Fresnel model.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Fresnel {
            $($(#[$about])* $name,)+
        }

        impl Choice for Fresnel {
            const WHAT: &'static str = "fresnel";
            const ALL: &'static [Self] = &[$(Fresnel::$name),+];

            fn word(self) -> &'static str {
                self.definition().word
            }

            fn about(self) -> &'static str {
                self.definition().about
            }
        }

        /// Evaluates an expression with the basis of a [`Fresnel`] as a value of its own type.
        macro_rules! with_basis {
            ($d fresnel:expr, $d basis:ident => $d work:expr) => {
                match $d fresnel {
                    $($crate::brdf::fresnel::Fresnel::$name => {
                        let $d basis = $crate::brdf::fresnel::$name;
                        $d work
                    })+
                }
            };
        }
        pub(crate) use with_basis;
    };
}

fresnel_models! { $
    /// Schlick 1994.
    Schlick,
    /// Schlick 1994 with the F82 tint of metals (Kutz, Hašan and Edmondson 2021).
    SchlickF82,
}

choice!(Fresnel);

impl Fresnel {
    /// Everything of it but the formulas.
    pub fn definition(self) -> Definition {
        with_basis!(self, basis => definition_of(basis))
    }

    /// The number of its weights, and so of the integrals of a table's texel.
    pub fn count(self) -> usize {
        with_basis!(self, basis => count_of(basis))
    }
}

fn definition_of<const N: usize, B: Basis<N>>(_: B) -> Definition {
    B::DEFINITION
}

fn count_of<const N: usize, B: Basis<N>>(_: B) -> usize {
    const { assert!(N >= 1 && N <= MOST_WEIGHTS && N == B::DEFINITION.integrals.len()) }
    N
}

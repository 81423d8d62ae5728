//! The cases that are mapped: formulas, methods of integration, ways of storing; each with its
//! failure and its cure.

use super::case::{Case, Kind};
use super::formulas::{formulas, roughness};
use super::ways::{GGX, METHODS, SUMS};
use super::{Family, Scale};
use crate::brdf::{Masking, Microfacet, Ndf};

const CHARLIE: Microfacet = Microfacet { ndf: Ndf::Charlie, masking: Masking::Neubelt };

/// Every case.
pub fn cases() -> Vec<Case> {
    let mut cases = formulas();
    cases.extend([sums(), methods(), storage_of_b(), storage_of_sheen()]);
    cases
}

fn sums() -> Case {
    Case {
        name: "sums of 65,536 samples",
        about: "Added one by one in f32, a sample is rounded to the last digit of the sum so far. \
                In blocks of 64, and blocks of blocks, what is rounded stays small.",
        x: Scale::with_zero("n·v", 1e-6, 1.0),
        y: Scale::new("roughness", 0.05, 1.0),
        fails: 1e-5,
        holds: 2e-6,
        kind: Kind::Tables(&SUMS),
    }
}

fn methods() -> Case {
    Case {
        name: "A and B",
        about: "The loop that engines ship divides 0 by 0 at n·v = 0, finds nothing where the lobe \
                is smooth, and at grazing angles most of its samples lie below the horizon; better \
                samplers cure the latter. Quadrature on a map that follows the lobe holds its \
                bound from corner to corner.",
        x: Scale::with_zero("n·v", 1e-6, 1.0),
        y: roughness(),
        fails: 0.1,
        holds: 3e-6,
        kind: Kind::Tables(&METHODS),
    }
}

fn storage_of_b() -> Case {
    Case {
        name: "storing B",
        about: "B spans ten decades. Eight bits keep nothing of it below 0.002, halves turn \
                subnormal below 6e-5 and 0 below 3e-8, and f32 keeps all of it; what counts for a \
                renderer is the absolute error, which the file states.",
        x: Scale::new("n·v", 1e-3, 1.0),
        y: roughness(),
        fails: 0.99,
        holds: 1e-7,
        kind: Kind::Storage(GGX, |value| value.b),
    }
}

fn storage_of_sheen() -> Case {
    Case {
        name: "storing Charlie's albedo",
        about: "Sheen's albedo has no limit as roughness falls: eight bits end at 1, halves at \
                65,504. A table whose values do not fit is refused, with the cure: --precision \
                f32, or --y roughness,min=X.",
        x: Scale::with_zero("n·v", 1e-6, 0.1),
        y: Scale::new("roughness", 1e-6, 1.0),
        fails: f64::INFINITY,
        holds: 1e-7,
        // Where it is next to nothing, what is lost of it does not count.
        kind: Kind::Storage(CHARLIE, |value| value.e().max(1e-3)),
    }
}

impl Case {
    /// The family of its maps on the CPU.
    pub fn family(&self) -> Family {
        match self.kind {
            Kind::Formula(_) => Family::Formulas,
            Kind::Tables(_) => Family::Methods,
            Kind::Storage(..) => Family::Storage,
        }
    }

    /// The tested claim, in words.
    pub fn claim(&self) -> String {
        let fails = if self.fails.is_finite() {
            format!("errs by at least {:e} somewhere", self.fails)
        } else {
            "yields a non-finite value somewhere".into()
        };
        format!("The first {fails}; the other by at most {:e} everywhere.", self.holds)
    }
}

//! How wrong E(F0) may be.

use crate::error::{Error, Result};

/// A tolerance of E(F0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The same everywhere.
    Absolute(f64),
    /// A share of E(F0) + 0.001: E(0) has zeros.
    Relative(f64),
    /// Steps of 8-bit sRGB in the radiance that is seen.
    Srgb {
        /// The number of steps.
        steps: f64,
        /// The radiance that arrives, 1 being white.
        radiance: f64,
        /// The radiance of a diffuse base, for radiance 1 that arrives.
        diffuse: f64,
    },
}

/// Added to the albedo that a share is taken of: three steps of 8-bit sRGB in the dark.
const LEAST: f64 = 1e-3;

/// Where the line through the step of sRGB at 0 touches the curve of its steps:
/// (1.055/12.92)^(12/7).
const TOUCHES: f64 = 0.013_640_8;

/// A step of 1 in the code of sRGB, from 0 to 1, in linear light (IEC 61966-2-1), or rather the
/// largest concave function below it: a step is the same up to linear light 0.003, and larger from
/// there on.
fn srgb_step(linear: f64) -> f64 {
    match linear < TOUCHES {
        true => (1.0 + 1.4 * linear / TOUCHES) / 12.92,
        false => 2.4 / 1.055 * linear.powf(1.0 - 1.0 / 2.4),
    }
}

impl Tolerance {
    /// Checks the numbers.
    pub fn checked(self) -> Result<Self> {
        let within = |number: f64, low: f64, high: f64| (low..=high).contains(&number);
        let (is_good, expected) = match self {
            Tolerance::Absolute(error) => (within(error, 1e-5, 0.5), "1e-5 to 0.5"),
            Tolerance::Relative(share) => (within(share, 1e-4, 0.5), "a share from 1e-4 to 0.5"),
            Tolerance::Srgb { steps, radiance, diffuse } => (
                within(steps, 0.1, 50.0)
                    && within(radiance, 1e-3, 1e3)
                    && within(diffuse, 0.0, 1.0),
                "0.1 to 50 steps at a radiance from 1e-3 to 1e3 over a diffuse one from 0 to 1",
            ),
        };
        if is_good {
            return Ok(self);
        }
        Err(Error::bad_input("tolerance", expected, self.to_string(), "give one in that range"))
    }

    /// The tolerance where E(F0) has this value: concave in it, so that an error which is linear in
    /// F0 is within it where it is so at both ends.
    pub fn at(self, albedo: f64) -> f64 {
        match self {
            Tolerance::Absolute(error) => error,
            Tolerance::Relative(share) => share * (albedo + LEAST),
            Tolerance::Srgb { steps, radiance, diffuse } => {
                // What is brighter than white is shown as white: its steps are those at white.
                let seen = (radiance * (albedo + diffuse)).min(1.0);
                steps / 255.0 * srgb_step(seen) / radiance
            }
        }
    }
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Tolerance::Absolute(error) => write!(f, "{error}"),
            Tolerance::Relative(share) => write!(f, "{share} of E(F0)"),
            Tolerance::Srgb { steps, radiance, diffuse } => {
                write!(f, "{steps} steps of 8-bit sRGB at radiance {radiance}")?;
                if *diffuse > 0.0 { write!(f, " over a diffuse base of {diffuse}") } else { Ok(()) }
            }
        }
    }
}

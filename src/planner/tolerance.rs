//! How wrong E(F0) may be.

use crate::error::{Error, Result};

/// A tolerance of E(F0).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// The same everywhere.
    Absolute(f64),
    /// A share of E(F0), which counts as at least 0.001: E(0) has zeros.
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

/// The least albedo that a share is taken of: three steps of 8-bit sRGB in the dark.
const LEAST: f64 = 1e-3;

/// The derivative of the code of sRGB, from 0 to 1, by linear light (IEC 61966-2-1).
fn srgb_slope(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 } else { 1.055 / 2.4 * linear.powf(1.0 / 2.4 - 1.0) }
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

    /// The tolerance where E(F0) has this value.
    pub fn at(self, albedo: f64) -> f64 {
        match self {
            Tolerance::Absolute(error) => error,
            Tolerance::Relative(share) => share * albedo.max(LEAST),
            Tolerance::Srgb { steps, radiance, diffuse } => {
                // What is brighter than white is shown as white: its steps are those at white.
                let seen = (radiance * (albedo + diffuse)).min(1.0);
                steps / (255.0 * srgb_slope(seen)) / radiance
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

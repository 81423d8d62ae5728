//! The report of a bake: a few lines for people, JSON for programs.

use crate::backend::device::DeviceInfo;
use crate::certify::deviation::Deviation;
use crate::table::claim::{Claim, Stage};
use std::fmt;

/// The backend that computed a table.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(tag = "kind", rename_all = "kebab-case"))]
pub enum Computed {
    /// The CPU, in f64.
    Cpu {
        /// Why not a device, where one was wanted.
        reason: Option<String>,
    },
    /// A Vulkan device, in f32.
    Vulkan {
        /// Which.
        device: DeviceInfo,
        /// Why a device, where there was a choice.
        reason: Option<String>,
        /// Seconds that its dispatches took, by its own clock; none where it has no clock.
        device_seconds: Option<f64>,
    },
}

/// The checks of a table that is not certified.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Checks {
    /// Evaluations of the integrand for a texel, on the average.
    pub evaluations: f64,
    /// The largest differences between a device and the CPU by the same rule in f64.
    pub cross_check: Option<Deviation>,
    /// The largest errors found against the double-exponential reference, in all slices by the
    /// same rule with the same bound.
    pub measured: Deviation,
    /// The names of the integrals.
    pub integrals: Vec<&'static str>,
    /// The largest error that storing a value in [0, 1] adds.
    pub rounding: f64,
}

/// Seconds of wall time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Seconds {
    /// Integrating: on a device with compilation and transfer, on the CPU with certification.
    pub integrate: f64,
    /// Certifying a device's table, or cross-checking and measuring.
    pub check: f64,
}

/// The report of a part of a slice.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Report {
    /// The command that repeats the bake of the whole table.
    pub command: String,
    /// The slice, as in `F0 = 0.04`; none of a table over two axes.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub slice: Option<String>,
    /// The channels that it is about, where others are integrated from another lobe.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub channels: Option<String>,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Columns and rows that hold the value at their axis's min or max instead of their own.
    pub clamped: [usize; 2],
    /// The backend.
    pub computed: Computed,
    /// The claim, as the file states it too.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub claim: Claim,
    /// The stages of a certification, one after the other.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub stages: Vec<Stage>,
    /// The checks of a table that is not certified.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub checks: Option<Checks>,
    /// The time that it took.
    pub seconds: Seconds,
}

impl fmt::Display for Computed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Computed::Cpu { .. } => f.write_str("CPU, f64"),
            Computed::Vulkan { device, .. } => {
                write!(f, "Vulkan, f32: {} ({})", device.name, device.driver)
            }
        }
    }
}

impl Report {
    /// The claim and its grounds in lines.
    fn write_claim(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.claim {
            Claim::Certificate(certificate) => {
                writeln!(f, "certified {}", certificate.promise)?;
                for Stage { by, error, texels, decided, .. } in &self.stages {
                    let decided = decided.map_or(String::new(), |decided| format!("{decided} of "));
                    let within = error.map_or("which has no bound there".into(), |error| {
                        format!("within {:.1e}", error.largest)
                    });
                    writeln!(f, "          {decided}{texels} texels by {by}, {within}")?;
                }
                if let Some(distance) = certificate.smallest_distance {
                    writeln!(
                        f,
                        "          the nearest is {distance:.1e} from a boundary of rounding"
                    )?;
                }
                writeln!(f, "blake3    {}", certificate.blake3)
            }
            Claim::Fitted { filter, .. } => writeln!(f, "fitted    {filter}; not certified"),
            Claim::Estimated { estimator, .. } => {
                writeln!(f, "estimator {estimator}; not certified")?;
                self.checks.iter().try_for_each(|checks| write!(f, "{checks}"))
            }
            Claim::Uncertified { rule, error_bound, .. } => {
                writeln!(f, "rule      {rule}; not certified, error at most {error_bound:.1e}")?;
                self.checks.iter().try_for_each(|checks| write!(f, "{checks}"))
            }
        }
    }
}

impl fmt::Display for Checks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Checks { evaluations, cross_check, measured, integrals, rounding } = self;
        writeln!(f, "cost      {evaluations:.0} evaluations for a texel")?;
        if let Some(check) = cross_check {
            let (points, largest) = (check.points, check.max());
            writeln!(
                f,
                "checked   by the CPU at {points} points: largest difference {largest:.1e}"
            )?;
        }
        let (points, errors) = (measured.points, measured.in_words(integrals));
        writeln!(f, "measured  at {points} points against the reference: {errors}")?;
        writeln!(f, "rounding  adds at most {rounding:.1e} in the file")
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(f, "computed  by {}", self.computed)?;
        match &self.computed {
            Computed::Cpu { reason: None } | Computed::Vulkan { reason: None, .. } => writeln!(f)?,
            Computed::Cpu { reason: Some(reason) } => writeln!(f, "; not on Vulkan: {reason}")?,
            Computed::Vulkan { reason: Some(reason), .. } => writeln!(f, "; {reason}")?,
        }
        self.write_claim(f)?;
        let [columns, rows] = self.clamped;
        if columns + rows > 0 {
            writeln!(
                f,
                "clamped   {columns} columns and {rows} rows to the min or max of an axis"
            )?;
        }
        let Seconds { integrate, check } = self.seconds;
        let each = 1e6 * integrate / (width * height) as f64;
        write!(
            f,
            "time      {:.1} ms, {each:.2} µs for a texel; checks {:.1} ms",
            1e3 * integrate,
            1e3 * check
        )?;
        if let Computed::Vulkan { device_seconds: Some(seconds), .. } = &self.computed {
            write!(f, "; of the former {:.2} ms on the device", 1e3 * seconds)?;
        }
        Ok(())
    }
}

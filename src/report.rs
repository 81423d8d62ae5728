//! What is said of a bake: for people a few lines, for programs JSON; and pictures of numbers.

pub mod map;

use crate::backend::vulkan::devices::DeviceInfo;
use crate::certificate::{Certificate, Stage};
use crate::certify::deviation::Deviation;
use serde::Serialize;
use std::fmt;

/// Who computed a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
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

/// What the numbers of a table that is not certified are worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// The rule that integrated.
    pub rule: &'static str,
    /// Evaluations of the integrand for a texel, on the average.
    pub evaluations: f64,
    /// The largest error of a value before it is stored, by the rule, the arithmetic, averages and the channel's
    /// formula; of values above 1 relative.
    pub bound: f64,
    /// How far a device was from the CPU, by the same rule in f64.
    pub cross_check: Option<Deviation>,
    /// The largest error found against the double-exponential reference.
    pub measured: Deviation,
    /// The largest error that storing a value in [0, 1] adds.
    pub rounding: f64,
}

/// What the numbers of a table are worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Worth {
    /// They are certified one by one.
    Certified {
        /// What the file says too.
        certificate: Certificate,
        /// How it was come by.
        stages: Vec<Stage>,
    },
    /// They are not.
    Uncertified {
        /// What is known instead.
        accuracy: Accuracy,
    },
}

/// Seconds of wall time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Integrating: on a device with compilation and transfer, on the CPU with certification.
    pub integrate: f64,
    /// Certifying a device's table, or cross-checking and measuring.
    pub check: f64,
}

/// What is said of a bake.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The command that repeats it.
    pub command: String,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Columns and rows that hold the value at their axis's min instead of their own.
    pub clamped: [usize; 2],
    /// Who computed it.
    pub computed: Computed,
    /// What its numbers are worth.
    #[serde(flatten)]
    pub worth: Worth,
    /// How long it took.
    pub seconds: Seconds,
}

impl Report {
    /// The certificate, if there is one.
    pub fn certificate(&self) -> Option<&Certificate> {
        match &self.worth {
            Worth::Certified { certificate, .. } => Some(certificate),
            Worth::Uncertified { .. } => None,
        }
    }
}

impl fmt::Display for Computed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Computed::Cpu { .. } => f.write_str("CPU, f64"),
            Computed::Vulkan { device, .. } => write!(f, "Vulkan, f32: {} ({})", device.name, device.driver),
        }
    }
}

impl fmt::Display for Worth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Worth::Certified { certificate, stages } => {
                writeln!(f, "certified {}", certificate.promise)?;
                for Stage { by, error_of_a, texels, decided, .. } in stages {
                    let share = decided.map_or(String::new(), |decided| format!("{decided} of "));
                    writeln!(f, "          {share}{texels} texels by {by}, within {error_of_a:.1e}")?;
                }
                if let Some(distance) = certificate.smallest_distance {
                    writeln!(f, "          the nearest is {distance:.1e} from a boundary of rounding")?;
                }
                write!(f, "blake3    {}", certificate.blake3)
            }
            Worth::Uncertified { accuracy } => {
                let Accuracy { rule, evaluations, bound, cross_check, measured, rounding } = accuracy;
                if let Some(Deviation { texels, .. }) = cross_check {
                    let largest = cross_check.map_or(0.0, |deviation| deviation.largest());
                    writeln!(f, "checked   by the CPU at {texels} texels: largest difference {largest:.1e}")?;
                }
                writeln!(f, "rule      {rule}: {evaluations:.0} evaluations for a texel; not certified")?;
                let Deviation { a, b, texels } = measured;
                writeln!(f, "error     at most {bound:.1e}; measured at {texels} texels: A {a:.1e}, B {b:.1e}")?;
                write!(f, "rounding  at most {rounding:.1e} more, in the file")
            }
        }
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
        writeln!(f, "{}", self.worth)?;
        let [columns, rows] = self.clamped;
        if columns + rows > 0 {
            writeln!(f, "clamped   {columns} columns and {rows} rows to the min of their axes")?;
        }
        let Seconds { integrate, check } = self.seconds;
        let each = 1e6 * integrate / (width * height) as f64;
        write!(f, "time      {:.1} ms, {each:.2} µs for a texel; checks {:.1} ms", 1e3 * integrate, 1e3 * check)?;
        if let Computed::Vulkan { device_seconds: Some(seconds), .. } = &self.computed {
            write!(f, "; of the former {:.2} ms on the device", 1e3 * seconds)?;
        }
        Ok(())
    }
}

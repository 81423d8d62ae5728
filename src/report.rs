//! What is said of a bake: for people a few lines, for programs JSON; and pictures of numbers.

pub mod map;

use crate::backend::vulkan::devices::DeviceInfo;
use crate::certify::Deviation;
use crate::integrate::rule::Rule;
use crate::request::Request;
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
        /// How far it was from the CPU, by the same rule in f64.
        cross_check: Deviation,
    },
}

/// What a table's numbers are worth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// The rule that integrated.
    pub rule: &'static str,
    /// Evaluations of the integrand for a texel; `None` for the reference.
    pub evaluations: Option<usize>,
    /// The largest absolute error of A and of B: that of the rule and of the arithmetic.
    pub bound: f64,
    /// The largest error found against the double-exponential reference.
    pub measured: Deviation,
    /// The largest error that storing a value in [0, 1] adds.
    pub rounding: f64,
}

/// Seconds of wall time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Integrating, on a device with compilation and transfer.
    pub integrate: f64,
    /// Cross-checking and measuring.
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
    pub accuracy: Accuracy,
    /// How long it took.
    pub seconds: Seconds,
}

impl Accuracy {
    /// Of a table by `rule` with an arithmetic of that error.
    pub fn new(request: &Request, rule: &Rule, arithmetic: f64, measured: Deviation) -> Self {
        let integrand = request.lut.integrand();
        Accuracy {
            rule: rule.name,
            evaluations: rule.evaluations(),
            bound: rule.bound(integrand) + arithmetic,
            measured,
            rounding: request.precision.half_step(),
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

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        write!(f, "computed  by {}", self.computed)?;
        match &self.computed {
            Computed::Cpu { reason: None } => writeln!(f)?,
            Computed::Cpu { reason: Some(reason) } => writeln!(f, "; not on Vulkan: {reason}")?,
            Computed::Vulkan { cross_check, .. } => {
                let (texels, largest) = (cross_check.texels, cross_check.largest());
                writeln!(f, "\nchecked   by the CPU at {texels} texels: largest difference {largest:.1e}")?;
            }
        }
        let Accuracy { rule, evaluations, bound, measured, rounding } = &self.accuracy;
        let evaluations = evaluations.map_or("double exponential".into(), |n| format!("{n} evaluations for a texel"));
        writeln!(f, "rule      {rule}: {evaluations}")?;
        let Deviation { a, b, texels } = measured;
        writeln!(f, "error     at most {bound:.1e}; measured at {texels} texels: A {a:.1e}, B {b:.1e}")?;
        writeln!(f, "rounding  at most {rounding:.1e} more, in the file")?;
        let [columns, rows] = self.clamped;
        if columns + rows > 0 {
            writeln!(f, "clamped   {columns} columns and {rows} rows to the min of their axes")?;
        }
        let Seconds { integrate, check } = self.seconds;
        let each = 1e6 * integrate / (width * height) as f64;
        write!(f, "time      {:.1} ms, {each:.2} µs for a texel; checks {:.1} ms", 1e3 * integrate, 1e3 * check)
    }
}

//! Studies of methods: errors beside times, on the machine at hand; and failures of formulas.

pub mod bounds;
pub mod lookup;
pub mod size;
pub mod speed;
pub mod stability;
pub mod worst;

use crate::backend::device::DeviceInfo;
use crate::brdf::{Masking, Microfacet, Ndf};
use crate::choice::Choice;
use crate::integrate::ScaleBias;
use crate::table::precision::Precision;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The machine that measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub processor: String,
    /// Its threads.
    pub threads: usize,
    /// Names and drivers of the Vulkan devices, in the order in which they were measured.
    pub devices: Vec<Device>,
    /// The version of splitsum.
    pub version: String,
}

/// A Vulkan device as a study names it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Device {
    /// Its name.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
}

/// The lobe that was studied.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lobe {
    /// Its distribution of normals.
    pub model: Ndf,
    /// Its masking.
    pub masking: Masking,
}

/// Told what share of the work, out of 1, is done.
pub type Share<'a> = &'a dyn Fn(f64);

impl From<Microfacet> for Lobe {
    fn from(Microfacet { ndf, masking }: Microfacet) -> Self {
        Lobe { model: ndf, masking }
    }
}

impl From<Lobe> for Microfacet {
    fn from(Lobe { model, masking }: Lobe) -> Self {
        Microfacet { ndf: model, masking }
    }
}

impl fmt::Display for Lobe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.model.word(), self.masking.word())
    }
}

impl Machine {
    /// The processor's name in the text of Linux's /proc/cpuinfo.
    pub fn processor_in(cpuinfo: &str) -> Option<&str> {
        cpuinfo.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1))
    }
}

impl From<&DeviceInfo> for Device {
    fn from(info: &DeviceInfo) -> Self {
        Device { name: info.name.clone(), driver: info.driver.clone() }
    }
}

/// How far (A, B) are from the truth: the largest error and the root of the mean square, of A and
/// of B. Absolute, but of albedos above 1 relative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// The largest of A and of B.
    pub max: [f64; 2],
    /// The root of the mean square of A and of B.
    pub rms: [f64; 2],
}

impl Errors {
    /// Of values against the truth, pair by pair; what is no finite number makes the largest
    /// f64::MAX, which JSON can hold.
    pub fn between(pairs: impl IntoIterator<Item = (ScaleBias, ScaleBias)>) -> Self {
        let (mut max, mut squares, mut count) = ([0.0f64; 2], [0.0; 2], 0.0f64);
        for (value, truth) in pairs {
            let scale = truth.e().max(1.0);
            for (i, (value, truth)) in
                [(value.a, truth.a), (value.b, truth.b)].into_iter().enumerate()
            {
                let error = ((value - truth) / scale).abs();
                let error = if error.is_finite() { error } else { f64::MAX };
                max[i] = max[i].max(error);
                squares[i] = (squares[i] + error * error).min(f64::MAX);
            }
            count += 1.0;
        }
        Errors { max, rms: squares.map(|sum| (sum / count.max(1.0)).sqrt()) }
    }

    /// The larger of the two largest.
    pub fn largest(&self) -> f64 {
        self.max[0].max(self.max[1])
    }
}

/// Values as they are stored.
fn stored(values: &[ScaleBias], precision: Precision) -> Vec<ScaleBias> {
    let (low, high) = precision.range();
    let store = |value: f64| precision.nearest(value.clamp(low, high));
    values.iter().map(|v| v.array().map(store).into()).collect()
}

/// The value in the middle; NaN where there is none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The result of some work, and the seconds it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = std::time::Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

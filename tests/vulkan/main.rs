//! Tests on Vulkan devices: each runs on every device found. Without a device each is reported as
//! ignored, with the reason; where SPLITSUM_REQUIRE_VULKAN is set, that is a failure instead.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

#[path = "../approximation_code/cases.rs"]
mod approximation_cases;
mod approximations;
mod certified;
#[path = "../common/mod.rs"]
mod common;
mod faults;
mod glass;
mod glass_twins;
mod model_twins;
mod previews;
mod sampling_twins;
mod stability;
mod tables;
mod twins;

use common::{VULKAN, missing};
use libtest_mimic::{Arguments, Failed, Trial};
use splitsum::backend::device::{DeviceInfo, GpuOptions};
use splitsum::backend::{Gpu, list_devices};

/// A test of a device.
type DeviceTest = (&'static str, fn(&Gpu) -> Result<(), Failed>);

fn on(device: &DeviceInfo, (name, test): DeviceTest) -> Trial {
    let options = GpuOptions { device: Some(device.uuid.clone()), ..GpuOptions::default() };
    Trial::test(format!("{}: {name}", device.name), move || test(&Gpu::open(&options)?))
}

fn main() {
    let mut arguments = Arguments::from_args();
    // The tests use every core themselves, and loaders are not at their best when many threads open
    // devices.
    arguments.test_threads = Some(1);
    let tests: Vec<DeviceTest> = [
        twins::TESTS,
        glass::TESTS,
        glass_twins::TESTS,
        sampling_twins::TESTS,
        stability::TESTS,
        tables::TESTS,
        certified::TESTS,
        previews::TESTS,
        approximations::TESTS,
    ]
    .concat();
    let mut trials: Vec<Trial> = match list_devices() {
        Ok(devices) if !devices.is_empty() => {
            devices.iter().flat_map(|device| tests.iter().map(|&test| on(device, test))).collect()
        }
        outcome => {
            let reason = outcome.err().map_or("no Vulkan device".into(), |error| error.to_string());
            tests
                .iter()
                .map(|(name, _)| missing(VULKAN, format!("no device: {name}"), reason.clone()))
                .collect()
        }
    };
    trials.extend(tables::validated());
    trials.extend(faults::trials());
    libtest_mimic::run(&arguments, trials).exit();
}

//! `splitsum devices`

use crate::backend::device::DeviceInfo;
use crate::backend::list_devices;
use crate::error::{Complaint, Error, Result};

#[derive(clap::Args)]
pub struct DevicesArgs {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &DevicesArgs) -> Result<()> {
    let devices = list_devices()?;
    if devices.is_empty() {
        let cure = "install a driver; bakes run on the CPU without one";
        return Err(Error::NoDevice(Complaint::new(
            "Vulkan devices",
            "at least one",
            "none",
            cure,
        )));
    }
    if arguments.json {
        return super::print_json(&devices);
    }
    super::print(&devices.iter().map(describe).collect::<Vec<_>>().join("\n"))
}

fn describe(device: &DeviceInfo) -> String {
    let DeviceInfo { name, kind, uuid, driver, api, unusable } = device;
    let unusable =
        unusable.as_ref().map(|reason| format!("\n  unusable: {reason}")).unwrap_or_default();
    format!("{name}\n  {kind}, UUID {uuid}\n  driver {driver}, Vulkan {api}{unusable}")
}

//! The flags that choose a backend.

use super::{choices, resources, usage};
use crate::backend::device::GpuOptions;
use crate::backend::{Backend, BackendChoice};
use crate::error::Result;

/// The backend of a command.
#[derive(clap::Args)]
pub struct DeviceArgs {
    /// Backend
    #[arg(
        long, value_name = "NAME", default_value = "auto",
        value_parser = choices::of::<BackendChoice>()
    )]
    backend: BackendChoice,
    /// Vulkan device, by UUID or a part of its name that no other has [default: discrete,
    /// integrated, virtual, software]
    #[arg(long, value_name = "NAME|UUID")]
    device: Option<String>,
}

impl DeviceArgs {
    /// Opens the backend for work that takes `bytes`, with these options besides the device.
    pub fn open(&self, options: GpuOptions, bytes: u64) -> Result<Backend> {
        let options = GpuOptions { device: self.device.clone(), ..options };
        let GpuOptions { device, validate, tile } = &options;
        let of_device =
            [(device.is_some(), "--device"), (*validate, "--validate"), (tile.is_some(), "--tile")];
        if let (BackendChoice::Cpu, Some((_, flag))) =
            (self.backend, of_device.iter().find(|(given, _)| *given))
        {
            let cure = "leave it out, or choose --backend vulkan";
            return Err(usage("--backend cpu", "no flag of a device", flag, cure));
        }
        resources::open_backend(self.backend, &options, bytes)
    }
}

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
        if self.backend == BackendChoice::Cpu && options != GpuOptions::default() {
            let cure = "leave out the flags of a device, or choose --backend vulkan";
            return Err(usage("--backend cpu", "flags of the CPU", "flags of a device", cure));
        }
        resources::open_backend(self.backend, &options, bytes)
    }
}

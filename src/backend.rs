//! The backends: the CPU in f64, or a Vulkan device in f32. They see parameters and give numbers;
//! they know no files.

#[cfg(not(feature = "vulkan"))]
mod absent;
pub mod cpu;
pub mod device;
#[cfg(feature = "vulkan")]
pub mod vulkan;
#[cfg(feature = "vulkan")]
pub mod wgsl;

#[cfg(not(feature = "vulkan"))]
pub use absent::{Gpu, bake, bake_glass, list_devices};
#[cfg(feature = "vulkan")]
pub use vulkan::{bake::bake, bake::bake_glass, devices::list_devices, gpu::Gpu};

use crate::choice::choice;
use crate::error::{Complaint, Error, Result};
use device::GpuOptions;
use std::cell::OnceCell;

/// The backend that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// Vulkan where a device can do the work and the work pays for starting it, else the CPU.
    #[default]
    Auto,
    /// Vulkan or an error.
    Vulkan,
    /// The CPU.
    Cpu,
}

choice!(BackendChoice, "backend", {
    Auto = "auto", "Vulkan where a device can do the work and it pays, else the CPU";
    Vulkan = "vulkan", "Vulkan or an error";
    Cpu = "cpu", "the CPU";
});

/// Seconds that it takes to start Vulkan and to end it: loader, driver, device and the compilation
/// of a kernel. A process that bakes 64 x 64 texels takes 0.22 s on an NVIDIA H100 (driver
/// 580.159.04) and 0.014 s on that machine's CPU; software drivers start in 0.03 s.
pub const VULKAN_START: f64 = 0.2;

/// A backend: the CPU, or a device that is opened when a job is large enough for it.
#[derive(Debug)]
pub struct Backend {
    choice: BackendChoice,
    options: GpuOptions,
    /// The device, or the reason why there is none.
    gpu: OnceCell<std::result::Result<Gpu, String>>,
}

/// The backend of a job, and the reason where there was a choice.
#[derive(Clone, Debug)]
pub struct Chosen<'a> {
    /// The device; none for the CPU.
    pub gpu: Option<&'a Gpu>,
    /// The reason.
    pub reason: Option<String>,
}

impl Backend {
    /// The CPU.
    pub fn cpu() -> Self {
        Backend { choice: BackendChoice::Cpu, options: GpuOptions::default(), gpu: OnceCell::new() }
    }

    /// The backend that is asked for. An error where there is no device and
    /// [`BackendChoice::Vulkan`] or a device by name is asked for.
    pub fn open(choice: BackendChoice, options: &GpuOptions) -> Result<Self> {
        let backend = Backend { choice, options: options.clone(), gpu: OnceCell::new() };
        if choice == BackendChoice::Vulkan || options.device.is_some() {
            let _ = backend.gpu.set(Ok(Gpu::open(options)?));
        }
        Ok(backend)
    }

    /// Chooses the backend of a job. `obstacle`: why a device cannot do it, if it cannot; `saved`:
    /// CPU seconds that a device would save. An error if the job needs the CPU and
    /// [`BackendChoice::Vulkan`] is asked for.
    pub fn choose(&self, obstacle: Option<Complaint>, saved: f64) -> Result<Chosen<'_>> {
        let on_cpu = |reason| Ok(Chosen { gpu: None, reason });
        let (saved_ms, start_ms) = (1e3 * saved, 1e3 * VULKAN_START);
        match (self.choice, obstacle) {
            (BackendChoice::Cpu, _) => on_cpu(None),
            (BackendChoice::Vulkan, Some(complaint)) => Err(Error::BadInput(complaint)),
            (BackendChoice::Auto, Some(complaint)) => on_cpu(Some(complaint.to_string())),
            // Who asks for a device, or says how it is to work, wants one.
            (BackendChoice::Auto, None)
                if self.options == GpuOptions::default() && saved <= VULKAN_START =>
            {
                on_cpu(Some(format!(
                    "a device would save {saved_ms:.1} ms of the CPU's work, and starting one \
                     takes {start_ms:.0} ms"
                )))
            }
            (choice, None) => match self.open_device() {
                Ok(gpu) if choice == BackendChoice::Vulkan => {
                    Ok(Chosen { gpu: Some(gpu), reason: None })
                }
                Ok(gpu) => {
                    let reason = format!(
                        "it saves {saved_ms:.0} ms of the CPU's work, and starting it takes \
                         {start_ms:.0} ms"
                    );
                    Ok(Chosen { gpu: Some(gpu), reason: Some(reason) })
                }
                Err(reason) => on_cpu(Some(reason.clone())),
            },
        }
    }

    /// The device, unless the CPU is asked for or there is none.
    pub fn device(&self) -> Option<&Gpu> {
        if self.choice == BackendChoice::Cpu { None } else { self.open_device().as_ref().ok() }
    }

    fn open_device(&self) -> &std::result::Result<Gpu, String> {
        self.gpu.get_or_init(|| Gpu::open(&self.options).map_err(|error| error.to_string()))
    }
}

/// Told the number of texels that are newly done, from any thread.
pub type Progress<'a> = &'a (dyn Fn(usize) + Sync);

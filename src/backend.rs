//! Who computes: the CPU in f64, or a Vulkan device in f32. Backends see parameters and give numbers; they know no files.

pub mod cpu;
pub mod rows;
pub mod shader;
pub mod vulkan;

use crate::error::{Complaint, Error, Result};
use std::cell::OnceCell;
use std::str::FromStr;
use vulkan::gpu::{Gpu, GpuOptions};

/// Which backend is asked for.
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

/// Seconds that it takes to start Vulkan: loader, driver, device and the compilation of a kernel.
pub const VULKAN_START: f64 = 0.03;

/// A backend: the CPU, or a device that is opened when a job is large enough for it.
#[derive(Debug)]
pub struct Backend {
    choice: BackendChoice,
    options: GpuOptions,
    /// Or why there is none.
    gpu: OnceCell<std::result::Result<Gpu, String>>,
}

/// Who does a job, and why, where there was a choice.
#[derive(Debug)]
pub struct Chosen<'a> {
    /// The device; `None` computes on the CPU.
    pub gpu: Option<&'a Gpu>,
    /// Why.
    pub reason: Option<String>,
}

impl Backend {
    /// The CPU.
    pub fn cpu() -> Self {
        Backend { choice: BackendChoice::Cpu, options: GpuOptions::default(), gpu: OnceCell::new() }
    }

    /// What is asked for; [`BackendChoice::Vulkan`] fails for want of a device, and so does a device that is named.
    pub fn open(choice: BackendChoice, options: &GpuOptions) -> Result<Self> {
        let backend = Backend { choice, options: options.clone(), gpu: OnceCell::new() };
        if choice == BackendChoice::Vulkan || options.device.is_some() {
            let _ = backend.gpu.set(Ok(Gpu::open(options)?));
        }
        Ok(backend)
    }

    /// Who does a job that a device may be unable to do, `obstacle` saying why, and in which it saves the CPU so many seconds. An
    /// error if the CPU is ruled out.
    pub fn choose(&self, obstacle: Option<Complaint>, saved: f64) -> Result<Chosen<'_>> {
        let on_cpu = |reason| Ok(Chosen { gpu: None, reason });
        let (saved_ms, start_ms) = (1e3 * saved, 1e3 * VULKAN_START);
        match (self.choice, obstacle) {
            (BackendChoice::Cpu, _) => on_cpu(None),
            (BackendChoice::Vulkan, Some(complaint)) => Err(Error::BadInput(complaint)),
            (BackendChoice::Auto, Some(complaint)) => on_cpu(Some(complaint.to_string())),
            // Whoever asks for a device, or how it is to work, wants one.
            (BackendChoice::Auto, None) if self.options == GpuOptions::default() && saved <= VULKAN_START => {
                on_cpu(Some(format!(
                    "a device would save {saved_ms:.1} ms of the CPU's work, and starting one takes {start_ms:.0} ms"
                )))
            }
            (choice, None) => match self.open_device() {
                Ok(gpu) if choice == BackendChoice::Vulkan => Ok(Chosen { gpu: Some(gpu), reason: None }),
                Ok(gpu) => {
                    let reason =
                        format!("it saves {saved_ms:.0} ms of the CPU's work, and starting it takes {start_ms:.0} ms");
                    Ok(Chosen { gpu: Some(gpu), reason: Some(reason) })
                }
                Err(reason) => on_cpu(Some(reason.clone())),
            },
        }
    }

    /// The device, if there is to be one.
    pub fn device(&self) -> Option<&Gpu> {
        if self.choice == BackendChoice::Cpu { None } else { self.open_device().as_ref().ok() }
    }

    fn open_device(&self) -> &std::result::Result<Gpu, String> {
        self.gpu.get_or_init(|| Gpu::open(&self.options).map_err(|error| error.to_string()))
    }
}

impl FromStr for BackendChoice {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "auto" => Ok(BackendChoice::Auto),
            "vulkan" => Ok(BackendChoice::Vulkan),
            "cpu" => Ok(BackendChoice::Cpu),
            _ => Err(Error::bad_input("backend", "auto, vulkan or cpu", format!("'{text}'"), "name one of these")),
        }
    }
}

/// Told how many texels more are done, from any thread.
pub type Progress<'a> = &'a (dyn Fn(usize) + Sync);

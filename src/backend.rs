//! Who computes: the CPU in f64, or a Vulkan device in f32. Backends see parameters and give numbers; they know no files.

pub mod cpu;
pub mod shader;
pub mod vulkan;

use crate::error::{Complaint, Error, Result};
use std::str::FromStr;
use vulkan::gpu::{Gpu, GpuOptions};

/// Which backend is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BackendChoice {
    /// Vulkan where a device can do the work, else the CPU.
    #[default]
    Auto,
    /// Vulkan or an error.
    Vulkan,
    /// The CPU.
    Cpu,
}

/// An opened backend: a device, or none and the reason why.
#[derive(Debug)]
pub struct Backend {
    /// The device; `None` computes on the CPU.
    pub gpu: Option<Gpu>,
    /// Why there is no device, where one was wanted.
    pub reason: Option<String>,
    choice: BackendChoice,
}

impl Backend {
    /// The CPU.
    pub fn cpu() -> Self {
        Backend { gpu: None, reason: None, choice: BackendChoice::Cpu }
    }

    /// Opens what is asked for; only [`BackendChoice::Vulkan`] can fail for want of a device.
    pub fn open(choice: BackendChoice, options: &GpuOptions) -> Result<Self> {
        match choice {
            BackendChoice::Cpu => Ok(Backend::cpu()),
            BackendChoice::Vulkan => Ok(Backend { gpu: Some(Gpu::open(options)?), reason: None, choice }),
            BackendChoice::Auto => match Gpu::open(options) {
                Ok(gpu) => Ok(Backend { gpu: Some(gpu), reason: None, choice }),
                Err(Error::NoDevice(complaint)) if options.device.is_some() => Err(Error::NoDevice(complaint)),
                Err(error) => Ok(Backend { gpu: None, reason: Some(error.to_string()), choice }),
            },
        }
    }

    /// The device for a job that it may be unable to do, `obstacle` saying why; an error if the CPU was ruled out.
    pub fn device_unless(&self, obstacle: Option<Complaint>) -> Result<(Option<&Gpu>, Option<String>)> {
        match (&self.gpu, obstacle) {
            (None, _) => Ok((None, self.reason.clone())),
            (Some(gpu), None) => Ok((Some(gpu), None)),
            (Some(_), Some(complaint)) if self.choice == BackendChoice::Auto => Ok((None, Some(complaint.to_string()))),
            (Some(_), Some(complaint)) => Err(Error::BadInput(complaint)),
        }
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

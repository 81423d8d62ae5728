//! In the place of Vulkan where the crate is built without it: there is no device.

use super::Progress;
use super::device::{DeviceBake, DeviceInfo, GpuOptions};
use crate::brdf::interface::Interface;
use crate::brdf::{Fresnel, Microfacet};
use crate::error::{Complaint, Error, Result};
use crate::integrate::glass::GlassRule;
use crate::integrate::half_vectors::HalfVectorRule;
use crate::table::grid::Grid;

/// A device: there is none.
#[derive(Debug)]
pub enum Gpu {}

fn no_vulkan() -> Error {
    let cure = "build it with the feature 'vulkan', or bake on the CPU";
    Error::NoDevice(Complaint::new("Vulkan", "splitsum built with it", "built without it", cure))
}

/// Always an error.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    Err(no_vulkan())
}

impl Gpu {
    /// Always an error.
    pub fn open(_: &GpuOptions) -> Result<Self> {
        Err(no_vulkan())
    }

    /// Its description.
    pub fn info(&self) -> &DeviceInfo {
        match *self {}
    }
}

/// The integrals of a lobe at every point of the grid.
pub fn bake(
    gpu: &Gpu,
    _: (Microfacet, Fresnel),
    _: &Grid,
    _: &HalfVectorRule,
    _: Progress,
) -> Result<DeviceBake> {
    match *gpu {}
}

/// R and T of an interface at every point of the grid.
pub fn bake_glass(
    gpu: &Gpu,
    _: Interface,
    _: &Grid,
    _: &GlassRule,
    _: Progress,
) -> Result<DeviceBake> {
    match *gpu {}
}

//! The Vulkan host: the one place with `unsafe`. It needs Vulkan 1.1, one queue with compute, f32
//! and u32, workgroups of 64, four storage buffers, a uniform of 16 KiB and 128 bytes of push
//! constants: what every driver has.
#![allow(
    unsafe_code,
    reason = "Vulkan is a C interface; every call's requirements are met in this module"
)]

pub mod bake;
pub mod buffer;
pub mod devices;
pub mod evaluate;
pub mod gpu;
pub mod instance;
pub mod pipeline;
pub mod render;

use crate::error::Error;
use ash::vk;

/// A failed call as an error.
fn failed(what: &str) -> impl Fn(vk::Result) -> Error {
    move |result| Error::DeviceFailure(format!("{what}: {result:?}"))
}

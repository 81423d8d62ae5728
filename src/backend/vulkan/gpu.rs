//! A device with a queue, freed when dropped.

use super::devices::choose;
use super::instance::Instance;
use crate::backend::device::{DeviceInfo, GpuOptions};
use crate::error::{Complaint, Error, Result};
use ash::vk;

/// A device with a queue.
pub struct Gpu {
    pub(super) device: ash::Device,
    pub(super) queue: vk::Queue,
    pub(super) queue_family: u32,
    pub(super) memory: vk::PhysicalDeviceMemoryProperties,
    pub(super) limits: vk::PhysicalDeviceLimits,
    /// What the driver has compiled before: the slices of a table share a kernel.
    pub(super) pipelines: vk::PipelineCache,
    /// The bits of the queue's clock that mean something; 0 where it has none.
    pub(super) timestamp_mask: u64,
    info: DeviceInfo,
    options: GpuOptions,
    instance: Instance,
}

impl Gpu {
    /// Opens the device that `options` name.
    pub fn open(options: &GpuOptions) -> Result<Self> {
        let instance = Instance::new(options.validate)?;
        let found = choose(&instance, options.device.as_deref())?;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(found.queue_family)
            .queue_priorities(&[1.0])];
        let create = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
        // SAFETY: `found.physical` comes from this instance, and the queue family from its list.
        let device = unsafe { instance.raw.create_device(found.physical, &create, None) }.map_err(
            |result| {
                let cure = "check its driver, or use --backend cpu";
                Error::NoDevice(Complaint::new(
                    &found.info.name,
                    "a device that opens",
                    format!("{result:?}"),
                    cure,
                ))
            },
        )?;
        // SAFETY: the device was made with one queue of this family; the properties are plain
        // queries.
        let (queue, memory, limits) = unsafe {
            (
                device.get_device_queue(found.queue_family, 0),
                instance.raw.get_physical_device_memory_properties(found.physical),
                instance.raw.get_physical_device_properties(found.physical).limits,
            )
        };
        // SAFETY: the structure is valid. A driver that has no room for a cache compiles anew.
        let pipelines = unsafe { device.create_pipeline_cache(&Default::default(), None) }
            .unwrap_or(vk::PipelineCache::null());
        let (info, options) = (found.info, options.clone());
        let timestamp_mask = u64::MAX.checked_shr(64 - found.timestamp_bits).unwrap_or(0);
        let queue_family = found.queue_family;
        Ok(Gpu {
            device,
            queue,
            queue_family,
            memory,
            limits,
            pipelines,
            timestamp_mask,
            info,
            options,
            instance,
        })
    }

    /// Its description.
    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    /// The options with which it was opened.
    pub fn options(&self) -> &GpuOptions {
        &self.options
    }

    /// The messages of the validation layers so far.
    pub fn validation_messages(&self) -> Vec<String> {
        self.instance.messages()
    }
}

impl std::fmt::Debug for Gpu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gpu").field("info", &self.info).finish_non_exhaustive()
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        // SAFETY: everything made from the device borrows this Gpu, so it is gone; the instance is
        // dropped after.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_pipeline_cache(self.pipelines, None);
            self.device.destroy_device(None);
        }
    }
}

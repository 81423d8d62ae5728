//! A storage buffer in memory that both the host and the device see.

use super::failed;
use super::gpu::Gpu;
use crate::error::{Error, Result};
use ash::vk;
use bytemuck::Pod;
use std::ffi::c_void;

/// A storage buffer, mapped for as long as it lives.
pub struct Buffer<'g> {
    gpu: &'g Gpu,
    pub(super) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut c_void,
    /// Its size.
    pub bytes: usize,
}

impl<'g> Buffer<'g> {
    /// A buffer with these contents.
    pub fn with<T: Pod>(gpu: &'g Gpu, contents: &[T]) -> Result<Self> {
        let buffer = Buffer::new(gpu, size_of_val(contents))?;
        buffer.write(contents);
        Ok(buffer)
    }

    /// A buffer of `bytes`, at least one word.
    pub fn new(gpu: &'g Gpu, bytes: usize) -> Result<Self> {
        let (raw, memory) = (vk::Buffer::null(), vk::DeviceMemory::null());
        // Whatever is made before a failure is freed by the drop of this.
        let mut buffer =
            Buffer { gpu, raw, memory, mapped: std::ptr::null_mut(), bytes: bytes.max(4) };
        let create = vk::BufferCreateInfo::default()
            .size(buffer.bytes as u64)
            .usage(vk::BufferUsageFlags::STORAGE_BUFFER);
        // SAFETY: the device is alive, and every structure is valid for its call.
        unsafe {
            buffer.raw =
                gpu.device.create_buffer(&create, None).map_err(failed("creating a buffer"))?;
            let needs = gpu.device.get_buffer_memory_requirements(buffer.raw);
            let allocate = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(memory_type(gpu, needs.memory_type_bits)?);
            buffer.memory =
                gpu.device.allocate_memory(&allocate, None).map_err(failed("allocating memory"))?;
            gpu.device
                .bind_buffer_memory(buffer.raw, buffer.memory, 0)
                .map_err(failed("binding memory"))?;
            buffer.mapped = gpu
                .device
                .map_memory(buffer.memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())
                .map_err(failed("mapping memory"))?;
        }
        Ok(buffer)
    }

    /// Overwrites the beginning of the buffer; what does not fit is left out.
    pub fn write<T: Pod>(&self, contents: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        // SAFETY: the mapping covers `self.bytes`, and no dispatch is under way: each is waited for
        // before it returns.
        unsafe {
            std::ptr::copy_nonoverlapping(
                bytes.as_ptr(),
                self.mapped.cast(),
                bytes.len().min(self.bytes),
            );
        }
    }

    /// Copies out the first `count` values, or as many as there are.
    pub fn read<T: Pod>(&self, count: usize) -> Vec<T> {
        let mut values = vec![T::zeroed(); count.min(self.bytes / size_of::<T>())];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        // SAFETY: as for write; the values' bytes fit.
        unsafe {
            std::ptr::copy_nonoverlapping(self.mapped.cast(), bytes.as_mut_ptr(), bytes.len())
        };
        values
    }
}

/// Memory that the host sees without flushing, cached where there is such.
fn memory_type(gpu: &Gpu, allowed: u32) -> Result<u32> {
    use vk::MemoryPropertyFlags as Flags;
    let coherent = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
    let types = &gpu.memory.memory_types[..gpu.memory.memory_type_count as usize];
    let find = |wanted: Flags| {
        let fits = |(i, kind): (usize, &vk::MemoryType)| {
            allowed >> i & 1 == 1 && kind.property_flags.contains(wanted)
        };
        types.iter().enumerate().position(fits)
    };
    let found = find(coherent | Flags::HOST_CACHED).or_else(|| find(coherent));
    found
        .map(|i| i as u32)
        .ok_or_else(|| Error::DeviceFailure("no memory that host and device share".into()))
}

impl Drop for Buffer<'_> {
    fn drop(&mut self) {
        // SAFETY: no dispatch that uses the buffer is under way (see Pipeline::run); freeing
        // unmaps; null handles are ignored.
        unsafe {
            self.gpu.device.destroy_buffer(self.raw, None);
            self.gpu.device.free_memory(self.memory, None);
        }
    }
}

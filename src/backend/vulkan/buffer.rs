//! Buffers: what the host writes for the device, and what the device writes for the host.

use super::failed;
use super::gpu::Gpu;
use crate::backend::wgsl::{Binding, Kernel};
use crate::error::{Error, Result};
use ash::vk;
use bytemuck::Pod;
use std::ffi::c_void;
use vk::{BufferUsageFlags as Usage, MemoryPropertyFlags as Memory};

/// The nodes that the uniform of a kernel has room for: 16 KiB, the least that a driver offers.
const MOST_NODES: usize = 1024;

/// The content of results before the device writes them: a NaN that no arithmetic makes.
pub const POISON: u32 = 0x7fc0_dead;

/// Memory that the host sees without flushing.
const SHARED: Memory =
    Memory::from_raw(Memory::HOST_VISIBLE.as_raw() | Memory::HOST_COHERENT.as_raw());

/// A buffer, mapped for as long as it lives where the host sees it.
pub struct Buffer<'g> {
    gpu: &'g Gpu,
    pub(super) raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut c_void,
    /// Its size.
    pub bytes: usize,
}

/// Values that a kernel writes into the device's own memory, which is many times as fast as the
/// host's, and a copy for the host.
pub struct Results<'g> {
    pub(super) own: Buffer<'g>,
    pub(super) copy: Buffer<'g>,
}

impl<'g> Buffer<'g> {
    /// A storage buffer with these contents.
    pub fn storage<T: Pod>(gpu: &'g Gpu, contents: &[T]) -> Result<Self> {
        Buffer::with(gpu, contents, Usage::STORAGE_BUFFER)
    }

    /// The nodes of a kernel, which are its first binding: see shaders/nodes.wgsl and points.wgsl.
    pub fn nodes(gpu: &'g Gpu, kernel: &Kernel, nodes: &[[f32; 2]]) -> Result<Self> {
        if kernel.bindings.first() == Some(&Binding::Storage) {
            return Buffer::storage(gpu, nodes);
        }
        if nodes.len() > MOST_NODES {
            return Err(Error::Internal(format!("{} nodes in a uniform", nodes.len())));
        }
        let mut contents = vec![[0.0; 4]; MOST_NODES];
        for (element, [at, weight]) in contents.iter_mut().zip(nodes) {
            *element = [*at, *weight, 0.0, 0.0];
        }
        Buffer::with(gpu, &contents, Usage::UNIFORM_BUFFER)
    }

    fn with<T: Pod>(gpu: &'g Gpu, contents: &[T], usage: Usage) -> Result<Self> {
        let buffer = Buffer::new(gpu, size_of_val(contents), usage, &[SHARED])?;
        buffer.write(bytemuck::cast_slice(contents));
        Ok(buffer)
    }

    /// A buffer of `bytes`, at least one word, in the first kind of memory that there is.
    fn new(gpu: &'g Gpu, bytes: usize, usage: Usage, kinds: &[Memory]) -> Result<Self> {
        let (raw, memory) = (vk::Buffer::null(), vk::DeviceMemory::null());
        // Whatever is made before a failure is freed by the drop of this.
        let mut buffer =
            Buffer { gpu, raw, memory, mapped: std::ptr::null_mut(), bytes: bytes.max(4) };
        let create = vk::BufferCreateInfo::default().size(buffer.bytes as u64).usage(usage);
        // SAFETY: the device is alive, and every structure is valid for its call.
        unsafe {
            buffer.raw =
                gpu.device.create_buffer(&create, None).map_err(failed("creating a buffer"))?;
            let needs = gpu.device.get_buffer_memory_requirements(buffer.raw);
            let allocate = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(memory_type(gpu, needs.memory_type_bits, kinds)?);
            buffer.memory =
                gpu.device.allocate_memory(&allocate, None).map_err(failed("allocating memory"))?;
            gpu.device
                .bind_buffer_memory(buffer.raw, buffer.memory, 0)
                .map_err(failed("binding memory"))?;
            if kinds.iter().all(|kind| kind.contains(SHARED)) {
                buffer.mapped = gpu
                    .device
                    .map_memory(buffer.memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())
                    .map_err(failed("mapping memory"))?;
            }
        }
        Ok(buffer)
    }

    /// Overwrites the beginning of a buffer that is mapped; what does not fit is left out.
    fn write(&self, contents: &[u8]) {
        if self.mapped.is_null() {
            return;
        }
        let bytes = contents.len().min(self.bytes);
        // SAFETY: the mapping covers `self.bytes`, and no dispatch is under way: each is waited for
        // before it returns.
        unsafe { std::ptr::copy_nonoverlapping(contents.as_ptr(), self.mapped.cast(), bytes) };
    }

    /// Copies out the beginning of a buffer that is mapped, as much as there is.
    fn read(&self, contents: &mut [u8]) {
        if self.mapped.is_null() {
            return;
        }
        let bytes = contents.len().min(self.bytes);
        // SAFETY: as for write.
        unsafe {
            std::ptr::copy_nonoverlapping(self.mapped.cast(), contents.as_mut_ptr(), bytes);
        };
    }
}

impl<'g> Results<'g> {
    /// Room for results of `bytes`. The host's copy starts out as poison as far as `first` bytes,
    /// which finds a device that does nothing; each run poisons what it writes, on the device.
    pub fn new(gpu: &'g Gpu, bytes: usize, first: usize) -> Result<Self> {
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let own = Buffer::new(gpu, bytes, usage, &[Memory::DEVICE_LOCAL, Memory::empty()])?;
        let kinds = [SHARED | Memory::HOST_CACHED, SHARED];
        let copy = Buffer::new(gpu, bytes, Usage::TRANSFER_DST, &kinds)?;
        copy.write(bytemuck::cast_slice(&vec![POISON; first.min(bytes).div_ceil(4)]));
        Ok(Results { own, copy })
    }

    /// Copies out the first `count` values of the last run, or as many as there are.
    pub fn read<T: Pod>(&self, count: usize) -> Vec<T> {
        let mut values = vec![T::zeroed(); count.min(self.copy.bytes / size_of::<T>())];
        self.copy.read(bytemuck::cast_slice_mut(&mut values));
        values
    }
}

/// The first of these kinds of memory that there is.
fn memory_type(gpu: &Gpu, allowed: u32, kinds: &[Memory]) -> Result<u32> {
    let types = &gpu.memory.memory_types[..gpu.memory.memory_type_count as usize];
    let find = |wanted: &Memory| {
        let fits = |(i, kind): (usize, &vk::MemoryType)| {
            allowed >> i & 1 == 1 && kind.property_flags.contains(*wanted)
        };
        types.iter().enumerate().position(fits)
    };
    kinds
        .iter()
        .find_map(find)
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

//! A compute pipeline bound to its buffers, and how it is run: one submission, one fence. The
//! results are poisoned, written and copied to the host, with a barrier between each two.

use super::buffer::{Buffer, POISON, Results};
use super::failed;
use super::gpu::Gpu;
use crate::backend::wgsl::{Binding, Kernel};
use crate::error::{Error, Result};
use ash::vk;
use std::time::{Duration, Instant};

/// The duration of a run.
#[derive(Clone, Copy, Debug)]
pub struct Elapsed {
    /// From the submission to the fence.
    pub wall: Duration,
    /// Seconds of the dispatch by the device's own clock; none where it has no clock.
    pub device: Option<f64>,
}

/// The time after which a dispatch is given up: 500 times that of a tile.
const TIMEOUT: Duration = Duration::from_secs(20);

/// A compiled kernel with its buffers.
pub struct Pipeline<'g, 'b> {
    gpu: &'g Gpu,
    _buffers: &'b [&'b Buffer<'g>],
    results: &'b Results<'g>,
    module: vk::ShaderModule,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    descriptors: vk::DescriptorPool,
    set: vk::DescriptorSet,
    commands: vk::CommandPool,
    command: vk::CommandBuffer,
    fence: vk::Fence,
    /// Two timestamps, where the queue has a clock.
    timestamps: vk::QueryPool,
}

impl<'g, 'b> Pipeline<'g, 'b> {
    /// Compiles `kernel` and binds `buffers`, the results' own among them, to bindings 0, 1, …
    pub fn new(
        gpu: &'g Gpu,
        kernel: &Kernel,
        buffers: &'b [&'b Buffer<'g>],
        results: &'b Results<'g>,
    ) -> Result<Self> {
        let (given, needed) = (buffers.len(), kernel.bindings.len());
        if given != needed {
            return Err(Error::Internal(format!("{given} buffers for {needed} bindings")));
        }
        // Whatever is made before a failure is freed by the drop of this.
        let mut this = Pipeline {
            gpu,
            _buffers: buffers,
            results,
            module: vk::ShaderModule::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            pipeline: vk::Pipeline::null(),
            descriptors: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            commands: vk::CommandPool::null(),
            command: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            timestamps: vk::QueryPool::null(),
        };
        this.compile(kernel)?;
        this.bind(kernel, buffers)?;
        this.prepare()?;
        Ok(this)
    }

    fn compile(&mut self, kernel: &Kernel) -> Result<()> {
        let device = &self.gpu.device;
        let binding = |(i, binding): (usize, &Binding)| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(i as u32)
                .descriptor_type(descriptor(*binding))
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
        };
        let bindings: Vec<_> = kernel.bindings.iter().enumerate().map(binding).collect();
        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(kernel.push_bytes)];
        let push = if kernel.push_bytes == 0 { &push[..0] } else { &push[..] };
        let module = vk::ShaderModuleCreateInfo::default().code(&kernel.spirv);
        let set_layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: every structure is valid for its call; naga has validated the shader.
        unsafe {
            self.module =
                device.create_shader_module(&module, None).map_err(failed("loading the shader"))?;
            self.set_layout = device
                .create_descriptor_set_layout(&set_layout, None)
                .map_err(failed("describing the buffers"))?;
            let layouts = [self.set_layout];
            let layout = vk::PipelineLayoutCreateInfo::default()
                .set_layouts(&layouts)
                .push_constant_ranges(push);
            self.layout = device
                .create_pipeline_layout(&layout, None)
                .map_err(failed("laying out the pipeline"))?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(self.module)
                .name(c"main");
            let create =
                [vk::ComputePipelineCreateInfo::default().stage(stage).layout(self.layout)];
            let pipelines = device
                .create_compute_pipelines(self.gpu.pipelines, &create, None)
                .map_err(|(_, result)| failed("compiling the shader")(result))?;
            self.pipeline = pipelines[0];
        }
        Ok(())
    }

    fn bind(&mut self, kernel: &Kernel, buffers: &[&Buffer]) -> Result<()> {
        let device = &self.gpu.device;
        let size =
            |&binding| vk::DescriptorPoolSize { ty: descriptor(binding), descriptor_count: 1 };
        let sizes: Vec<_> = kernel.bindings.iter().map(size).collect();
        let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let layouts = [self.set_layout];
        let infos: Vec<_> = buffers
            .iter()
            .map(|buffer| {
                [vk::DescriptorBufferInfo {
                    buffer: buffer.raw,
                    offset: 0,
                    range: buffer.bytes as u64,
                }]
            })
            .collect();
        // SAFETY: the buffers outlive this pipeline, which borrows them.
        unsafe {
            self.descriptors = device
                .create_descriptor_pool(&pool, None)
                .map_err(failed("creating descriptors"))?;
            let allocate = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.descriptors)
                .set_layouts(&layouts);
            self.set = device
                .allocate_descriptor_sets(&allocate)
                .map_err(failed("allocating descriptors"))?[0];
            let mut writes = Vec::new();
            for (i, (info, &binding)) in infos.iter().zip(&kernel.bindings).enumerate() {
                let write = vk::WriteDescriptorSet::default()
                    .dst_set(self.set)
                    .dst_binding(i as u32)
                    .descriptor_type(descriptor(binding))
                    .buffer_info(info);
                writes.push(write);
            }
            device.update_descriptor_sets(&writes, &[]);
        }
        Ok(())
    }

    fn prepare(&mut self) -> Result<()> {
        let device = &self.gpu.device;
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(self.gpu.queue_family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: every structure is valid for its call.
        unsafe {
            self.commands = device
                .create_command_pool(&pool, None)
                .map_err(failed("creating a command pool"))?;
            let allocate = vk::CommandBufferAllocateInfo::default()
                .command_pool(self.commands)
                .command_buffer_count(1);
            self.command = device
                .allocate_command_buffers(&allocate)
                .map_err(failed("allocating commands"))?[0];
            self.fence = device
                .create_fence(&Default::default(), None)
                .map_err(failed("creating a fence"))?;
            if self.gpu.timestamp_mask != 0 {
                let pool = vk::QueryPoolCreateInfo::default()
                    .query_type(vk::QueryType::TIMESTAMP)
                    .query_count(2);
                self.timestamps = device
                    .create_query_pool(&pool, None)
                    .map_err(failed("creating the device's clock"))?;
            }
        }
        Ok(())
    }

    /// Runs `groups` workgroups with the push constants `push`, copies the first `bytes` of the
    /// results to the host, waits for all that, and tells how long it took.
    pub fn run(&self, push: &[u8], groups: u32, bytes: usize) -> Result<Elapsed> {
        let device = &self.gpu.device;
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        let commands = [self.command];
        let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
        let start = Instant::now();
        // SAFETY: the command buffer is not in use: every run waits for its fence, or the device is
        // lost.
        unsafe {
            device.begin_command_buffer(self.command, &begin).map_err(failed("recording"))?;
            self.record(push, groups, bytes.min(self.results.own.bytes) as u64);
            device.end_command_buffer(self.command).map_err(failed("recording"))?;
            device.reset_fences(&[self.fence]).map_err(failed("resetting the fence"))?;
            device
                .queue_submit(self.gpu.queue, &submit, self.fence)
                .map_err(failed("submitting the work"))?;
            device
                .wait_for_fences(&[self.fence], true, TIMEOUT.as_nanos() as u64)
                .map_err(failed("waiting for the work"))?;
        }
        Ok(Elapsed { wall: start.elapsed(), device: self.device_seconds()? })
    }

    /// Records the commands of a run. What the host wrote is visible to every later submission;
    /// what the device writes is visible to nothing without a barrier.
    fn record(&self, push: &[u8], groups: u32, bytes: u64) {
        use vk::{AccessFlags as Access, PipelineStageFlags as Stage};
        let (device, command) = (&self.gpu.device, self.command);
        let (own, copy) = (self.results.own.raw, self.results.copy.raw);
        let transferred = (Stage::TRANSFER, Access::TRANSFER_WRITE);
        // WGSL has no buffers that are written alone.
        let integrated = (Stage::COMPUTE_SHADER, Access::SHADER_READ | Access::SHADER_WRITE);
        let copied = (Stage::TRANSFER, Access::TRANSFER_READ);
        let has_clock = self.timestamps != vk::QueryPool::null();
        let (bind, sets) = (vk::PipelineBindPoint::COMPUTE, [self.set]);
        let regions = [vk::BufferCopy::default().size(bytes)];
        // SAFETY: the command buffer is being recorded, and the buffers hold `bytes`, a multiple of
        // four as every result is of words.
        unsafe {
            if has_clock {
                device.cmd_reset_query_pool(command, self.timestamps, 0, 2);
            }
            device.cmd_fill_buffer(command, own, 0, bytes, POISON);
            self.barrier(transferred, integrated);
            device.cmd_bind_pipeline(command, bind, self.pipeline);
            device.cmd_bind_descriptor_sets(command, bind, self.layout, 0, &sets, &[]);
            if !push.is_empty() {
                let stage = vk::ShaderStageFlags::COMPUTE;
                device.cmd_push_constants(command, self.layout, stage, 0, push);
            }
            if has_clock {
                // Once the poison is written.
                device.cmd_write_timestamp(command, Stage::TRANSFER, self.timestamps, 0);
            }
            device.cmd_dispatch(command, groups, 1, 1);
            if has_clock {
                device.cmd_write_timestamp(command, Stage::COMPUTE_SHADER, self.timestamps, 1);
            }
            self.barrier(integrated, copied);
            device.cmd_copy_buffer(command, own, copy, &regions);
            self.barrier(transferred, (Stage::HOST, Access::HOST_READ));
        }
    }

    /// What follows sees what was written before.
    fn barrier(
        &self,
        (from, wrote): (vk::PipelineStageFlags, vk::AccessFlags),
        (to, access): (vk::PipelineStageFlags, vk::AccessFlags),
    ) {
        let memory = [vk::MemoryBarrier::default().src_access_mask(wrote).dst_access_mask(access)];
        let none = vk::DependencyFlags::empty();
        // SAFETY: the command buffer is being recorded.
        unsafe {
            self.gpu.device.cmd_pipeline_barrier(self.command, from, to, none, &memory, &[], &[]);
        }
    }

    /// Seconds between the two timestamps of the last run.
    fn device_seconds(&self) -> Result<Option<f64>> {
        if self.timestamps == vk::QueryPool::null() {
            return Ok(None);
        }
        let mut ticks = [0u64; 2];
        // SAFETY: the fence has been waited for, so that both timestamps are written.
        unsafe {
            self.gpu
                .device
                .get_query_pool_results(
                    self.timestamps,
                    0,
                    &mut ticks,
                    vk::QueryResultFlags::TYPE_64,
                )
                .map_err(failed("reading the device's clock"))?;
        }
        let ticks = ticks[1].wrapping_sub(ticks[0]) & self.gpu.timestamp_mask;
        Ok(Some(1e-9 * f64::from(self.gpu.limits.timestamp_period) * ticks as f64))
    }
}

/// Vulkan's word for a binding.
fn descriptor(binding: Binding) -> vk::DescriptorType {
    match binding {
        Binding::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        Binding::Storage => vk::DescriptorType::STORAGE_BUFFER,
    }
}

impl Drop for Pipeline<'_, '_> {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: the device is idle, or lost, when the wait returns; null handles are ignored.
        unsafe {
            let _ = device.device_wait_idle();
            device.destroy_query_pool(self.timestamps, None);
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.commands, None);
            device.destroy_descriptor_pool(self.descriptors, None);
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
            device.destroy_shader_module(self.module, None);
        }
    }
}

//! A compute pipeline bound to its buffers, and how it is run: one submission, one fence, one
//! barrier towards the host.

use super::buffer::Buffer;
use super::failed;
use super::gpu::Gpu;
use crate::backend::wgsl::Kernel;
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
    /// Compiles `kernel` and binds `buffers` to its bindings 0, 1, … in order.
    pub fn new(gpu: &'g Gpu, kernel: &Kernel, buffers: &'b [&'b Buffer<'g>]) -> Result<Self> {
        if buffers.len() != kernel.buffers as usize {
            return Err(Error::Internal(format!(
                "{} buffers for {} bindings",
                buffers.len(),
                kernel.buffers
            )));
        }
        // Whatever is made before a failure is freed by the drop of this.
        let mut this = Pipeline {
            gpu,
            _buffers: buffers,
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
        this.bind(buffers)?;
        this.prepare()?;
        Ok(this)
    }

    fn compile(&mut self, kernel: &Kernel) -> Result<()> {
        let device = &self.gpu.device;
        let binding = |i| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(i)
                .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
        };
        let bindings: Vec<_> = (0..kernel.buffers).map(binding).collect();
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
                .create_compute_pipelines(vk::PipelineCache::null(), &create, None)
                .map_err(|(_, result)| failed("compiling the shader")(result))?;
            self.pipeline = pipelines[0];
        }
        Ok(())
    }

    fn bind(&mut self, buffers: &[&Buffer]) -> Result<()> {
        let device = &self.gpu.device;
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::STORAGE_BUFFER,
            descriptor_count: buffers.len() as u32,
        }];
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
            let write = |(i, info)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(self.set)
                    .dst_binding(i as u32)
                    .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                    .buffer_info(info)
            };
            let writes: Vec<_> =
                infos.iter().map(|info| &info[..]).enumerate().map(write).collect();
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

    /// Runs `groups` workgroups with the push constants `push`, waits for them, and tells how long
    /// they took.
    pub fn run(&self, push: &[u8], groups: u32) -> Result<Elapsed> {
        use vk::{AccessFlags, PipelineStageFlags};
        let device = &self.gpu.device;
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // What the host wrote is visible to every later submission; what the shader writes is not,
        // without this.
        let to_host = [vk::MemoryBarrier::default()
            .src_access_mask(AccessFlags::SHADER_WRITE)
            .dst_access_mask(AccessFlags::HOST_READ)];
        let commands = [self.command];
        let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
        let start = Instant::now();
        // SAFETY: the command buffer is not in use: every run waits for its fence, or the device is
        // lost.
        unsafe {
            device.begin_command_buffer(self.command, &begin).map_err(failed("recording"))?;
            if self.timestamps != vk::QueryPool::null() {
                device.cmd_reset_query_pool(self.command, self.timestamps, 0, 2);
                device.cmd_write_timestamp(
                    self.command,
                    PipelineStageFlags::TOP_OF_PIPE,
                    self.timestamps,
                    0,
                );
            }
            device.cmd_bind_pipeline(self.command, vk::PipelineBindPoint::COMPUTE, self.pipeline);
            let (bind, sets) = (vk::PipelineBindPoint::COMPUTE, [self.set]);
            device.cmd_bind_descriptor_sets(self.command, bind, self.layout, 0, &sets, &[]);
            if !push.is_empty() {
                device.cmd_push_constants(
                    self.command,
                    self.layout,
                    vk::ShaderStageFlags::COMPUTE,
                    0,
                    push,
                );
            }
            device.cmd_dispatch(self.command, groups, 1, 1);
            if self.timestamps != vk::QueryPool::null() {
                device.cmd_write_timestamp(
                    self.command,
                    PipelineStageFlags::COMPUTE_SHADER,
                    self.timestamps,
                    1,
                );
            }
            let (from, to) = (PipelineStageFlags::COMPUTE_SHADER, PipelineStageFlags::HOST);
            device.cmd_pipeline_barrier(
                self.command,
                from,
                to,
                vk::DependencyFlags::empty(),
                &to_host,
                &[],
                &[],
            );
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

//! A bake on a device: the grid cut into dispatches short enough for any watchdog, read back tile
//! by tile.

use super::buffer::{Buffer, Results};
use super::gpu::Gpu;
use super::pipeline::{Elapsed, Pipeline};
use crate::backend::Progress;
use crate::backend::device::DeviceBake;
use crate::backend::wgsl::{Kernel, bake_kernel, glass_kernel};
use crate::brdf::interface::Interface;
use crate::brdf::{Fresnel, Microfacet};
use crate::error::{Error, Result};
use crate::integrate::Field;
use crate::integrate::glass::GlassRule;
use crate::integrate::half_vectors::{HalfVectorNodes, HalfVectorRule};
use crate::numeric::quadrature::gauss_legendre::Node;
use crate::table::grid::Grid;
use std::time::Duration;

/// The time that a dispatch aims at. Watchdogs strike at 2 s and more; 40 ms leaves room for texels
/// fifty times as costly as those before.
const TARGET: Duration = Duration::from_millis(40);

/// Texels of the first dispatch, by which the device's speed is measured: 50 ms of the dearest rule
/// on the slowest device.
const FIRST_TILE: usize = 4096;

/// How many times as large as the last tile the next may be. The widest grid has 16384 texels in a
/// row whose alpha is 0, which cost nothing: the second tile has most of its texels beyond.
const GROWTH: f64 = 8.0;

/// Texels of the largest tile: 16 MiB of results for two integrals, on the device and on the host.
const LARGEST_TILE: usize = 1 << 21;

/// A kernel that writes `count` integrals for each point of a grid, and its input.
#[derive(Clone, Debug)]
pub struct Work {
    /// The kernel: its bindings are nodes, n·v, α and results.
    pub kernel: Kernel,
    /// The nodes of its rule, or points.
    pub nodes: Vec<[f32; 2]>,
    /// The fields of its `Rule`, numbers by their bits.
    pub rule: Vec<u32>,
    /// Integrals for each point.
    pub count: usize,
    /// The cosine of the critical angle, or 0.
    pub critical: f64,
}

/// The integrals of a lobe at every point of the grid, in its order, by `rule` in f32.
pub fn bake(
    gpu: &Gpu,
    (lobe, fresnel): (Microfacet, Fresnel),
    grid: &Grid,
    rule: &HalfVectorRule,
    progress: Progress,
) -> Result<DeviceBake> {
    let work = Work {
        kernel: bake_kernel(lobe, fresnel, rule.power)?,
        nodes: node_data(&rule.nodes()),
        rule: words(&rule.counts()),
        count: fresnel.count(),
        critical: 0.0,
    };
    run(gpu, &work, grid, progress)
}

/// R and T of an interface at every point of the grid, in its order, by `rule` in f32, and in f64
/// where they are known exactly.
pub fn bake_glass(
    gpu: &Gpu,
    interface: Interface,
    grid: &Grid,
    rule: &GlassRule,
    progress: Progress,
) -> Result<DeviceBake> {
    let side = interface.side();
    let nodes = rule.nodes(side);
    let numbers = [interface.eta(), interface.k(), interface.critical()];
    let bits = numbers.map(|number| (number as f32).to_bits());
    let work = Work {
        kernel: glass_kernel(interface, rule.power(side))?,
        nodes: nodes.lists().into_iter().flatten().map(pair).collect(),
        rule: [words(&rule.counts(side)), bits.into()].concat(),
        count: 2,
        critical: interface.critical(),
    };
    let mut baked = run(gpu, &work, grid, progress)?;
    for (i, integrals) in baked.integrals.values_mut().chunks_exact_mut(2).enumerate() {
        interface.put_exact(grid.point(i), integrals);
    }
    Ok(baked)
}

/// Runs a kernel at every point of the grid; the results are in its order.
pub fn run(gpu: &Gpu, work: &Work, grid: &Grid, progress: Progress) -> Result<DeviceBake> {
    let Work { kernel, nodes, rule, count, critical } = work;
    let (group, texel) = (kernel.workgroup, size_of::<f32>() * count);
    let largest = largest_tile(gpu, group, texel).min(grid.len());
    let mut tile = gpu.options().tile.unwrap_or(FIRST_TILE).clamp(1, largest);
    let nodes = Buffer::nodes(gpu, kernel, nodes)?;
    // The difference is rounded once: near the critical angle none of f32 is left in the shader.
    let view = |&mu: &f64| [mu as f32, (mu - critical) as f32];
    let mus = Buffer::storage(gpu, &grid.mus.iter().map(view).collect::<Vec<_>>())?;
    let alphas: Vec<f32> = grid.alphas.iter().map(|&alpha| alpha as f32).collect();
    let alphas = Buffer::storage(gpu, &alphas)?;
    let results = Results::new(gpu, texel * largest, texel * tile)?;
    let buffers = [&nodes, &mus, &alphas, &results.own];
    let pipeline = Pipeline::new(gpu, kernel, &buffers, &results)?;
    let mut integrals = Vec::with_capacity(grid.len() * count);
    let mut device_seconds = Some(0.0);
    while integrals.len() < grid.len() * count {
        let first = integrals.len() / count;
        let texels = tile.min(grid.len() - first);
        let push = [words(&[first, first + texels]), rule.clone()].concat();
        let groups = texels.div_ceil(group) as u32;
        let Elapsed { wall, device } =
            pipeline.run(bytemuck::cast_slice(&push), groups, texel * texels)?;
        device_seconds = device_seconds.zip(device).map(|(sum, device)| sum + device);
        integrals.extend(results.read::<f32>(texels * count).into_iter().map(f64::from));
        progress(texels);
        if gpu.options().tile.is_none() {
            tile = next_tile(tile, wall).next_multiple_of(group).min(largest);
        }
    }
    fail_on_validation_message(gpu)?;
    Ok(DeviceBake { integrals: Field::of(*count, integrals), device_seconds })
}

/// Counts as a shader reads them.
pub fn words(counts: &[usize]) -> Vec<u32> {
    counts.iter().map(|&count| count as u32).collect()
}

/// The most texels of so many bytes that fit the device's limits on buffers and workgroups.
fn largest_tile(gpu: &Gpu, group: usize, texel: usize) -> usize {
    let by_buffer = gpu.limits.max_storage_buffer_range as usize / texel;
    let by_groups = gpu.limits.max_compute_work_group_count[0] as usize * group;
    LARGEST_TILE.min(by_buffer).min(by_groups)
}

/// A tile that would have taken [`TARGET`], but no more than [`GROWTH`] times the last one.
fn next_tile(tile: usize, elapsed: Duration) -> usize {
    let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
    (tile as f64 * ratio.min(GROWTH)) as usize
}

/// The nodes as the shader reads them: (position, weight), in the order of the fields of `Rule`.
pub fn node_data(nodes: &HalfVectorNodes) -> Vec<[f32; 2]> {
    let lists = [&nodes.radial, &nodes.azimuth, &nodes.radial_horizon, &nodes.azimuth_horizon];
    lists.into_iter().flatten().map(pair).collect()
}

/// A node as a shader reads it.
pub fn pair(node: &Node) -> [f32; 2] {
    [node.at as f32, node.weight as f32]
}

/// Under validation, anything that the layers say is a failure.
fn fail_on_validation_message(gpu: &Gpu) -> Result<()> {
    match gpu.validation_messages().as_slice() {
        [] => Ok(()),
        messages => {
            Err(Error::DeviceFailure(format!("the validation layers say: {}", messages.join("; "))))
        }
    }
}

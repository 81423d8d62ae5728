//! A bake on a device: the grid cut into dispatches short enough for any watchdog, read back tile by tile.

use super::buffer::Buffer;
use super::gpu::Gpu;
use super::pipeline::{Elapsed, Pipeline};
use crate::backend::Progress;
use crate::backend::shader::{Kernel, bake_kernel, samples_kernel};
use crate::error::{Error, Result};
use crate::integrate::ScaleBias;
use crate::integrate::h_space::{HSpaceNodes, HSpaceRule};
use crate::lut::Grid;
use crate::model::Microfacet;
use crate::quadrature::point_set::Point;
use crate::sampling::Sampler;
use std::time::Duration;

/// What a dispatch aims at. Watchdogs strike at 2 s and more; 40 ms leaves room for a texel mix fifty times as dear.
const TARGET: Duration = Duration::from_millis(40);

/// Texels of the first dispatch, by which the device's speed is measured.
const FIRST_TILE: usize = 1024;

/// The largest tile: 32 MiB of results.
const LARGEST_TILE: usize = 1 << 22;

/// What lies in the results before the device writes them: a NaN that no arithmetic makes.
const POISON: [u32; 2] = [0x7fc0_dead; 2];

/// A device's work.
#[derive(Clone, Debug)]
pub struct DeviceBake {
    /// (A, B) at every point of the grid, in its order.
    pub integrals: Vec<ScaleBias>,
    /// Seconds that the dispatches took by the device's own clock, without start, compilation and transfer; none
    /// where it has no clock.
    pub device_seconds: Option<f64>,
}

/// (A, B) of a lobe at every point of the grid, in its order, integrated by `rule` in f32.
pub fn bake(gpu: &Gpu, lobe: Microfacet, grid: &Grid, rule: &HSpaceRule, progress: Progress) -> Result<DeviceBake> {
    run(gpu, &bake_kernel(lobe, rule.power)?, &node_data(&rule.nodes()), rule.counts(), grid, progress)
}

/// The same by an estimator over `points`.
pub fn bake_samples(
    gpu: &Gpu,
    lobe: Microfacet,
    grid: &Grid,
    sampler: Sampler,
    points: &[Point],
) -> Result<DeviceBake> {
    run(gpu, &samples_kernel(lobe, sampler)?, &point_data(points), [points.len(), 0, 0, 0], grid, &|_| ())
}

fn run(
    gpu: &Gpu,
    kernel: &Kernel,
    nodes: &[[f32; 2]],
    counts: [usize; 4],
    grid: &Grid,
    progress: Progress,
) -> Result<DeviceBake> {
    let group = kernel.workgroup;
    let largest = largest_tile(gpu, group).min(grid.len());
    let mut tile = gpu.options().tile.unwrap_or(FIRST_TILE).clamp(1, largest);
    let nodes = Buffer::with(gpu, nodes)?;
    let mus = Buffer::with(gpu, &to_f32(&grid.mus))?;
    let alphas = Buffer::with(gpu, &to_f32(&grid.alphas))?;
    let results = Buffer::new(gpu, size_of::<[f32; 2]>() * largest)?;
    let buffers = [&nodes, &mus, &alphas, &results];
    let pipeline = Pipeline::new(gpu, kernel, &buffers)?;
    let poison = vec![POISON; largest];
    let mut integrals = Vec::with_capacity(grid.len());
    let mut device_seconds = Some(0.0);
    while integrals.len() < grid.len() {
        let first = integrals.len();
        let count = tile.min(grid.len() - first);
        results.write(&poison[..count]);
        let push: Vec<u32> = [first, first + count].into_iter().chain(counts).map(|n| n as u32).collect();
        let Elapsed { wall, device } = pipeline.run(bytemuck::cast_slice(&push), count.div_ceil(group) as u32)?;
        device_seconds = device_seconds.zip(device).map(|(sum, device)| sum + device);
        let values = results.read::<[f32; 2]>(count);
        integrals.extend(values.into_iter().map(|[a, b]| ScaleBias { a: a.into(), b: b.into() }));
        progress(count);
        if gpu.options().tile.is_none() {
            tile = next_tile(tile, wall).next_multiple_of(group).min(largest);
        }
    }
    said_nothing(gpu)?;
    Ok(DeviceBake { integrals, device_seconds })
}

/// The most texels that fit the device's limits on buffers and workgroups.
fn largest_tile(gpu: &Gpu, group: usize) -> usize {
    let by_buffer = gpu.limits.max_storage_buffer_range as usize / size_of::<[f32; 2]>();
    let by_groups = gpu.limits.max_compute_work_group_count[0] as usize * group;
    LARGEST_TILE.min(by_buffer).min(by_groups)
}

/// A tile that would have taken [`TARGET`], but no more than four times the last one: the first is slowed by
/// compilation.
fn next_tile(tile: usize, elapsed: Duration) -> usize {
    let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
    (tile as f64 * ratio.min(4.0)) as usize
}

/// The nodes as the shader reads them: (position, weight), in the order of the fields of `Rule`.
pub fn node_data(nodes: &HSpaceNodes) -> Vec<[f32; 2]> {
    let lists = [&nodes.radial, &nodes.azimuth, &nodes.radial_horizon, &nodes.azimuth_horizon];
    lists.into_iter().flatten().map(|node| [node.at as f32, node.weight as f32]).collect()
}

/// The points as the shader reads them: (cos φ, sin² φ), (v, 1 - v), (weight, nothing).
pub fn point_data(points: &[Point]) -> Vec<[f32; 2]> {
    let pairs = |p: &Point| [[p.cosine, p.sine2], [p.v, 1.0 - p.v], [p.weight, 0.0]];
    points.iter().flat_map(pairs).map(|pair| pair.map(|value| value as f32)).collect()
}

fn to_f32(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// Under validation, anything that the layers say is a failure.
fn said_nothing(gpu: &Gpu) -> Result<()> {
    match gpu.validation_messages().as_slice() {
        [] => Ok(()),
        messages => Err(Error::DeviceFailure(format!("the validation layers say: {}", messages.join("; ")))),
    }
}

//! A row of a preview on a device.

use super::bake::{node_data, words};
use super::buffer::{Buffer, Results};
use super::gpu::Gpu;
use super::pipeline::Pipeline;
use crate::backend::wgsl::Kernel;
use crate::error::{Error, Result};
use crate::integrate::half_vectors::HalfVectorRule;

/// The input of a row of spheres: see the shader's `Job`.
#[derive(Clone, Debug, PartialEq)]
pub struct RowData {
    /// (α, roughness, means of P1 and P2) for each column.
    pub columns: Vec<[f32; 4]>,
    /// (A, B) over n·v and roughness, a square of texels.
    pub table: Vec<[f32; 2]>,
    /// Pixels along the edge of a sphere's cell.
    pub cell: usize,
    /// The scene's number.
    pub scene: u32,
}

/// The pixels of a row in linear R, G, B.
pub fn render_row(
    gpu: &Gpu,
    kernel: &Kernel,
    row: &RowData,
    rule: &HalfVectorRule,
) -> Result<Vec<[f64; 3]>> {
    let nodes = Buffer::nodes(gpu, kernel, &node_data(&rule.nodes()))?;
    let columns = Buffer::storage(gpu, &row.columns)?;
    let table = Buffer::storage(gpu, &row.table)?;
    let count = row.cell * row.cell * row.columns.len();
    let bytes = size_of::<[f32; 4]>() * count;
    let pixels = Results::new(gpu, bytes, bytes)?;
    let side = row.table.len().isqrt();
    let job = [row.cell, row.columns.len(), row.scene as usize, side];
    let push = words(&[job, rule.counts()].concat());
    let buffers = [&nodes, &columns, &table, &pixels.own];
    let groups = count.div_ceil(kernel.workgroup) as u32;
    let pipeline = Pipeline::new(gpu, kernel, &buffers, &pixels)?;
    pipeline.run(bytemuck::cast_slice(&push), groups, bytes)?;
    let pixels = pixels.read::<[f32; 4]>(count);
    if pixels.iter().flatten().any(|value| !value.is_finite()) {
        return Err(Error::CheckFailed(
            "the device left pixels out; use another one, or --backend cpu".into(),
        ));
    }
    Ok(pixels.into_iter().map(|[r, g, b, _]| [r.into(), g.into(), b.into()]).collect())
}

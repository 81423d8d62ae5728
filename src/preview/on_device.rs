//! A row of a preview on a Vulkan device.

use super::Row;
use crate::backend::Gpu;
use crate::backend::vulkan::render::{RowData, render_row};
use crate::backend::wgsl::{Kernel, compile, lobe_source};
use crate::brdf::Fresnel;
use crate::error::Result;
use crate::integrate::half_vectors::HalfVectorRule;
use crate::integrate::rules::H288_NODES;

/// The nodes of [`super::RULE`].
const NODES: HalfVectorRule = H288_NODES;

/// Twin of `preview`.
const PREVIEW: &str = include_str!("../../shaders/preview.wgsl");

/// The pixels of a row in linear R, G, B.
pub fn render_row_on_device(gpu: &Gpu, row: &Row, cell: usize) -> Result<Vec<[f64; 3]>> {
    let column =
        |c: &super::Column| [c.alpha, c.roughness, c.means.0, c.means.1].map(|value| value as f32);
    let data = RowData {
        columns: row.columns.iter().map(column).collect(),
        table: row.table.values.iter().map(|value| value.map(|value| value as f32)).collect(),
        cell,
        scene: row.scene as u32,
    };
    render_row(gpu, &kernel(row)?, &data, &NODES)
}

/// The kernel of a row: it reads the table where the table's own axes say.
fn kernel(row: &Row) -> Result<Kernel> {
    let lookup = format!(
        "fn table_u(nov: f32) -> f32 {{ return {}; }}
fn table_v(roughness: f32) -> f32 {{ return {}; }}
",
        row.table.x.uv("nov"),
        row.table.y.uv("roughness")
    );
    compile(&[&lobe_source(row.lobe, Fresnel::Schlick, NODES.power), &lookup, PREVIEW].join("\n"))
}

//! An expression of WGSL on a device, for one argument after the other: functions alone, to be
//! compared with their twins.

use super::buffer::{Buffer, Results};
use super::gpu::Gpu;
use super::pipeline::Pipeline;
use crate::backend::wgsl::compile;
use crate::error::Result;

/// Evaluates `expression`, a vec4 of the argument `p`, at each of the arguments. `source` defines
/// the functions in it, `nodes` (shaders/rule.wgsl) among it.
pub fn evaluate(
    gpu: &Gpu,
    source: &str,
    expression: &str,
    nodes: &[[f32; 2]],
    arguments: &[[f32; 4]],
) -> Result<Vec<[f32; 4]>> {
    let entry = format!(
        "@group(0) @binding(1) var<storage, read> arguments: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> results: array<vec4<f32>>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if id.x >= arrayLength(&arguments) {{ return; }}
    let p = arguments[id.x];
    results[id.x] = {expression};
}}"
    );
    let kernel = compile(&[source, &entry].join("\n"))?;
    let nodes = Buffer::nodes(gpu, &kernel, nodes)?;
    let input = Buffer::storage(gpu, arguments)?;
    let bytes = size_of_val(arguments);
    let output = Results::new(gpu, bytes, bytes)?;
    let buffers = [&nodes, &input, &output.own];
    let groups = arguments.len().div_ceil(kernel.workgroup) as u32;
    Pipeline::new(gpu, &kernel, &buffers, &output)?.run(&[], groups, bytes)?;
    Ok(output.read(arguments.len()))
}

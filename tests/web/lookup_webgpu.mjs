// Evaluates a generated WGSL function at many points: one invocation of a compute shader each.

const GROUP = 64;

let opened;

/** Opens the one device of this page. Turns every error that nobody caught into a console error. */
async function open() {
  if (opened !== undefined) return opened;
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error('WebGPU: no adapter');
  // Lets 32-bit tables be filtered.
  const gpu = await adapter.requestDevice({ requiredFeatures: ['float32-filterable'] });
  gpu.addEventListener('uncapturederror', ({ error }) => console.error(error.message));
  gpu.lost.then(({ message }) => console.error(`WebGPU: the device is lost: ${message}`));
  const { vendor, architecture, device, description } = adapter.info;
  opened = { gpu, name: [vendor, architecture, device, description].filter(Boolean).join(' ') };
  return opened;
}

/** Names the device that computes. */
export async function device() {
  return (await open()).name;
}

/** Evaluates `splitsum_<name>` at all points. Returns four floats for each. */
export async function lookup({ table, points, source, name, fields }) {
  const { gpu } = await open();
  const loaded = upload(gpu, table);
  const entries = [{ binding: 2, resource: loaded.createView(view(table.layers > 0)) }];
  if (name === 'filtered') entries.push({ binding: 3, resource: linear(gpu) });
  const found = await compute(points, shader(table.layers > 0, source, name, fields), entries);
  loaded.destroy();
  return found;
}

/** Evaluates an expression of `point` at all points, below code without a texture. */
export function evaluate({ points, source, value }) {
  return compute(points, around('', source, `  results[id.x] = ${value};`), []);
}

/** Runs an invocation for each point, with further bindings. */
async function compute(points, code, bindings) {
  const { gpu } = await open();
  const module = gpu.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  const errors = messages.filter(({ type }) => type === 'error');
  if (errors.length > 0) {
    throw new Error(`WGSL: ${errors.map((e) => `${e.lineNum}: ${e.message}`).join('\n')}`);
  }
  const pipeline = await gpu.createComputePipelineAsync({ layout: 'auto', compute: { module } });

  const places = buffer(gpu, points.byteLength, 'STORAGE', 'COPY_DST');
  const results = buffer(gpu, points.byteLength, 'STORAGE', 'COPY_SRC');
  const read = buffer(gpu, points.byteLength, 'MAP_READ', 'COPY_DST');
  gpu.queue.writeBuffer(places, 0, points);
  const entries = [
    { binding: 0, resource: { buffer: places } },
    { binding: 1, resource: { buffer: results } },
    ...bindings,
  ];

  const encoder = gpu.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, gpu.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries }));
  pass.dispatchWorkgroups(Math.ceil(points.length / 4 / GROUP));
  pass.end();
  encoder.copyBufferToBuffer(results, 0, read, 0, points.byteLength);
  gpu.queue.submit([encoder.finish()]);
  await read.mapAsync(GPUMapMode.READ);
  const found = new Float32Array(read.getMappedRange().slice(0));
  for (const one of [places, results, read]) one.destroy();
  return found;
}

/** Writes the shader of a table's lookup. The exact function gets no sampler. */
function shader(layered, source, name, fields) {
  const values = [0, 1, 2, 3].map((i) => (i < fields.length ? `found.${fields[i]}` : '0.0'));
  const inputs = name === 'filtered' ? 'bound_table, bound_sampler' : 'bound_table';
  const bindings = `\
@group(0) @binding(2) var bound_table: ${layered ? 'texture_2d_array' : 'texture_2d'}<f32>;
@group(0) @binding(3) var bound_sampler: sampler;`;
  return around(bindings, source, `\
  let found = splitsum_${name}(${inputs}, point.x, point.y${layered ? ', point.z' : ''});
  results[id.x] = vec4f(${values.join(', ')});`);
}

/** Writes the shader around the generated code. */
function around(bindings, source, lines) {
  return `${source}
@group(0) @binding(0) var<storage, read> points: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> results: array<vec4f>;
${bindings}
@compute @workgroup_size(${GROUP})
fn main(@builtin(global_invocation_id) id: vec3u) {
  if (id.x >= arrayLength(&points)) { return; }
  let point = points[id.x];
${lines}
}`;
}

/** Makes a buffer. */
function buffer(gpu, size, ...uses) {
  return gpu.createBuffer({ size, usage: uses.reduce((all, use) => all | GPUBufferUsage[use], 0) });
}

/** Makes the sampler that splitsum asks of a renderer: linear, clamped at the edges, no mips. */
function linear(gpu) {
  return gpu.createSampler({ magFilter: 'linear', minFilter: 'linear' });
}

/** Says how the texture is seen. An array of one layer would be seen as 2D otherwise. */
function view(layered) {
  return { dimension: layered ? '2d-array' : '2d' };
}

/** Uploads the table. */
function upload(gpu, { width, height, layers, texelBytes, webgpu, level }) {
  const size = [width, height, Math.max(layers, 1)];
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
  const texture = gpu.createTexture({ size, format: webgpu, usage });
  const layout = { bytesPerRow: width * texelBytes, rowsPerImage: height };
  gpu.queue.writeTexture({ texture }, level, layout, size);
  return texture;
}

// Evaluates a generated GLSL function at many points: one pixel of an RGBA32F target each.

import { glErrors } from './gl_errors.mjs';

const WIDTH = 256;
const CORNERS = `#version 300 es
void main() {
  // Covers the target by one large triangle.
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;

let gl;

/** Opens the one context of this page. */
function context() {
  if (gl !== undefined) return gl;
  gl = document.createElement('canvas').getContext('webgl2');
  if (gl === null) throw new Error('WebGL2: no context');
  // Lets a float target be drawn to, and 32-bit tables be filtered.
  for (const name of ['EXT_color_buffer_float', 'OES_texture_float_linear']) {
    if (gl.getExtension(name) === null) throw new Error(`WebGL2: ${name} is missing`);
  }
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  return gl;
}

/** Names the device that draws. */
export function device() {
  const info = context().getExtension('WEBGL_debug_renderer_info');
  return info === null ? 'unnamed' : gl.getParameter(info.UNMASKED_RENDERER_WEBGL);
}

/** Evaluates `splitsum_<name>` at all points. Returns four floats for each. */
export function lookup({ table, points, source, name, fields }) {
  return draw(points, fragment(table.layers > 0, source, name, fields), (program) => {
    const loaded = upload(table);
    gl.uniform1i(gl.getUniformLocation(program, 'bound_table'), 1);
    return [loaded];
  });
}

/** Evaluates an expression of `point` at all points, below code without a texture. */
export function evaluate({ points, source, value }) {
  return draw(points, around('', source, `  result = ${value};`), () => []);
}

/** Draws a pixel for each point. `bind(program)` returns further textures. */
function draw(points, shader, bind) {
  context();
  const height = Math.ceil(points.length / 4 / WIDTH);
  const program = link(shader);
  gl.useProgram(program);

  // Holds the points, filled up with zeros to whole rows.
  const padded = new Float32Array(WIDTH * height * 4);
  padded.set(points);
  const place = texture(gl.TEXTURE0, gl.TEXTURE_2D, gl.NEAREST);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, WIDTH, height, 0, gl.RGBA, gl.FLOAT, padded);
  gl.uniform1i(gl.getUniformLocation(program, 'points'), 0);

  const bound = bind(program);

  const target = texture(gl.TEXTURE2, gl.TEXTURE_2D, gl.NEAREST);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, WIDTH, height);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.viewport(0, 0, WIDTH, height);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.readPixels(0, 0, WIDTH, height, gl.RGBA, gl.FLOAT, padded);

  const errors = glErrors(gl);
  if (errors.length > 0) throw new Error(`WebGL2: ${errors.join(', ')}`);
  for (const one of [place, ...bound, target]) gl.deleteTexture(one);
  gl.deleteFramebuffer(frame);
  gl.deleteProgram(program);
  return padded.subarray(0, points.length);
}

/** Writes the shader of a table's lookup. */
function fragment(layered, source, name, fields) {
  const values = [0, 1, 2, 3].map((i) => (i < fields.length ? `found.${fields[i]}` : '0.0'));
  const uniform = `uniform highp ${layered ? 'sampler2DArray' : 'sampler2D'} bound_table;`;
  return around(uniform, source, `\
  SplitSum found = splitsum_${name}(bound_table, point.x, point.y${layered ? ', point.z' : ''});
  result = vec4(${values.join(', ')});`);
}

/** Writes the shader around the generated code. Sets no precision that the code must set. */
function around(uniform, source, lines) {
  return `#version 300 es
precision highp float;
uniform highp sampler2D points;
${uniform}
out vec4 result;
${source}
void main() {
  vec4 point = texelFetch(points, ivec2(gl_FragCoord.xy), 0);
${lines}
}`;
}

/** Compiles and links. Throws with the driver's log. */
function link(source) {
  const program = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, CORNERS], [gl.FRAGMENT_SHADER, source]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
      throw new Error(`GLSL: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.attachShader(program, shader);
    gl.deleteShader(shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(`GLSL: ${gl.getProgramInfoLog(program)}`);
  }
  return program;
}

/** Makes a texture without mips, clamped at its edges. Leaves it bound to the unit. */
function texture(unit, kind, filter) {
  const made = gl.createTexture();
  gl.activeTexture(unit);
  gl.bindTexture(kind, made);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
    gl.texParameteri(kind, name, filter);
  }
  for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) {
    gl.texParameteri(kind, name, gl.CLAMP_TO_EDGE);
  }
  return made;
}

/** Uploads the table to unit 1, filtered linearly. */
function upload({ width, height, layers, webgl }) {
  const [internal, layout, type] = [webgl.internal, webgl.layout, webgl.type].map((n) => gl[n]);
  if (layers === 0) {
    const made = texture(gl.TEXTURE1, gl.TEXTURE_2D, gl.LINEAR);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, layout, type, webgl.data);
    return made;
  }
  const made = texture(gl.TEXTURE1, gl.TEXTURE_2D_ARRAY, gl.LINEAR);
  const size = [width, height, layers];
  gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, internal, ...size, 0, layout, type, webgl.data);
  return made;
}

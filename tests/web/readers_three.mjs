// Reads files by three.js inside the page.

import {
  FloatType, GLSL3, Mesh, NearestFilter, OrthographicCamera, PlaneGeometry, RawShaderMaterial,
  RGBAFormat, Scene, WebGLRenderer, WebGLRenderTarget,
} from 'three';
import { glErrors } from './gl_errors.mjs';
import { EXRLoader } from '/three/examples/jsm/loaders/EXRLoader.js';
import { KTX2Loader } from '/three/examples/jsm/loaders/KTX2Loader.js';

// Covers the target, whatever the camera.
const VERTICES = `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;
// Copies texel to pixel of the same place: row 0 of the file to row 0 of what is read back.
const COPY = `
precision highp float;
uniform highp sampler2D table;
out vec4 texel;
void main() { texel = texelFetch(table, ivec2(gl_FragCoord.xy), 0); }`;

const renderer = new WebGLRenderer();

/** Reads a KTX2 file: uploads it and reads back what a shader sees. */
export async function readKtx2(url, { width, height }) {
  const loader = new KTX2Loader().detectSupport(renderer);
  const table = await loader.loadAsync(url);
  const faults = [];
  if (table.image.width !== width || table.image.height !== height) {
    faults.push(`is ${table.image.width} x ${table.image.height}`);
  }
  const values = sample(table, width, height);
  faults.push(...glErrors(renderer.getContext()));
  table.dispose();
  loader.dispose();
  return { components: 4, values: Array.from(values), faults };
}

/** Draws a table into a float target of its size. Returns four floats for each texel. */
function sample(table, width, height) {
  const target = new WebGLRenderTarget(width, height, {
    type: FloatType, format: RGBAFormat, depthBuffer: false,
    minFilter: NearestFilter, magFilter: NearestFilter,
  });
  const material = new RawShaderMaterial({
    glslVersion: GLSL3, vertexShader: VERTICES, fragmentShader: COPY,
    uniforms: { table: { value: table } }, depthTest: false, depthWrite: false,
  });
  const scene = new Scene().add(new Mesh(new PlaneGeometry(2, 2), material));
  renderer.setRenderTarget(target);
  renderer.render(scene, new OrthographicCamera());
  const values = new Float32Array(width * height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, values);
  renderer.setRenderTarget(null);
  target.dispose();
  material.dispose();
  return values;
}

/** Reads an EXR file. Turns the rows: three's loader puts the lowest first. */
export async function readExr(url) {
  const { image } = await new EXRLoader().setDataType(FloatType).loadAsync(url);
  const { width, height, data } = image;
  const components = data.length / (width * height);
  const row = width * components;
  const values = [];
  for (let y = height - 1; y >= 0; y--) values.push(...data.subarray(y * row, (y + 1) * row));
  return { components, values, faults: [] };
}

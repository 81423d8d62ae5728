// Takes out the tables that three.js and Babylon.js ship, as .npy files.
// Usage: node shipped.mjs OUTFOLDER
// Writes three.npy (f32: scale, bias), babylon_raw_rgba8.npy and babylon_openpbr_raw_rgba8.npy (u8,
// as stored in their PNG). Each has the shape (height, width, channels), the first row first.
// Prints one JSON line for each.

import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { getDFGLUT } from 'three/src/renderers/shaders/DFGLUTData.js';
import { fromHalf } from './half.mjs';
import { decodePng } from './png.mjs';

const BABYLON = join(import.meta.dirname, 'node_modules/@babylonjs/core/Misc/brdfTextureTools.js');

/** Takes the PNG out of a constant of Babylon's file, whose constants are not exported. */
function pngOf(source, constant) {
  const match = new RegExp(`\\b${constant} = "data:image/png;base64,([^"]+)"`).exec(source);
  if (match === null) throw new Error(`Babylon has no ${constant}`);
  return decodePng(Buffer.from(match[1], 'base64'));
}

/** Writes the bytes of a .npy file, version 1.0. The header fills a multiple of 64 bytes. */
function npy(type, shape, data) {
  const dict = `{'descr': '${type}', 'fortran_order': False, 'shape': (${shape.join(', ')}), }`;
  const length = Math.ceil((10 + dict.length + 1) / 64) * 64 - 10;
  const header = Buffer.alloc(10, '\x93NUMPY\x01\x00', 'latin1');
  header.writeUInt16LE(length, 8);
  const text = Buffer.from(`${dict.padEnd(length - 1)}\n`, 'latin1');
  return Buffer.concat([header, text, Buffer.from(data.buffer, data.byteOffset, data.byteLength)]);
}

const [folder] = process.argv.slice(2);
if (folder === undefined) throw new Error('usage: node shipped.mjs OUTFOLDER');
await mkdir(folder, { recursive: true });

/** Writes one table and tells of it. */
async function put(name, type, { width, height, channels, data }) {
  const shape = [height, width, channels];
  await writeFile(join(folder, name), npy(type, shape, data));
  console.log(JSON.stringify({ file: name, shape, type }));
}

const { width, height, data } = getDFGLUT().image;
const halves = Float32Array.from(data, fromHalf);
await put('three.npy', '<f4', { width, height, channels: 2, data: halves });

const source = await readFile(BABYLON, 'utf8');
await put('babylon_raw_rgba8.npy', '|u1', pngOf(source, '_environmentBRDFBase64Texture'));
const openPbr = pngOf(source, '_openPBREnvironmentBRDFBase64Texture');
await put('babylon_openpbr_raw_rgba8.npy', '|u1', openPbr);

// Reads splitsum's files by libraries that are not ours and compares value by value.
// Usage: node readers.mjs MANIFEST.json
// Prints one JSON line for each file and reader: file, reader, ok, maxDifference, note.
// Judges nothing: a reader that is known to fail is not an error here.
//
// The manifest lists files; its paths are relative to it:
//   path        the file
//   kind        "ktx2", "exr" or "dds"
//   width, height, components
//   expected    f64, little endian: the values, row by row from the top (layer by layer)
//   bytes       for KTX2: the raw bytes of its level
//   vkFormat, layers  for KTX2: checked where given
//   tolerance   the largest difference that is still `ok`, if not the one below

import { readFile } from 'node:fs/promises';
import { dirname, join, resolve } from 'node:path';
import { withPage } from './chromium.mjs';
import { readByDescriptor } from './descriptor.mjs';

// Lets a GPU divide an 8-bit value by 255 in f32. Floats come through exactly.
const TOLERANCE = 2e-7;

const MODULES = join(import.meta.dirname, 'node_modules');
const THREE = { imports: { three: '/three/src/Three.js' } };

/** Names the readers of each kind. Each is a function of a file's entry, its URL and the page. */
const READERS = {
  ktx2: { 'ktx-parse': byDescriptor, three: inPage('readers_three.mjs', 'readKtx2') },
  exr: { three: inPage('readers_three.mjs', 'readExr') },
  dds: { babylon: inPage('readers_babylon.mjs', 'readDds') },
};

/** Reads by ktx-parse, in Node. */
async function byDescriptor(file) {
  return readByDescriptor(await readFile(file.path), await readFile(file.bytes), file);
}

/** Reads by a function of a module, in the page. */
function inPage(module, name) {
  const call = async (job) => (await import(`/web/${job.module}`))[job.name](job.url, job.file);
  return (file, url, page) => page.evaluate(call, { module, name, url, file });
}

/** Compares what a reader found with what is expected. */
function compare(file, expected, { components, values, faults }) {
  const notes = [...faults];
  const texels = expected.length / file.components;
  if (components < file.components) notes.push(`has ${components} components`);
  if (values.length / components < texels) {
    notes.push(`has ${values.length / components} of ${texels} texels`);
  }
  const read = Math.min(texels, values.length / components);
  const shared = Math.min(components, file.components);
  let largest = 0;
  for (let texel = 0; texel < read; texel++) {
    for (let c = 0; c < shared; c++) {
      const got = values[texel * components + c];
      const difference = Math.abs(got - expected[texel * file.components + c]);
      // Keeps a value that is no number from passing unseen.
      largest = Math.max(largest, Number.isNaN(difference) ? Infinity : difference);
    }
  }
  const ok = notes.length === 0 && largest <= (file.tolerance ?? TOLERANCE);
  // Becomes null in JSON where it is infinite.
  return { ok, maxDifference: largest, note: notes.join('; ') };
}

/** Runs all readers of one file. Prints a line for each. */
async function readOne(file, url, page) {
  const bytes = await readFile(file.expected);
  const expected = new Float64Array(bytes.buffer.slice(bytes.byteOffset).slice(0, bytes.length));
  for (const [reader, run] of Object.entries(READERS[file.kind])) {
    let result;
    try {
      result = compare(file, expected, await run(file, url, page));
    } catch (error) {
      const message = error.message.replace(/^page\.evaluate: (Error: )?/, '');
      const note = `refused: ${message.split('\n')[0]}`;
      result = { ok: false, maxDifference: null, note };
    }
    console.log(JSON.stringify({ file: file.path, reader, ...result }));
  }
}

const [manifest] = process.argv.slice(2);
if (manifest === undefined) throw new Error('usage: node readers.mjs MANIFEST.json');
const base = dirname(resolve(manifest));
const { files } = JSON.parse(await readFile(manifest, 'utf8'));
if (files.length === 0) throw new Error(`${manifest} lists no file`);
const folders = {
  '/web/': import.meta.dirname,
  '/three/': join(MODULES, 'three'),
  '/babylon/': join(MODULES, '@babylonjs/core'),
};
const entries = files.map((file, number) => {
  const entry = { ...file };
  for (const key of ['path', 'expected', 'bytes']) {
    if (file[key] !== undefined) entry[key] = resolve(base, file[key]);
  }
  // Ends in the file's kind: Babylon chooses a loader by it.
  const url = `/file/${number}.${file.kind}`;
  folders[url] = entry.path;
  return [entry, url];
});
await withPage(folders, async (page) => {
  for (const [entry, url] of entries) await readOne(entry, url, page);
}, THREE);

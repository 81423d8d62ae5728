// Reads DDS files by Babylon.js inside the page.

import { glErrors } from './gl_errors.mjs';
import { Engine } from '/babylon/Engines/engine.js';
import '/babylon/Engines/Extensions/engine.readTexture.js';
import { Texture } from '/babylon/Materials/Textures/texture.js';
import { Logger } from '/babylon/Misc/logger.js';
import { Scene } from '/babylon/scene.js';

const messages = [];
// Keeps Babylon's errors for the report. They would fail the page as console errors.
Logger.Error = (message) => messages.push([message].flat().join(' '));

const engine = new Engine(document.createElement('canvas'));
const scene = new Scene(engine);

/** Reads a DDS file: uploads it and reads the texture back. */
export async function readDds(url, { width, height }) {
  messages.length = 0;
  const texture = await load(url);
  const size = texture.getSize();
  const pixels = await texture.readPixels();
  texture.dispose();

  const faults = messages.map((message) => `error: ${message}`);
  faults.push(...glErrors(engine._gl));
  if (size.width !== width || size.height !== height) {
    faults.push(`is ${size.width} x ${size.height}`);
  }
  if (pixels === null) throw new Error(['no pixels', ...faults].join('; '));
  const eight = pixels instanceof Uint8Array;
  if (eight) faults.push('is read as RGBA8');
  return { components: 4, values: Array.from(pixels, (p) => (eight ? p / 255 : p)), faults };
}

/** Loads a texture without mips, rows as stored. */
function load(url) {
  return new Promise((done, fail) => {
    const texture = new Texture(url, scene, {
      noMipmap: true,
      invertY: false,
      samplingMode: Texture.NEAREST_SAMPLINGMODE,
      onLoad: () => done(texture),
      onError: (message) => fail(new Error(message ?? 'not loaded')),
    });
  });
}

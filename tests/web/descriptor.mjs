// Reads a KTX2 file by ktx-parse, and decodes its texels by nothing but the file's own data format
// descriptor. Wrong values here mean a descriptor that does not describe the data.

import { KHR_DF_TRANSFER_SRGB, KHR_SUPERCOMPRESSION_NONE, read, write } from 'ktx-parse';
import { fromHalf } from './half.mjs';

const FLOAT = 0x80;
const LINEAR = 0x10;
const CHANNEL = 15;
const ALPHA = 15;

/**
 * Reads a file.
 *
 * `wanted` holds what the manifest says: width, height, and where given vkFormat and layers.
 * `raw` holds the bytes that the one level must have.
 * Returns the values, texel by texel, and notes on all that is not as wanted.
 */
export function readByDescriptor(bytes, raw, wanted) {
  const file = read(bytes);
  const faults = [];
  const check = (name, got, want) => {
    if (want !== undefined && got !== want) faults.push(`${name} is ${got}, not ${want}`);
  };
  check('vkFormat', file.vkFormat, wanted.vkFormat);
  check('pixelWidth', file.pixelWidth, wanted.width);
  check('pixelHeight', file.pixelHeight, wanted.height);
  check('layerCount', file.layerCount, wanted.layers ?? 0);
  check('levels', file.levels.length, 1);
  check('scheme', file.supercompressionScheme, KHR_SUPERCOMPRESSION_NONE);
  const level = Buffer.from(file.levels[0].levelData);
  if (!level.equals(raw)) faults.push('the level has other bytes');
  // Keeps our KTXwriter: ktx-parse puts in its own name otherwise.
  if (!Buffer.from(write(file, { keepWriter: true })).equals(bytes)) {
    faults.push('ktx-parse writes other bytes');
  }

  const [descriptor] = file.dataFormatDescriptor;
  const components = descriptor.samples.length;
  descriptor.samples.forEach(({ channelType }, i) => {
    check(`channel ${i}`, channelType & CHANNEL, i === 3 ? ALPHA : i);
  });
  return { components, values: decode(level, descriptor), faults };
}

/** Decodes all texels of a level. */
function decode(level, { samples, bytesPlane, transferFunction }) {
  const size = bytesPlane[0];
  const curved = transferFunction === KHR_DF_TRANSFER_SRGB;
  const values = [];
  for (let at = 0; at + size <= level.length; at += size) {
    // Reads the texel as one number: its bytes are little endian.
    const bytes = Buffer.from(level.subarray(at, at + size)).reverse();
    const texel = BigInt(`0x${bytes.toString('hex')}`);
    for (const sample of samples) {
      const value = valueOf(texel, sample);
      const { channelType } = sample;
      const linear = (channelType & LINEAR) !== 0 || (channelType & CHANNEL) === ALPHA;
      values.push(curved && !linear ? fromSrgb(value) : value);
    }
  }
  return values;
}

/** Takes one sample's bits out of a texel. ktx-parse keeps the length less one, as files do. */
function valueOf(texel, { bitOffset, bitLength, channelType, sampleUpper }) {
  const bits = Number((texel >> BigInt(bitOffset)) & ((1n << BigInt(bitLength + 1)) - 1n));
  if ((channelType & FLOAT) === 0) return bits / sampleUpper;
  if (bitLength + 1 === 16) return fromHalf(bits);
  if (bitLength + 1 !== 32) throw new Error(`a float of ${bitLength + 1} bits`);
  return new Float32Array(Uint32Array.of(bits).buffer)[0];
}

/** Applies the sRGB curve's inverse. */
function fromSrgb(value) {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

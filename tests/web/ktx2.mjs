// Reads the plain KTX2 files that splitsum writes: one level, no supercompression.
// Runs in Node and in a page.

const MAGIC = [0xab, 0x4b, 0x54, 0x58, 0x20, 0x32, 0x30, 0xbb, 0x0d, 0x0a, 0x1a, 0x0a];

// Gives for each vkFormat: bytes of a texel, WebGPU's name, WebGL2's three names, view of its data.
const FORMATS = {
  9: [1, 'r8unorm', 'R8', 'RED', 'UNSIGNED_BYTE', Uint8Array],
  16: [2, 'rg8unorm', 'RG8', 'RG', 'UNSIGNED_BYTE', Uint8Array],
  37: [4, 'rgba8unorm', 'RGBA8', 'RGBA', 'UNSIGNED_BYTE', Uint8Array],
  43: [4, 'rgba8unorm-srgb', 'SRGB8_ALPHA8', 'RGBA', 'UNSIGNED_BYTE', Uint8Array],
  64: [4, 'rgb10a2unorm', 'RGB10_A2', 'RGBA', 'UNSIGNED_INT_2_10_10_10_REV', Uint32Array],
  76: [2, 'r16float', 'R16F', 'RED', 'HALF_FLOAT', Uint16Array],
  83: [4, 'rg16float', 'RG16F', 'RG', 'HALF_FLOAT', Uint16Array],
  97: [8, 'rgba16float', 'RGBA16F', 'RGBA', 'HALF_FLOAT', Uint16Array],
  100: [4, 'r32float', 'R32F', 'RED', 'FLOAT', Float32Array],
  103: [8, 'rg32float', 'RG32F', 'RG', 'FLOAT', Float32Array],
  109: [16, 'rgba32float', 'RGBA32F', 'RGBA', 'FLOAT', Float32Array],
};

/**
 * Reads a file.
 *
 * Returns its width, height, layers (0 for a 2D texture, N for an array of N), the format's names
 * and the bytes of its level. Throws on anything that splitsum does not write.
 */
export function readKtx2(buffer) {
  const view = new DataView(buffer);
  const u32 = (at) => view.getUint32(at, true);
  const u64 = (at) => Number(view.getBigUint64(at, true));
  if (buffer.byteLength < 104) throw new Error('KTX2: shorter than its header');
  if (MAGIC.some((byte, i) => view.getUint8(i) !== byte)) throw new Error('KTX2: wrong magic');

  const vkFormat = u32(12);
  if (!(vkFormat in FORMATS)) throw new Error(`KTX2: vkFormat ${vkFormat} is not known here`);
  const [texelBytes, webgpu, internal, layout, type, View] = FORMATS[vkFormat];
  const [width, height, layers] = [u32(20), u32(24), u32(32)];
  expect('pixelDepth', u32(28), 0);
  expect('faceCount', u32(36), 1);
  expect('levelCount', u32(40), 1);
  expect('supercompressionScheme', u32(44), 0);

  const [offset, length] = [u64(80), u64(88)];
  expect('level length', length, width * height * Math.max(layers, 1) * texelBytes);
  if (offset + length > buffer.byteLength) throw new Error('KTX2: the level is cut short');
  const level = buffer.slice(offset, offset + length);
  const webgl = { internal, layout, type, data: new View(level) };
  return { vkFormat, width, height, layers, texelBytes, webgpu, webgl, level };
}

/** Throws unless a header's field has the one value that splitsum writes. */
function expect(name, got, wanted) {
  if (got !== wanted) throw new Error(`KTX2: ${name} is ${got}, not ${wanted}`);
}

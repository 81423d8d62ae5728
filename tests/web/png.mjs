// Decodes PNG pictures of 8 bits, RGB or RGBA, not interlaced. A browser would premultiply alpha or
// apply a colour profile; a table's bytes must come through as they are.

import { inflateSync } from 'node:zlib';

const MAGIC = Buffer.from('89504e470d0a1a0a', 'hex');
// Gives the channels of each colour type that is read here.
const CHANNELS = { 2: 3, 6: 4 };

/** Decodes a picture: width, height, channels and its bytes, row by row from the top. */
export function decodePng(bytes) {
  if (!bytes.subarray(0, 8).equals(MAGIC)) throw new Error('PNG: wrong magic');
  let header;
  const packed = [];
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at);
    const type = bytes.toString('latin1', at + 4, at + 8);
    const body = bytes.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') header = body;
    if (type === 'IDAT') packed.push(body);
    at += length + 12;
  }
  const [width, height] = [header.readUInt32BE(0), header.readUInt32BE(4)];
  const [depth, colour, , , interlaced] = header.subarray(8);
  const channels = CHANNELS[colour];
  if (depth !== 8 || channels === undefined || interlaced !== 0) {
    throw new Error(`PNG: ${depth} bits, colour type ${colour}, interlace ${interlaced}`);
  }
  const lines = inflateSync(Buffer.concat(packed));
  return { width, height, channels, data: unfilter(lines, width * channels, height, channels) };
}

/** Undoes the filter of each row. A row begins with its filter's number. */
function unfilter(lines, stride, height, channels) {
  const data = new Uint8Array(stride * height);
  for (let y = 0; y < height; y++) {
    const filter = lines[y * (stride + 1)];
    for (let x = 0; x < stride; x++) {
      const at = y * stride + x;
      const left = x < channels ? 0 : data[at - channels];
      const up = y === 0 ? 0 : data[at - stride];
      const corner = x < channels || y === 0 ? 0 : data[at - stride - channels];
      data[at] = lines[y * (stride + 1) + 1 + x] + predict(filter, left, up, corner);
    }
  }
  return data;
}

/** Predicts a byte from its neighbours: none, left, up, their mean, or the nearest to a plane. */
function predict(filter, left, up, corner) {
  if (filter === 0) return 0;
  if (filter === 1) return left;
  if (filter === 2) return up;
  if (filter === 3) return (left + up) >> 1;
  if (filter !== 4) throw new Error(`PNG: filter ${filter}`);
  const plane = left + up - corner;
  const [toLeft, toUp, toCorner] = [left, up, corner].map((value) => Math.abs(plane - value));
  if (toLeft <= toUp && toLeft <= toCorner) return left;
  return toUp <= toCorner ? up : corner;
}

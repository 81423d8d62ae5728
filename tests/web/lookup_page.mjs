// Evaluates one case of lookup.mjs inside the page, in both languages.

import { readKtx2 } from './ktx2.mjs';
import * as webgl from './lookup_webgl.mjs';
import * as webgpu from './lookup_webgpu.mjs';

/** Names the browser and the devices that draw. */
export async function devices() {
  return {
    browser: navigator.userAgent,
    webgl: webgl.device(),
    webgpu: await webgpu.device(),
  };
}

/** Evaluates both functions in both languages. Returns one entry for each of the four. */
export async function evaluate(job) {
  const points = new Float32Array(await bytes(job.points));
  const expected = new Float32Array(await bytes(job.expected));
  if (points.length === 0 || points.length % 4 !== 0 || points.length !== expected.length) {
    throw new Error(`${job.name}: points and expected values must be as many, four floats each`);
  }
  return job.values === undefined ? ofTable(job, points, expected) : ofValues(job, points, expected);
}

/** The same of a table. */
async function ofTable(job, points, expected) {
  const table = readKtx2(await bytes(job.table));
  if ((table.layers > 0) !== (job.third !== null)) {
    throw new Error(`${job.name}: a third parameter and layers belong together`);
  }
  const results = [];
  for (const [language, api] of [['glsl', webgl], ['wgsl', webgpu]]) {
    const source = new TextDecoder().decode(await bytes(job[language]));
    for (const name of job.functions ?? ['filtered', 'exact']) {
      const found = await api.lookup({ table, points, source, name, fields: job.fields });
      const label = { case: job.name, language, function: name };
      results.push({ ...label, ...compare(found, expected, points, job) });
    }
  }
  return results;
}

/** The same of the expressions of a job without a table: one entry for each language. */
async function ofValues(job, points, expected) {
  const results = [];
  for (const [language, api] of [['glsl', webgl], ['wgsl', webgpu]]) {
    const source = new TextDecoder().decode(await bytes(job[language]));
    const found = await api.evaluate({ points, source, value: job.values[language] });
    const label = { case: job.name, language };
    results.push({ ...label, ...compare(found, expected, points, { ...job, third: null }) });
  }
  return results;
}

/** Compares what a function gave with what was expected. Fails on a value that is no number. */
function compare(found, expected, points, { name, fields, third }) {
  let [largest, worst, sum] = [-1, 0, 0];
  for (let i = 0; i < expected.length; i += 4) {
    for (let f = 0; f < fields.length; f++) {
      const difference = Math.abs(found[i + f] - expected[i + f]);
      if (!Number.isFinite(difference)) {
        const pair = `${found[i + f]} for ${expected[i + f]}`;
        throw new Error(`${name}: point ${i / 4}, ${fields[f]}: ${pair}`);
      }
      sum += difference;
      if (difference > largest) [largest, worst] = [difference, i + f];
    }
  }
  const first = worst - (worst % 4);
  const at = { point: first / 4, nov: points[first], roughness: points[first + 1] };
  if (third !== null) at[third] = points[first + 2];
  Object.assign(at, { field: fields[worst % 4], found: found[worst], expected: expected[worst] });
  const count = points.length / 4;
  return { points: count, largest, mean: sum / (count * fields.length), at };
}

/** Fetches a file's bytes. */
async function bytes(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${await response.text()}`);
  return response.arrayBuffer();
}

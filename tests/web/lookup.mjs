// Runs the generated lookup code in Chromium and compares it with expected values.
// Usage: node lookup.mjs MANIFEST.json
// Prints one JSON object: the devices, and for each case, language and function the differences.
//
// The manifest lists cases; its paths are relative to it:
//   name      a name for the report
//   table     a KTX2 file that splitsum wrote, if not values
//   glsl      generated GLSL ES 3.00 functions
//   wgsl      generated WGSL functions
//   fields    the members of the struct `SplitSum`, at most four
//   functions the functions to run, if not both
//   third     null, or the name of the third parameter of a table with layers
//   values    instead of a table, its functions and its third parameter: in each language an
//             expression of the vec4 `point`, whose first components are the fields
//   points    f32, little endian: n.v, roughness, third, 0 for each point
//   expected  f32, little endian: the fields in order, then zeros, four for each point

import { readFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import { withPage } from './chromium.mjs';

const FILES = ['table', 'glsl', 'wgsl', 'points', 'expected'];

/** Serves each file of each case, and tells the page where. */
function jobsOf(cases, base, folders) {
  return cases.map((one, number) => {
    const job = { ...one };
    for (const file of FILES.filter((file) => file in one)) {
      job[file] = `/case/${number}/${file}`;
      folders[job[file]] = resolve(base, one[file]);
    }
    return job;
  });
}

/** Evaluates all cases in one page. */
async function evaluate(page, jobs) {
  const devices = await page.evaluate(async () => (await import('/web/lookup_page.mjs')).devices());
  const results = [];
  for (const job of jobs) {
    const run = async (one) => (await import('/web/lookup_page.mjs')).evaluate(one);
    results.push(...(await page.evaluate(run, job)));
  }
  return { ...devices, results };
}

const [manifest] = process.argv.slice(2);
if (manifest === undefined) throw new Error('usage: node lookup.mjs MANIFEST.json');
const { cases } = JSON.parse(await readFile(manifest, 'utf8'));
if (cases.length === 0) throw new Error(`${manifest} lists no case`);
const folders = { '/web/': import.meta.dirname };
const jobs = jobsOf(cases, dirname(resolve(manifest)), folders);
console.log(JSON.stringify(await withPage(folders, (page) => evaluate(page, jobs)), null, 1));

// Renders a row of metal spheres by three.js twice: with three's own DFG table, and with ours.
// Usage: node spheres.mjs OUT.png REPLACEMENT.js
// Saves one picture, three's own row above, and prints the difference of the rows as JSON.
//
// REPLACEMENT.js stands in for three's src/renderers/shaders/DFGLUTData.js: it exports
// `getDFGLUT()` and may import three's files by the same relative paths. Three itself stays as it
// is: the server gives one file for the other.

import { join, resolve } from 'node:path';
import { withPage } from './chromium.mjs';

const THREE = join(import.meta.dirname, 'node_modules/three/');
const TABLE = 'src/renderers/shaders/DFGLUTData.js';

const [picture, replacement] = process.argv.slice(2);
if (replacement === undefined) throw new Error('usage: node spheres.mjs OUT.png REPLACEMENT.js');

// Serves three twice, so that each copy of its modules has a table of its own.
const folders = {
  '/web/': import.meta.dirname,
  '/own/': THREE,
  '/replaced/': THREE,
  [`/replaced/${TABLE}`]: resolve(replacement),
};
const scopes = {
  '/own/': { three: '/own/src/Three.js' },
  '/replaced/': { three: '/replaced/src/Three.js' },
};

const difference = await withPage(folders, async (page) => {
  const run = async (table) => (await import('/web/spheres_page.mjs')).renderBoth(table);
  const { width, height, ...found } = await page.evaluate(run, TABLE);
  await page.setViewportSize({ width, height });
  await page.screenshot({ path: picture });
  return found;
}, { scopes });
console.log(JSON.stringify(difference));

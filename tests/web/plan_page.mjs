// Opens the page of a plan in Chromium, light and dark, wide and narrow.
// Usage: node plan_page.mjs PAGE.html
// Prints one JSON object: what went wrong, what was asked for, and what the page shows.

import { resolve } from 'node:path';
import { withPage } from './chromium.mjs';

const [file] = process.argv.slice(2);
if (file === undefined) throw new Error('usage: node plan_page.mjs PAGE.html');

/** Runs in the page: the sizes of its pictures and the contrast of its text. */
async function look() {
  const svgs = [...document.querySelectorAll('svg')].map((svg) => {
    const { width, height } = svg.getBoundingClientRect();
    return [width, height];
  });
  const addresses = [...document.querySelectorAll('image, img')].map(
    (image) => image.getAttribute('href') ?? image.getAttribute('src'),
  );
  const images = await Promise.all(
    addresses.map(async (address) => {
      const image = new Image();
      image.src = address;
      await image.decode();
      return [image.naturalWidth, image.naturalHeight];
    }),
  );
  const light = (colour) => {
    const parts = colour.match(/\d+/g).slice(0, 3).map((part) => part / 255);
    const linear = parts.map((p) => (p <= 0.04045 ? p / 12.92 : ((p + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05;
  };
  const paper = light(getComputedStyle(document.body).backgroundColor);
  const contrast = (element, property) => {
    const ink = light(getComputedStyle(element)[property]);
    return Math.max(ink / paper, paper / ink);
  };
  const texts = [...document.querySelectorAll('p, td, th, figcaption, h2')];
  const labels = [...document.querySelectorAll('svg text')];
  return {
    svgs,
    images,
    scripts: document.scripts.length,
    headings: [...document.querySelectorAll('h2')].map((heading) => heading.textContent),
    overflow: document.documentElement.scrollWidth - window.innerWidth,
    contrast: Math.min(
      ...texts.map((element) => contrast(element, 'color')),
      ...labels.map((element) => contrast(element, 'fill')),
    ),
  };
}

const folders = { '/plan.html': resolve(file) };
const answer = await withPage(folders, async (page) => {
  const wrong = [];
  const requests = [];
  page.on('console', (message) => wrong.push(`${message.type()}: ${message.text()}`));
  page.on('requestfailed', (request) => wrong.push(`failed: ${request.url().slice(0, 100)}`));
  page.on('dialog', (dialog) => {
    wrong.push(`dialog: ${dialog.message()}`);
    return dialog.dismiss();
  });
  page.on('request', (request) => requests.push(request.url().split(',')[0]));
  const views = [];
  for (const colorScheme of ['light', 'dark']) {
    for (const width of [1200, 390]) {
      await page.emulateMedia({ colorScheme });
      await page.setViewportSize({ width, height: 900 });
      await page.goto(new URL('/plan.html', page.url()).href, { waitUntil: 'load' });
      views.push({ colorScheme, width, ...(await page.evaluate(look)) });
    }
  }
  return { wrong, requests: [...new Set(requests)], views };
});
console.log(JSON.stringify(answer));

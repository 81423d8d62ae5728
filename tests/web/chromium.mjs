// Opens a page in Debian's Chromium on a local server.
// Gives WebGL2 and WebGPU on any machine: SwiftShader draws both on the CPU.

import { createServer } from 'node:http';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { chromium } from 'playwright-core';

// Names the program. A machine that keeps Chromium elsewhere sets CHROMIUM.
const PROGRAM = process.env.CHROMIUM ?? '/usr/bin/chromium';

const FLAGS = [
  // Keeps root in a container able to start it.
  '--no-sandbox',
  // Keeps it quiet: nothing but our server is asked for anything.
  '--no-first-run',
  '--disable-quic',
  '--disable-sync',
  '--disable-background-networking',
  '--disable-component-update',
  '--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1',
  // Draws WebGL2 by SwiftShader.
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
  // Draws WebGPU by SwiftShader's Vulkan.
  '--enable-unsafe-webgpu',
  '--enable-features=Vulkan',
  '--use-webgpu-adapter=swiftshader',
];

// Lists the types that a browser insists on. Anything else is plain bytes.
const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.json': 'application/json',
  '.wasm': 'application/wasm',
};

/**
 * Opens an empty page, runs `use(page)` and returns its answer.
 *
 * `folders` maps a URL's beginning to a folder ("/three/" ends in a slash) or to one file. The
 * longest beginning wins, so that a file can stand in for another inside a folder.
 * `importMap` names the modules that the page imports by a bare name.
 * Throws if `use` throws, or if the page or its console reports an error.
 */
export async function withPage(folders, use, importMap = {}) {
  const server = await serve(folders, importMap);
  const profile = await mkdtemp(join(tmpdir(), 'splitsum-web-'));
  const errors = [];
  let context;
  try {
    context = await chromium.launchPersistentContext(profile, {
      executablePath: PROGRAM,
      headless: true,
      args: FLAGS,
    });
    const page = await context.newPage();
    page.on('pageerror', (error) => errors.push(`page: ${error.stack ?? error}`));
    page.on('console', (message) => {
      if (message.type() === 'error') errors.push(`console: ${message.text()}`);
    });
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    const answer = await use(page);
    if (errors.length > 0) throw new Error('the page reported errors');
    return answer;
  } catch (error) {
    if (errors.length > 0) error.message += `\n${errors.join('\n')}`;
    throw error;
  } finally {
    await context?.close();
    server.closeAllConnections();
    server.close();
    await rm(profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** Starts the server on a free port. The page itself is at "/". */
async function serve(folders, importMap) {
  const starts = Object.keys(folders).sort((a, b) => b.length - a.length);
  const server = createServer(async (request, response) => {
    const { pathname } = new URL(request.url, 'http://127.0.0.1');
    if (pathname === '/') {
      response.writeHead(200, { 'Content-Type': 'text/html' });
      response.end(emptyPage(importMap));
      return;
    }
    try {
      const bytes = await readFile(fileAt(folders, starts, decodeURIComponent(pathname)));
      const type = TYPES[extname(pathname)] ?? 'application/octet-stream';
      response.writeHead(200, { 'Content-Type': type }).end(bytes);
    } catch (error) {
      response.writeHead(404, { 'Content-Type': 'text/plain' }).end(String(error.message));
    }
  });
  await new Promise((done, fail) => {
    server.once('error', fail);
    server.listen(0, '127.0.0.1', done);
  });
  return server;
}

/** Finds the file behind a path. Stays inside the folder: `..` is resolved before joining. */
function fileAt(folders, starts, path) {
  const start = starts.find((s) => path === s || (s.endsWith('/') && path.startsWith(s)));
  if (start === undefined) throw new Error(`nothing is served at ${path}`);
  const rest = path.slice(start.length);
  return rest === '' ? folders[start] : join(folders[start], normalize(`/${rest}`));
}

/** Writes the empty page. An icon of its own spares a request that would fail. */
function emptyPage(importMap) {
  return `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">
<style>body { margin: 0; background: #fff } canvas { display: block }</style>
<script type="importmap">${JSON.stringify(importMap)}</script>`;
}

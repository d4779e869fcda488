// Opens a page in headless Chromium and says in JSON what it does there: what it asks the network for, what it complains
// of, whether the picture changes with time, and the values that it shows.
//
//   node check.mjs page.html [--rows 0,10] [--columns a,b] [--dimensions 0,10] [--picture file.png [--row 10] [--select JOINT/1] [--size 1200x800]]
import { chromium } from 'playwright-core';
import { existsSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [page, ...rest] = process.argv.slice(2);
const option = (name) => (rest.includes(name) ? rest[rest.indexOf(name) + 1] : undefined);
const browsers = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome', process.env.CHROMIUM].filter(Boolean);
const executablePath = browsers.find((path) => existsSync(path));
if (!executablePath) {
  console.log(JSON.stringify({ skipped: 'there is no Chromium' }));
  process.exit(0);
}
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--hide-scrollbars'] });
const [width, height] = (option('--size') ?? '1280x800').split('x').map(Number);
const tab = await browser.newPage({ viewport: { width, height } });
const found = { requests: [], errors: [], values: {}, colours: 0, changed: 0 };
tab.on('request', (r) => /^(file|data|blob):/.test(r.url()) || found.requests.push(r.url()));
tab.on('pageerror', (e) => found.errors.push(e.message));
tab.on('console', (m) => m.type() === 'error' && found.errors.push(m.text()));
await tab.goto(pathToFileURL(page).href);
await tab.waitForSelector('body[data-ready]', { timeout: 20000 });
const rows = await tab.evaluate(() => cognate.data.runs[0].rows);
// the picture at the beginning and in the middle
const pixels = (row) => tab.evaluate((row) => {
  cognate.toRow(row);
  cognate.draw();
  const canvas = document.querySelector('#stage canvas');
  const gl = canvas.getContext('webgl2');
  const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  window.pixelsBefore ??= bytes;
  const colours = new Set();
  let changed = 0;
  for (let k = 0; k < bytes.length; k += 4) {
    const [r, g, b] = bytes.subarray(k, k + 3);
    if (Math.max(r, g, b) - Math.min(r, g, b) > 40 && bytes[k + 3] > 200) colours.add(((r >> 5) << 6) | ((g >> 5) << 3) | (b >> 5));
    if (Math.abs(r - window.pixelsBefore[k]) + Math.abs(g - window.pixelsBefore[k + 1]) + Math.abs(b - window.pixelsBefore[k + 2]) > 60) changed++;
  }
  return { colours: colours.size, changed };
}, row);
found.colours = (await pixels(0)).colours;
found.changed = (await pixels(Math.floor((rows - 1) / 3))).changed;
found.rows = rows;
found.overlaps = await tab.evaluate(() => cognate.data.overlaps.map(({ elements, depth, row, place }) => ({ elements, depth, row, place: place.map((c) => c[row]), before: place.map((c) => Number.isFinite(c[0])) })));
for (const row of (option('--rows') ?? '').split(',').filter(Boolean).map(Number)) {
  await tab.evaluate((row) => cognate.toRow(row), row);
  for (const column of (option('--columns') ?? '').split(',').filter(Boolean)) {
    (found.values[column] ??= []).push(await tab.evaluate((column) => cognate.value(column), column));
  }
}
if (option('--dimensions')) {
  found.dimensions = [];
  for (const row of option('--dimensions').split(',').map(Number)) {
    found.dimensions.push(await tab.evaluate((row) => (cognate.toRow(row), cognate.dimensions()), row));
  }
  // of joints and markers one kind is seen
  const seen = () => tab.evaluate(() => ['Joints', 'Markers'].map((name) => [...document.querySelectorAll('#tools button')].find((b) => b.textContent === name)?.className === 'on'));
  found.symbols = [await seen()];
  for (const name of ['Markers', 'Joints']) {
    await tab.click(`#tools button:text-is("${name}")`);
    found.symbols.push(await seen());
  }
}
if (rows > 1) {
  await tab.evaluate(() => (cognate.toRow(0), cognate.play()));
  // a browser without a graphics card takes its time
  const moves = () => cognate.state.row > 0 || cognate.state.t > cognate.data.runs[0].times[0];
  found.played = await tab.waitForFunction(moves, null, { timeout: 8000 }).then(() => true, () => false);
  await tab.evaluate(() => cognate.pause());
}
if (option('--picture')) {
  const state = { row: Number(option('--row') ?? 0), select: option('--select') ?? null };
  await tab.evaluate(({ row, select }) => (cognate.select(select), cognate.toRow(row)), state);
  for (const name of (option('--press') ?? '').split(',').filter(Boolean)) await tab.click(`#tools button:text-is("${name}")`);
  await tab.waitForTimeout(200);
  await tab.screenshot({ path: option('--picture') });
}
await browser.close();
console.log(JSON.stringify(found));

// Opens pages in headless Chromium, one after the other, and says in JSON what each of them does: whether it is shown, what it
// complains of, what part of the picture is drawn at its times, and how many pictures a second it plays.
//
//   node open.mjs [--sizes 1280x800,390x844] [--times 8] [--play] [--save] [--without webgl|script] page.html …
import { chromium } from 'playwright-core';
import { existsSync, readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const words = process.argv.slice(2);
const taken = (name, fallback) => (words.includes(name) ? words.splice(words.indexOf(name), 2)[1] : fallback);
const flag = (name) => words.includes(name) && Boolean(words.splice(words.indexOf(name), 1));
const sizes = taken('--sizes', '1280x800').split(',').map((size) => size.split('x').map(Number));
const times = Number(taken('--times', '8'));
const without = taken('--without', '');
const [plays, saves] = [flag('--play'), flag('--save')];
const browsers = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome', process.env.CHROMIUM].filter(Boolean);
const executablePath = browsers.find((path) => existsSync(path));
if (!executablePath) {
  console.log(JSON.stringify({ skipped: 'there is no Chromium' }));
  process.exit(0);
}
const graphics = without === 'webgl' ? ['--disable-3d-apis'] : ['--enable-unsafe-swiftshader'];
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--hide-scrollbars', ...graphics] });

/** Returns the parts of the picture that have a colour of their own, at times from the first to the last. */
const drawn = (tab) => tab.evaluate((times) => {
  const { rows } = cognate.data.runs[0];
  const canvas = document.querySelector('#stage canvas');
  const gl = canvas.getContext('webgl2');
  if (!gl) return null;
  const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  const n = Math.min(times, rows);
  return Array.from({ length: n }, (_, k) => {
    cognate.toRow(n > 1 ? Math.round((k * (rows - 1)) / (n - 1)) : 0);
    cognate.draw();
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    let own = 0;
    for (let at = 0; at < bytes.length; at += 4) {
      const [r, g, b] = [bytes[at], bytes[at + 1], bytes[at + 2]];
      if (bytes[at + 3] > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 40) own++;
    }
    return (4 * own) / bytes.length;
  });
}, times);

/** Returns the elements that are struck out at the same times. */
const struckOut = (tab) => tab.evaluate((times) => {
  const { rows } = cognate.data.runs[0];
  const n = Math.min(times, rows);
  return Array.from({ length: n }, (_, k) => {
    cognate.toRow(n > 1 ? Math.round((k * (rows - 1)) / (n - 1)) : 0);
    return [...document.querySelectorAll('#tree .row.off')].map((row) => row.title);
  });
}, times);

/** Returns what the place in the middle of the screen says, and whether the parts of the page have room. */
const layout = (tab) => tab.evaluate(() => {
  const stage = document.getElementById('stage')?.getBoundingClientRect();
  const play = document.getElementById('play')?.getBoundingClientRect();
  const middle = document.elementFromPoint(innerWidth / 2, innerHeight / 2);
  return {
    middle: middle?.closest('#failure, #without')?.textContent ?? '',
    wider: document.documentElement.scrollWidth - innerWidth,
    stage: stage && [stage.width / innerWidth, stage.height / innerHeight],
    play: play && play.width > 20 && play.left >= 0 && play.right <= innerWidth && play.top >= 0 && play.bottom <= innerHeight,
  };
});

/** Presses a tool that saves a file; returns the beginning of that, its size and its name. */
async function saved(tab, name) {
  const [download] = await Promise.all([tab.waitForEvent('download', { timeout: 60000 }), tab.click(`#tools button:text-is("${name}")`)]);
  const bytes = readFileSync(await download.path());
  return { name: download.suggestedFilename(), size: bytes.length, begins: bytes.subarray(0, 8).toString('latin1') };
}

const all = [];
for (const page of words) {
  for (const [width, height] of sizes) {
    const context = await browser.newContext({ viewport: { width, height }, javaScriptEnabled: without !== 'script', acceptDownloads: true });
    const tab = await context.newPage();
    const found = { page, size: `${width}x${height}`, requests: [], errors: [] };
    tab.on('request', (r) => /^(file|data|blob):/.test(r.url()) || found.requests.push(r.url()));
    tab.on('pageerror', (e) => found.errors.push(e.message));
    tab.on('console', (m) => m.type() === 'error' && found.errors.push(m.text()));
    await tab.goto(pathToFileURL(page).href);
    // a browser without a graphics card takes its time
    const shown = tab.waitForSelector('body[data-ready]', { timeout: 120000, state: 'attached' }).then(() => true);
    const failed = tab.waitForSelector('#failure:has(p)', { timeout: 120000 }).then(() => false);
    found.ready = without !== 'script' && (await Promise.race([shown, failed]).catch(() => false));
    Promise.allSettled([shown, failed]);
    if (without === 'script') found.layout = { middle: await tab.locator('#failure').innerText() };
    else found.layout = await layout(tab);
    if (found.ready) {
      found.rows = await tab.evaluate(() => cognate.data.runs[0].rows);
      found.drawn = await drawn(tab);
      found.off = await struckOut(tab);
      found.values = await tab.evaluate(() => document.querySelectorAll('#values td.number').length);
    }
    if (found.ready && plays && found.rows > 1) {
      await tab.evaluate(() => (cognate.toRow(0), cognate.play()));
      await tab.waitForFunction(() => cognate.state.rate > 0, null, { timeout: 120000 }).catch(() => {});
      found.rate = await tab.evaluate(() => [cognate.state.rate, document.getElementById('rate').textContent]);
      await tab.evaluate(() => cognate.pause());
    }
    if (found.ready && saves) {
      found.picture = await saved(tab, 'Picture');
      found.film = await saved(tab, 'Film');
    }
    all.push(found);
    await context.close();
  }
}
await browser.close();
console.log(JSON.stringify(all));

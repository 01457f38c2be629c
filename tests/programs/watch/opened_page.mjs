// SPDX-License-Identifier: MIT
// The page that a browser test has open: what one can do to it, what it says, and the checks.
//   node <test> <chromium> <page.html> <folder for screenshots> ...
import { writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { Chromium } from './chromium.mjs';

const [program, page, folder, ...rest] = process.argv.slice(2);
export const given = rest;
const count = { checks: 0, failures: 0 };
export function check(what, good, detail = '') {
  ++count.checks;
  if (good) return;
  ++count.failures;
  console.error(`FAILED: ${what}${detail === '' ? '' : `: ${detail}`}`);
}
export const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;
export const sleep = (seconds) => new Promise((wake) => setTimeout(wake, 1000 * seconds));

const complaints = [];
const requests = [];
export const url = pathToFileURL(resolve(page)).href;
export const chromium = new Chromium(program);
chromium.on((method, p) => {
  if (method === 'Runtime.exceptionThrown')
    complaints.push(p.exceptionDetails.exception?.description ?? p.exceptionDetails.text);
  if (method === 'Runtime.consoleAPICalled' && ['error', 'assert'].includes(p.type))
    complaints.push(p.args.map((a) => a.value ?? a.description).join(' '));
  if (method === 'Log.entryAdded' && p.entry.level === 'error') complaints.push(`${p.entry.text} ${p.entry.url ?? ''}`);
  if (method === 'Network.requestWillBeSent') requests.push(p.request.url);
  if (method === 'Network.webSocketCreated') requests.push(p.url);
});

/** Without a network; done once the expression holds. */
export async function open(started) {
  await chromium.attach();
  for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await chromium.send(`${domain}.enable`);
  await chromium.send('Network.emulateNetworkConditions', {
    offline: true,
    latency: 0,
    downloadThroughput: 0,
    uploadThroughput: 0,
  });
  await resize(1280, 800, { deviceScaleFactor: 1 });
  await chromium.send('Page.navigate', { url });
  let opened = false;
  for (let i = 0; i < 100 && !opened && complaints.length === 0; ++i) {
    await sleep(0.1);
    opened = await evaluate(started);
  }
  if (!opened) throw new Error(`the page did not start; it said: ${complaints.join('; ') || 'nothing'}`);
  await drawn();
}

/** Nothing came from elsewhere, nothing was complained of. */
export async function isWhole() {
  check('no resource was asked for', (await evaluate('performance.getEntriesByType("resource").length')) === 0);
  const foreign = requests.filter((request) => request !== url && !request.startsWith('data:'));
  check('no network request', foreign.length === 0, foreign.join(' '));
  check('the page itself was seen by the network log', requests.includes(url));
  check('no error in the console', complaints.length === 0, complaints.join('; '));
}

/** The steps of a test, one after the other; the exit status says whether all held. */
export async function run(...steps) {
  const begin = Date.now();
  try {
    for (const step of steps) await step();
  } catch (error) {
    check('the test ran to its end', false, error.stack);
    if (complaints.length > 0) console.error(`the page said: ${complaints.join('; ')}`);
  } finally {
    await chromium.close();
  }
  console.log(
    `browser: ${count.checks - count.failures} of ${count.checks} checks passed in ${((Date.now() - begin) / 1000).toFixed(1)} s`,
  );
  process.exitCode = count.failures === 0 ? 0 : 1;
}

export const evaluate = (expression) => chromium.evaluate(expression);
export const figure = async (id) =>
  Number((await evaluate(`document.getElementById('${id}').textContent`)).replace('\u2212', '-'));
/** Two frames on, whatever was asked for has been drawn. */
export const drawn = () =>
  evaluate('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))');
/** The window is of this size, on a screen of two dots a pixel unless said otherwise. */
export const resize = (width, height, { mobile = false, deviceScaleFactor = 2 } = {}) =>
  chromium.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor, mobile });
export async function press(key, code = key, modifiers = 0) {
  for (const type of ['keyDown', 'keyUp'])
    await chromium.send('Input.dispatchKeyEvent', { type, key, code, modifiers });
  await drawn();
}
export async function mouse(type, x, y, button = 'left') {
  await chromium.send('Input.dispatchMouseEvent', {
    type,
    x,
    y,
    button,
    buttons: type === 'mouseReleased' ? 0 : 1,
    clickCount: 1,
  });
}
async function touch(type, ...points) {
  await chromium.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
}
/** Fingers that go from one place to another each, in steps. */
export async function drag(from, to, steps = 6) {
  await touch('touchStart', ...from);
  for (let i = 1; i <= steps; ++i)
    await touch(
      'touchMove',
      ...from.map(([x, y], f) => [x + ((to[f][0] - x) * i) / steps, y + ((to[f][1] - y) * i) / steps]),
    );
  await touch('touchEnd');
  await drawn();
}

export async function click(selector, share = 0.5) {
  const box = await evaluate(`document.querySelector('${selector}').getBoundingClientRect().toJSON()`);
  const [x, y] = [box.x + share * box.width, box.y + box.height / 2];
  await mouse('mouseMoved', x, y);
  await mouse('mousePressed', x, y);
  await mouse('mouseReleased', x, y);
  await drawn();
}
export const slide = async (time) => {
  await evaluate(
    `{ const s = document.getElementById('slider'); s.value = ${time}; s.dispatchEvent(new Event('input')); }`,
  );
  await drawn();
};
export async function screenshot(name) {
  const png = (await chromium.send('Page.captureScreenshot', { format: 'png' })).data;
  writeFileSync(join(folder, name), Buffer.from(png, 'base64'));
  return chromium.pixels(png);
}
export const cameraPlace = () => evaluate('replay.camera.camera.position.toArray()');
export const distance = (a, b) => Math.hypot(...a.map((value, i) => value - b[i]));

/** Relative luminance of sRGB, 0 to 255 (WCAG 2.2). */
export function luminance(colour) {
  const [r, g, b] = colour.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

// SPDX-License-Identifier: MIT
// A headless Chromium spoken to over a pipe (DevTools protocol, messages end with a zero byte), and what a screenshot
// holds. No packages: what tests the page must not need a download.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { inflateSync } from 'node:zlib';

export class Chromium {
  #next = 0;
  #waiting = new Map();
  #listeners = [];
  #buffer = Buffer.alloc(0);

  constructor(program) {
    this.profile = mkdtempSync(join(tmpdir(), 'pinnquad-browser-'));
    const root = process.getuid?.() === 0; // Chromium's sandbox refuses root
    this.process = spawn(
      program,
      [
        '--headless=new',
        '--remote-debugging-pipe',
        `--user-data-dir=${this.profile}`,
        ...(root ? ['--no-sandbox'] : []),
        '--use-gl=angle',
        '--use-angle=swiftshader',
        '--enable-unsafe-swiftshader',
        '--disable-dev-shm-usage',
        '--no-first-run',
        '--disable-extensions',
        '--disable-background-networking',
        '--disable-component-update',
        '--host-resolver-rules=MAP * ~NOTFOUND',
        '--window-size=1280,800',
        '--hide-scrollbars',
        'about:blank',
      ],
      { stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe'] },
    );
    this.stderr = '';
    this.process.stderr.on('data', (text) => {
      this.stderr = (this.stderr + text).slice(-4000);
    });
    this.process.stdio[4].on('data', (data) => this.#receive(data));
    this.process.stdio[3].on('error', () => {}); // the exit says it better
    this.exited = new Promise((resolve) => this.process.once('close', resolve));
    this.process.once('error', (error) => this.#fail(error));
    this.process.once('close', (code) => this.#fail(new Error(`chromium ended (code ${code}): ${this.stderr}`)));
  }

  /** A command and its result. */
  send(method, parameters = {}, sessionId = this.session) {
    const id = ++this.#next;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`${method} got no answer in 60 s`)), 60000);
      this.#waiting.set(id, { resolve, reject, timer, method });
      this.process.stdio[3].write(`${JSON.stringify({ id, method, params: parameters, sessionId })}\0`);
    });
  }

  on(listener) {
    this.#listeners.push(listener);
  }

  /** Attaches to the window's page: send() speaks to it from here on. */
  async attach() {
    const { targetInfos } = await this.send('Target.getTargets');
    const { targetId } = targetInfos.find((target) => target.type === 'page');
    this.session = (await this.send('Target.attachToTarget', { targetId, flatten: true })).sessionId;
  }

  /** The value of an expression in the page. */
  async evaluate(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', {
      expression,
      returnByValue: true,
      awaitPromise: true,
    });
    if (exceptionDetails)
      throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }

  async close() {
    const late = setTimeout(() => this.process.kill('SIGKILL'), 5000);
    if (this.process.exitCode === null)
      await this.send('Browser.close', {}, undefined).catch(() => this.process.kill('SIGKILL'));
    await this.exited;
    clearTimeout(late);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }

  #receive(data) {
    this.#buffer = Buffer.concat([this.#buffer, data]);
    for (let end = this.#buffer.indexOf(0); end >= 0; end = this.#buffer.indexOf(0)) {
      const message = JSON.parse(this.#buffer.subarray(0, end).toString());
      this.#buffer = this.#buffer.subarray(end + 1);
      if (message.id === undefined) {
        for (const listener of this.#listeners) listener(message.method, message.params);
        continue;
      }
      const call = this.#waiting.get(message.id);
      if (!call) continue;
      this.#waiting.delete(message.id);
      clearTimeout(call.timer);
      if (message.error) call.reject(new Error(`${call.method}: ${message.error.message}`));
      else call.resolve(message.result);
    }
  }

  #fail(error) {
    for (const call of this.#waiting.values()) {
      clearTimeout(call.timer);
      call.reject(error);
    }
    this.#waiting.clear();
  }
}

/** Width, height and bytes (RGB or RGBA) of a PNG as Chromium writes it: 8 bit, not interlaced. */
export function readPng(file) {
  const chunks = [];
  let width, height, channels;
  for (let at = 8; at < file.length;) {
    const size = file.readUInt32BE(at);
    const kind = file.toString('latin1', at + 4, at + 8);
    const body = file.subarray(at + 8, at + 8 + size);
    if (kind === 'IHDR') {
      [width, height] = [body.readUInt32BE(0), body.readUInt32BE(4)];
      channels = { 2: 3, 6: 4 }[body[9]];
      if (body[8] !== 8 || !channels || body[12] !== 0) throw new Error('a PNG of another kind than expected');
    }
    if (kind === 'IDAT') chunks.push(body);
    at += size + 12;
  }
  const raw = inflateSync(Buffer.concat(chunks));
  const stride = width * channels;
  const pixels = Buffer.alloc(height * stride);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? pixels[y * stride + x - channels] : 0;
      const above = y > 0 ? pixels[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y > 0 ? pixels[(y - 1) * stride + x - channels] : 0;
      pixels[y * stride + x] = raw[y * (stride + 1) + 1 + x] + predict(filter, left, above, corner);
    }
  }
  return { width, height, channels, pixels };
}

/** The PNG filters (ISO/IEC 15948, clause 9). */
function predict(filter, left, above, corner) {
  if (filter === 0) return 0;
  if (filter === 1) return left;
  if (filter === 2) return above;
  if (filter === 3) return (left + above) >> 1;
  const guess = left + above - corner;
  const [a, b, c] = [Math.abs(guess - left), Math.abs(guess - above), Math.abs(guess - corner)];
  return a <= b && a <= c ? left : b <= c ? above : corner;
}

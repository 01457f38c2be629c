// SPDX-License-Identifier: MIT
// A headless Chromium spoken to over a pipe (DevTools protocol, messages end with a zero byte), and what a screenshot
// holds. No packages: what tests the page must not need a download.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

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

  /** Width, height and bytes (RGBA) of a PNG in base 64, decoded by the page. */
  async pixels(png) {
    const { width, height, bytes } = await this.evaluate(`(async () => {
      const image = new Image();
      image.src = 'data:image/png;base64,${png}';
      await image.decode();
      const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
      canvas.drawImage(image, 0, 0);
      const { width, height, data } = canvas.getImageData(0, 0, image.width, image.height);
      const reader = new FileReader();
      reader.readAsDataURL(new Blob([data]));
      await new Promise((read) => (reader.onload = read));
      return { width, height, bytes: reader.result.split(',')[1] };
    })()`);
    return { width, height, channels: 4, pixels: Buffer.from(bytes, 'base64') };
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

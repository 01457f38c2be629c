// SPDX-License-Identifier: MIT
// The page on small screens, under fingers, and in light and dark.
import { rows } from './flight.mjs';
import {
  cameraPlace,
  check,
  chromium,
  click,
  distance,
  drag,
  drawn,
  evaluate,
  figure,
  luminance,
  near,
  resize,
  screenshot,
  sleep,
} from './opened_page.mjs';

const boxes = (...ids) =>
  evaluate(`${JSON.stringify(ids)}.map((id) => document.getElementById(id).getBoundingClientRect().toJSON())`);
const overlap = (a, b) =>
  Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
  Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));

/** The axis under the timeline: labels in seconds, each where a click on it leads, none over another. */
export async function axisIsTrue(where) {
  const labels = await evaluate(`[...document.querySelectorAll('#axis span')].map((tick) => ({
    seconds: tick.textContent, box: tick.getBoundingClientRect().toJSON(), share: parseFloat(tick.style.left) / 100 }))`);
  check(`${where}: the axis has ticks`, labels.length >= 3, labels.length);
  check(
    `${where}: the labels are seconds`,
    labels.every(({ seconds }) => /^\d+(\.\d+)? s$/.test(seconds)),
    labels.map(({ seconds }) => seconds).join(),
  );
  check(
    `${where}: no label lies on the next`,
    labels.every(({ box }, i) => i === 0 || box.left >= labels[i - 1].box.right),
  );
  const [timeline] = await boxes('timeline');
  check(
    `${where}: no label leaves the timeline`,
    labels.every(({ box }) => box.left >= timeline.left - 1 && box.right <= timeline.right + 1),
  );
  const tick = labels[Math.floor(labels.length / 2)];
  await click('#timeline', tick.share);
  const pixel = (rows[rows.length - 1].t - rows[0].t) / timeline.width;
  check(`${where}: a click at ${tick.seconds}`, near(await figure('time'), parseFloat(tick.seconds), pixel + 0.006));
}

/** A small screen: nothing over the view, everything within the window, fingers do what the mouse does. */
export async function phoneWorks() {
  await chromium.send('Emulation.setTouchEmulationEnabled', { enabled: true, maxTouchPoints: 2 });
  for (const [width, height] of [
    [390, 844],
    [320, 568],
    [844, 390],
  ]) {
    const where = `${width} x ${height}`;
    await resize(width, height, { mobile: true });
    await sleep(0.3);
    await drawn();
    const panels = ['head', 'telemetry', 'rotors', 'legend', 'bar'];
    const [view, ...others] = await boxes('view', ...panels);
    others.forEach((box, i) => {
      check(`${where}: ${panels[i]} is beside the view`, overlap(view, box) < 1, `${overlap(view, box)} pixels`);
      check(
        `${where}: ${panels[i]} is in the window`,
        box.left >= 0 && box.top >= 0 && box.right <= width + 0.5 && box.bottom <= height + 0.5,
        JSON.stringify(box),
      );
    });
    const least = 0.2 * width * height;
    check(`${where}: the view has room`, view.width * view.height > least, `${view.width} x ${view.height}`);
    check(
      `${where}: the view is not stretched`,
      near(await evaluate('replay.camera.camera.aspect'), view.width / view.height, 0.02),
    );
    const out =
      await evaluate(`[...document.querySelectorAll('.panel *')].filter((e) => { const b = e.getBoundingClientRect();
      return b.width > 0 && !e.closest('svg') && (b.right > ${width} + 1 || b.bottom > ${height} + 1); }).map((e) => e.id)`);
    check(`${where}: nothing is cut off`, out.length === 0, out.join());
    await axisIsTrue(where);
    await screenshot(`replay_${width}.png`);
  }
  await resize(390, 844, { mobile: true });
  await sleep(0.3);
  await evaluate('replay.setCamera("follow")');
  await drawn();
  const [view, timeline] = await boxes('view', 'timeline');
  const [x, y] = [view.x + view.width / 2, view.y + view.height / 2];
  const away = () => evaluate('replay.camera.camera.position.distanceTo(replay.camera.controls.target)');
  const [before, far] = [await cameraPlace(), await away()];
  await drag([[x, y]], [[x + 90, y + 10]]);
  check('one finger orbits', distance(await cameraPlace(), before) > 0.2 * far && near(await away(), far, 0.01 * far));
  await drag(
    [
      [x - 30, y],
      [x + 30, y],
    ],
    [
      [x - 90, y],
      [x + 90, y],
    ],
  );
  check('two fingers apart come nearer', (await away()) < 0.6 * far, `${far} m, then ${await away()} m`);
  const row = timeline.y + 20;
  await drag([[timeline.x + 0.2 * timeline.width, row]], [[timeline.x + 0.75 * timeline.width, row]]);
  const wanted = rows[0].t + 0.75 * (rows[rows.length - 1].t - rows[0].t);
  check('a finger drags the time', near(await figure('time'), wanted, 0.3), `${await figure('time')} s, not ${wanted}`);
  await chromium.send('Emulation.setTouchEmulationEnabled', { enabled: false });
}

/** The panels follow the reader's colour scheme; their text stays readable. */
export async function schemesWork() {
  const seen = [];
  for (const value of ['light', 'dark']) {
    await chromium.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value }] });
    await drawn();
    const [text, panel] = await evaluate(`[getComputedStyle(document.getElementById('speed')).color,
      getComputedStyle(document.getElementById('bar')).backgroundColor]`);
    const numbers = [text, panel].map((colour) =>
      luminance(
        colour
          .match(/[\d.]+/g)
          .slice(0, 3)
          .map(Number),
      ),
    );
    const contrast = (Math.max(...numbers) + 0.05) / (Math.min(...numbers) + 0.05);
    check(`${value}: figures stand out from their panel`, contrast >= 7, `${text} on ${panel}: ${contrast}`);
    seen.push(numbers[1]);
  }
  check('light panels are lighter than dark ones', seen[0] > seen[1] + 0.5, seen.join());
}

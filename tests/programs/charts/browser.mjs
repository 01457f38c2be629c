// SPDX-License-Identifier: MIT
// Opens the page of a training in headless Chromium, without a network, and uses its charts as a person would: points, drags,
// shows and hides, on a wide window and on a phone's, in light and dark. What is drawn is compared with report.json, which did
// not go through the page.
//   node browser.mjs <chromium> <report.html> <folder for screenshots> <report.json>
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

import {
  check,
  chromium,
  drag,
  drawn,
  evaluate,
  given,
  isWhole,
  mouse,
  near,
  open,
  resize,
  run,
  screenshot,
  sleep,
  url,
} from '../watch/opened_page.mjs';

const report = JSON.parse(readFileSync(given[0], 'utf8'));
const loop = report.closed_loop;
/** A chart of the page as an expression: its figure's place in an open page, and its panel's. */
const chart = (figure, panel = 0) => `chartOf(document.querySelectorAll('${figure}')[0].querySelectorAll('canvas')[${panel}])`;
const path = (panel) => chart('main > figure .chart', panel);
const series = (of) => evaluate(`${of}.data.datasets.map(({ label, data, hidden }) => ({ label, data, hidden }))`);
const named = (list, label) => list.find((one) => one.label === label).data;
const range = (of) => evaluate(`[${of}.scales.x.min, ${of}.scales.x.max, ${of}.scales.y.min, ${of}.scales.y.max]`);

/** Where a share of the plot is on the screen, the plot in the middle of the window. */
async function place(of, across, up) {
  await evaluate(`${of}.canvas.scrollIntoView({ block: 'center' })`);
  await drawn();
  return evaluate(`(() => { const { left, right, top, bottom } = ${of}.chartArea, box = ${of}.canvas.getBoundingClientRect();
    return [box.x + left + ${across} * (right - left), box.y + bottom + ${up} * (top - bottom)]; })()`);
}
/** Pixels of a chart's canvas that have about this colour. */
const pixels = (of, colour) =>
  evaluate(`(() => { const { canvas } = ${of}, { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const wanted = [1, 3, 5].map((i) => parseInt('${colour}'.slice(i, i + 2), 16));
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 200 && wanted.every((c, k) => Math.abs(c - data[i + k]) < 12)) ++count;
    return count; })()`);
const blue = { light: '#1f5f9e', dark: '#79b0e6' };

async function pageOpens() {
  await open('Boolean(window.chartOf) && document.querySelectorAll("canvas").length >= 2');
  await screenshot('report.png');
  check('the verdict comes first', await evaluate(`document.querySelector('main').firstElementChild.matches('.verdict')`));
  check(
    'the path begins in the first window',
    (await evaluate(`${path(0)}.canvas.getBoundingClientRect().top`)) < 800 - 200,
  );
  check('chapters are folded', (await evaluate('document.querySelectorAll("details[open]").length')) === 0);
}

async function dataAreTheRuns() {
  const flown = await series(path(1));
  for (const [name, key] of [
    ['with the model', 'model'],
    ['without the model', 'without_jerk'],
  ]) {
    const most = Math.max(...named(flown, name).map(({ y }) => y));
    const wanted = 100 * loop[key].largest_error_m;
    check(`the largest distance ${name}`, most <= wanted + 1e-3 && most > 0.95 * wanted, `${most} cm, not ${wanted}`);
  }
  const planned = named(await series(path(0)), 'planned');
  const north = Math.max(...planned.map(({ y }) => y));
  check('the planned path is as long as the figure-eight', near(north, loop.half_length_m, 0.01), `${north} m`);
  await evaluate(`location.hash = 'flights'`);
  await sleep(0.5);
  await drawn();
  const models = Object.values(report.models)
    .filter(({ by_flight }) => by_flight)
    .map(({ by_flight }) => Object.values(by_flight).map(({ rmse }) => 1e3 * rmse));
  for (const { label, data } of await series(chart('#flights'))) {
    check(
      `errors by flight: ${label}`,
      models.some((errors) => errors.length === data.length && errors.every((e, i) => near(e, data[i].x, 1e-6 * e))),
      JSON.stringify(data),
    );
  }
  const rows = await evaluate(`${chart('#flights')}.scales.y.ticks.map(({ label }) => label)`);
  check('each flight has its name', rows.join() === Object.keys(report.models[report.exported_model].by_flight).join(), rows);
}

async function hoverTells() {
  const of = path(1);
  for (const share of [0.25, 0.7]) {
    const [x, y] = await place(of, share, 0.5);
    await mouse('mouseMoved', x, y);
    await drawn();
    const { opacity, title, body } = await evaluate(`(({ opacity, title, body }) => ({ opacity, title, body }))(${of}.tooltip)`);
    const [least, most] = await range(of);
    const time = Number(title[0].split(': ')[1]);
    check(`hover at ${share} shows the instant`, opacity === 1 && near(time, least + share * (most - least), 0.11), title[0]);
    const lines = body.flatMap(({ lines }) => lines);
    for (const { label, data } of await series(of)) {
      const value = data.reduce((best, one) => (Math.abs(one.x - time) < Math.abs(best.x - time) ? one : best)).y;
      check(`hover at ${share}: ${label}`, lines.includes(`${label}: ${Number(value.toPrecision(4))}`), lines.join('; '));
    }
  }
  await screenshot('report_hover.png');
}

async function dragZooms() {
  for (const [of, what] of [
    [path(1), 'time'],
    [path(0), 'path'],
  ]) {
    const whole = await range(of);
    const [x0, y0] = await place(of, 0.3, 0.8);
    const [x1, y1] = await place(of, 0.6, 0.2);
    await mouse('mousePressed', x0, y0);
    for (const share of [0.3, 0.6, 1]) await mouse('mouseMoved', x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    await mouse('mouseReleased', x1, y1);
    await sleep(0.2);
    await drawn();
    const [left, right, low, high] = await range(of);
    const at = (value, from) => (value - whole[from]) / (whole[from + 1] - whole[from]);
    const shares = [at(left, 0), at(right, 0), at(low, 2), at(high, 2)];
    check(`${what}: a drag zooms`, [0.3, 0.6, 0.2, 0.8].every((s, i) => near(s, shares[i], 0.02)), shares.join());
    if (what === 'time') await screenshot('report_zoom.png');
    for (const clickCount of [1, 2])
      for (const type of ['mousePressed', 'mouseReleased'])
        await chromium.send('Input.dispatchMouseEvent', { type, x: x1, y: y1, button: 'left', clickCount });
    await sleep(0.2);
    check(`${what}: a double click goes back`, (await range(of)).every((v, i) => near(v, whole[i], 1e-9)), await range(of));
  }
}

async function fingersZoom() {
  const of = path(1);
  await resize(390, 844, { mobile: true, deviceScaleFactor: 1 });
  await chromium.send('Emulation.setTouchEmulationEnabled', { enabled: true, maxTouchPoints: 2 });
  const whole = await range(of);
  const at = await Promise.all([0.3, 0.45, 0.55, 0.7, 0.05, 0.95].map((share) => place(of, share, 0.5)));
  const scrolled = await evaluate('scrollY');
  await drag([at[1], at[2]], [at[0], at[3]]);
  const spread = await range(of);
  const share = (spread[1] - spread[0]) / (whole[1] - whole[0]);
  check('two fingers spread the time, four times as far apart', near(share, 0.25, 0.06), share);
  check('the page stays as it is', (await evaluate('visualViewport.scale')) === 1 && (await evaluate('scrollY')) === scrolled);
  await screenshot('report_pinch.png');
  await drag([at[3]], [at[0]]);
  const moved = await range(of);
  const shift = (moved[0] - spread[0]) / (spread[1] - spread[0]);
  check('a finger moves a chart that is spread', near(shift, 0.4, 0.06) && near(moved[1] - moved[0], spread[1] - spread[0], 1e-6), shift);
  await drag([at[4], at[5]], [at[1], at[2]]);
  check('fingers that close go back to all of it', (await range(of)).every((v, i) => near(v, whole[i], 1e-6)), await range(of));
  await drag([at[2]], [[at[2][0], at[2][1] - 150]]);
  check('a finger scrolls the page over a whole chart', (await evaluate('scrollY')) > scrolled + 50, await evaluate('scrollY'));
  await chromium.send('Emulation.setTouchEmulationEnabled', { enabled: false });
  await resize(1280, 800);
}

async function legendToggles() {
  const button = `[...document.querySelectorAll('main > figure .legend button')].find((b) => b.textContent === 'with the model')`;
  const hidden = async () => {
    const panels = await Promise.all([0, 1].map((panel) => series(path(panel))));
    return panels.flat().filter((one) => one.hidden).map(({ label }) => label).join();
  };
  const count = async () => [await pixels(path(0), blue.light), await pixels(path(1), blue.light)];
  await place(path(0), 0.5, 0.5);
  const before = await count();
  check('both panels have blue lines', Math.min(...before) > 100, before.join());
  for (const wanted of ['with the model,with the model', '']) {
    const [x, y] = await evaluate(`(() => { const b = ${button}; b.scrollIntoView({ block: 'center' });
      const { x, y, width, height } = b.getBoundingClientRect(); return [x + width / 2, y + height / 2]; })()`);
    for (const type of ['mousePressed', 'mouseReleased']) await mouse(type, x, y);
    await drawn();
    check(`the legend: hidden is '${wanted}'`, (await hidden()) === wanted, await hidden());
    check('the button says so', (await evaluate(`${button}.ariaPressed`)) === String(wanted === ''));
    const now = await count();
    check('the lines are gone or back', now.every((n, i) => (wanted === '' ? n > 0.9 * before[i] : n < 5)), now.join());
  }
}

async function copies() {
  await evaluate(`document.querySelector('.copy button').click()`);
  const copied = await evaluate('getSelection().toString()');
  check('the copy button takes the Inputs', copied.includes('::Inputs inputs;') && copied.includes('predict(inputs'), copied);
}

async function chaptersDraw() {
  await evaluate(`dispatchEvent(new Event('beforeprint'))`);
  await sleep(0.5);
  await drawn();
  check('on paper every chart is drawn', await evaluate(`[...document.querySelectorAll('.chart')].every((one) =>
    one.querySelector('canvas') && !one.querySelector('table'))`));
  const drawnPanels = await evaluate(`[...document.querySelectorAll('.chart')].map((one) => [...one.querySelectorAll('canvas')].map(
    (canvas) => chartOf(canvas).data.datasets.map(({ label, data }) => ({ name: label, x: data.map(({ x }) => x), y: data.map(({ y }) => y) }))))`);
  const held = [...readFileSync(fileURLToPath(url), 'utf8').matchAll(/<script type="application\/json">(.*?)<\/script>/g)].map(([, text]) =>
    JSON.parse(text).panels.map((panel) => panel.series.map(({ name, x, y }) => ({ name, x, y }))));
  check('at least ten charts of twenty panels', held.length >= 10 && held.flat().length >= 20, held.flat().length);
  held.forEach((panels, i) => check(`chart ${i + 1} draws the data of the page`, JSON.stringify(panels) === JSON.stringify(drawnPanels[i])));
  const decades = await evaluate(`${chart('#response')}.scales.x.ticks.map(({ label }) => label).join()`);
  check('frequencies are of a logarithmic axis', /(^|,)1\.?0?,2/.test(decades), decades);
}

async function phonesAndSchemes() {
  for (const value of ['light', 'dark']) {
    await chromium.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value }] });
    await sleep(0.2);
    await drawn();
    check(`${value}: an open page takes the scheme`, (await pixels(path(1), blue[value])) > 60);
    for (const width of [1280, 390]) {
      await resize(width, 844, { mobile: width === 390, deviceScaleFactor: 1 });
      await sleep(0.5);
      await place(path(1), 0.5, 0.5);
      const where = `${width} pixels, ${value}`;
      check(`${where}: nothing is wider`, (await evaluate('document.documentElement.scrollWidth')) <= width);
      const wide = await evaluate(`[...document.querySelectorAll('.plots > div, .legend button, canvas')].map((one) =>
        one.getBoundingClientRect()).filter(({ left, right }) => left < 0 || right > ${width}).length`);
      check(`${where}: no chart leaves the window`, wide === 0, wide);
      const [line, other] = [await pixels(path(1), blue[value]), await pixels(path(1), blue[value === 'dark' ? 'light' : 'dark'])];
      check(`${where}: the line has the scheme's blue`, line > 60 && other < 5, `${line} pixels, ${other} of the other`);
      await screenshot(`report_${width}_${value}.png`);
    }
  }
  const [across, up] = await evaluate(`(({ x, y, chartArea: a }) => [(a.right - a.left) / (x.max - x.min),
    (a.bottom - a.top) / (y.max - y.min)])({ ...${path(0)}.scales, chartArea: ${path(0)}.chartArea })`);
  check('the path has one scale on both axes', near(across / up, 1, 0.01), across / up);
}

async function restWorks() {
  const licences = await evaluate(`document.querySelector('.licence pre').textContent`);
  for (const name of ['chart.js', 'chartjs-plugin-zoom', '@kurkle/color', 'hammerjs'])
    check(`the licence of ${name}`, new RegExp(`^${name}\n\nThe MIT License`, 'm').test(licences));
  await isWhole();
}

await run(pageOpens, dataAreTheRuns, hoverTells, dragZooms, fingersZoom, legendToggles, copies, chaptersDraw, phonesAndSchemes, restWorks);

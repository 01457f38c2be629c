// SPDX-License-Identifier: MIT
// Opens a page to watch a flight in headless Chromium, without a network, and uses it as a person would: plays, drags, presses
// keys. What it shows is compared with the flight's own rows, which did not go through the page.
//   node browser.mjs <chromium> <page.html> <folder for screenshots> <rows.csv> <title>
import { rampColour } from '../../../tools/page/watch/src/ramp.js';
import { rows, title } from './flight.mjs';
import {
  cameraPlace,
  check,
  click,
  distance,
  drawn,
  evaluate,
  figure,
  isWhole,
  luminance,
  mouse,
  near,
  open,
  press,
  resize,
  run,
  screenshot,
  sleep,
  slide,
} from './opened_page.mjs';
import { axisIsTrue, phoneWorks, schemesWork } from './small_screens.mjs';

/** Body axis in the world, by the rotation matrix of the quaternion. */
function bodyAxis([w, x, y, z], axis) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ][axis];
}
/** NED in the page's axes: x east, y up, z south. */
const toPage = ([north, east, down]) => [east, -down, -north];

async function pageOpens() {
  await open('Boolean(window.replay) && Number(document.getElementById("slider").max) > 1');
  check('title', (await evaluate('document.title')) === title, await evaluate('document.title'));
  check('title on the page', (await evaluate('document.getElementById("title").textContent')) === title);
  check('every row has arrived', (await evaluate('replay.flight.rows')) === rows.length);
}

/** Whether the clock goes on by that many seconds; patient, because software draws few frames on a busy machine. */
async function timeAdvances(seconds) {
  const first = await figure('time');
  for (let i = 0; i < 100; ++i) {
    if ((await figure('time')) >= first + seconds) return true;
    await sleep(0.1);
  }
  return false;
}

/** From slow to fast the colours only get lighter, in the ramp and in the legend as the screen shows it. */
async function colourTellsSpeed() {
  const ramp = Array.from({ length: 257 }, (_, i) => luminance(rampColour(i / 256)));
  const falls = (values) => values.findIndex((value, i) => i > 0 && value < values[i - 1]);
  check('the ramp only gets lighter', falls(ramp) === -1 && ramp[0] < 0.03 && ramp[256] > 0.7, `at ${falls(ramp)}`);
  const picture = await screenshot('replay.png');
  const box = await evaluate('document.getElementById("ramp").getBoundingClientRect().toJSON()');
  const y = Math.round(box.y + box.height / 2);
  const legend = [];
  for (let x = Math.ceil(box.x) + 6; x < box.x + box.width - 6; x += 4) {
    const at = picture.channels * (y * picture.width + x);
    legend.push(luminance([...picture.pixels.subarray(at, at + 3)]));
  }
  check('the legend only gets lighter', falls(legend) === -1 && legend.at(-1) > legend[0] + 0.5, legend.join(' '));
}

async function timePasses() {
  check('it plays when opened', await timeAdvances(0.5));
  await press(' ', 'Space');
  const stopped = await figure('time');
  await sleep(0.4);
  check('Space stops it', (await figure('time')) === stopped);
  await press('ArrowRight');
  check('the right arrow goes on by a second', near(await figure('time'), stopped + 1, 0.011));
  await press('ArrowLeft');
  check('the left arrow goes back', near(await figure('time'), stopped, 0.011));
  await press('ArrowUp');
  await press('ArrowUp');
  check('the up arrow plays faster', (await evaluate('replay.rate')) === 4);
  await click('#rates button:nth-child(2)');
  check('the button 1x sets the speed', (await evaluate('replay.rate')) === 1);
  await click('#play');
  check('the play button plays', await timeAdvances(0.3));
  await click('#play');
  const paused = await figure('time');
  await sleep(0.4);
  check('the play button stops', (await figure('time')) === paused);
  await press('Home');
  check('Home', near(await figure('time'), rows[0].t, 0.006));
  await press('.', 'Period');
  check('the full stop goes one row on', near(await evaluate('replay.time'), rows[1].t, 1e-4));
  await press('End');
  check('End', near(await figure('time'), rows[rows.length - 1].t, 0.006));
  const last = rows[rows.length - 1].t;
  await click('#slider', 0.5);
  check(
    'a click in the middle of the slider',
    near(await figure('time'), (rows[0].t + last) / 2, 0.02 * last),
    `${await figure('time')} s`,
  );
}

async function posesAreTheFlights() {
  for (const i of [0, 1, Math.floor(rows.length / 3), Math.floor(rows.length / 2), rows.length - 2, rows.length - 1]) {
    const row = rows[i];
    await slide(row.t);
    const matrix = await evaluate('replay.vehicle.group.matrixWorld.elements.slice()');
    const where = `row ${i + 1}`;
    check(
      `position of ${where}`,
      distance(matrix.slice(12, 15), toPage([row.north, row.east, row.down])) < 1e-3,
      matrix.slice(12, 15),
    );
    for (const axis of [0, 1, 2]) {
      const expected = toPage(bodyAxis(row.q, axis));
      check(
        `body axis ${'xyz'[axis]} of ${where}`,
        distance(matrix.slice(4 * axis, 4 * axis + 3), expected) < 3e-4,
        matrix.slice(4 * axis, 4 * axis + 3),
      );
    }
    check(`speed of ${where}`, near(await figure('speed'), Math.hypot(...row.velocity), 0.052));
    check(`climb of ${where}`, near(await figure('climb'), -row.velocity[2], 0.052));
    check(
      `altitude of ${where}`,
      near(await figure('altitude'), (await evaluate('replay.flight.groundZ')) - row.down, 0.052),
    );
    const nose = bodyAxis(row.q, 0);
    check(`pitch of ${where}`, near(await figure('pitch'), (180 / Math.PI) * Math.asin(-nose[2]), 0.06));
    const turn = (await figure('heading')) - (180 / Math.PI) * Math.atan2(nose[1], nose[0]);
    check(`heading of ${where}`, near(turn - 360 * Math.round(turn / 360), 0, 0.52));
    const tilt = (180 / Math.PI) * Math.atan2(bodyAxis(row.q, 1)[2], bodyAxis(row.q, 2)[2]);
    check(`roll of ${where}`, near(await figure('roll'), tilt, 0.06), `${await figure('roll')} instead of ${tilt}`);
    for (const [rotor, command] of row.commands.entries()) {
      const shown = Math.min(Math.max(command, 0), 1);
      check(`command ${rotor + 1} of ${where}`, near(await figure(`u${rotor + 1}`), shown, 0.0052));
      check(
        `arrow ${rotor + 1} of ${where}`,
        near(
          await evaluate(`replay.vehicle.rotors[${rotor}].shaft.scale.y / replay.vehicle.rotors[${rotor}].fullLength`),
          shown,
          1e-3,
        ),
      );
    }
    const seen = await evaluate(
      'replay.world.localToWorld(replay.vehicle.group.position.clone()).project(replay.camera.camera).toArray()',
    );
    check(`the camera follows to ${where}`, Math.hypot(seen[0], seen[1]) < 0.3 && seen[2] < 1, seen);
  }
  const [a, b] = [rows[10], rows[11]];
  await slide((a.t + b.t) / 2);
  const between = await evaluate('replay.vehicle.group.matrixWorld.elements.slice(12, 15)');
  check(
    'between two rows',
    distance(between, toPage([a.north + b.north, a.east + b.east, a.down + b.down].map((v) => v / 2))) < 1e-3,
  );
}

/** Distinct colours and how many pixels `rule(r, g, b)` holds for, within a box given as shares of the picture. */
function statistics({ width, height, channels, pixels }, rule = () => true, box = [0, 0, 1, 1]) {
  const colours = new Set();
  let count = 0;
  for (let y = Math.floor(box[1] * height); y < Math.floor(box[3] * height); ++y) {
    for (let x = Math.floor(box[0] * width); x < Math.floor(box[2] * width); ++x) {
      const at = channels * (y * width + x);
      const [r, g, b] = [pixels[at], pixels[at + 1], pixels[at + 2]];
      colours.add((r << 16) | (g << 8) | b);
      if (rule(r, g, b)) ++count;
    }
  }
  return { colours: colours.size, count };
}
/** Pixels that differ visibly, without the bar at the bottom, whose labels may change. */
function differing(a, b) {
  let count = 0;
  for (let i = 0; i < 0.85 * a.height * a.width * a.channels; i += a.channels) {
    if (Math.abs(a.pixels[i] - b.pixels[i]) + Math.abs(a.pixels[i + 1] - b.pixels[i + 1]) > 24) ++count;
  }
  return count;
}

async function picturesShowIt() {
  await slide(rows[Math.floor(0.6 * rows.length)].t);
  await screenshot('replay.png');
  await press('h', 'KeyH'); // the instruments hidden: what is left is the canvas and the bar
  const view = [0.2, 0.05, 0.8, 0.85];
  const picture = await screenshot('replay_view.png');
  const all = statistics(picture, undefined, view);
  check('the canvas is not blank', all.colours > 400, `${all.colours} colours`);
  const orange = statistics(picture, (r, g, b) => r > 150 && g > 70 && g < 190 && b < 90, [0.3, 0.2, 0.7, 0.8]).count;
  check('the orange front of the vehicle is in the middle', orange > 40, `${orange} pixels`);
  await evaluate('replay.vehicle.group.visible = false; replay.stale = true');
  await drawn();
  const without = await screenshot('replay_view.png');
  check('the vehicle covers pixels', differing(picture, without) > 1500, `${differing(picture, without)} pixels`);
  await evaluate('replay.vehicle.group.visible = true; replay.stale = true');

  await click('#cameras button:nth-child(3)');
  const trails = [];
  for (let i = 0; i < 3; ++i) {
    trails[await evaluate('replay.trail.mode')] = await screenshot('replay_free.png');
    await press('t', 'KeyT');
  }
  const trail = differing(trails[1], trails[2]);
  check('the whole trail covers pixels', trail > 1000, `${trail} pixels`);
  const vivid = (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) > 110;
  await press('Home');
  const atFirst = statistics(await screenshot('replay_free.png'), vivid, view).count;
  await press('End');
  const atLast = statistics(await screenshot('replay_free.png'), vivid, view).count;
  check('the trail grows with the flight', atLast > 1000 && atLast > 5 * atFirst, `${atFirst} pixels, then ${atLast}`);
  await press('h', 'KeyH');
}

async function cameraObeys() {
  const before = await cameraPlace();
  await slide(rows[5].t);
  check('the free camera stands still', distance(await cameraPlace(), before) < 1e-6);
  await mouse('mouseMoved', 640, 400);
  await mouse('mousePressed', 640, 400);
  await mouse('mouseMoved', 760, 380);
  await mouse('mouseReleased', 760, 380);
  await drawn();
  check('dragging orbits', distance(await cameraPlace(), before) > 1);
  await press('r', 'KeyR');
  check('R brings the camera back', distance(await cameraPlace(), before) < 1e-6);
  await press('c', 'KeyC');
  check('C goes on to the first mode', (await evaluate('replay.camera.mode')) === 'follow');
  await press('c', 'KeyC');
  await slide(rows[Math.floor(rows.length / 2)].t);
  const behind =
    await evaluate(`(() => { const v = replay.vehicle.group.matrixWorld.elements, c = replay.camera.camera.position;
    return (c.x - v[12]) * v[0] + (c.z - v[14]) * v[2]; })()`);
  check('the chasing camera is behind the nose', behind < -0.5, `${behind} m along the nose`);
}

async function restWorks() {
  await resize(1000, 700);
  await sleep(0.3);
  await drawn();
  check(
    'the canvas takes the new size',
    (await evaluate('[replay.renderer.domElement.width, replay.renderer.domElement.height].join()')) === '2000,1400',
  );
  check('the aspect too', near(await evaluate('replay.camera.camera.aspect'), 1000 / 700, 1e-6));
  await press('?', 'Slash');
  check(
    '? shows keys and licence',
    await evaluate(
      `document.getElementById('help').open &&
        /Permission is hereby granted/.test(document.querySelector('#help pre').innerText)`,
    ),
  );
  check('nothing failed on the page', await evaluate('document.getElementById("failure").hidden'));
  await isWhole();
}

await run(
  pageOpens,
  timePasses,
  () => axisIsTrue('1280 x 800'),
  colourTellsSpeed,
  posesAreTheFlights,
  picturesShowIt,
  cameraObeys,
  phoneWorks,
  schemesWork,
  restWorks,
);

// SPDX-License-Identifier: MIT
// The replay: reads the flight that the page holds, draws it, and lets one move in time and space.
import { Box3, Matrix4, Group, Scene, Vector3, WebGLRenderer } from 'three';

import { Camera, cameraModes } from './camera.js';
import { Flight } from './flight.js';
import { Instruments } from './instruments.js';
import { scaleEnd } from './ramp.js';
import { buildGround, buildLight, buildNorthMark, buildSky, Plumb } from './surroundings.js';
import { Timeline } from './timeline.js';
import { Trail, trailModes } from './trail.js';
import { Vehicle } from './vehicle.js';

const byId = (id) => document.getElementById(id);
const rates = [0.5, 1, 2, 4];
const icons = {
  play: '<svg viewBox="0 0 18 18"><path d="M4 2l12 7-12 7z"/></svg>',
  pause: '<svg viewBox="0 0 18 18"><path d="M3 2h4v14H3zM11 2h4v14h-4z"/></svg>',
};

class Replay {
  constructor(flight) {
    this.flight = flight;
    this.time = flight.begin;
    this.playing = false;
    this.rate = 1;
    this.stale = true;
    const scale = scaleEnd(flight.maxSpeed);

    const canvas = byId('view');
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.scene = new Scene();
    // NED is turned into the page's axes once, here: x east, y up, z south. All below it stays NED.
    this.world = new Group();
    this.world.applyMatrix4(new Matrix4().set(0, 1, 0, 0, 0, 0, -1, 0, -1, 0, 0, 0, 0, 0, 0, 1));
    this.world.updateMatrixWorld();
    this.vehicle = new Vehicle(flight);
    this.trail = new Trail(flight, scale.end);
    this.plumb = new Plumb(flight.groundZ, 0.5 * this.vehicle.span);
    this.world.add(
      buildGround(flight.groundZ),
      buildNorthMark(flight.groundZ),
      this.trail.mesh,
      this.plumb.group,
      this.vehicle.group,
    );
    this.scene.add(buildSky(), buildLight(), this.world);

    const bounds = new Box3().setFromArray(flight.positions).applyMatrix4(this.world.matrixWorld);
    this.camera = new Camera(canvas, bounds, -flight.groundZ, this.vehicle.span);
    this.instruments = new Instruments(flight, scale);
    this.timeline = new Timeline(flight, scale.end, (time) => this.seek(time));
    this.#connect();
    this.resize();
    let last = null;
    const frame = (milliseconds) => {
      // after a pause of the browser (hidden tab) the flight goes on where it was
      const passed = last === null ? 0 : Math.min((milliseconds - last) / 1000, 0.25);
      last = milliseconds;
      this.#frame(passed);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  seek(time) {
    this.time = Math.min(Math.max(time, this.flight.begin), this.flight.end);
    this.stale = true;
  }

  play() {
    if (this.time >= this.flight.end) this.time = this.flight.begin;
    this.playing = true;
    this.#showControls();
  }

  pause() {
    this.playing = false;
    this.#showControls();
  }

  setRate(rate) {
    this.rate = rate;
    this.#showControls();
  }

  setCamera(mode) {
    this.camera.setMode(mode);
    this.#showControls();
  }

  setTrail(mode) {
    this.trail.setMode(mode);
    this.#showControls();
  }

  /** The canvas has the room that the layout leaves it: the window, or what is beside the panels of a small screen. */
  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.resize(width, height);
    this.trail.resize(width, height, ratio);
    this.timeline.draw();
    this.stale = true;
  }

  #frame(passed) {
    if (this.playing) {
      this.seek(this.time + passed * this.rate);
      if (this.time >= this.flight.end) this.pause();
    }
    const state = this.flight.at(this.time);
    const place = this.world.localToWorld(new Vector3(...state.position));
    const [w, x, y, z] = state.attitude;
    const heading = Math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z);
    const moved = this.camera.update(place, heading);
    if (!moved && !this.stale) return; // a standing picture costs nothing
    this.stale = false;
    this.vehicle.show(state, this.time);
    this.vehicle.keepVisible(this.camera.metresPerPixel(place, this.canvas.clientHeight));
    this.trail.show(this.time);
    this.plumb.show(state.position, this.vehicle.model.scale.x);
    this.instruments.show(state, this.time);
    this.timeline.show(this.time);
    this.renderer.render(this.scene, this.camera.camera);
  }

  #connect() {
    byId('play').addEventListener('click', () => this.#toggle());
    byId('trail').addEventListener('click', () => this.#nextTrail());
    byId('about').addEventListener('click', () => byId('help').showModal());
    const choice = (parent, text, title, action) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = text;
      button.title = title;
      button.addEventListener('click', action);
      byId(parent).append(button);
      return button;
    };
    this.rateButtons = rates.map((rate) => choice('rates', `${rate}×`, 'Speed (↑ ↓)', () => this.setRate(rate)));
    this.cameraButtons = cameraModes.map((mode) => choice('cameras', mode, 'Camera (C)', () => this.setCamera(mode)));
    window.addEventListener('resize', () => this.resize());
    const sizes = new ResizeObserver(() => this.resize()); // also where only the panels have moved
    sizes.observe(this.canvas);
    sizes.observe(byId('profile'));
    byId('view').addEventListener('webglcontextrestored', () => {
      this.stale = true;
    });
    window.addEventListener('keydown', (event) => this.#key(event));
    this.#showControls();
  }

  #toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  #nextTrail() {
    this.setTrail((this.trail.mode + 1) % trailModes.length);
  }

  #key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || byId('help').open) return;
    const row = this.flight.rowAt(this.time);
    const step = event.shiftKey ? 10 : 1;
    const faster = (by) => this.setRate(rates[Math.min(Math.max(rates.indexOf(this.rate) + by, 0), rates.length - 1)]);
    const rowTime = (i) => this.flight.times[Math.min(Math.max(i, 0), this.flight.rows - 1)];
    const actions = {
      ' ': () => this.#toggle(),
      ArrowLeft: () => this.seek(this.time - step),
      ArrowRight: () => this.seek(this.time + step),
      ArrowUp: () => faster(1),
      ArrowDown: () => faster(-1),
      ',': () => this.seek(rowTime(this.time > this.flight.times[row] ? row : row - 1)),
      '.': () => this.seek(rowTime(row + 1)),
      Home: () => this.seek(this.flight.begin),
      End: () => this.seek(this.flight.end),
      c: () => this.setCamera(cameraModes[(cameraModes.indexOf(this.camera.mode) + 1) % cameraModes.length]),
      r: () => this.setCamera(this.camera.mode),
      t: () => this.#nextTrail(),
      h: () => document.body.classList.toggle('bare'),
      '?': () => byId('help').showModal(),
    };
    const action = actions[event.key] ?? actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault(); // a focused button or slider must not act as well
    action();
  }

  #showControls() {
    byId('play').innerHTML = this.playing ? icons.pause : icons.play;
    this.rateButtons.forEach((button, i) => button.setAttribute('aria-pressed', rates[i] === this.rate));
    this.cameraButtons.forEach((button, i) => button.setAttribute('aria-pressed', cameraModes[i] === this.camera.mode));
    byId('trail').textContent = `trail: ${trailModes[this.trail.mode].name}`;
    this.stale = true;
  }
}

function fail(text) {
  byId('failure').textContent = text;
  byId('failure').hidden = false;
}

try {
  const replay = new Replay(new Flight(JSON.parse(byId('flight').textContent)));
  window.replay = replay; // for the browser test, and for whoever opens the console
  const openAtAddress = () => {
    const start = /[#&]t=(\d+(?:\.\d+)?)/.exec(location.hash); // page.html#t=12.5 opens at that moment, standing still
    if (start) {
      replay.pause();
      replay.seek(Number(start[1]));
    }
    return Boolean(start);
  };
  window.addEventListener('hashchange', openAtAddress);
  if (!openAtAddress()) replay.play();
} catch (error) {
  fail(`This flight cannot be shown: ${error.message}. The page needs a browser with WebGL 2.`);
  throw error;
}

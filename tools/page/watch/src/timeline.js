// SPDX-License-Identifier: MIT
// The timeline: altitude over time, coloured by speed, with an axis in seconds; a mouse, a pen or a finger drags it.
import { rampColour } from './ramp.js';

const byId = (id) => document.getElementById(id);
const widestTick = 60; // pixels that a label needs

/** The least of 1, 2, 5 times a power of ten that is not below `least`. */
export function tickStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= least * (1 - 1e-9));
}

export class Timeline {
  /** `seek(time)` is called with each time asked for. */
  constructor(flight, speedEnd, seek) {
    this.flight = flight;
    this.speedEnd = speedEnd;
    this.slider = byId('slider'); // for keyboards and screen readers; its own thumb would stop short of the ends
    this.slider.min = flight.begin;
    this.slider.max = flight.end;
    this.slider.addEventListener('input', () => seek(Number(this.slider.value)));
    const area = byId('timeline');
    const seekAt = (event) => {
      const box = area.getBoundingClientRect();
      const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
      seek(flight.begin + share * (flight.end - flight.begin));
    };
    area.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      area.setPointerCapture(event.pointerId);
      seekAt(event);
    });
    area.addEventListener('pointermove', (event) => {
      if (area.hasPointerCapture(event.pointerId)) seekAt(event);
    });
  }

  show(time) {
    this.slider.value = time;
    byId('needle').style.left = `${100 * this.#share(time)}%`;
  }

  draw() {
    this.#drawProfile();
    this.#drawAxis();
  }

  #share(time) {
    return this.flight.end > this.flight.begin ? (time - this.flight.begin) / (this.flight.end - this.flight.begin) : 0;
  }

  #drawProfile() {
    const { flight, speedEnd } = this;
    const canvas = byId('profile');
    const ratio = window.devicePixelRatio || 1;
    const width = (canvas.width = Math.max(1, Math.round(canvas.clientWidth * ratio)));
    const height = (canvas.height = Math.max(1, Math.round(canvas.clientHeight * ratio)));
    const pen = canvas.getContext('2d');
    let lowest = Infinity;
    let highest = -Infinity;
    for (let row = 0; row < flight.rows; ++row) {
      lowest = Math.min(lowest, flight.altitude(row));
      highest = Math.max(highest, flight.altitude(row));
    }
    const range = Math.max(highest - lowest, 1);
    for (let x = 0; x < width; ++x) {
      const [first, last] = [x, x + 1].map((edge) =>
        flight.rowAt(flight.begin + ((flight.end - flight.begin) * edge) / width),
      );
      let [altitude, speed] = [0, 0];
      for (let row = first; row <= last; ++row) {
        altitude += flight.altitude(row) / (last - first + 1);
        speed += flight.speeds[row] / (last - first + 1);
      }
      const top = height * (0.88 - 0.72 * ((altitude - lowest) / range));
      pen.fillStyle = `rgb(${rampColour(speed / speedEnd).map(Math.round)})`;
      pen.fillRect(x, top, 1, height - top);
    }
  }

  #drawAxis() {
    const axis = byId('axis');
    axis.replaceChildren();
    const { begin, end } = this.flight;
    const width = axis.clientWidth;
    if (!(end > begin) || width === 0) return;
    const step = tickStep(((end - begin) * widestTick) / width);
    const digits = Math.max(0, -Math.floor(Math.log10(step)));
    for (let i = Math.ceil(begin / step - 0.05); i * step <= end + 1e-6; ++i) {
      const share = Math.max(0, this.#share(i * step));
      const tick = document.createElement('span');
      tick.textContent = `${(i * step).toFixed(digits)} s`;
      tick.style.left = `${100 * share}%`;
      if (share * width < 16) tick.className = 'first';
      if (share * width > width - 20) tick.className = 'last';
      axis.append(tick);
    }
  }
}

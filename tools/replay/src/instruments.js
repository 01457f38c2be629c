// SPDX-License-Identifier: MIT
// The figures and dials over the view.
import { eulerDegrees } from './flight.js';
import { rampColour, rampGradient } from './ramp.js';
import { isAtLimit } from './vehicle.js';

const byId = (id) => document.getElementById(id);
const pixelsPerDegree = 1.35; // of the horizon's dial

function svg(name, attributes, parent, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

/** A real minus sign, as wide as a plus, and no "-0.0". */
function signed(value, digits = 1) {
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) !== 0 ? '\u2212' : '') + text;
}

export class Instruments {
  constructor(flight, scale) {
    this.flight = flight;
    byId('title').textContent = document.title;
    const duration = ((flight.end - flight.begin) * flight.rows) / Math.max(1, flight.rows - 1); // a row ends a period
    byId('facts').textContent =
      `${flight.rows.toLocaleString('en')} rows, ${duration.toFixed(1)} s, up to ${flight.maxSpeed.toFixed(1)} m/s`;
    byId('duration').textContent = flight.end.toFixed(2);
    this.#buildLadder();
    this.#buildLegend(scale);
    this.bars = this.#buildRotors();
  }

  #buildLadder() {
    let path = '';
    for (let degrees = -80; degrees <= 80; degrees += 10) {
      if (degrees === 0) continue;
      const half = degrees % 20 === 0 ? 18 : 9;
      path += `M${-half} ${-degrees * pixelsPerDegree}H${half}`;
    }
    byId('ladder').setAttribute('d', path);
  }

  #buildLegend({ end, tick }) {
    byId('ramp').style.background = rampGradient;
    for (let speed = 0; speed <= end + 1e-9; speed += tick) {
      const label = document.createElement('span');
      label.style.left = `${(100 * speed) / end}%`;
      label.textContent = String(Number(speed.toFixed(1)));
      byId('ramp-ticks').append(label);
    }
  }

  /** The bars stand where the rotors are, seen from above with the nose up. */
  #buildRotors() {
    const map = byId('rotor-map');
    const reach = Math.max(...this.flight.rotors.flatMap((rotor) => [Math.abs(rotor.x_m), Math.abs(rotor.y_m)]));
    const place = (rotor) => [(40 * rotor.y_m) / reach, (-32 * rotor.x_m) / reach];
    for (const rotor of this.flight.rotors) {
      const [x, y] = place(rotor);
      svg(
        'line',
        {
          x1: 0,
          y1: 0,
          x2: x * 0.62,
          y2: y * 0.5,
          stroke: rotor.x_m > 0 ? '#ff9d2e' : '#dfe6ef',
          'stroke-width': 3,
          'stroke-linecap': 'round',
          opacity: 0.8,
        },
        map,
      );
    }
    svg('path', { d: 'M0 -17L-6 -6H6Z', fill: '#ff9d2e' }, map);
    svg('circle', { r: 7, fill: '#26313f', stroke: '#94b0d6', 'stroke-width': 1 }, map);
    return this.flight.rotors.map((rotor, i) => {
      const [x, y] = place(rotor);
      const height = 42;
      const base = y + height / 2 - 3;
      svg(
        'rect',
        { x: x - 7, y: base - height, width: 14, height, rx: 3, fill: '#94b0d626', stroke: '#94b0d655' },
        map,
      );
      const fill = svg('rect', { x: x - 7, y: base, width: 14, height: 0, rx: 3, fill: '#57d0ff' }, map);
      const side = x > 0 ? 1 : -1;
      const turn = rotor.spin > 0 ? '\u21ba' : '\u21bb';
      svg('text', { x: x + side * 17, y: base - height + 8, class: 'name' }, map, `${i + 1} ${turn}`);
      const number = svg('text', { x, y: base + 11, id: `u${i + 1}` }, map, '0.00');
      return { fill, number, base, height };
    });
  }

  show(state, time) {
    const { roll, pitch, yaw } = eulerDegrees(state.attitude);
    byId('time').textContent = time.toFixed(2);
    byId('speed').textContent = state.speed.toFixed(1);
    byId('climb').textContent = signed(-state.velocity[2]);
    byId('altitude').textContent = (this.flight.groundZ - state.position[2]).toFixed(1);
    byId('roll').textContent = signed(roll);
    byId('pitch').textContent = signed(pitch);
    byId('heading').textContent = String(Math.round(yaw + 360) % 360).padStart(3, '0');
    byId('horizon-ball').setAttribute('transform', `rotate(${-roll}) translate(0 ${pitch * pixelsPerDegree})`);
    this.bars.forEach((bar, i) => {
      const command = state.commands[i];
      bar.fill.setAttribute('y', bar.base - bar.height * command);
      bar.fill.setAttribute('height', bar.height * command);
      bar.fill.setAttribute('fill', isAtLimit(command) ? '#ff4256' : '#57d0ff');
      bar.number.textContent = command.toFixed(2);
    });
  }
}

/** Altitude over time, coloured by speed: the slider's background. */
export function drawProfile(flight, speedEnd) {
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
  pen.fillStyle = '#94b0d61a';
  pen.fillRect(0, 0, width, height);
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
    const colour = rampColour(speed / speedEnd).map(Math.round);
    pen.fillStyle = `rgba(${colour}, 0.42)`;
    pen.fillRect(x, top, 1, height - top);
    pen.fillStyle = `rgb(${colour})`;
    pen.fillRect(x, top - ratio, 1, 2 * ratio);
  }
}

// SPDX-License-Identifier: MIT
// The figures and dials over the view.
import { eulerDegrees } from './flight.js';
import { rampGradient } from './ramp.js';
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
          class: rotor.x_m > 0 ? 'arm front' : 'arm',
        },
        map,
      );
    }
    svg('path', { d: 'M0 -17L-6 -6H6Z', class: 'nose' }, map);
    svg('circle', { r: 7, class: 'hub' }, map);
    return this.flight.rotors.map((rotor, i) => {
      const [x, y] = place(rotor);
      const height = 42;
      const base = y + height / 2 - 3;
      svg('rect', { x: x - 7, y: base - height, width: 14, height, rx: 3, class: 'whole' }, map);
      const fill = svg('rect', { x: x - 7, y: base, width: 14, height: 0, rx: 3, class: 'command' }, map);
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
      bar.fill.classList.toggle('limit', isAtLimit(command));
      bar.number.textContent = command.toFixed(2);
    });
  }
}

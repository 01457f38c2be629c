// SPDX-License-Identifier: MIT
// The flight as the page holds it, and its state at any time between rows. World NED, body FRD, SI units.

/** Base64 of a little-endian array; every machine that runs a browser is little-endian. */
function decode(text, ArrayType) {
  return new ArrayType(Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer);
}

export class Flight {
  constructor(json) {
    this.rotors = json.rotors; // {x_m, y_m, spin}: forward and right of the centre, spin 1 counter-clockwise from above
    this.propellerDiameter = json.propeller_diameter_m;
    this.groundZ = json.ground_z_m;
    this.times = decode(json.time_s, Float32Array);
    this.positions = decode(json.position_m, Float32Array);
    this.velocities = Float32Array.from(decode(json.velocity, Int16Array), (v) => v * json.velocity_unit_m_s);
    this.attitudes = decode(json.attitude, Int16Array); // w, x, y, z in units of 1/32767
    this.commands = Float32Array.from(decode(json.commands, Uint16Array), (u) => u / 65535);
    this.rows = this.times.length;
    this.begin = this.times[0];
    this.end = this.times[this.rows - 1];
    this.speeds = new Float32Array(this.rows);
    for (let i = 0; i < this.rows; ++i) this.speeds[i] = Math.hypot(...this.velocities.subarray(3 * i, 3 * i + 3));
    this.maxSpeed = this.speeds.reduce((a, b) => Math.max(a, b), 0);
  }

  /** The last row at or before that time. */
  rowAt(time) {
    let low = 0;
    let high = this.rows - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  altitude(row) {
    return this.groundZ - this.positions[3 * row + 2];
  }

  attitude(row) {
    const q = Array.from(this.attitudes.subarray(4 * row, 4 * row + 4));
    const norm = Math.hypot(...q);
    return q.map((component) => component / norm);
  }

  /** State at a time, between two rows: positions, velocities and commands linear, attitudes on the great circle. */
  at(time) {
    const row = this.rowAt(time);
    const next = Math.min(row + 1, this.rows - 1);
    const span = this.times[next] - this.times[row];
    const share = span > 0 ? Math.min(Math.max((time - this.times[row]) / span, 0), 1) : 0;
    const mix = (array, width) =>
      Array.from({ length: width }, (_, i) => array[width * row + i] * (1 - share) + array[width * next + i] * share);
    const velocity = mix(this.velocities, 3);
    return {
      position: mix(this.positions, 3),
      velocity,
      speed: Math.hypot(...velocity),
      attitude: slerp(this.attitude(row), this.attitude(next), share),
      commands: mix(this.commands, 4),
    };
  }
}

/** The shorter way between two unit quaternions. */
function slerp(a, b, share) {
  const dot = a.reduce((sum, component, i) => sum + component * b[i], 0);
  const sign = dot < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(dot)));
  const small = angle < 1e-4; // the sines cancel; linear is exact enough
  const from = small ? 1 - share : Math.sin((1 - share) * angle) / Math.sin(angle);
  const to = sign * (small ? share : Math.sin(share * angle) / Math.sin(angle));
  const q = a.map((component, i) => from * component + to * b[i]);
  const norm = Math.hypot(...q);
  return q.map((component) => component / norm);
}

/** Roll, pitch and yaw in degrees of a unit quaternion w, x, y, z (Euler ZYX, body to world). */
export function eulerDegrees([w, x, y, z]) {
  const across = 2 * (w * x + y * z);
  const upright = w * w - x * x - y * y + z * z;
  const degrees = 180 / Math.PI;
  return {
    roll: degrees * Math.atan2(across, upright),
    pitch: degrees * Math.atan2(2 * (w * y - z * x), Math.hypot(across, upright)),
    yaw: degrees * Math.atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z),
  };
}

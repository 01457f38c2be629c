// SPDX-License-Identifier: MIT
// The flown path as a ribbon of constant width on the screen. Where it ends and fades is decided per pixel by time,
// so that it reaches exactly to the vehicle and costs nothing per frame.
import { BufferAttribute, BufferGeometry, Mesh, ShaderMaterial, Vector2 } from 'three';

import { rampColour } from './ramp.js';

const vertexShader = `
  attribute vec3 tangent;
  attribute float side;
  attribute float time;
  attribute vec3 colour;
  uniform vec2 resolution;
  uniform float width;
  varying float vTime;
  varying float vSide;
  varying vec3 vColour;
  void main() {
    mat4 toClip = projectionMatrix * modelViewMatrix;
    vec4 here = toClip * vec4(position, 1.0);
    vec4 ahead = toClip * vec4(position + tangent, 1.0);
    // difference of the two on the screen without dividing: right also when one is behind the camera
    vec2 along = (ahead.xy * here.w - here.xy * ahead.w) * resolution;
    float size = length(along);
    vec2 across = size > 1e-9 ? vec2(-along.y, along.x) / size : vec2(0.0, 1.0);
    here.xy += side * width * across / resolution * here.w;
    vTime = time;
    vSide = side;
    vColour = colour;
    gl_Position = here;
  }`;

const fragmentShader = `
  uniform float now;
  uniform float tail;
  uniform float rest;
  varying float vTime;
  varying float vSide;
  varying vec3 vColour;
  void main() {
    float age = now - vTime;
    float flown = age < 0.0 ? 0.0 : 1.0 - smoothstep(0.55 * tail, tail, age);
    float opacity = max(0.95 * flown, rest) * smoothstep(1.0, 0.55, abs(vSide));
    if (opacity < 0.004) discard;
    float edge = smoothstep(0.35, 0.7, abs(vSide)); // a pale edge: the ramp's slow end is as dark as the ground
    gl_FragColor = vec4(mix(vColour, vec3(0.86, 0.90, 0.95), 0.45 * edge), opacity);
  }`;

/** What the trail shows: seconds behind the vehicle, and how visible the rest of the path is. */
export const trailModes = [
  { name: 'last 30 s', tail: 30, rest: 0.06 },
  { name: 'whole', tail: 1e9, rest: 0.14 },
  { name: 'none', tail: 1e-9, rest: 0 },
];

export class Trail {
  constructor(flight, speedEnd) {
    const rows = flight.rows;
    const position = new Float32Array(6 * rows);
    const tangent = new Float32Array(6 * rows);
    const side = new Float32Array(2 * rows);
    const time = new Float32Array(2 * rows);
    const colour = new Float32Array(6 * rows);
    const index = new Uint32Array(6 * Math.max(0, rows - 1));
    for (let i = 0; i < rows; ++i) {
      const before = Math.max(i - 1, 0);
      const after = Math.min(i + 1, rows - 1);
      const rgb = rampColour(flight.speeds[i] / speedEnd);
      for (let edge = 0; edge < 2; ++edge) {
        const v = 2 * i + edge;
        side[v] = edge === 0 ? -1 : 1;
        time[v] = flight.times[i];
        for (let axis = 0; axis < 3; ++axis) {
          position[3 * v + axis] = flight.positions[3 * i + axis];
          tangent[3 * v + axis] = flight.positions[3 * after + axis] - flight.positions[3 * before + axis];
          colour[3 * v + axis] = rgb[axis] / 255;
        }
      }
      if (i + 1 < rows) index.set([2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3], 6 * i);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(position, 3));
    geometry.setAttribute('tangent', new BufferAttribute(tangent, 3));
    geometry.setAttribute('side', new BufferAttribute(side, 1));
    geometry.setAttribute('time', new BufferAttribute(time, 1));
    geometry.setAttribute('colour', new BufferAttribute(colour, 3));
    geometry.setIndex(new BufferAttribute(index, 1));
    this.uniforms = {
      resolution: { value: new Vector2(1, 1) },
      width: { value: 5 },
      now: { value: 0 },
      tail: { value: 30 },
      rest: { value: 0 },
    };
    this.mesh = new Mesh(
      geometry,
      new ShaderMaterial({
        vertexShader,
        fragmentShader,
        uniforms: this.uniforms,
        transparent: true,
        depthWrite: false,
        side: 2,
      }),
    );
    this.mesh.frustumCulled = false; // its width is not in the bounding sphere
    this.mode = flight.end - flight.begin > 90 ? 0 : 1;
    this.setMode(this.mode);
  }

  setMode(mode) {
    this.mode = mode;
    this.uniforms.tail.value = trailModes[mode].tail;
    this.uniforms.rest.value = trailModes[mode].rest;
  }

  show(time) {
    this.uniforms.now.value = time;
  }

  resize(width, height, pixelRatio) {
    this.uniforms.resolution.value.set(width * pixelRatio, height * pixelRatio);
    this.uniforms.width.value = 5 * pixelRatio;
  }
}

// SPDX-License-Identifier: MIT
// Sky, ground with its grid, north mark, and the vehicle's shadow with the plumb line that tells its place.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  CircleGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Group,
  HemisphereLight,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  PlaneGeometry,
  ShaderMaterial,
  SphereGeometry,
  SRGBColorSpace,
} from 'three';

// as the screen shows them: these shaders write display colours
const horizon = new Color().setHex(0x7f9fc4, '');
const zenith = new Color().setHex(0x10233f, '');
const soil = new Color().setHex(0x1b2a35, '');

/** Ground and sky are drawn behind everything and keep no depth: nothing flies below or beyond them. */
export function buildSky() {
  const sky = new Mesh(
    new SphereGeometry(1, 32, 16),
    new ShaderMaterial({
      side: BackSide,
      depthWrite: false,
      depthTest: false,
      uniforms: { horizon: { value: horizon }, zenith: { value: zenith } },
      vertexShader: `
      varying vec3 direction;
      void main() {
        direction = position;
        gl_Position = projectionMatrix * vec4(mat3(modelViewMatrix) * position * 10.0, 1.0);
      }`,
      fragmentShader: `
      uniform vec3 horizon;
      uniform vec3 zenith;
      varying vec3 direction;
      void main() {
        float height = max(normalize(direction).y, 0.0);
        gl_FragColor = vec4(mix(horizon, zenith, 1.0 - exp(-5.5 * height)), 1.0);
      }`,
    }),
  );
  sky.frustumCulled = false;
  sky.renderOrder = -3;
  return sky;
}

/** A plane in NED x and y at the ground's z. Grid of 1, 10 and 100 m; each fades where its lines would crowd. */
export function buildGround(groundZ) {
  const ground = new Mesh(
    new PlaneGeometry(6000, 6000),
    new ShaderMaterial({
      side: DoubleSide,
      depthWrite: false,
      uniforms: { horizon: { value: horizon }, soil: { value: soil } },
      vertexShader: `
      varying vec2 place;
      varying vec3 toEye;
      void main() {
        place = position.xy;
        vec4 view = modelViewMatrix * vec4(position, 1.0);
        toEye = view.xyz;
        gl_Position = projectionMatrix * view;
      }`,
      fragmentShader: `
      uniform vec3 horizon;
      uniform vec3 soil;
      varying vec2 place;
      varying vec3 toEye;
      float grid(float pitch, float pixels) {
        vec2 c = place / pitch;
        vec2 step = fwidth(c);
        vec2 away = abs(fract(c - 0.5) - 0.5) / step;
        vec2 line = (1.0 - smoothstep(pixels - 0.5, pixels + 0.5, away)) * (1.0 - smoothstep(0.08, 0.3, step));
        return max(line.x, line.y);
      }
      void main() {
        float distance = length(toEye);
        vec3 colour = soil;
        colour = mix(colour, vec3(0.56, 0.68, 0.80), 0.12 * exp(-distance / 28.0) * grid(1.0, 0.6));
        colour = mix(colour, vec3(0.56, 0.68, 0.80), 0.25 * exp(-distance / 320.0) * grid(10.0, 0.7));
        colour = mix(colour, vec3(0.64, 0.78, 0.92), 0.42 * grid(100.0, 0.9));
        gl_FragColor = vec4(mix(horizon, colour, exp(-distance / 360.0)), 1.0);
      }`,
    }),
  );
  ground.position.z = groundZ;
  ground.renderOrder = -2;
  return ground;
}

/** Where the north is, written on the ground at the origin. */
export function buildNorthMark(groundZ) {
  const size = 256;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = size;
  const pen = canvas.getContext('2d');
  pen.strokeStyle = pen.fillStyle = '#ffb454';
  pen.lineWidth = 5;
  pen.beginPath();
  pen.arc(128, 128, 92, 0, 2 * Math.PI);
  pen.stroke();
  pen.beginPath();
  pen.moveTo(128, 50);
  pen.lineTo(104, 104);
  pen.lineTo(152, 104);
  pen.fill();
  pen.font = '600 72px system-ui, sans-serif';
  pen.textAlign = 'center';
  pen.fillText('N', 128, 186);
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  const mark = new Mesh(
    new PlaneGeometry(6, 6),
    new MeshBasicMaterial({
      map: texture,
      transparent: true,
      opacity: 0.75,
      depthWrite: false,
      side: DoubleSide,
    }),
  );
  mark.position.z = groundZ;
  mark.rotation.set(Math.PI, 0, Math.PI / 2); // the picture's up is x (north), its face is up (-z)
  mark.renderOrder = -1;
  return mark;
}

/** Light in the page's own axes (y up). */
export function buildLight() {
  const light = new Group();
  const sun = new DirectionalLight(0xfff2dd, 2.6);
  sun.position.set(4, 9, 5);
  light.add(new HemisphereLight(0xbcd7ff, 0x39424d, 1.9), sun);
  return light;
}

export class Plumb {
  constructor(groundZ, radius) {
    this.groundZ = groundZ;
    this.group = new Group();
    const shadow = new Mesh(
      new CircleGeometry(1, 40),
      new ShaderMaterial({
        transparent: true,
        depthWrite: false,
        side: DoubleSide,
        vertexShader:
          'varying vec2 p; void main() { p = position.xy; ' +
          'gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
        fragmentShader:
          'varying vec2 p; void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, 0.6 * smoothstep(1.0, 0.35, length(p))); }',
      }),
    );
    shadow.renderOrder = -1;
    this.shadow = shadow;
    this.radius = radius;
    const geometry = new BufferGeometry();
    this.ends = new BufferAttribute(new Float32Array(6), 3);
    geometry.setAttribute('position', this.ends);
    const line = new Line(
      geometry,
      new LineBasicMaterial({ color: 0xcfe2ff, transparent: true, opacity: 0.35, depthWrite: false }),
    );
    line.frustumCulled = false;
    this.group.add(shadow, line);
  }

  show([north, east, down], scale) {
    this.shadow.position.set(north, east, this.groundZ);
    this.shadow.scale.setScalar(this.radius * Math.max(1, 0.8 * scale));
    this.ends.setXYZ(0, north, east, down);
    this.ends.setXYZ(1, north, east, this.groundZ);
    this.ends.needsUpdate = true;
  }
}

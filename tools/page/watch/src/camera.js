// SPDX-License-Identifier: MIT
// Three ways to look: follow (moves along, keeps its direction), chase (also turns with the nose), free (stands still).
// The mouse orbits in all three.
import { PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

export const cameraModes = ['follow', 'chase', 'free'];
const up = new Vector3(0, 1, 0);

/** Lives in the page's own axes: x east, y up, z south. */
export class Camera {
  constructor(canvas, bounds, groundHeight, span) {
    this.camera = new PerspectiveCamera(50, 1, 0.05, 8000);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = 1.2 * span;
    this.controls.maxDistance = 1500;
    this.controls.zoomSpeed = 1.4;
    this.bounds = bounds;
    this.groundHeight = groundHeight;
    this.span = span;
    this.mode = 'follow';
    this.last = null;
  }

  setMode(mode) {
    this.mode = mode;
    this.controls.enablePan = mode === 'free';
    this.last = null;
  }

  resize(width, height) {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  /** Metres that a pixel covers at a place. */
  metresPerPixel(place, windowHeight) {
    const angle = (this.camera.fov * Math.PI) / 180;
    return (2 * Math.tan(angle / 2) * this.camera.position.distanceTo(place)) / windowHeight;
  }

  /** `place` of the vehicle and its `heading` in rad, clockwise from north. True when the view has changed. */
  update(place, heading) {
    const before = this.camera.position.clone();
    if (this.last === null) {
      this.#start(place, heading);
    } else if (this.mode !== 'free') {
      const offset = this.camera.position.clone().sub(this.controls.target);
      if (this.mode === 'chase') offset.applyAxisAngle(up, this.last.heading - heading);
      this.controls.target.copy(place);
      this.camera.position.copy(place).add(offset);
    }
    this.last = { heading };
    const lowest = this.groundHeight + 0.15; // the ground has no underside
    if (this.camera.position.y < lowest) this.camera.position.y = lowest;
    return this.controls.update() || !before.equals(this.camera.position);
  }

  #start(place, heading) {
    if (this.mode === 'free') {
      const centre = this.bounds.getCenter(new Vector3());
      const size = this.bounds.getSize(new Vector3()).length();
      this.controls.target.copy(centre);
      this.camera.position.copy(centre).add(new Vector3(0.6, 0.3, 0.78).multiplyScalar(0.9 * size + 4));
      return;
    }
    const behind = new Vector3(-Math.sin(heading), 0, Math.cos(heading));
    const right = new Vector3(Math.cos(heading), 0, Math.sin(heading));
    const sideways = this.mode === 'chase' ? 0 : 0.5;
    this.controls.target.copy(place);
    this.camera.position
      .copy(place)
      .addScaledVector(behind, 2.4 * this.span)
      .addScaledVector(right, 2.4 * this.span * sideways)
      .addScaledVector(up, 0.92 * this.span);
  }
}

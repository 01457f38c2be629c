// SPDX-License-Identifier: MIT
// The quadrotor, built to scale from the airframe's rotor places, in its own axes: x forward, y right, z down (FRD).
import {
  BoxGeometry,
  CanvasTexture,
  CircleGeometry,
  Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  Vector3,
} from 'three';

const colours = {
  shell: 0x4a5b70,
  metal: 0xaab6c4,
  front: 0xff9d2e,
  rear: 0xdfe6ef,
  blade: 0x141a22,
  thrust: 0x57d0ff,
  limit: 0xff4256,
};
const up = -1; // of z

/** A rod between two points. three's cylinders lie along y. */
function rod(from, to, radius, material) {
  const along = new Vector3().subVectors(to, from);
  const mesh = new Mesh(new CylinderGeometry(radius, radius, along.length(), 14), material);
  mesh.position.addVectors(from, to).multiplyScalar(0.5);
  mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
  return mesh;
}

const standard = (color, roughness = 0.55, metalness = 0.15) =>
  new MeshStandardMaterial({ color, roughness, metalness });

export class Vehicle {
  constructor(flight) {
    this.group = new Group();
    this.model = new Group(); // enlarged when far away; the group itself keeps the flown pose
    this.group.add(this.model);
    const reach = Math.max(...flight.rotors.map((rotor) => Math.hypot(rotor.x_m, rotor.y_m)));
    this.span = 2 * reach + flight.propellerDiameter;
    this.#buildBody(reach);
    this.marker = buildMarker();
    this.group.add(this.marker);
    this.rotors = flight.rotors.map((rotor) => this.#buildRotor(rotor, reach, flight.propellerDiameter / 2));
  }

  #buildBody(reach) {
    const shell = standard(colours.shell, 0.4, 0.3);
    const hub = new Mesh(new CylinderGeometry(0.3 * reach, 0.24 * reach, 0.16 * reach, 6), shell);
    hub.rotation.x = -Math.PI / 2; // cylinder axis y -> body -z
    hub.scale.set(1, 1, 0.82);
    const canopy = new Mesh(
      new SphereGeometry(0.22 * reach, 28, 14, 0, 2 * Math.PI, 0, Math.PI / 2),
      standard(0x6f88a6, 0.3, 0.3),
    );
    canopy.rotation.x = -Math.PI / 2;
    canopy.scale.set(1.25, 0.62, 0.95);
    canopy.position.z = up * 0.07 * reach;
    const battery = new Mesh(new BoxGeometry(0.52 * reach, 0.24 * reach, 0.13 * reach), standard(0x222c39, 0.8));
    battery.position.z = 0.14 * reach;
    // the front: a wedge that no one can mistake for the tail
    const nose = new Mesh(new ConeGeometry(0.12 * reach, 0.34 * reach, 4), standard(colours.front, 0.45));
    nose.rotation.z = -Math.PI / 2; // cone axis y -> body x
    nose.position.set(0.43 * reach, 0, 0);
    nose.scale.set(1, 1, 0.7);
    this.model.add(hub, canopy, battery, nose);
    for (const side of [-1, 1]) {
      const skid = rod(
        new Vector3(-0.36 * reach, side * 0.26 * reach, 0.36 * reach),
        new Vector3(0.36 * reach, side * 0.26 * reach, 0.36 * reach),
        0.018 * reach,
        standard(colours.metal),
      );
      this.model.add(skid);
      for (const end of [-0.2, 0.2]) {
        this.model.add(
          rod(
            new Vector3(end * 0.7 * reach, side * 0.14 * reach, 0.05 * reach),
            new Vector3(end * reach, side * 0.26 * reach, 0.36 * reach),
            0.016 * reach,
            standard(colours.metal),
          ),
        );
      }
    }
  }

  #buildRotor(rotor, reach, radius) {
    const isFront = rotor.x_m > 0;
    const colour = isFront ? colours.front : colours.rear;
    const place = new Vector3(rotor.x_m, rotor.y_m, 0);
    const top = up * 0.15 * reach;
    this.model.add(rod(new Vector3(), place, 0.038 * reach, standard(colour, 0.5)));
    this.model.add(
      rod(
        new Vector3(rotor.x_m, rotor.y_m, 0.06 * reach),
        new Vector3(rotor.x_m, rotor.y_m, top),
        0.075 * reach,
        standard(colours.shell, 0.35, 0.5),
      ),
    );

    const head = new Group();
    head.position.set(rotor.x_m, rotor.y_m, top);
    const disc = new Mesh(
      new CircleGeometry(radius, 48),
      new MeshBasicMaterial({
        color: colour,
        transparent: true,
        opacity: 0.14,
        side: DoubleSide,
        depthWrite: false,
      }),
    );
    const blades = new Group();
    for (const half of [0, Math.PI]) {
      const blade = new Mesh(
        new BoxGeometry(0.92 * radius, 0.13 * radius, 0.012 * reach),
        standard(colours.blade, 0.5),
      );
      blade.position.set(0.5 * radius * Math.cos(half), 0.5 * radius * Math.sin(half), up * 0.012 * reach);
      blade.rotation.set(0.2, 0, half);
      blades.add(blade);
    }
    const rim = new Mesh(
      new CylinderGeometry(radius, radius, 0.02 * reach, 56, 1, true),
      new MeshBasicMaterial({
        color: colour,
        transparent: true,
        opacity: 0.55,
        side: DoubleSide,
        depthWrite: false,
      }),
    );
    rim.rotation.x = -Math.PI / 2;

    // the command as an arrow along the thrust, of length 0 to `fullLength`
    const fullLength = 1.1 * reach;
    const material = new MeshBasicMaterial({ color: colours.thrust, transparent: true, opacity: 0.85 });
    const shaft = new Mesh(new CylinderGeometry(0.028 * reach, 0.028 * reach, 1, 12), material);
    shaft.rotation.x = -Math.PI / 2;
    const tip = new Mesh(new ConeGeometry(0.075 * reach, 0.17 * reach, 16), material);
    tip.rotation.x = -Math.PI / 2;
    head.add(disc, blades, rim, shaft, tip);
    this.model.add(head);
    return { spin: rotor.spin, blades, shaft, tip, material, fullLength };
  }

  /** Pose and commands of a state; the blades turn slower than the real ones, which a screen could not show. */
  show(state, time) {
    this.group.position.set(...state.position);
    const [w, x, y, z] = state.attitude;
    this.group.quaternion.set(x, y, z, w);
    this.rotors.forEach((rotor, i) => {
      const command = state.commands[i];
      const length = Math.max(command * rotor.fullLength, 1e-4);
      rotor.shaft.scale.y = length;
      rotor.shaft.position.z = (up * length) / 2;
      rotor.tip.position.z = up * length;
      rotor.material.color = new Color(isAtLimit(command) ? colours.limit : colours.thrust);
      rotor.blades.rotation.z = -rotor.spin * time * 21; // seen from above counter-clockwise is negative about z down
    });
  }

  /** Keeps the model at least `pixels` wide; a circle comes up around it while it is enlarged. */
  keepVisible(metresPerPixel, pixels = 40) {
    const needed = (metresPerPixel * pixels) / this.span;
    this.model.scale.setScalar(Math.max(1, needed));
    this.marker.scale.setScalar(metresPerPixel * pixels * 1.7);
    this.marker.material.opacity = Math.min(Math.max((needed - 1) / 2, 0), 0.85);
    this.marker.visible = needed > 1;
  }
}

/** A thin circle that faces the camera. */
function buildMarker() {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 128;
  const pen = canvas.getContext('2d');
  pen.strokeStyle = '#ffffff';
  pen.lineWidth = 3;
  pen.beginPath();
  pen.arc(64, 64, 61, 0, 2 * Math.PI);
  pen.stroke();
  return new Sprite(
    new SpriteMaterial({ map: new CanvasTexture(canvas), transparent: true, depthTest: false, depthWrite: false }),
  );
}

/** At 0 or at 1, to the resolution of the page's commands. */
export function isAtLimit(command) {
  return command <= 1e-4 || command >= 1 - 1e-4;
}

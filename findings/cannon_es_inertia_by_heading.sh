#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: cannon-es 0.20.0 (npm).
# One would guess: a body's inertia is that of its shape, in its own axes: a ball has 0.4 m r^2, and where it heads when made
#   changes nothing.
# What happens: it is that of the bounding box, whose sides are along the world's axes, taken for the body's: of what is made, or
#   gets a shape, while it is turned, the box is a larger one.
# Seen: a plate of 1 kg, 0.2 m square, after 1 N m about its axis for 0.1 s: 15 rad/s made heading north, 7.5 made heading
#   north-east (right: 15 both). A ball: 1.67 times 0.4 m r^2.
# Why it matters: a simulated vehicle turns half as fast in yaw, for its whole life, because it was placed at 45 degrees. Gains
#   tuned at one heading are off by two at another.
# pinnquad: inertia is a number of the airframe's file, or comes from flights (docs/identify.md); it has no shapes.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" cannon-es@0.20.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install cannon-es"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { Body, Box, Quaternion, Sphere, Vec3, World } = require('cannon-es');
const turned = (heading) => {
  const quaternion = new Quaternion().setFromAxisAngle(new Vec3(0, 0, 1), heading);
  const plate = new Body({ mass: 1, shape: new Box(new Vec3(0.1, 0.1, 0.01)), quaternion, angularDamping: 0 });
  const world = new World();
  world.addBody(plate);
  for (let i = 0; i < 100; ++i) {
    plate.torque.set(0, 0, 1);
    world.step(0.001);
  }
  return plate.angularVelocity.z;
};
const right = 0.1 / ((0.2 ** 2 + 0.2 ** 2) / 12), north = turned(0), northEast = turned(Math.PI / 4);
const ball = new Body({ mass: 1, shape: new Sphere(0.1) }).inertia.x / (0.4 * 0.1 ** 2);
console.log(`made heading north ${north.toFixed(2)}, north-east ${northEast.toFixed(2)} rad/s (right: ${right.toFixed(2)})`);
console.log(`a ball: ${ball.toFixed(2)} times 0.4 m r^2`);
if (Math.abs(north - right) > 1e-6 || Math.abs(northEast - right / 2) > 1e-6 || Math.abs(ball - 5 / 3) > 1e-6) {
  console.log('changed: the inertia of a body');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

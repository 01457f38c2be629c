#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: cannon-es 0.20.0 (npm).
# One would guess: a body without torque keeps its angular momentum; unless it spins about a principal axis, or all its inertias
#   are equal, its angular velocity changes: omega_dot = J^-1 (J omega x omega).
# What happens: that term is not there. The angular velocity stays, and the momentum turns with the body.
# Seen: a box of 0.2 x 0.4 x 0.6 m at (5, 0.1, 1) rad/s, after 1 s without damping: (5, 0.1, 1) still (right: (5.07, -0.47,
#   0.14), by Euler's equation in steps of 0.25 ms); the momentum has changed by 13 %.
# Why it matters: pitch and yaw rates together roll a quadrotor: about 3 rad/s^2 at 2 rad/s each with usual inertias. A controller
#   or a model of the simulated vehicle never sees it, and a tumbling vehicle does not tumble.
# pinnquad: pinnquad::angular_acceleration() has the term (include/pinnquad/dynamics/rigid_body.hpp), and `identify` measures it.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" cannon-es@0.20.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install cannon-es"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { Body, Box, Vec3, World } = require('cannon-es');
const step_s = 0.00025, steps = 4000;
const world = new World(), body = new Body({ mass: 1, shape: new Box(new Vec3(0.1, 0.2, 0.3)), angularDamping: 0 });
world.addBody(body);
body.angularVelocity.set(5, 0.1, 1);
const { inertia, quaternion } = body;
const momentumOf = (rates) => quaternion.vmult(inertia.vmul(quaternion.conjugate().vmult(rates)));
const before = momentumOf(body.angularVelocity);
const q = quaternion.clone(); // by Euler's equation, rates in the body's frame
let w = body.angularVelocity.clone();
const change = ({ x, y, z }) =>
  new Vec3((inertia.y - inertia.z) * y * z / inertia.x, (inertia.z - inertia.x) * z * x / inertia.y,
           (inertia.x - inertia.y) * x * y / inertia.z);
for (let i = 0; i < steps; ++i) {
  world.step(step_s);
  const half = w.vadd(change(w).scale(step_s / 2));
  w = w.vadd(change(half).scale(step_s));
  q.integrate(q.vmult(half), step_s, new Vec3(1, 1, 1), q).normalize();
}
const right = q.vmult(w), got = body.angularVelocity, words = (v) => v.toArray().map((value) => value.toFixed(2)).join(', ');
const changed = momentumOf(got).vsub(before).length() / before.length();
console.log(`(${words(got)}) rad/s (right: (${words(right)})); the momentum changes by ${(100 * changed).toFixed(0)} %`);
if (words(got) !== '5.00, 0.10, 1.00' || words(right) !== '5.07, -0.47, 0.14' || Math.abs(changed - 0.134) > 0.01) {
  console.log('changed: the spin of a body without torque');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: gl-matrix 3.4.4 (npm).
# One would guess: quat.getAngle(a, b) of two equal unit quaternions is 0, or nearly so.
# What happens: it is acos(2 * dot^2 - 1) without a limit, and quaternions are Float32Array: dot^2 is often a little above 1.
#   For half of all attitudes the angle to itself is NaN. vec3.angle() has the limit.
# Seen: 10,000 random attitudes: 50 % NaN, the rest up to 0.0008 rad.
# Why it matters: the error of an attitude loop is nearly 0 all the time, so half of the chart is holes, and a mean is NaN.
# pinnquad: acos is called in one place, on a limited argument (simulation/simulator.hpp); the page of flights uses three.js,
#   whose angleTo() is limited.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" gl-matrix@3.4.4 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install gl-matrix"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { quat } = require('gl-matrix');
let seed = 1, lost = 0, worst = 0;
const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647 - 0.5;
for (let i = 0; i < 10000; ++i) {
  const attitude = quat.normalize(quat.create(), quat.fromValues(random(), random(), random(), random()));
  const angle = quat.getAngle(attitude, attitude);
  if (Number.isNaN(angle)) ++lost; else worst = Math.max(worst, angle);
}
console.log(`angle of an attitude to itself: NaN for ${(lost / 100).toFixed(0)} %, otherwise up to ${worst.toFixed(4)} rad`);
if (lost < 3000) { console.log('changed: getAngle of equal quaternions is a number'); process.exit(1); }
JS
node "$dir/observe.cjs"

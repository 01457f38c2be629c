#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: ahrs 1.3.3 (npm): Madgwick's and Mahony's attitude filters.
# One would guess: a craft that is level and still has the attitude (1, 0, 0, 0), from the first sample on.
# What happens: Madgwick's step divides the gradient by its length, and both are exactly 0 there: the attitude is NaN from the
#   first sample on, and remains so. Mahony's filter gives (1, 0, 0, 0).
# Seen: gyro 0, accelerometer (0, 0, 1): Madgwick NaN, still NaN after 100 samples of a tilted craft; Mahony 1, 0, 0, 0.
# Why it matters: simulated and replayed flights begin like this, so do unit tests, and sensors that count in coarse steps.
# pinnquad: it estimates no attitude; its simulated flights begin level and still.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" ahrs@1.3.3 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install ahrs"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const AHRS = require('ahrs');
const after = (algorithm, tilted) => {
  const filter = new AHRS({ sampleInterval: 10, algorithm, beta: 0.4 });
  filter.update(0, 0, 0, 0, 0, 1);
  for (let i = 0; i < tilted; ++i) filter.update(0.01, 0, 0, 0.1, 0.1, 0.98);
  return Object.values(filter.getQuaternion());
};
const still = after('Madgwick', 0), later = after('Madgwick', 100), mahony = after('Mahony', 0);
console.log(`Madgwick: ${still}; 100 samples later: ${later}; Mahony: ${mahony}`);
if (![...still, ...later].every(Number.isNaN) || mahony[0] !== 1) {
  console.log('changed: Madgwick of ahrs has an attitude for a level, still craft');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

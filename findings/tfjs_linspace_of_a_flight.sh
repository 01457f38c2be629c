#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: @tensorflow/tfjs-core and @tensorflow/tfjs-backend-cpu 4.22.0 (npm).
# One would guess: linspace(0, 600, n) ends at 600, and each value is the nearest float32.
# What happens: linspace() and range() add the step to the value before, in float32, so rounding adds up.
# Seen: ten minutes at 250 Hz: the last of linspace(0, 600, 150001) is 600.387, that of range(0, 600, 0.004) 600.383 (right:
#   600 and 599.996), half-way it is 299.882. 0.004 times the row, in float32, is off by less than 1e-4.
# Why it matters: a time axis made so leaves the flight's clock: by 0.12 s after five minutes, by 0.39 s after ten. What is
#   interpolated there is of another time.
# pinnquad: time is the number of the row or tick times its step, in double.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" @tensorflow/tfjs-core@4.22.0 \
  @tensorflow/tfjs-backend-cpu@4.22.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install @tensorflow/tfjs-core"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const tf = require('@tensorflow/tfjs-core');
require('@tensorflow/tfjs-backend-cpu');
const rows = 150001, axis = tf.linspace(0, 600, rows).dataSync(), stepped = tf.range(0, 600, 0.004).dataSync();
const exact = Float32Array.from({ length: rows }, (_, i) => Math.fround(0.004) * i);
const seen = [axis[rows - 1], stepped[rows - 2], axis[75000]];
console.log(`last of linspace ${seen[0].toFixed(3)}, of range ${seen[1].toFixed(3)}; half-way ${seen[2].toFixed(3)}`);
const recorded = [600.3865, 600.3825, 299.8817].every((value, i) => Math.abs(seen[i] - value) < 1e-3);
if (!recorded || Math.abs(exact[rows - 1] - 600) > 1e-4) {
  console.log('changed: linspace or range of tfjs rounds otherwise');
  process.exit(1);
}
JS
node "$dir/observe.cjs" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

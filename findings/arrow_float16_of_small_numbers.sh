#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: apache-arrow 21.2.0 (npm).
# One would guess: a Float16 column holds the nearest half precision number: 1e-8 is 0, 2047.5 is 2048, 70000 is Infinity.
# What happens: the conversion masks bits and does not carry. 1e-8 and -1e-8 become -Infinity, 2047.5 becomes 1024 (the carry
#   of the rounded mantissa is lost), and 70000 becomes 2.13 (the exponent wraps).
# Seen: 1e-8 -> -Infinity, 2047.5 -> 1024, 70000 -> 2.134765625; 9.81 -> 9.8125 and 65504 -> 65504 are right.
# Why it matters: half precision is chosen to store long flights and weights. Rates of a craft at rest are of such size, motor
#   speeds pass through 2047.5, and no message says so.
# pinnquad: reads float16 weights alone, by NumPy, and writes none (docs/convert.md).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" apache-arrow@21.2.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install apache-arrow"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { Float16, vectorFromArray } = require('apache-arrow');
const half = (value) => vectorFromArray([value], new Float16()).get(0);
const seen = [1e-8, -1e-8, 2047.5, 70000, 9.81, 65504].map(half);
console.log(`1e-8, -1e-8, 2047.5, 70000, 9.81, 65504 -> ${seen.join(', ')}`);
if (seen.join() !== [-Infinity, -Infinity, 1024, 2.134765625, 9.8125, 65504].join()) {
  console.log('changed: Float16 of apache-arrow rounds otherwise');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

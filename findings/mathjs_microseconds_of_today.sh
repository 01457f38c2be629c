#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: mathjs 15.2.0 (npm).
# One would guess: sort(), median() and floor() of numbers do what JavaScript's own do.
# What happens: they compare with the relative tolerance of equal(), 1e-12. Microseconds since 1970 that are less than 1.7 ms
#   apart are equal: sort() leaves them as they came, median() takes a wrong one; floor() of seconds since 1970 rounds up
#   in the last 1.7 ms of each second.
# Seen: sort of first + [3000, 0, 2000, 1000] us -> [0, 1000, 3000, 2000]; median 1000 (right: 1500);
#   floor(1700000000.999) -> 1700000001.
# Why it matters: stamps of a log at 1 kHz are closer than that. Rows change places, and derivatives get the wrong sign.
# pinnquad: its pages compare with JavaScript's operators.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" mathjs@15.2.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install mathjs"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { sort, median, floor } = require('mathjs');
const first = 1.7e15, stamps = [3000, 0, 2000, 1000].map((us) => first + us);
const sorted = sort(stamps).map((us) => us - first), middle = median(stamps) - first, second = floor(1700000000.999);
console.log(`sort: ${sorted}, median: ${middle}, floor(1700000000.999): ${second}`);
if (sorted.join() === '0,1000,2000,3000' || middle === 1500 || second === 1700000000) {
  console.log('changed: mathjs sorts, takes the median or rounds stamps as JavaScript does');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

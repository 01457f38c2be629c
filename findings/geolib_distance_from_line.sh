#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: geolib 3.3.14 (npm).
# One would guess: getDistanceFromLine() with its default accuracy of 1 m is right to about 1 m.
# What happens: the three sides of the triangle of point and line are rounded to whole metres, and the distance is the height of
#   what is left. Off a long leg a metre of rounding is tens of metres of height, or none.
# Seen: beside the middle of a leg: 0.5 m off 500 m gives 15.80; 10 m off 200 m gives 0; 20 m off 1000 m gives 31.61.
#   Right, with an accuracy of 1 mm: 0.71, 10.01, 20.02 (the Earth's shape, taken as a sphere, is less than 0.3 m of it).
# Why it matters: the cross-track error of a flight along waypoints is 0, then 16 m, then 0 again, while the vehicle keeps on its
#   line.
# pinnquad: positions are metres in a local frame, and errors are differences of them; it knows no latitudes.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" geolib@3.3.14 geographiclib-geodesic@2.2.0 \
  >"$dir/log" 2>&1 || {
  echo "not run: npm does not install geolib"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { getDistanceFromLine } = require('geolib');
const { Geodesic } = require('geographiclib-geodesic');
const from = ({ latitude, longitude }, azimuth, metres) => {
  const { lat2, lon2 } = Geodesic.WGS84.Direct(latitude, longitude, azimuth, metres);
  return { latitude: lat2, longitude: lon2 };
};
let asRecorded = true;
for (const [leg, off, recorded] of [[500, 0.5, 15.8], [200, 10, 0], [1000, 20, 31.61]]) {
  const begin = { latitude: 47, longitude: 8 }, line = [begin, from(begin, 90, leg)];
  const point = from(from(begin, 90, leg / 2), 0, off);
  const got = getDistanceFromLine(point, ...line), fine = getDistanceFromLine(point, ...line, 0.001);
  console.log(`${off} m off a leg of ${leg} m: ${got.toFixed(2)} m, with an accuracy of 1 mm ${fine.toFixed(2)} m`);
  asRecorded &&= Math.abs(got - recorded) < 0.01 && Math.abs(fine - off) < 0.3;
}
if (!asRecorded) {
  console.log('changed: the distance from a line');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

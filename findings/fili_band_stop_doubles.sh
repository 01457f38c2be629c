#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: fili 2.0.3 (npm).
# One would guess: FirCoeffs' bandstop() takes out what is between F1 and F2 and passes the rest; bandpass() passes that band.
# What happens: bandstop() is the sum of everything and the band, so the band is doubled; of an odd order it is the band alone.
#   bandpass() is the band times -1: late by half the order, as all of them are, and upside down.
# Seen: 80 to 120 Hz at 1 kHz, order 200: 1 at 20 and 300 Hz, 2.00 at 100 Hz (right: 0). Order 201: 0 at 20 Hz (right: 1), 1.00 at
#   100 Hz. bandpass() of order 200: -1.00 at 100 Hz (right: 1). lowpass() and highpass() of order 200 are right.
# Why it matters: a notch at the propellers' frequency doubles their vibration in the gyro, and a rate or a command through the
#   band-pass has the other sign.
# pinnquad: import smooths by least-squares polynomials (tools/logs/savitzky_golay.cpp); there are no notches.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" fili@2.0.3 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install fili"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { FirCoeffs, FirFilter } = require('fili');
const rate_Hz = 1000, rows = 2000;
// What a settled sine of 1 comes out as, against itself half the order earlier.
const gain = (type, order, frequency_Hz) => {
  const sine = (row) => Math.sin((2 * Math.PI * frequency_Hz * row) / rate_Hz);
  const filter = new FirFilter(new FirCoeffs()[type]({ order, Fs: rate_Hz, F1: 80, F2: 120, Fc: 100 }));
  const out = filter.multiStep(Array.from({ length: rows }, (_, row) => sine(row)));
  let alike = 0, power = 0;
  for (let row = rows - 1000; row < rows; ++row) {
    alike += out[row] * sine(row - order / 2);
    power += sine(row - order / 2) ** 2;
  }
  return alike / power;
};
let asRecorded = true;
for (const [type, order, ...recorded] of [['bandstop', 200, 1, 2, 1], ['bandstop', 201, 0, 1, 0], ['bandpass', 200, 0, -1, 0],
                                          ['lowpass', 200, 1, 0.5, 0], ['highpass', 200, 0, 0.5, 1]]) {
  const gains = [20, 100, 300].map((frequency_Hz) => gain(type, order, frequency_Hz));
  console.log(`${type} of order ${order}: ${gains.map((value) => value.toFixed(2)).join(', ')} at 20, 100, 300 Hz`);
  asRecorded &&= gains.every((value, i) => Math.abs(value - recorded[i]) < 0.02);
}
if (!asRecorded) {
  console.log('changed: the gains of the FIR filters');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

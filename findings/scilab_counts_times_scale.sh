#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: Scilab 6.1.1 (Debian 12's scilab-cli 6.1.1+dfsg2-6).
# One would guess: int16 times a decimal number is the product, rounded if the result is int16: 1000 * 0.061 is 61, as in Octave.
# What happens: the decimal number is cut to an int16 before the product. Every scale below 1 is 0, and 2.7 is 2; a divisor is
#   not cut. Nothing is reported.
# Seen: int16([7 1000 -2048]) * 0.061 -> 0 0 0 (right: 0 61 -125); 1000 * 2.7 -> 2000 (right: 2700); 1000 * 0.4 -> 0,
#   1000 / 2.5 -> 400.
# Why it matters: sensors log counts of 16 bits, and 0.061 mg a count is a usual accelerometer: scaled, it is all zeros. A
#   scale of 2.7 leaves a flight that looks like one, a quarter too small.
# pinnquad: counts become double before they are scaled (tools/logs/dataflash.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in scilab-cli=6.1.1+dfsg2-6 octave=7.3.0-2; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install $want"; exit 2; }
done
cat >"$dir/observe.m" <<'BOTH'
counts = int16([7 1000 -2048]);
printf("%d %d %d, ", double(counts * 0.061));
printf("%d, %d, %d\n", double(counts(2) * 2.7), double(counts(2) * 0.4), double(counts(2) / 2.5));
BOTH
scilab=$(HOME=$dir scilab-cli -nb -quit -f "$dir/observe.m" </dev/null 2>"$dir/errors" | grep ,)
octave=$(octave-cli --norc -q "$dir/observe.m" 2>"$dir/errors")
printf 'Scilab: %s\nOctave: %s\n' "$scilab" "$octave"
if [ "$scilab" != "0 0 0, 2000, 0, 400" ] || [ "$octave" != "0 61 -125, 2700, 400, 400" ]; then
  echo "changed: int16 times a decimal number"
  exit 1
fi

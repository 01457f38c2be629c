#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: signal 1.4.3 of Octave 7.3.0 (Debian 12's octave-signal 1.4.3-1).
# One would guess: the type of decimate()'s filter changes how well it filters, not where the flight is in time.
# What happens: the default, a Chebyshev filter, is run forwards and backwards, without delay. "fir" is run forwards alone and
#   its delay is not taken back: the result is half the order of input rows late, 15 rows by default, and begins near 0.
# Seen: the ramp 1, 2, ... 400 by 4 with "fir": order 10 is 5 rows late, 30 is 15, 60 is 30. 9.81 begins as -0.0123.
# Why it matters: 15 rows of a 250 Hz log are 60 ms, three times a rotor lag. Decimated with "fir", a gyro is late against the
#   motor commands beside it, and an identified lag grows or turns negative.
# pinnquad: smooths in place, by least-squares polynomials (tools/logs/savitzky_golay.cpp), and identifies each command's lag.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
[ "$(dpkg-query -W -f '${Version}' octave-signal 2>/dev/null)" = "1.4.3-1" ] || { echo "not run: install octave-signal=1.4.3-1"; exit 2; }
cat >"$dir/observe.m" <<'OCTAVE'
pkg load signal
ramp = (1:400)';
late = @(order) ramp(1 + 4 * 49) - decimate(ramp, 4, order, "fir")(50);
late_rows = [late(10), late(30), late(60)];
first = decimate(9.81 * ones(100, 1), 4, 30, "fir")(1);
printf("rows late: %.2f (order 10), %.2f (30), %.2f (60); 9.81 begins as %.4f\n", late_rows, first);
assert(late_rows, [5, 15, 30], 1e-6);
assert(first, -0.0123, 1e-3);
OCTAVE
octave-cli --norc -q "$dir/observe.m" 2>"$dir/errors" || { echo "changed: the delay of decimate's fir"; exit 1; }

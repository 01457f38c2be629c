#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: control 3.4.0 of Octave 7.3.0 (Debian 12's octave-control 3.4.0-3).
# One would guess: c2d() gives a discrete model of the same plant: whichever method is chosen, its steady state is nearly the same.
# What happens: "impulse" samples the impulse response and does not multiply it by the period, so the discrete model's gain is
#   about 1 / period times too great. The other four methods keep it.
# Seen: a rotor of 20 ms lag and gain 1 at 250 Hz: gain 275.8 by "impulse", 1 by zoh, foh, tustin and matched.
# Why it matters: a rotor or a filter discretised by it answers a step 276 times as strongly; a loop closed around it is
#   unstable, or is tuned with gains that are 276 times too small.
# pinnquad: the rotor lag is part of the state that Runge-Kutta integrates (include/pinnquad/vehicle/quadrotor.hpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
[ "$(dpkg-query -W -f '${Version}' octave-control 2>/dev/null)" = "3.4.0-3" ] || { echo "not run: install octave-control=3.4.0-3"; exit 2; }
cat >"$dir/observe.m" <<'OCTAVE'
pkg load control
rotor = tf(1, [0.02, 1]);
gain = @(method) dcgain(c2d(rotor, 0.004, method));
impulse_gain = gain("impulse");
others = [gain("zoh"), gain("foh"), gain("tustin"), gain("matched")];
printf("gain of a rotor of gain 1: impulse %.1f, zoh, foh, tustin, matched %.3f %.3f %.3f %.3f\n", impulse_gain, others);
assert(impulse_gain, 275.8, 0.1);
assert(others, ones(1, 4), 1e-9);
OCTAVE
octave-cli --norc -q "$dir/observe.m" 2>"$dir/errors" || { echo "changed: the gain of c2d's impulse"; exit 1; }

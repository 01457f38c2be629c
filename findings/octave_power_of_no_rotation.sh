#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: quaternion 2.4.0 of Octave 7.3.0 (Debian 12's octave-quaternion 2.4.0-10).
# One would guess: the identity to any power is the identity, exp(log(q)) is q for every rotation, and exp(0) is 1.
# What happens: log, exp and powers divide by the length of the vector part, or of its rounded angle. At the identity x, y and z
#   are NaN, and exp(log(q)) is NaN too for rotations below 2e-8 rad. No error or warning is given.
# Seen: quaternion(1,0,0,0)^0.5 -> 1, NaN, NaN, NaN; log of it 0, NaN, NaN, NaN; exp(quaternion(0,0,0,0)) 1, NaN, NaN, NaN;
#   exp(log(q)) of 1e-9 rad about z: z is NaN; of 1e-4 rad it is right.
# Why it matters: q0 * (inv(q0) * q1)^t interpolates attitudes. Where a log holds its attitude for two rows, on the ground or at
#   a logger's repeated sample, the interpolated attitude is NaN.
# pinnquad: attitudes between rows are interpolated by components and normalised (include/pinnquad/features/input_history.hpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
[ "$(dpkg-query -W -f '${Version}' octave-quaternion 2>/dev/null)" = "2.4.0-10" ] || { echo "not run: install octave-quaternion=2.4.0-10"; exit 2; }
cat >"$dir/observe.m" <<'OCTAVE'
pkg load quaternion
still = quaternion(1, 0, 0, 0);
half = still ^ 0.5;
logarithm = log(still);
one = exp(quaternion(0, 0, 0, 0));
small = exp(log(rot2q([0 0 1], 1e-9)));
larger = exp(log(rot2q([0 0 1], 1e-4)));
printf("identity: z of its root %g, of its logarithm %g; z of exp(0) %g; exp(log()) of 1e-9 rad: z %g, of 1e-4 rad: z %g\n", ...
       half.z, logarithm.z, one.z, small.z, larger.z);
assert(isnan([half.z, logarithm.z, one.z, small.z]), true(1, 4));
assert(larger.z, 5e-5, 1e-12);
OCTAVE
octave-cli --norc -q "$dir/observe.m" 2>"$dir/errors" || { echo "changed: log, exp or powers of small rotations"; exit 1; }

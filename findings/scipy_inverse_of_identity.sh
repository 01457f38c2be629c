#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: SciPy 1.10.1 (Debian 12's python3-scipy).
# One would guess: Rotation.inv() conjugates, so x, y and z change sign and w stays: the identity is its own inverse.
# What happens: inv() changes the sign of w and leaves x, y, z. The rotation is the same, the numbers are not: the inverse of
#   the identity is (0, 0, 0, -1), and w of the inverse of each small rotation is negative.
# Seen: identity -> [0, 0, 0, -1]; 0.1 rad about x -> [0.04998, 0, 0, -0.99875].
# Why it matters: an attitude error is made by inv(). 2 * (x, y, z) as its small angle has the wrong sign, a log or a network's
#   input that was recorded with w > 0 meets the other half of the sphere, and interpolation by component passes through zero.
# pinnquad: conjugate() keeps w (core/rotation.hpp), and the attitude loop takes the short way round for either sign of w.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
from scipy.spatial.transform import Rotation

identity = Rotation.identity().inv().as_quat()
small = Rotation.from_rotvec([0.1, 0, 0]).inv().as_quat()
print("inverse of the identity (x, y, z, w):", identity, "and of 0.1 rad about x:", np.round(small, 5))
assert identity[3] == -1 and small[3] < 0 and small[0] > 0, "changed: inv() conjugates, w keeps its sign"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

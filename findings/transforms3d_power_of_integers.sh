#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: transforms3d 0.4 (Debian 12's python3-transforms3d 0.4+ds-2).
# One would guess: qpow, qexp and qlog of a quaternion written as [0, 0, 0, 1] do what they do for [0., 0., 0., 1.].
# What happens: the result has the type of the argument. Integers cut each component to an integer: no error, no warning.
# Seen: qpow([0, 0, 0, 1], .5), half of a turn by 180 degrees: 0, 0, 0, 0 (right: .707, 0, 0, .707); qlog of it 0, 0, 0, 1
#   (right: 0, 0, 0, 1.571); qexp([0, 0, 0, 1]) 0, 0, 0, 0 (right: .540, 0, 0, .841). Its product and matrix are right.
# Why it matters: test attitudes and mounting rotations are typed with integers: between two of them slerp by powers passes
#   through a quaternion of length 0.
# pinnquad: its Python package turns each attitude into double (docs/python.md).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
[ "$(dpkg-query -W -f '${Version}' python3-transforms3d 2>/dev/null)" = "0.4+ds-2" ] || { echo "not run: install python3-transforms3d=0.4+ds-2"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
from transforms3d.quaternions import qexp, qlog, qpow

whole, fraction = [0, 0, 0, 1], [0.0, 0.0, 0.0, 1.0]
print("integers:", qpow(whole, 0.5), qlog(whole), qexp(whole), "floats:", qpow(fraction, 0.5), qlog(fraction), qexp(fraction))
half = np.sqrt(0.5)
right = ([half, 0, 0, half], [0, 0, 0, np.pi / 2], [np.cos(1), 0, 0, np.sin(1)])
for value, wanted in zip((qpow(fraction, 0.5), qlog(fraction), qexp(fraction)), right):
    assert np.allclose(value, wanted), "changed: powers of floats"
for value, seen in zip((qpow(whole, 0.5), qlog(whole), qexp(whole)), ([0, 0, 0, 0], [0, 0, 0, 1], [0, 0, 0, 0])):
    assert np.array_equal(value, seen), "changed: powers of integers"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

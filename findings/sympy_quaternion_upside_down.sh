#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: SymPy 1.11.1 (Debian 12's python3-sympy).
# One would guess: Quaternion.from_rotation_matrix gives the quaternion of every rotation matrix, of 180 degrees too.
# What happens: signs of x, y and z are taken from differences of mirrored elements, and the sign of 0 is 0. A rotation by 180
#   degrees has a symmetric matrix: x, y, z and w are all 0, without an error.
# Seen: yaw 60, roll 180 degrees -> 0 + 0*i + 0*j + 0*k (exact is 0.866*i + 0.5*j); roll 170 degrees is right.
# Why it matters: a quadrotor that is upside down has such a matrix; derivations and generated code start in SymPy.
# pinnquad: from_rotation_matrix() divides by the largest of the four components (core/rotation.hpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.11.1-1
[ "$(dpkg-query -W -f '${Version}' python3-sympy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-sympy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
from sympy import Matrix, Rational, cos, pi, rot_axis1, rot_axis3
from sympy.algebras.quaternion import Quaternion


def length(roll):
    about = rot_axis3(-pi / 3) * rot_axis1(-roll)  # SymPy's axes turn the other way
    assert about.T * about == Matrix.eye(3) and about.det() == 1 or abs(float((about.T * about).norm()) - 3**0.5) < 1e-12
    found = Quaternion.from_rotation_matrix(about)
    return float(found.norm()), found


right, _ = length(pi * Rational(17, 18))
lost, found = length(pi)
print(f"length of the quaternion: {right:.4f} at 170 degrees of roll, {lost:.4f} at 180 ({found})")
assert abs(right - 1) < 1e-9 and lost < 1e-6, "changed: from_rotation_matrix is right at 180 degrees"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

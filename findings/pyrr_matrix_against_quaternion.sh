#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: pyrr 0.10.3 (Debian 12's python3-pyrr 0.10.3-5).
# One would guess: a quaternion and the matrix made from it turn a vector to the same place; so do quaternion and matrix made
#   from the same angle, or from the same Euler angles.
# What happens: matrices turn row vectors: apply_to_vector() of a matrix multiplies from the left, but the matrices of
#   create_from_quaternion() and create_from_z_rotation() are those for column vectors. So the vector turns the other way
#   than with apply_to_vector() of the quaternion. From Euler angles the two differ in the order too: neither is the other's
#   transposed.
# Seen: (1, 2, 3) turned by 0.5 rad about z: quaternion (-0.081, 2.235, 3), matrix (1.836, 1.276, 3).
# Why it matters: a viewer draws the attitude by a matrix, thrust arrows by a quaternion: one of them turns the wrong way.
# pinnquad: tests hold from_rotation_matrix() and body_to_world() of its quaternion to each other (tests/core/rotation.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1:1.24.2-1+deb12u1
[ "$(dpkg-query -W -f '${Version}' python3-numpy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-numpy=$want"; exit 2; }
cd "$dir"
for package in python3-pyrr=0.10.3-5 python3-multipledispatch=0.6.0-3; do
  apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
done
for archive in ./*.deb; do dpkg-deb -x "$archive" packages; done
cat >observe.py <<'PYTHON'
import numpy as np
from pyrr import matrix33, quaternion

vector, euler = np.array([1.0, 2.0, 3.0]), [0.3, 0.2, 0.1]
turned = quaternion.apply_to_vector(quaternion.create_from_z_rotation(0.5), vector)
matrix = matrix33.create_from_z_rotation(0.5)
print("about z: quaternion", turned.round(3), "matrix", matrix33.apply_to_vector(matrix, vector).round(3))
by_quaternion = matrix33.create_from_quaternion(quaternion.create_from_eulers(euler))
by_euler = matrix33.create_from_eulers(euler)
print("from Euler angles: matrices differ by", np.abs(by_quaternion - by_euler).max().round(3), "and transposed by",
      np.abs(by_quaternion - by_euler.T).max().round(3))
by_matrix = matrix33.apply_to_vector(matrix, vector)
assert np.allclose(matrix @ vector, turned) and not np.allclose(by_matrix, turned), "changed: pyrr's matrix turns as its quaternion"
assert not np.allclose(by_quaternion, by_euler) and not np.allclose(by_quaternion, by_euler.T), "changed: Euler angles give one rotation"
PYTHON
PYTHONPATH=packages/usr/lib/python3/dist-packages /usr/bin/python3 observe.py 2>errors || { tail -n 1 errors; exit 1; }

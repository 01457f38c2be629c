#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: Bullet 3.24 (Debian 12's libbullet-dev 3.24+dfsg-2, whose headers are single precision by default).
# One would guess: the angle of a quaternion, and between two, is found to six digits or so, as its x, y and z are.
# What happens: getAngle() and angleShortestPath() are acos() of w or of a dot product. Near 1 a float cannot tell 1 from
#   1 - 3e-8: the angle comes in steps, and is 0 below 3e-4 rad. 2 atan2(length of x, y, z; w) of the same quaternion is exact.
# Seen: 0.01 rad -> 0.0100068; 0.001 -> 0.000977; 0.0003 -> 0 (0.02 degrees).
# Why it matters: the error of an attitude loop in a simulator is mostly that small. Its log is a staircase that ends at 0, and a
#   slow drift is not seen.
# pinnquad: attitude errors are made of x, y and z of the error's quaternion (include/pinnquad/control).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
apt-get download libbullet-dev=3.24+dfsg-2 >log 2>&1 || { echo "not run: apt-get does not download libbullet-dev=3.24+dfsg-2"; exit 2; }
dpkg-deb -x ./*.deb packages
cat >observe.cpp <<'CPP'
#include <LinearMath/btQuaternion.h>
#include <cmath>
#include <cstdio>
int main() {
  bool as_recorded = true;
  const auto observe = [&](float angle, double recorded) {
    const btQuaternion turned(btVector3(0, 0, 1), angle);
    const double got = turned.getAngle(), between = turned.angleShortestPath(btQuaternion(0, 0, 0, 1));
    const double exact = 2 * std::atan2(double(turned.z()), double(turned.w()));
    std::printf("%g rad: getAngle() %.7f, angleShortestPath() %.7f, by atan2 %.7f\n", angle, got, between, exact);
    as_recorded = as_recorded && std::fabs(got - recorded) < 1e-6 && std::fabs(exact - angle) < 1e-8;
  };
  observe(0.01f, 0.0100068);
  observe(0.001f, 0.0009766);
  observe(0.0003f, 0);
  if (!as_recorded) std::puts("changed: the angle of a small rotation");
  return as_recorded ? 0 : 1;
}
CPP
g++ -O1 -w -Ipackages/usr/include/bullet observe.cpp -o observe
./observe

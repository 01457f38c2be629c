#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: GLM 0.9.9.8 (Debian 12's libglm-dev 0.9.9.8+ds-6).
# One would guess: quat(eulerAngles(q)) is q again, up to rounding and its sign, at a pitch of 90 degrees too; double is at
#   least as exact as float.
# What happens: the branch for 90 degrees is taken where two terms are within the type's epsilon of 0. In double the terms
#   are two to three times that by rounding, the branch is missed, and a yaw made of noise is added to the roll.
# Seen: yaw 0.2, pitch pi/2: float comes back; double comes back 0.245 rad (14 degrees) off.
# Why it matters: a loop, a tail-sitter and a quadrotor in a flip pass there; the drawn attitude jumps in one sample.
# pinnquad: attitudes are quaternions; Euler angles are read from logs that have no others, and shown on the page of flights.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
package=libglm-dev=0.9.9.8+ds-6
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
cat >observe.cpp <<'CPP'
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
template <class T>
double error() {  // rad, of the attitude that comes back
  using Vector = glm::vec<3, T>;
  const auto q = glm::angleAxis(T(0.2), Vector(0, 0, 1)) * glm::angleAxis(glm::half_pi<T>(), Vector(0, 1, 0));
  const auto back = glm::qua<T>(glm::eulerAngles(q));
  return 2 * std::acos(std::min(1.0, std::fabs(double(glm::dot(q, back)))));
}
int main() {
  const double in_float = error<float>(), in_double = error<double>();
  std::printf("straight up, there and back: float %.4f rad off, double %.4f rad off\n", in_float, in_double);
  if (in_float < 0.01 && in_double > 0.2) return 0;
  std::puts("changed: eulerAngles() of float or double at a pitch of 90 degrees");
  return 1;
}
CPP
g++ -w -Ipackages/usr/include observe.cpp -o observe
./observe

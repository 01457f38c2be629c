#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: GLM 0.9.9.8 (Debian 12's libglm-dev 0.9.9.8+ds-6).
# One would guess: squad() with control points from intermediate() is the smooth curve through attitudes; where the rate is
#   constant it is slerp.
# What happens: intermediate() ends with exp() of a sum that is 0 at constant rate and at rest, and GLM's exp(0) is the
#   quaternion (0, 0, 0, 0), not the identity. The control point is no rotation, and squad() with it leaves the path between
#   its ends.
# Seen: exp(0) has w = 0. Attitudes at 0, 0.5, 1 and 1.5 rad about z: a quarter of the way from 0.5 to 1 squad() is at
#   1.316 rad (right: 0.625). Four times the same attitude: 0.5 rad becomes a quaternion of length 0.831. slerp() is right.
# Why it matters: viewers resample logged attitudes for smooth video: the vehicle swings about between its samples.
# pinnquad: its page of flights interpolates two attitudes at a time, the shorter way (tools/page/watch/src/flight.js).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
package=libglm-dev=0.9.9.8+ds-6
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
cat >observe.cpp <<'CPP'
#define GLM_ENABLE_EXPERIMENTAL
#include <cmath>
#include <cstdio>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtx/quaternion.hpp>
static glm::dquat yaw(double angle) { return glm::angleAxis(angle, glm::dvec3(0, 0, 1)); }
int main() {
  const auto q0 = yaw(0), q1 = yaw(0.5), q2 = yaw(1), q3 = yaw(1.5);
  const double identity = glm::exp(glm::dquat(0, 0, 0, 0)).w;
  const double curved = glm::angle(glm::squad(q1, q2, glm::intermediate(q0, q1, q2), glm::intermediate(q1, q2, q3), 0.25));
  const double straight = glm::angle(glm::slerp(q1, q2, 0.25));
  const auto still = glm::intermediate(q1, q1, q1);
  const double length = glm::length(glm::squad(q1, q1, still, still, 0.25));
  std::printf("exp(0) has w = %g; squad at %.3f, slerp at %.3f rad; at rest a length of %.3f\n", identity, curved, straight, length);
  if (identity == 0 && std::fabs(curved - 1.3161) < 1e-3 && std::fabs(straight - 0.625) < 1e-6 && length < 0.9) return 0;
  std::puts("changed: squad() with intermediate() is elsewhere, or exp(0) is the identity");
  return 1;
}
CPP
g++ -w -Ipackages/usr/include observe.cpp -o observe
./observe

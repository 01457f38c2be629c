#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: Boost 1.74.0's odeint (Debian 12's libboost1.74-dev 1.74.0+ds1-21).
# One would guess: adams_bashforth<4> is of the fourth order: half the step, a sixteenth of the error.
# What happens: it is so if do_step() writes to another state. If it writes to the state that it reads, as the integrate
#   functions let it, the first three steps are wrong, and their error, of the first order, stays.
# Seen: x' = x cos t to 4 s in 160 steps: error 0.049 in place, 3.3e-7 to another state; in 320 steps 0.024 and 2.0e-8. Euler's
#   method has 0.0036 in 160 steps.
# Why it matters: it is chosen where the model is costly, as it evaluates it once a step. The flight looks plausible, and is
#   further off than Euler's.
# pinnquad: its simulator steps by Runge-Kutta, of which tests measure the order.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
package=libboost1.74-dev=1.74.0+ds1-21
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
cat >observe.cpp <<'CPP'
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstdio>
#include <vector>
namespace odeint = boost::numeric::odeint;
using State = std::vector<double>;
static void slope(const State& x, State& dx, double t) { dx[0] = x[0] * std::cos(t); }
static double error(const State& x) { return std::fabs(x[0] - std::exp(std::sin(4.0))); }
int main() {
  double in_place[2], apart[2], euler = 0;
  for (int k = 0; k < 2; ++k) {
    const int steps = k == 0 ? 160 : 320;
    const double dt = 4.0 / steps;
    State x{1}, y{1}, next{1}, z{1};
    odeint::integrate_n_steps(odeint::adams_bashforth<4, State>(), slope, x, 0.0, dt, steps);
    odeint::adams_bashforth<4, State> stepper;
    for (int i = 0; i < steps; ++i, y = next) stepper.do_step(slope, y, i * dt, next, dt);
    in_place[k] = error(x), apart[k] = error(y);
    if (k > 0) continue;
    odeint::integrate_n_steps(odeint::euler<State>(), slope, z, 0.0, dt, steps);
    euler = error(z);
  }
  std::printf("errors in 160 and 320 steps: in place %.2g and %.2g, to another state %.2g and %.2g; Euler's, in 160, %.2g\n",
              in_place[0], in_place[1], apart[0], apart[1], euler);
  const double halved = in_place[0] / in_place[1], order_four = apart[0] / apart[1];
  if (in_place[0] > 10 * euler && halved > 1.9 && halved < 2.2 && order_four > 14 && order_four < 18) return 0;
  std::puts("changed: the order of adams_bashforth in place");
  return 1;
}
CPP
g++ -O1 -w -Ipackages/usr/include observe.cpp -o observe
./observe

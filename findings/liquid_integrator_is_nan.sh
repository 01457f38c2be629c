#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: liquid-dsp 1.5.0 (Debian 12's libliquid-dev 1.5.0-2).
# One would guess: iirfilt_rrrf_create_integrator() sums its input, iirfilt_rrrf_create_differentiator() gives its slope, a few
#   rows late.
# What happens: the integrator's gain is negative, and shared by its four sections: a fourth root, NaN, and so are all outputs. The
#   differentiator is good to 4 % below a twentieth of the sampling rate, and falls off after that.
# Seen: the integral of 1, 1, 1, ...: NaN. The slope of a ramp of 0.5 a row: 0.5166. Of sines, over 2 pi f: 0.91 at 0.1 of the
#   sampling rate, 0.65 at 0.2. A difference of two rows, sin(pi f) / (pi f): 0.98, 0.94.
# Why it matters: angular accelerations of a gyro and speeds of an accelerometer come from such filters. A derivative that is 9 %
#   low at 25 Hz, of a log at 250 Hz, makes an identified effectiveness as much too small.
# pinnquad: import differentiates by least-squares polynomials, exact for ramps (tools/logs/savitzky_golay.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
for package in libliquid-dev=1.5.0-2 libfftw3-single3=3.3.10-1; do
  apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
done
for archive in ./*.deb; do dpkg-deb -x "$archive" packages; done
cat >observe.cpp <<'CPP'
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <liquid/liquid.h>
int main() {
  const int rows = 4000, settled = 2000;
  float got = 0;
  int not_a_number = 0;
  iirfilt_rrrf integrator = iirfilt_rrrf_create_integrator(), differentiator = iirfilt_rrrf_create_differentiator();
  for (int i = 0; i < rows; ++i) {
    iirfilt_rrrf_execute(integrator, 1.0f, &got);
    not_a_number += std::isnan(got);
  }
  for (int i = 0; i < rows; ++i) iirfilt_rrrf_execute(differentiator, 0.5f * i, &got);
  const double slope = got;
  const auto gain = [&](double frequency) {  // of the root of the mean square, over 2 pi f
    double in = 0, out = 0;
    iirfilt_rrrf_reset(differentiator);
    for (int i = 0; i < rows; ++i) {
      const double sine = std::sin(2 * M_PI * frequency * i);
      iirfilt_rrrf_execute(differentiator, float(sine), &got);
      if (i < settled) continue;
      in += sine * sine;
      out += double(got) * got;
    }
    return std::sqrt(out / in) / (2 * M_PI * frequency);
  };
  const double fifth = gain(0.2), tenth = gain(0.1), twentieth = gain(0.05);
  std::printf("the integral of ones is NaN in %d of %d rows; the slope of a ramp of 0.5: %.4f\n", not_a_number, rows, slope);
  std::printf("slopes of sines over the right ones: %.3f at 0.05, %.3f at 0.1, %.3f at 0.2\n", twentieth, tenth, fifth);
  const auto near = [](double value, double recorded) { return std::fabs(value - recorded) < 0.005; };
  if (not_a_number == rows && near(slope, 0.5166) && near(twentieth, 1) && near(tenth, 0.91) && near(fifth, 0.65)) return 0;
  std::puts("changed: the integrator or the differentiator");
  return 1;
}
CPP
libraries=$(echo packages/usr/lib/*)
g++ -O1 -w -Ipackages/usr/include observe.cpp -L"$libraries" -l:libliquid.a -l:libfftw3f.so.3 -lm -o observe
LD_LIBRARY_PATH=$libraries ./observe

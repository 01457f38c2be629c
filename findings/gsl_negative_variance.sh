#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: GSL 2.7.1 (Debian 12's libgsl-dev and libgsl27 2.7.1+dfsg-5+deb12u1).
# One would guess: a variance is never negative, and a moving window of five rows knows nothing of the rows before it.
# What happens: gsl_movstat_variance() takes back what left the window, so one wild row stays behind as a rounding error: the
#   variance of all later windows is wrong, and negative. One NaN makes every later mean NaN, while the moving median of the
#   same rows shows no NaN at all.
# Seen: a sine of 60 rows, 1e9 in row 20: variance in row 40 is -0.0004 (right: 0.0106); NaN in row 20: 42 means of 60 are
#   NaN, no median is.
# Why it matters: the square root of a moving variance is a usual measure of vibration: after one spike it is NaN.
# pinnquad: import's filters sum each window anew, between rows that are finite (tools/logs/savitzky_golay.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
for package in libgsl-dev=2.7.1+dfsg-5+deb12u1 libgsl27=2.7.1+dfsg-5+deb12u1 libgslcblas0=2.7.1+dfsg-5+deb12u1; do
  apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
done
for archive in ./*.deb; do dpkg-deb -x "$archive" packages; done
cat >observe.cpp <<'CPP'
#include <cmath>
#include <cstdio>
#include <gsl/gsl_movstat.h>
int main() {
  const int rows = 60;
  gsl_vector *flown = gsl_vector_alloc(rows), *moving = gsl_vector_alloc(rows);
  gsl_movstat_workspace* window = gsl_movstat_alloc(5);
  const auto fill = [&](double wild) {
    for (int i = 0; i < rows; ++i) gsl_vector_set(flown, i, i == 20 ? wild : std::sin(0.1 * i));
  };
  const auto lost = [&] {
    int count = 0;
    for (int i = 0; i < rows; ++i) count += std::isnan(gsl_vector_get(moving, i));
    return count;
  };
  fill(1e9);
  gsl_movstat_variance(GSL_MOVSTAT_END_PADVALUE, flown, moving, window);
  const double after = gsl_vector_get(moving, 40);
  fill(0);
  gsl_movstat_variance(GSL_MOVSTAT_END_PADVALUE, flown, moving, window);
  const double right = gsl_vector_get(moving, 40);
  fill(NAN);
  gsl_movstat_mean(GSL_MOVSTAT_END_PADVALUE, flown, moving, window);
  const int means = lost();
  gsl_movstat_median(GSL_MOVSTAT_END_PADVALUE, flown, moving, window);
  const int medians = lost();
  std::printf("variance 20 rows after a spike %.4f, without one %.4f; one NaN: %d means, %d medians are NaN\n", after, right, means, medians);
  if (after < 0 && right > 0 && means == 42 && medians == 0) return 0;
  std::puts("changed: the moving variance, mean or median of GSL forgets what has left its window");
  return 1;
}
CPP
libraries=packages/usr/lib/$(g++ -print-multiarch)
g++ -w -Ipackages/usr/include observe.cpp -o observe "$libraries/libgsl.so.27" "$libraries/libgslcblas.so.0"
LD_LIBRARY_PATH=$libraries ./observe

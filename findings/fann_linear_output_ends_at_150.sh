#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: FANN 2.2.0 (Debian 12's libfann-dev and libfann2 2.2.0+ds-8).
# One would guess: FANN_LINEAR is unbounded, and fann_get_MSE() is the mean of squared errors.
# What happens: each neuron's sum is cut to +-150 over its steepness before the activation, the linear one's too. The error of
#   an output with a symmetric activation, such as tanh, is halved, so its MSE is a quarter. No error or warning is given.
# Seen: a linear neuron of weight 1 and steepness 1: 100 -> 100, 6000 -> 150. An output of 0 for 0.8: MSE 0.16 with
#   FANN_SIGMOID_SYMMETRIC, 0.64 with FANN_LINEAR.
# Why it matters: outputs in rotations per minute or microseconds end at 150. Compared by MSE, a network with tanh at its end
#   wins by four over one that is as good.
# pinnquad: the last layer of its networks is linear and unbounded; R^2 and errors are of the commands.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
for package in libfann-dev=2.2.0+ds-8 libfann2=2.2.0+ds-8; do
  apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
done
for archive in ./*.deb; do dpkg-deb -x "$archive" packages; done
cat >observe.c <<'C'
#include <fann.h>
#include <math.h>
#include <stdio.h>
static struct fann* neuron(enum fann_activationfunc_enum activation, fann_type weight) {
  struct fann* made = fann_create_standard(2, 1, 1);
  fann_set_activation_function_output(made, activation);
  fann_set_activation_steepness_output(made, 1);
  fann_set_weight(made, 0, 2, weight);
  fann_set_weight(made, 1, 2, 0); /* of the constant */
  return made;
}
static double squared(enum fann_activationfunc_enum activation) {
  fann_type in = 1, wanted = 0.8f;
  struct fann* silent = neuron(activation, 0);
  fann_test(silent, &in, &wanted);
  return fann_get_MSE(silent);
}
int main(void) {
  fann_type slow = 100, fast = 6000;
  struct fann* linear = neuron(FANN_LINEAR, 1);
  const double low = *fann_run(linear, &slow), high = *fann_run(linear, &fast);
  const double by_tanh = squared(FANN_SIGMOID_SYMMETRIC), by_line = squared(FANN_LINEAR);
  printf("100 -> %g, 6000 -> %g; 0 for 0.8 is an MSE of %.2f by tanh, %.2f by a line\n", low, high, by_tanh, by_line);
  if (low == 100 && high == 150 && fabs(by_tanh - 0.16) < 1e-6 && fabs(by_line - 0.64) < 1e-6) return 0;
  puts("changed: the end of a linear output, or the MSE of a symmetric one");
  return 1;
}
C
libraries=packages/usr/lib/$(gcc -print-multiarch)
gcc -w -Ipackages/usr/include observe.c -o observe "$libraries/libfann.so.2"
LD_LIBRARY_PATH=$libraries ./observe

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# check.sh <compiler> <include folder> <Eigen's include folder> <work folder> <flags...>: compiles and runs
# broken_weights.cpp. Returns 77 where the compiler or the processor lacks something.
set -u
compiler=$1 include=$2 eigen=$3 work=$4
shift 4
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$work"

skip() { echo "skipped: $*"; exit 77; }
command -v "$compiler" > /dev/null || skip "no $compiler"
case "$*" in
  *x86-64-v3*) grep -q avx2 /proc/cpuinfo || skip "no AVX2" ;;
  *x86-64-v4*) grep -q avx512vl /proc/cpuinfo || skip "no AVX-512" ;;
esac
"$compiler" -std=c++17 -DNDEBUG "$@" -I"$include" -isystem "$eigen" "$here/broken_weights.cpp" -o "$work/broken_weights" ||
  { echo "failed: $compiler $*"; exit 1; }
"$work/broken_weights"

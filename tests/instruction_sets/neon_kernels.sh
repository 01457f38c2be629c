#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# neon_kernels.sh <repository> <Eigen's include folder> <doctest's include folder> <working folder>: the tests of what
# runs on a vector unit with NEON under emulation. Returns 77 where a tool is missing.
set -euo pipefail
root=$1 eigen=$2 doctest=$3 work=$4
skip() { echo "skipped: $*"; exit 77; }
compiler=$(command -v aarch64-linux-gnu-g++) || skip "no aarch64-linux-gnu-g++"
emulator=$(command -v qemu-aarch64 || command -v qemu-aarch64-static) || skip "no qemu-aarch64"
# doctest's folder alone: beside it may stand the headers of the host's C library
rm -rf "$work"
mkdir -p "$work/include"
ln -s "$doctest/doctest" "$work/include/doctest"
# unoptimised, as the presets compile these tests: optimising kernels that are unrolled when compiled takes minutes
flags=(-std=c++17 -O0 -static -DPINNQUAD_INLINE_AS_COMPILER_LIKES "-I$root/include" "-I$root/tests" "-I$work/include"
  -isystem "$eigen")

# Every operation of a pack, the way forward and a mini-batch. The slopes are made of the same operations.
sources=("$root"/tests/nn/{activations,batched_network,clip,kernels,packed_network,register_layer}.cpp)
# what each includes, compiled once for all of them
printf '#include <Eigen/Core>\n#include <doctest/doctest.h>\n' >"$work/precompiled.hpp"
"$compiler" "${flags[@]}" -x c++-header "$work/precompiled.hpp" -o "$work/precompiled.hpp.gch"
"$compiler" "${flags[@]}" -c "$root/tests/main.cpp" -o "$work/main.o"
objects=("$work/main.o")
for source in "${sources[@]}"; do
  objects+=("$work/$(basename "$source" .cpp).o")
  "$compiler" "${flags[@]}" -include "$work/precompiled.hpp" -c "$source" -o "${objects[-1]}"
done
"$compiler" "${flags[@]}" "${objects[@]}" -o "$work/kernels"
"$emulator" "$work/kernels"

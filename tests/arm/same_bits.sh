#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# same_bits.sh <repository> <working folder> <host | aarch64 | armhf>: the portable kernel has the same bits wherever
# the hardware multiplies and adds in one rounding: g++ and clang++, -O0 to -O3, x86-64, 64-bit and 32-bit ARM (under
# qemu-user). Compiled as another project would, without this one's flags.
set -euo pipefail
root=$1 work=$2/$3 machine=$3
mkdir -p "$work"

skip() {
  echo "SKIPPED: $*"
  exit 77
}
need() { command -v "$1" >/dev/null || skip "no $1; on Debian: apt-get install $2"; }

host_flags=
if [ "$(uname -m)" = x86_64 ]; then
  host_flags=-mfma
  grep -qw fma /proc/cpuinfo || skip "this machine has no fused multiply-add to compare with"
fi
need g++ g++

# build_and_run <name> <emulator or env> <compiler> <flag>...: its lines in $work/<name>
build_and_run() {
  local name=$1 emulator=$2 compiler=$3
  shift 3
  "$compiler" -std=c++17 "-I$root/include" "-I$root/tests/cortex_m" "$@" "$root/tests/arm/bits.cpp" -o "$work/program"
  "$emulator" "$work/program" >"$work/$name"
}

# compare <name>: with what g++ -O2 has on the host
failed=no
compare() {
  if cmp -s "$work/reference" "$work/$1"; then
    echo "$1: $(wc -l <"$work/$1") lines, same bits"
  else
    echo "FAILED: $1 differs from the host's g++ -O2:"
    diff "$work/reference" "$work/$1" | head -4
    failed=yes
  fi
}

build_and_run reference env g++ -O2 $host_flags
[ "$(wc -l <"$work/reference")" -eq 232 ] || { echo "FAILED: the reference is not whole"; exit 1; }

case $machine in
  host)
    for optimisation in -O0 -Os -O3; do
      build_and_run "g++$optimisation" env g++ "$optimisation" $host_flags
      compare "g++$optimisation"
      command -v clang++ >/dev/null || continue
      build_and_run "clang++$optimisation" env clang++ "$optimisation" $host_flags
      compare "clang++$optimisation"
    done
    # Must differ, or nothing is compared: two roundings instead of one where the machine's baseline has no fused
    # operation.
    if [ -n "$host_flags" ]; then
      build_and_run rounded_twice env g++ -O2 -DROUNDED_TWICE
      if cmp -s "$work/reference" "$work/rounded_twice"; then
        echo "FAILED: a product rounded before it is added makes no difference"
        failed=yes
      fi
    fi
    ;;
  aarch64 | armhf)
    if [ "$machine" = aarch64 ]; then
      compiler=aarch64-linux-gnu-g++ package=g++-aarch64-linux-gnu emulator=qemu-aarch64 flags=()
    else
      compiler=arm-linux-gnueabihf-g++ package=g++-arm-linux-gnueabihf emulator=qemu-arm
      flags=(-march=armv7-a -mfpu=neon-vfpv4)
    fi
    need "$compiler" "$package"
    need "$emulator" qemu-user
    for optimisation in -O0 -Os -O2 -O3; do
      build_and_run "$machine$optimisation" "$emulator" "$compiler" "$optimisation" -static "${flags[@]}"
      compare "$machine$optimisation"
    done
    ;;
esac
[ "$failed" = no ]

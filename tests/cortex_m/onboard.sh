#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# onboard.sh <repository> <working folder> <compiler> <Eigen>: what OnboardInverse costs on an M7 at -Os and -O2, within its
# limits of instructions, memory and stack; the slopes that it finds are the host's.
set -euo pipefail
root=$1 work=$2 compiler=$3 eigen=$4
# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_prepared
mkdir -p "$work/onboard"

# Instructions of the longest tick and of a second, by optimisation: a tenth above what is measured. 1 % of 400 MHz are
# 4 million a second, at an instruction a cycle. Bytes.
declare -A most_of_tick=([-Os]=73900 [-O2]=48000) most_of_second=([-Os]=2460000 [-O2]=1860000)
most_bytes=6100 most_stack=1000
# Microseconds of the clock become a float by doubles, which this M7 has.
forbidden=${forbidden%"|$doubles"}

fma=$(host_fma)
host=$work/onboard/host
"$compiler" -std=c++17 -O1 $fma -DNDEBUG -ffp-contract=off "-I$root/include" -isystem "$eigen" "$here/onboard.cpp" -o "$host"
"$host" >"$host.txt"
for optimisation in -Os -O2; do
  image=$work/onboard/m7_dp$optimisation
  compile m7_dp "$optimisation" "$here/onboard.cpp" "$image.o"
  compile m7_dp -O1 "$here/start_up.cpp" "$image.start_up.o"
  link_image m7_dp "$image" "$image.start_up.o" "$image.o"
  run_image m7_dp "$image" "$image.txt"
  judge_symbols "$image"
  if ! cmp -s <(grep '^rows' "$image.txt") <(grep '^rows' "$host.txt"); then reject "rows" "not the host's"; fi
  apart=$(ulps slopes "$image.txt" "$host.txt" 0 3)
  at_most "ulps of the slopes" "$apart" 256
  at_most "instructions of a tick" "$(largest instructions "$image.txt")" "${most_of_tick[$optimisation]}"
  at_most "instructions of a second" "$(largest second "$image.txt")" "${most_of_second[$optimisation]}"
  at_most "bytes" "$(largest bytes "$image.txt")" "$most_bytes"
  at_most "stack" "$(largest stack "$image.txt")" "$most_stack"
  echo "m7_dp $optimisation: $(grep '^instructions' "$image.txt" | sed 's/instructions //' | paste -sd, -) instructions;" \
    "$(largest second "$image.txt") a second; $(largest bytes "$image.txt") B, $(largest stack "$image.txt") B stack, slopes $apart ulp from the host"
done
if [ "$rejected" -gt 0 ]; then exit 1; fi

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# inner_loop.sh <repository> <working folder> <compiler> <Eigen>: the whole inner loop on an M7 at -Os and -O2, its core on
# an M4F too, within its limits of instructions and stack; answers and bias as on the host.
set -euo pipefail
root=$1 work=$2 compiler=$3 eigen=$4
# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_prepared
mkdir -p "$work/inner_loop"

fma=$(host_fma)

# loop_flags <loop>: the flight stacks' core with the shipped structured model, with one that has a residual network,
# the library's AdaptiveInverse in a TrackingController, and the core as it learns its vehicle: its longest tick is a row
loop_flags() {
  local block=$root/examples/models/structured_quadrotor.block
  case $1 in
    core) loop_flags=("${shipped_flags[@]}" "-DBLOCK_FILE=\"$block\"") ;;
    residual) loop_flags=("${structured_flags[@]}" "-DBLOCK_FILE=\"$work/structured_model.block\"") ;;
    onboard) loop_flags=("${shipped_flags[@]}" "-DBLOCK_FILE=\"$block\"" -DONBOARD) ;;
    library) loop_flags=("${shipped_flags[@]}" "-DBLOCK_FILE=\"$block\"" -DLIBRARY_LOOP) ;;
  esac
}

# Instructions of the longest tick, by loop and optimisation: a tenth above what is measured. Bytes of stack.
declare -A most_instructions=([core-Os]=26500 [core-O2]=13000 [residual-Os]=33200 [residual-O2]=20600
  [library-Os]=17200 [library-O2]=8000 [onboard-Os]=60800 [onboard-O2]=32000)
most_stack=1560
# A start reckons the airframe in double precision, which an M4F has not; a tick does not.
forbidden=${forbidden%"|$doubles"}

# link_loop <target> <loop> <object> <image>: with what measures it, compiled once a block, and runs it.
link_loop() {
  local target=$1 object=$3 image=$4 part common=$work/inner_loop/$1.$2
  loop_flags "$2"
  [ -f "$common.measure.o" ] || compile "$target" -O1 "$here/measure_inner_loop.cpp" "$common.measure.o" "${loop_flags[@]}"
  [ -f "$common.start_up.o" ] || compile "$target" -O1 "$here/start_up.cpp" "$common.start_up.o"
  link_image "$target" "$image" "$common.start_up.o" "$common.measure.o" "$object"
  run_image "$target" "$image" "$image.txt"
}

# judge_loop <loop> <optimisation> <image>
judge_loop() {
  judge_symbols "$3"
  at_most "instructions" "$(largest instructions "$3.txt")" "${most_instructions[$1$2]}"
  at_most "stack" "$(largest stack "$3.txt")" "$most_stack"
}

count_of() { awk -v name="$2" '$1 == "instructions" && $2 == name { print $3 }' "$1"; }

for loop in core residual library onboard; do
  loop_flags "$loop"
  host=$work/inner_loop/host.$loop
  "$compiler" -std=c++17 -O1 $fma -DNDEBUG -ffp-contract=off "-I$root/include" -isystem "$eigen" "-I$work" \
    "${loop_flags[@]}" "$here/inner_loop.cpp" "$here/measure_inner_loop.cpp" -o "$host"
  "$host" >"$host.txt"
  grep -q '^status start 0$' "$host.txt" || reject "status" "the host's $loop does not start"
  grep -q '^status bias 0$' "$host.txt" || reject "status" "the host's $loop learns no bias"
  for target in m4f m7_dp; do
    for optimisation in -Os -O2; do
      # the M4F takes as many instructions: once, as firmware is compiled, for the doubles that it has not
      if [ "$target" = m4f ] && [[ "$loop$optimisation" != @(core|onboard)-Os ]]; then continue; fi
      image=$work/inner_loop/$target$optimisation.$loop
      loop_flags "$loop"
      compile "$target" "$optimisation" "$here/inner_loop.cpp" "$image.o" "${loop_flags[@]}"
      link_loop "$target" "$loop" "$image.o" "$image"
      if ! cmp -s <(grep '^status' "$image.txt") <(grep '^status' "$host.txt"); then
        reject "status" "$loop on $target $optimisation says something else than on the host"
      fi
      apart=$(ulps commands "$image.txt" "$host.txt" 0 3)
      at_most "ulps of the $loop's commands" "$apart" 16
      judge_loop "$loop" "$optimisation" "$image"
      echo "$target $optimisation $loop: $(count_of "$image.txt" learning) instructions where the bias learns," \
        "$(count_of "$image.txt" between) between, $(count_of "$image.txt" far) far from the training flights;" \
        "$(largest stack "$image.txt") B stack, commands $apart ulp from the host"
    done
  done
done
if [ "$rejected" -gt 0 ]; then exit 1; fi

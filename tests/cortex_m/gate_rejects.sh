#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# gate_rejects.sh <repository> <working folder> <Eigen>: each limit of the gate refuses what breaks it, by name; the
# honest network passes through the same steps.
set -euo pipefail
root=$1 work=$2 eigen=$3
# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_tools
[ -f "$work/prepared" ] || { echo "SKIPPED: the host's results are not there (cortex_m.prepare)"; exit 77; }

target=m4f failed=no
mkdir -p "$work/planted"
for part in start_up measure_forward; do
  compile "$target" -O1 "$here/$part.cpp" "$work/planted/$part.o"
done

# verdict <name> <object>: what the gate says of it
verdict() {
  local image=$work/planted/$1.elf
  link_image "$target" "$image" "$work/planted/start_up.o" "$work/planted/measure_forward.o" "$2"
  run_image "$target" "$image" "$image.txt"
  rejected=0
  judge_forward "$image" "$image.txt" "$work/host_forward.txt"
}

# expect <offence in planted.cpp> <what the gate calls it>
expect() {
  local object=$work/planted/$1.o said
  compile "$target" -O2 "$here/planted.cpp" "$object" "${model_flags[@]}" "-DPLANTED=$1"
  said=$(verdict "$1" "$object" 2>&1) || { echo "$1: $said"; failed=yes; return; }
  if grep -qE "^rejected: $2" <<<"$said"; then
    echo "$1: $(grep -E "^rejected: $2" <<<"$said" | head -1)"
  else
    echo "FAILED: $1 is planted, and the gate says: ${said:-nothing}"
    failed=yes
  fi
}

compile "$target" -O2 "$here/under_test.cpp" "$work/planted/honest.o" "${model_flags[@]}"
honest=$(verdict honest "$work/planted/honest.o")
if [ -n "$honest" ]; then
  echo "FAILED: nothing is planted, and the gate says: $honest"
  failed=yes
fi
expect HEAP "symbol: _?(malloc|free)"
expect DOUBLE_PRECISION "symbol: __aeabi_(dmul|f2d|d2f)"
expect OPERATOR_NEW "symbol: _Zn[wa]"
expect RUN_TIME_INITIALISED "initialised at run time"
expect STATIC_BUFFER "static RAM: 16"
expect WEIGHTS_IN_RAM "static RAM: 25516"
expect DEEP_STACK "stack: [0-9]+"
expect DATA_DEPENDENT "instructions depend on the data: [0-9]+ to [0-9]+"
expect OTHER_ORDER "bits: "
expect PLAIN_LOOPS "instructions: [0-9]+"
expect CODE_TWICE "code: [0-9]+"
[ "$failed" = no ]

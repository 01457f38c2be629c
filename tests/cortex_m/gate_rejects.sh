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

# expect <offences in planted.cpp, with | between> <what the gate calls each>...
expect() {
  local object=$work/planted/${1//|/_}.o said called offences=$1
  shift
  compile "$target" -O2 "$here/planted.cpp" "$object" "${model_flags[@]}" "-DPLANTED=$offences"
  said=$(verdict "${offences//|/_}" "$object" 2>&1) || { echo "$offences: $said"; failed=yes; return; }
  for called in "$@"; do
    if grep -qE "^rejected: $called" <<<"$said"; then
      echo "$offences: $(grep -E "^rejected: $called" <<<"$said" | head -1)"
    else
      echo "FAILED: $offences is planted, the gate says nothing of '$called': ${said:-nothing}"
      failed=yes
    fi
  done
}

compile "$target" -O2 "$here/under_test.cpp" "$work/planted/honest.o" "${model_flags[@]}"
honest=$(verdict honest "$work/planted/honest.o")
if [ -n "$honest" ]; then
  echo "FAILED: nothing is planted, and the gate says: $honest"
  failed=yes
fi
expect 'HEAP|DOUBLE_PRECISION|OPERATOR_NEW|RUN_TIME_INITIALISED' "symbol: _?(malloc|free)" \
  "symbol: __aeabi_(dmul|f2d|d2f)" "symbol: _Zn[wa]" "initialised at run time"
expect 'STATIC_BUFFER|DEEP_STACK' "static RAM: 16" "stack: [0-9]+"
expect 'WEIGHTS_IN_RAM|CODE_TWICE' "static RAM: 25516" "code: [0-9]+"
expect DATA_DEPENDENT "instructions depend on the data: [0-9]+ to [0-9]+"
expect OTHER_ORDER "bits: "
expect PLAIN_LOOPS "instructions: [0-9]+"
[ "$failed" = no ]

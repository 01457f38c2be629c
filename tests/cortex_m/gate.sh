#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# gate.sh <repository> <working folder> <Eigen> <target>: the paper's network on one processor at -Os and -O2: same
# bits as the host, within its limits of instructions, stack, code and RAM; predict() beside it.
set -euo pipefail
root=$1 work=$2 eigen=$3 target=$4
# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_prepared

for optimisation in -Os -O2; do
  name=$work/$target$optimisation
  build_target "$target" "$optimisation" forward "$name.forward.elf"
  run_image "$target" "$name.forward.elf" "$name.forward.txt"
  judge_forward "$name.forward.elf" "$name.forward.txt" "$work/host_forward.txt"
  echo "$target $optimisation forward: $(largest instructions "$name.forward.txt") instructions," \
    "$(largest stack "$name.forward.txt") B stack, $(code_bytes "$name.forward.elf") B code," \
    "$(weight_bytes "$name.forward.elf") B weights, $(ram_bytes "$name.forward.elf") B RAM"

  build_target "$target" "$optimisation" predict "$name.predict.elf"
  run_image "$target" "$name.predict.elf" "$name.predict.txt"
  judge_symbols "$name.predict.elf"
  if ! cmp -s <(grep '^status' "$name.predict.txt") <(grep '^status' "$work/host_predict.txt"); then
    reject "status" "predict() or the self-test says something else than on the host"
  fi
  if [ "$(grep -c '^status ordinary 0$' "$name.predict.txt")" != 48 ] ||
    ! grep -q '^status self_test 0$' "$name.predict.txt" ||
    grep -q '^status not_finite 0$' "$name.predict.txt"; then
    reject "status" "an ordinary state has no commands, the self-test fails or a bad input is taken"
  fi
  angles=$(ulps features "$name.predict.txt" "$work/host_predict.txt" 12 13)
  others=$(ulps features "$name.predict.txt" "$work/host_predict.txt" 14 15)
  commands=$(ulps commands "$name.predict.txt" "$work/host_predict.txt" 0 3)
  at_most "ulps of roll and pitch" "$angles" 2
  at_most "ulps of sine and cosine of yaw" "$others" 0
  at_most "ulps of the commands" "$commands" 16
  echo "$target $optimisation predict: $(largest instructions "$name.predict.txt") instructions" \
    "($(smallest instructions "$name.predict.txt") for a bad input), $(largest stack "$name.predict.txt") B stack," \
    "$(ram_bytes "$name.predict.elf") B RAM of the C library; roll and pitch $angles ulp," \
    "sine and cosine of yaw $others ulp, commands $commands ulp from the host"

  # monotone by construction, with the residual that the recipe may keep, and as shipped: not more instructions, nor more of
  # the stack, than the paper's network
  for model in structured shipped; do
    flags=${model}_flags[@]
    build_target "$target" "$optimisation" predict "$name.$model.elf" "$model" "${!flags}"
    run_image "$target" "$name.$model.elf" "$name.$model.txt"
    judge_symbols "$name.$model.elf"
    if ! cmp -s <(grep '^status' "$name.$model.txt") <(grep '^status' "$work/host_$model.txt"); then
      reject "status" "predict() of the $model model or its self-test says something else than on the host"
    fi
    if [ "$(grep -c '^status ordinary 0$' "$name.$model.txt")" != 48 ] || ! grep -q '^status self_test 0$' "$name.$model.txt"; then
      reject "status" "an ordinary state has no commands of the $model model, or its self-test fails"
    fi
    commands=$(ulps commands "$name.$model.txt" "$work/host_$model.txt" 0 3)
    at_most "ulps of the $model model's commands" "$commands" 16
    at_most "instructions of the $model model" "$(largest instructions "$name.$model.txt")" \
      "$(largest instructions "$name.predict.txt")"
    at_most "stack of the $model model" "$(largest stack "$name.$model.txt")" "$(largest stack "$name.predict.txt")"
    echo "$target $optimisation predict, $model model: $(largest instructions "$name.$model.txt") instructions," \
      "$(largest stack "$name.$model.txt") B stack, commands $commands ulp from the host"
  done
done
if [ "$rejected" -gt 0 ]; then exit 1; fi

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# prepare.sh <repository> <working folder> <compiler> <Eigen>: writes the model and what the host's portable kernel with
# hardware FMA makes of them.
set -euo pipefail
root=$1 work=$2 compiler=$3 eigen=$4
rm -rf -- "$work"
mkdir -p "$work"

# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_tools

fma=
if [ "$(uname -m)" = x86_64 ]; then
  fma=-mfma
  grep -qw fma /proc/cpuinfo || { echo "SKIPPED: this machine has no fused multiply-add to compare with"; exit 77; }
fi
"$compiler" -std=c++17 -O1 "-I$root/include" -isystem "$eigen" "$here/write_model.cpp" -o "$work/write_model"
"$work/write_model" "$work/paper_model.hpp" "$work/structured_model.hpp" "$work/structured_model.block"
for what in forward predict; do
  "$compiler" -std=c++17 -O2 $fma -DNDEBUG -ffp-contract=off "-I$root/include" -isystem "$eigen" "-I$work" \
    "${model_flags[@]}" "$here/under_test.cpp" "$here/measure_$what.cpp" -o "$work/host_$what"
  "$work/host_$what" >"$work/host_$what.txt"
  echo "host, $what: $(wc -l <"$work/host_$what.txt") lines"
done
for name in structured shipped; do
  flags=${name}_flags[@]
  "$compiler" -std=c++17 -O2 $fma -DNDEBUG -ffp-contract=off "-I$root/include" -isystem "$eigen" "-I$work" \
    "${!flags}" "$here/under_test.cpp" "$here/measure_predict.cpp" -o "$work/host_$name"
  "$work/host_$name" >"$work/host_$name.txt"
done
touch "$work/prepared"

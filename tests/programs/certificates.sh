# SPDX-License-Identifier: MIT
# What certify says of every exported model in the tree: a row each, and no model without one.
source "$(dirname "$0")/common.sh" "$@"

# exit code: 0 proven, 1 refuted, 2 no export of a format that says enough, or of an airframe or features of its own
models=(
  "1 examples/models/crazyflie_2_1.hpp"
  "1 examples/models/demo_quadrotor.hpp"
  "2 examples/models/model.hpp" # the demo's under another name
  "0 examples/models/structured_quadrotor.hpp"
  "2 tests/models/v1/demo_quadrotor.hpp"
  "1 tests/models/v2/crazyflie_tanh.hpp"
  "0 tests/models/v3/near_ground_quadrotor.hpp"
  "2 tests/models/v3/own_racer.hpp"
  "2 tests/models/v4/own_racer.hpp"
  "2 tests/support/small_model.hpp"
)
within_s=1 # of the processor, to refute one
case "$compiler_flags" in *sanitize*) within_s=30 ;; esac
for entry in "${models[@]}"; do
  expected=${entry%% *} model=${entry#* } code=0
  "$pinnquad" certify "$source_dir/$model" --json >stdout.txt 2>stderr.txt || code=$?
  [ "$code" -eq "$expected" ] || fail "$model: exit code $code instead of $expected: $(cat stdout.txt stderr.txt)"
  case $code in
    0) grep -q '"verdict": "proven"' stdout.txt || fail "$model: $(cat stdout.txt)" ;;
    1)
      seconds=$(sed -n 's/^ *"seconds": \([0-9.e-]*\),*$/\1/p' stdout.txt)
      awk -v s="$seconds" -v most="$within_s" 'BEGIN { exit !(s != "" && s < most) }' || fail "$model: refuted after ${seconds:-?} s"
      ;;
    2) [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "$model: not one line: $(cat stderr.txt)" ;;
  esac
  echo "$model: $code${seconds:+, $seconds s}"
  seconds=
done
found=$(cd "$source_dir" && find examples/models tests/models tests/support/small_model.hpp -name '*.hpp' ! -name known_predictions.hpp | sort)
[ "$found" = "$(printf '%s\n' "${models[@]#* }" | sort)" ] || fail "other models are in the tree: $found"

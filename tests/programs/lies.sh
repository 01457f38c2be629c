# SPDX-License-Identifier: MIT
# Headers and blocks that lie: refused by compiler, open(), self test, certify, evaluate and block.
#   lies.sh <arguments of common.sh> <lies_driver>
source "$(dirname "$0")/common.sh" "$@"
driver=$6
command -v python3 >/dev/null || { echo "skipped: no python3 to edit headers"; exit 77; }

"$pinnquad" fly near_ground --seed 3 --samples 300 --out flight.csv >/dev/null 2>&1 ||
  "$pinnquad" fly --seed 3 --samples 300 --out flight.csv >/dev/null
mkdir blocks
hash=$("$driver" blocks) || fail "a lie was believed"
for block in blocks/*.block; do
  expect_line 2 "$block: |shape is unknown" "$pinnquad" certify "$block"
  expect_line 2 "$block: |shape is unknown" "$pinnquad" evaluate "$block" --flight flight.csv
done
[ "$(ls blocks | wc -l)" -ge 20 ] || fail "fewer than 20 blocks lie"

python3 "$source_dir/tests/programs/lies/lies.py" "$source_dir" "$pinnquad" "$hash" flight.csv \
  "$compiler" -std=c++17 "-I$source_dir/include" -isystem "$eigen"

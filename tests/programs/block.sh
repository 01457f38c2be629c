# SPDX-License-Identifier: MIT
# block writes from a header's text what the library writes from its types, byte by byte; evaluate then judges it.
#   block.sh <arguments of common.sh> <block_driver>
source "$(dirname "$0")/common.sh" "$@"
driver=$6

mkdir library text
"$driver" library
headers=("$source_dir/examples/models/demo_quadrotor.hpp" "$source_dir/examples/models/crazyflie_2_1.hpp"
  "$source_dir/tests/models/v2/crazyflie_tanh.hpp" "$source_dir/tests/models/v3/own_racer.hpp")
names=(demo_quadrotor crazyflie_2_1 crazyflie_tanh v3_own_racer)
for i in "${!headers[@]}"; do
  "$pinnquad" block "${headers[i]}" --out "text/${names[i]}.block" >said.txt
  cmp "library/${names[i]}.block" "text/${names[i]}.block" || fail "${names[i]} is another block from its text"
  grep -q "as a block of $(wc -c <"text/${names[i]}.block") bytes" said.txt || fail "said: $(cat said.txt)"
done

# what evaluate says of them, on a flight of the vehicle
"$pinnquad" fly --seed 9 --samples 500 --out flight.csv >/dev/null
"$pinnquad" evaluate text/demo_quadrotor.block --flight flight.csv --json >judged.json
grep -q '"airframe": "paper_quadrotor"' judged.json || fail "said: $(cat judged.json)"
expect_line 2 '17 inputs, 4 outputs and 167 parameters whose shape is unknown' "$pinnquad" evaluate text/crazyflie_tanh.block --flight flight.csv
answer=$(sed -n 's/.*using Network = \(.*\);/\1/p' "${headers[2]}")
"$pinnquad" evaluate text/crazyflie_tanh.block --flight flight.csv --answer "$answer" >tanh.txt 2>&1 || [ $? -eq 1 ] || fail "said: $(cat tanh.txt)"
grep -q 'pinnquad::Tanh' tanh.txt || fail "said: $(cat tanh.txt)"
expect_line 2 'whose shape is unknown here' "$pinnquad" evaluate text/v3_own_racer.block --flight flight.csv

# what is no header, or no longer one, and what open() or the self test would refuse (lies.sh has many); nothing is written
cp "${headers[0]}" model.hpp
refused() { # <pattern> <sed program>: of the header
  sed "$2" model.hpp >changed.hpp
  expect_line 2 "$1" "$pinnquad" block changed.hpp --out changed.block
  [ ! -e changed.block ] || fail "a block was written in spite of $2"
}
expect_line 2 'none.hpp: expected a readable file, found none' "$pinnquad" block none.hpp --out changed.block
expect_line 2 'flight.csv: expected a header that pinnquad train exported' "$pinnquad" block flight.csv --out changed.block
expect_line 2 'same file; it would be overwritten' "$pinnquad" block model.hpp --out ./model.hpp
refused 'changed.hpp:[0-9]+: expected format 2 to 4, found 5' 's/format_version = 4/format_version = 5/'
refused 'changed.hpp:[0-9]+: expected records that are known, found `moon`' 's/"answer", "commands"/"moon", "commands"/'
refused 'changed.hpp:[0-9]+: expected numbers in `command_lower`, found `low`' 's/command_lower = 0.0/command_lower = low/'
refused 'changed.hpp: expected `answer` in an exported header, found none' '/ answer = /d'
refused 'changed.hpp:[0-9]+: expected the frame `body FRD, world NED`, found `body FLU, world ENU`' 's/body FRD, world NED/body FLU, world ENU/'
refused 'changed.hpp:[0-9]+: expected a time of 0 to 4 s, found -3' 's/lag_removed_s = .*;/lag_removed_s = -3.0;/'
refused 'changed.hpp:[0-9]+: expected 16 numbers in `allocation`, found 12' '/7.378601163836665/d'
# a checkout that made the ends of its lines CRLF: the same block
sed 's/$/\r/' model.hpp >changed.hpp
"$pinnquad" block model.hpp --out given.block >/dev/null
"$pinnquad" block changed.hpp --out changed.block >/dev/null
cmp given.block changed.block || fail "a header with CRLF is another block"

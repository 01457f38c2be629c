# SPDX-License-Identifier: MIT
# Bad input: one line that says where and what, exit code 2, nothing written.
source "$(dirname "$0")/common.sh" "$@"

"$pinnquad" fly --seed 1 --samples 2400 --out good.csv >/dev/null
refused() { # <pattern> <file>: train refuses the flight and leaves no trace
  mkdir -p out
  expect_line 2 "$1" "$pinnquad" train --flight "$2" --out out --epochs 1 --seeds 1
  [ -z "$(ls -A out)" ] || fail "something was left in the output folder: $(ls -A out)"
}
edit() { # <awk program>: bad.csv from good.csv
  awk -F, -v OFS=, "$1" good.csv >bad.csv
}

edit 'NR == 1 { $5 = "wrong" } { print }'
refused 'bad\.csv:1: .*wdot_x' bad.csv
edit 'NR == 7 { $3 = "fast" } { print }'
refused 'bad\.csv:7:3: .*fast' bad.csv
edit 'NR == 9 { $4 = "nan" } { print }'
refused 'bad\.csv:9:4: ' bad.csv
edit 'NR == 9 { $4 = "" } { print }'
refused 'bad\.csv:9:4: ' bad.csv
edit 'NR == 11 { NF = NF - 1 } { print }'
refused 'bad\.csv:11' bad.csv
edit 'NR == 12 { $(NF + 1) = "1" } { print }'
refused 'bad\.csv:12' bad.csv
: >bad.csv
refused 'bad\.csv:1' bad.csv
head -n 1 good.csv >bad.csv
refused 'bad\.csv:[0-9]+: .*rows' bad.csv
head -n 500 good.csv >bad.csv
refused 'bad\.csv:[0-9]+: .*rows' bad.csv
refused 'absent\.csv: ' absent.csv

: >a_file
expect_line 2 'a_file/out' "$pinnquad" train --flight good.csv --out a_file/out --epochs 1 --seeds 1
expect_line 2 'a_file/flight\.csv' "$pinnquad" fly --samples 10 --out a_file/flight.csv
expect_line 2 "no airframe named 'zeppelin'; known: " "$pinnquad" train --flight good.csv --airframe zeppelin --out out
expect_line 2 "no airframe named 'zeppelin'; known: " "$pinnquad" fly --airframe zeppelin --out out/f.csv
expect_line 2 "no.toml: expected a readable file, found none" "$pinnquad" fly --airframe no.toml --out out/f.csv
mkdir folder.toml
expect_line 2 "folder.toml: expected a readable file, found a folder" "$pinnquad" fly --airframe folder.toml --out out/f.csv
sed 's/mass_kg = .*/mass_kg = true/' "$source_dir/examples/airframes/racer_5_inch.toml" >heavy.toml
expect_line 2 "heavy.toml:4:11: expected a number, found a truth value" "$pinnquad" fly --airframe heavy.toml --out out/f.csv
expect_line 2 'a_file/model\.block' "$pinnquad" train --flight good.csv --out out --epochs 1 --seeds 1 --block a_file/model.block
expect_line 2 '--epochs' "$pinnquad" train --flight good.csv --epochs 0
expect_line 2 '--name' "$pinnquad" train --flight good.csv --name 3rd
expect_line 2 '--seeds' "$pinnquad" train --flight good.csv --seeds many
"$pinnquad" train --help >help.txt # whole: grep -q closes a pipe at the first match
grep -q -- --epochs help.txt || fail "train --help lists no options"
"$pinnquad" fly --help | grep -q -- --seed || fail "fly --help lists no options"
[ -z "$(ls -A out)" ] || fail "something was left in the output folder: $(ls -A out)"

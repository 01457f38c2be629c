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

tr ',' ';' <good.csv >bad.csv
refused 'bad\.csv:1: expected commas between the cells .*, found semicolons' bad.csv
tr ',' '\t' <good.csv >bad.csv
refused 'bad\.csv:1: expected commas between the cells .*, found tabs' bad.csv
edit 'NR > 1 { $1 *= 1000 } { print }'
refused 'bad\.csv:3:1: expected rows at most 4 s apart in column t, found 50 \(milliseconds\?' bad.csv
# a gyro that stands still, an attitude that turns slowly: no degrees
edit 'NR > 1 { $11 = $12 = $14 = $15 = 0; $13 = 0.5; $16 = $1 * 0.5 / 57.3 } { print }'
refused 'bad\.csv:2:11: expected body rates that change, as the attitude does, in columns w_x, w_y, w_z, found the same in all 2400 rows' bad.csv

# nested deeper than any parser's stack: TOML of every kind, JSON (of a study: programs.report)
deep() { awk -v begin="$1" -v each="$2" -v end="$3" 'BEGIN { printf "%s", begin; for (i = 0; i < 50000; ++i) printf "%s", each; print end }' >deep.toml; }
for text in 'a|.a| = 1' '[a|.a|]' 'a = |[|' 'a = |{a = |' "|['x'.|" 'a = "x" # .\n"b"|."b"| = 1'; do
  IFS='|' read -r begin each end <<<"$text"
  deep "$begin" "$each" "$end"
  for command in "fly --out out/f.csv --airframe deep.toml" "import good.csv --out out/d --mapping deep.toml" "airframe check deep.toml" \
    "fly --out out/f.csv --config deep.toml"; do
    # shellcheck disable=SC2086
    expect_line 2 'deep\.toml:[12]:[0-9]+: expected TOML of at most 64 levels, found one nested deeper' "$pinnquad" $command
  done
done
mkdir nested
awk 'BEGIN { printf "{\"format\": 1, \"x\": "; for (i = 0; i < 100000; ++i) printf "{\"a\": " }' >nested/dataset.json
expect_line 2 'nested/dataset\.json:1:[0-9]+: expected JSON of at most 64 levels' "$pinnquad" train --dataset nested --hold-out x --out out/d
printf '{"format": 1, "sample_period_s": 0.05, "lag_removed_s": 0, "flights": [{"file": "good.csv\\u0000.csv", "name": "", "rows": 1}]}' >nested/dataset.json
expect_line 2 'nested/dataset\.json: expected the name of a file in this folder' "$pinnquad" train --dataset nested --hold-out x --out out/d

# an output that is write-protected stays, though its folder would let it be replaced
for output in out/f.csv out/results.csv out/model.hpp; do
  echo kept >$output && chmod 444 $output
  case $output in
    *f.csv) expect_line 2 "cannot write $output: it is write-protected" "$pinnquad" fly --samples 20 --out $output ;;
    *) expect_line 2 "cannot write $output: it is write-protected" "$pinnquad" train --flight good.csv --out out --epochs 1 --seeds 1 ;;
  esac
  [ "$(cat $output)" = kept ] || fail "$output was replaced"
  rm -f $output
done
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

# SPDX-License-Identifier: MIT
# fly -> train -> judge -> export -> fly the export, small; and the same seed gives the same bits.
source "$(dirname "$0")/common.sh" "$@"

"$pinnquad" fly --seed 3 --samples 3000 --out flight.csv
[ "$(wc -l <flight.csv)" -eq 3001 ] || fail "3000 rows and a header were expected"
mkdir a b c
"$pinnquad" train --flight flight.csv --out a --seeds 2 --epochs 8 --threads 2 --block a/model.block >a.txt
for model in linearized vanilla physics-informed structured; do
  grep -q "^  test flight, .* $model" a.txt || fail "the table names no $model: $(grep 'test flight' a.txt)"
done
awk '/^  test flight, /, /^  least derivative over nominal, yaw/ { if (!width) width = length($0); if (length($0) != width) { print; bad = 1 } ++rows }
  END { exit bad || rows < 40 }' a.txt >crooked.txt || fail "the table's columns do not stand below each other: $(cat crooked.txt)"
grep -q '^  proven: each signed sum' a.txt || fail "does not say what is proven of the export: $(grep -A9 export a.txt)"
"$pinnquad" certify a/model.hpp >/dev/null || fail "what train calls proven certify does not prove"
for file in results.csv report.json model.hpp model.block replay.txt ellipses.svg errors.svg prediction.svg; do
  [ -s "a/$file" ] || fail "$file is missing or empty"
done
[ "$(wc -l <a/results.csv)" -eq 8 ] || fail "results.csv: a header, the linearized model, 4 networks and 2 structured models were expected"

# same seed, same bits, whatever the number of threads
"$pinnquad" fly --seed 3 --samples 3000 --out again.csv >/dev/null
cmp flight.csv again.csv || fail "the same seed flew another flight"
"$pinnquad" fly --seed 4 --samples 3000 --out other.csv >/dev/null
! cmp -s flight.csv other.csv || fail "another seed flew the same flight"
"$pinnquad" train --flight flight.csv --out b --seeds 2 --epochs 8 --threads 1 --block b/model.block >/dev/null
cmp a/model.hpp b/model.hpp || fail "the same seeds trained other weights"
cmp a/model.block b/model.block || fail "the same seeds wrote another block"

# several flights: whole ones train, validate and test; the same in one file of its own is another training
for part in 1 2 3; do
  sed -n "1p;$((part * 1000 - 998)),$((part * 1000 + 1))p" flight.csv >"part_$part.csv"
done
mkdir d
"$pinnquad" train --flight part_1.csv part_2.csv --flight part_3.csv --out d --seeds 1 --epochs 2 --allow-poor >d.txt
grep -q "3000 rows: 1000 train, 1000 validate, 1000 test, in whole flights" d.txt || fail "said: $(cat d.txt)"
grep -q "test: part_3.csv" d.txt || fail "the last flight is not the test: $(cat d.txt)"
grep -q 'training_data = "part_1.csv, part_2.csv, part_3.csv"' d/model.hpp || fail "the header does not name its flights"
[ "$(head -n 1 d/replay.txt)" = "pinnquad-replay 1 1000 24" ] || fail "the replay is not the test flight"
grep -q '"block": "validation"' d/report.json || fail "report.json does not say which flight validates"
expect_line 2 'at least 3 flights' "$pinnquad" train --flight part_1.csv other.csv --out e
expect_line 2 'part_1.csv and part_1.csv hold the same flight' "$pinnquad" train --flight part_1.csv part_1.csv part_2.csv --out e
expect_line 2 'at least 2200 rows in 2 flights, found 2000' "$pinnquad" train --flight part_1.csv part_2.csv --out e

# the exported header in a project of its own, from a folder of any name
odd='a @place@ "of"; its own'
mkdir "$odd"
cp a/model.hpp "$odd"
cmake -S "$source_dir/tools/fly_export" -B fly_export -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$compiler_flags" \
  -DPINNQUAD_MODEL_HEADER="$work/$odd/model.hpp" >configure.txt
cmp a/model.hpp fly_export/include/model.hpp || fail "the configured header is another one"
cmake --build fly_export >build.txt || { cat build.txt; fail "the exported header does not compile"; }
fly_export/fly_export --replay a/replay.txt >flown.txt 2>flown_errors.txt || true # 8 epochs need not fly well
cat flown.txt
grep -q "self test .*: ok" flown.txt || fail "the self test of the export failed"
grep -q ": agrees" flown.txt || fail "the export does not agree with the trainer"
grep -q "weights zeroed" flown.txt || fail "no closed loop was flown"
# what the demo says of such files in the end
out=a
cp flown.txt a
eval "$(sed -n '/^errors() {$/,/^rmse() /p' "$source_dir/scripts/demo")"
[[ $(errors) =~ ^linearized\ [0-9.]+,\ vanilla\ [0-9.]+,\ physics-informed\ [0-9.]+,\ structured\ [0-9.]+$ ]] ||
  fail "the demo reads these errors: $(errors)"
for feed_forward in export 'analytic inverse' 'none \(hover trim\)'; do
  [[ $(rmse "$feed_forward") =~ ^[0-9]+\.[0-9]+$ ]] || fail "the demo reads no RMSE of $feed_forward: $(rmse "$feed_forward")"
done
expect_line 2 "flight.csv:1: expected 'pinnquad-replay 1 <rows> 24'" fly_export/fly_export --replay flight.csv
head -c 5000 a/replay.txt >truncated.txt
expect_line 2 "truncated.txt:[0-9]+:[0-9]+: expected a number" fly_export/fly_export --replay truncated.txt

# weights of a later training, of another flight, as a block, flown by the program that was built for the first
"$pinnquad" train --flight other.csv --out c --seeds 1 --epochs 6 --block c/model.block >/dev/null
! cmp -s a/model.block c/model.block || fail "another flight trained the same weights"
fly_export/fly_export --replay c/replay.txt --block c/model.block >block.txt 2>/dev/null || true
grep -q "block .*c/model.block, .* bytes" block.txt || fail "the block was not read"
grep -q "self test .*: ok" block.txt || fail "the self test of the block failed"
grep -q ": agrees" block.txt || fail "the block does not agree with the trainer"
fly_export/fly_export --replay c/replay.txt >other.txt 2>/dev/null || true
grep -q ": DISAGREES" other.txt || fail "the header's weights agree with another training's"
head -c 1000 c/model.block >cut.block
refused() { expect_line 2 "$2: $1" fly_export/fly_export --replay c/replay.txt --block "$2"; } # <why> <file>
refused block_truncated cut.block
refused block_incompatible flight.csv
refused "no such readable file" none.block

# hostile invocations of that program
bash "$(dirname "$0")/hostile.sh" "$pinnquad" "$source_dir" "$work/hostile" "$compiler" "$compiler_flags" \
  "$work/fly_export/fly_export" "$work/c/replay.txt" "$work/c/model.block"

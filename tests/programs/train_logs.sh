# SPDX-License-Identifier: MIT
# train on a dataset of logged flights, from folder to header: what is held out, refused, written, interrupted and taken up again.
source "$(dirname "$0")/common.sh" "$@"

# Flights of the simulator as a dataset: the truth is known.
dataset() { # <folder> <flight>...
  local folder=$1 list=
  shift
  mkdir -p "$folder"
  for flight in "$@"; do
    [ -e "$folder/$flight.csv" ] || "$pinnquad" fly --seed "${flight#flight}" --samples 500 --out "$folder/$flight.csv" >/dev/null
    list="$list${list:+,}{\"name\": \"$flight\", \"file\": \"$flight.csv\", \"trajectory\": \"\", \"rows\": 500, \"source\": \"simulator\"}"
  done
  printf '{"format": 1, "sample_period_s": 0.05, "lag_removed_s": 0, "absent": [], "flights": [%s], "steps": []}\n' "$list" \
    >"$folder/dataset.json"
}
flights=(flight1 flight2 flight3 flight4 flight5 flight6 flight7)
dataset logs "${flights[@]}"
airframe=(--airframe paper_quadrotor)

# refused in one line, before anything is written
refused() { # <pattern> [option]...
  local pattern=$1
  shift
  expect_line 2 "$pattern" "$pinnquad" train "$@" --out refused
  [ ! -e refused ] || fail "a refused training left $(ls refused)"
}
refused '^train: say what judges: --hold-out NAME.*the flights are flight1, flight2' --dataset logs
refused '^train: --hold-out fligth3: no flight and no trajectory of that name; nearest: flight' --dataset logs --hold-out fligth3
refused '^train: --models rigde: no model of that name; nearest: ridge' --dataset logs --hold-out flight3 --models rigde
refused '^train: --export rigde: no such model is compared; nearest: ridge' --dataset logs --hold-out flight3 --export rigde
refused 'no/dataset.json' --dataset no --hold-out flight3
refused '^train: --flight and --dataset can.t be given together' --dataset logs --flight logs/flight1.csv
refused '^train: --hold-out and --hold-out-each can.t' --dataset logs --hold-out flight1 --hold-out-each flight
refused '^train: --flight, --dataset or --log is required' --hold-out flight1
refused '^train: --recipe goes with --flight, not with --dataset' --dataset logs --hold-out flight1 --recipe best
refused '^train: --hold-out goes with --dataset or --log' --flight logs/flight1.csv --hold-out flight1
refused '^train: --log and --mapping go together' --log logs --hold-out flight1
refused 'hold-out-each' --dataset logs --hold-out-each row
# a lag or a clock that no header can state, a command that stands still: found before the folder and the training
dataset late flight1 flight2 flight3
sed -i 's/"lag_removed_s": 0/"lag_removed_s": -0.02/' late/dataset.json
refused 'late/dataset.json: expected a lag removed of 0 to 4 s, .* found -0.02 s' --dataset late --hold-out flight3
dataset slow flight1 flight2 flight3
awk -F, -v OFS=, 'NR > 1 { $1 *= 1000 } { print }' logs/flight2.csv >slow/flight2.csv
refused 'slow/flight2.csv:3:1: expected rows at most 4 s apart in column t, found 50 .milliseconds' --dataset slow --hold-out flight3
dataset still flight1 flight2 flight3
awk -F, -v OFS=, 'NR > 1 { $19 = 0.5 } { print }' logs/flight2.csv >still/flight2.csv
refused 'still/flight2.csv:2:19: expected commands that change in column u2' --dataset still --hold-out flight3
# the same flight under another name: it would train and judge
dataset leak flight1 flight2 flight3
cp leak/flight1.csv leak/copy.csv
sed -i 's/"flight3", "file": "flight3.csv"/"copy", "file": "copy.csv"/' leak/dataset.json
refused 'held-out flight copy are among those that train' --dataset leak --hold-out copy

# each flight in turn: a table, a report, a header that compiles and agrees, a closed loop
code=0
"$pinnquad" train --dataset logs "${airframe[@]}" --hold-out-each flight --models constant,linear,ridge --seeds 2 --out each \
  --block each/model.block >each.txt 2>stderr.txt || code=$?
cat each.txt stderr.txt
[ "$code" -eq 0 ] || fail "exit code $code"
for file in report.json report.html model.hpp model.block replay.txt; do [ -s "each/$file" ] || fail "$file is missing"; done
[ ! -e each/fits ] || fail "the fits of a whole training were left behind"
for text in '"exported": true' '"exported_model": "ridge"\|"exported_model": "linear"' '"r2_flight_bias_removed"' '"per_seed"' \
  '"by_fold"' '"held_out"' '"standing": "success"' '"closed_loop"'; do
  grep -q "$text" each/report.json || fail "report.json lacks $text"
done
grep -q 'what the others are compared with' each.txt || fail "no verdict on the constant: $(cat each.txt)"
for flight in "${flights[@]}"; do grep -q "$flight" each/report.html || fail "the page does not name $flight"; done
[ "$(sed -n 's/.*"worse_than_mean": *//p' each/report.json | head -n 1)" != true ] || fail "worse than the mean"

cmake -S "$source_dir/tools/fly_export" -B fly_export -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$compiler_flags" \
  -DPINNQUAD_MODEL_HEADER="$work/each/model.hpp" >configure.txt
cmake --build fly_export >build.txt || { cat build.txt; fail "the exported header does not compile"; }
fly_export/fly_export --replay each/replay.txt >flown.txt 2>&1 || true
grep -q "self test .*: ok" flown.txt || fail "the self test of the export failed: $(cat flown.txt)"
grep -q ": agrees" flown.txt || fail "the export does not agree with the trainer: $(cat flown.txt)"

# one flight can't decide, and nothing is called a success
"$pinnquad" train --dataset logs "${airframe[@]}" --hold-out flight2 --models constant,linear --seeds 1 --out one >one.txt 2>stderr.txt
grep -q "1 held-out flight can't tell, 6 or more can" one.txt || fail "said: $(cat one.txt)"
! grep -q '"success": true' one/report.json || fail "a success of one flight"

# Ctrl-C keeps the finished fits, and the same command goes on from there
setsid "$pinnquad" train --dataset logs "${airframe[@]}" --hold-out-each flight --models constant,vanilla --seeds 20 --threads 1 \
  --out cut >stdout.txt 2>stderr.txt &
pid=$!
for ((wait = 0; wait < 4800; ++wait)); do
  if [ "$(find cut/fits -name '*.fit' 2>/dev/null | wc -l)" -ge 8 ]; then break; fi
  sleep 0.05
done
kill -INT "$pid"
code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130: $(cat stderr.txt)"
grep -qE 'interrupted; [1-9][0-9]* of 147 fits are finished and kept in cut/fits' stderr.txt || fail "said: $(cat stderr.txt)"
[ ! -e cut/model.hpp ] || fail "an interrupted training exported"
[ -z "$(find cut -name '*.partial*')" ] || fail "a half-written file was left behind"
"$pinnquad" train --dataset logs "${airframe[@]}" --hold-out-each flight --models constant,vanilla --seeds 1 --epochs 1 --allow-poor \
  --out cut >again.txt 2>stderr.txt
! grep -q 'finished by an earlier run' again.txt || fail "fits of other epochs were taken"

# the table of a real vehicle's flights, where they are
nanobench=$source_dir/../shared/reference/flight_logs/nanobench_subset_50hz.csv
if [ ! -f "$nanobench" ]; then
  echo "SKIPPED: nanobench_subset_50hz.csv is not here; its rotation was not judged"
  exit 0
fi
"$pinnquad" import "$nanobench" --mapping nanobench --out nanobench >/dev/null
"$pinnquad" train --dataset nanobench --airframe crazyflie_2_1 --hold-out-each trajectory \
  --models constant,physics,linear,ridge,ridge_centred --seeds 1 --out nano >nano.txt 2>stderr.txt
cat nano.txt
grep -q 'looking ahead: for planned trajectories only' nano.txt || fail "no centred model was ranked apart: $(cat nano.txt)"

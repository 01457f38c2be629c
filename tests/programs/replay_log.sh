#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# replay: a model over a flight answers as the compiled model does, row by row, and says why not; a flight stack's core over what
# it logged answers as it did, from a CSV, a folder and a ULog file; what was changed is found, the first tick named.
source "$(dirname "$0")/common.sh" "$@"
judge=$6 record=$7
command -v python3 >/dev/null || { echo "skipped: no python3 to read the tables"; exit 77; }
here=$source_dir/tests/programs/replay_log

# ---- flights
"$pinnquad" fly d1 --seed 3 --samples 1200 --out clean.csv >/dev/null
python3 "$here/spoil.py" clean.csv flight.csv
"$judge" flight.csv .
demo=$source_dir/examples/models/demo_quadrotor.hpp
for guard in training flight_stack; do
  "$pinnquad" replay flight.csv --model "$demo" --guard $guard --out demo.csv >demo.txt
  python3 "$here/compare.py" demo.csv demo_$guard.txt 3
  "$pinnquad" replay flight.csv --model speeds.block --guard $guard --out speeds.csv >speeds.txt
  python3 "$here/compare.py" speeds.csv speeds_$guard.txt 3
  # a ridge and a network with a window, as train fits them to logs; the judge's window is a control loop's
  "$pinnquad" replay flight.csv --model physics.block --answer "$(cat physics.answer)" --guard $guard --out physics.csv >physics.txt
  python3 "$here/compare.py" physics.csv physics_$guard.txt 3
done
grep -q 'NaN or infinite: wdot_x' demo.txt || fail "no word of the NaN: $(cat demo.txt)"
grep -qE 'outside_envelope\),"?wdot_y = [-0-9.]+ rad/s\^2 is (above|below) [-0-9.]+, by [0-9.e+]+ half-widths' demo.csv ||
  fail "no word of the feature outside"
grep -q 'the analytic inverse declines too' demo.csv || fail "no word of the analytic inverse"
! grep -q altitude demo.csv || fail "complains of a column that the model does not ask for"
grep -qE '^flight.csv,801,.*warming_up.* from 160 ms before' physics.csv || fail "no word of the window behind a gap"
grep -q 'NaN or infinite: altitude' speeds.csv || fail "no word of the altitude"
"$pinnquad" replay flight.csv --model "$demo" --json >demo.json
python3 - demo.csv demo.json <<'PY'
import csv, json, sys
rows, said = list(csv.DictReader(open(sys.argv[1]))), json.load(open(sys.argv[2]))
count = lambda key, value: sum(row[key] == value for row in rows)
assert said["rows"] == len(rows) == 1200 and said["run_by"] == "flight_stack"
for who, number in said["answered_by"].items():
    assert number == count("answered_by", who), who
for status, number in said["statuses"].items():
    assert number == count("status", status), status
# events and the longest stretch, from the table alone
states = [row["state"] for row in rows]
starts = [i for i in range(len(rows)) if i == 0 or states[i] != states[i - 1]]
assert said["event_count"] == len(starts)
assert [event["row"] for event in said["events"]] == [i + 1 for i in starts[:10]]
assert all(event["reason"] == rows[event["row"] - 1]["reason"] for event in said["events"])
longest, run = 0, 0
for row in rows:
    run = run + 1 if row["answered_by"] != "model" else 0
    longest = max(longest, run)
assert said["longest_without_model"]["rows"] == longest >= 60, said["longest_without_model"]
# the largest difference
difference = lambda row: max([abs(float(row[f"u{i}"]) - float(row[f"logged_u{i}"])) for i in range(1, 5)] if row["u1"] else [0])
worst = max(rows, key=difference)
assert said["largest_difference"]["row"] == int(worst["row"])
assert abs(said["largest_difference"]["difference"] - difference(worst)) < 1e-12
answered = [difference(row) for row in rows if row["u1"]]
assert 0 < len(answered) < len(rows)
assert abs(said["mean_difference"] - sum(answered) / len(answered)) < 1e-12
PY
# a model that answers nothing
awk -F, -v OFS=, 'NR > 1 { $2 = 9000 } { print }' clean.csv >far.csv
code=0
"$pinnquad" replay far.csv --model "$demo" --guard training >far.txt 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code for a model that answers no row"
grep -q 'answers no row of this log' stderr.txt || fail "said: $(cat stderr.txt)"

# ---- cores
for flown in px4:eight px4:random_places crazyflie:random_places; do
  stack=${flown%:*} path=${flown#*:}
  mkdir "$stack-$path"
  "$record" "$stack" "$path" "$stack-$path" >"$stack-$path.txt"
  models=()
  for block in sound other narrow; do models+=(--model "$stack-$path/$block.block"); done
  "$pinnquad" replay "$stack-$path" "${models[@]}" --json --out "$stack-$path.csv" >"$stack-$path.json" ||
    fail "$flown: replay differs: $(tail -3 "$stack-$path.json")"
  python3 - "$stack-$path/flight_pinnquad_record_0.csv" "$stack-$path.csv" "$stack-$path.json" "$stack" <<'PY'
import csv, json, math, sys
logged, replayed = (list(csv.DictReader(open(name))) for name in sys.argv[1:3])
said = json.load(open(sys.argv[3]))
reactions = ["flies", "holds position", "levels", "keeps commands", "gives up"]
worst, asked = 0, 0
assert len(logged) == len(replayed) == said["rows"] == said["compared"] > 15000
for was, now in zip(logged, replayed):
    assert was["tick"] == now["tick"]
    assert reactions[int(was["reaction"])] == now["reaction"], (was, now)
    asked += int(was["asked"])
    for i in range(4):
        command, again = float(was[f"commands[{i}]"]), now[f"u{i + 1}"]
        if math.isnan(command):
            assert again == "", (was, now)
        else:
            worst = max(worst, abs(command - float(again)))
assert worst <= 1e-5, worst
assert said["differing"] == 0 and said["first_difference"] is None
assert sorted(said["reactions"]) == sorted(reactions), said["reactions"]
assert said["statuses"]["fell_back"] > 500 and said["causes"]["outside_envelope"] > 500
by_hand = len(logged) - asked
assert said["answered_by"]["not_asked"] == by_hand and by_hand == (0 if sys.argv[4] == "px4" else 750)
models = {row["state"].split("[")[-1] for row in replayed if "[" in row["state"]}
assert models == {"sound.block]", "other.block]", "narrow.block]"}, models
why = {row["reason"].split(":")[0] for row in replayed if row["reaction"] == "keeps commands"}
assert {"body rates", "attitude"} <= why, why
text = " ".join(row["reason"] for row in replayed)
for words in ("body_rates_rad_s[0] is NaN", "its norm is 1.2", "ms old, limit", "its time stamp is 1000.0 ms ahead"):
    assert words in text, words
print(f"{len(logged)} ticks, commands within {worst:.1e}")
PY
done

# a structured model, other effects in the analytic inverse, limits of trust: to the bit
trust=$source_dir/tests/flight_stacks/structured_trust.hpp
mkdir structured
"$record" structured eight structured >structured.txt
structured=(--model structured/sound.block)
"$pinnquad" replay structured "${structured[@]}" --trust "$trust" --out structured.csv >structured.said ||
  fail "structured: replay differs: $(tail -3 structured.said)"
python3 - structured/flight_pinnquad_record_0.csv structured.csv <<'PY'
import csv, struct, sys
logged, replayed = (list(csv.DictReader(open(name))) for name in sys.argv[1:3])
assert len(logged) == len(replayed) > 15000
bits = lambda number: struct.pack("f", float(number))
for was, now in zip(logged, replayed):
    if was["commands[0]"] != "nan":
        assert all(bits(was[f"commands[{i}]"]) == bits(now[f"u{i + 1}"]) for i in range(4)), (was, now)
assert sum(row["answered_by"] == "model" for row in replayed) > 20000
words = " ".join(row["reason"] for row in replayed)
assert sum(row["cause"] == "distrusted" for row in replayed) > 4000
assert "command residual 0." in words and "limit 0.018" in words, words[:300]
PY
# the analytic inverse with other effects answers otherwise, where it answers; one that is not known is refused
code=0
"$pinnquad" replay structured "${structured[@]}" --trust "$trust" --set effects=1 >differs.txt || code=$?
[ "$code" -eq 1 ] && grep -qE 'first at 1[2-9]\.[0-9]* s .*: u1 ' differs.txt || fail "other effects: $(tail -1 differs.txt)"
expect_line 2 'knew an effect that replay does not \(effects f1\)' "$pinnquad" replay structured "${structured[@]}" \
  --trust "$trust" --set effects=241
# limits that flew are asked for; others, by the names of today, are said to be others, and the answer is another
expect_line 2 '--trust: the core that flew had limits' "$pinnquad" replay structured "${structured[@]}"
sed 's/ distance_limit/ squared_distance_limit/; s/innovation_limit = 0.018/innovation_limit = 0.118/; s/innovation_/command_residual_/' "$trust" >loose.hpp
code=0
"$pinnquad" replay structured "${structured[@]}" --trust loose.hpp >differs.txt || code=$?
[ "$code" -eq 1 ] && grep -q '^note .*other limits than those that flew' differs.txt || fail "other limits: $(tail -1 differs.txt)"
sed 's/distribution_mean = {{/distribution_mean = {{1.0f, /' "$trust" >long.hpp
expect_line 2 'long.hpp:[0-9]*: expected 210 numbers in `whitening`, found 190' "$pinnquad" replay structured "${structured[@]}" --trust long.hpp
# behind gaps what was distrusted still is
python3 "$here/planted.py" structured/flight_pinnquad_record_0.csv planted.csv drop 9000 9100 13000 13003 14000 15000
"$pinnquad" replay planted.csv "${structured[@]}" --trust "$trust" --set effects=18 --set drag_n_s_m=1 --set rate_damping_n_m_s=0.025 \
  --set distance_limit=235.03697 --set innovation_limit=0.01800841 >same.txt || fail "gaps: $(tail -2 same.txt)"

# a model too soft for a payload: the reason of the hand-over in words; behind gaps, and of every third tick, it is the same
mkdir payload thirds
"$record" payload hover payload >payload.txt
soft=(--model payload/sound.block --model payload/soft.block)
"$pinnquad" replay payload "${soft[@]}" --out payload.csv >payload.said || fail "payload: replay differs: $(tail -3 payload.said)"
grep -qE '^because .*distrusted [0-9]{4,}' payload.said || fail "no word of the hand-over: $(cat payload.said)"
grep -qE 'flies, analytic inverse \(distrusted\).*: the bias stood at its bound, 3 m/s\^2: the model does not make' payload.said ||
  fail "no word of the bias: $(cat payload.said)"
cp payload/flight_pinnquad_settings_0.csv thirds/
log=payload/flight_pinnquad_record_0.csv
awk 'NR == 1 || NR % 3 == 0' $log >thirds/flight_pinnquad_record_0.csv
"$pinnquad" replay thirds "${soft[@]}" >same.txt || fail "every third tick: $(tail -2 same.txt)"
python3 "$here/planted.py" $log thirds/flight_pinnquad_record_0.csv drop 6500 6900 7500 7600 14000 15000
"$pinnquad" replay thirds "${soft[@]}" >same.txt || fail "gaps: $(tail -2 same.txt)"

f=px4-eight
models=(--model $f/sound.block --model $f/other.block --model $f/narrow.block)
log=$f/flight_pinnquad_record_0.csv
same() { "$pinnquad" replay "$@" >same.txt || fail "differs: replay $*: $(tail -2 same.txt)"; grep -q '^same ' same.txt || fail "said: $(cat same.txt)"; }
# differs <regular expression of its last line> <arguments>...
differs() {
  local pattern=$1 code=0
  shift
  "$pinnquad" replay "$@" >differs.txt || code=$?
  [ "$code" -eq 1 ] || fail "exit code $code: replay $*"
  tail -1 differs.txt | grep -qE -- "$pattern" || fail "does not match '$pattern': $(tail -1 differs.txt)"
}
same $log "${models[@]}"
python3 "$here/to_ulog.py" $f flight.ulg "$source_dir/examples/px4_module/msg"
same flight.ulg "${models[@]}"

# planted: another model in place of the one that flew, from the first tick on
differs '^DIFFERS .* first at 5.000 s \(tick 2\): u1 ' $log --model $f/other.block
grep -q 'a model of checksum [0-9a-f]* flew from 5.000 s, not the one given' differs.txt || fail "no word of the other model"
# one bit of a weight; where the golden vectors notice, the model is refused
for block in sound other narrow; do cp $f/$block.block $block.block; done
cp $f/bit.block bit.block
differs '^DIFFERS .* first at [0-9.]* s \(tick [0-9]*\): ' $log --model bit.block
python3 - $f/sound.block wrong.block <<'PY'
import struct, sys, zlib
block = bytearray(open(sys.argv[1], "rb").read())
block[-4 - 4 * 100 + 2] ^= 0x40  # high in the mantissa of a weight
block[-4:] = struct.pack("<I", zlib.crc32(block[:-4]))
open(sys.argv[2], "wb").write(block)
PY
expect_line 2 'wrong.block: expected golden commands that its weights give, found others' "$pinnquad" replay $log --model wrong.block
# another gain, limit, age
differs '^DIFFERS .* first at 5.0[0-9]* s \(tick [0-9]*\): .*u[1-4] ' $log "${models[@]}" --set tilt_1_s=9.01
differs '^DIFFERS .* first at 13.*levels' $log "${models[@]}" --set local_us=200000
differs '^DIFFERS .* in 1 of' $log "${models[@]}" --tolerance 1 --set keep_us=39000
mkdir gain
cp $log gain/
sed '2s/,9,3,22,8,/,9,3,22,8.01,/' $f/flight_pinnquad_settings_0.csv >gain/flight_pinnquad_settings_0.csv
differs '^DIFFERS .* first at ' gain "${models[@]}"
# one cell of the log
head -9001 $log >short.csv
plant() { python3 "$here/planted.py" short.csv planted.csv "$@"; }
same short.csv "${models[@]}"
grep -q 'no topic pinnquad_settings' same.txt || fail "no word of the settings: $(cat same.txt)"
plant set 7000 status 11
differs '^DIFFERS .* in 1 of 9000 ticks, first at 11.998 s \(tick 7000\): status ok, logged fell_back$' planted.csv "${models[@]}"
plant set 7001 reaction 2
differs '\(tick 7001\): it flies, logged: levels$' planted.csv "${models[@]}"
plant add 7002 'commands[2]' 2e-5
differs '\(tick 7002\): u3 [0-9.]*, logged [0-9.]*$' planted.csv "${models[@]}"
plant add 7002 'commands[2]' 5e-6
same planted.csv "${models[@]}"
plant set 7003 'commands[1]' nan
differs '\(tick 7003\): u2 [0-9.]*, logged nan$' planted.csv "${models[@]}"
plant set 7004 stale_inputs 4
differs '\(tick 7004\): stale: none, logged: position and velocity$' planted.csv "${models[@]}"
plant set 7005 refused_samples 1
differs '\(tick 7005\): 0 samples refused, logged 1$' planted.csv "${models[@]}"
plant add 7001 'body_rates_rad_s[1]' 0.01 # an input: the answer is another
differs ' in 1 of 9000 ticks, .*\(tick 7001\): u1 ' planted.csv "${models[@]}"

# ticks that were not logged: in flight, while it levels, holds its place, keeps its commands, refuses NaN
head -17001 $log >short.csv
gaps='3 400 7000 7050 8200 8210 11400 11600 11700 11710 15005 15007 15015 15018 16005 16010 16025 16026'
plant drop $gaps
same planted.csv "${models[@]}"
grep -qE '^note +[0-9]+ ticks not compared: behind gaps' same.txt || fail "no word of gaps: $(cat same.txt)"
plant drop 2 7000
same planted.csv "${models[@]}"
# nothing of a log can be compared: a finding, not the same
head -16011 $log | sed -e '2,16006d' >planted.csv
expect_nothing() {
  local code=0
  "$pinnquad" replay planted.csv "${models[@]}" "$@" >nothing.txt 2>stderr.txt || code=$?
  [ "$code" -eq 1 ] || fail "exit code $code where nothing was compared: $(cat nothing.txt)"
  grep -q 'planted.csv: nothing compared' stderr.txt || fail "said: $(cat stderr.txt)"
}
expect_nothing
tail -1 nothing.txt | grep -q '^NOTHING ' || fail "said: $(cat nothing.txt)"
! grep -q '^same' nothing.txt || fail "said: $(cat nothing.txt)"
expect_nothing --json
grep -q '"compared": 0' nothing.txt || fail "said: $(cat nothing.txt)"
head -101 $log >short.csv # progress would be a line of its own

# ---- what is refused
refused() { expect_line 2 "$1" "$pinnquad" replay "${@:2}"; }
refused 'expected a readable' none.csv --model "$demo"
refused 'none.block: expected a readable file' short.csv --model none.block
plant rename came cane
refused 'planted.csv:1: expected a column came of numbers, as a core logs it, found none of that name' planted.csv "${models[@]}"
plant set 50 reaction 2.5
refused 'planted.csv:50: expected a whole number from 0 to 255 in column reaction, found 2.5' planted.csv "${models[@]}"
plant set 50 timestamp nan
refused 'planted.csv:50: expected a whole number .* in column timestamp, found nan' planted.csv "${models[@]}"
plant set 50 'attitude[0]' text
refused 'planted.csv:1: expected a column attitude\[0\] of numbers' planted.csv "${models[@]}"
plant set 50 'attitude[0]' 1e300
refused 'planted.csv:50: expected a 32-bit number' planted.csv "${models[@]}"
plant set 50 model 123
refused 'a model of checksum 0000007b flew from 5.048 s, and none of these is it' planted.csv "${models[@]}"
refused "no setting named 'tilt'; known: body_rates_us, .*tilt_1_s" short.csv "${models[@]}" --set tilt=7
refused 'expected tilt_1_s=NUMBER in 1/s' short.csv "${models[@]}" --set tilt_1_s=x
refused 'expected keep_us=NUMBER, a whole one, in us' short.csv "${models[@]}" --set keep_us=1.5
refused 'a flight stack.s core flies float models' short.csv --model speeds.block
refused 'takes one model' flight.csv --model "$demo" --model speeds.block
refused '--set: these are settings of a flight stack' flight.csv --model "$demo" --set tilt_1_s=7
sed '5s/^[^,]*,/0,/' clean.csv >back.csv
refused 'back.csv:5: expected a time above [0-9.]* in column t, found 0' back.csv --model "$demo"
sed '7s/,[^,]*/,abc/3' clean.csv >text.csv
refused 'text.csv:7: expected a number in column vdot_bz, found "abc"' text.csv --model "$demo"
cut -d, -f1-10 clean.csv >narrow.csv
refused 'narrow.csv:1: expected a column named w_x' narrow.csv --model "$demo"
head -c 3000 flight.ulg >cut.ulg # what is whole of it is run
same cut.ulg "${models[@]}"
grep -qE '^note .*cut.ulg' same.txt || fail "no word of the cut: $(cat same.txt)"
head -c 600 flight.ulg >cut.ulg
refused 'cut.ulg: expected a topic pinnquad_record' cut.ulg "${models[@]}"
mkdir empty
refused 'empty: expected' empty --model "$demo"
refused 'are the same file' flight.csv --model "$demo" --out flight.csv
[ ! -e none ] || fail "wrote something"

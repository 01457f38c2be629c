# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2054,SC2154
# pinnquad-study: killed and resumed, interrupted, sharded and merged, it gives the rows of an undisturbed run, bit for bit; what is
# broken is run again, what is foreign is refused.
source "$(dirname "$0")/common.sh" "$@"

models=(--models 1,7,9,13 --seeds 3)
options=("${models[@]}" --epochs 12 --threads 2)
# long enough to be killed before it is over
long=("${models[@]}" --epochs 80 --threads 2)
trainings=10
# every column but the last, which is a time
figures() { sed 's/,[^,]*$//' "$1/rows.csv"; }
same() { # <folder> <other folder>: the same rows in the same order, the same predictions
  diff <(figures "$1") <(figures "$2") || fail "the rows of $1 and $2 differ"
  diff -r "$1/series" "$2/series" || fail "the predictions of $1 and $2 differ"
}
rows() { if [ -f "$1/rows.csv" ]; then wc -l <"$1/rows.csv"; else echo 0; fi; }
# started <folder>: runs in the background until a training is finished beside model 1; sets pid
started() {
  "$study" paper "${long[@]}" --out "$1" >stdout.txt 2>stderr.txt &
  pid=$!
  for ((wait = 0; wait < 6000; ++wait)); do
    if [ "$(rows "$1")" -ge 3 ] || ! kill -0 "$pid" 2>/dev/null; then return; fi
    sleep 0.02
  done
}

"$study" paper "${options[@]}" --out whole >whole.txt
[ "$(rows whole)" -eq $((trainings + 1)) ] || fail "rows.csv: a header and $trainings rows were expected"
grep -q '^13 *d3/101 ' whole.txt || fail "no line of model 13: $(cat whole.txt)"
head -n 1 whole/rows.csv | grep -q '^model,flight,flight_seed,seed,epochs,weights,mae,.*,validation_mae,training_s$' ||
  fail "columns: $(head -n 1 whole/rows.csv)"
for model in 1 7 9 13; do
  head -n 1 "whole/series/model$model.csv" | grep -q '^time_s,wdot_x,wdot_y,wdot_z,u1,u2,u3,u4,p1,p2,p3,p4$' ||
    fail "series of model $model"
done
# docs/paper.md, deviation 16: 40 % and 80 % of 15,000 rows, 20 % of 5,000
for block in 7:6000 9:12000 13:1000; do
  [ "$(wc -l <"whole/series/model${block%:*}.csv")" -eq $((${block#*:} + 1)) ] || fail "test rows of model $block"
done
for entry in version recipe flights models compiler flags cpu threads wall_s started finished; do
  grep -q "^  \"$entry\": " whole/study.json || fail "study.json has no $entry"
done
"$study" paper "${models[@]}" --epochs 12 --threads 1 --out one_thread >/dev/null
same whole one_thread

# killed, then resumed; the next run finds nothing to do
"$study" paper "${long[@]}" --out long >/dev/null
started killed
kill -KILL "$pid" 2>/dev/null || fail "the study was over before it could be killed: a longer one is needed"
{ wait "$pid" || true; } 2>stderr.txt # where the shell says that it was killed
kept=$(rows killed)
[ "$kept" -le "$trainings" ] || fail "the study was over before it was killed"
"$study" paper "${long[@]}" --out killed >resumed.txt
same long killed
grep -q "$trainings of $trainings trainings are in .*, [1-9][0-9]* of them from before" resumed.txt || fail "said: $(cat resumed.txt)"
[ -z "$(find killed -name '*.partial*')" ] || fail "a half-written file was left behind"
cp -r killed again
: >again/rows.csv.partial-1 # as a killed run leaves it
: >again/series/model7.csv.partial-1
"$study" paper "${long[@]}" --out again >resumed.txt
grep -q ", $trainings of them from before" resumed.txt || fail "said: $(cat resumed.txt)"
[ -z "$(find again -name '*.partial*')" ] || fail "a half-written file was left behind"
cmp killed/rows.csv again/rows.csv || fail "a run with nothing to do changed the rows"

# Ctrl-C: the code of an interrupt, what is finished is kept
started interrupted
kill -TERM "$pid" 2>/dev/null || true
code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130; said: $(cat stderr.txt)"
grep -q "interrupted; [1-9] of $trainings trainings are in interrupted/rows.csv; the same command goes on" stderr.txt ||
  fail "said: $(cat stderr.txt)"
"$study" paper "${long[@]}" --out interrupted >/dev/null
same long interrupted
[ -z "$(find interrupted -name '*.partial*')" ] || fail "a half-written file was left behind"

# shards and merge
for shard in 1 2 3; do "$study" paper "${options[@]}" --shard "$shard/3" --out "part$shard" >/dev/null; done
code=0
"$study" merge part1 part3 --out merged >stdout.txt 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code of a merge without part 2"
grep -q '3 trainings are missing, the first is model 7, flight d1 of seed 101, seed 1' stderr.txt || fail "said: $(cat stderr.txt)"
"$study" merge part1 part2 part3 --out merged >/dev/null
same whole merged
"$study" paper "${options[@]}" --out merged >resumed.txt # a merged folder is a study like any other
grep -q ", $trainings of them from before" resumed.txt || fail "said: $(cat resumed.txt)"

# part by part, and again: what --out holds stays, and no time counts twice; --out may be among the folders
seconds() { sed -n 's/^  "wall_s": \(.*\),$/\1/p' "$@" | awk '{ sum += $1 } END { printf "%.3f\n", sum }'; }
mkdir gathered
for shard in 1 2 3; do cp -r "part$shard" "gathered/$shard"; done
total=$(seconds part?/study.json)
code=0
"$study" merge gathered/1 gathered/3 --out gathered/all >/dev/null 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code of a merge without part 2"
"$study" merge gathered/2 --out gathered/all >stdout.txt 2>stderr.txt || fail "a merge lost the rows of its folder: $(cat stderr.txt)"
grep -q "$trainings of $trainings trainings from 1 folders are in .*, 7 of them from before" stdout.txt || fail "said: $(cat stdout.txt)"
for again in once twice; do
  same whole gathered/all
  [ "$(seconds gathered/all/study.json)" = "$total" ] || fail "$(seconds gathered/all/study.json) s instead of $total s, merged $again"
  grep -q '"parts": 3,' gathered/all/study.json || fail "not of three parts, merged $again"
  "$study" merge gathered/* --out gathered/all >/dev/null || fail "a merge into one of the folders named"
done
cp gathered/all/rows.csv before.csv
awk -F, -v OFS=, 'NR == 2 { $7 = "0.5" } { print }' before.csv >gathered/all/rows.csv
cp gathered/all/rows.csv before.csv
expect_line 2 'gathered/all has other figures than a part before for model' "$study" merge part1 part2 part3 --out gathered/all
cmp before.csv gathered/all/rows.csv || fail "a refused merge changed the rows"
rm gathered/all/study.json
expect_line 2 'gathered/all/study.json: expected the settings of the rows beside it, found none' "$study" merge part1 --out gathered/all
cmp before.csv gathered/all/rows.csv || fail "a refused merge changed the rows"
expect_line 2 'merge: whole is the folder to write; there is nothing to join' "$study" merge whole --out whole

mkdir -p linked/series
ln -s ../part1/rows.csv linked/rows.csv
cp part1/rows.csv before.csv
expect_line 2 'part1/rows.csv and --out linked/rows.csv are the same file' "$study" merge part1 part2 part3 --out linked
cmp before.csv part1/rows.csv || fail "a merge lost the rows of a part"

# rows that are not whole: that training is run again
broken() { # <awk or head command>...: makes rows.csv of the copy
  rm -rf broken
  cp -r whole broken
  "$@" <whole/rows.csv >broken/rows.csv
  "$study" paper "${options[@]}" --out broken >/dev/null 2>stderr.txt
  same whole broken
}
broken head -c -25
grep -q 'broken/rows.csv: 1 row is not whole; run again' stderr.txt || fail "said: $(cat stderr.txt)"
broken awk -F, -v OFS=, 'NR == 5 { NF = NF - 1 } { print }'
broken awk -F, -v OFS=, 'NR == 5 { $9 = "0.9x" } { print }'
broken head -c 20
broken head -n 4
broken true

# rows of other trainings: refused by name, and kept
foreign() { # <pattern> <awk program>: makes rows.csv of the copy
  rm -rf foreign
  cp -r whole foreign
  awk -F, -v OFS=, "$2" whole/rows.csv >foreign/rows.csv
  cp foreign/rows.csv before.csv
  expect_line 2 "foreign/rows.csv.*: .*$1" "$study" paper "${options[@]}" --out foreign
  cmp before.csv foreign/rows.csv || fail "a refused resume changed the rows: $1"
  expect_line 2 "foreign/rows.csv.*: .*$1" "$study" merge foreign --out no
}
foreign 'model 7, flight d1 of seed 101, seed 1: epochs is 300 there and 12 here' '$1 == 7 && $4 == 1 { $5 = 300 } { print }'
foreign 'model 7, flight d1 of seed 101, seed 9: there is no such training here' '$1 == 7 && $4 == 1 { $4 = 9 } { print }'
foreign 'model 9, flight d1 of seed 102, seed 1: there is no such training here' '$1 == 9 { $3 = 102 } { print }'
foreign 'model 4, flight d1 of seed 101, seed 1: there is no such training here' '$1 == 7 { $1 = 4 } { print }'
foreign 'model 13, flight d3 of seed 101, seed 2: weights is best there and final here' '$1 == 13 && $4 == 2 { $6 = "best" } { print }'
foreign 'expected one row of model 7, flight d1 of seed 101, seed 2, found a second one' '{ print } $1 == 7 && $4 == 2 { $7 = "0.5"; print }'

# a full disk (a file that may not grow): what was finished is kept
cp -r whole full
head -n -2 whole/rows.csv >full/rows.csv
size=$(wc -c <full/rows.csv)
limit=$((size / 1024 + 1))
[ "$(wc -c <full/study.json)" -lt $((limit * 1024)) ] || fail "study.json has grown: this check needs more rows"
limited() { (trap '' XFSZ; ulimit -f "$limit"; exec "$study" paper "${options[@]}" --out full); }
expect_line 2 'cannot write full/rows.csv: File too large' limited
diff <(head -n -2 whole/rows.csv | head -c "$size") <(head -c "$size" full/rows.csv) || fail "a full disk lost rows"
[ -z "$(tail -c 1 full/rows.csv)" ] || fail "a full disk left half a row"
"$study" paper "${options[@]}" --out full >/dev/null
same whole full

# foreign folders and bad input
expect_line 2 'whole/study.json: of another study: epochs is 12 there and 13 here' "$study" paper "${models[@]}" --epochs 13 --out whole
expect_line 2 'of another study: models has 4 entries there and 1 here' "$study" paper --models 7 --seeds 3 --epochs 12 --out whole
expect_line 2 'seed' "$study" paper "${options[@]}" --flight-seed 2 --out whole
cp -r part2 other
sed -i 's/"epochs": 12/"epochs": 11/' other/study.json
expect_line 2 'merge: other is of another study than part1: epochs is 12 there and 11 here' "$study" merge part1 other --out no
cp -r part2 other_figures
awk -F, -v OFS=, 'NR == 2 { $7 = "0.5" } { print }' part2/rows.csv >other_figures/rows.csv
expect_line 2 'other_figures has other figures than a part before for model 7' "$study" merge part2 other_figures --out no
expect_line 2 'absent/study.json: expected a readable file' "$study" merge part1 absent --out no
expect_line 2 'no model 15 in Table 2; known: 1-14' "$study" paper --models 2,15 --out no
expect_line 2 'no model 0 in Table 2' "$study" paper --models 0 --out no
expect_line 2 "found 'x'" "$study" paper --models 2,x --out no
expect_line 2 "found '8-5'" "$study" paper --models 8-5 --out no
expect_line 2 'expected i/n' "$study" paper --shard 4/3 --out no
expect_line 2 '--out DIR is needed' "$study" paper --seeds 1
expect_line 2 "no variant .z.; known: vanilla, " "$study" ablation --variants vanilla,z --out no
expect_line 2 '--seeds' "$study" paper --seeds 0 --out no
expect_line 2 'expected a command before --models: paper, ablation, beyond, merge' "$study" --models 2 --seeds 1 --out no
expect_line 2 'not expected: ' "$study" --models 2 ablation --seeds 1 --epochs 1 --out no
expect_line 2 'not expected: ablation' "$study" paper ablation --seeds 1 --epochs 1 --out no
expect_line 2 'not expected: ' "$study" --epochs 3 merge part1 --out no
: >a_file
expect_line 2 'a_file/out' "$study" paper "${options[@]}" --out a_file/out
rm -rf garbage
cp -r whole garbage
echo garbage >garbage/study.json
expect_line 2 'garbage/study.json:1:1: expected JSON' "$study" paper "${options[@]}" --out garbage
echo '{}' >garbage/study.json
expect_line 2 'garbage/study.json: expected the settings of a study' "$study" merge garbage --out no
rm garbage/study.json
expect_line 2 'garbage/study.json: expected the settings of the rows beside it, found none' "$study" paper "${options[@]}" --out garbage
cp whole/study.json garbage
sed -i 1s/mae/mea/ garbage/rows.csv
expect_line 2 'garbage/rows.csv:1: expected the columns' "$study" paper "${options[@]}" --out garbage
rm garbage/rows.csv
mkdir garbage/rows.csv
expect_line 2 'garbage/rows.csv: expected a readable file, found a folder' "$study" paper "${options[@]}" --out garbage
exec 9<whole
flock 9
expect_line 2 'cannot write whole: another program is at work in it' "$study" paper "${options[@]}" --out whole
exec 9<&-

# the ablation runs, the weights of the least validation error are others
"$study" ablation --seeds 1 --epochs 1 --out ablation >ablation.txt
grep -q '^informed_lambda_0.3 ' ablation.txt || fail "said: $(cat ablation.txt)"
"$study" paper --models 13 --seeds 1 --epochs 12 --weights best --patience 3 --out best >/dev/null
grep -q '^13,d3,101,1,12,best,' best/rows.csv || fail "said: $(cat best/rows.csv)"
[ ! -e no ] || fail "a refused command left the folder no"

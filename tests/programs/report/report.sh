# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# The report of a study: planted effects get their verdicts, the page is whole, bad input leaves nothing behind.
#   report.sh <report_driver> <work folder>
driver=$1
check_script=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check.py
source "$(dirname "$0")/../common.sh" "$driver" - "$2" - -

outputs=(report.html report.json table3.csv comparisons.csv claims.csv)
look() { # <folder>: from outside, where Python is
  if command -v python3 >/dev/null; then
    python3 "$check_script" "$1" || fail "the report of $1 is not what its rows say"
  else
    echo "no python3: the page and the p-values were not looked at"
  fi
}
verdict() { # <folder> <claim> <verdict>
  local said
  said=$(sed -n "s/^$2,[0-9]*,\([a-z ]*\),.*/\1/p" "$1/claims.csv")
  [ "$said" = "$3" ] || fail "claim $2 of $1 is '$said', '$3' was planted"
}
verdicts() { cut -d, -f1-3 "$1/claims.csv"; }
edit() { # <awk program>: a study with other rows, in edited/
  rm -rf edited
  cp -r planted edited
  awk -F, -v OFS=, "$1" planted/rows.csv >edited/rows.csv
}

# 1. what was planted is found, with 8 seeds; the smallest p is 2^-7
"$driver" make planted 8
cp -r planted plain
"$driver" report planted
for file in "${outputs[@]}"; do [ -s "planted/$file" ] || fail "$file is missing or empty"; done
look planted
for planted in "1.1 reproduced" "1.2 reproduced" "2.1 reproduced" "2.2 in part" "2.3 reproduced" "3.1 reproduced" "3.2 in part" \
  "3.3 reproduced" "4.1 not reproduced" "4.2 not reproduced" "4.3 reproduced" "4.4 reproduced" "5.1 reproduced" \
  "5.2 not reproduced" "5.3 in part" "5.4 not reproduced"; do
  verdict planted "${planted%% *}" "${planted#* }"
done
grep -q '^2,4,mae,d1,1,8,8,0,0,.*,0\.0078125,1,better,' planted/comparisons.csv || fail "4 against 2: not p = 2^-7, effect size 1"
grep -q '^7,8,mae,d1,1,8,0,0,8,.*,0\.0078125,-1,worse,' planted/comparisons.csv || fail "8 against 7: not p = 2^-7, effect size -1"
grep -q '^2,4,mae,"further flights, means",,3,3,0,0,.*,0\.25,' planted/comparisons.csv || fail "the further flights are not three"
[ "$(grep -c 'further flights' planted/comparisons.csv)" -eq 6 ] || fail "a line other than the flights' means is of further flights"
grep -q '&lt;quadrotor&gt; &amp; Co' planted/report.html || fail "text of study.json is not escaped"
grep -q 'Seeds vary the training, not the data' planted/report.html || fail "the page does not say what seeds vary"
[ -z "$(find . -name '*.partial*')" ] || fail "a half-written file was left behind"
grep -q 'class="box banner".*Smaller than the default study: 8 seeds of 20\.' planted/report.html || fail "no banner of 8 seeds"
columns() { grep -A 2 "id=\"claim-$1\"" planted/report.html | grep -o '<thead>.*</thead>'; }
columns 1.1 | grep -q '>network</th>.*>linearized</th>.*>factor</th><th class="n">paper</th>' || fail "claim 1.1 has not its own columns"
columns 2.1 | grep -q '>baseline</th>.*>candidate</th>.*>change</th>.*>lower in</th>.*>p</th>' || fail "claim 2.1 is not paired"
grep -q '^1\.1,.*: network 4\.[0-9]*e-3, linearized 10[0-9.]*e-3, factor 2[0-9.]* times' planted/claims.csv || fail "claim 1.1 in claims.csv"

# 2. five seeds decide nothing, whichever way they lean; six do. A study of the default size has no banner
"$driver" make five 5
"$driver" report five
[ "$(cut -d, -f3 five/claims.csv | sort -u | tr '\n' ' ')" = "undecided verdict " ] || fail "five seeds decide: $(verdicts five)"
grep -q 'class="badge not"' five/report.html && fail "the page of five seeds has a claim that is not reproduced"
look five
"$driver" make six 6
"$driver" report six
verdict six 2.1 reproduced
verdict six 4.1 "not reproduced"
verdict six 4.2 "not reproduced"
edit 'NR == 1 || $1 == 1 || ($1 != 8 && $4 <= 6) || $4 <= 5 { print }' # model 8 alone has five
"$driver" report edited
verdict edited 2.1 reproduced
verdict edited 4.1 undecided
verdict edited 4.2 undecided
verdict edited 4.4 undecided
verdict edited 5.2 "not reproduced"
"$driver" make twenty 20
"$driver" report twenty
grep -q 'class="box banner"' twenty/report.html && fail "a banner on a study of the default size"
edit '$5 == 300 { $5 = 12 } { print }'
sed -i 's/"epochs": 300/"epochs": 12/' edited/study.json
"$driver" report edited
grep -q 'Smaller than the default study: 12 epochs of 300, 8 seeds of 20\.' edited/report.html || fail "no banner of 12 epochs"

# 3. the suspect entries decide nothing: whatever models 3 and 10 have in pitch
pitch=$(head -n 1 planted/rows.csv | tr ',' '\n' | grep -n '^angle_difference_deg_pitch$' | cut -d: -f1)
for factor in 0.001 4; do
  edit "NR > 1 && (\$1 == 3 || \$1 == 10) { \$$pitch *= $factor } { print }"
  "$driver" report edited
  [ "$(verdicts edited)" = "$(verdicts planted)" ] || fail "a suspect entry decides a claim"
done

# 4. an effect the other way round is found too
edit 'NR > 1 && ($1 == 2 || $1 == 4) { $1 = 6 - $1 } { print }'
"$driver" report edited
verdict edited 2.1 "not reproduced"
verdict edited 2.2 "not reproduced"
verdict edited 2.3 "not reproduced"
look edited

# 5. incomplete studies are reported as far as they go
edit '$1 != 14 && !($1 == 6 && $4 == 3) { print }'
"$driver" report edited
verdict edited 5.2 "not judged"
verdict edited 5.4 "not judged"
verdict edited 5.1 reproduced
grep -q 'model 14: no rows' edited/report.html || fail "the page does not name the missing model"
grep -q 'model 6: 7 of 8 seeds, without seed 3' edited/report.html || fail "the page does not name the missing seed"
look edited
edit 'NR == 1 || ($1 == 4 && $3 == 1 && $4 == 2) { print }'
rm -r edited/series
"$driver" report edited
verdict edited 2.1 "not judged"
grep -q 'no series/model2.csv' edited/report.html || fail "the page does not say which figures are left out"
look edited
grep -q 'hold what they show: .*Fig. 5, Fig. 6' edited/report.html || fail "the page does not say that Figs. 5 and 6 are left out"
edit '{ print }' # pictures of flights, as fly --pictures leaves them
mkdir -p edited/flights/d2 edited/flights/d3
for picture in d2/ground_effect d3/wind; do echo "<svg>$picture</svg>" >"edited/flights/$picture.svg"; done
"$driver" report edited
grep -q "base64,$(base64 -w 0 edited/flights/d2/ground_effect.svg)\"" edited/report.html || fail "Fig. 5 is not in the page"
grep -q "base64,$(base64 -w 0 edited/flights/d3/wind.svg)\"" edited/report.html || fail "Fig. 6 is not in the page"
look edited
edit '{ print }'
tail -n 1 planted/rows.csv | cut -c1-40 | tr -d '\n' >>edited/rows.csv # a run that was killed while it wrote
"$driver" report edited
grep -q 'cut off: left out' edited/report.html || fail "the page does not tell of the row that is cut off"
column() { head -n 1 planted/rows.csv | tr ',' '\n' | grep -n "^$1$" | cut -d: -f1; }
edit '$1 == 4 && $3 == 1 && $4 == 5 { for (i = 7; i <= 21; ++i) $i = "nan" } { print }' # a training that diverged
"$driver" report edited
grep -q 'model 4: 1 trainings without a finite error' edited/report.html || fail "the page does not tell of the training that diverged"
look edited
edit '{ print } NR > 1 && ($1 == 2 || $1 == 4) { $6 = "best"; print }'
"$driver" report edited
grep -q 'best-validation weights' edited/report.html || fail "the other weights are not compared"
look edited
echo '{}' >edited/study.json # nothing but the rows
"$driver" report edited
look edited

# 6. bad input: one line, exit code 2, and what was there stays
refused() { # <pattern>: edited/ is refused
  cp planted/report.html edited/
  expect_line 2 "$1" "$driver" report edited
  cmp -s planted/report.html edited/report.html || fail "a refused study lost its report: $1"
  for file in report.json table3.csv comparisons.csv claims.csv; do rm -f "edited/$file"; done
  [ -z "$(find edited -name '*.partial*')" ] || fail "a half-written file was left behind: $1"
}
edit 'NR == 1 { $7 = "wrong" } { print }' && refused 'rows\.csv:1: expected a column named mae'
edit 'NR == 7 { $9 = "fast" } { print }' && refused 'rows\.csv:7:9: expected a number in column r2, found "fast"'
edit 'NR == 7 { $9 = "" } { print }' && refused 'rows\.csv:7:9: .*an empty cell'
edit 'NR == 8 { $1 = 15 } { print }' && refused 'rows\.csv:8:1: expected a model of Table 2.*"15"'
edit 'NR == 8 { $6 = "mean" } { print }' && refused 'rows\.csv:8:6: expected final or best'
edit 'NR == 8 { $4 = "-1" } { print }' && refused 'rows\.csv:8:4: expected a seed'
edit 'NR == 8 { $5 = 999 } { print }' && refused 'rows\.csv:8:5: expected the epochs of study\.json, 300, in column epochs, found "999"'
edit 'NR == 8 { $3 = 99 } { print }' && refused 'rows\.csv:8:3: expected the seed of a flight d1 of study\.json in column flight_seed, found "99"'
edit 'NR == 8 { $2 = "d9" } { print }' && refused 'rows\.csv:8:3: expected the seed of a flight d9 of study\.json'
edit 'NR == 8 { $7 = -5 } { print }' && refused 'rows\.csv:8:7: expected an error of 0 or more in column mae, found "-5"'
edit 'NR == 8 { $7 = "nan" } { print }' && refused 'rows\.csv:8:7: expected a finite error beside a finite rmse in column mae, found "nan"'
edit 'NR == 8 { $11 = "inf" } { print }' && refused 'rows\.csv:8:11: expected a finite error beside a finite mae_u1 in column rmse_u1, found "inf"'
edit 'NR == 8 { $9 = 1.01 } { print }' && refused 'rows\.csv:8:9: expected at most 1 in column r2, found "1\.01"'
edit "NR == 8 { \$$(column sign_violation_share_yaw) = 1.5 } { print }" && refused 'expected a share from 0 to 1 in column sign_violation_share_yaw'
edit "NR == 8 { \$$(column angle_difference_deg_roll) = 200 } { print }" && refused 'expected degrees from 0 to 180 in column angle_difference_deg_roll'
edit "NR == 8 { \$$(column training_s) = -1 } { print }" && refused 'expected 0 seconds or more in column training_s'
edit '{ print }' && sed -i 's/"seeds"/"models": [2, 4], "seeds"/' edited/study.json && refused 'rows\.csv:10:1: expected a model of study\.json in column model, found "3"'
edit '{ print }' && awk 'BEGIN { for (i = 0; i < 100000; ++i) s = s "["; print "{\"x\": " s }' >edited/study.json &&
  refused 'study\.json:1:70: expected JSON of at most 64 levels, found one nested deeper'
edit '{ print }' && echo '{"x": 1e400}' >edited/study.json && refused 'study\.json: expected JSON of numbers that a double holds'
edit 'NR == 9 { NF = NF - 1 } { print }' && refused 'rows\.csv:9:[0-9]+: expected [0-9]+ fields'
edit '{ print } NR == 9 { print }' && refused 'rows\.csv:10: expected one row per training.*line 9'
edit 'NR == 1 { print }' && refused 'rows\.csv:1: expected at least one finished training'
edit '{ print }' && rm edited/rows.csv && refused 'rows\.csv: expected a readable file'
edit '{ print }' && : >edited/rows.csv && refused 'rows\.csv:1: .*an empty file'
edit '{ print }' && rm edited/study.json && refused 'study\.json: expected a readable file'
edit '{ print }' && printf '{\n "a": 1,\n oops\n}\n' >edited/study.json && refused 'study\.json:3:2: expected JSON'
edit '{ print }' && echo '{"kind": "ablation"}' >edited/study.json && refused 'study\.json: expected a study of Table 2'
edit '{ print }' && sed -i '5s/^[^,]*/soon/' edited/series/model4.csv && refused 'model4\.csv:5:1: .*time_s, found "soon"'
expect_line 2 'absent/study\.json: expected a readable file' "$driver" report absent
edit '{ print }' # Ctrl-C before the work is done
echo before >edited/report.html
expect_line 130 '^report: interrupted; nothing was written$' "$driver" interrupt edited
[ "$(cat edited/report.html)" = before ] || fail "an interrupted report was written"
[ -z "$(find edited -name '*.partial*')" ] || fail "a half-written file was left behind"
mkdir plain/claims.csv # the last of the five can't be written: none is
expect_line 2 'cannot write plain/claims\.csv: it is a folder' "$driver" report plain
[ ! -e plain/report.html ] || fail "some of the files were written, others not"
[ -z "$(find plain -name '*.partial*')" ] || fail "a half-written file was left behind"
# a disk that is full for one of the five
one_full() { # in a name space of its own: small/ is a disk of two pages
  mount -t tmpfs -o size=8k tmpfs small && head -c 4096 /dev/zero >small/filled && : >small/claims.csv
  head -c 4096 /dev/zero >small/filled_too 2>/dev/null
  exec "$driver" report plain
}
export -f one_full
export driver
rm -rf plain/claims.csv
mkdir small
ln -s ../small/claims.csv plain/claims.csv
if unshare -rm mount -t tmpfs tmpfs small 2>/dev/null; then
  expect_line 2 'cannot write plain/claims\.csv: No space left on device' unshare -rm bash -c one_full
  [ ! -e plain/report.html ] || fail "some of the files were written, others not"
  [ -z "$(find plain -name '*.partial*')" ] || fail "a half-written file was left behind"
else
  echo "SKIPPED: a full disk: no name space to mount one in"
fi
echo "report: all checks passed"

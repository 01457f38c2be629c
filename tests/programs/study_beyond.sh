# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2154
# pinnquad study beyond: a small run end to end, gone on with after rows were lost, refused where it asks for what there is not.
source "$(dirname "$0")/common.sh" "$@"

options=(--conditions d3_5,d1_speed --models ridge,structured --seeds 2 --flights 1 --epochs 3 --threads 2)
figures() { sed 's/,[^,]*$//' "$1/rows.csv"; }

"$pinnquad" study beyond "${options[@]}" --out whole >whole.txt
# two conditions: the paper's network and the structured model by two seeds, the ridge once
[ "$(wc -l <whole/rows.csv)" -eq 11 ] || fail "rows.csv: a header and 10 rows were expected"
grep -q '^structured,d1_speed,101,2,3,' whole/rows.csv || fail "no row of the structured model: $(cat whole/rows.csv)"
for file in beyond.html beyond.json study.json; do [ -s "whole/$file" ] || fail "no $file"; done
grep -q '"ratio":' whole/beyond.json || fail "no ratio in beyond.json"

cp -r whole again
head -n 5 whole/rows.csv >again/rows.csv
"$pinnquad" study beyond "${options[@]}" --out again >again.txt
grep -q '^10 of 10 trainings are in again/rows.csv, 4 of them from before' again.txt || fail "said: $(cat again.txt)"
diff <(figures whole) <(figures again) || fail "gone on with, the rows are others"

expect_line 2 "no condition 'd9'; known: d1, " "$pinnquad" study beyond --conditions d9 --out no
expect_line 2 "no model 'x'; known: formula, " "$pinnquad" study beyond --models x --out no
expect_line 2 '--out DIR is needed' "$pinnquad" study beyond --seeds 1
[ ! -e no ] || fail "a refused command left the folder no"

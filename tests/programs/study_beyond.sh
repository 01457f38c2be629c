# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2154
# pinnquad-study beyond: a small run end to end, gone on with after rows were lost, refused where it asks for what there is not.
source "$(dirname "$0")/common.sh" "$@"

options=(--conditions d1,d3_5,d1_speed,d1_told_heavy --models none,inverse,structured --seeds 2 --flights 1 --epochs 3 --threads 2)
figures() { sed 's/,[^,]*$//' "$1/rows.csv"; }
# figure FOLDER MODEL CONDITION SEED COLUMN
figure() {
  awk -F, -v model="$2" -v condition="$3" -v seed="$4" -v column="$5" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == column) at = i }
    $1 == model && $2 == condition && $4 == seed { print $at }' "$1/rows.csv"
}
holds() { awk "BEGIN { exit !($1) }" || fail "$1 does not hold: $2"; }

"$study" beyond "${options[@]}" --out whole >whole.txt
# four conditions: the paper's network and the structured model by two seeds, the formulas once
[ "$(wc -l <whole/rows.csv)" -eq 25 ] || fail "rows.csv: a header and 24 rows were expected"
grep -q '^structured,d1_speed,101,2,3,' whole/rows.csv || fail "no row of the structured model: $(cat whole/rows.csv)"
for file in beyond.html beyond.json study.json; do [ -s "whole/$file" ] || fail "no $file"; done
grep -q '"ratio":' whole/beyond.json || fail "no ratio in beyond.json"

# in the loop: the formula told the truth and the structured model fly, the latter as the former; no feed-forward does not, nor
# does the formula told wrong, which the structured model does not mind
loop() { figure whole "$1" "$2" "$3" eight_rmse_m; }
holds "$(loop none d1 0) > 0.1" "the hover's commands"
holds "$(loop inverse d1 0) < 0.01" "the formula"
holds "$(loop structured d1 1) < 1.2 * $(loop inverse d1 0)" "the structured model"
holds "$(loop inverse d1_told_heavy 0) > 0.05" "the formula told wrong"
holds "$(loop structured d1_told_heavy 1) < 1.2 * $(loop inverse d1 0)" "the structured model told wrong"
holds "$(figure whole structured d1 1 eight_declined_share) == 0 && $(figure whole paper d1 1 proven) == 0" "declined, proven"
holds "$(figure whole structured d1 1 proven) == 1 && $(figure whole structured d1 1 wrong_derivative_share_roll) == 0" "proven"

# judged is what train exports: the same error on the same rows
"$pinnquad" fly d1 --seed 101 --out d1.csv >/dev/null
"$pinnquad" train --flight d1.csv --recipe structured --loss vanilla --epochs 3 --seeds 1 --out trained >/dev/null 2>stderr.txt || fail "$(cat stderr.txt)"
trained=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "mae") at = i } $1 == "structured" && $2 == 1 { print $at }' trained/results.csv)
holds "($trained - $(figure whole structured d1 1 mean_absolute_error))^2 < 1e-18" "the error of train and that of the study"

cp -r whole again
head -n 5 whole/rows.csv >again/rows.csv
"$study" beyond "${options[@]}" --out again >again.txt
grep -q '^24 of 24 trainings are in again/rows.csv, 4 of them from before' again.txt || fail "said: $(cat again.txt)"
diff <(figures whole) <(figures again) || fail "gone on with, the rows are others"

expect_line 2 "no condition 'd9'; known: d1, " "$study" beyond --conditions d9 --out no
expect_line 2 "no model 'x'; known: none, " "$study" beyond --models x --out no
expect_line 2 '--out DIR is needed' "$study" beyond --seeds 1
[ ! -e no ] || fail "a refused command left the folder no"

# SPDX-License-Identifier: MIT
# evaluate judges a block or a header as the training judged the network that it was written from, and refuses what is neither.
source "$(dirname "$0")/common.sh" "$@"
command -v python3 >/dev/null || { echo "skipped: no python3 to read the reports"; exit 77; }

"$pinnquad" fly --seed 3 --samples 3000 --out flight.csv >/dev/null
mkdir a
"$pinnquad" train --flight flight.csv --recipe paper --out a --seeds 2 --epochs 8 --block a/model.block --allow-poor >/dev/null 2>a.txt
code=0
"$pinnquad" evaluate a/model.block --flight flight.csv --rows test --json >judged.json || code=$?
python3 - a/report.json judged.json "$code" <<'EOF'
import json, sys
report, judged = (json.load(open(name)) for name in sys.argv[1:3])
verdict = report["verdict"]
row = next(r for r in report["results"] if r["model"] == verdict["model"] and r["seed"] == verdict["seed"])
differ = [name for name, value in judged["figures"].items() if value != row[name]]
assert not differ, f"evaluate and train judge otherwise: {differ}"
assert judged["mean_absolute_error"] == row["mae"] and judged["rmse"] == row["rmse"] and judged["r2"] == row["r2"]
for axis in "roll", "pitch", "yaw":
    assert judged["pair_violations"][axis] == row[f"sign_violation_share_{axis}"], axis
    assert judged["slope_error"][axis] == row[f"slope_error_{axis}"], axis
assert judged["rows"] == 600 and judged["airframe"] == "paper_quadrotor", judged
assert judged["golden_difference"] == 0, judged["golden_difference"]
assert int(sys.argv[3]) == (1 if verdict["worse_than_mean"] else 0), sys.argv[3]

# the report for scripts: its names, each figure over the seeds, and that of the exported network as evaluate has it
axes = ["pitch", "roll", "yaw"]
plain = ["mean_absolute_error", "rmse", "r2"]
by_axis = ["wrong_derivative_share", "least_derivative_over_nominal", "pair_violations", "pair_violations_flown",
           "large_step_violations", "large_step_violations_flown", "slope_error"]
assert sorted(report["models"]) == ["linearized", "physics_informed", "vanilla"], list(report["models"])
exported = [r["seed"] for r in report["results"] if r["model"] == verdict["model"]].index(verdict["seed"])
for model, seeds in {"linearized": 1, "vanilla": 2, "physics_informed": 2}.items():
    figures = report["models"][model]
    assert sorted(figures) == sorted(plain + by_axis), list(figures)
    of_all = [(name, figures[name], judged[name]) for name in plain]
    for name in by_axis:
        assert sorted(figures[name]) == axes, name
        of_all += [(name, figures[name][axis], judged[name][axis]) for axis in axes]
    for name, figure, of_one in of_all:
        assert sorted(figure) == ["deviation", "mean", "per_seed"], figure
        each = figure["per_seed"]
        assert len(each) == seeds and abs(figure["mean"] - sum(each) / seeds) <= 1e-12, (model, name, figure)
        if seeds == 1:
            assert figure["deviation"] is None, figure
        else:
            assert abs(figure["deviation"] - abs(each[0] - each[1]) / 2**0.5) <= 1e-12, figure
        if model == "physics_informed":
            assert abs(each[exported] - of_one) <= 1e-6, (name, each, of_one)
for axis in axes:
    assert report["models"]["linearized"]["wrong_derivative_share"][axis]["mean"] == 0, axis
    assert report["models"]["linearized"]["large_step_violations"][axis]["mean"] == 0, axis
    assert 0.98 < report["models"]["linearized"]["least_derivative_over_nominal"][axis]["mean"] < 1.02, axis
assert report["exported"] is True and report["header"] == "a/model.hpp" and report["block"] == "a/model.block"
assert report["not_exported_because"] is None
EOF
# of the header the same, but for what it is called
"$pinnquad" evaluate a/model.hpp --flight flight.csv --rows test --json >header.json || [ $? -eq "$code" ] || fail "another exit code for a header"
diff <(grep -v '"model": ' judged.json) <(grep -v '"model": ' header.json) || fail "a header is judged otherwise than its block"
# what was printed as a warning stands in the report
sed -n 's/^train: warning: //p' a.txt >warnings.txt
python3 - a/report.json warnings.txt <<'EOF'
import json, sys
warnings = json.load(open(sys.argv[1]))["warnings"]
printed = open(sys.argv[2]).read().splitlines()
assert warnings == printed, (warnings, printed)
EOF

# derivatives by another program: a header's numbers, features and network written down anew, differences in double
python3 "$source_dir/tests/programs/judgement/wrong_derivatives.py" a/model.hpp flight.csv judged.json ||
  fail "the share of wrong derivatives is another one by finite differences"
"$pinnquad" evaluate a/model.block --flight flight.csv --rows test >table.txt || [ $? -eq "$code" ] || fail "another exit code without --json"
grep -q 'Dense<25>' table.txt || fail "does not name the network: $(cat table.txt)"

# an airframe of its own: found by its file alone
sed 's/^name = .*/name = "mine"/; s/^mass_kg = .*/mass_kg = 1.31/' "$source_dir/examples/airframes/paper_quadrotor.toml" >mine.toml
mkdir b
"$pinnquad" train --flight flight.csv --recipe paper --airframe mine.toml --out b --seeds 1 --epochs 2 --block b/model.block --allow-poor >/dev/null 2>&1
expect_line 2 'b/model.block: a network of 16 inputs, 4 outputs and 6379 parameters whose shape is unknown' \
  "$pinnquad" evaluate b/model.block --flight flight.csv
"$pinnquad" evaluate b/model.block --flight flight.csv --airframe mine.toml >mine.txt || [ $? -eq 1 ]
"$pinnquad" evaluate b/model.hpp --flight flight.csv >own.txt || [ $? -eq 1 ]
sed 1d mine.txt | diff - <(sed 1d own.txt) || fail "the header brings its airframe with it: another judgement"
grep -q 'for mine' mine.txt || fail "said: $(cat mine.txt)"
expect_line 2 'a/model.block: a model for the airframe paper_quadrotor, not for --airframe mine.toml' \
  "$pinnquad" evaluate a/model.block --flight flight.csv --airframe mine.toml
answer=$(sed -n 's/.*answer = "\(.*\)";/\1/p' a/model.hpp)
"$pinnquad" evaluate a/model.block --flight flight.csv --answer "$answer" >answer.txt || [ $? -eq 1 ]
expect_line 2 'whose shape is unknown' "$pinnquad" evaluate a/model.block --flight flight.csv --answer "${answer/Relu/Tanh}"

# commands that no model predicts: exit code 1
awk -F, -v OFS=, 'NR > 1 { for (i = 18; i <= 21; i++) $i = 0.5 + 0.4 * sin(NR * i) } { print }' flight.csv >noise.csv
code=0
"$pinnquad" evaluate a/model.block --flight noise.csv >/dev/null 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code for a model worse than the mean"
grep -q '^evaluate: a/model.block: worse than the mean of the commands' stderr.txt || fail "said: $(cat stderr.txt)"

# what is no block, or no longer one
refused() { expect_line 2 "$1" "$pinnquad" evaluate "$2" --flight flight.csv; }
refused 'none.block: expected a readable file, found none' none.block
refused 'flight.csv: expected a model block, as pinnquad train --block writes it, found something else' flight.csv
cp flight.csv flight.hpp
refused 'flight.hpp: expected a header that pinnquad train exported, found something else' flight.hpp
head -c 20000 a/model.block >cut.block
refused 'cut.block: expected a model block of [0-9]* bytes, found 20000' cut.block
head -c 30 a/model.block >short.block
refused 'short.block: expected a model block' short.block
for offset in 9 16 30 60 2000 20000; do
  cp a/model.block changed.block
  printf '\377' | dd of=changed.block bs=1 seek="$offset" conv=notrunc status=none
  refused 'changed.block: expected ' changed.block
done
expect_line 2 'none.csv: expected a readable file' "$pinnquad" evaluate a/model.block --flight none.csv

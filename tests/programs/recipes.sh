# SPDX-License-Identifier: MIT
# Recipes and losses by name: what is trained is what the report says, and what it was trained with is exported and judged.
source "$(dirname "$0")/common.sh" "$@"
command -v python3 >/dev/null || { echo "skipped: no python3 to read the reports"; exit 77; }

"$pinnquad" fly --seed 3 --samples 2500 --out flight.csv >/dev/null
train() {
  local flight=flight.csv
  if [ "$1" = --flight ]; then flight=$2 && shift 2; fi
  "$pinnquad" train --flight "$flight" --seeds 1 --epochs 3 --threads 1 --allow-poor "$@" >said.txt 2>stderr.txt
}
train --out default
train --out structured --recipe structured
train --out paper --recipe paper --loss physics_informed --loss vanilla
train --out best --recipe best
train --out small --recipe small --loss pearson,constant_weight --block small/model.block
figures() { sed 's/,[^,]*$//' "$1/results.csv"; } # the last column is a time
diff <(figures default) <(figures structured) || fail "the default is not the recipe structured"
cmp default/model.hpp structured/model.hpp || fail "the default exports another model than the recipe structured"
diff <(figures default | grep -v '^structured,') <(figures paper) || fail "the paper's networks are others beside a structured model"
! diff -q <(figures paper) <(figures best) >/dev/null || fail "the recipes paper and best train alike"
train --out in_order --recipe paper --loss vanilla,physics_informed
cmp in_order/model.hpp paper/model.hpp || fail "the order in which losses are named changes the export"

# the default's signs are proven, whatever it was trained for; one loss that is asked for changes nothing of that model
"$pinnquad" certify default/model.hpp >certificate.txt || fail "certify does not prove the default model: $(cat certificate.txt)"
grep -q '^proven ' certificate.txt || fail "said: $(cat certificate.txt)"
train --out one --loss vanilla
cmp one/model.hpp default/model.hpp || fail "the structured model is another one beside one loss"
cut -d, -f1 one/results.csv | uniq | diff - <(printf '%s\n' model linearized vanilla structured) || fail "trained: $(cut -d, -f1 one/results.csv)"

# the altitude: not shown far from the ground, shown where the commands depend on it, or as asked; pinned slopes: the airframe's
awk -F, -v OFS=, 'NR > 1 { for (u = 18; u <= 21; u++) $u = 0.2 + 0.6 * $u + 0.004 * ($17 - 20) } { print }' flight.csv >near.csv
train --flight near.csv --out near --loss vanilla --block near/model.block
grep -q '^      the structured model is shown the altitude: error on the validation rows with it [0-9.]*e-3, without [0-9.]*e-3$' said.txt || fail "said: $(cat said.txt)"
grep -q 'pinnquad::InverseFeaturesWithAltitude;' near/model.hpp || fail "the model is not shown the altitude"
for model in near/model.hpp near/model.block; do
  "$pinnquad" certify "$model" >/dev/null || fail "certify does not prove $model"
done
"$pinnquad" evaluate near/model.hpp --flight near.csv --rows test --json >near.json || fail "evaluate does not judge a model with the altitude"
[ "$(head -n 1 near/replay.txt)" = "pinnquad-replay 1 500 25" ] || fail "the replay: $(head -n 1 near/replay.txt)"
"$compiler" -std=c++17 -fsyntax-only -Wall -Wextra -Werror -I near -I "$source_dir/include" -I "$source_dir/tools" -isystem "$eigen" \
  "$source_dir/tools/fly_export/fly_export.cpp" || fail "fly_export does not compile with a model that is shown the altitude"
train --flight near.csv --out near_no --loss vanilla --altitude no
grep -q 'pinnquad::InverseFeatures;' near_no/model.hpp || fail "--altitude no shows it"
train --out far_yes --loss vanilla --altitude yes --slopes pinned
grep -q 'pinnquad::InverseFeaturesWithAltitude;' far_yes/model.hpp || fail "--altitude yes does not show it"
grep -q "slope is not the airframe's" stderr.txt && fail "pinned slopes are doubted: $(cat stderr.txt)"

# when the default is not to be trusted: limits in a header beside it, of 80 s of validation rows and more; nothing that stays
grep -q '^  no limits .* at least 80 s of validation rows' said.txt || fail "a short flight: $(cat said.txt)"
"$pinnquad" fly --seed 3 --samples 9000 --out long.csv >/dev/null
train --flight long.csv --out trusted --loss vanilla
grep -q '^  trusted/trust.hpp: struct TrainedQuadModelTrust' said.txt || fail "said: $(cat said.txt)"
# shellcheck disable=SC2086
"$compiler" $compiler_flags -std=c++17 -O1 -Wall -Wextra -Werror -I trusted -I "$source_dir/include" \
  -isystem "$eigen" "$source_dir/tests/programs/trust/guarded.cpp" -o guarded || fail "the limits do not compile"
./guarded trusted/replay.txt || fail "the limits do not do what they are for"
train --out trusted --recipe paper
[ ! -e trusted/trust.hpp ] || fail "limits of an earlier training stay beside another model"

"$pinnquad" evaluate small/model.hpp --flight flight.csv --rows test --json >small.json || [ $? -eq 1 ]
"$pinnquad" evaluate small/model.block --flight flight.csv --rows test --json >block.json || [ $? -eq 1 ]
diff <(grep -v '"model": ' small.json) <(grep -v '"model": ' block.json) || fail "header and block of one network are judged otherwise"
python3 - <<'PYTHON'
import json
read = lambda folder: json.load(open(folder + "/report.json"))
default, paper, best, small = (read(folder) for folder in ("default", "paper", "best", "small"))
assert default["settings"]["recipe"] == "structured" and default["verdict"]["model"] == "structured", default["verdict"]
assert sorted(default["models"]) == ["linearized", "physics_informed", "structured", "vanilla"], list(default["models"])
certificate = default["certificate"]
assert certificate["proven"] is True and paper["certificate"] is None, certificate
said = open("certificate.txt").read()
for axis in "roll", "pitch", "yaw":
    slope, own = certificate["slope"][axis], certificate["airframe_slope"][axis]
    assert f"{axis:5} {slope:.6f} s^2/rad, {slope / own:.2f} of the airframe's own" in said, (axis, slope, own, said)
    assert default["models"]["structured"]["wrong_derivative_share"][axis]["mean"] == 0, axis
near, near_no, far_yes = (read(folder) for folder in ("near", "near_no", "far_yes"))
choice, far = near["altitude"], default["altitude"]
assert choice["asked"] == "auto" and choice["taken"] is True, choice
assert choice["validation_mae"] < 0.8 * choice["validation_mae_without"], choice
assert far["taken"] is False and far["validation_mae"] > 0.8 * far["validation_mae_without"] > 0, far
assert (near_no["altitude"]["taken"], far_yes["altitude"]["taken"], paper["altitude"]) == (False, True, None)
judged = json.load(open("near.json"))
mae = lambda report: report["models"]["structured"]["mean_absolute_error"]["mean"]
assert abs(mae(near) - judged["mean_absolute_error"]) < 1e-6 and mae(near) < 0.5 * mae(near_no), (mae(near), mae(near_no))
assert default["settings"]["structured"]["slopes"] == "learned" and far_yes["settings"]["structured"]["slopes"] == "pinned"
for axis, own in far_yes["certificate"]["airframe_slope"].items():
    assert abs(far_yes["certificate"]["slope"][axis] / own - 1) < 1e-6, (axis, far_yes["certificate"])
assert list(map(lambda r: r["settings"]["recipe"], (paper, best, small))) == ["paper", "best", "small"]
assert paper["settings"]["network"] == best["settings"]["network"] == "10 x 25 ReLU", paper["settings"]
assert paper["settings"]["learning_rate"] == 1e-3 and paper["settings"]["learning_rate_schedule"] == "constant"
for report in best, small:
    settings = report["settings"]
    assert settings["learning_rate"] == 3e-3 and "cosine" in settings["learning_rate_schedule"], settings
    assert settings["weight_decay"] == {"vanilla": 1e-4, "physics_informed": 3e-4}, settings
assert small["settings"]["network"] == "2 x 32 ReLU"
assert sorted(small["models"]) == ["constant_weight", "linearized", "pearson"], list(small["models"])
assert sorted(small["settings"]["losses"]) == ["constant_weight", "pearson"]
assert sorted(paper["models"]) == sorted(best["models"]) == ["linearized", "physics_informed", "vanilla"]
# the loss named first in the list of losses is the one that is exported where physics_informed was not asked for
assert small["verdict"]["model"] == "constant weight", small["verdict"]
judged = json.load(open("small.json"))
assert "Dense<32>" in judged["answer"] and judged["answer"].count("Dense<") == 3, judged["answer"]
assert abs(small["models"]["constant_weight"]["rmse"]["mean"] - judged["rmse"]) <= 1e-6
for axis in "roll", "pitch", "yaw":
    a, b = small["models"]["constant_weight"]["wrong_derivative_share"][axis], judged["wrong_derivative_share"][axis]
    assert abs(a["mean"] - b) <= 1e-6, (axis, a, b)
PYTHON
grep -q 'constant weight' small/model.hpp || fail "the header does not say its loss: $(grep -n loss small/model.hpp)"

mkdir out
refused() { expect_line 2 "$1" "$pinnquad" train --flight flight.csv --out out --epochs 1 --seeds 1 "${@:2}"; }
refused "^train: no recipe named 'worst'; known: structured, paper, best, small$" --recipe worst
refused "^train: --loss: no loss named 'mse'; known: vanilla, physics_informed, constant_weight, pearson$" --loss vanilla,mse
refused "^train: --altitude and --slopes go with --recipe structured, not with paper$" --recipe paper --slopes pinned
[ -z "$(ls -A out)" ] || fail "something was left in the output folder: $(ls -A out)"
"$pinnquad" train --help >help.txt
for word in structured paper best small vanilla physics_informed constant_weight pearson altitude slopes pinned 130; do grep -q "$word" help.txt || fail "help does not name $word"; done

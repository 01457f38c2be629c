# SPDX-License-Identifier: MIT
# certify proves a structured model, refutes the paper's networks by motions that another program finds to be such, and says so
# where it can do neither.
source "$(dirname "$0")/common.sh" "$@"
command -v python3 >/dev/null || { echo "skipped: no python3 to read the reports"; exit 77; }

exit_code() { local code=0; "$@" >stdout.txt 2>stderr.txt || code=$?; echo "$code"; }

# the paper's networks: a counterexample inside the envelope, in less than a second of an optimised build
seconds=1
case "$compiler_flags" in *sanitize*) seconds=30 ;; esac
for header in examples/models/demo_quadrotor.hpp examples/models/crazyflie_2_1.hpp; do
  [ "$(exit_code "$pinnquad" certify "$source_dir/$header" --json)" -eq 1 ] || fail "$header: $(cat stdout.txt stderr.txt)"
  python3 "$source_dir/tests/programs/judgement/counterexample.py" "$source_dir/$header" stdout.txt "$seconds" ||
    fail "$header: the counterexample is none"
done
[ "$(exit_code "$pinnquad" certify "$source_dir/examples/models/demo_quadrotor.hpp")" -eq 1 ] || fail "another exit code without --json"
grep -q '^refuted ' stdout.txt || fail "said: $(cat stdout.txt)"
"$pinnquad" certify "$source_dir/examples/models/demo_quadrotor.hpp" --json --seed 7 >a.txt || [ $? -eq 1 ]
"$pinnquad" certify "$source_dir/examples/models/demo_quadrotor.hpp" --json --seed 7 >b.txt || [ $? -eq 1 ]
diff <(grep -v seconds a.txt) <(grep -v seconds b.txt) || fail "the same seed finds other motions"

# a structured model: proven, header and block; its judgement beside the paper's two
"$pinnquad" fly --seed 3 --samples 3000 --out flight.csv >/dev/null
"$pinnquad" train --flight flight.csv --seeds 1 --epochs 6 --out model --block model/model.block --allow-poor >train.txt 2>&1 ||
  fail "train: $(cat train.txt)"
for file in model/model.hpp model/model.block; do
  [ "$(exit_code "$pinnquad" certify "$file")" -eq 0 ] || fail "$file: $(cat stdout.txt stderr.txt)"
  grep -q '^proven ' stdout.txt || fail "said: $(cat stdout.txt)"
  [ "$(exit_code "$pinnquad" certify "$file" --json)" -eq 0 ] || fail "$file: another exit code for JSON"
  grep -v '"model":' stdout.txt >"$(basename "$file").json"
done
diff model.hpp.json model.block.json || fail "header and block have different certificates"
grep -q 'require_certificate<' model/model.hpp || fail "the header does not ask for its certificate"
"$pinnquad" evaluate model/model.hpp --flight flight.csv --rows test --json >judged.json || fail "evaluate refuses it"
python3 - <<'PYTHON'
import json
report, judged = json.load(open("model/report.json")), json.load(open("judged.json"))
models = report["models"]
assert sorted(models) == ["linearized", "physics_informed", "structured", "vanilla"], list(models)
structured = models["structured"]
assert report["verdict"]["model"] == "structured", report["verdict"]
assert structured["mean_absolute_error"]["mean"] < 0.7 * models["physics_informed"]["mean_absolute_error"]["mean"], models
assert abs(structured["mean_absolute_error"]["mean"] - judged["mean_absolute_error"]) < 1e-6
for axis in "roll", "pitch", "yaw":
    assert structured["wrong_derivative_share"][axis]["mean"] == 0 == judged["wrong_derivative_share"][axis]
PYTHON

# the proof is of these numbers: with a slope turned there is none, and the header does not compile
python3 - <<'PYTHON'
import re
text = open("model/model.hpp").read()
at = text.index("{", text.index(" parameters = ")) + 1
turned = re.sub(r"[^\s{]", lambda first: "-" + first.group(0), text[at:], count=1)
open("turned.hpp", "w").write(text[:at] + turned)
PYTHON
expect_line 2 'turned.hpp:[0-9]+: expected a header as it was exported, found one that was edited since' "$pinnquad" certify turned.hpp
sed -i '/ contents_hash = /d' turned.hpp
expect_line 2 'turned.hpp: expected golden commands that its weights give, found others' "$pinnquad" certify turned.hpp

# slopes that are above 0 and that no vehicle would feel prove nothing; of a thrust that hardly follows it warns
python3 - "$source_dir/examples/models/structured_quadrotor.hpp" <<'PYTHON'
import re, sys
text = open(sys.argv[1]).read()
at = text.index("{", text.index(" parameters = ")) + 1
number = r"[-+.\de]+f"
def numbers(name):
    return [float(n[:-1]) for n in re.findall(number, re.search(" " + name + " = (.*?);", text, re.S).group(1))]
def scaled(index, share, output, feature, signs):
    """The weight of one feature in one sum, and the golden commands that follow from it; without the hash."""
    found = list(re.finditer(number, text[at:at + 2000]))[index]
    old = float(found.group(0)[:-1])
    mean, spread = numbers("input")[feature], numbers("input")[19 + feature]
    unit = (share - 1) * old * numbers("output")[4 + output] / 4
    features = numbers("golden_features")[feature::19]
    golden = [u + signs[i % 4] * unit * (features[i // 4] - mean) / spread for i, u in enumerate(numbers("golden_commands"))]
    result = text[:at + found.start()] + repr(share * old) + "f" + text[at + found.end():]
    rows = ",".join("{{" + ",".join(repr(u) + "f" for u in golden[i:i + 4]) + "}}" for i in range(0, len(golden), 4))
    result = re.sub("( golden_commands = ).*?;", lambda m: m.group(1) + "{{" + rows + "}};", result, flags=re.S)
    return re.sub(".* contents_hash = .*\n", "", result)
open("hardly.hpp", "w").write(scaled(0, 1e-45, 1, 1, [-1, 1, 1, -1]))
open("sinks.hpp", "w").write(scaled(3, 0.4, 0, 0, [1, 1, 1, 1]))
PYTHON
expect_line 2 'hardly.hpp: expected slopes and bounds of which its certificate is proven' "$pinnquad" certify hardly.hpp
code=$(exit_code "$pinnquad" certify sinks.hpp)
[ "$code" -eq 0 ] || fail "exit code $code of a small thrust slope: $(cat stdout.txt stderr.txt)"
grep -q '^thrust .* 0\.41 of the airframe' stdout.txt || fail "said: $(cat stdout.txt)"
grep -q '^warning .*sinks under a load' stdout.txt || fail "said: $(cat stdout.txt)"
code=$(exit_code "$pinnquad" certify "$source_dir/examples/models/structured_quadrotor.hpp")
grep -q '^warning' stdout.txt && fail "it warns of the example: $(cat stdout.txt)"
grep -q '^ .* a sum rises for sure from a step of ' stdout.txt || fail "said: $(cat stdout.txt)"
"$pinnquad" certify "$source_dir/tests/models/v3/near_ground_quadrotor.hpp" --json >near.json
python3 - <<'PYTHON'
import json
near = json.load(open("near.json"))
assert 0.5 * near["airframe_thrust_slope"] < near["least_thrust_slope"] < near["held_thrust_slope"], near
assert near["thrust_slope"] == near["held_thrust_slope"] and "held_slope_with_body_rates" not in near
assert all(step > 0 for step in near["sure_step"].values()) and near["rounding"] > 0
PYTHON

# models that train fits to logs: a formula under the outputs, affine maps, structured ones; evaluate judges the flight
# that was held out as train did
mkdir logs
for i in 1 2 3; do "$pinnquad" fly --seed "$i" --samples 600 --out "logs/flight$i.csv" >/dev/null; done
python3 - <<'PYTHON'
import json
flights = [{"name": f"flight{i}", "file": f"flight{i}.csv", "trajectory": "", "rows": 600, "source": "simulator"} for i in (1, 2, 3)]
json.dump({"format": 1, "sample_period_s": 0.05, "lag_removed_s": 0, "absent": [], "flights": flights, "steps": []},
          open("logs/dataset.json", "w"))
PYTHON
# judge_export <folder> <model> <flights> <exit codes of certify> [option of train]...
judge_export() {
  local folder=$1 model=$2 codes=$4 code=0 flights
  read -r -a flights <<<"$3"
  shift 4
  "$pinnquad" train "$@" --models "constant,$model" --export "$model" --seeds 1 --epochs 2 --out "$folder" \
    --block "$folder/model.block" --allow-poor >train.txt 2>&1 || fail "train $model: $(cat train.txt)"
  code=$(exit_code "$pinnquad" certify "$folder/model.hpp" --seconds 0.5)
  case " $codes " in *" $code "*) ;; *) fail "$model: certify ends with $code: $(cat stdout.txt stderr.txt)" ;; esac
  cp stdout.txt "$folder/certify.txt"
  code=$(exit_code "$pinnquad" evaluate "$folder/model.hpp" --flight "${flights[@]}" --json)
  [ "$code" -le 1 ] || fail "evaluate $model: $(cat stderr.txt)"
  python3 - "$folder" "$model" "$codes" <<'PYTHON'
import json, sys
folder, model, codes = sys.argv[1:]
trained, judged = json.load(open(f"{folder}/report.json"))["models"][model], json.load(open("stdout.txt"))
assert judged["golden_difference"] <= 1e-5, judged["golden_difference"]
for figure in "r2", "rmse", "mean_absolute_error":
    said = trained[figure]["mean"]
    assert abs(said - judged[figure]) <= 2e-3 * abs(said), (model, figure, said, judged[figure])
for figure in "pair_violations", "large_step_violations", "large_step_violations_flown":
    for axis, share in trained["pairs"][figure].items():
        assert abs(share - judged[figure][axis]) <= 1e-6, (model, figure, axis, share, judged[figure])
slopes = trained["slopes"]
for axis, least in slopes["least_derivative_over_nominal"].items():
    # train moves by a step, evaluate differentiates: the same of an affine model
    assert codes != "0" or abs(least - judged["least_derivative_over_nominal"][axis]) <= 1e-3 * abs(least) + 2e-3, (model, axis, least)
PYTHON
}
for entry in "linearized 0" "ridge 0" "vanilla 1" "structured 0"; do
  judge_export "m_${entry% *}" "${entry% *}" logs/flight3.csv "${entry#* }" --dataset logs --airframe paper_quadrotor --hold-out flight3
done

# windows, of logs that have a row every 20 ms: proven by what the weights of all instants sum to, refuted by a motion
log=${PINNQUAD_REFERENCE_DIR:-$source_dir/../shared/reference}/flight_logs/nanobench_subset_50hz.csv
if [ -f "$log" ]; then
  "$pinnquad" import "$log" --mapping nanobench --out nano >import.txt 2>&1 || fail "import: $(cat import.txt)"
  held=B9_trefoil_fast_rep1 # and with it the other flight of that trajectory
  for model in ridge_causal ridge_centred structured_causal; do
    judge_export "n_$model" "$model" "nano/$held.csv nano/B9_trefoil_medium_rep1.csv" 0 --dataset nano --airframe crazyflie_2_1 --hold-out "$held"
    grep -q 'of one that is held; of the present alone' "n_$model/certify.txt" || fail "$model: $(cat "n_$model/certify.txt")"
    [ "$model" != structured_causal ] || grep -q '^with rates ' "n_$model/certify.txt" || fail "$model: $(cat "n_$model/certify.txt")"
  done
  # the weights by hand: of the present instant, and summed over all
  python3 - n_ridge_causal/model.hpp n_ridge_causal/certify.txt <<'PYTHON'
import re, sys
text, said = open(sys.argv[1]).read(), open(sys.argv[2]).read()
def listed(name): return re.search(r"\b%s = (\{.*?\});" % name, text, re.S).group(1)
def numbers(name): return [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?[,}\s])", listed(name))]
names = re.findall(r'"(.*?)"', listed("feature_names"))
n, weights, spread, scale, signs = len(names), numbers("parameters"), numbers("input"), numbers("output"), numbers("motor_torque_signs")
for axis, name in enumerate(("roll", "pitch", "yaw")):
    places = [i for i, feature in enumerate(names) if re.match("wdot_" + "xyz"[axis], feature)]
    slopes = [sum(signs[3 * u + axis] * scale[4 + u] * weights[u * n + i] for u in range(4)) / spread[n + i] for i in places]
    held, present = map(float, re.search(name + r" +(\S+) s.2/rad.*alone (\S+)", said).groups())
    assert len(places) == 9 and abs(held - sum(slopes)) < 2e-6 and abs(present - slopes[0]) < 2e-6, (name, slopes, held, present)
PYTHON
else
  echo "no logs with a window: $log is not there"
fi

# no time to find anything: neither
code=$(exit_code "$pinnquad" certify "$source_dir/tests/models/v2/crazyflie_tanh.hpp" --seconds 0.01)
case "$code" in 1 | 3) ;; *) fail "exit code $code of a short search: $(cat stderr.txt)" ;; esac

expect_line 2 'none.hpp: expected a readable file' "$pinnquad" certify none.hpp
expect_line 2 'flight.csv: expected a model block' "$pinnquad" certify flight.csv

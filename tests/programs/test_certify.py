# SPDX-License-Identifier: MIT
"""certify proves a structured model, refutes the paper's networks by motions that another program finds to be such, and
says so where it can do neither."""
import json
import re

import pytest
from conftest import SOURCE, edited, replaced, report_of
from exported import AXES, Header

DEMO = SOURCE / "examples/models/demo_quadrotor.hpp"
STRUCTURED = SOURCE / "examples/models/structured_quadrotor.hpp"


def but_the_time(text, key="seconds"):
    return [line for line in text.splitlines() if key not in line]


# every exported model in the tree; exit code: 0 proven, 1 refuted; 2: no block stands beside it
MODELS = {
    "examples/models/crazyflie_2_1.hpp": 1,
    "examples/models/demo_quadrotor.hpp": 1,
    "examples/models/model.hpp": 2,  # the demo's under another name
    "examples/models/structured_quadrotor.hpp": 0,
    "tests/models/near_ground_quadrotor.hpp": 0,
    "tests/models/own_racer.hpp": 1,
}


@pytest.mark.parametrize("model, code", MODELS.items())
def test_certificate(pinnquad, flags, model, code):
    if code == 2:
        pinnquad.refused("certify --json", SOURCE / model, keyword=".block")
        return
    said = json.loads(pinnquad("certify --json", SOURCE / model, code=code).out)
    assert said["verdict"] == ("counterexample" if code else "proven")
    # of the processor, to refute one
    assert not code or said["seconds"] < (30 if any("sanitize" in flag for flag in flags) else 1)


def test_every_model_has_a_row():
    found = [path for folder in ("examples/models", "tests/models") for path in (SOURCE / folder).glob("*.hpp")]
    assert sorted(str(path.relative_to(SOURCE)) for path in found if path.name != "known_predictions.hpp") == sorted(MODELS)


@pytest.mark.parametrize("model", ["examples/models/demo_quadrotor.hpp", "examples/models/crazyflie_2_1.hpp"])
def test_counterexample(pinnquad, model):
    """Two motions inside the envelope differ in one angular acceleration, and the signed sum falls from the first to
    the second: by the network of the header's text, in double."""
    report = json.loads(pinnquad("certify --json", SOURCE / model, code=1).out)
    header, example = Header(SOURCE / model), report["counterexample"]
    axis, names = AXES.index(example["axis"]), header.names()
    x = [example["features"][name] for name in names]
    more = list(x)
    assert example["moved"][0] == names[3 + axis] == "wdot_" + "xyz"[axis] and example["step"] > 0
    for name in example["moved"]:
        more[names.index(name)] += example["step"]
    for motion in x, more:
        for low, value, high in zip(header.numbers("envelope_lower"), motion, header.numbers("envelope_upper")):
            assert low <= value <= high
    commands, signed_sum = header.commands(), header.sums()
    before, after = (signed_sum(commands(motion), axis) for motion in (x, more))
    assert after < before - 5e-6
    assert abs(before - example["signed_sum"]) < 1e-5 and abs(after - example["signed_sum_after_step"]) < 1e-5


def test_text_and_seed(pinnquad):
    assert "\nrefuted " in pinnquad("certify", DEMO, code=1).out
    one, other = (pinnquad("certify --json --seed 7", DEMO, code=1).out for _ in range(2))
    assert but_the_time(one) == but_the_time(other)
    # no time to find anything: neither
    pinnquad("certify --seconds 0.01", SOURCE / "examples/models/crazyflie_2_1.hpp", code=(1, 3))


@pytest.fixture(scope="module")
def flight(flown):
    return flown("--seed 3 --samples 3000")


@pytest.fixture(scope="module")
def trained(made, flight):
    return made(f"train {flight} --seeds 1 --epochs 6 --out . --allow-poor")


def test_structured(pinnquad, trained, flight):
    """Proven, header and block; its judgement beside the paper's two."""
    for file in "model.hpp", "model.block":
        assert "\nproven " in pinnquad("certify", trained / file).out
    of_header, of_block = (pinnquad("certify --json", trained / file).out for file in ("model.hpp", "model.block"))
    assert but_the_time(of_header, '"model":') == but_the_time(of_block, '"model":')
    assert "require_certificate<" in (trained / "model.hpp").read_text()
    report = report_of(trained)
    judged = json.loads(pinnquad("evaluate", trained / "model.hpp", flight, "--rows", "test", "--json").out)
    models = report["models"]
    assert sorted(models) == ["formula", "paper_physics_informed", "paper_vanilla", "structured"]
    assert report["verdict"]["model"] == "structured"
    error = {name: model["mean_absolute_error"]["mean"] for name, model in models.items()}
    assert error["structured"] < 0.7 * error["paper_physics_informed"]
    assert abs(error["structured"] - judged["mean_absolute_error"]) < 1e-6
    for axis in AXES:
        wrong = models["structured"]["wrong_derivative_share"][axis]["mean"]
        assert wrong == 0 == judged["wrong_derivative_share"][axis]


def test_bias(pinnquad, trained):
    """With a bias that is learnt in flight: header, block, report and certificate say one thing."""
    report = report_of(trained)
    times = report["bias_time_constants_s"]
    least = report["settings"]["bias"]["least_time_constant_s"]
    tried = report["models"]["structured"]["adaptive"]["tried_s"]
    assert len(times) == 4 and all(time in tried and (time == 0 or time >= least) for time in times)
    header = (trained / "model.hpp").read_text()
    stated = re.search(r"array<float, 4> bias_time_constants_s = \{\{(.*)\}\};", header).group(1)
    assert [float(time.strip("f ")) for time in stated.split(",")] == pytest.approx(times)
    assert "bias" in header.split("#pragma once")[0]
    of_block, certified = (json.loads(pinnquad(f"{command} --json", trained / "model.block").out)
                           for command in ("block", "certify"))
    assert of_block["bias_time_constants_s"] == pytest.approx(times)
    said = pinnquad("certify", trained / "model.hpp").flat
    assert re.search(" bias with the bias .*slopes hold as they are.* 0.7000", said), said
    assert certified["bias"]["time_constants_s"] == pytest.approx(times)
    assert certified["bias"]["widens_command_bound"] == pytest.approx([0.7] * 4)
    assert report["certificate"]["bias_widens_command_bound"] == pytest.approx([0.7] * 4)
    # of a model that says none, nothing is said
    assert "\nbias" not in pinnquad("block", SOURCE / "tests/models/own_racer.block").out


def test_shipped(pinnquad):
    said = pinnquad("certify", STRUCTURED).flat
    assert " warning " not in said and re.search("a sum rises for sure from a step of ", said), said


def test_near_ground(pinnquad, flown):
    flight = flown("d3 --seed 1 --samples 3000")
    pinnquad(f"train {flight} --models structured --altitude yes --seeds 1 --epochs 1 --out near "
             "--allow-poor")
    near = json.loads(pinnquad("certify --json near/model.block").out)
    assert 0.5 * near["airframe_thrust_slope"] < near["held_thrust_slope"]
    assert near["thrust_slope"] == near["held_thrust_slope"] and "held_slope_with_body_rates" not in near
    assert all(step > 0 for step in near["sure_step"].values()) and near["rounding"] > 0


def judge_export(pinnquad, model, code, flights, words):
    """A model that train fits to logs: certify ends with that code, evaluate judges the flight that was held out as
    train did. What certify says."""
    pinnquad(f"train {words} --models constant,{model} --export {model} --seeds 1 --epochs 2 --out {model} "
             "--allow-poor")
    certified = pinnquad(f"certify {model}/model.hpp --seconds 0.5", code=code)
    judged = json.loads(pinnquad(f"evaluate {model}/model.hpp --json", *flights, code=(0, 1)).out)
    trained = report_of(model)["models"][model]
    assert judged["golden_difference"] <= 1e-5
    for figure in "r2", "rmse", "mean_absolute_error":
        said = trained[figure]["mean"]
        assert abs(said - judged[figure]) <= 2e-3 * abs(said), figure
    for figure in "pair_violations", "large_step_violations", "large_step_violations_flown":
        for axis, share in trained[figure].items():
            assert abs(share["mean"] - judged[figure][axis]) <= 1e-6, (figure, axis)
    for axis, least in trained["least_derivative_over_nominal"].items():
        assert abs(least["mean"] - judged["least_derivative_over_nominal"][axis]) <= 1e-6 * abs(least["mean"]) + 1e-9, axis
    return certified


@pytest.mark.parametrize("model, code", [("linearized", 0), ("vanilla", 1), ("structured", 0)])
def test_models_of_logs(pinnquad, flown, dataset, model, code):
    """A formula under the outputs, a network, a structured model; affine maps below."""
    dataset("logs", {f"flight{seed}": flown(f"--seed {seed} --samples 600") for seed in (1, 2, 3)})
    judge_export(pinnquad, model, code, ["logs/flight3.csv"],
                 "logs --airframe paper_quadrotor --hold-out flight3")


@pytest.mark.parametrize("model", ["ridge_causal", "ridge_centred", "structured_causal"])
def test_windows(pinnquad, nanobench, model):
    """Of logs that have a row every 20 ms: proven by what the weights of all instants sum to."""
    held = "B9_trefoil_fast_rep1"  # and with it the other flight of that trajectory
    said = judge_export(pinnquad, model, 0, [nanobench / f"{held}.csv", nanobench / "B9_trefoil_medium_rep1.csv"],
                        f"{nanobench} --airframe crazyflie_2_1 --hold-out {held}")
    assert "of one that is held; of the present alone" in said.flat
    assert model != "structured_causal" or re.search("^with rates ", said.out, re.M), said
    if model != "ridge_causal":
        return
    # the weights by hand: of the present instant, and summed over all
    header = Header(f"{model}/model.hpp")
    names, scale, signs = header.names(), header.numbers("output"), header.signs()
    n, weights, spread = len(names), header.numbers("parameters"), header.numbers("input")
    for axis, name in enumerate(AXES):
        places = [i for i, feature in enumerate(names) if feature.startswith("wdot_" + "xyz"[axis])]
        slopes = [sum(signs[3 * u + axis] * scale[4 + u] * weights[u * n + i] for u in range(4)) / spread[n + i]
                  for i in places]
        held, present = map(float, re.search(name + r" +(\S+) s.2/rad.*?alone (\S+)", said.flat).groups())
        assert len(places) == 9 and abs(held - sum(slopes)) < 2e-6 and abs(present - slopes[0]) < 2e-6, name


@pytest.mark.parametrize("past, code", [(0.5, 0), (1.02, 1)])
def test_held_slope(pinnquad, flown, dataset, past, code):
    """Commands that are affine in the angular accelerations of now and, against them, of 20 ms before: the present
    slope is 4 x 0.02 whatever the past takes off about the yaw axis, the slope of one that is held is that less it; both
    over the square of how much faster the flight is played than it was flown, so that there is a row every 20 ms."""
    faster = 2.5
    signs = (-1, 1, 1, -1), (1, -1, 1, -1), (1, 1, -1, -1)  # front right, rear left, front left, rear right

    def of_two_instants():
        before = []

        def change(line, cells):
            if line == 1:
                return
            now = [0.002 * float(cells[4]), 0.002 * float(cells[5]), 0.02 * float(cells[6])]
            then = before or now
            cells[0] = 0.05 / faster * (line - 2)
            for at in range(1, 13):  # accelerations, then velocity and rates
                cells[at] = float(cells[at]) * (faster**2 if at < 7 else faster)
            for u in range(4):
                cells[17 + u] = 0.5 + sum(signs[axis][u] * (now[axis] - (past if axis == 2 else 0.5) * then[axis])
                                          for axis in range(3))
            before[:] = now

        return change

    names = "a", "b", "c"
    dataset("logs", {name: edited(flown(f"--seed {seed} --samples 500"), f"{name}.csv", of_two_instants())
                     for seed, name in enumerate(names, start=1)})
    replaced("logs/dataset.json", "logs/dataset.json", ('"sample_period_s": 0.05', '"sample_period_s": 0.02'))
    pinnquad("train logs --airframe paper_quadrotor --hold-out c --models constant,ridge_causal "
             "--export ridge_causal --seeds 1 --out held")
    found = json.loads(pinnquad("certify --json held/model.hpp", code=code).out)
    assert found["verdict"] == ("counterexample" if code else "proven")
    if not code:
        slope, held = (found[key]["yaw"] * faster**2 for key in ("slope", "held_slope"))
        assert abs(slope - 0.08) < 1e-5 and abs(held - 0.04) < 1e-5, found
        return
    assert abs(found["counterexample"]["derivative"] * faster**2 + 0.08 * (past - 1)) < 1e-5
    assert found["counterexample"]["moved"] == ["wdot_z", *(f"wdot_z[-{tap}]" for tap in range(1, 9))]


def test_lone_tap(pinnquad, recorded):
    """A window whose past shows one angular acceleration alone, against the present's: never proven."""
    block = recorded("cases/proof_lone_tap/lone_wdot.block")
    said = pinnquad("certify --json", block, code=(1, 2))
    if said.code == 1:
        found = json.loads(said.out)
        assert found["uncounted_features"] == ["wdot_x[-1]"] and "proven" not in found["verdict"]
        assert found["counterexample"]["moved"] == ["wdot_x", "wdot_x[-1]"]
        assert "\nno proof " in pinnquad("certify", block, code=1).out

# SPDX-License-Identifier: MIT
"""Models by name: what is trained is what the report says, and what it was trained with is exported and
judged."""
import json
import os
import re
from pathlib import Path

import pytest
from conftest import SOURCE, Program, edited, replaced, report_of, same_bytes
from exported import AXES

PAPER = "--models formula,paper_vanilla,paper_physics_informed"
TRAIN = "--seeds 1 --epochs 3 --threads 1 --allow-poor"


@pytest.fixture(scope="module")
def flight(flown):
    return flown("--seed 3 --samples 2500")


@pytest.fixture(scope="module")
def trained(made, flight):
    """trained(options): the folder that they write, once."""
    return lambda words="", of=flight: made(f"train {of} {TRAIN} --out . {words}")


def figures(folder, but=""):
    """Of each model; the last column is a time."""
    rows = [line.rsplit(",", 1)[0] for line in (folder / "results.csv").read_text().splitlines()]
    return [row for row in rows if not but or not row.startswith(f"{but},")]


def test_defaults_and_order(trained):
    default, structured = trained(), trained("--models formula,paper_vanilla,paper_physics_informed,structured")
    paper = trained(PAPER)
    assert figures(default) == figures(structured)
    same_bytes(default / "model.hpp", structured / "model.hpp")
    assert figures(default, but="structured") == figures(paper), "a structured model changes the networks beside it"
    assert figures(paper) != figures(trained(PAPER.replace("paper", "best")))
    same_bytes(trained("--models paper_physics_informed,formula,paper_vanilla") / "model.hpp", paper / "model.hpp")
    one = trained("--models formula,paper_vanilla,structured")
    same_bytes(one / "model.hpp", default / "model.hpp")
    assert [row.split(",")[0] for row in figures(one)] == ["model", "formula", "paper_vanilla", "structured"]


def test_reports(pinnquad, trained):
    """test_certify.py has the default's proof, test_evaluate.py the judgement of what is exported."""
    default, best = report_of(trained()), report_of(trained(PAPER.replace("paper", "best")))
    paper = report_of(trained(PAPER))
    folder = trained("--models formula,small_pearson,small_constant_weight")
    small = report_of(folder)
    certificate = default["certificate"]
    assert certificate["proven"] is True and paper["certificate"] is None
    said = pinnquad("certify", trained() / "model.hpp").out
    for axis in AXES:
        slope, own = certificate["slope"][axis], certificate["airframe_slope"][axis]
        assert f"{axis:5} {slope:.6f} s^2/rad, {slope / own:.2f} of the airframe's own" in said, axis
    assert default["settings"]["structured"]["slopes"] == "learned"
    structured, warned = default["models"]["structured"], (trained() / "stderr.txt").read_text()
    motors = [motor["r2"]["mean"] for motor in structured["per_motor"].values()]
    assert abs(default["verdict"]["worst_motor_r2"] - min(motors)) <= 1e-9 < default["verdict"]["r2"] - min(motors)
    error = default["verdict"]["held_out_rmse"]
    networks = {name: default["models"][name]["rmse"]["mean"] for name in ("paper_vanilla", "paper_physics_informed")}
    assert error["best_other_model"] == min(networks, key=networks.get) and error["exported"] == structured["rmse"]["mean"]
    for network in networks:  # one that errs less by a tenth is told, and no other
        less = network == error["best_other_model"] and networks[network] < 0.9 * structured["rmse"]["mean"]
        assert (f"--export {network} exports it" in warned) == less, network

    of_paper, of_best, of_small = (report["settings"]["networks"][name] for report, name in (
        (paper, "paper"), (best, "best"), (small, "small")))
    assert of_paper["network"] == of_best["network"] == "10 x 25 ReLU"
    assert of_paper["learning_rate"] == 1e-3 and of_paper["learning_rate_schedule"] == "constant"
    for settings in of_best, of_small:
        assert settings["learning_rate"] == 3e-3 and "cosine" in settings["learning_rate_schedule"], settings
        assert settings["weight_decay"] == {"vanilla": 1e-4, "physics_informed": 3e-4}, settings
    assert of_small["network"] == "2 x 32 ReLU"
    assert sorted(small["models"]) == ["formula", "small_constant_weight", "small_pearson"]
    assert sorted(of_small["losses"]) == ["small_constant_weight", "small_pearson"]
    assert sorted(paper["models"]) == ["formula", "paper_physics_informed", "paper_vanilla"]
    # the loss named first in the list of losses is the one that is exported where physics_informed was not asked for
    assert small["verdict"]["model"] == small["exported_model"] == "small_constant_weight"
    assert "constant weight" in (folder / "model.hpp").read_text()
    assert json.loads(pinnquad("block --json", folder / "model.block").out)["network"].count("Dense<") == 3


def test_slopes_under_noise(pinnquad, flown):
    """Gyro noise bends the slopes of least squares: those of smoothed rows are exported, each with an interval, said by
    report, page and console alike; of a quiet flight least squares are kept."""
    words = "--models structured --seeds 1 --epochs 3 --threads 1"
    quiet, noisy = flown("--seed 3 --samples 5000"), flown("--seed 3 --samples 5000 --gyro-noise 0.03 --jitter 10")
    errors = {}
    for flight, by in (quiet, "least squares"), (noisy, "smoothed rows"):
        folder = Path(by.split()[0])
        said = pinnquad(f"train {words} --verbose", flight, "--out", folder).flat
        report = report_of(folder)
        certificate = report["certificate"]
        assert certificate["proven"] is True and report["exported"] is True
        assert sorted(certificate["known"]) == ["pitch", "roll", "thrust", "yaw"]
        for axis in AXES:
            known, own = certificate["known"][axis], certificate["airframe_slope"][axis]
            lower, upper = known["interval_95"]
            assert known["by"] == by and lower < certificate["slope"][axis] < upper, axis
            assert (known["least_squares"] < 0.8 * own) == (by == "smoothed rows"), axis
            assert f"{axis} {lower / own:.2f} to {upper / own:.2f}" in said, axis
            assert lower < 1.03 * own and upper > own, axis
        assert certificate["known"]["thrust"]["by"] == "least squares"
        least = min(certificate["slope"][axis] / certificate["airframe_slope"][axis] for axis in AXES)
        assert f"at least {least:.2f} of the airframe's own slope" in said
        assert f"at least {least:.2f} of the airframe's own slope" in pinnquad("certify", folder / "model.hpp").flat
        assert said.count("by smoothed rows") == (3 if by == "smoothed rows" else 0)
        assert f"<td>{by}</td>" in (folder / "report.html").read_text()
        assert any("smoothed rows" in warning for warning in report["warnings"]) == (by == "smoothed rows")
        judged = json.loads(pinnquad("evaluate", folder / "model.block", quiet, "--json").out)
        errors[by] = judged["rmse"]
    assert errors["smoothed rows"] < 1.1 * errors["least squares"] < 0.02, "on a flight without noise"


@pytest.mark.parametrize("noise, seed, most", ((0.02, 21, 0.010), (0.05, 25, 0.012)))
def test_slopes_of_any_seed(pinnquad, flown, noise, seed, most):
    """Flights whose noise has a large mean, or hides yaw most, teach as well as others do: slopes, their intervals, and
    the error on a flight without noise."""
    noisy, quiet = flown(f"--seed {seed} --gyro-noise {noise} --jitter 10"), flown("--seed 2")
    pinnquad("train --models structured --seeds 1 --epochs 20 --threads 1", noisy, "--out", "any")
    certificate = report_of("any")["certificate"]
    for axis in AXES:
        own = certificate["airframe_slope"][axis]
        assert 0.95 < certificate["slope"][axis] / own < 1.06, axis
        lower, upper = certificate["known"][axis]["interval_95"]
        assert lower < 1.03 * own and upper > own, axis
        assert upper - lower < 0.1 * own, axis
    judged = json.loads(pinnquad("evaluate", "any/model.block", quiet, "--json").out)
    assert judged["mean_absolute_error"] < most


def test_latency(pinnquad, flown):
    """Commands that stand a row beside the motion are aligned with it, said by console, report and header; those of slow
    rotors stay, and so do all by --lag 0."""
    words = "train --models linear,structured --export structured --seeds 1 --epochs 3"
    late, prompt = (flown(f"--seed 3 --samples 5000 {latency}") for latency in ("--latency 50", ""))
    rows = Path(prompt).read_text().splitlines()  # a sensor that is late by a row
    ahead = [",".join(row.split(",")[:-4] + after.split(",")[-4:]) for row, after in zip(rows[1:], rows[2:])]
    Path("ahead.csv").write_text("\n".join([rows[0], *ahead, ""]))
    error = {}
    slow = "--airframe crazyflie_2_1"
    for flight, options, lag in ((late, "", -0.05), (late, "--lag 0", 0), ("ahead.csv", "", 0.05), (prompt, "", 0),
                                 (flown(f"--seed 3 --samples 5000 {slow}"), slow, 0)):
        said = pinnquad(f"{words} {options} --out aligned", flight).out
        report = report_of("aligned")
        assert report["settings"]["lag_removed_s"] == pytest.approx(lag), (flight, options)
        assert ("--lag 0 leaves the commands" in said) == (lag != 0)
        assert ("from command to motion removed" in Path("aligned/report.html").read_text()) == (lag != 0)
        stated = re.search("lag_removed_s = ([0-9.]+)", Path("aligned/model.hpp").read_text()).group(1)
        assert float(stated) == pytest.approx(max(lag, 0)), "below 0 it is none of the rotors"
        error[str(flight), options] = report["models"]["structured"]["rmse"]["mean"]
    assert error[str(late), ""] < 0.5 * error[str(late), "--lag 0"]
    assert error[str(late), ""] < 1.8 * error[str(prompt), ""]


def test_altitude_and_slopes(pinnquad, trained, flight, compiler):
    """The altitude is not shown far from the ground, shown where the commands depend on it, or as asked; pinned slopes
    are the airframe's."""

    def near_ground(line, cells):
        if line > 1:
            cells[17:21] = [0.2 + 0.6 * float(u) + 0.004 * (float(cells[16]) - 20) for u in cells[17:21]]

    edited(flight, "near.csv", near_ground)
    said = pinnquad(f"train near.csv {TRAIN} --out near --verbose").flat
    assert re.search(r"altitude used by the structured model: .* with it [0-9.]*e-3, without it [0-9.]*e-3 ", said), said
    assert "pinnquad::InverseFeaturesWithAltitude;" in Path("near/model.hpp").read_text()
    for model in "model.hpp", "model.block":
        pinnquad(f"certify near/{model}")
    judged = json.loads(pinnquad("evaluate near/model.hpp near.csv --rows test --json").out)
    assert Path("near/replay.txt").read_text().startswith("pinnquad-replay 1 500 25\n")
    Path("self_test.cpp").write_text("#include <model.hpp>\nint main() { return self_test("
                                     "pinnquad::InverseDynamics<TrainedQuadModel>{}) != pinnquad::Status::ok; }\n")
    compiler("-Wall -Wextra -Werror -I near self_test.cpp -o self_test")
    Program("./self_test")()
    pinnquad(f"train near.csv {TRAIN} --out near_no --models structured --altitude no")
    assert "pinnquad::InverseFeatures;" in Path("near_no/model.hpp").read_text()
    far = trained("--models structured --altitude yes --slopes pinned")
    assert "pinnquad::InverseFeaturesWithAltitude;" in (far / "model.hpp").read_text()
    assert "--slopes pinned takes" not in (far / "stderr.txt").read_text(), "pinned slopes are doubted"

    near, near_no, far_yes, default = (report_of(folder) for folder in ("near", "near_no", far, trained()))
    choice, other = near["altitude"], default["altitude"]
    assert choice["asked"] == "auto" and choice["taken"] is True
    assert choice["validation_mae"] < 0.8 * choice["validation_mae_without"]
    assert other["taken"] is False and other["validation_mae"] > 0.8 * other["validation_mae_without"] > 0
    assert near_no["altitude"]["taken"] is False and far_yes["altitude"]["taken"] is True
    assert report_of(trained(PAPER.replace("paper", "best")))["altitude"] is None
    error, error_no = (report["models"]["structured"]["mean_absolute_error"]["mean"] for report in (near, near_no))
    assert abs(error - judged["mean_absolute_error"]) < 1e-6 and error < 0.5 * error_no
    assert far_yes["settings"]["structured"]["slopes"] == "pinned"
    for axis, own in far_yes["certificate"]["airframe_slope"].items():
        assert abs(far_yes["certificate"]["slope"][axis] / own - 1) < 1e-6, axis


def test_limits_of_trust(pinnquad, flight, flown, compiler, flags):
    """In a header beside the model, of 80 s of validation rows and more; nothing that stays. The header brings an airframe
    that a file gave."""
    assert re.search(" no trust.hpp: .* 80 s", pinnquad(f"train {flight} {TRAIN} --out short --models structured").flat)
    long = flown("--seed 3 --samples 9000")
    replaced(SOURCE / "examples/airframes/paper_quadrotor.toml", "mine.toml", ("^name = .*", r'name = "my \\"own\\" quad"'))
    said = pinnquad(f"train {long} {TRAIN} --out trusted --models structured --airframe mine.toml").out
    header = Path("trusted/model.hpp").read_text()
    assert "using Vehicle = TrainedQuadModelAirframe;" in header and 'name = "my \\"own\\" quad";' in header
    assert " trusted/trust.hpp: struct TrainedQuadModelTrust" in said
    compiler(*flags, "-O1", "-Wall", "-Wextra", "-Werror", "-I", "trusted", SOURCE / "tests/programs/trust/guarded.cpp",
             "-o", "guarded")
    Program("./guarded")("trusted/replay.txt")
    pinnquad(f"train {flight} {TRAIN} --out trusted --models paper_physics_informed")
    assert not Path("trusted/trust.hpp").exists(), "limits of an earlier training stay beside another model"


@pytest.mark.parametrize("words, keyword", [("--models paper_mse", "nearest: paper_"), ("--recipe paper", "--models NAME"),
                                            ("--models paper_vanilla --slopes pinned", "--slopes")])
def test_refused(pinnquad, flight, commands, words, keyword):
    Path("out").mkdir()
    line = pinnquad.refused(f"train {flight} --out out --epochs 1 --seeds 1 {words}", keyword=keyword).lines[0]
    assert not os.listdir("out")
    (text,) = [text for command, text in commands if command.words[-1] == "train"]
    nearest = line.split("nearest: ")[1].split(";")[0].replace("_", ", ") if "nearest: " in line else "altitude, slopes, pinned, 130"
    for name in nearest.split(", "):
        assert name in text, f"help does not name {name}"

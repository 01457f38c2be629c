# SPDX-License-Identifier: MIT
"""evaluate judges a block or a header as the training judged the network that it was written from, and refuses what is
neither."""
import csv
import json
import math
import re
import shutil

import pytest
from conftest import SOURCE, edited, report_of
from exported import AXES, Header

PLAIN = ["mean_absolute_error", "rmse", "r2"]
BY_AXIS = ["wrong_derivative_share", "least_derivative_over_nominal", "median_derivative_over_nominal", "pair_violations", "pair_violations_flown",
           "large_step_violations", "large_step_violations_flown", "slope_error"]


@pytest.fixture(scope="module")
def flight(flown):
    return flown("--seed 3 --samples 3000")


@pytest.fixture(scope="module")
def trained(made, flight):
    """A folder with a/: a network trained as the paper's."""
    words = "--models formula,paper_vanilla,paper_physics_informed --seeds 2 --epochs 8 --allow-poor --out a"
    return made(f"train {flight} {words}")


@pytest.fixture(scope="module")
def evaluated(pinnquad, trained, flight):
    """Exit code and what it says of the rows that trained none."""
    return pinnquad("evaluate", trained / "a/model.block", flight, "--rows", "test", "--json", code=(0, 1))


@pytest.fixture(scope="module")
def judged(evaluated):
    return json.loads(evaluated.out)


def but_the_name(text):
    return [line for line in text.splitlines() if '"model": ' not in line]


def test_judges_as_the_training_did(trained, evaluated, judged):
    report = report_of(trained / "a")
    verdict = report["verdict"]
    of_model = [row for row in report["results"] if row["model"] == verdict["model"]]
    (row,) = [row for row in of_model if row["seed"] == verdict["seed"]]
    assert {name: row[name] for name in judged["figures"]} == judged["figures"]
    assert [judged[name] for name in PLAIN] == [row["mae"], row["rmse"], row["r2"]]
    for axis in AXES:
        assert judged["pair_violations"][axis] == row[f"sign_violation_share_{axis}"], axis
        assert judged["slope_error"][axis] == row[f"slope_error_{axis}"], axis
    assert judged["rows"] == 600 and judged["airframe"] == "paper_quadrotor" and judged["golden_difference"] == 0
    assert evaluated.code == verdict["worse_than_mean"]

    # the report for scripts: its names, each figure over the seeds, and that of the exported network as evaluate has it
    assert sorted(report["models"]) == ["formula", "paper_physics_informed", "paper_vanilla"]
    exported = [row["seed"] for row in of_model].index(verdict["seed"])
    for model, seeds in {"formula": 1, "paper_vanilla": 2, "paper_physics_informed": 2}.items():
        figures = report["models"][model]
        of_all = [(name, figures[name], judged[name]) for name in PLAIN]
        for name in BY_AXIS:
            assert sorted(figures[name]) == sorted(AXES), name
            of_all += [(name, figures[name][axis], judged[name][axis]) for axis in AXES]
        for name, figure, of_one in of_all:
            assert sorted(figure) == ["deviation", "mean", "per_seed"], figure
            each = figure["per_seed"]
            assert len(each) == seeds and abs(figure["mean"] - sum(each) / seeds) <= 1e-12, (model, name, figure)
            if seeds == 1:
                assert figure["deviation"] is None, figure
            else:
                assert abs(figure["deviation"] - abs(each[0] - each[1]) / 2**0.5) <= 1e-12, figure
            if model == "paper_physics_informed":
                assert abs(each[exported] - of_one) <= 1e-6, (name, each, of_one)
    linearized = report["models"]["formula"]
    for axis in AXES:
        for figure in "wrong_derivative_share", "large_step_violations":
            assert linearized[figure][axis]["mean"] == 0, (figure, axis)
        assert 0.98 < linearized["least_derivative_over_nominal"][axis]["mean"] < 1.02, axis
    assert report["exported"] is True and report["not_exported_because"] is None
    assert report["header"] == "a/model.hpp" and report["block"] == "a/model.block"
    printed = re.findall("^train: warning: (.*)$", (trained / "stderr.txt").read_text(), re.M)
    assert report["warnings"] == printed


def test_header_as_block(pinnquad, trained, flight, evaluated):
    words = flight, "--rows", "test"
    of_header = pinnquad("evaluate", trained / "a/model.hpp", *words, "--json", code=evaluated.code)
    assert but_the_name(of_header.out) == but_the_name(evaluated.out)
    assert "Dense<25>" in pinnquad("evaluate", trained / "a/model.block", *words, code=evaluated.code).out


def test_by_another_program(trained, flight, judged):
    """Wrong derivatives on the last 20 % of rows, by differences in double of the header's network; violations among
    large steps. Features are from the flight's columns; the vehicle is the paper's."""
    header = Header(trained / "a/model.hpp")
    commands, signed_sum = header.commands(), header.sums()
    with open(flight) as file:
        rows = [list(map(float, row)) for row in list(csv.reader(file))[1:]]
    rows = rows[len(rows) * 4 // 5 :]
    assert judged["rows"] == len(rows)
    # v_dot, omega_dot, v, omega behind t
    motions = [row[1:13] + [row[13], row[14], math.sin(row[15]), math.cos(row[15])] for row in rows]
    made = [commands(x) for x in motions]
    # over the airframe's own in hover: inertia over what full thrust and full torque of the rotors turn it with
    arm_m, thrust_N = 0.243952, 0.1099 * 1.225 * (8500 / 60) ** 2 * 0.2286**4
    torque_N_m = 0.04016 * 1.225 * (8500 / 60) ** 2 * 0.2286**5 / (2 * math.pi)
    nominal = 0.01469 / (arm_m * thrust_N), 0.01686 / (arm_m * thrust_N), 0.03093 / torque_N_m
    for axis, name in enumerate(AXES):
        slopes = []
        for x in motions:
            above, below = list(x), list(x)
            above[3 + axis] += 1e-6
            below[3 + axis] -= 1e-6
            slopes.append((signed_sum(commands(above), axis) - signed_sum(commands(below), axis)) / 2e-6)
        # a row may differ: differences of rounded sums where the derivative is nearly 0, and a kink in between
        wrong = sum(slope < 0 for slope in slopes) / len(rows)
        assert abs(judged["wrong_derivative_share"][name] - wrong) <= 2 / len(rows), name
        said = judged["least_derivative_over_nominal"][name]
        assert abs(said - min(slopes) / nominal[axis]) <= 1e-3 * max(1, abs(said)), name
        asked = [row[4 + axis] for row in rows]
        mean = sum(asked) / len(asked)
        large = 0.5 * math.sqrt(sum((a - mean) ** 2 for a in asked) / (len(asked) - 1))
        flown = [row[-4:] for row in rows]
        for figure, of in ("large_step_violations", made), ("large_step_violations_flown", flown):
            sums = [signed_sum(u, axis) for u in of]
            pairs = [(b - a, d - c) for a, b, c, d in zip(asked, asked[1:], sums, sums[1:]) if abs(b - a) > large]
            share = sum(a * s < 0 for a, s in pairs) / len(pairs)
            assert abs(judged[figure][name] - share) <= 2 / len(pairs), (figure, name)


def test_of_a_dataset(pinnquad, trained, flight, dataset):
    """Told apart from a flight, and judged as it."""
    dataset("logs", {"one": flight})
    of_file, of_folder = (json.loads(pinnquad("evaluate", trained / "a/model.block", source, "--json", code=(0, 1)).out)
                          for source in (flight, "logs"))
    assert of_file["rows"] == of_folder["rows"] and of_file["rmse"] == of_folder["rmse"]
    pinnquad.refused("evaluate", trained / "a/model.block", "logs --rows test", keyword="--rows")


def test_header_without_its_block(pinnquad, trained, flight):
    """A header is taken by the block beside it, which says its hash."""
    shutil.copy(trained / "a/model.hpp", "alone.hpp")
    pinnquad.refused("evaluate alone.hpp", flight, at="alone.hpp", keyword="alone.block")
    shutil.copy(SOURCE / "examples/models/demo_quadrotor.block", "alone.block")
    pinnquad.refused("evaluate alone.hpp", flight, at="alone.block", keyword="another header")
    shutil.copy(trained / "a/model.block", "alone.block")
    pinnquad("evaluate alone.hpp", flight, code=(0, 1))


def test_worse_than_the_mean(pinnquad, trained, flight):
    """Commands that no model predicts."""

    def noise(line, cells):
        if line > 1:
            for i in range(17, 21):
                cells[i] = 0.5 + 0.4 * math.sin(line * (i + 1))

    edited(flight, "noise.csv", noise)
    done = pinnquad("evaluate", trained / "a/model.block", "noise.csv", code=1)
    assert "worse than the mean" in done.err and "model.block: " in done.err, done


def test_refused(pinnquad, trained):
    """What is no block, or no longer one, is in test_block.py."""
    pinnquad.refused("evaluate", trained / "a/model.block", "none.csv", at="none.csv", keyword="readable file")

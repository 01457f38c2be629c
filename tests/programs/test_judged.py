# SPDX-License-Identifier: MIT
"""What train takes for a flight, what it thinks worth exporting, and that what it exports compiles and flies."""
import json
import math
import os
import re
import shutil
from pathlib import Path

import pytest
from conftest import SOURCE, Program, cell, column, edited, report_of, same_bytes

TRAIN = "--epochs 1 --seeds 1"
COMMANDS = 18, 19, 20, 21
DEGREES = 57.29577951


@pytest.fixture(scope="module")
def good(flown):
    return flown("--seed 3 --samples 3000")


@pytest.mark.parametrize("place, keyword, change", [
    # numbers that no flight has
    ("500:3", "vdot_by", cell(500, 3, "1e39")), ("501:18", "u1", cell(501, 18, "1e30")),
    ("502:9", "v_by", cell(502, 9, "150")), # commands and angles in other units
    ("2:18", "(u - 1000) / 1000", column(*COMMANDS, to=lambda u: 1000 + 1000 * u)),
    ("2:18", "percent", column(*COMMANDS, to=lambda u: 100 * u)), ("2:18", "negated",
                                                                   column(*COMMANDS, to=lambda u: -u)),
    ("2:14", "degrees", column(14, 15, 16, to=lambda angle: angle * DEGREES)),
    ("2:11", "degrees per second", column(11, 12, 13, to=lambda rate: rate * DEGREES)),
    # a command that stands still
    ("2:19", "1800 training rows", column(19, to=0.5)),
    ("2402:20", "600 test rows", lambda line, cells: [*cells[:19], 0.25, *cells[20:]] if line > 2401 else None)])
def test_refused(pinnquad, good, place, keyword, change):
    """Before training: it leaves no trace in a folder that is there, and makes none."""
    Path("there").mkdir()
    edited(good, "bad.csv", change)
    for folder in ("there", "made") if keyword == "u1" else ("made",):
        pinnquad.refused(f"train bad.csv --out {folder} {TRAIN}", at=f"bad.csv:{place}", keyword=keyword)
    assert not os.listdir("there") and not Path("made").exists()


def test_refused_names(pinnquad, good):
    for name in "class", "NULL", "_Model", "my__model", "errno", "3rd", "a b":
        pinnquad.refused(f"train --out made {TRAIN}", good, "--name", name, keyword="--name")
    assert not Path("made").exists(), "a refused training left its folder"


def test_stands_still_in_some_test_rows(pinnquad, good):
    edited(good, "varies.csv", lambda line, cells: [*cells[:19], 0.25, *cells[20:]] if line > 2500 else None)
    pinnquad(f"train varies.csv --out varies {TRAIN} --allow-poor")


def test_worse_than_the_mean(pinnquad, good):
    """Results and report, no header, exit code 1 and one line; with --allow-poor a header that says so. The commands
    have nothing to do with the motion: in the test rows another mean than in the training rows."""

    def noise(line, cells):
        if line > 1:
            for i in COMMANDS:
                cells[i - 1] = (0.2 if line < 2400 else 0.8) + 0.1 * math.sin(line * i)

    edited(good, "noise.csv", noise)
    train = "train noise.csv --out {0} --epochs 2 --seeds 1"
    pinnquad.refused(train.format("poor"), code=1, keyword="worse than the mean")
    assert {"results.csv", "report.json"} <= set(os.listdir("poor"))
    assert not {"model.hpp", "model.block", "replay.txt"} & set(os.listdir("poor"))
    report = report_of("poor")
    assert report["verdict"]["worse_than_mean"] is True and report["exported"] is False
    assert "verdict do not fly: structured is worse than the mean" in pinnquad(train.format("poor") + " --allow-poor").flat
    header = Path("poor/model.hpp").read_text()
    assert re.search("^// do not fly: .*worse than the mean", "\n".join(header.split("\n")[:3]), re.M)
    assert "bool worse_than_mean = true;" in header and report_of("poor")["exported"] is True
    # one that is refused where another was exported: what there is old is named
    shutil.copytree("poor", "stale")
    os.link("stale/report.json", "held.json")  # who has the old report open keeps it whole
    line = pinnquad.refused(train.format("stale"), code=1, keyword="earlier training").lines[0]
    for file in "model.hpp", "replay.txt", "model.block":
        assert f"stale/{file}" in line
        same_bytes(f"poor/{file}", f"stale/{file}")
    same_bytes("poor/report.json", "held.json")
    assert report_of("stale")["exported"] is False


def linear(line, cells):
    """Commands that are a linear map of the motion."""
    if line > 1:
        for i in COMMANDS:
            cells[i - 1] = 0.5 + 0.01 * float(cells[i - 17]) + 0.01 * float(cells[i - 9])


def test_no_better_than_linear_regression(pinnquad, good):
    """A warning, and the fact in header and report."""
    edited(good, "linear.csv", linear)
    done = pinnquad("train linear.csv --models paper_physics_informed --out linear --epochs 3 --seeds 1")
    assert re.search("^train: warning: .*linear regression", done.err, re.M), done
    header = Path("linear/model.hpp").read_text()
    assert "bool beats_linear_regression = false;" in header
    assert float(re.search(r"linear_regression_r_squared = ([\d.]+)", header).group(1)) > 0.99999
    assert '"beats_linear_regression": false' in Path("linear/report.json").read_text()
    # the same of a structured model, whose slopes are those of no vehicle: proven, and a warning each
    err = pinnquad("train linear.csv --out sloped --epochs 3 --seeds 1 --allow-poor").err
    for axis in "roll", "yaw":
        assert re.search(f"^train: warning: .*its {axis} slope is .* --slopes pinned ", err, re.M), err
    pinnquad("certify sloped/model.hpp")


def test_pinned_slopes_on_a_noisy_flight(pinnquad, flown):
    """The model is worse than the mean, and no network that is refuted takes its place."""
    noisy = flown("--seed 3 --samples 2400 --gyro-noise 0.1")
    done = pinnquad("train --slopes pinned --out pinned --epochs 20 --seeds 2", noisy, code=1)
    assert not Path("pinned/model.hpp").exists()
    assert re.search("^train: not exported: .*--slopes learned", done.err, re.M), done
    done = pinnquad("train --out learned --epochs 20 --seeds 2", noisy)
    assert "noise of gyro or accelerometer bends the slopes" in done.err and "slope is" not in done.err, done
    pinnquad("certify learned/model.hpp")


def test_still_flight(pinnquad, good, compiler):
    """A flight at yaw 0 and one constant climb rate, from a file whose name is no text: trained, exported, compiled,
    flown."""

    def still(line, cells):
        if line > 1:
            cells[15] = cells[12] = cells[6] = 0
            cells[9] = -0.5

    name = 'yaw\udcff* "0";\n\\\n#error?\\?.csv'
    edited(good, name, still)
    for folder, words, flat in (("still_structured", "", "wdot_z, v_bz, w_z, sin_yaw, cos_yaw, w_yz, w_zx, vv_bz"),
                                ("still", "--models paper_physics_informed",
                                 "wdot_z, v_bz, w_z, sin_yaw, cos_yaw")):
        err = pinnquad(f"train --out {folder} --epochs 4 --seeds 1 --allow-poor {words}", name).err
        assert f"train: warning: {flat}: " in err, err
    pinnquad("certify still_structured/model.hpp")
    report = json.loads(Path("still/report.json").read_text(encoding="utf-8"))
    assert 'yaw?* "0";?\\?#error?\\?.csv' in (report["settings"].get("flight"), report.get("flight"))
    compiler("-O1 -trigraphs -Wall -Wextra -Werror -I.", SOURCE / "tests/programs/judged/still.cpp", "-o", "flies")
    Program("./flies")()

# SPDX-License-Identifier: MIT
"""Offline baselines beside the kinds of train (tools/study/boosting.py), on the rows that train parted. Skipped without
scikit-learn."""
import json
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from conftest import SOURCE, Program

pytestmark = pytest.mark.skipif(find_spec("sklearn") is None, reason="Debian's python3-sklearn is not installed")
boosting = Program(sys.executable, SOURCE / "tools/study/boosting.py")


def figures(out):
    """Error and R^2 of each model, those of the script and those of the report."""
    own, report = out.split("of the report\n")
    return [{line.split()[0]: [float(word) for word in line.split()[1:3]] for line in text.splitlines()[skipped:]}
            for text, skipped in ((own, 1), (report, 0))]


def test_same_rows_and_features(pinnquad, flown):
    """Ridge is solved twice, here and by the program: the same rows and features leave the same error. Trees are better
    than the mean of the commands, and extrapolate worse than what is nearly linear."""
    flights = []
    for seed in 3, 4, 5:
        flights.append(Path(shutil.copy(flown(f"--seed {seed} --samples 2400"), f"flight{seed}.csv")))
    for of in flights[:1], flights:
        pinnquad("train --models constant,ridge --out run", *of)
        done = boosting("run", *of, "--trees=60")
        own, report = figures(done.out)
        assert own["ridge"] == pytest.approx(report["ridge"], rel=0.03), done
        assert own["ridge"][0] < own["boosting"][0] < 0.3 * report["constant"][0], done
        assert 0.9 < own["boosting"][1] < 1, done
    force = figures(boosting("run", *flights, "--features=inverse", "--altitude", "--trees=1").out)[0]
    assert force["ridge"] != own["ridge"] and force["ridge"] == pytest.approx(own["ridge"], rel=0.1)


def test_refusals(pinnquad, flown):
    flight = Path(shutil.copy(flown("--seed 3 --samples 2400"), "flight.csv"))
    pinnquad("train --models ridge --out run", flight)
    boosting.refused("nowhere", flight, at="nowhere/report.json", keyword="expected JSON")
    boosting.refused("run", shutil.copy(flight, "other.csv"), keyword="the flight")
    boosting.refused("run", flight, "--window", keyword="a window needs a row every 0.02 s")
    text = flight.read_text().splitlines(keepends=True)
    flight.write_text("".join(text[:-1]))
    boosting.refused("run", flight, at="flight.csv", keyword="2400 rows")
    flight.write_text(text[0].replace("u1", "u9") + "".join(text[1:]))
    boosting.refused("run", flight, at="flight.csv", keyword="column u1")
    Path("run/report.json").write_text(json.dumps({"folds": []}))
    boosting.refused("run", flight, at="run/report.json", keyword="folds")
    assert "--trees" in boosting("run", flight, "--trees=0", code=2).err
    assert "report.json" in boosting("--help").out

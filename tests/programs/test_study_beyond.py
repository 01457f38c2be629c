# SPDX-License-Identifier: MIT
"""study beyond: a small run end to end, gone on with after rows were lost, refused where it asks for what there is
not."""
import json
import statistics
import sys
from pathlib import Path

import pytest
from conftest import SOURCE, Program, edited, table

OPTIONS = "--conditions d1,d3_5,d1_speed,d1_told_heavy --models none,inverse,structured --seeds 2 --flights 1 " \
    "--epochs 3 --threads 2"


@pytest.fixture(scope="module")
def beyond(study):
    return Program(*study.words, "beyond")


@pytest.fixture(scope="module")
def whole(beyond, tmp_path_factory):
    folder = tmp_path_factory.mktemp("beyond")
    beyond(f"{OPTIONS} --out whole", cwd=folder)
    return folder / "whole"


def test_whole(pinnquad, whole):
    """Four conditions: the paper's network and the structured model by two seeds, the formulas once."""
    rows = table(whole / "rows.csv")
    assert len(rows) == 24
    assert any(line.startswith("structured,d1_speed,101,2,3,")
               for line in (whole / "rows.csv").read_text().splitlines())
    def figure(model, condition, seed, column):
        (row,) = [row for row in rows if (row["model"], row["flight"], row["seed"]) == (model, condition, str(seed))]
        return float(row[column])

    def loop(model, condition, seed):
        return figure(model, condition, seed, "eight_rmse_m")

    # In the loop the formula given the truth flies, and the structured model as well as it. No feed-forward does not,
    # nor does the formula given wrong parameters, which the structured model does not mind.
    truth = loop("inverse", "d1", 0)
    assert loop("none", "d1", 0) > 0.1 and truth < 0.01 and loop("inverse", "d1_told_heavy", 0) > 0.05
    assert loop("structured", "d1", 1) < 1.2 * truth and loop("structured", "d1_told_heavy", 1) < 1.2 * truth
    assert figure("structured", "d1", 1, "eight_declined_share") == 0 == figure("paper", "d1", 1, "proven")
    assert figure("structured", "d1", 1, "proven") == 1
    assert figure("structured", "d1", 1, "wrong_derivative_share_roll") == 0

    # judged is what train exports: the same error on the same rows
    pinnquad("fly d1 --seed 101 --out d1.csv")
    pinnquad("train d1.csv --models structured --epochs 3 --seeds 1 --out trained")
    (trained,) = [row for row in table("trained/results.csv") if (row["model"], row["seed"]) == ("structured", "1")]
    assert abs(float(trained["mae"]) - figure("structured", "d1", 1, "mean_absolute_error")) < 1e-9


def test_reported(whole):
    """Ratios are those of the rows' means; the formula stands beside each seed of the network."""
    report = Program(sys.executable, SOURCE / "tools/study/report.py")
    said = report(whole).out
    assert "d3_5: 5 % of the rows train" in said and "Closed loop" in said
    found, rows = json.loads((whole / "report.json").read_text())["conditions"], table(whole / "rows.csv")
    for condition in "d1", "d3_5", "d1_speed", "d1_told_heavy":
        means = {model: statistics.fmean(float(row["mean_absolute_error"]) for row in rows
                                         if (row["model"], row["flight"]) == (model, condition))
                 for model in ("inverse", "structured", "paper")}
        for model in "inverse", "structured":
            pair = found[condition][model]["mean_absolute_error"]
            assert pair["ratio"] == pytest.approx(means[model] / means["paper"], rel=1e-12) and pair["pairs"] == 2
            assert pair["wins"] == (2 if pair["ratio"] < 1 else 0) and pair["p_value"] == 0.5, pair
    page = (whole / "report.html").read_text()
    assert page.count("<figure>") == 6 and "{{" not in page and "told mass and inertia 10 % too large" in page
    Path("bad").mkdir()
    Path("bad/study.json").write_text((whole / "study.json").read_text())
    for column, value, keyword in (0, "unheard_of", "unheard_of"), (6, "soon", '"soon"'), (3, "x", "a seed"):
        edited(whole / "rows.csv", "bad/rows.csv",
               lambda line, cells: cells.__setitem__(column, value) if line == 3 else None)
        report.refused("bad", at="bad/rows.csv", keyword=keyword)
    assert not Path("bad/report.html").exists()


def test_gone_on_with(beyond, whole):
    rows = (whole / "rows.csv").read_text().splitlines()
    Path("again").mkdir()
    Path("again/study.json").write_text((whole / "study.json").read_text())
    Path("again/rows.csv").write_text("\n".join([*rows[:5], ""]))
    assert "24 of 24 trainings are in again/rows.csv, 4 of them from before" in beyond(f"{OPTIONS} --out again").out
    again = Path("again/rows.csv").read_text().splitlines()
    assert [row.rsplit(",", 1)[0] for row in again] == [row.rsplit(",", 1)[0] for row in rows]


@pytest.mark.parametrize("words, keyword", [("--conditions d9 --out no", "'d9'"), ("--models x --out no", "'x'"),
                                            ("--seeds 1", "--out")])
def test_refused(beyond, words, keyword):
    beyond.refused(words, keyword=keyword)
    assert not Path("no").exists()

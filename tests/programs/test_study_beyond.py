# SPDX-License-Identifier: MIT
"""study beyond: a small run end to end, gone on with after rows were lost, refused where it asks for what there is
not."""
from pathlib import Path

import pytest
from conftest import Program, table

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
    for file in "beyond.html", "beyond.json", "study.json":
        assert (whole / file).stat().st_size, file
    assert '"ratio":' in (whole / "beyond.json").read_text()

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
    pinnquad("train d1.csv --recipe structured --loss vanilla --epochs 3 --seeds 1 --out trained")
    (trained,) = [row for row in table("trained/results.csv") if (row["model"], row["seed"]) == ("structured", "1")]
    assert abs(float(trained["mae"]) - figure("structured", "d1", 1, "mean_absolute_error")) < 1e-9


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

# SPDX-License-Identifier: MIT
"""A study of one's own: rows that a stopped run keeps, tests by pair, figure and table."""
import csv
import functools

import numpy as np
import pytest

import pinnquad
from pinnquad import study

pytest.importorskip("joblib")
stats = pytest.importorskip("scipy.stats")


@pytest.fixture(scope="module")
def flown():
    return pinnquad.fly("d1", seed=2, rows=2400)


def noisy(size):
    """The structured features' least squares, with an error of that size: a contender whose rank is known."""
    def contender(parts, seed):
        X, y = parts.train.motion, parts.train.commands
        weights = np.linalg.lstsq(np.c_[X, np.ones(len(X))], y, rcond=None)[0]
        predicted = np.c_[parts.test.motion, np.ones(len(parts.test.motion))] @ weights
        return predicted + size * np.random.default_rng(seed).standard_normal(predicted.shape)
    return contender


@pytest.fixture(scope="module")
def run(flown, tmp_path_factory):
    contenders = {"good": noisy(0.001), "bad_one": noisy(0.05), "same": noisy(0.001)}
    return study.run(contenders, flown, tmp_path_factory.mktemp("study"), seeds=8, jobs=2)


def test_rows_are_worked_out_by_hand(run, flown):
    assert [(row["contender"], row["seed"]) for row in run.rows] == [
        (name, seed) for name in ("good", "bad_one", "same") for seed in range(1, 9)]
    train, validation, test = map(study.Part, pinnquad.split(flown))
    off = noisy(0.05)(study.Parts(train, validation, test), 3) - test.commands
    row = run.rows[10]
    assert row["mean_absolute_error"] == pytest.approx(np.abs(off).mean(), rel=1e-12)
    assert row["r2_u2"] == pytest.approx(1 - (off[:, 1]**2).sum() / (len(off) * test.commands[:, 1].var()), rel=1e-9)
    assert test.motion.shape == (480, 16) and train.commands.shape == (1440, 4)


def test_pairs_are_tested(run):
    bad, same = run.compare()
    assert bad.contender == "bad_one" and bad.pairs == 8 and bad.difference > 0.005
    assert bad.p_value == pytest.approx(2 / 2**8)  # all eight of one sign: the least that Wilcoxon's test has
    assert bad.p_holm == bad.p_value and np.isnan(same.p_value)  # equal to the reference: nothing to rank
    assert (bad.why_no_p, same.why_no_p) == ("", "none: equal errors") and "none: equal errors" in run.to_latex()
    assert bad.p_value == stats.wilcoxon([row["mean_absolute_error"] for row in run.rows[8:16]],
                                         [row["mean_absolute_error"] for row in run.rows[:8]]).pvalue


def test_holm_corrects_for_as_many(flown, tmp_path):
    contenders = {"reference": noisy(0.01)}
    contenders.update({f"one {i}": noisy(0.01 * (1 + i)) for i in (1, 2, 3)})
    compared = study.run(contenders, flown, tmp_path / "study", seeds=7).compare()
    assert [one.p_holm for one in compared] == pytest.approx([3 * 2 / 2**7] * 3)


def test_files(run):
    pytest.importorskip("matplotlib")
    table, latex, svg, pdf = run.save()
    with open(table, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 24 and float(rows[10]["rmse"]) == run.rows[10]["rmse"]
    text = latex.read_text()
    assert text.count("\\\\") == 4 and "bad\\_one" in text and "0.0078" in text and text.count("\\textbf") == 2
    assert b"<svg" in svg.read_bytes() and pdf.read_bytes().startswith(b"%PDF")
    assert len(run.to_frame()) == 24


def test_a_stopped_run_goes_on(flown, tmp_path):
    asked = []

    def contender(parts, seed):
        asked.append(seed)
        if seed == 3 and len(asked) < 4:
            raise RuntimeError("out of memory")
        return parts.test.commands + 0.01 * seed

    with pytest.raises(RuntimeError, match="out of memory"):
        study.run({"own": contender}, flown, tmp_path / "study", seeds=4)
    first = study.run({"own": contender}, flown, tmp_path / "study", seeds=4)
    assert asked == [1, 2, 3, 3, 4]
    again = study.run({"own": contender}, flown, tmp_path / "study", seeds=[2, 4])
    assert asked == [1, 2, 3, 3, 4] and again.rows == [first.rows[1], first.rows[3]]

    step = 0.02

    def contender(parts, seed):  # another text: made anew
        asked.append(-seed)
        return parts.test.commands + step * seed

    study.run({"own": contender}, flown, tmp_path / "study", seeds=1)
    assert asked[-1] == -1
    step = 0.03  # another number: made anew
    study.run({"own": contender}, flown, tmp_path / "study", seeds=1)
    study.run({"own": contender}, flown, tmp_path / "study", seeds=1)
    assert asked[-3:] == [4, -1, -1]
    with pytest.raises(ValueError, match="found one of others"):
        study.run({"own": contender}, pinnquad.fly(rows=2400, seed=9), tmp_path / "study", seeds=1)


def test_rows_of_other_settings_are_made_anew(flown, tmp_path):
    chosen = (1, "paper_quadrotor"), (2, "paper_quadrotor"), (2, "racer_5_inch"), (2, pinnquad.Airframe("racer_5_inch"))
    rows = [study.run({"s": "structured"}, flown, tmp_path, seeds=1, epochs=epochs, airframe=airframe).rows[0]
            for epochs, airframe in chosen]
    assert rows[0] != rows[1] != rows[2] == rows[3]  # each has its own time
    asked = []

    def shifted(parts, seed, step):
        asked.append(step)
        return parts.test.commands + step

    textless = eval("lambda parts, seed: shifted(parts, seed, 0)", {"shifted": shifted})
    for own in [functools.partial(shifted, step=step) for step in (0.1, 0.2, 0.2)] + [textless, textless]:
        assert study.run({"own": own}, flown, tmp_path, seeds=1).rows[0]["mean_absolute_error"] == pytest.approx(asked[-1])
    assert asked == [0.1, 0.2, 0, 0]


def test_flights_are_others_by_column_and_by_border(flown, tmp_path):
    def require(*flights):
        study.run({"own": noisy(0.01)}, flights, tmp_path, seeds=1)

    parts = [pinnquad.Flight(flown.rows[rows], str(rows)) for rows in (slice(1200), slice(1200, 2400))]
    require(flown)
    for others in ([pinnquad.Flight(flown.rows, columns=[("pack", "V", flown.time_s)])], parts):
        with pytest.raises(ValueError, match="found one of others"):
            require(*others)


def test_a_backend_of_joblib_is_used(flown, tmp_path):
    import joblib
    with joblib.parallel_backend("threading", n_jobs=3):
        result = study.run({"own": noisy(0.01)}, flown, tmp_path / "study", seeds=6)
    assert [row["seed"] for row in result.rows] == [1, 2, 3, 4, 5, 6]
    assert not list((tmp_path / "study").glob("**/*.part"))


def test_models_of_the_library_and_of_blocks(flown, structured, tmp_path):
    names = {"structured": "structured", "paper": "paper_vanilla", "block": lambda parts, seed: structured}
    result = study.run(names, flown, tmp_path / "study", seeds=2, epochs=2)
    error = {row["contender"]: row["mean_absolute_error"] for row in result.rows}
    training = pinnquad.train(flown, models=["structured"], seeds=1, seed=2, epochs=2, lag_s=0.0)
    assert error["structured"] == pytest.approx(training.figures["structured"]["mean_absolute_error"]["mean"], rel=1e-6)
    assert 0 < error["structured"] < error["paper"] and error["block"] < 0.05


@pytest.mark.parametrize("contender, words", [
    (lambda parts, seed: np.zeros((3, 4)), r"'own': expected finite commands of shape \(480, 4\), found \(3, 4\)"),
    (lambda parts, seed: np.full((480, 4), np.nan), "not finite"), ("paper_magic", "no model of that name")])
def test_contenders_that_answer_nothing(flown, tmp_path, contender, words):
    with pytest.raises(ValueError, match=words):
        study.run({"own": contender}, flown, tmp_path / "study", seeds=1)
    assert not list((tmp_path / "study" / "rows").glob("*.json"))


def test_a_reference_that_is_none(flown, tmp_path):
    for contenders, reference in (({}, None), ({"structured": "structured"}, "mine")):
        with pytest.raises(ValueError, match="reference: expected one of"):
            study.run(contenders, flown, tmp_path / "study", reference=reference)
    assert not (tmp_path / "study").exists()

# SPDX-License-Identifier: MIT
"""Training from Python: the bytes that the program writes, figures, refusals."""
import numpy as np
import pytest

import pinnquad
from pinnquad import Flight


def test_the_model_is_proven_and_good(trained, flight):
    assert trained.kind == "structured" and trained.r2 > 0.98
    assert pinnquad.certify(trained.model).proven
    judged = pinnquad.evaluate(trained.model, flight, "test")
    assert judged.r2 == pytest.approx(trained.r2, abs=1e-9)
    figures = trained.figures["structured"]
    assert figures["r2"]["mean"] == trained.r2 and figures["wrong_derivative_share"]["roll"]["mean"] == 0
    assert "structured" in trained.figures


@pytest.mark.parametrize("models", ["formula,paper_vanilla,structured", "paper_physics_informed"])
def test_the_bytes_of_the_program(program, flight, tmp_path, models):
    flight.save(tmp_path / "flight.csv")
    program("train", tmp_path / "flight.csv", "--models", models, "--seeds", 2, "--epochs", 2, "--out",
            tmp_path / "theirs", "--allow-poor")
    training = pinnquad.train(Flight.read(tmp_path / "flight.csv"), models=models.split(","), seeds=2, epochs=2)
    files = training.save(tmp_path / "ours", allow_poor=True)
    assert [file.rsplit("/")[-1] for file in files][:2] == ["model.hpp", "model.block"]
    for name in ("model.hpp", "model.block", "trust.hpp"):
        ours, theirs = tmp_path / "ours" / name, tmp_path / "theirs" / name
        assert ours.exists() == theirs.exists(), name
        same = not ours.exists() or ours.read_bytes() == theirs.read_bytes()
        assert same, name  # of whole headers pytest would look for the differences for minutes


def test_saved_and_loaded(trained, flight, tmp_path):
    trained.save(tmp_path / "model", "MyModel")
    assert "struct MyModel" in (tmp_path / "model/model.hpp").read_text()
    model = pinnquad.Model.load(tmp_path / "model/model.block")
    assert model.name == "MyModel"
    x = model.features(flight)
    np.testing.assert_array_equal(model.predict(x), trained.model.predict(x))


def test_whole_flights_are_held_out_by_name():
    flights = [Flight(pinnquad.fly(seed=seed, rows=1000).rows, f"flight {seed}") for seed in (1, 2, 3)]
    by_order = pinnquad.train(flights, models=["structured"], seeds=1, epochs=1)
    by_name = pinnquad.train(flights, models=["structured"], seeds=1, epochs=1, hold_out=["flight 1"])
    assert by_order.r2 != by_name.r2 and min(by_order.r2, by_name.r2) > 0.95
    with pytest.raises(ValueError, match="flight 9"):
        pinnquad.train(flights, hold_out=["flight 9"])


@pytest.mark.parametrize("arguments, words", [
    ({"models": ["paper_magic"]}, "no model of that name; nearest: paper_"),
    ({"seeds": 0}, "seeds must be"), ({"epochs": 0}, "epochs must be"), ({"threads": 5000}, "threads must be"),
    ({"slopes": "steep"}, "no slopes named"), ({"slopes": "pinned", "models": ["paper_vanilla"]}, "are of structured models"),
    ({"lag_s": float("nan")}, "lag_s"), ({"airframe": "kite"}, "kite")])
def test_choices_that_make_no_sense(flight, arguments, words):
    with pytest.raises(ValueError, match=words) as caught:
        pinnquad.train(flight, **arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["seeds", "epochs", "seed", "threads"])
def test_numbers_that_are_not_whole(flight, name):
    for wrong in (2.7, np.float32(2.7), np.float64(2), "2"):
        with pytest.raises(TypeError):
            pinnquad.train(flight, models=["structured"], **{name: wrong})


def test_parts_are_those_of_train(flight):
    parts = pinnquad.split(flight)
    np.testing.assert_array_equal(np.concatenate([part[0].rows for part in parts]), flight.rows)
    assert [part.rows for part in parts] == [1440, 480, 480]
    flights = [Flight(pinnquad.fly(seed=seed, rows=100).rows, f"flight {seed}") for seed in range(1, 6)]
    assert [[one.name for one in part] for part in pinnquad.split(flights)][2] == ["flight 5"]


def test_flights_that_nobody_should_train_on(flight):
    with pytest.raises(ValueError, match="2200 rows or more to train on, found 100"):
        pinnquad.train(Flight(flight.rows[:100]))
    still = flight.rows.copy()
    still[:, 17:] = 0.5
    with pytest.raises((ValueError, pinnquad.Error)):
        pinnquad.train(Flight(still, "still"))
    degrees = flight.rows.copy()
    degrees[:, 13:16] *= 57.3
    with pytest.raises(pinnquad.Error, match="degrees:"):
        pinnquad.train(Flight(degrees, "degrees"))
    for wrong in (None, 3, [], "flight.csv", [flight, 3]):
        with pytest.raises((TypeError, ValueError)):
            pinnquad.train(wrong)


def test_limits_of_another_model_do_not_stay(flight, tmp_path):
    (tmp_path / "trust.hpp").write_text("another model's")
    training = pinnquad.train(flight, models=["paper_vanilla"], seeds=1, epochs=1)
    assert [path.rsplit("/")[-1] for path in training.save(tmp_path, allow_poor=True)] == ["model.hpp", "model.block"]
    assert not (tmp_path / "trust.hpp").exists()


def test_nothing_is_half_written(trained, tmp_path):
    with pytest.raises(ValueError, match="identifier"):
        trained.save(tmp_path / "model", "my-model")
    assert not (tmp_path / "model").exists()
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError):
        trained.save(tmp_path / "file")

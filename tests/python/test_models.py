# SPDX-License-Identifier: MIT
"""Models of blocks: one motion and many, the guard, figures and proofs as the program says them, hostile arrays."""
import inspect
import json
import pickle
import threading

import numpy as np
import pytest
from conftest import MODELS

import pinnquad
from pinnquad import Model, Status


def inside(model, rows, seed=1):
    """Motions in the model's envelope."""
    lower, upper = model.envelope
    return np.random.default_rng(seed).uniform(lower, upper, (rows, len(lower)))


def test_one_and_many_are_the_same_bits(structured, network):
    for model in (structured, network):
        x = inside(model, 700)
        many = model.predict(x)
        assert many.shape == (700, 4) and many.dtype == np.float32
        np.testing.assert_array_equal(many, [model.predict(row) for row in x])
        np.testing.assert_array_equal(many, model.predict(x.astype(np.float32)))
        np.testing.assert_array_equal(many[:3], model.predict(x[:3].tolist()))
        assert model.predict(x[:0]).shape == (0, 4)


def test_features_of_a_flight_give_its_commands(structured, flight):
    x = structured.features(flight)
    assert x.shape == (len(flight), len(structured.feature_names))
    np.testing.assert_allclose(x[:, structured.feature_names.index("wdot_y")],
                               flight.angular_acceleration_rad_s2[:, 1], rtol=1e-6)
    assert np.abs(structured.predict(x) - flight.commands).mean() < 0.02


def test_the_guard(structured):
    x = inside(structured, 5)
    x[1, 3] = np.nan
    x[2, 0] = np.inf
    x[3] = structured.envelope[1] + 1e3
    commands, statuses = structured.predict_guarded(x)
    assert [Status(s) for s in statuses] == [Status.ok, Status.not_finite, Status.not_finite, Status.outside_envelope,
                                             Status.ok]
    np.testing.assert_array_equal(np.isnan(commands).any(axis=1), statuses != 0)
    np.testing.assert_array_equal(commands[[0, 4]], structured.predict(x[[0, 4]]))
    one, status = structured.predict_guarded(x[1])
    assert status == Status.not_finite and np.isnan(one).all()


@pytest.mark.parametrize("wrong, error, words", [
    (lambda x: x[:, :-1], ValueError, r"expected shape \(19,\) or \(rows, 19\), found \(8, 18\)"),
    (lambda x: x[None], ValueError, "expected shape"), (lambda x: x[0, 0], ValueError, "expected shape"),
    (lambda x: x > 0, TypeError, "expected numbers .*, found bool"), (lambda x: x + 0j, TypeError, "found complex128"),
    (lambda x: x.astype("datetime64[us]"), TypeError, "found datetime64"),
    (lambda x: x.astype(str), TypeError, "found <U"), (lambda x: x.astype(object), TypeError, "found object"),
    (lambda x: "motion", TypeError, "expected numbers"), (lambda x: None, TypeError, "expected numbers"),
    (lambda x: np.ma.masked_less(x, x.max()), ValueError, "expected numbers without a mask, found 151 masked"),
    (lambda x: [[1.0], [1.0, 2.0]], (TypeError, ValueError), "expected"),
    (lambda x: np.where(np.arange(19) == 4, np.nan, x), ValueError, "row 0, feature 4: expected a finite number"),
    (lambda x: np.zeros(3, [("a", "f8")]), ValueError, "expected a column 's_z', found a")])
def test_arrays_that_are_no_motions(structured, wrong, error, words):
    x = inside(structured, 8)
    for ask in (structured.predict, structured.predict_guarded):
        if "finite" in words and ask == structured.predict_guarded:
            continue
        with pytest.raises(error, match=words) as caught:
            ask(wrong(x))
        assert "\n" not in str(caught.value)


def test_memory_in_any_order_is_copied(structured):
    x = inside(structured, 8)
    expected = structured.predict(x)
    for given in (np.asfortranarray(x), np.repeat(x, 2, axis=0)[::2], x.astype(">f8"), np.ma.array(x), x.tolist()):
        np.testing.assert_array_equal(structured.predict(given), expected)
        np.testing.assert_array_equal(structured.predict_guarded(given)[0], expected)
    np.testing.assert_array_equal(structured.predict(np.rint(x).astype(int)), structured.predict(np.rint(x)))


def test_answers_go_into_an_array_that_is_given(structured, network):
    """Of one motion and of many; in place of the answer's own memory."""
    for model in (structured, network):
        x = inside(model, 8)
        expected = model.predict(x)
        for kind in (np.float64, np.float32):
            out = np.full(4, 7, np.float32)
            for row, commands in zip(x.astype(kind), model.predict(x.astype(kind))):
                assert model.predict(row, out=out) is out
                np.testing.assert_array_equal(out, commands)
        for out in (np.empty((8, 4)), np.empty((8, 4), np.float32), np.empty((8, 8), np.float32)[:, ::2]):
            assert model.predict(x, out=out) is out
            np.testing.assert_array_equal(out, expected)
        for row in (x[0], x[0].astype(">f8"), np.repeat(x[0], 2)[::2], x[0].tolist()):
            np.testing.assert_array_equal(model.predict(row, out=out[1]), expected[0])
            np.testing.assert_array_equal(Model.predict(model, features=row, out=None), expected[0])


@pytest.mark.parametrize("out, error, found", [
    (np.zeros(3, "f4"), ValueError, r"\(3,\), float32"), (np.zeros((1, 4), "f4"), ValueError, r"\(1, 4\), float32"),
    (np.zeros(4, "f2"), ValueError, r"\(4,\), float16"), (np.zeros(4, int), ValueError, r"\(4,\), int64"),
    (np.zeros(4, "c8"), ValueError, r"\(4,\), complex64"), ([0, 0, 0, 0], TypeError, "list"), ("u", TypeError, "str"),
    (np.broadcast_to(np.float32(0), 4), ValueError, r"\(4,\), float32, read-only")])
def test_arrays_that_take_no_answer(network, out, error, found):
    words = r"^predict: out: expected an array of shape \(4,\), float32 or float64, that may be written to, found " + found
    with pytest.raises(error, match=words + "$"):
        network.predict(inside(network, 1)[0], out=out)


def test_what_is_refused_leaves_the_array_that_is_given(network):
    x, out = inside(network, 1)[0], np.full(4, 7, np.float32)
    for at, number in ((3, np.nan), (15, -np.inf)):
        wrong = x.copy()
        wrong[at] = number
        with pytest.raises(ValueError, match=f"row 0, feature {at}: expected a finite number, found {number}"):
            network.predict(wrong, out=out)
    for arguments, named in (((), {}), ((x, out), {}), ((x,), {"into": out}), ((x,), {"features": x}), ((x[:5],), {"out": out})):
        with pytest.raises((TypeError, ValueError)):
            network.predict(*arguments, **named)
    assert (out == 7).all()
    with pytest.raises(TypeError):
        Model.predict(out, x)
    assert str(inspect.signature(Model.predict)) == "(self, /, features, *, out=None)"


def test_columns_go_by_name(structured):
    """In any order, among others: of a structured array, of a DataFrame."""
    pandas = pytest.importorskip("pandas")
    x, names = inside(structured, 8), structured.feature_names
    expected = structured.predict(x)
    fields = np.zeros(8, [(name, "f8") for name in reversed(names)] + [("note", "i4")])
    for name, column in zip(names, x.T):
        fields[name] = column
    np.testing.assert_array_equal(structured.predict(fields), expected)
    frame = pandas.DataFrame(fields, index=range(10, 18))
    commands = structured.predict(frame)
    assert list(commands.columns) == ["u1", "u2", "u3", "u4"] and list(commands.index) == list(range(10, 18))
    np.testing.assert_array_equal(commands, expected)
    assert list(structured.predict_guarded(frame)[0].columns) == ["u1", "u2", "u3", "u4"]
    with pytest.raises(ValueError, match="expected a column 'w_x', found"):
        structured.predict(frame.drop(columns="w_x"))


def test_pickles_and_files(structured, tmp_path):
    x = inside(structured, 10)
    structured.save(tmp_path / "a.block")
    assert (tmp_path / "a.block").read_bytes() == (MODELS / "structured_quadrotor.block").read_bytes()
    for again in (Model.load(tmp_path / "a.block"), pickle.loads(pickle.dumps(structured)),
                  Model.of_bytes(structured.to_bytes())):
        np.testing.assert_array_equal(again.predict(x), structured.predict(x))
    assert structured.airframe == pinnquad.Airframe("paper_quadrotor")


def test_blocks_that_are_none(structured, tmp_path):
    whole = structured.to_bytes()
    random = np.random.default_rng(3)
    for broken in [b"", b"x", whole[:100], whole[:-1], whole + b"", bytes(len(whole))] + [
            whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1:] for at in random.integers(0, len(whole), 200)]:
        if broken == whole:
            continue
        with pytest.raises(pinnquad.Error, match="expected .*, found") as caught:
            Model.of_bytes(broken)
        assert "\n" not in str(caught.value)
    with pytest.raises(pinnquad.Error, match="nothing.block"):
        Model.load(tmp_path / "nothing.block")
    for wrong in (None, 3, "text"):
        with pytest.raises((TypeError, pinnquad.Error)):
            Model.of_bytes(wrong)
    with pytest.raises(TypeError):
        Model()


def test_evaluate_says_what_the_program_says(program, structured, flight, tmp_path):
    flight.save(tmp_path / "flight.csv")
    for rows in ("all", "test"):
        said = json.loads(program("evaluate", MODELS / "structured_quadrotor.block",
                                  tmp_path / "flight.csv", "--rows", rows, "--json"))
        ours = pinnquad.evaluate(structured, flight, rows)
        for name in ("r2", "mean_absolute_error", "wrong_derivative_share", "rows", "rows_outside_envelope"):
            assert getattr(ours, name) == said[name], name
        assert ours.report.keys() == said.keys() and ours.report["verdict"] == said["verdict"]


def test_certify(program, structured, network):
    proven = pinnquad.certify(structured)
    assert proven.report == json.loads(program("certify", MODELS / "structured_quadrotor.block", "--json"))
    assert proven.proven and min(proven.slope.values()) > 0
    refuted = pinnquad.certify(network, seconds=20)
    assert refuted.verdict == "counterexample" and not refuted.proven and refuted.slope is None
    found = refuted.counterexample
    assert found["signed_sum_after_step"] < found["signed_sum"]
    x = np.array([found["features"][name] for name in network.feature_names])
    more = x.copy()
    more[[network.feature_names.index(name) for name in found["moved"]]] += found["step"]
    signs = {"roll": [-1, 1, 1, -1], "pitch": [1, -1, 1, -1], "yaw": [1, 1, -1, -1]}[found["axis"]]
    before, after = network.predict(np.stack([x, more])).astype(float) @ signs
    assert before - after == pytest.approx(found["signed_sum"] - found["signed_sum_after_step"], abs=1e-5)


def test_questions_that_make_no_sense(structured, flight):
    with pytest.raises(ValueError, match="no rows named 'some'; known: all, test"):
        pinnquad.evaluate(structured, flight, "some")
    with pytest.raises(ValueError, match="seconds"):
        pinnquad.certify(structured, seconds=float("nan"))
    with pytest.raises(TypeError):
        pinnquad.evaluate(flight, structured)


def test_many_threads_ask_one_model(network):
    x = inside(network, 20000)
    answers = [None] * 4

    def ask(i):
        answers[i] = network.predict(x)

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    for answer in answers[1:]:
        np.testing.assert_array_equal(answer, answers[0])

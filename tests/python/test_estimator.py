# SPDX-License-Identifier: MIT
"""The structured model as scikit-learn's regressors are: parameters, clones, tables by name, its own checks."""
import pickle

import numpy as np
import pytest

import pinnquad
from pinnquad import Flight, StructuredInverse

pandas = pytest.importorskip("pandas")
sklearn = pytest.importorskip("sklearn")
metrics = pytest.importorskip("sklearn.metrics")


@pytest.fixture(scope="module")
def fitted(flight):
    return StructuredInverse(epochs=2, lag_s=0.0).fit(flight)


def test_it_is_the_model_of_train(fitted, flight):
    training = pinnquad.train(flight, models=["structured"], seeds=1, epochs=2, lag_s=0.0)
    assert fitted.model_.to_bytes() == training.model.to_bytes()
    assert fitted.r2_ == training.r2 and fitted.linear_regression_r2_ == training.linear_regression_r2
    np.testing.assert_array_equal(fitted.predict(flight), training.model.predict(training.model.features(flight)))
    assert fitted.score(flight) > 0.99


def test_fit_returns_self_and_parameters_are_kept(flight):
    estimator = StructuredInverse(epochs=1)
    assert estimator.fit(flight) is estimator
    assert estimator.get_params()["epochs"] == 1 and estimator.set_params(epochs=2).epochs == 2
    with pytest.raises(ValueError, match="Invalid parameter"):
        estimator.set_params(layers=3)
    again = sklearn.base.clone(estimator)
    assert again.get_params() == estimator.get_params() and not hasattr(again, "model_")
    with pytest.raises(sklearn.exceptions.NotFittedError, match="not fitted"):
        again.predict(flight)


def test_arrays_and_frames(fitted, flight):
    """The same rows in any clothes: the same model, the same commands."""
    X, y = flight.rows[:, 1:17], flight.rows[:, 17:]
    expected = fitted.predict(flight)
    as_arrays = StructuredInverse(epochs=2, lag_s=0.0).fit(X, y)
    np.testing.assert_allclose(as_arrays.predict(X), expected, atol=1e-6)
    frame = flight.to_frame()[["u2", "u1", "u4", "u3"] + list(Flight.column_names[16::-1])].assign(note=1.0)
    as_frame = StructuredInverse(epochs=2, lag_s=0.0).fit(frame)
    for given in (frame.set_index(np.arange(5, 5 + len(frame))), frame.drop(columns=["u1", "u2", "u3", "u4", "t"])):
        commands = as_frame.predict(given)
        assert list(commands.columns) == ["u1", "u2", "u3", "u4"] and list(commands.index) == list(given.index)
        np.testing.assert_allclose(commands, expected, atol=1e-6)
    assert as_frame.n_features_in_ == 16 and list(as_frame.feature_names_in_) == list(Flight.column_names[1:17])
    assert as_arrays.score(X, y) == pytest.approx(fitted.score(flight), abs=1e-6)
    assert as_arrays.score(X, y) == pytest.approx(metrics.r2_score(y, as_arrays.predict(X)), abs=1e-9)
    np.testing.assert_allclose(fitted.predict(X[:1]), expected[:1], atol=1e-6)


@pytest.mark.parametrize("X, y, words", [
    (lambda f: f.rows[:, 1:16], lambda f: f.commands, r"X: expected N x 16, .* found shape \(2400, 15\)"),
    (lambda f: f.rows[:, 1:17], lambda f: f.commands[:9], "y: expected 2400 rows, found 9"),
    (lambda f: f.rows[:, 1:17], lambda f: None, "y is missing"),
    (lambda f: f, lambda f: f.commands, "flights have their commands"),
    (lambda f: f.to_frame().drop(columns="wdot_x"), lambda f: None, "expected a column 'wdot_x'"),
    (lambda f: np.where(f.rows[:, 1:17] == f.rows[7, 3], np.nan, f.rows[:, 1:17]), lambda f: f.commands, "row 7, column vdot_bz"),
    (lambda f: np.ma.masked_less(f.rows[:, 1:17], 0), lambda f: f.commands, "without a mask"),
    (lambda f: f.rows[:99, 1:17], lambda f: f.commands[:99], "2200 rows or more")])
def test_rows_that_are_none(flight, X, y, words):
    with pytest.raises(ValueError, match=words) as caught:
        StructuredInverse(epochs=1).fit(X(flight), y(flight))
    assert "\n" not in str(caught.value)


def test_pickled_it_predicts(fitted, flight, tmp_path):
    again = pickle.loads(pickle.dumps(fitted))
    np.testing.assert_array_equal(again.predict(flight), fitted.predict(flight))
    with pytest.raises(ValueError, match="model_.save"):
        again.save(tmp_path / "model")
    assert [path.rsplit("/")[-1] for path in fitted.save(tmp_path / "model")][:2] == ["model.hpp", "model.block"]


def test_cross_validation_and_search(flight):
    """A search over a parameter, in order of time."""
    from sklearn.model_selection import GridSearchCV, TimeSeriesSplit
    long = pinnquad.fly("d1", seed=5, rows=5000)
    X, y = long.rows[:, 1:17], long.rows[:, 17:]
    search = GridSearchCV(StructuredInverse(epochs=1, lag_s=0.0), {"slopes": ["learned", "pinned"]},
                          cv=TimeSeriesSplit(2, max_train_size=3000, test_size=1000), error_score="raise")
    search.fit(X, y)
    assert search.best_score_ > 0.97 and set(search.cv_results_["param_slopes"]) == {"learned", "pinned"}


@pytest.mark.parametrize("check", [
    "check_parameters_default_constructible", "check_get_params_invariance", "check_set_params",
    "check_no_attributes_set_in_init", "check_estimators_unfitted"])
def test_checks_of_scikit_learn(check):
    """Those whose data are not random rows of two features, which no quadrotor flew."""
    from sklearn.utils import estimator_checks
    if not hasattr(estimator_checks, check):
        pytest.skip(f"this scikit-learn has no {check}")
    getattr(estimator_checks, check)("StructuredInverse", StructuredInverse())

# SPDX-License-Identifier: MIT
"""The structured model as a regressor of scikit-learn, for pipelines, searches and cross-validation."""
import inspect

import numpy as np

from ._core import Dataset, Flight, train
from .arrays import COMMANDS, by_name, commands_like, is_frame, plain

try:
    from sklearn.base import BaseEstimator, RegressorMixin
    from sklearn.exceptions import NotFittedError
except ImportError:

    class BaseEstimator:
        """get_params() and set_params() as scikit-learn has them, where it is not installed."""

        def get_params(self, deep=True):
            """The arguments of the constructor, by name."""
            return {name: getattr(self, name) for name in inspect.signature(type(self)).parameters}

        def set_params(self, **parameters):
            """Sets some of them, and returns the estimator."""
            for name, value in parameters.items():
                if name not in self.get_params():
                    raise ValueError(f"Invalid parameter {name!r}; known: {', '.join(self.get_params())}")
                setattr(self, name, value)
            return self

        def __getstate__(self):
            return dict(self.__dict__)

    class RegressorMixin:
        """Marks a regressor."""

    class NotFittedError(ValueError, AttributeError):
        """predict() before fit()."""

MOTION = Flight.column_names[1:17]  #: columns of X


def _are_flights(given):
    return isinstance(given, (Flight, Dataset)) or (isinstance(given, (list, tuple)) and len(given) > 0 and
                                                    all(isinstance(one, Flight) for one in given))


class StructuredInverse(RegressorMixin, BaseEstimator):
    """The inverse dynamics whose slopes are proven: motion in, four motor commands out.

    `fit(flights)` takes a Flight, a Dataset or a list of flights. `fit(X, y)` takes rows of one flight in time order:
    X is N x 16, the columns `StructuredInverse.motion_names` (SI units, body FRD, world NED; Flight documents them), y is
    N x 4, commands from 0 to 1. X and y are arrays, by place, or DataFrames, by column name. The last fifth of one flight,
    or whole flights at the end, are held out to judge the model; 2,200 rows are the fewest.

    airframe   what flew: an Airframe, a name, or a TOML file
    step_s     time between the rows of X, s; flights have times of their own
    seeds, epochs, seed, hold_out, altitude, slopes, lag_s, threads: of pinnquad.train()

    After fit: flight_verdict_ (may it fly? a FlightVerdict), model_ (a Model), training_ (a Training, which saves the header;
    not pickled), r2_ and linear_regression_r2_ (of the commands on the rows held out), n_features_in_, feature_names_in_.
    """

    motion_names, command_names = MOTION, COMMANDS

    def __init__(self, airframe="paper_quadrotor", *, step_s=0.05, seeds=1, epochs=None, seed=1, hold_out=(), altitude=None,
                 slopes="learned", lag_s=None, threads=None):
        self.airframe, self.step_s, self.seeds, self.epochs, self.seed = airframe, step_s, seeds, epochs, seed
        self.hold_out, self.altitude, self.slopes, self.lag_s, self.threads = hold_out, altitude, slopes, lag_s, threads

    def fit(self, X, y=None):
        """Learns, and returns the estimator. Raises ValueError or pinnquad.Error, one line."""
        flights = X if _are_flights(X) else self._flight(X, y)
        if flights is X and y is not None:
            raise ValueError("y: expected none, for flights have their commands")
        self.training_ = train(flights, self.airframe, models=["structured"], seeds=self.seeds, epochs=self.epochs,
                               seed=self.seed, hold_out=list(self.hold_out), altitude=self.altitude, slopes=self.slopes,
                               lag_s=self.lag_s, threads=self.threads)
        self.model_ = self.training_.model
        self.r2_, self.linear_regression_r2_ = self.training_.r2, self.training_.linear_regression_r2
        self.n_features_in_, self.feature_names_in_ = len(MOTION), np.array(MOTION, dtype=object)
        return self

    @property
    def flight_verdict_(self):
        """May the model fly? The FlightVerdict of training_; of an estimator that was pickled that of model_."""
        model = self._fitted()
        return getattr(self, "training_", model).flight_verdict

    def __repr__(self, *arguments, **named):
        shown = super().__repr__(*arguments, **named)
        return f"{self.flight_verdict_.in_words}\n{shown}" if hasattr(self, "model_") else shown

    def predict(self, X):
        """Commands, N x 4, not clipped: an array, or of a DataFrame a DataFrame with its index. X as of fit()."""
        model = self._fitted()
        commands = model.predict(model.features(X if _are_flights(X) else self._flight(X, None, asked=True)))
        return commands_like(X, commands)

    def score(self, X, y=None, sample_weight=None):
        """Coefficient of determination R^2, the mean over the four commands; of flights without y."""
        if _are_flights(X):
            if y is not None:
                raise ValueError("y: expected none, for flights have their commands")
            y = np.concatenate([flight.commands for flight in ([X] if isinstance(X, Flight) else X)])
        else:
            y = _table("y", y, COMMANDS)
        off, own = (y - np.asarray(self.predict(X))) ** 2, y - np.average(y, axis=0, weights=sample_weight)
        return float(np.mean(1 - np.average(off, axis=0, weights=sample_weight) /
                             np.average(own**2, axis=0, weights=sample_weight)))

    def save(self, folder, name="TrainedQuadModel", *, allow_poor=False):
        """Writes the header and the block that fly: Training.save()."""
        self._fitted()
        if not hasattr(self, "training_"):
            raise ValueError("an estimator that was pickled has its block alone: model_.save(path)")
        return self.training_.save(folder, name, allow_poor=allow_poor)

    def _fitted(self):
        if not hasattr(self, "model_"):
            raise NotFittedError("This StructuredInverse instance is not fitted yet; call fit() first")
        return self.model_

    def _flight(self, X, y, asked=False):
        """Rows as a Flight."""
        if y is None and not asked:
            if not is_frame(X) or not set(COMMANDS) <= set(X.columns):
                raise ValueError("fit: expected flights, or X and y, or a DataFrame with the columns of a flight; y is missing")
            y = by_name("X", X, COMMANDS)
        motion = _table("X", X, MOTION)
        rows = np.zeros((len(motion), 21))
        rows[:, 0], rows[:, 1:17] = np.arange(len(motion)) * self.step_s, motion
        if not asked:
            commands = _table("y", y, COMMANDS)
            if len(commands) != len(motion):
                raise ValueError(f"y: expected {len(motion)} rows, found {len(commands)}")
            rows[:, 17:] = commands
        return Flight(rows, "X")

    def __getstate__(self):
        state = super().__getstate__()
        return {name: value for name, value in state.items() if name != "training_"}


def _table(what, given, names):
    array = plain(what, given, names)
    if array.ndim == 1 and array.size == 0 or array.ndim != 2 or array.shape[1] != len(names):
        raise ValueError(f"{what}: expected N x {len(names)}, the columns {', '.join(names)}; found shape {array.shape}")
    return array

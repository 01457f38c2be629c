# SPDX-License-Identifier: MIT
"""Answers of the library as dataclasses: fields with units, to_frame() for pandas, plot() for matplotlib."""
import os
import weakref
from dataclasses import asdict, dataclass, field
from typing import Optional

import numpy as np

from . import _core, plots

AXES = ("roll", "pitch", "yaw")
_verdicts = weakref.WeakKeyDictionary()  # of a Model, which never changes


def pandas():
    """pandas, or one line where it is not installed."""
    try:
        import pandas as module
    except ImportError:
        raise ImportError("to_frame() needs pandas: python3-pandas of Debian, or pip install pandas") from None
    return module


@dataclass(frozen=True, repr=False)
class FlightVerdict:
    """May a model fly? The one verdict of the program, its pages and headers, by all that is known of the model."""

    may_fly: str  #: 'fit' for simulation and bench, 'care': fly with care, 'no': do not fly
    in_words: str  #: "do not fly: why"
    why: str  #: the reasons in one line; of a model that is fit the evidence
    reasons: list  #: each for itself; none of a model that is fit
    evidence: str  #: what the verdict is made of
    next: str  #: the flight to record next, or the command to type

    def __repr__(self):
        return f"{self.in_words}\nnext: {self.next}"

    def __bool__(self):
        raise TypeError("a verdict is no truth value: look at may_fly, which is 'fit', 'care' or 'no'")


class _Judged:
    """The verdict first."""

    def __repr__(self):
        fields = (f"{name}={getattr(self, name)!r}" for name, of in self.__dataclass_fields__.items() if of.repr)
        return f"{self.flight_verdict.in_words}\n{type(self).__name__}({', '.join(fields)})"

    @property
    def flight_verdict(self):
        """May the model fly? A FlightVerdict."""
        return FlightVerdict(**self.report[self._verdict_key])

    _verdict_key = "verdict"  # in the report


@dataclass(frozen=True, repr=False)
class Evaluation(_Judged):
    """A model judged on flights: commands that it predicts beside those that were flown."""

    model: str  #: path of its block
    airframe: str
    flight: str  #: names of the flights
    rows: int  #: judged
    rows_outside_envelope: int
    rows_without_features: int  #: at the ends of flights, where a window has no rows
    r2: float  #: coefficient of determination, the mean over the four commands
    mean_absolute_error: float
    rmse: float
    wrong_derivative_share: dict = field(repr=False)  #: of the rows, by axis: signs of slopes that are wrong
    figures: dict = field(repr=False)  #: every figure by its name: "r2_u1", "correlation_roll" ...
    report: dict = field(repr=False)  #: what `pinnquad evaluate --json` prints

    def to_frame(self):
        """A pandas DataFrame of one row, so that pandas.concat() compares models."""
        return pandas().DataFrame([{"model": self.model, "airframe": self.airframe, "rows": self.rows, **self.figures}])

    def plot(self, axes=None):
        """R^2 of each command as bars. Returns the axes of matplotlib."""
        return plots.bars(axes, {name: self.figures[f"r2_{name}"] for name in ("u1", "u2", "u3", "u4")}, "$R^2$")


@dataclass(frozen=True, repr=False)
class Certificate(_Judged):
    """The signs of a model's slopes: proven, refuted by two motions, or neither."""

    model: str  #: path of its block
    airframe: str
    verdict: str  #: on the signs: 'proven', 'counterexample' or 'neither'; flight_verdict says whether it may fly
    argument: Optional[str] = field(repr=False)  #: of the proof, in words
    slope: Optional[dict]  #: least slope of the signed sums, by axis; None where nothing is proven
    airframe_slope: Optional[dict] = field(repr=False)  #: the airframe's in hover, by axis
    thrust_slope: Optional[float]
    counterexample: Optional[dict] = field(repr=False)  #: axis, features, the feature moved, the signed sums
    report: dict = field(repr=False)  #: what `pinnquad certify --json` prints

    _verdict_key = "flight_verdict"

    @property
    def proven(self):
        """True where more angular acceleration always asks for more torque."""
        return self.verdict == "proven"

    def to_frame(self):
        """A pandas DataFrame with a row an axis: verdict, proven slope, the airframe's, their ratio (1: exact)."""
        slope, own = self.slope or {}, self.airframe_slope or {}
        return pandas().DataFrame([{"axis": axis, "verdict": self.verdict, "slope": slope.get(axis, np.nan),
                                    "airframe_slope": own.get(axis, np.nan),
                                    "ratio": slope.get(axis, np.nan) / own.get(axis, np.nan)} for axis in AXES])

    def plot(self, axes=None):
        """Proven slopes over the airframe's as bars. Returns the axes of matplotlib."""
        ratio = {axis: (self.slope[axis] / self.airframe_slope[axis] if self.proven else 0.0) for axis in AXES}
        axes = plots.bars(axes, ratio, "proven slope / airframe's")
        axes.axhline(1.0, color="0.5", linewidth=0.8)
        return axes


@dataclass(frozen=True, repr=False)
class ModelFlight(_Judged):
    """A model flown as feed-forward in the simulator, beside the analytic inverse with and without the path's jerk."""

    airframe: str  #: that flew
    trajectory: str
    period_s: float
    half_length_m: float
    model: dict  #: rmse_m and largest_error_m of the position, flown_s, status, answered_share ...
    analytic_inverse: dict
    without_jerk: dict
    traces: dict = field(repr=False)  #: of the model and of the analytic inverse without jerk: time_s, north_m, error_m ...
    report: dict = field(repr=False)  #: what `pinnquad loop --json` prints

    def to_frame(self):
        """A pandas DataFrame with a row a feed-forward: its figures."""
        names = ("model", "analytic_inverse", "without_jerk")
        return pandas().DataFrame([getattr(self, name) for name in names], index=names).drop(columns=["declined"])

    def plot(self, axes=None):
        """How far off the path each flew, over time. Returns the axes of matplotlib."""
        return plots.errors(axes, self.traces)


@dataclass(frozen=True)
class IdentifiedNumber:
    """A number of the vehicle that flew."""

    value: float
    low: Optional[float]  #: of the 95 % interval; None: no end
    high: Optional[float]
    unit: str
    excitation: str  #: 'good', 'fair', 'weak' or 'not determined': how well the flights determine it
    fly: Optional[str] = None  #: the flight that would determine it


def evaluate(model, flights, rows="all"):
    """Judges a Model on a Flight or a Dataset, and returns an Evaluation: the figures of `pinnquad evaluate`.

    rows: 'all', or 'test': those that train() holds out of these flights.
    """
    report = _core._evaluate(model, flights, rows)
    own = {name: report[name] for name in Evaluation.__dataclass_fields__ if name != "report"}
    return Evaluation(**own, report=report)


def certify(model, seconds=5.0, seed=1):
    """Proves the signs of a Model's slopes, or finds two motions that refute them; returns a Certificate.

    seconds: of the processor, for the search where nothing is proven; seed: of the search.
    """
    report = _core._certify(model, seconds, seed)
    own = {name: report.get(name) for name in Certificate.__dataclass_fields__ if name != "report"}
    return Certificate(**own, report=report)


def loop(model, trajectory="eight", *, airframe=None, columns=None, battery=None, battery_charge=100.0, guard=True):
    """Flies a Model as feed-forward in the simulator, and returns a ModelFlight: the figures of `pinnquad loop`.

    trajectory: 'eight', 'yaw_eight', 'circle', as large and fast as airframe and training range allow, or a CSV file of
    waypoints (docs/loop.md). airframe: another one than the model's, with the same motor order. columns: values of the
    model's input columns by name, by default the middle of their ranges. battery: the vehicle's, as '3x2200', and its charge
    at the start, %. guard: False: the model is asked outside its training envelope too.
    Raises ValueError or pinnquad.Error, one line, for what can't be flown.
    """
    held = [f"{name}={float(value)!r}" for name, value in (columns or {}).items()]
    report, traces = _core._loop(model, os.fspath(trajectory), airframe, held, battery or "", battery_charge, guard)
    own = {name: report[name] for name in ModelFlight.__dataclass_fields__ if name in report}
    return ModelFlight(**own, traces=traces, report=report)


def _model_verdict(self):
    """May it fly? A FlightVerdict by what its block records, its signs, and a figure-eight in the simulator."""
    if self not in _verdicts:
        _verdicts[self] = FlightVerdict(**_core._verdict(self))
    return _verdicts[self]


def _training_verdict(self):
    """May its model fly? The FlightVerdict of `pinnquad train` with this airframe: rows held out, other models, flight."""
    return FlightVerdict(**self._flight_verdict)


def _shown(self):
    return f"{self.flight_verdict.in_words}\n{self._words()}"


def _numbers(self):
    """IdentifiedNumbers by name, such as 'thrust_m_s2' and 'roll_effectiveness_rad_s2' (docs/identify.md)."""
    return {name: IdentifiedNumber(**number) for name, number in self._numbers.items()}


def _identification_frame(self):
    """A pandas DataFrame with a row a number: value, low, high, unit, excitation, fly."""
    return pandas().DataFrame([{"number": name, **asdict(number)} for name, number in self.numbers.items()]).set_index("number")


def _identification_plot(self, axes=None):
    """The numbers with their 95 % intervals, each over its value. Returns the axes of matplotlib."""
    return plots.intervals(axes, self.numbers)


def _training_frame(self):
    """A pandas DataFrame with a row a model: mean and standard deviation over seeds of each figure."""
    rows = []
    for key, figures in self.figures.items():
        row = {"model": key}
        for name, figure in figures.items():
            parts = {name: figure} if isinstance(figure, dict) and "mean" in figure else {
                f"{name}_{axis}": one for axis, one in figure.items()} if isinstance(figure, dict) else {}
            for part, one in parts.items():
                row[part], row[f"{part}_deviation"] = one["mean"], one["deviation"]
        rows.append(row)
    return pandas().DataFrame(rows).set_index("model").astype(float)


def _training_plot(self, axes=None):
    """Mean absolute error of each model on the rows held out; a dot a seed. Returns the axes of matplotlib."""
    errors = {key: figures["mean_absolute_error"] for key, figures in self.figures.items() if "mean_absolute_error" in figures}
    axes = plots.bars(axes, {key: error["mean"] for key, error in errors.items()}, "mean absolute error of the commands")
    for place, error in enumerate(errors.values()):
        axes.plot([place] * len(error["per_seed"]), error["per_seed"], "k.", markersize=3)
    return axes


def _flight_frame(self):
    """A pandas DataFrame: a column for each of column_names and each extra column, a row an instant."""
    columns = dict(zip(self.column_names, self.rows.T))
    columns.update({name: self[name] for name, _ in self.columns})
    return pandas().DataFrame(columns)


def _flight_plot(self, axes=None):
    """Speeds, attitude, body rates and commands over time, one below the other. Returns the four axes of matplotlib."""
    return plots.flight(axes, self)


_core.Model.flight_verdict, _core.Training.flight_verdict = property(_model_verdict), property(_training_verdict)
_core.Model.__repr__ = _core.Training.__repr__ = _shown
_core.Flight.to_frame, _core.Flight.plot = _flight_frame, _flight_plot
_core.Training.to_frame, _core.Training.plot = _training_frame, _training_plot
_core.Identification.numbers = property(_numbers)
_core.Identification.to_frame, _core.Identification.plot = _identification_frame, _identification_plot
for _method, _name in ((_flight_frame, "to_frame"), (_training_frame, "to_frame"), (_identification_frame, "to_frame"),
                       (_flight_plot, "plot"), (_training_plot, "plot"), (_identification_plot, "plot")):
    _method.__name__ = _name

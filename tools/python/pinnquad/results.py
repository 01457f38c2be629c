# SPDX-License-Identifier: MIT
"""Answers of the library as dataclasses: fields with units, to_frame() for pandas, plot() for matplotlib."""
from dataclasses import asdict, dataclass, field
from typing import Optional

import numpy as np

from . import _core, plots

AXES = ("roll", "pitch", "yaw")


def pandas():
    """pandas, or one line where it is not installed."""
    try:
        import pandas as module
    except ImportError:
        raise ImportError("to_frame() needs pandas: python3-pandas of Debian, or pip install pandas") from None
    return module


@dataclass(frozen=True)
class Evaluation:
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


@dataclass(frozen=True)
class Certificate:
    """The signs of a model's slopes: proven, refuted by two motions, or neither."""

    model: str  #: path of its block
    airframe: str
    verdict: str  #: 'proven', 'counterexample' or 'neither'
    argument: Optional[str] = field(repr=False)  #: of the proof, in words
    slope: Optional[dict]  #: least slope of the signed sums, by axis; None where nothing is proven
    airframe_slope: Optional[dict] = field(repr=False)  #: the airframe's in hover, by axis
    thrust_slope: Optional[float]
    counterexample: Optional[dict] = field(repr=False)  #: axis, features, the feature moved, the signed sums
    report: dict = field(repr=False)  #: what `pinnquad certify --json` prints

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


_core.Flight.to_frame, _core.Flight.plot = _flight_frame, _flight_plot
_core.Training.to_frame, _core.Training.plot = _training_frame, _training_plot
_core.Identification.numbers = property(_numbers)
_core.Identification.to_frame, _core.Identification.plot = _identification_frame, _identification_plot
for _method, _name in ((_flight_frame, "to_frame"), (_training_frame, "to_frame"), (_identification_frame, "to_frame"),
                       (_flight_plot, "plot"), (_training_plot, "plot"), (_identification_plot, "plot")):
    _method.__name__ = _name

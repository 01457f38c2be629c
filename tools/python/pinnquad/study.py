# SPDX-License-Identifier: MIT
"""A study of one's own: models of any origin on the same rows over many seeds, with paired tests, a figure and a table.

    from pinnquad import study
    result = study.run({"structured": "structured", "mine": mine}, flights, "my_study", seeds=20, jobs=2)
    print(result.to_frame())
    result.save()                   # rows.csv, table.tex, errors.svg, errors.pdf

A contender is a name of pinnquad.train() ("structured", "paper_vanilla", "paper_physics_informed" ...) or a callable
mine(parts, seed). It learns from parts.train and parts.validation, and returns the commands of parts.test, N x 4, or a
pinnquad.Model (of a program of one's own: Model.load("model.block")). docs/python.md has one with a loss in PyTorch.
"""
import csv
import functools
import hashlib
import inspect
import json
import os
import socket
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import plots
from ._core import Airframe, Dataset, Flight, Model, split, train
from .results import pandas

#: columns of rows.csv; errors of the commands on the rows held out
COLUMNS = ("contender", "seed", "mean_absolute_error", "rmse", "r2", "r2_u1", "r2_u2", "r2_u3", "r2_u4", "seconds", "source")


@dataclass(frozen=True)
class Part:
    """Rows of one part of the flights."""

    flights: Dataset

    @property
    def motion(self):
        """N x 16, the columns Flight.column_names[1:17]."""
        return np.concatenate([flight.rows[:, 1:17] for flight in self.flights])

    @property
    def commands(self):
        """N x 4, 0 to 1."""
        return np.concatenate([flight.commands for flight in self.flights])

    def to_frame(self):
        """All columns as a pandas DataFrame."""
        return pandas().concat([flight.to_frame() for flight in self.flights], ignore_index=True)


@dataclass(frozen=True)
class Parts:
    """What a contender sees: train() parts the flights in the same way."""

    train: Part
    validation: Part
    test: Part


@dataclass(frozen=True)
class Comparison:
    """A contender against the reference, seed by seed."""

    contender: str
    reference: str
    pairs: int
    difference: float  #: of the mean absolute errors, contender - reference, the mean over seeds
    p_value: float  #: Wilcoxon's signed-rank test, two-sided; NaN below 6 pairs, and where all differences are 0
    p_holm: float  #: Holm's correction for as many contenders
    why_no_p: str = ""  #: why p_value is NaN; empty where it is a number


FEWEST_PAIRS = 6  #: below, Wilcoxon's exact two-sided p is 2^(1-n) at least, above 0.05


def _why_no_p(pairs, p):
    if p == p:
        return ""
    return f"none: {pairs} of {FEWEST_PAIRS} seeds" if pairs < FEWEST_PAIRS else "none: equal errors"


@dataclass(frozen=True)
class Study:
    """Rows of a study, one a contender and seed."""

    folder: Path
    rows: list = field(repr=False)  #: dicts of COLUMNS
    reference: str

    def to_frame(self):
        """The rows as a pandas DataFrame."""
        return pandas().DataFrame(self.rows, columns=COLUMNS)

    def compare(self):
        """A Comparison of every other contender with the reference."""
        stats = _scipy_stats()
        errors, found = self._errors(), []
        for name in errors:
            if name == self.reference:
                continue
            seeds = sorted(errors[name].keys() & errors[self.reference].keys())
            off = np.array([errors[name][seed] - errors[self.reference][seed] for seed in seeds])
            p = float(stats.wilcoxon(off).pvalue) if len(off) >= FEWEST_PAIRS and np.any(off) else float("nan")
            found.append((name, len(off), float(off.mean()) if len(off) else float("nan"), p))
        corrected, worst = {}, 0.0
        known = sorted((one for one in found if one[3] == one[3]), key=lambda one: one[3])
        for place, one in enumerate(known):
            worst = max(worst, min(1.0, one[3] * (len(known) - place)))
            corrected[one[0]] = worst
        return [Comparison(name, self.reference, pairs, off, p, corrected.get(name, float("nan")), _why_no_p(pairs, p))
                for name, pairs, off, p in found]

    def to_latex(self):
        """A table for a paper (package booktabs): mean and standard deviation over seeds, best error in bold, Holm's p."""
        tested = {one.contender: one for one in self.compare()}
        means = {name: np.mean(list(errors.values())) for name, errors in self._errors().items()}
        lines = []
        for name, mean in means.items():
            own = [row for row in self.rows if row["contender"] == name]
            cells = [f"{mean:.5f} $\\pm$ {_deviation([row['mean_absolute_error'] for row in own]):.5f}"]
            if mean == min(means.values()):
                cells = [f"\\textbf{{{cells[0]}}}"]
            cells += [f"{np.mean([row[key] for row in own]):.5f}" for key in ("rmse", "r2")]
            test = tested.get(name)
            cells += [str(len(own)), "reference" if test is None else test.why_no_p or f"{test.p_holm:.2g}"]
            lines.append(" & ".join([name.replace("_", "\\_")] + cells) + " \\\\")
        return "\n".join(["\\begin{tabular}{lccccc}", "\\toprule",
                          "Model & Mean absolute error & RMSE & $R^2$ & Seeds & $p$ \\\\", "\\midrule", *lines, "\\bottomrule",
                          "\\end{tabular}", ""])

    def plot(self, axes=None):
        """The mean absolute error of each seed, and their median, a column a contender. Returns the axes of matplotlib."""
        axes = plots.pyplot().subplots(layout="constrained")[1] if axes is None else axes
        for place, (name, errors) in enumerate(self._errors().items()):
            values = np.array(list(errors.values()))
            spread = np.linspace(-0.15, 0.15, len(values)) if len(values) > 1 else np.zeros(1)
            axes.plot(place + spread, values, "o", markersize=3, alpha=0.7)
            axes.plot([place - 0.25, place + 0.25], [np.median(values)] * 2, "k-")
        axes.set_xticks(range(len(self._errors())), list(self._errors()))
        axes.set_ylabel("mean absolute error of the commands")
        return axes

    def save(self):
        """Writes rows.csv, table.tex, errors.svg and errors.pdf into the folder, and returns their paths."""
        table, latex = self.folder / "rows.csv", self.folder / "table.tex"
        with open(table, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(self.rows)
        latex.write_text(self.to_latex(), encoding="utf-8")
        axes = self.plot()
        figures = [self.folder / "errors.svg", self.folder / "errors.pdf"]
        for path in figures:
            axes.figure.savefig(path)
        plots.pyplot().close(axes.figure)
        return [table, latex, *figures]

    def _errors(self):
        """Mean absolute errors by contender and seed."""
        errors = {}
        for row in self.rows:
            errors.setdefault(row["contender"], {})[row["seed"]] = row["mean_absolute_error"]
        return errors


def run(contenders, flights, folder, *, seeds=20, jobs=None, reference=None, airframe="paper_quadrotor", epochs=None):
    """Fits every contender with every seed that `folder` has no row of, and returns the Study.

    contenders  a dict, name: a name of train(), or a callable (see the module)
    flights     a Flight, a Dataset or a list of flights, parted as train() parts them, by pinnquad.split()
    folder      a row is a file in folder/rows as soon as it is finished: a run that was stopped goes on, and several
                machines with one folder share the work. A row is made anew when airframe or epochs of its name have
                changed, the text of its callable, a number that it closes over or what a functools.partial holds; and
                in each run where Python does not have that text.
    seeds       how many, from 1; or the seeds themselves (a range for each task of a Slurm array)
    jobs        rows at a time, by joblib; None: as joblib.parallel_backend() says, such as "dask", else one
    reference   the contender that the others are compared with; None: the first
    airframe, epochs   of the contenders of train()

    Raises ValueError, one line, for another study in the folder; what a callable raises, after the rows that it finished.
    """
    joblib = _joblib()
    folder, reference = Path(folder), reference or next(iter(contenders), None)
    if reference not in contenders:
        raise ValueError(f"reference: expected one of {', '.join(contenders) or 'the contenders'}, found {reference!r}")
    if isinstance(flights, Flight):
        flights = [flights]
    flights = [flight for flight in flights]
    wanted = list(range(1, seeds + 1)) if isinstance(seeds, int) else [int(seed) for seed in seeds]
    settings = (epochs, Airframe(airframe).to_toml())
    sources = {name: _source(contender, settings) for name, contender in contenders.items()}
    (folder / "rows").mkdir(parents=True, exist_ok=True)
    _require_the_same_flights(folder, flights)
    missing = [(name, contender, seed) for seed in wanted for name, contender in contenders.items()
               if sources[name] is None or _read(folder, name, seed, sources[name]) is None]
    joblib.Parallel(n_jobs=jobs)(
        joblib.delayed(_fit)(folder, name, contender, seed, flights, airframe, epochs, sources[name])
        for name, contender, seed in missing)
    rows = [_read(folder, name, seed, sources[name]) for name in contenders for seed in wanted]
    return Study(folder, rows, reference)


def _fit(folder, name, contender, seed, flights, airframe, epochs, source):
    """One row, written when it is whole."""
    begun = time.perf_counter()
    parts = Parts(*map(Part, split(flights)))
    if isinstance(contender, str):
        training = train(flights, airframe, models=[contender], seeds=1, seed=seed, epochs=epochs, lag_s=0.0, threads=1)
        commands = training.model.predict(training.model.features(parts.test.flights))
    else:
        commands = contender(parts, seed)
        if isinstance(commands, Model):
            commands = commands.predict(commands.features(parts.test.flights))
    figures = _figures(name, np.asarray(commands, float), parts.test.commands)
    row = {"contender": name, "seed": seed, **figures, "seconds": time.perf_counter() - begun, "source": source}
    _write(_path(folder, name, seed), row)


def _write(path, content):
    """JSON, whole or not at all, whoever else writes it."""
    part = path.with_suffix(f".{socket.gethostname()}.{os.getpid()}.part")
    part.write_text(json.dumps(content), encoding="utf-8")
    os.replace(part, path)


def _figures(name, predicted, flown):
    if predicted.shape != flown.shape or not np.isfinite(predicted).all():
        raise ValueError(f"contender {name!r}: expected finite commands of shape {flown.shape}, found "
                         f"{predicted.shape if predicted.shape != flown.shape else 'a number that is not finite'}")
    off = predicted - flown
    r2 = 1 - (off**2).sum(axis=0) / ((flown - flown.mean(axis=0))**2).sum(axis=0)
    figures = {"mean_absolute_error": np.abs(off).mean(), "rmse": np.sqrt((off**2).mean()), "r2": r2.mean()}
    figures.update({f"r2_u{rotor + 1}": one for rotor, one in enumerate(r2)})
    return {key: float(value) for key, value in figures.items()}


def _path(folder, name, seed):
    safe = "".join(c if c.isalnum() or c in "-_" else "_" for c in name)
    return folder / "rows" / f"{safe}-{hashlib.sha256(name.encode()).hexdigest()[:8]}-{seed}.json"


def _read(folder, name, seed, source):
    """A row that is finished; None where there is none of this source."""
    try:
        row = json.loads(_path(folder, name, seed).read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except json.JSONDecodeError as error:
        raise ValueError(f"{_path(folder, name, seed)}: expected a row of a study, found {error}; delete it") from None
    return row if row["source"] == source else None


def _source(contender, settings):
    """A digest of what decides rows beside flights and seed: a name and its `settings`; or the text of a callable, the plain
    values that it closes over, and what a functools.partial, a method or an object holds. None where Python has them not."""
    if isinstance(contender, str):
        return _digest(contender, *settings)
    held = []
    if isinstance(contender, functools.partial):
        held, contender = [contender.args, contender.keywords], contender.func
    plain = {}
    try:
        if inspect.isroutine(contender):
            held.append(getattr(contender, "__self__", None))
            plain = {name: value for name, value in sorted(inspect.getclosurevars(contender).nonlocals.items())
                     if isinstance(value, (bool, int, float, str, tuple))}
        else:
            held.append(contender)
            contender = type(contender)
        return _digest(inspect.getsource(contender), plain, _joblib().hash(held))
    except Exception:  # no text, or whatever a pickle of what it holds raises
        return None


def _digest(*parts):
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


def _require_the_same_flights(folder, flights):
    digest = hashlib.sha256()
    for flight in flights:
        digest.update(repr((len(flight), flight.trajectory, flight.weight, flight.columns)).encode())
        for values in (flight.rows, *(flight[name] for name, _ in flight.columns)):
            digest.update(np.ascontiguousarray(values).tobytes())
    path, own = folder / "study.json", {"flights": digest.hexdigest()}
    if not path.exists():
        _write(path, own)
    elif json.loads(path.read_text(encoding="utf-8")) != own:
        raise ValueError(f"{folder}: expected an empty folder or a study of these flights, found one of others")


def _deviation(values):
    return float(np.std(values, ddof=1)) if len(values) > 1 else 0.0


def _joblib():
    try:
        import joblib
    except ImportError:
        raise ImportError("study.run() needs joblib: python3-joblib of Debian, or pip install joblib") from None
    return joblib


def _scipy_stats():
    try:
        from scipy import stats
    except ImportError:
        raise ImportError("a paired test needs scipy: python3-scipy of Debian, or pip install scipy") from None
    return stats

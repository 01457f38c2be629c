#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Gradient boosting, and ridge regression on the same features, on the rows that `pinnquad train` parted.

    pinnquad train d1.csv --out my_model
    tools/study/boosting.py my_model d1.csv [--features inverse] [--altitude]
    pinnquad train my_logs --hold-out-each trajectory --out my_model
    tools/study/boosting.py my_model my_logs [--window]

Offline baselines. Flights that train, validate and judge are those of my_model/report.json. Features: PhysicsFeatures
(features/motion_parts.hpp) and the battery's voltage where it was logged. A model for each motor: scikit-learn's
HistGradientBoostingRegressor and ridge. The validation rows count its trees and choose its penalty; of whole flights
both are then fitted to these rows too, as pinnquad's closed forms are. Printed: mean absolute error and R^2 of the rows
held out, mean over the folds, beside those of the report's own kinds. Needs Debian's python3-numpy and python3-sklearn.
Exit code: 0; 1 without these; 2 bad input.
"""
import argparse
import csv
import json
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")  # threads that wait for each other take minutes on a busy machine
try:
    import numpy as np
    from sklearn.ensemble import HistGradientBoostingRegressor
except ImportError as error:
    sys.exit(f"boosting.py: {error}: needs python3-numpy and python3-sklearn")

GRAVITY_M_S2 = 9.80665
TAPS, PERIOD_S = 9, 0.02  # LogWindow of tools/training/log_features.hpp
MOTORS = ("u1", "u2", "u3", "u4")
BATTERY = "battery_voltage [V]"
PENALTIES = 10.0 ** np.arange(-6, 5)  # times the rows, of standardised features


class BadInput(Exception):
    pass


def read_json(path):
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise BadInput(f"{path}: expected JSON, found {error}") from None


def read_flight(path):
    try:
        with open(path, newline="") as file:
            lines = csv.reader(file)
            head = next(lines)
            table = np.array([[float(field) for field in line] for line in lines])
    except (OSError, ValueError, StopIteration) as error:
        raise BadInput(f"{path}: expected a flight, found {error!r}") from None
    missing = [name for name in ("t", "vdot_bx", *MOTORS) if name not in head]
    if missing:
        raise BadInput(f"{path}: expected a column {missing[0]}, found none")
    return {name: table[:, at] for at, name in enumerate(head)}


def flights_of(report, sources):
    """The flights of a report by name: of a folder that `pinnquad import` wrote, or files."""
    files = {}
    for source in sources:
        if source.is_dir():
            for flight in read_json(source / "dataset.json")["flights"]:
                files[flight["name"]] = source / flight["file"]
        else:
            files[source.name] = source
    flights = {}
    for entry in report["settings"]["flights"]:
        file = files.get(entry["flight"], files.get(Path(entry["flight"]).name))
        if file is None:
            raise BadInput(f"expected the flight {entry['flight']} of the report, found {', '.join(sorted(files))}")
        flight = flights[entry["flight"]] = read_flight(file)
        if len(flight["t"]) != entry["rows"]:
            raise BadInput(f"{file}: expected {entry['rows']} rows as in the report, found {len(flight['t'])}")
    return flights


def features_of(flight, options):
    """Of each row; NaN where the window is not complete."""
    def three(*names):
        return np.stack([flight[name] for name in names], axis=1)

    roll, pitch = flight["roll"], flight["pitch"]
    down = np.stack([-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)], axis=1)
    velocity, rates = three("v_bx", "v_by", "v_bz"), three("w_x", "w_y", "w_z")
    force = three("vdot_bx", "vdot_by", "vdot_bz") + np.cross(rates, velocity) - GRAVITY_M_S2 * down
    if options.features == "inverse":
        force = force[:, 2:]
    accelerations = np.hstack([force, three("wdot_x", "wdot_y", "wdot_z")])
    products = rates[:, [1, 2, 0]] * rates[:, [2, 0, 1]]
    columns = [accelerations, rates, products, down, velocity, velocity * np.abs(velocity)]
    if BATTERY in flight:
        columns.append(flight[BATTERY][:, None])
    if options.altitude:
        columns.append(flight["altitude"][:, None])
    if options.window:
        t = flight["t"]
        begins = np.maximum.accumulate(np.where(np.diff(t, prepend=-np.inf) > 1.5 * PERIOD_S, t, -np.inf))
        for tap in range(1, TAPS):
            past = np.stack([np.interp(t - tap * PERIOD_S, t, column) for column in accelerations.T], axis=1)
            past[t - tap * PERIOD_S < begins - 1e-4 * PERIOD_S] = np.nan
            columns.append(past)
    return np.hstack(columns)


def parts_of(fold, rows_of):
    """Rows that train, validate, judge: (flight, first, end)."""
    if fold["by_time"]:
        name, rows = fold["train"][0], fold["rows"]
        first = rows["train"], rows["train"] + rows["validation"]
        return [(name, 0, first[0])], [(name, *first)], [(name, first[1], rows_of[name])]
    train, validation = [], []
    for name in fold["train"]:
        shared = name in fold["validation"]  # its last fifth validates
        train.append((name, 0, int(0.8 * rows_of[name]) if shared else rows_of[name]))
    for name in fold["validation"]:
        validation.append((name, int(0.8 * rows_of[name]) if name in fold["train"] else 0, rows_of[name]))
    return train, validation, [(name, 0, rows_of[name]) for name in fold["held_out"]]


def fit_ridge(x, u, validating, refit, _options):
    mean, scale = x.mean(axis=0), x.std(axis=0)
    scale[scale < 1e-9] = 1

    def solved(x, u, penalty):
        z = (x - mean) / scale
        centre, level = z.mean(axis=0), u.mean(axis=0)
        z = z - centre
        system = z.T @ z + penalty * len(z) * np.eye(z.shape[1])
        weights = np.linalg.solve(system, z.T @ (u - level))
        return lambda of: level + ((of - mean) / scale - centre) @ weights

    penalty = min(PENALTIES, key=lambda p: np.mean((solved(x, u, p)(validating[0]) - validating[1]) ** 2))
    return solved(*refit, penalty)


def fit_boosting(x, u, validating, refit, options):
    models = []
    for motor in range(u.shape[1]):
        def fitted(x, u, trees):
            model = HistGradientBoostingRegressor(max_iter=trees, early_stopping=False, random_state=1)
            return model.fit(x, u[:, motor])

        model = fitted(x, u, options.trees)
        errors = [np.mean((said - validating[1][:, motor]) ** 2) for said in model.staged_predict(validating[0])]
        models.append(fitted(*refit, int(np.argmin(errors)) + 1))
    return lambda of: np.stack([model.predict(of) for model in models], axis=1)


def judged(report, flights, options):
    """{model: [folds x motors] of mean absolute errors and of R^2}."""
    tables = {name: (features_of(flight, options), np.stack([flight[u] for u in MOTORS], axis=1))
              for name, flight in flights.items()}
    rows_of = {name: len(flight["t"]) for name, flight in flights.items()}

    def rows(parts):
        x, u = (np.vstack([tables[name][which][first:end] for name, first, end in parts]) for which in (0, 1))
        whole = np.isfinite(x).all(axis=1)
        if whole.sum() < 100:
            raise BadInput(f"expected 100 rows with all features or more in {parts[0][0]} and others, "
                           f"found {whole.sum()} (a window needs a row every {PERIOD_S:g} s)")
        return x[whole], u[whole]

    found = {"ridge": ([], []), "boosting": ([], [])}
    for fold in report["folds"]:
        train, validation, test = parts_of(fold, rows_of)
        training, validating, (x, u) = rows(train), rows(validation), rows(test)
        refit = training if fold["by_time"] else rows(train + validation)
        for name, fit in (("ridge", fit_ridge), ("boosting", fit_boosting)):
            error = fit(*training, validating, refit, options)(x) - u
            found[name][0].append(np.abs(error).mean(axis=0))
            found[name][1].append(1 - (error ** 2).sum(axis=0) / ((u - u.mean(axis=0)) ** 2).sum(axis=0))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder that pinnquad train wrote: its report.json parts the rows")
    parser.add_argument("data", type=Path, nargs="+", help="folder that pinnquad import wrote, or the flights, CSV")
    parser.add_argument("--features", choices=("physics", "inverse"), default="physics",
                        help="inverse: of the specific force the part along the thrust axis alone, as `structured`")
    parser.add_argument("--altitude", action="store_true", help="the altitude is a feature")
    parser.add_argument("--window", action="store_true", help="the accelerations of the last 160 ms are features")
    parser.add_argument("--trees", type=int, default=500, help="the most of a model (default: 500)")
    options = parser.parse_args()
    if options.trees < 1:
        parser.error("--trees needs at least 1")
    try:
        report = read_json(options.run / "report.json")
        if not report.get("folds"):
            raise BadInput(f"{options.run / 'report.json'}: expected the folds of pinnquad train, found none")
        found = judged(report, flights_of(report, options.data), options)
    except BadInput as error:
        print(f"boosting.py: {error}", file=sys.stderr)
        return 2
    print(f"{'':24} {'error, 1e-3':>11} {'R^2':>7}   motor by motor")
    for name, (errors, r2) in found.items():
        each = "  ".join(f"{1e3 * e:.2f} {r:.3f}" for e, r in zip(np.mean(errors, axis=0), np.mean(r2, axis=0)))
        print(f"{name:24} {1e3 * np.mean(errors):11.2f} {np.mean(r2):7.3f}   {each}")
    print("of the report")
    for name, model in report["models"].items():
        if model["applicable"]:
            print(f"{name:24} {1e3 * model['mean_absolute_error']['mean']:11.2f} {model['r2']['mean']:7.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

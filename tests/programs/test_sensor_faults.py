# SPDX-License-Identifier: MIT
"""Faults of sensors and vehicles that every single row hides, planted into recorded flights: import tells each, in the
flight that has it and in no other. docs/import.md has the smallest that are found."""
import json
import re
import shutil
from math import cos, radians, sin
from pathlib import Path

import pytest
from conftest import table
from test_log_faults import FORCES, MAPPING, MOTORS, RATES, each, logged, scaled, written

EXTRA = '[[extra]]\nname = "battery_voltage"\nunit = "V"\ncolumn = "volts"\n'


def second_half(change, *columns):
    def plant(rows):
        middle = (rows[0]["t"] + rows[-1]["t"]) / 2
        each(change, *columns)([row for row in rows if row["t"] > middle])

    return plant


def pitched(degrees):
    """An IMU that is turned about the body's y, in place of the attitude."""
    s, c = sin(radians(degrees)), cos(radians(degrees))

    def plant(rows):
        for row in rows:
            for x, _, z in RATES, FORCES:
                row[x], row[z] = c * row[x] + s * row[z], c * row[z] - s * row[x]

    return plant


def low_passed(seconds):
    def plant(rows):
        step = rows[1]["t"] - rows[0]["t"]
        share = step / (seconds + step)
        for before, row in zip(rows, rows[1:]):
            for name in RATES:
                row[name] = before[name] + share * (row[name] - before[name])

    return plant


def drifting(degrees_per_second):
    def plant(rows):
        for row in rows:
            row["yaw"] += radians(degrees_per_second) * (row["t"] - rows[0]["t"])

    return plant


# the smallest that is found: plant, pattern of its lines
FAULTS = {
    "other propellers": (second_half(lambda u: u / 1.2, *MOTORS),
                         r"u1 to u4: from .* thrust of a rotor .* more than before"),
    "imu pitched": (pitched(7), r"turned by .* degrees .* about y against"),
    "gyro bias": (each(lambda q: q + 0.1, "q"), r"w_y: on average 0\.\d+ rad/s .* more than the attitude turns by"),
    "gyro low-pass": (low_passed(0.03), r"w_x to w_z: the rates come [2-7]\d\.?\d* ms"),
    "volts of another unit": (scaled(10, "volts"), r"battery_voltage: [\d.]+ V on average"),
    "none": (lambda rows: None, "(?!)"),
}


def told(done):
    """Each warning; as JSON, because the text collapses those of one kind."""
    return done.lines if done.code else json.loads(done.out)["warnings"]


@pytest.fixture(scope="module")
def flights(pinnquad, recorded, unpacked, tmp_path_factory):
    """flights(log): the rows of its flights by name; importing them says nothing of the kind."""
    folder = tmp_path_factory.mktemp("recorded")
    known = {}

    def of(log):
        if log in known:
            return known[log]
        if log == "px4":
            source = [recorded("sih/test_circle.ulg"), unpacked("train_random", "train_figure8", "payload")]
        else:
            source = [recorded("flight_logs/nanobench_subset_50hz.csv")]
        done = pinnquad("import --json --lag 0 --rate 50", *source, "--mapping", log, "--out", folder / log)
        assert not [line for line in told(done) for _, pattern in FAULTS.values() if re.search(pattern, line)], done
        known[log] = {}
        for flight in sorted(folder.glob(f"{log}/*.csv")):
            volts = [float(cells["battery_voltage [V]"]) for cells in table(flight)]
            known[log][flight.stem] = [{**row, "volts": v} for row, v in zip(logged(flight), volts)]
        return known[log]

    return of


def imported(pinnquad, rows_of, plants, code=0):
    """What import reports of these flights, a fault planted into each."""
    Path("log.toml").write_text(MAPPING + EXTRA)
    Path("logs").mkdir()
    for name, rows in rows_of.items():
        rows = [dict(row) for row in rows]
        plants.get(name, lambda rows: None)(rows)
        written(f"logs/{name}.csv", rows)
    return pinnquad("import logs --json --mapping log.toml --lag 0 --out dataset", code=code)


@pytest.mark.parametrize("log, first", [("nanobench", 2), ("px4", 0)])
def test_told_of_its_flight_alone(pinnquad, flights, log, first):
    """A fault in each flight, of all in turn."""
    names, faults = list(flights(log)), list(FAULTS)
    planted = {name: faults[(first + at) % len(faults)] for at, name in enumerate(names)}
    lines = told(imported(pinnquad, flights(log), {name: FAULTS[fault][0] for name, fault in planted.items()}))
    found = {(name, fault) for fault, (_, pattern) in FAULTS.items() for line in lines if re.search(pattern, line)
             for name in names if name in line.split(": column")[0]}
    assert found == {pair for pair in planted.items() if pair[1] != "none"}, lines


def test_a_heading_that_drifts(pinnquad, flights):
    """It turns the velocity too: the line says why, whether it is refused or not."""
    for name in "B10_lissajous_slow_rep1", "B7_oval_medium_rep1":
        done = imported(pinnquad, {name: flights("nanobench")[name]}, {name: drifting(1.5)}, code=(0, 2))
        pattern = r"w_z: on average 0\.02\d* rad/s .* less than .* heading"
        assert any(re.search(pattern, line) for line in told(done)), done
        shutil.rmtree("logs")


def test_commands_in_tenths(pinnquad, flights):
    rows_of = {name: flights("nanobench")[name] for name in ("B2_circle_fast_rep1", "B7_oval_fast_rep1")}
    tenths = {name: scaled(0.1, *MOTORS) for name in rows_of}
    assert any("no command is above 0.09" in line for line in told(imported(pinnquad, rows_of, tenths)))

# SPDX-License-Identifier: MIT
"""Flights and datasets: arrays where the rows lie, files, logs, hostile rows."""
import gc
import pickle

import numpy as np
import pytest
from conftest import SOURCE

import pinnquad
from pinnquad import Dataset, Flight


def with_battery(flight):
    return Flight(flight.rows, "own", "circle", 2.0, [("battery_voltage", "V", np.linspace(16, 15, len(flight)))])


def test_arrays_are_the_memory_of_the_flight(flight):
    for array in (flight.rows, flight.commands, flight.time_s, flight["u3"], with_battery(flight)["battery_voltage"]):
        assert not array.flags.owndata and not array.flags.writeable
    assert np.shares_memory(flight.rows, flight.commands)
    np.testing.assert_array_equal(flight.rows[:, 17:], flight.commands)
    for at, quantity in ((1, flight.linear_acceleration_m_s2), (4, flight.angular_acceleration_rad_s2),
                         (7, flight.velocity_m_s), (10, flight.body_rates_rad_s), (13, flight.euler_rad)):
        np.testing.assert_array_equal(flight.rows[:, at:at + 3], quantity)
    for i, name in enumerate(Flight.column_names):
        np.testing.assert_array_equal(flight[name], flight.rows[:, i])
    with pytest.raises(ValueError):
        flight.commands[0, 0] = 1


def test_arrays_keep_their_flight_and_a_flight_its_dataset(flight):
    dataset = Dataset([flight])
    assert np.shares_memory(dataset[0].rows, dataset[-1].rows)
    rows = dataset[0].commands
    one = dataset[0]
    del dataset
    gc.collect()
    [pinnquad.fly(rows=2000) for _ in range(3)]
    np.testing.assert_array_equal(rows, flight.commands)
    np.testing.assert_array_equal(one.rows, flight.rows)


def test_round_trips(flight, tmp_path):
    own = with_battery(flight)
    own.save(tmp_path / "own.csv")
    for again in (Flight.read(tmp_path / "own.csv"), pickle.loads(pickle.dumps(own))):
        np.testing.assert_array_equal(again.rows, own.rows)
        assert again.columns == [("battery_voltage", "V")]
        np.testing.assert_array_equal(again["battery_voltage"], own["battery_voltage"])
    assert (again.name, again.trajectory, again.weight) == ("own", "circle", 2.0)
    Dataset([flight, own]).save(tmp_path / "dataset")
    dataset = Dataset.read([tmp_path / "dataset"])
    assert len(dataset) == 2 and dataset.rows == 2 * len(flight)
    np.testing.assert_array_equal(dataset[0].rows, flight.rows)
    assert [(len(one), one.weight) for one in dataset] == [(len(flight), 1), (len(flight), 2)]
    for one in (dataset, Dataset(dataset), pinnquad.split(flight)[0]):
        assert one.sample_period_s == 0.05


def test_logs_of_others():
    log = sorted((SOURCE.parent / "shared/reference").glob("**/*.ulg"))
    if not log:
        pytest.skip("no logs that others recorded beside the repository")
    dataset = Dataset.read(log[:1], mapping="px4")
    assert dataset.rows > 100 and dataset.sample_period_s > 0
    assert np.isfinite(dataset[0].rows).all() and np.diff(dataset[0].time_s).min() > 0


def test_rows_that_are_none(flight):
    rows = flight.rows[:100].copy()
    for wrong, words in ((rows[:, :20], "21 columns"), (rows[0], "21 columns"), (rows[None], "21 columns"),
                         (rows[::-1], "row 1: time does not increase")):
        with pytest.raises(ValueError, match=words):
            Flight(wrong)
    rows[7, 5] = np.nan
    with pytest.raises(ValueError, match="row 7, column wdot_y"):
        Flight(rows)
    for wrong in ("abc", None, [["a"] * 21], object()):
        with pytest.raises((ValueError, TypeError)):
            Flight(wrong)
    with pytest.raises(ValueError, match="battery"):
        Flight(flight.rows[:10], columns=[("battery", "V", [1.0])])
    with pytest.raises(ValueError, match="no column named 'u5'; known: time_s"):
        flight["u5"]
    with pytest.raises(IndexError, match="flight 1 of 1"):
        Dataset(flight)[1]
    with pytest.raises(ValueError, match="row 1, column pack: expected a finite number, found nan"):
        Flight(flight.rows[:2], columns=[("pack", "V", [1, np.nan])])
    assert len(Flight(np.zeros((0, 21)))) == 0


def test_files_that_are_none(flight, tmp_path):
    with pytest.raises(pinnquad.Error, match="nothing.csv"):
        Flight.read(tmp_path / "nothing.csv")
    bad = tmp_path / "bad.csv"
    bad.write_text(",".join(Flight.column_names) + "\n" + "\n".join(",".join([str(t)] + ["x"] * 20) for t in range(20)))
    with pytest.raises(pinnquad.Error, match=r"bad.csv:2:2: expected a finite number in column vdot_bx"):
        Flight.read(bad)
    for paths in ([], [tmp_path], ["/dev/null"]):
        with pytest.raises((pinnquad.Error, ValueError)) as caught:
            Dataset.read(paths)
        assert "\n" not in str(caught.value)
    flight.save(tmp_path / "flight.csv")
    with pytest.raises(ValueError, match="lag_s: only logs"):
        Dataset.read([tmp_path / "flight.csv"], lag_s=0.1)
    with pytest.raises((pinnquad.Error, ValueError), match="martian"):
        Dataset.read([bad], mapping="martian")
    for wrong in (3, "abc", [1, 2], None):
        with pytest.raises(TypeError, match="expected a Dataset"):
            Dataset(wrong)


def test_two_flights_of_one_name(flight):
    with pytest.raises(ValueError, match="name of its own"):
        Dataset([flight, flight])

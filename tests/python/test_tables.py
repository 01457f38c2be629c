# SPDX-License-Identifier: MIT
"""Flights of arrays and data frames: what went in comes out, in every frame, and a mistake is one clear line."""
import numpy as np
import pytest

import pinnquad
from pinnquad import Dataset, Flight


@pytest.fixture(scope="module")
def flown():
    """Half a minute at 100 Hz would be long: D1 as it is, 20 Hz."""
    return pinnquad.fly("d1", seed=3, rows=1200)


def arrays(flight):
    """As from_arrays() takes them, NED and FRD; the specific force of motion and attitude."""
    w, v = flight.body_rates_rad_s, flight.velocity_m_s
    roll, pitch, _ = flight.euler_rad.T
    down = np.stack([-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)], axis=1)
    force = flight.linear_acceleration_m_s2 + np.cross(w, v) - 9.80665 * down
    return {"time_s": flight.time_s, "world": "ned", "body": "frd", "euler_rad": flight.euler_rad, "body_rates_rad_s": w,
            "specific_force_m_s2": force, "velocity_m_s": v, "velocity_axes": "body", "altitude_m": flight.altitude_m,
            "commands": flight.commands, "motor_order": "px4", "airframe": "paper_quadrotor", "lag_s": 0.0,
            "keep_saturated": True}


def quaternions(euler):
    (sr, sp, sy), (cr, cp, cy) = np.sin(euler.T / 2), np.cos(euler.T / 2)
    return np.stack([cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                     cr * cp * sy - sr * sp * cy], axis=1)


def the_same(again, flight):
    """Rows of the flight, but for those at its ends and for outliers."""
    at = np.searchsorted(flight.time_s, again.time_s - 1e-6)
    assert len(again) > 0.9 * len(flight)
    for quantity in ("body_rates_rad_s", "velocity_m_s", "commands"):
        np.testing.assert_allclose(again[quantity], flight[quantity][at], atol=1e-9)
    turned = again.euler_rad - flight.euler_rad[at]
    np.testing.assert_allclose(np.sin(turned), 0, atol=1e-9)
    np.testing.assert_allclose(again.linear_acceleration_m_s2, flight.linear_acceleration_m_s2[at], atol=1e-6)


def test_arrays(flown):
    again = Flight.from_arrays(**arrays(flown), name="mine", columns=[("pack", "V", np.linspace(16, 15, len(flown)))])
    assert again.name == "mine" and again.columns == [("pack", "V")]
    the_same(again, flown)
    the_same(Flight.from_arrays(**arrays(flown), columns=[("commands", "1", np.zeros(len(flown)))]), flown)


def test_frames_and_orders(flown):
    """ENU and FLU, a quaternion x, y, z, w, Betaflight's motors: the same flight."""
    given = arrays(flown)
    w, x, y, z = quaternions(given.pop("euler_rad")).T
    s = np.sqrt(0.5)  # (0, s, s, 0) q (0, 1, 0, 0)
    w, x, y, z = -s * x - s * y, s * w + s * z, s * w - s * z, s * y - s * x
    given["quaternion"] = np.stack([-x, w, z, -y], axis=1)[:, [1, 2, 3, 0]]
    flip = np.array([1, -1, -1])
    for name in ("body_rates_rad_s", "specific_force_m_s2", "velocity_m_s"):
        given[name] = given[name] * flip
    u = given["commands"]
    given.update(world="enu", body="flu", quaternion_order="xyzw", motor_order="betaflight",
                 commands=u[:, [3, 0, 1, 2]])
    the_same(Flight.from_arrays(**given), flown)


@pytest.mark.parametrize("names, words", [(['pa"ck'], "plain text"), (["pack", "pack"], "found 'pack' twice")])
def test_names_of_columns(flown, names, words):
    with pytest.raises((pinnquad.Error, ValueError), match=words):
        Flight.from_arrays(**arrays(flown), columns=[(name, "V", np.ones(len(flown))) for name in names])


@pytest.mark.parametrize("change, words", [
    ({"world": "nwu"}, "world: expected 'ned' or 'enu', found 'nwu'"), ({"body": None}, "body"),
    ({"name": "../x"}, "without folders"), ({"motor_order": "x"}, "motor_order"), ({"euler_rad": None}, "neither"),
    ({"quaternion": np.ones((1200, 4))}, "both"), ({"velocity_axes": None}, "velocity_axes"),
    ({"commands": np.ones((1200, 3))}, "1200 x 4 numbers, found shape \\(1200, 3\\)"),
    ({"commands": np.ones((7, 4))}, "found shape \\(7, 4\\)"),
    ({"altitude_m": np.array(["a"] * 1200)}, "altitude_m: expected numbers"),
    ({"time_s": np.zeros(1200)}, "times that increase"),
    ({"time_s": np.arange(1200).astype("datetime64[s]")}, "timedelta64"),
    ({"specific_force_m_s2": None, "velocity_m_s": None}, "found none of them")])
def test_mistakes(flown, change, words):
    with pytest.raises(ValueError, match=words):
        Flight.from_arrays(**{**arrays(flown), **change})


def test_mistakes_that_the_import_finds(flown):
    given = arrays(flown)
    given["body_rates_rad_s"] = np.degrees(given["body_rates_rad_s"])
    with pytest.raises(pinnquad.Error, match="the table: .*degrees per second") as said:
        Flight.from_arrays(**given)
    assert "\n" not in str(said.value) and "/tmp" not in str(said.value)


MAPPING = """\
world = "ned"
body = "frd"
[time]
column = "t"
[attitude]
euler = ["roll", "pitch", "yaw"]
unit = "deg"
[body_rates]
columns = ["p", "q", "r"]
[velocity]
columns = ["u", "v", "w"]
axes = "body"
[motors]
columns = ["m1", "m2", "m3", "m4"]
order = "px4"
"""


def frame_of(flight):
    columns = {"t": flight.time_s}
    columns.update(zip(("roll", "pitch", "yaw"), np.degrees(flight.euler_rad).T))
    columns.update(zip("pqr", flight.body_rates_rad_s.T))
    columns.update(zip("uvw", flight.velocity_m_s.T))
    columns.update(zip(("m1", "m2", "m3", "m4"), flight.commands.T))
    columns["note"] = np.array(["in the air"] * len(flight))
    return columns


def test_dataframe(flown):
    settings = {"airframe": "paper_quadrotor", "lag_s": 0.0, "keep_saturated": True}
    dataset = Dataset.from_dataframe(frame_of(flown), MAPPING, name="mine", **settings)
    assert len(dataset) == 1 and dataset[0].name == "mine"
    at = np.searchsorted(flown.time_s, dataset[0].time_s - 1e-6)
    np.testing.assert_allclose(dataset[0].body_rates_rad_s, flown.body_rates_rad_s[at], atol=1e-9)
    with pytest.raises(ValueError, match="lag_s: a dataset was imported with one"):
        pinnquad.train(dataset, lag_s=0.1)
    with pytest.raises(pinnquad.Error, match="the mapping:.*nearest: p"):
        Dataset.from_dataframe(frame_of(flown), MAPPING.replace('"p"', '"pp"'), **settings)
    with pytest.raises(ValueError, match="one length"):
        Dataset.from_dataframe({"t": np.zeros(3), "x": np.zeros(2)}, MAPPING)
    with pytest.raises(ValueError, match="found none"):
        Dataset.from_dataframe({}, MAPPING)


def test_pandas(flown):
    pandas = pytest.importorskip("pandas")
    dataset = Dataset.from_dataframe(pandas.DataFrame(frame_of(flown)), MAPPING, airframe="paper_quadrotor", lag_s=0.0)
    assert len(dataset) >= 1

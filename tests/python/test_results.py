# SPDX-License-Identifier: MIT
"""Answers as dataclasses: tables of pandas, charts of matplotlib, one line where they are not installed."""
import dataclasses
import subprocess
import sys

import numpy as np
import pytest

import pinnquad
from pinnquad import Dataset, Flight


@pytest.fixture(scope="module")
def charts():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot
    yield pyplot
    pyplot.close("all")


def test_a_flight_as_a_frame_and_back(flight):
    pandas = pytest.importorskip("pandas")
    own = Flight(flight.rows, "own", columns=[("battery_voltage", "V", np.linspace(16, 15, len(flight)))])
    frame = own.to_frame()
    assert list(frame.columns) == list(Flight.column_names) + ["battery_voltage"]
    shuffled = frame[frame.columns[::-1]].assign(note="calm")
    again = Dataset.from_dataframe(shuffled)[0]
    np.testing.assert_array_equal(again.rows, own.rows)
    np.testing.assert_array_equal(again["battery_voltage"], own["battery_voltage"])
    np.testing.assert_array_equal(Flight(frame).rows, own.rows)
    np.testing.assert_array_equal(Flight(frame.to_records(index=False)).rows, own.rows)  # fields by name
    fields = shuffled.drop(columns="note").to_records(index=False)
    np.testing.assert_array_equal(Flight(fields).rows, own.rows)
    hidden = {**dict(zip(Flight.column_names, own.rows.T)), "heat": np.ma.masked_less(own.time_s, 1)}
    with pytest.raises(ValueError, match="row 0, column heat: expected a finite number"):
        Dataset.from_dataframe(hidden)
    with pytest.raises(ValueError, match="expected a column 'w_x', found t, vdot_bx"):
        Dataset.from_dataframe(frame.drop(columns="w_x"))
    with pytest.raises(ValueError, match="row 3, column u2"):
        Dataset.from_dataframe(frame.assign(u2=frame.u2.where(frame.index != 3)))
    with pytest.raises(ValueError, match="column 'u2': expected numbers"):
        Dataset.from_dataframe(frame.assign(u2="high"))
    assert isinstance(frame, pandas.DataFrame)


def test_arrays_that_hide_rows_are_refused(flight):
    rows = flight.rows.copy()
    np.testing.assert_array_equal(Flight(np.asfortranarray(rows)).rows, rows)
    np.testing.assert_array_equal(Flight(np.ma.array(rows)).rows, rows)
    with pytest.raises(ValueError, match="rows: expected numbers without a mask, found 1 masked"):
        Flight(np.ma.array(rows, mask=np.arange(rows.size).reshape(rows.shape) == 30))


@pytest.mark.parametrize("rows", [100.7, 100.0, "100", np.float32(100)])
def test_rows_are_whole(rows):
    with pytest.raises(TypeError, match="rows: expected a whole number, found"):
        pinnquad.fly(rows=rows)
    assert len(pinnquad.fly(rows=np.int64(100))) == 100


@pytest.mark.parametrize("name, value", [("fault_rotor", 2.7), ("turbulence_seed", np.float32(1.5))])
def test_effects_are_whole(name, value):
    with pytest.raises(TypeError, match=f"effects: {name}: expected a whole number"):
        pinnquad.Simulator(effects=pinnquad.Effects(**{name: value}))


def test_an_evaluation(structured, network, flight):
    pandas = pytest.importorskip("pandas")
    judged = [pinnquad.evaluate(model, flight) for model in (structured, network)]
    assert dataclasses.is_dataclass(judged[0]) and judged[0].rows == len(flight)
    frame = pandas.concat([one.to_frame() for one in judged])
    assert list(frame["r2"]) == [one.r2 for one in judged] and frame["rows"].iloc[0] == len(flight)


def test_a_certificate(structured, network):
    pytest.importorskip("pandas")
    proven, refuted = pinnquad.certify(structured), pinnquad.certify(network, seconds=20)
    frame = proven.to_frame().set_index("axis")
    assert list(frame.index) == ["roll", "pitch", "yaw"] and (frame["ratio"] > 0.5).all()
    assert frame.loc["yaw", "slope"] == proven.slope["yaw"]
    assert refuted.to_frame()["slope"].isna().all() and "Certificate" in repr(refuted)
    flown = pinnquad.loop(structured)
    assert flown.to_frame().loc["model", "rmse_m"] == flown.model["rmse_m"] < flown.without_jerk["rmse_m"]


def test_a_training(trained):
    pytest.importorskip("pandas")
    frame = trained.to_frame()
    assert frame.loc["structured", "r2"] == trained.r2
    assert frame.loc["structured", "wrong_derivative_share_roll"] == 0


def test_charts(charts, flight, trained, structured, tmp_path):
    found = pinnquad.identify(pinnquad.fly("d1", airframe="px4_sih", rows=3000), mass_kg=1.0, arm_m=0.2)
    axes = flight.plot()
    np.testing.assert_array_equal(axes[3].lines[2].get_ydata(), flight.commands[:, 2])
    np.testing.assert_allclose(axes[1].lines[0].get_ydata(), np.degrees(flight.euler_rad[:, 0]))
    assert axes[0].get_ylabel() == "velocity, m/s" and axes[3].get_xlabel() == "time, s"
    bars = trained.plot().patches
    assert [bar.get_height() for bar in bars] == [trained.figures["structured"]["mean_absolute_error"]["mean"]]
    judged = pinnquad.evaluate(structured, flight)
    assert [bar.get_height() for bar in judged.plot().patches] == [judged.figures[f"r2_u{i}"] for i in (1, 2, 3, 4)]
    proven = pinnquad.certify(structured)
    assert proven.plot().patches[0].get_height() == proven.slope["roll"] / proven.airframe_slope["roll"]
    frame = found.to_frame()
    assert frame.loc["thrust_m_s2", "value"] == found.numbers["thrust_m_s2"].value
    shown = [text.get_text() for text in found.plot().get_yticklabels()]
    assert any(text.startswith("roll_effectiveness_rad_s2 = ") for text in shown)
    flown = pinnquad.loop(structured)
    lines = flown.plot().lines
    assert lines[0].get_ydata().max() <= flown.model["largest_error_m"] < lines[1].get_ydata().max()
    _, (one, other) = charts.subplots(1, 2)
    assert trained.plot(one) is one and judged.plot(axes=other) is other
    axes[0].figure.savefig(tmp_path / "flight.png")
    assert (tmp_path / "flight.png").stat().st_size > 10_000


@pytest.mark.parametrize("absent, call, line", [
    ("matplotlib", "pinnquad.fly(rows=20).plot()", "plot() needs matplotlib: "),
    ("pandas", "pinnquad.fly(rows=20).to_frame()", "to_frame() needs pandas: "),
    ("joblib", "pinnquad.study.run({'structured': 'structured'}, pinnquad.fly(rows=20), 'x')", "study.run() needs joblib: ")])
def test_what_is_not_installed_is_one_line(absent, call, line, tmp_path):
    """And the import of pinnquad loads none of the large packages."""
    text = (f"import sys; sys.modules[{absent!r}] = None\nimport pinnquad\n"
            "assert not {'matplotlib', 'pandas', 'sklearn', 'scipy', 'joblib'} & {name for name, module in sys.modules.items() if module}\n"
            f"{call}")
    asked = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, cwd=tmp_path)
    assert asked.returncode == 1 and asked.stderr.splitlines()[-1].startswith(f"ImportError: {line}")


def test_without_scikit_learn_the_estimator_is_the_same(tmp_path):
    text = ("import sys; sys.modules['sklearn'] = None; sys.modules['sklearn.base'] = None\nimport pickle, pinnquad\n"
            "flight = pinnquad.fly(rows=2400)\none = pinnquad.StructuredInverse(epochs=1)\n"
            "assert one.set_params(epochs=2).fit(flight) is one and one.get_params()['epochs'] == 2\n"
            "assert (pickle.loads(pickle.dumps(one)).predict(flight) == one.predict(flight)).all()\n"
            "print(one.score(flight))")
    asked = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, cwd=tmp_path)
    assert float(asked.stdout) > 0.99, asked.stderr

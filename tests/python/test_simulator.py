# SPDX-License-Identifier: MIT
"""The simulator: names, units, effects in flight, the same bits as the program, errors, threads, pickles."""
import _thread
import copy
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import pinnquad
from pinnquad import Effects, FlightEnded, Path, Simulator

GROUND_Z_M = 0.877
WEIGHT_N = 1.5 * 9.80665
SHAPES = {"time_s": (), "linear_acceleration_m_s2": (3,), "angular_acceleration_rad_s2": (3,), "velocity_m_s": (3,),
          "body_rates_rad_s": (3,), "euler_rad": (3,), "altitude_m": (), "commands": (4,)}


# names


def test_every_airframe_flies():
    assert "paper_quadrotor" in pinnquad.airframe_names()
    for name in pinnquad.airframe_names():
        Simulator(name).fly(0.1)


def test_unknown_names_are_answered_with_the_known_ones():
    with pytest.raises(ValueError, match="no airframe named 'kite'; known: .*paper_quadrotor"):
        Simulator("kite")
    with pytest.raises(ValueError, match="no ground effect named 'magic'; known: none, cheeseman_bennett, conyers"):
        Simulator(effects=Effects(ground_effect="magic"))
    simulator = Simulator(effects=Effects(ground_effect="conyers"))
    with pytest.raises(ValueError, match="no ground effect named 'magic'"):
        simulator.set_effects(Effects(ground_effect="magic"))
    assert simulator.effects.ground_effect == "conyers"
    with pytest.raises(ValueError, match="no pilot named 'icarus'; known: random, near_ground, hover"):
        Simulator(pilot="icarus")
    with pytest.raises(ValueError, match="no flight named 'd9'; known: d1, d2"):
        pinnquad.fly("d9")


# the recording


def test_shapes():
    simulator = Simulator(seed=2)
    assert simulator.rows == 0 and len(simulator.recording()) == 0
    assert simulator.recording().commands.shape == (0, 4)
    simulator.fly(3.0)
    rows = simulator.recording()
    assert len(rows) == 60
    for name, shape in SHAPES.items():
        assert rows[name].shape == (60,) + shape and rows[name].dtype == np.float64
        assert np.isfinite(rows[name]).all()


def test_a_recording_is_of_its_own():
    simulator = Simulator(seed=2)
    simulator.fly(1.0)
    first = simulator.recording()
    kept = first.rows.copy()
    simulator.fly(50.0)
    del simulator
    np.testing.assert_array_equal(first.rows, kept)


def test_taken():
    simulator = Simulator()
    simulator.fly(1.0)
    assert len(simulator.take_recording()) == 20 and simulator.rows == 0
    simulator.fly(1.0)
    assert simulator.recording().time_s[0] == 1.05


# the state


def test_hover():
    simulator = Simulator(pilot="hover")
    simulator.fly(1.0)
    state = simulator.state
    assert state["time_s"] == 1.0 == simulator.time_s
    np.testing.assert_allclose(state["position_m"], (0, 0, -35), atol=1e-6)
    np.testing.assert_allclose(state["velocity_m_s"], 0, atol=1e-6)
    np.testing.assert_allclose(state["attitude"], (1, 0, 0, 0), atol=1e-9)
    assert state["altitude_m"] == pytest.approx(35.877, abs=1e-6)
    assert state["rotor_thrust_N"] == pytest.approx(WEIGHT_N, abs=1e-4)
    np.testing.assert_allclose(state["commands"], simulator.hover_commands(), rtol=1e-6)
    np.testing.assert_allclose(state["rotor_commands"], state["commands"], rtol=1e-6)


def test_step():
    simulator = Simulator(pilot="hover")
    hover = simulator.hover_commands()
    simulator.step(hover + [-0.01, 0.01, 0.01, -0.01], 0.05)
    assert simulator.state["body_rates_rad_s"][0] > 0.1  # rolls right
    assert abs(simulator.state["body_rates_rad_s"][1]) < 1e-9
    np.testing.assert_array_equal(simulator.recording().commands[-1], hover + [-0.01, 0.01, 0.01, -0.01])
    simulator.step([0.5, 0.5, 0.5, 0.5])  # one tick
    assert simulator.time_s == pytest.approx(0.052)


@pytest.mark.parametrize("copied", [lambda s: s.copy(), copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s))])
def test_a_copy_flies_on_alone_and_alike(copied):
    simulator = Simulator(seed=9, gyro_noise_rad_s=0.01)
    simulator.fly(2.0)
    simulator.step(simulator.hover_commands(), 0.1)
    simulator.set_effects(Effects(wake=True))
    simulator.take_recording()
    simulator.fly(1.0)
    other = copied(simulator)
    other.fly(2.0)
    assert simulator.time_s == 3.1
    simulator.fly(2.0)
    np.testing.assert_array_equal(simulator.recording().rows, other.recording().rows)
    np.testing.assert_array_equal(simulator.state["position_m"], other.state["position_m"])
    assert other.effects == Effects(wake=True)


# effects


def test_each_effect_does_what_it_says():
    still = Simulator(pilot="hover")
    hover = still.hover_commands()[0]
    by = lambda **changes: Simulator(pilot="hover", effects=Effects(**changes))
    assert by(payload_kg=0.15).hover_commands()[0] == pytest.approx(1.1 * hover, rel=1e-9)  # 10 % of 1.5 kg
    weak = by(fault_rotor=2, fault_share=0.8).hover_commands()
    np.testing.assert_allclose(weak * [1, 1, 0.8, 1], hover, rtol=1e-9)
    sagging = by(battery_cells=4, battery_charge=0.5)
    sagging.fly(9.9)
    volts, volts_of_full = sagging.state["battery_voltage_V"], 4 * 4.1029
    assert 13.5 < volts < 4 * 3.804 and sagging.state["thrust_scale"] == pytest.approx((volts / volts_of_full) ** 2)
    assert sagging.hover_commands()[0] == pytest.approx(hover * (volts_of_full / volts) ** 2)
    recorded = sagging.recording()
    assert recorded.columns == [("battery_voltage", "V")] and abs(recorded["battery_voltage"][-1] - volts) < 0.01
    assert np.diff(recorded["battery_voltage"])[20:].max() < 0.01 and still.recording().columns == []
    assert by(standard_atmosphere=False).hover_commands()[0] < hover  # denser than at 157 m
    assert by(wind_m_s=(8, 0, 0), inflow=True).hover_commands()[0] < 0.97 * hover  # translational lift
    windy = by(wind_m_s=(5, 0, 0))
    for change in ({"rotor_drag": True}, {"linear_drag_N_s_m": 0.5}):
        more = by(wind_m_s=(5, 0, 0), **change)
        assert more.state["aerodynamic_force_N"][0] > windy.state["aerodynamic_force_N"][0] + 0.1, change
    assert by(wind_m_s=(5, 0, 0), drag=False).state["aerodynamic_force_N"][0] == 0
    gusty = by(wind_m_s=(5, 0, 0), turbulence_m_s=5.0)
    assert abs(gusty.state["wind_m_s"] - [5, 0, 0]).max() > 0.05
    nose_up = by(wind_m_s=(-8, 0, 0), flapping=True).hover_commands() - by(wind_m_s=(-8, 0, 0)).hover_commands()
    assert nose_up[1] > 0 > nose_up[0]  # the rear rotors hold against it
    assert by(wind_m_s=(8, 0, 0), wake=True).hover_commands().mean() > by(wind_m_s=(8, 0, 0)).hover_commands().mean()


# the same bits


def test_same_seed_same_flight():
    flights = []
    for seed, portions in ((7, [10.0]), (7, [3.0, 0.5, 6.5]), (8, [10.0])):
        simulator = Simulator(seed=seed)
        for seconds in portions:
            simulator.fly(seconds)
        flights.append(simulator.recording().commands)
    np.testing.assert_array_equal(flights[0], flights[1])
    assert (flights[0] != flights[2]).any()


@pytest.mark.parametrize("name", ["d1", "d2", "d3", "harder"])
def test_the_file_of_the_program(program, tmp_path, name):
    ours, theirs = tmp_path / "python.csv", tmp_path / "fly.csv"
    program("fly", name, "--seed", 3, "--samples", 1000, "--out", theirs)
    pinnquad.fly(name, seed=3, rows=1000).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()


def test_the_file_of_the_program_with_another_airframe_and_noise(program, tmp_path):
    ours, theirs = tmp_path / "python.csv", tmp_path / "fly.csv"
    airframe = pinnquad.Airframe("racer_5_inch")
    airframe.mass_kg *= 1.1
    airframe.save(tmp_path / "heavy.toml")
    program("fly", "d1", "--airframe", tmp_path / "heavy.toml", "--seed", 5, "--samples", 200, "--gyro-noise", 0.05,
            "--latency", 20, "--out", theirs)
    pinnquad.fly(airframe=airframe, seed=5, rows=200, gyro_noise_rad_s=0.05, command_latency_s=0.02).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()


# errors

NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize("arguments", [
    {"start_m": (0, 0, GROUND_Z_M)}, {"start_m": (NAN, 0, -3)}, {"max_speed_m_s": NAN}, {"gyro_noise_rad_s": -1.0},
    {"command_latency_s": NAN}, {"derivative_interval_s": 0.0}])
def test_arguments_that_make_no_sense(arguments):
    with pytest.raises(ValueError, match=next(iter(arguments))):
        Simulator(**arguments)


@pytest.mark.parametrize("changes, error", [
    ({"wind_m_s": (NAN, 0, 0)}, ValueError), ({"gust_m_s": (0, INF, 0)}, ValueError),
    ({"gust_period_s": 0.0}, ValueError), ({"payload_kg": -1.0}, ValueError),
    ({"battery_Ah": NAN}, ValueError), ({"wind_m_s": 3}, TypeError),
    ({"drag": "yes"}, TypeError), ({"fault_rotor": -1}, TypeError), ({"turbulence_seed": 2**64}, TypeError),
    ({"wind_m_s": (1, 2)}, TypeError)])
def test_effects_that_make_no_sense(changes, error):
    with pytest.raises(error, match=next(iter(changes))) as caught:
        Simulator(effects=Effects(**changes))
    assert "\n" not in str(caught.value)
    with pytest.raises(TypeError, match="pinnquad.Effects"):
        Simulator(effects=changes)


def test_effects_that_this_airframe_cannot_have():
    with pytest.raises(pinnquad.Error, match="out_of_range"):
        Simulator(effects=Effects(fault_rotor=4, fault_share=0.5))
    with pytest.raises(FlightEnded, match="no_solution"):
        Simulator(effects=Effects(fault_share=0.0))


def test_seconds_and_commands_that_make_no_sense():
    with pytest.raises(TypeError):
        Simulator(seed=-1)
    simulator = Simulator()
    for seconds in (-1.0, NAN, INF):
        with pytest.raises(ValueError, match="seconds"):
            simulator.fly(seconds)
    for commands in ([0.5] * 3, [[0.5] * 4], [0.5, 0.5, NAN, 0.5]):
        with pytest.raises(ValueError, match="commands must be four"):
            simulator.step(commands, 1.0)
    assert simulator.time_s == 0.0


def test_a_flight_that_ended():
    simulator = Simulator(pilot="hover")
    with pytest.raises(FlightEnded, match=r"ended at 4\.\d+ s, north .*: it came down to the ground") as caught:
        simulator.step([0, 0, 0, 0], 10.0)
    error = caught.value
    assert isinstance(error, pinnquad.Error)
    assert error.time_s == simulator.time_s and error.altitude_m <= 0.0 and error.velocity_m_s[2] > 5.0
    np.testing.assert_array_equal(error.position_m, simulator.state["position_m"])
    assert error.reason == "it came down to the ground"
    assert not simulator.flying and simulator.rows > 40
    with pytest.raises(FlightEnded):
        simulator.fly(1.0)


def test_a_file_that_cannot_be_written():
    with pytest.raises(OSError, match="/no/such/folder/flight.csv"):
        pinnquad.fly(rows=20).save("/no/such/folder/flight.csv")


# threads

LONG_S = 30000.0  # some ten seconds of work: far more than the tests wait for


@pytest.fixture
def ctrl_c():
    """A shell that started this in the background has switched Ctrl-C off."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield lambda after_s: threading.Timer(after_s, _thread.interrupt_main).start()
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_stops_a_long_flight_which_can_go_on(ctrl_c):
    simulator = Simulator(seed=1)
    ctrl_c(0.3)  # needs the GIL: fly must have let go of it
    with pytest.raises(KeyboardInterrupt):
        simulator.fly(LONG_S)
    stopped_s = simulator.time_s
    assert 0.0 < stopped_s < LONG_S
    simulator.fly(1.0)
    assert simulator.time_s == pytest.approx(stopped_s + 1.0, abs=1e-6)


def test_what_a_handler_raises_ends_a_training(flight):
    def late(number, frame):
        raise TimeoutError("too late")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    with pytest.raises(TimeoutError, match="too late"):
        pinnquad.train(flight, models=["paper_vanilla"], seeds=50, epochs=3000)
    signal.signal(signal.SIGALRM, before)


def test_ctrl_c_stops_a_training(ctrl_c, flight):
    ctrl_c(1.0)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        pinnquad.train(flight, models=["paper_vanilla", "paper_physics_informed"], seeds=50, epochs=3000)
    assert time.monotonic() - start < 60
    # the next one is not interrupted
    assert pinnquad.train(flight, models=["structured"], seeds=1, epochs=1).kind == "structured"


def test_a_simulator_in_flight_refuses_a_second_thread():
    simulator = Simulator(seed=1)
    thread = threading.Thread(target=simulator.fly, args=(1500.0,))
    thread.start()
    refused = 0
    while thread.is_alive():
        try:
            simulator.state
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
        time.sleep(0.001)
    thread.join()
    assert refused > 0 and simulator.time_s == 1500.0


# pilots of Python


def circle(time_s, position_m, velocity_m_s):
    """Three metres around the start, a turn in 12 s, pulled back to the path."""
    angle = 2 * np.pi * time_s / 12
    place = np.array([3 * np.sin(angle), 3 - 3 * np.cos(angle), -35.0])
    along = 2 * np.pi / 12 * np.array([3 * np.cos(angle), 3 * np.sin(angle), 0.0])
    return along + 1.0 * (place - position_m)


def test_a_path_of_arrays_is_flown():
    """As the same path by a callable; a parabola is met to the last bit of its numbers."""
    times = np.linspace(0, 12, 49)
    angle = 2 * np.pi * times / 12
    places = np.stack([3 * np.sin(angle), 3 - 3 * np.cos(angle), np.full(49, -35.0)], axis=1)
    path = Path(times, places)
    np.testing.assert_allclose(path(times), places, atol=1e-12)
    between = np.linspace(0.5, 11.5, 200)
    turned = 2 * np.pi * between / 12
    np.testing.assert_allclose(path(between), np.stack([3 * np.sin(turned), 3 - 3 * np.cos(turned), np.full(200, -35.0)], axis=1), atol=1e-3)
    step = 1e-6
    np.testing.assert_allclose(path.velocity_m_s(between), (path(between + step) - path(between - step)) / (2 * step), atol=1e-6)
    np.testing.assert_allclose(path(13.0), places[-1], atol=1e-12)
    assert (path.velocity_m_s([-1.0, 13.0]) == 0).all()
    fall = Path([0.0, 1.0, 3.0, 4.0], [(1, 0, 2 * t * t) for t in (0.0, 1.0, 3.0, 4.0)])
    np.testing.assert_allclose(fall(np.array([0.3, 2.0, 3.7]))[:, 2], 2 * np.array([0.3, 2.0, 3.7]) ** 2, rtol=1e-12)
    simulator = Simulator(pilot=path)
    simulator.fly(12.0)
    by_callable = Simulator(pilot=circle)
    by_callable.fly(12.0)
    np.testing.assert_allclose(simulator.state["position_m"], by_callable.state["position_m"], atol=0.02)
    np.testing.assert_allclose(simulator.state["position_m"], places[-1], atol=0.5)
    assert abs(np.linalg.norm(simulator.recording().velocity_m_s, axis=1)[100:].mean() - 2 * np.pi * 3 / 12) < 0.15
    np.testing.assert_allclose(simulator.recording().velocity_m_s, by_callable.recording().velocity_m_s, atol=0.02)
    for one in simulator, by_callable:
        again = pickle.loads(pickle.dumps(one))
        again.fly(1.0), one.fly(1.0)
        np.testing.assert_array_equal(again.recording().rows, one.recording().rows)


@pytest.mark.parametrize("times, places, words", [
    ([0.0], [(0, 0, 0)], "two times or more"), ([0.0, 1.0], np.zeros((2, 2)), r"found shapes \(2,\) and \(2, 2\)"),
    ([0.0, 0.0], np.zeros((2, 3)), "times that rise"), ([0.0, np.nan], np.zeros((2, 3)), "finite"),
    ([0.0, 1.0], np.full((2, 3), np.inf), "finite"), ([0.0, 1.0], np.ma.masked_less(np.zeros((2, 3)), 1), "without a mask")])
def test_paths_that_are_none(times, places, words):
    with pytest.raises(ValueError, match=words):
        Path(times, places)


def test_a_yaw_rate_and_a_velocity():
    simulator = Simulator(pilot=lambda *_: ((0, 0, 0), 0.5))
    simulator.fly(2.0)
    assert simulator.state["body_rates_rad_s"][2] == pytest.approx(0.5, abs=0.05)
    seen = []
    Simulator(pilot=lambda time_s, position_m, velocity_m_s: seen.append((time_s, position_m, velocity_m_s)) or (1, 0, 0)).fly(0.01)
    assert [round(one[0], 6) for one in seen] == [0.0, 0.002, 0.004, 0.006, 0.008] and seen[0][1].tolist() == [0, 0, -35]


@pytest.mark.parametrize("pilot, error, words", [
    (lambda *_: 3, TypeError, "pilot: expected a velocity .*, found 3"), (lambda *_: (1, 2), TypeError, "found"),
    (lambda *_: None, TypeError, "found None"), (lambda *_: (1, np.nan, 0), ValueError, "pilot: its velocity"),
    (lambda *_: ((1, 0, 0), np.inf), ValueError, "pilot: its yaw rate"), (lambda *_: 1 / 0, ZeroDivisionError, "division"),
    (3, TypeError, "pilot must be a name or a callable")])
def test_pilots_that_are_none(pilot, error, words):
    with pytest.raises(error, match=words):
        simulator = Simulator(pilot=pilot)
        try:
            simulator.fly(1.0)
        finally:
            assert simulator.time_s == 0.0 and simulator.flying

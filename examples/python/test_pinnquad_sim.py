#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Tests of the module pinnquad_sim: names, shapes, units, the switch, the same bits as pinnquad fly, errors.

PINNQUAD_PROGRAM: the program pinnquad; without it the comparison with it is skipped.
"""
import _thread
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import pinnquad_sim
from pinnquad_sim import FlightEnded, Simulator

GROUND_Z_M = 0.877
RADIUS_M = 0.1143
WEIGHT_N = 1.5 * 9.80665

SHAPES = {
    "time_s": (),
    "linear_acceleration_m_s2": (3,),
    "angular_acceleration_rad_s2": (3,),
    "velocity_m_s": (3,),
    "body_rates_rad_s": (3,),
    "euler_rad": (3,),
    "altitude_m": (),
    "commands": (4,),
}


def at_height(height_m):
    return (0.0, 0.0, GROUND_Z_M - height_m)


def down_velocity(rows):
    """World z of the body-frame velocity: the third row of R = Rz Ry Rx."""
    roll, pitch = rows["euler_rad"][:, 0], rows["euler_rad"][:, 1]
    v = rows["velocity_m_s"]
    return -np.sin(pitch) * v[:, 0] + np.cos(pitch) * (np.sin(roll) * v[:, 1] + np.cos(roll) * v[:, 2])


class Names(unittest.TestCase):
    def test_known_names(self):
        self.assertIn("paper_quadrotor", pinnquad_sim.airframes())
        self.assertEqual(pinnquad_sim.ground_effects(), ["none", "cheeseman_bennett", "conyers"])
        for airframe in pinnquad_sim.airframes():
            Simulator(airframe).fly(0.1)

    def test_unknown_names_are_answered_with_the_known_ones(self):
        with self.assertRaisesRegex(ValueError, "no airframe named 'kite'; known: .*paper_quadrotor"):
            Simulator("kite")
        for name in pinnquad_sim.airframes():
            with self.assertRaisesRegex(ValueError, name.replace(".", r"\.")):
                Simulator("kite")
        effects = "no ground effect named 'magic'; known: none, cheeseman_bennett, conyers"
        with self.assertRaisesRegex(ValueError, effects):
            Simulator(ground_effect="magic")
        simulator = Simulator(ground_effect="conyers")
        with self.assertRaisesRegex(ValueError, effects):
            simulator.set_ground_effect("magic")
        self.assertEqual(simulator.ground_effect, "conyers")
        with self.assertRaisesRegex(ValueError, "no pilot named 'icarus'; known: random, hover"):
            Simulator(pilot="icarus")

    def test_everything_is_documented(self):
        self.assertIn("NED", pinnquad_sim.__doc__)
        for name in dir(Simulator):
            if not name.startswith("_"):
                self.assertGreater(len(getattr(Simulator, name).__doc__), 20, name)


class Recording(unittest.TestCase):
    def test_shapes(self):
        simulator = Simulator(seed=2)
        self.assertEqual(simulator.rows, 0)
        for name, array in simulator.recording().items():
            self.assertEqual(array.shape, (0,) + SHAPES[name])
        simulator.fly(3.0)
        rows = simulator.recording()
        self.assertEqual(set(rows), set(SHAPES))
        for name, array in rows.items():
            self.assertEqual(array.shape, (60,) + SHAPES[name])
            self.assertEqual(array.dtype, np.float64)
            self.assertTrue(np.isfinite(array).all())

    def test_arrays_own_their_memory(self):
        simulator = Simulator(seed=2)
        simulator.fly(1.0)
        first, again = simulator.recording(), simulator.recording()
        kept = {name: array.copy() for name, array in first.items()}
        for array in again.values():
            self.assertTrue(array.flags.owndata)
            array[...] = -1.0
        simulator.fly(50.0)
        del simulator
        for name, array in first.items():
            np.testing.assert_array_equal(array, kept[name])

    def test_units_and_frames(self):
        simulator = Simulator(seed=1)
        simulator.fly(60.0)
        rows = simulator.recording()
        np.testing.assert_allclose(rows["time_s"], 0.05 * np.arange(1, 1201), rtol=1e-12)
        climb = np.diff(rows["altitude_m"]) / 0.05
        down = down_velocity(rows)
        self.assertLess(np.abs(climb + (down[1:] + down[:-1]) / 2).max(), 0.03)  # m/s; jerk h^2 / 12, h = 0.05 s
        self.assertTrue(((rows["commands"] >= 0) & (rows["commands"] <= 1)).all())
        signed = rows["commands"] @ [-1, 1, 1, -1]  # Eq. (2), roll
        self.assertGreater(np.corrcoef(signed, rows["angular_acceleration_rad_s2"][:, 0])[0, 1], 0.95)
        self.assertLess(np.linalg.norm(rows["velocity_m_s"], axis=1).max(), 8.5)

    def test_cleared(self):
        simulator = Simulator()
        simulator.fly(1.0)
        simulator.clear_recording()
        self.assertEqual(simulator.rows, 0)
        simulator.fly(1.0)
        self.assertEqual(simulator.recording()["time_s"][0], 1.05)

    def test_noise_is_of_the_recording_only(self):
        exact, noisy = Simulator(seed=4), Simulator(seed=4, gyro_noise_rad_s=0.05, command_jitter_s=0.01)
        for simulator in (exact, noisy):
            simulator.fly(60.0)
        np.testing.assert_array_equal(exact.state["position_m"], noisy.state["position_m"])
        a, b = exact.recording(), noisy.recording()
        np.testing.assert_array_equal(a["altitude_m"], b["altitude_m"])
        self.assertAlmostEqual((b["body_rates_rad_s"] - a["body_rates_rad_s"]).std(), 0.05, delta=0.005)


class State(unittest.TestCase):
    def test_hover(self):
        simulator = Simulator(pilot="hover")
        simulator.fly(1.0)
        state = simulator.state
        self.assertEqual(state["time_s"], 1.0)
        self.assertEqual(simulator.time_s, 1.0)
        np.testing.assert_allclose(state["position_m"], (0, 0, -35), atol=1e-6)
        np.testing.assert_allclose(state["velocity_m_s"], 0, atol=1e-6)
        np.testing.assert_allclose(state["attitude"], (1, 0, 0, 0), atol=1e-9)
        self.assertAlmostEqual(state["altitude_m"], 35.877, places=6)
        self.assertAlmostEqual(state["rotor_thrust_N"], WEIGHT_N, places=4)
        np.testing.assert_allclose(state["commands"], simulator.hover_commands(), rtol=1e-6)
        np.testing.assert_allclose(state["rotor_commands"], state["commands"], rtol=1e-6)

    def test_wind(self):
        simulator = Simulator(pilot="hover", wind=(2.5, 0, 0), gust=(2.5, 0, 0), gust_period_s=10.0)  # D3
        simulator.fly(2.5)
        np.testing.assert_allclose(simulator.state["wind_m_s"], (5, 0, 0), atol=1e-9)
        drag_N = 5.38309e-3 * 1.21 * 5.0**2  # k rho v^2
        self.assertAlmostEqual(simulator.state["aerodynamic_force_N"][0], drag_N, delta=0.01)
        self.assertGreater(simulator.state["position_m"][0], 0.01)  # blown north
        simulator.fly(5.0)
        np.testing.assert_allclose(simulator.state["wind_m_s"], (0, 0, 0), atol=1e-9)

    def test_step(self):
        simulator = Simulator(pilot="hover")
        hover = simulator.hover_commands()
        simulator.step(hover + [-0.01, 0.01, 0.01, -0.01], 0.05)
        self.assertGreater(simulator.state["body_rates_rad_s"][0], 0.1)  # rolls right
        self.assertLess(abs(simulator.state["body_rates_rad_s"][1]), 1e-9)
        np.testing.assert_array_equal(simulator.recording()["commands"][-1], hover + [-0.01, 0.01, 0.01, -0.01])
        simulator.step([0.5, 0.5, 0.5, 0.5])  # one tick
        self.assertAlmostEqual(simulator.time_s, 0.052)

    def test_copy_flies_on_alone(self):
        simulator = Simulator(seed=9)
        simulator.fly(2.0)
        other = simulator.copy()
        other.set_ground_effect("conyers")
        other.fly(2.0)
        self.assertEqual((simulator.time_s, simulator.ground_effect), (2.0, "none"))
        other.set_ground_effect("none")
        simulator.fly(2.0)
        # 30 m up there is no effect, but another inverse: its rounding differs
        np.testing.assert_allclose(simulator.state["position_m"], other.state["position_m"], rtol=0, atol=1e-9)

    def test_repr(self):
        simulator = Simulator(seed=9, ground_effect="conyers")
        simulator.fly(1.0)
        self.assertIn("paper_quadrotor, seed 9, ground effect conyers: 1.000 s, 20 rows", repr(simulator))


class GroundEffect(unittest.TestCase):
    def test_hover_needs_less_by_the_ratio(self):
        height_m = 0.3
        simulator = Simulator(pilot="hover", start_m=at_height(height_m))
        none = simulator.hover_commands()
        simulator.set_ground_effect("cheeseman_bennett")
        ratio = 1.0 / (1.0 - (RADIUS_M / (4.0 * height_m)) ** 2)
        np.testing.assert_allclose(none / simulator.hover_commands(), ratio, rtol=5e-6)
        self.assertGreater(ratio, 1.009)

    def test_conyers_at_known_points(self):
        # Z/R: ratio, calculated from the published coefficients for L = 690 mm, R = 114.3 mm
        for x, ratio in ((0.5, 1.1404), (1.49, 0.9922), (3.56, 1.0542)):
            simulator = Simulator(pilot="hover", start_m=at_height(x * RADIUS_M))
            none = simulator.hover_commands()
            simulator.set_ground_effect("conyers")
            np.testing.assert_allclose(none / simulator.hover_commands(), ratio, atol=1e-4)

    def test_switched_in_flight(self):
        height_m = 3.56 * RADIUS_M
        simulator = Simulator(pilot="hover", start_m=at_height(height_m))
        simulator.fly(2.0)
        simulator.set_ground_effect("conyers")
        self.assertEqual(simulator.time_s, 2.0)
        simulator.fly(2.0)
        rows = simulator.recording()
        before, after = rows["commands"][39].mean(), rows["commands"][79].mean()
        self.assertAlmostEqual(before / after, 1.0542, delta=2e-4)
        self.assertAlmostEqual(simulator.state["rotor_thrust_N"] * 1.0542, WEIGHT_N, delta=0.003)
        self.assertAlmostEqual(rows["altitude_m"][-1], height_m, delta=0.01)

    def test_the_present_effect_set_again_changes_nothing(self):
        flights = []
        for again in (True, False):
            simulator = Simulator(seed=3, ground_effect="conyers", start_m=at_height(0.3))
            simulator.fly(2.0)
            if again:
                simulator.set_ground_effect("none")
                simulator.set_ground_effect("conyers")
            simulator.fly(2.0)
            flights.append(simulator.recording()["commands"])
        np.testing.assert_array_equal(*flights)


class SameBits(unittest.TestCase):
    def test_same_seed_same_flight(self):
        flights = []
        for seed, portions in ((7, [10.0]), (7, [3.0, 0.5, 6.5]), (8, [10.0])):
            simulator = Simulator(seed=seed)
            for seconds in portions:
                simulator.fly(seconds)
            flights.append(simulator.recording()["commands"])
        np.testing.assert_array_equal(flights[0], flights[1])
        self.assertTrue((flights[0] != flights[2]).any())

    @unittest.skipUnless(os.environ.get("PINNQUAD_PROGRAM"), "PINNQUAD_PROGRAM does not name the program")
    def test_the_file_of_the_program_fly(self):
        with tempfile.TemporaryDirectory() as folder:
            for airframe, seed in (("paper_quadrotor", 3), (pinnquad_sim.airframes()[-1], 5)):
                ours, theirs = pathlib.Path(folder, "python.csv"), pathlib.Path(folder, "fly.csv")
                subprocess.run([os.environ["PINNQUAD_PROGRAM"], "fly", "--airframe", airframe, "--seed", str(seed),
                                "--samples", "1000", "--out", str(theirs)], check=True, stdout=subprocess.DEVNULL)
                simulator = Simulator(airframe, seed)
                simulator.fly(50.0)
                simulator.save_csv(ours)
                self.assertEqual(ours.read_bytes(), theirs.read_bytes())


class Errors(unittest.TestCase):
    def test_values_that_make_no_sense(self):
        nan = float("nan")
        for arguments in ({"wind": (nan, 0, 0)}, {"gust": (0, float("inf"), 0)}, {"gust_period_s": 0.0},
                          {"start_m": (0, 0, GROUND_Z_M)}, {"start_m": (nan, 0, -3)}, {"max_speed_m_s": nan},
                          {"gyro_noise_rad_s": -1.0}, {"command_latency_s": nan}, {"derivative_interval_s": 0.0}):
            with self.subTest(arguments), self.assertRaisesRegex(ValueError, next(iter(arguments))):
                Simulator(**arguments)
        with self.assertRaises(TypeError):
            Simulator(seed=-1)
        simulator = Simulator()
        for seconds in (-1.0, nan, float("inf")):
            with self.assertRaisesRegex(ValueError, "seconds"):
                simulator.fly(seconds)
        for commands in ([0.5] * 3, [[0.5] * 4], [0.5, 0.5, nan, 0.5]):
            with self.assertRaisesRegex(ValueError, "commands must be four"):
                simulator.step(commands, 1.0)
        self.assertEqual(simulator.time_s, 0.0)

    def test_a_flight_that_ended(self):
        simulator = Simulator(pilot="hover")
        with self.assertRaisesRegex(FlightEnded, r"ended at 4\.\d+ s, north .*: it came down to the ground") as caught:
            simulator.step([0, 0, 0, 0], 10.0)
        error = caught.exception
        self.assertIsInstance(error, RuntimeError)
        self.assertEqual(error.time_s, simulator.time_s)
        self.assertLessEqual(error.altitude_m, 0.0)
        self.assertGreater(error.velocity_m_s[2], 5.0)
        np.testing.assert_array_equal(error.position_m, simulator.state["position_m"])
        self.assertEqual(error.reason, "it came down to the ground")
        self.assertFalse(simulator.flying)
        self.assertGreater(simulator.rows, 40)
        with self.assertRaises(FlightEnded):
            simulator.fly(1.0)

    def test_a_file_that_cannot_be_written(self):
        simulator = Simulator()
        simulator.fly(1.0)
        with self.assertRaisesRegex(OSError, "/no/such/folder/flight.csv"):
            simulator.save_csv("/no/such/folder/flight.csv")


class Threads(unittest.TestCase):
    LONG_S = 30000.0  # some ten seconds of work: far more than the tests wait for

    def test_ctrl_c_stops_a_long_flight_which_can_go_on(self):
        # a shell that started this in the background has switched Ctrl-C off
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        simulator = Simulator(seed=1)
        threading.Timer(0.3, _thread.interrupt_main).start()  # needs the GIL: fly must have let go of it
        with self.assertRaises(KeyboardInterrupt):
            simulator.fly(self.LONG_S)
        stopped_s = simulator.time_s
        self.assertTrue(0.0 < stopped_s < self.LONG_S)
        simulator.fly(1.0)
        self.assertAlmostEqual(simulator.time_s, stopped_s + 1.0, places=6)

    def test_a_simulator_in_flight_refuses_a_second_thread(self):
        simulator = Simulator(seed=1)
        thread = threading.Thread(target=simulator.fly, args=(1500.0,))
        thread.start()
        refused = 0
        while thread.is_alive():
            try:
                simulator.state
            except RuntimeError as error:
                self.assertIn("another thread", str(error))
                refused += 1
            time.sleep(0.001)
        thread.join()
        self.assertGreater(refused, 0)
        self.assertEqual(simulator.time_s, 1500.0)


if __name__ == "__main__":
    print("Python %s, NumPy %s" % (sys.version.split()[0], np.__version__))
    unittest.main()

# SPDX-License-Identifier: MIT
"""Forces, torques and winds of Python's, against SciPy's integrator of the same equations."""
import pickle
import traceback

import numpy as np
import pytest

import pinnquad
from pinnquad import Effects, FlightEnded, HoverEnv, Simulator, VectorHoverEnv, Vehicles

BARE = Effects(drag=False, standard_atmosphere=False)
GRAVITY = np.array([0, 0, 9.80665])
PLACE_M = np.array([0.0, 0.0, -35.0])


def force_N(time_s, position_m, velocity_m_s):
    """A spring to where it began, a drag, a push that swings."""
    return -2 * (position_m - PLACE_M) - 0.1 * np.linalg.norm(velocity_m_s, axis=-1, keepdims=True) * velocity_m_s + np.stack(
        [3 * np.sin(5 * time_s), np.zeros_like(time_s), np.cos(3 * time_s)], axis=-1)


def torque_N_m(time_s, body_rates_rad_s):
    return -0.01 * body_rates_rad_s + np.stack([0.01 * np.cos(4 * time_s), 0.02 * np.sin(time_s), 0.005 + 0 * time_s], axis=-1)


def wrench(motion):
    return force_N(motion.time_s, motion.position_m, motion.velocity_m_s), torque_N_m(motion.time_s, motion.body_rates_rad_s)


def wind_m_s(time_s, position_m):
    return np.stack([4 * np.sin(2 * time_s), 0.3 * position_m[:, 0], np.cos(time_s)], axis=1)


def judge(airframe, derivatives, seconds):
    """SciPy's last state of the rigid body under a thrust that holds its weight: position, velocity, attitude, rates."""
    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp
    inertia = np.array(airframe.inertia_kg_m2)

    def rate(t, y):
        x, v, (w, *q), omega = y[:3], y[3:6], y[6:10], y[10:]
        up = np.array([2 * (w * q[1] + q[0] * q[2]), 2 * (q[1] * q[2] - w * q[0]), w * w - q[0]**2 - q[1]**2 + q[2]**2])
        force, torque = derivatives(t, x, v, omega)
        turn = 0.5 * np.concatenate([[-np.dot(q, omega)], w * omega + np.cross(q, omega)])
        spin = (torque - np.cross(omega, inertia * omega)) / inertia
        return np.concatenate([v, GRAVITY - GRAVITY[2] * up + force / airframe.mass_kg, turn, spin])

    start = np.concatenate([PLACE_M, np.zeros(3), [1, 0, 0, 0], np.zeros(3)])
    return solve_ivp(rate, (0, seconds), start, rtol=1e-12, atol=1e-12).y[:, -1]


def of_wrench(t, x, v, omega):
    return force_N(np.array(t), x, v), torque_N_m(np.array(t), omega)


def of_wind(drag):
    return lambda t, x, v, omega: (-drag * (v - wind_m_s(np.array([t]), x[None])[0]), np.zeros(3))


def flown(effects, seconds=1.0):
    """The same of a simulator, whose rotors begin in the hover without these effects."""
    simulator = Simulator(effects=BARE, pilot="hover")
    simulator.set_effects(effects)
    simulator.step(Vehicles(1, effects=BARE).hover_commands(), seconds)
    return np.concatenate([simulator.state[name] for name in ("position_m", "velocity_m_s", "attitude", "body_rates_rad_s")])


def test_a_simulator_follows_the_judge():
    np.testing.assert_allclose(flown(BARE.but(wrench=wrench)), judge(Vehicles(1).airframe, of_wrench, 1.0), atol=2e-12)
    drag = 0.5
    np.testing.assert_allclose(flown(BARE.but(wind_m_s=wind_m_s, linear_drag_N_s_m=drag)),
                               judge(Vehicles(1).airframe, of_wind(drag), 1.0), atol=2e-12)


@pytest.mark.parametrize("effects, derivatives", [(BARE.but(wrench=wrench), of_wrench),
                                                  (BARE.but(wind_m_s=wind_m_s, linear_drag_N_s_m=0.5), of_wind(0.5))])
def test_vehicles_follow_the_judge_in_second_order(effects, derivatives):
    def off(step_s):
        vehicles = Vehicles(3, effects=effects, physics_step_s=step_s)
        vehicles.rotor_commands[:] = Vehicles(1, effects=BARE).hover_commands()
        vehicles.step(vehicles.rotor_commands, 1.0)
        assert (vehicles.state == vehicles.state[0]).all()
        return np.abs(vehicles.state[0, :13] - judge(vehicles.airframe, derivatives, 1.0)).max()

    assert off(0.001) < 1e-6 and off(0.002) == pytest.approx(4 * off(0.001), rel=0.1)


def test_a_payload_is_pushed_too():
    push = Effects(drag=False, wrench=lambda motion: ([2.0, 0, 0], None))
    for one in (Vehicles(1, effects=push), Vehicles(1, effects=push.but(payload_kg=1.5))):
        one.step(one.hover_commands()[None], 0.1)
        mass_kg = one.airframe.mass_kg + one.effects.payload_kg
        assert one.velocity_m_s[0, 0] == pytest.approx(0.2 / mass_kg, rel=1e-9)


def test_a_refused_vehicle_stays():
    vehicles = Vehicles(2, effects=Effects(wrench=wrench))
    commands, before = np.tile(vehicles.hover_commands(), (2, 1)), vehicles.state.copy()
    commands[1, 2] = np.nan
    assert [pinnquad.Status(s).name for s in vehicles.step(commands, 0.01)] == ["ok", "not_finite"]
    np.testing.assert_array_equal(vehicles.state[1], before[1])
    assert vehicles.velocity_m_s[0, 0] != 0


def test_a_motion_is_that_of_the_vehicle():
    seen = []

    def watch(motion):
        seen.append((len(motion), motion.attitude.copy(), motion.air_velocity_m_s.copy(), motion.rotor_speed_rev_s.copy()))
        np.testing.assert_allclose(motion.to_world([0, 0, -1.0])[0], [0, 0, -1], atol=1e-12)
        return None, None

    effects = Effects(wrench=watch, wind_m_s=(3, 0, 0), battery_cells=4, battery_charge=0.5)
    many = Vehicles(2, effects=effects)
    seen.clear()
    many.step(np.tile(many.hover_commands(), (2, 1)), 0.003)
    assert [rows for rows, *_ in seen if rows == 2] == [2] * 4  # of three steps the starts, and the last one's end
    one = Simulator(effects=effects, pilot="hover")
    seen.clear()
    state = one.state
    (rows, attitude, through_air, speeds), = seen
    assert rows == 1 and (attitude == [1, 0, 0, 0]).all()
    np.testing.assert_allclose(through_air, [[-3, 0, 0]], atol=1e-12)
    airframe = one.airframe
    thrust = (airframe.thrust_coefficient * state["air_density_kg_m3"] * airframe.propeller_diameter_m**4 * speeds**2).sum()
    assert thrust == pytest.approx(state["rotor_thrust_N"], rel=1e-6)  # of a density of 1.225


def test_a_recording_has_the_force():
    """An own push is in the recorded acceleration, and the pilot's inverse knows it."""
    simulator = Simulator(effects=BARE.but(wrench=lambda motion: ([1.5, 0, 0], None)))
    simulator.step(Vehicles(1, effects=BARE).hover_commands(), 0.05)
    np.testing.assert_allclose(simulator.recording().linear_acceleration_m_s2,
                               [[1.5 / simulator.airframe.mass_kg, 0, 0]], atol=1e-9)
    lifted = Simulator(effects=BARE.but(wrench=lambda motion: ([0, 0, -2.0], None)), pilot="hover")
    lifted.fly(0.5)
    np.testing.assert_allclose(lifted.state["position_m"], PLACE_M, atol=1e-9)
    assert lifted.state["rotor_thrust_N"] == pytest.approx(lifted.airframe.mass_kg * GRAVITY[2] - 2)
    np.testing.assert_allclose(lifted.state["aerodynamic_force_N"], [0, 0, -2])


def test_copies_and_pickles_fly_on_alike():
    simulator = Simulator(effects=Effects(wrench=wrench, wind_m_s=wind_m_s))
    simulator.fly(0.2)
    others = [simulator.copy(), pickle.loads(pickle.dumps(simulator))]
    for one in (simulator, *others):
        one.fly(0.2)
        np.testing.assert_array_equal(one.state["position_m"], simulator.state["position_m"])


class Broken(Exception):
    pass


def breaks_at(time_s):
    def broken(motion):
        if motion.time_s[0] > time_s:
            raise Broken("no such air")
        return None, None

    return broken


@pytest.mark.parametrize("effects, error, words", [
    (Effects(wrench=breaks_at(0.1)), Broken, "no such air"),
    (Effects(wrench=lambda m: (np.full(3, np.nan if m.time_s[0] > 0.1 else 0), None)), ValueError, r"wrench\(\), force_N.*finite"),
    (Effects(wrench=lambda m: (None, np.zeros(3 if m.time_s[0] < 0.1 else 2))), ValueError, r"torque_N_m must be \(3,\) or"),
    (Effects(wrench=lambda m: np.zeros(3) if m.time_s[0] > 0.1 else (None, None)), TypeError, "must return"),
    (Effects(wind_m_s=lambda t, x: np.zeros(3) if t[0] < 0.1 else None), TypeError, "returned None"),
    (Effects(wind_m_s=lambda t, x: np.zeros(3) if t[0] < 0.1 else "calm"), TypeError, "wind_m_s")])
def test_what_fails_leaves_all_as_it_was(effects, error, words):
    simulator = Simulator(effects=effects)
    simulator.fly(0.06)
    many = Vehicles(9, effects=effects)
    commands = np.tile(many.hover_commands(), (9, 1))
    many.step(commands, 0.05)
    before = simulator.state, many.state.copy(), simulator.rows
    for work in (lambda: simulator.fly(1.0), lambda: simulator.step(commands[0], 1.0), lambda: many.step(commands, 0.5)):
        with pytest.raises(error, match=words) as raised:
            work()
        if error is Broken:
            assert "broken" in [frame.name for frame in traceback.extract_tb(raised.value.__traceback__)]
    assert repr(simulator.state) == repr(before[0]) and simulator.rows == before[2]
    np.testing.assert_array_equal(many.state, before[1])
    for one in (simulator, pickle.loads(pickle.dumps(Simulator()))):  # and flies on
        one.set_effects(Effects())
        one.fly(0.2)
    assert simulator.time_s == pytest.approx(0.26)


def test_what_is_no_effect():
    for effects, error, words in ((Effects(wrench=3), TypeError, "wrench must be a callable or None, found 3"),
                                  (Effects(wind_m_s="calm"), TypeError, "wind_m_s can't be 'calm'"),
                                  (Effects(wrench=breaks_at(-1)), Broken, "no such air")):
        for made in (Simulator, lambda effects: Vehicles(2, effects=effects)):
            with pytest.raises(error, match=words):
                made(effects=effects)
    with pytest.raises(ValueError, match="no wind_m_s.. with ground_contact"):
        Vehicles(2, effects=Effects(wind_m_s=wind_m_s, ground_contact=True))
    with pytest.raises(FlightEnded, match="ground"):
        Simulator(effects=Effects(wrench=lambda motion: ([0, 0, 100.0], None)), pilot=lambda *_: (0, 0, 0)).fly(30)


def test_environments_have_them():
    pushed = Effects(wrench=lambda motion: (-0.3 * motion.velocity_m_s, None))
    for kind, count in ((HoverEnv, ()), (VectorHoverEnv, (4,))):
        still, slowed = (kind(*count, effects=effects) for effects in (BARE, BARE.but(wrench=pushed.wrench)))
        for environment in (still, slowed):
            environment.reset(seed=3)
            for _ in range(10):
                environment.step(environment.vehicles.rotor_commands.reshape(environment.action_space.shape))
        speed = [np.linalg.norm(environment.vehicles.velocity_m_s[:, :2], axis=1) for environment in (still, slowed)]
        assert (speed[1] < speed[0]).all()
    assert isinstance(pinnquad.Effects().wrench, type(None))

# SPDX-License-Identifier: MIT
"""Many vehicles by one call, and the environments on them."""
import pickle
import threading

import numpy as np
import pytest

import pinnquad
from pinnquad import Effects, HoverEnv, Simulator, Status, VectorHoverEnv, Vehicles


@pytest.mark.parametrize("effects", [
    Effects(), Effects(wind_m_s=(3, 1, 0), wake=True), Effects(wind_m_s=(3, 1, 0), gust_m_s=(0, 2, 0)),
    Effects(ground_effect="conyers"), Effects(ground_effect="cheeseman_bennett")])
def test_they_fly_as_the_simulator_does(effects):
    """To the bit, in lanes or one by one; eleven leave lanes over."""
    start_m = (0, 0, 0)
    alone = [Simulator(pilot="hover", effects=effects, start_m=start_m) for _ in range(11)]
    many = Vehicles(11, effects=effects)
    many.reset(position_m=start_m)
    random = np.random.default_rng(1)
    for _ in range(50):
        commands = many.hover_commands(start_m) + random.uniform(-0.02, 0.03, (11, 4))
        for one, its in zip(alone, commands):
            one.step(its, 0.01)
        assert (many.step(commands, 0.01) == 0).all()
        many.time_s[:] = alone[0].time_s  # a simulator's clock is set at its rows
    for i, one in enumerate(alone):
        np.testing.assert_array_equal(many.position_m[i], one.state["position_m"])
        np.testing.assert_array_equal(many.velocity_m_s[i], one.state["velocity_m_s"])
        np.testing.assert_array_equal(many.attitude[i], one.state["attitude"])
        np.testing.assert_array_equal(many.body_rates_rad_s[i], one.state["body_rates_rad_s"])
        np.testing.assert_array_equal(many.rotor_commands[i], one.state["rotor_commands"])


def test_what_is_refused_on_the_way_stays_there():
    vehicles = Vehicles(9)
    vehicles.position_m[4, 2] = -10_878 + 0.01  # just below where the atmosphere ends
    vehicles.velocity_m_s[4, 2] = -5
    commands = np.tile(vehicles.hover_commands(), (9, 1))
    statuses = vehicles.step(commands, 0.5)
    assert Status(statuses[4]) == Status.out_of_range and (np.delete(statuses, 4) == 0).all()
    assert 0 < vehicles.time_s[4] < 0.01 and vehicles.time_s[5] == pytest.approx(0.5)


def test_each_has_commands_and_a_place_of_its_own():
    vehicles = Vehicles(1000)
    vehicles.position_m[:, 0] = np.arange(1000)
    commands = np.tile(vehicles.hover_commands(), (1000, 1))
    commands[7] += [-0.01, 0.01, 0.01, -0.01]
    assert (vehicles.step(commands, 0.1) == 0).all()
    assert vehicles.body_rates_rad_s[7, 0] > 0.1
    np.testing.assert_allclose(vehicles.body_rates_rad_s[:7], 0, atol=1e-12)
    np.testing.assert_allclose(vehicles.position_m[:, 0], np.arange(1000), atol=1e-2)
    np.testing.assert_allclose(vehicles.time_s, 0.1)
    which = np.arange(1000) == 7
    vehicles.reset(which, (1, 2, -3))
    assert vehicles.time_s[7] == 0 and vehicles.position_m[7, 2] == -3 and vehicles.position_m[8, 2] < -30


def test_arrays_are_the_state():
    vehicles = Vehicles(5)
    assert np.shares_memory(vehicles.state, vehicles.attitude) and vehicles.state.shape == (5, 18)
    state = vehicles.state
    del vehicles
    state[:] = 1  # kept alive by the array


def test_what_is_refused_stays_where_it_was():
    vehicles = Vehicles(4)
    vehicles.velocity_m_s[1] = np.nan
    vehicles.attitude[2] = (2, 0, 0, 0)
    commands = np.tile(vehicles.hover_commands(), (4, 1))
    commands[3, 2] = np.inf
    before = vehicles.state.copy()
    assert [Status(s) for s in vehicles.step(commands, 0.01)] == [
        Status.ok, Status.not_finite, Status.not_unit_quaternion, Status.not_finite]
    np.testing.assert_array_equal(vehicles.state[1:], before[1:])


@pytest.mark.parametrize("commands, words", [
    (np.zeros((3, 4)), r"shape \(4, 4\)"), (np.zeros(4), "shape"), (np.zeros((4, 4), np.float32), "float64"),
    (np.zeros((8, 4))[::2], "C-contiguous"), (np.zeros((4, 4), int), "float64"), (np.zeros((4, 4)).T[:, :3], "shape")])
def test_commands_that_are_none(commands, words):
    with pytest.raises(ValueError, match=words):
        Vehicles(4).step(commands)


def test_arguments_that_make_no_sense():
    for count in (0, 10**9):
        with pytest.raises(ValueError, match="count must be"):
            Vehicles(count)
    with pytest.raises(TypeError):
        Vehicles(-1)
    vehicles = Vehicles(2)
    commands = np.full((2, 4), 0.5)
    for seconds in (-1, np.nan, np.inf):
        with pytest.raises(ValueError, match="seconds"):
            vehicles.step(commands, seconds)
    with pytest.raises(ValueError, match="2 truth values"):
        vehicles.reset(np.ones(3, bool))
    with pytest.raises(ValueError, match="position_m"):
        vehicles.reset(position_m=(0, 0, np.nan))
    with pytest.raises(ValueError, match="physics_step_s"):
        Vehicles(2, physics_step_s=0)


def test_pickle():
    vehicles = Vehicles(10, "racer_5_inch", effects=Effects(inflow=True))
    vehicles.step(np.random.default_rng(1).uniform(0.1, 0.3, (10, 4)), 0.1)
    again = pickle.loads(pickle.dumps(vehicles))
    np.testing.assert_array_equal(again.state, vehicles.state)
    assert again.effects == vehicles.effects and again.airframe == vehicles.airframe


def test_a_second_thread_is_refused():
    vehicles = Vehicles(2000)
    commands = np.tile(vehicles.hover_commands(), (2000, 1))
    thread = threading.Thread(target=vehicles.step, args=(commands, 1.0))
    thread.start()
    refused = 0
    while thread.is_alive():
        try:
            vehicles.reset()
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
    thread.join()
    assert refused > 0


# environments


def test_an_episode():
    environment = HoverEnv(episode_s=1.0)
    seen, info = environment.reset(seed=3)
    assert environment.observation_space.contains(seen) and info == {}
    assert environment.action_space.contains(environment.action_space.sample())
    hover = environment.vehicles.hover_commands()
    steps = rewards = 0
    terminated = truncated = False
    while not (terminated or truncated):
        seen, reward, terminated, truncated, info = environment.step(hover)
        steps, rewards = steps + 1, rewards + reward
    assert truncated and not terminated and steps == 100 and 0 < rewards < 100
    again, _ = HoverEnv().reset(seed=3)
    np.testing.assert_array_equal(again, environment.reset(seed=3)[0])


def test_what_falls_ends():
    environment = HoverEnv(target_m=(0, 0, -2.0), spread_m=0)
    environment.reset(seed=1)
    for _ in range(300):
        seen, reward, terminated, truncated, _ = environment.step(np.zeros(4))
        if terminated:
            break
    assert terminated and not truncated and seen[2] > 2.5
    for wrong in (np.zeros(3), [np.nan] * 4, "up"):
        with pytest.raises(ValueError):
            environment.step(wrong)


def test_many_environments_are_one_at_a_time():
    alone, many = HoverEnv(), VectorHoverEnv(1)
    np.testing.assert_array_equal(alone.reset(seed=5)[0], many.reset(seed=5)[0][0])
    actions = np.random.default_rng(2).uniform(0.4, 0.6, (20, 4))
    for action in actions:
        one, all_of = alone.step(action), many.step(action[None])
        np.testing.assert_array_equal(one[0], all_of[0][0])
        assert one[1] == all_of[1][0]


def test_what_ends_begins_anew():
    environment = VectorHoverEnv(50, episode_s=0.05)
    environment.reset(seed=1)
    actions = np.full((50, 4), 0.5)
    for _ in range(4):
        assert environment.step(actions)[4] == {}
    seen, rewards, terminated, truncated, info = environment.step(actions)
    assert truncated.all() and info["ended"].all() and info["final_observation"].shape == (50, 17)
    assert (environment.vehicles.time_s == 0).all() and not np.array_equal(seen, info["final_observation"])
    with pytest.raises(ValueError, match=r"\(50, 4\)"):
        environment.step(actions[:10])
    assert environment.action_space.shape == (50, 4)

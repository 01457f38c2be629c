# SPDX-License-Identifier: MIT
"""Many vehicles by one call, and the environments on them."""
import pickle
import threading

import numpy as np
import pytest

import pinnquad
from pinnquad import Airframe, Effects, HoverEnv, Simulator, Spin, Status, VectorHoverEnv, Vehicles

SPREADS = {"mass_kg": 0.2, "inertia_kg_m2": 0.2, "thrust_coefficient": 0.1, "rotor_time_constant_s": 0.5,
           "drag_area_m2": 0.5, "thrust_scale": 0.05, "x_m": 0.03}


def uneven(airframe):
    """Without what plain airframes leave out: a product of inertia, a curve, a lag for each direction."""
    airframe.inertia_products_kg_m2 = (0.0003, 0, 0)
    airframe.rotors[1].thrust_curve = 0.3
    airframe.rotors[2].rise_time_constant_s, airframe.rotors[2].fall_time_constant_s = 0.02, 0.04
    return airframe


def one_airframe():
    return "paper_quadrotor"


def an_airframe_each():
    airframes = Airframe("paper_quadrotor").randomised(11, SPREADS)
    return airframes[:2] + [uneven(airframes[2])] + airframes[3:10] + ["racer_5_inch"]


def each_turns_otherwise():
    airframes = Airframe("paper_quadrotor").randomised(11, SPREADS)
    for rotor in airframes[4].rotors:
        rotor.spin = Spin.clockwise if rotor.spin == Spin.counter_clockwise else Spin.counter_clockwise
    return airframes


@pytest.mark.parametrize("airframes", [one_airframe, an_airframe_each, each_turns_otherwise])
@pytest.mark.parametrize("effects", [
    Effects(), Effects(wind_m_s=(3, 1, 0), wake=True), Effects(wind_m_s=(3, 1, 0), gust_m_s=(0, 2, 0)),
    Effects(ground_effect="conyers"), Effects(ground_effect="cheeseman_bennett"),
    Effects(ground_effect="conyers", drag=False, payload_kg=0.2, payload_from_s=0.1, battery_cells=4, battery_charge=0.3),
    Effects(ground_effect="rotors", turbulence_m_s=5, rotor_drag=True, inflow=True, flapping=True, fault_share=0.9,
            fault_rotor=2, rate_damping_N_m_s=0.01, linear_drag_N_s_m=0.1, ground_contact=True)])
def test_they_fly_as_the_simulator_does(effects, airframes):
    """To the bit, in lanes or one by one; eleven leave lanes over."""
    start_m = (0, 0, 0)
    given = airframes()
    each = given if isinstance(given, list) else [given] * 11
    alone = [Simulator(one, pilot="hover", effects=effects, start_m=start_m) for one in each]
    many = Vehicles(11, given, effects=effects)
    many.reset(position_m=start_m)
    random = np.random.default_rng(1)
    if not effects.battery_cells:  # a simulator's hover is that of its battery under load
        np.testing.assert_array_equal(np.broadcast_to(many.hover_commands(start_m), (11, 4)),
                                      [one.hover_commands() for one in alone])
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
        assert many.charge_used_C[i] == one.state["charge_used_C"] and (many.charge_used_C[i] > 0) == (effects.battery_cells > 0)


def test_other_airframes_in_flight():
    """Those of a mask fly on as what they have become, the others as before."""
    commands = np.tile(Vehicles(1).hover_commands(), (19, 1))
    light, heavy = Airframe("paper_quadrotor"), Airframe("paper_quadrotor")
    heavy.mass_kg *= 1.1
    for which in (np.arange(19) == 10, np.arange(19) % 3 == 0, None):
        expected, changed = Vehicles(19, light), Vehicles(19, light)
        expected.step(commands, 0.01), changed.step(commands, 0.01)
        became = Vehicles(19, heavy)
        became.state[:] = expected.state
        changed.set_airframe(heavy, which)
        for vehicles in (expected, changed, became):
            assert (vehicles.step(commands, 0.01) == 0).all()
        chosen = np.ones(19, bool) if which is None else which
        np.testing.assert_array_equal(changed.state, np.where(chosen[:, None], became.state, expected.state))
        assert chosen.any() and not np.array_equal(became.state, expected.state)
        changed.set_airframe([light] * int(chosen.sum()), which)  # and back, one given for each
        changed.state[:] = expected.state
        for vehicles in (expected, changed):
            vehicles.step(commands, 0.01)
        np.testing.assert_array_equal(changed.state, expected.state)


def test_what_can_not_fly_changes_nothing():
    broken = Airframe("paper_quadrotor")
    broken.mass_kg = 50
    with pytest.raises(pinnquad.Error, match="vehicle 2: airframe paper_quadrotor.*invalid_airframe"):
        Vehicles(3, ["paper_quadrotor", "racer_5_inch", broken])
    vehicles = Vehicles(3)
    with pytest.raises(pinnquad.Error, match="vehicle 2: airframe paper_quadrotor.*invalid_airframe"):
        vehicles.set_airframe(["racer_5_inch", broken], [False, True, True])
    assert vehicles.airframe == Airframe("paper_quadrotor")
    for given in (["paper_quadrotor"] * 2, [], ["paper_quadrotor"] * 4):
        with pytest.raises(ValueError, match="airframe must be one, or 3, one per vehicle; found"):
            Vehicles(3, given)
    for given in (3, None, b"paper_quadrotor", [1, 2, 3]):
        with pytest.raises(TypeError, match="expected an Airframe"):
            Vehicles(3, given)
    with pytest.raises(ValueError, match="3 truth values"):
        vehicles.set_airframe("racer_5_inch", [True])


def test_airframes_are_drawn_within_their_spreads():
    middle = Airframe("racer_5_inch")
    drawn = middle.randomised(400, {"mass_kg": 0.2, "thrust_scale": 0.05}, seed=3)
    mass = np.array([one.mass_kg for one in drawn]) / middle.mass_kg
    scale = np.array([[rotor.thrust_scale for rotor in one.rotors] for one in drawn])
    assert 0.8 <= mass.min() < 0.81 and 1.19 < mass.max() <= 1.2 and abs(mass.mean() - 1) < 0.02
    assert scale.min() >= 0.95 and scale.max() <= 1.05 and abs(np.corrcoef(scale.T)[0, 1]) < 0.15
    assert all(one.thrust_coefficient == middle.thrust_coefficient for one in drawn)
    again = middle.randomised(400, {"mass_kg": 0.2, "thrust_coefficient": 0.1}, seed=3)
    assert [one.mass_kg for one in again] == [one.mass_kg for one in drawn]  # whatever else is drawn
    assert middle.randomised(1, {"mass_kg": 0.2}, seed=4)[0].mass_kg != drawn[0].mass_kg
    for one in Airframe("paper_quadrotor").randomised(200, {"inertia_kg_m2": 0.5}):
        one.check()
    for spreads, words in (({"mass": 0.1}, "no spread named 'mass'; known: "), ({"mass_kg": 1}, "from 0 to less"),
                           ({"mass_kg": -0.1}, "from 0 to less"), ({"mass_kg": np.nan}, "from 0 to less")):
        with pytest.raises(ValueError, match=words):
            middle.randomised(1, spreads)
    none = Airframe("paper_quadrotor")
    none.mass_kg = 50
    with pytest.raises(pinnquad.Error, match="paper_quadrotor: of 1000 .* none can hover"):
        none.randomised(1, {"mass_kg": 0.1})


def test_what_is_refused_on_the_way_stays_there():
    vehicles = Vehicles(9)
    vehicles.position_m[4, 2] = -10_878 + 0.01  # just below where the atmosphere ends
    vehicles.velocity_m_s[4, 2] = -5
    commands = np.tile(vehicles.hover_commands(), (9, 1))
    statuses = vehicles.step(commands, 0.5)
    assert Status(statuses[4]) == Status.out_of_range and (np.delete(statuses, 4) == 0).all()
    assert 0 < vehicles.time_s[4] < 0.01 and vehicles.time_s[5] == pytest.approx(0.5)


def test_one_of_many_begins_anew():
    vehicles = Vehicles(1000)
    vehicles.step(np.tile(vehicles.hover_commands(), (1000, 1)), 0.1)
    vehicles.reset(np.arange(1000) == 7, (1, 2, -3))
    assert vehicles.time_s[7] == 0 and vehicles.position_m[7, 2] == -3
    assert vehicles.position_m[8, 2] < -30 and vehicles.time_s[8] == pytest.approx(0.1)


def test_arrays_are_the_state():
    vehicles = Vehicles(5)
    assert np.shares_memory(vehicles.state, vehicles.attitude) and vehicles.state.shape == (5, 19)
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
    (np.zeros((3, 4)), r"shape \(4, 4\)"), (np.zeros(4), "shape"), (np.zeros((4, 4)).T[:, :3], "shape"),
    (np.zeros((4, 4), complex), "found complex128"), (np.zeros((4, 4), "m8[us]"), "found timedelta64"),
    (np.ma.masked_equal(np.zeros((4, 4)), 0), "without a mask, found 16 masked")])
def test_commands_that_are_none(commands, words):
    with pytest.raises((TypeError, ValueError), match=words):
        Vehicles(4).step(commands)


def test_commands_of_any_memory():
    commands = np.random.default_rng(1).uniform(0.4, 0.6, (8, 4)).astype(np.float32).astype(float)
    expected = Vehicles(8)
    expected.step(commands, 0.1)
    for given in (commands.astype(np.float32), np.asfortranarray(commands), np.repeat(commands, 2, axis=1)[:, ::2],
                  np.ma.array(commands), commands.tolist()):
        vehicles = Vehicles(8)
        vehicles.step(given, 0.1)
        np.testing.assert_array_equal(vehicles.state, expected.state)
    one, other = Simulator(), Simulator()
    one.step(commands[0].astype(np.float32), 0.1), other.step(commands[0], 0.1)
    np.testing.assert_array_equal(one.state["position_m"], other.state["position_m"])
    with pytest.raises(ValueError, match="without a mask"):
        one.step(np.ma.masked_greater(commands[0], 0))


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
    each = Vehicles(3, Airframe("paper_quadrotor").randomised(3, SPREADS))
    assert pickle.loads(pickle.dumps(each)).airframe == each.airframe and len(each.airframe) == 3


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
    assert truncated.all() and info["_final_obs"].all() and np.stack(info["final_obs"]).shape == (50, 17)
    assert (environment.vehicles.time_s == 0).all() and not np.array_equal(seen, np.stack(info["final_obs"]))
    with pytest.raises(ValueError, match=r"\(50, 4\)"):
        environment.step(actions[:10])
    assert environment.action_space.shape == (50, 4)


def test_each_episode_has_an_airframe_of_its_own():
    environment = VectorHoverEnv(20, episode_s=0.05, randomise={"mass_kg": 0.2})
    environment.reset(seed=1)
    masses = [one.mass_kg for one in environment.vehicles.airframe]
    assert len(set(masses)) == 20
    actions = environment.vehicles.hover_commands()
    environment.vehicles.position_m[3] = (0, 0, 100)  # this one ends first
    info = environment.step(actions)[4]
    ended = info["_final_obs"]
    assert ended[3] and ended.sum() == 1 and info["final_obs"][3].shape == (17,) and info["final_obs"][4] is None
    after = [one.mass_kg for one in environment.vehicles.airframe]
    assert after[3] != masses[3] and after[:3] + after[4:] == masses[:3] + masses[4:]
    np.testing.assert_array_equal(environment.vehicles.rotor_commands[3], environment.vehicles.hover_commands()[3])
    alone, one = HoverEnv(randomise=SPREADS), VectorHoverEnv(1, randomise=SPREADS)
    np.testing.assert_array_equal(alone.reset(seed=5)[0], one.reset(seed=5)[0][0])
    assert alone.vehicles.airframe == one.vehicles.airframe != Airframe("paper_quadrotor")
    action = np.full(4, 0.55)
    assert alone.step(action)[1] == one.step(action[None])[1][0]
    again = VectorHoverEnv(20, randomise={"mass_kg": 0.2})
    again.reset(seed=1)
    assert [each.mass_kg for each in again.vehicles.airframe] == masses
    with pytest.raises(ValueError, match="no spread named"):
        VectorHoverEnv(2, randomise={"weight": 0.1})


def test_tasks_of_ones_own():
    """A reward, a path and an effect of Python's."""
    def circle(time_s):
        return np.stack([2 * np.cos(time_s), 2 * np.sin(time_s), np.full(len(time_s), -20.0)], axis=1)

    asked = []

    def reward(state, actions, target_m):
        asked.append((state.shape, actions.shape))
        return -np.linalg.norm(state[:, :3] - target_m, axis=1)

    environment = VectorHoverEnv(5, target_m=circle, reward=reward, spread_m=0, step_s=0.02,
                                 effects=Effects(wrench=lambda motion: (-0.3 * motion.velocity_m_s, None)))
    seen, _ = environment.reset(seed=1)
    np.testing.assert_allclose(seen[:, :3], 0, atol=1e-6)
    still = VectorHoverEnv(5, target_m=circle, spread_m=0, step_s=0.02)
    still.reset(seed=1)
    actions = np.tile(environment.vehicles.hover_commands((0, 0, -20)), (5, 1))
    for step in range(1, 11):
        seen, rewards, *_ = environment.step(actions)
        still.step(actions)
        off_m = environment.vehicles.position_m - circle(np.full(5, 0.02 * step))
        np.testing.assert_allclose(seen[:, :3], off_m, atol=1e-5)
        np.testing.assert_allclose(rewards, -np.linalg.norm(off_m, axis=1), rtol=1e-12)
    assert asked == [((5, 19), (5, 4))] * 10
    assert np.linalg.norm(environment.vehicles.velocity_m_s) < np.linalg.norm(still.vehicles.velocity_m_s)
    path = pinnquad.Path(np.linspace(0, 1, 101), circle(np.linspace(0, 1, 101)))
    by_arrays = VectorHoverEnv(5, target_m=path, spread_m=0, step_s=0.02)
    by_arrays.reset(seed=1)
    for step in range(1, 11):
        seen, *_ = by_arrays.step(actions)
        np.testing.assert_allclose(seen[:, :3], by_arrays.vehicles.position_m - circle(np.full(5, 0.02 * step)), atol=1e-5)
    with pytest.raises(ValueError, match=r"reward must return shape \(2,\), found \(\)"):
        wrong = VectorHoverEnv(2, reward=lambda *_: 0.0)
        wrong.reset(seed=1), wrong.step(actions[:2])
    with pytest.raises(ValueError, match=r"target_m\(time_s\) must be finite numbers of shape \(1, 3\)"):
        HoverEnv(target_m=lambda time_s: np.zeros(3))


def test_masked_choices_and_actions_are_refused():
    with pytest.raises(ValueError, match="which: expected numbers without a mask, found 1 masked"):
        Vehicles(2).reset(np.ma.array([True, True], mask=[False, True]))
    environment = HoverEnv()
    environment.reset(seed=1)
    with pytest.raises(ValueError, match="action: expected numbers without a mask"):
        environment.step(np.ma.masked_greater(np.full(4, 0.5), 0))


def test_gymnasium():
    """Where it is installed: its own checker, its registry and its vector environments."""
    gymnasium = pytest.importorskip("gymnasium", minversion="1.1")
    from gymnasium.utils.env_checker import check_env

    environment = gymnasium.make("pinnquad/Hover-v0", episode_s=0.5)
    check_env(environment.unwrapped)
    assert isinstance(environment.unwrapped, HoverEnv)
    environment.reset(seed=1)
    assert any(environment.step(environment.action_space.sample())[3] for _ in range(50))
    many = gymnasium.make_vec("pinnquad/Hover-v0", num_envs=7, vectorization_mode="vector_entry_point", episode_s=0.05)
    assert isinstance(many.unwrapped, VectorHoverEnv) and isinstance(many, gymnasium.vector.VectorEnv)
    assert many.metadata["autoreset_mode"] == gymnasium.vector.AutoresetMode.SAME_STEP
    counted = gymnasium.wrappers.vector.RecordEpisodeStatistics(many)
    counted.reset(seed=2)
    for _ in range(5):
        *_, info = counted.step(np.full((7, 4), 0.5, np.float32))
    assert info["_episode"].all() and (info["episode"]["l"] == 5).all()
    apart = gymnasium.make_vec("pinnquad/Hover-v0", num_envs=2, vectorization_mode="sync",
                               vector_kwargs={"autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP})
    np.testing.assert_array_equal(apart.reset(seed=[3, 4])[0][0], HoverEnv().reset(seed=3)[0])

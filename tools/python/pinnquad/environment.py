# SPDX-License-Identifier: MIT
"""Environments of gymnasium: fly to a target, or along a path, and stay there. gymnasium itself is optional.

With gymnasium, `import pinnquad` registers "pinnquad/Hover-v0" for gymnasium.make() and gymnasium.make_vec().
"""
import numpy as np

from ._core import Airframe, Vehicles
from .arrays import unmasked
from .spaces import SAME_STEP, Box, Env, VectorEnv, batch_space, register

GROUND_Z_M = 0.877
OBSERVED = 17  #: numbers of an observation


class _Hover:
    """The task of both environments, for many vehicles at once."""

    def __init__(self, count, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise, reward):
        self.spreads = dict(randomise or {})
        self.middle = Airframe(airframe) if self.spreads else None
        if self.spreads:
            airframe = self.middle.randomised(count, self.spreads)
        self.vehicles = Vehicles(count, airframe, effects=effects)
        self.path = target_m if callable(target_m) else None
        start = np.asarray(target_m, float) if self.path is None else self._places(np.zeros(1))[0]
        if start.shape != (3,) or not np.isfinite(start).all():
            raise ValueError("target_m must be three finite numbers, NED")
        self.start_m, self.target_m = start, np.broadcast_to(start, (count, 3)).copy()
        if not (np.isfinite(step_s) and step_s >= 0.001 and episode_s >= step_s):
            raise ValueError("step_s must be 0.001 s or more, and episode_s no less")
        self.step_s, self.steps_of_episode = float(step_s), int(round(episode_s / step_s))
        self.spread_m, self.farthest_m = float(spread_m), float(farthest_m)
        self.reward = reward
        self.hover = np.broadcast_to(self.vehicles.hover_commands(tuple(start)), (count, 4)).copy()
        self.steps = np.zeros(count, int)

    def _places(self, time_s):
        places = np.asarray(self.path(time_s), float)
        if places.shape != (len(time_s), 3) or not np.isfinite(places).all():
            raise ValueError(f"target_m(time_s) must be finite numbers of shape ({len(time_s)}, 3), found {places.shape}")
        return places

    def begin(self, which, random):
        """The first observations."""
        self.reset(which, random)
        return self.observe()

    def reset(self, which, random):
        count = int(np.count_nonzero(which))
        if self.spreads:
            seed = int(random.integers(2**63))
            self.vehicles.set_airframe(self.middle.randomised(count, self.spreads, seed), which)
        self.vehicles.reset(which, tuple(self.start_m))
        self.target_m[which] = self.start_m
        self.hover[which] = self.vehicles.rotor_commands[which]
        self.vehicles.position_m[which] += random.uniform(-self.spread_m, self.spread_m, (count, 3))
        self.vehicles.velocity_m_s[which] += random.normal(0, 0.5, (count, 3))
        self.vehicles.body_rates_rad_s[which] += random.normal(0, 0.2, (count, 3))
        self.steps[which] = 0

    def observe(self):
        state = self.vehicles.state
        seen = state[:, :OBSERVED].astype(np.float32)
        seen[:, :3] = state[:, :3] - self.target_m
        return seen

    def step(self, actions):
        commands = np.ascontiguousarray(actions, float)
        statuses = self.vehicles.step(np.clip(commands, 0.0, 1.0), self.step_s)
        self.steps += 1
        if self.path is not None:
            self.target_m[:] = self._places(self.steps * self.step_s)
        off_m = np.linalg.norm(self.vehicles.position_m - self.target_m, axis=1)
        if self.reward is None:
            turning = np.linalg.norm(self.vehicles.body_rates_rad_s, axis=1)
            reward = np.exp(-off_m) - 0.01 * turning - 0.1 * np.abs(commands - self.hover).mean(axis=1)
        else:
            reward = np.asarray(self.reward(self.vehicles.state, commands, self.target_m), float)
            if reward.shape != off_m.shape:
                raise ValueError(f"reward must return shape {off_m.shape}, found {reward.shape}")
        down = self.vehicles.position_m[:, 2] >= GROUND_Z_M
        terminated = (statuses != 0) | down | (off_m > self.farthest_m)
        return reward, terminated, self.steps >= self.steps_of_episode


def _observation_space():
    return Box(-np.inf, np.inf, (OBSERVED,), np.float32)


def _action_space():
    return Box(0.0, 1.0, (4,), np.float32)


class HoverEnv(Env):
    """One quadrotor that is to fly to a target and stay there.

    observation  17 float32: position - target (NED, m), velocity (NED, m/s), attitude (w, x, y, z, body to world),
                 body rates (FRD, rad/s), commands behind the rotors' lag
    action       4 motor commands, 0 to 1, held for step_s
    reward       exp(-distance / 1 m) - 0.01 s/rad of body rates - 0.1 of the commands' mean distance from hover
    terminated   at the ground, beyond farthest_m of the target, or where a step can't be calculated
    truncated    after episode_s

    Tasks of one's own are callables of arrays, a row a vehicle (one here):

    target_m     a place, NED, m; or target_m(time_s), times of shape (vehicles,) since the episode began, gives places,
                 vehicles x 3: a trajectory
    reward       reward(state, actions, target_m) gives (vehicles,); state as Vehicles.state has it, after the step
    effects      Effects(wrench=..., wind_m_s=...): a force and a torque, a wind

    With randomise={"mass_kg": 0.2, "thrust_coefficient": 0.1} each episode has an airframe of its own
    (Airframe.randomised), which is not observed: environment.vehicles.airframe tells it.
    """

    def __init__(self, airframe="paper_quadrotor", *, effects=None, target_m=(0.0, 0.0, -35.0), step_s=0.01,
                 episode_s=10.0, spread_m=2.0, farthest_m=20.0, randomise=None, reward=None):
        self._task = _Hover(1, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise, reward)
        self._all = np.ones(1, bool)
        self.observation_space, self.action_space = _observation_space(), _action_space()

    @property
    def vehicles(self):
        """The vehicle, as Vehicles of one."""
        return self._task.vehicles

    def reset(self, *, seed=None, options=None):
        """The first observation and {}. A seed gives the same episodes."""
        super().reset(seed=seed)
        return self._task.begin(self._all, self.np_random)[0], {}

    def step(self, action):
        """observation, reward, terminated, truncated, {}."""
        action = np.asarray(unmasked("action", action), float)
        if action.shape != (4,) or not np.isfinite(action).all():
            raise ValueError("action must be four finite numbers, one per rotor")
        reward, terminated, truncated = self._task.step(action[None])
        return self._task.observe()[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), {}


class VectorHoverEnv(VectorEnv):
    """Many HoverEnvs stepped by one call. An episode that ends begins anew in the same step (gymnasium's
    AutoresetMode.SAME_STEP): where `info["_final_obs"]` is true, `info["final_obs"]` has its last observation, else None."""

    metadata = {"render_modes": [], "autoreset_mode": SAME_STEP}

    def __init__(self, num_envs, airframe="paper_quadrotor", *, effects=None, target_m=(0.0, 0.0, -35.0), step_s=0.01,
                 episode_s=10.0, spread_m=2.0, farthest_m=20.0, randomise=None, reward=None):
        self._task = _Hover(num_envs, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise,
                            reward)
        self.num_envs = num_envs
        self.single_observation_space, self.single_action_space = _observation_space(), _action_space()
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    @property
    def vehicles(self):
        """All of them."""
        return self._task.vehicles

    def reset(self, *, seed=None, options=None):
        """The first observations, num_envs x 17, and {}."""
        super().reset(seed=seed)
        return self._task.begin(np.ones(self.num_envs, bool), self.np_random), {}

    def step(self, actions):
        """observations, rewards, terminated, truncated, info: arrays of num_envs rows."""
        actions = np.asarray(unmasked("actions", actions), float)
        if actions.shape != (self.num_envs, 4) or not np.isfinite(actions).all():
            raise ValueError(f"actions must be finite numbers of shape ({self.num_envs}, 4)")
        reward, terminated, truncated = self._task.step(actions)
        seen, info = self._task.observe(), {}
        ended = terminated | truncated
        if ended.any():
            last = np.full(self.num_envs, None, object)
            for one in np.flatnonzero(ended):
                last[one] = seen[one]
            info = {"final_obs": last, "_final_obs": ended}
            self._task.reset(ended, self.np_random)
            seen = self._task.observe()
        return seen, reward, terminated, truncated, info


register("pinnquad/Hover-v0", entry_point="pinnquad.environment:HoverEnv",
         vector_entry_point="pinnquad.environment:VectorHoverEnv")

# SPDX-License-Identifier: MIT
"""Environments as gymnasium has them: fly to a target and stay there. gymnasium itself is optional."""
import numpy as np

from ._core import Airframe, Vehicles
from .spaces import Box, Env, batch_space

GROUND_Z_M = 0.877
OBSERVED = 17  #: numbers of an observation


class _Hover:
    """The task of both environments, for many vehicles at once."""

    def __init__(self, count, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise):
        self.spreads = dict(randomise or {})
        self.middle = Airframe(airframe) if self.spreads else None
        if self.spreads:
            airframe = self.middle.randomised(count, self.spreads)
        self.vehicles = Vehicles(count, airframe, effects=effects)
        self.target_m = np.asarray(target_m, float)
        if self.target_m.shape != (3,) or not np.isfinite(self.target_m).all():
            raise ValueError("target_m must be three finite numbers, NED")
        if not (np.isfinite(step_s) and step_s >= 0.001 and episode_s >= step_s):
            raise ValueError("step_s must be 0.001 s or more, and episode_s no less")
        self.step_s, self.steps_of_episode = float(step_s), int(round(episode_s / step_s))
        self.spread_m, self.farthest_m = float(spread_m), float(farthest_m)
        self.hover = np.broadcast_to(self.vehicles.hover_commands(tuple(self.target_m)), (count, 4)).copy()
        self.steps = np.zeros(count, int)
        self.random = np.random.default_rng()

    def begin(self, which, seed):
        """The first observations; a seed makes the draws of all that follow."""
        if seed is not None:
            self.random = np.random.default_rng(seed)
        self.reset(which)
        return self.observe()

    def reset(self, which):
        count = int(np.count_nonzero(which))
        if self.spreads:
            seed = int(self.random.integers(2**63))
            self.vehicles.set_airframe(self.middle.randomised(count, self.spreads, seed), which)
        self.vehicles.reset(which, tuple(self.target_m))
        self.hover[which] = self.vehicles.rotor_commands[which]
        self.vehicles.position_m[which] += self.random.uniform(-self.spread_m, self.spread_m, (count, 3))
        self.vehicles.velocity_m_s[which] += self.random.normal(0, 0.5, (count, 3))
        self.vehicles.body_rates_rad_s[which] += self.random.normal(0, 0.2, (count, 3))
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
        off_m = np.linalg.norm(self.vehicles.position_m - self.target_m, axis=1)
        turning = np.linalg.norm(self.vehicles.body_rates_rad_s, axis=1)
        reward = np.exp(-off_m) - 0.01 * turning - 0.1 * np.abs(commands - self.hover).mean(axis=1)
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

    With randomise={"mass_kg": 0.2, "thrust_coefficient": 0.1} each episode has an airframe of its own
    (Airframe.randomised), which is not observed: environment.vehicles.airframe tells it.
    """

    def __init__(self, airframe="paper_quadrotor", *, effects=None, target_m=(0.0, 0.0, -35.0), step_s=0.01,
                 episode_s=10.0, spread_m=2.0, farthest_m=20.0, randomise=None):
        self._task = _Hover(1, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise)
        self._all = np.ones(1, bool)
        self.observation_space, self.action_space = _observation_space(), _action_space()

    @property
    def vehicles(self):
        """The vehicle, as Vehicles of one."""
        return self._task.vehicles

    def reset(self, *, seed=None, options=None):
        """The first observation and {}. A seed gives the same episodes."""
        return self._task.begin(self._all, seed)[0], {}

    def step(self, action):
        """observation, reward, terminated, truncated, {}."""
        action = np.asarray(action, float)
        if action.shape != (4,) or not np.isfinite(action).all():
            raise ValueError("action must be four finite numbers, one per rotor")
        reward, terminated, truncated = self._task.step(action[None])
        return self._task.observe()[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), {}


class VectorHoverEnv:
    """Many HoverEnvs stepped by one call. What ends begins anew in the same step: `info["final_observation"]` has the
    last observations of the episode, `info["ended"]` which vehicles they are of."""

    def __init__(self, num_envs, airframe="paper_quadrotor", *, effects=None, target_m=(0.0, 0.0, -35.0), step_s=0.01,
                 episode_s=10.0, spread_m=2.0, farthest_m=20.0, randomise=None):
        self._task = _Hover(num_envs, airframe, effects, target_m, step_s, episode_s, spread_m, farthest_m, randomise)
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
        return self._task.begin(np.ones(self.num_envs, bool), seed), {}

    def step(self, actions):
        """observations, rewards, terminated, truncated, info: arrays of num_envs rows."""
        actions = np.asarray(actions, float)
        if actions.shape != (self.num_envs, 4) or not np.isfinite(actions).all():
            raise ValueError(f"actions must be finite numbers of shape ({self.num_envs}, 4)")
        reward, terminated, truncated = self._task.step(actions)
        seen, info = self._task.observe(), {}
        ended = terminated | truncated
        if ended.any():
            info = {"ended": ended, "final_observation": seen[ended]}
            self._task.reset(ended)
            seen = self._task.observe()
        return seen, reward, terminated, truncated, info

    def close(self):
        """Nothing is open."""

# SPDX-License-Identifier: MIT
"""Base classes and spaces of gymnasium, or, where it is not installed, ones that have what a program asks of them."""
import numpy as np

try:
    from gymnasium import Env, register
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space

    SAME_STEP = AutoresetMode.SAME_STEP
except ImportError:
    SAME_STEP = "SameStep"

    def register(id, **entry_points):
        """There is no registry."""

    class Env:
        """Replaces gymnasium.Env."""

        metadata = {"render_modes": []}
        render_mode = spec = _np_random = None

        @property
        def unwrapped(self):
            return self

        @property
        def np_random(self):
            """The generator of every draw."""
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        def reset(self, *, seed=None, options=None):
            """A seed makes the draws of all that follow."""
            if seed is not None:
                self._np_random = np.random.default_rng(seed)

        def close(self):
            """Nothing is open."""

    class VectorEnv(Env):
        """Replaces gymnasium.vector.VectorEnv."""

    class Box:
        """Arrays between `low` and `high`, of one shape and dtype."""

        def __init__(self, low, high, shape=None, dtype=np.float32):
            shape = np.shape(low) if shape is None else shape
            self.low = np.broadcast_to(np.asarray(low, dtype), shape)
            self.high = np.broadcast_to(np.asarray(high, dtype), shape)
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self.seed(None)

        def seed(self, seed):
            """Of sample()."""
            self._random = np.random.default_rng(seed)

        def sample(self):
            """Uniform where both ends are finite, else normal."""
            bounded = np.isfinite(self.low) & np.isfinite(self.high)
            low, high = np.where(bounded, self.low, 0), np.where(bounded, self.high, 1)
            inside = self._random.uniform(low, high)
            return np.where(bounded, inside, self._random.standard_normal(self.shape)).astype(self.dtype)

        def contains(self, x):
            """True for an array of the space."""
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

        __contains__ = contains

        def __repr__(self):
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    def batch_space(space, n):
        """The space of n such arrays."""
        return Box(np.stack([space.low] * n), np.stack([space.high] * n), dtype=space.dtype)

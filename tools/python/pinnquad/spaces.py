# SPDX-License-Identifier: MIT
"""Box of gymnasium, or, where gymnasium is not installed, one that has what a program asks of it."""
import numpy as np

try:
    from gymnasium import Env
    from gymnasium.spaces import Box
    from gymnasium.vector.utils import batch_space
except ImportError:

    class Env:
        """Stands in for gymnasium.Env."""

        metadata = {"render_modes": []}
        render_mode = None

        @property
        def unwrapped(self):
            return self

        def close(self):
            """Nothing is open."""

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

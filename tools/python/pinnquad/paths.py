# SPDX-License-Identifier: MIT
"""Trajectories of arrays: places at times, for pilots of Simulator and targets of environments."""
import numpy as np

from .arrays import plain

PULL_1_S = 1.0  #: velocity back to the path, of each metre off it


class Path:
    """A trajectory of one's own, of arrays: places at times, NED, with a smooth curve between them.

    time_s       seconds since the flight or the episode began, rising, two or more
    position_m   a place for each, (times, 3)

    Simulator(pilot=path) flies along it: the path's velocity, and 1 m/s back to it for each metre off. For
    environments target_m=path: path(time_s) gives the places at times, and velocity_m_s(time_s) its velocities. Before
    the first time and behind the last it stays. Between the times it is a cubic of each number, whose slope at a time is
    that of the parabola through it and its neighbours. ValueError for times or places that are no path.
    """

    def __init__(self, time_s, position_m):
        times, places = np.array(plain("time_s", time_s), float), np.array(plain("position_m", position_m), float)
        if times.ndim != 1 or len(times) < 2 or places.shape != (len(times), 3):
            raise ValueError(f"Path: expected two times or more and as many places, (times, 3), found shapes {times.shape} "
                             f"and {places.shape}")
        if not (np.isfinite(times).all() and np.isfinite(places).all() and (np.diff(times) > 0).all()):
            raise ValueError("Path: expected finite numbers, and times that rise")
        self.time_s, self.position_m = times, places
        self._slopes = np.gradient(places, times, axis=0, edge_order=min(2, len(times) - 1))

    def __call__(self, time_s, position_m=None, velocity_m_s=None):
        """Places at times; with a position the velocity that a pilot wants there."""
        if position_m is None:
            return self._at(time_s)[0]
        place, velocity = self._at(time_s)
        return velocity + PULL_1_S * (place - position_m)

    def velocity_m_s(self, time_s):
        """Velocities at times, NED; 0 where the path stays."""
        return self._at(time_s)[1]

    def _at(self, time_s):
        """Places and velocities."""
        given = np.asarray(time_s, float)
        time = np.clip(given, self.time_s[0], self.time_s[-1])[..., None]
        after = np.clip(np.searchsorted(self.time_s, time[..., 0], side="right"), 1, len(self.time_s) - 1)
        first, last = self.time_s[after - 1, None], self.time_s[after, None]
        length = last - first
        s = (time - first) / length
        a, b = self.position_m[after - 1], self.position_m[after]
        p, q = self._slopes[after - 1] * length, self._slopes[after] * length
        bend, end = 2 * (a - b) + p + q, 3 * (b - a) - 2 * p - q
        flying = (given >= self.time_s[0]) & (given <= self.time_s[-1])
        return a + s * (p + s * (end + s * bend)), np.where(flying[..., None], (p + s * (2 * end + 3 * s * bend)) / length, 0.0)

    def __repr__(self):
        return f"<pinnquad.Path: {len(self.time_s)} places, {self.time_s[0]:g} to {self.time_s[-1]:g} s>"

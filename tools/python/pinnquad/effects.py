# SPDX-License-Identifier: MIT
"""The effects of a simulated vehicle, each with its switch (docs/simulator.md has equations and sources)."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable

import numpy as np


def _columns(first, last, doc):
    return property(lambda self: self.rows[:, first:last], doc=doc)


class Motion:
    """How vehicles move, as Effects.wrench is asked: arrays of a row a vehicle, of one row for a Simulator."""

    __slots__ = ("rows",)

    def __init__(self, rows):
        self.rows = rows

    position_m = _columns(0, 3, "NED; the ground is at z = 0.877 m.")
    velocity_m_s = _columns(3, 6, "NED.")
    air_velocity_m_s = _columns(6, 9, "NED: the same less the wind.")
    attitude = _columns(9, 13, "Unit quaternions w, x, y, z, body to world.")
    body_rates_rad_s = _columns(13, 16, "p, q, r, FRD.")
    rotor_speed_rev_s = _columns(16, 20, "Front right, rear left, front left, rear right.")
    time_s = property(lambda self: self.rows[:, 20], doc="Of each vehicle, shape (rows,).")

    def __len__(self):
        return len(self.rows)

    def to_world(self, vectors):
        """Vectors of the body (FRD), (3,) or a row a vehicle, in the world (NED)."""
        q = self.attitude
        turned = 2 * np.cross(q[:, 1:], vectors)
        return vectors + q[:, :1] * turned + np.cross(q[:, 1:], turned)


@dataclass(frozen=True)
class Effects:
    """The air, the rotors in it, and the conditions of a flight. `but(wake=True)` is the same with a change.

    By default still air of the standard atmosphere, and drag: the paper's D1. An effect is off at False, at 0, and
    fault_share at 1.
    """

    #: NED, m/s: one for all places, or a function of one's own, wind_m_s(time_s, position_m), of arrays (n,) and (n, 3),
    #: that returns (n, 3)
    wind_m_s: Any = (0.0, 0.0, 0.0)
    gust_m_s: tuple = (0.0, 0.0, 0.0)  #: NED, m/s: gust_m_s * sin(2 pi t / gust_period_s) is added to the wind
    gust_period_s: float = 10.0
    turbulence_m_s: float = 0.0  #: wind at 20 ft of MIL-F-8785C's gusts (Dryden), m/s
    turbulence_height_m: float = 35.0  #: above ground, for the gusts' length and strength
    turbulence_seed: int = 1
    standard_atmosphere: bool = True  #: density over altitude; else that of sea level
    drag: bool = True  #: the body's, quadratic in the airspeed
    linear_drag_N_s_m: float = 0.0  #: PX4's SIH: 1.0
    rate_damping_N_m_s: float = 0.0  #: PX4's SIH: 0.025
    ground_effect: str = "none"  #: one of pinnquad.ground_effects; "rotors" is Cheeseman and Bennett's, rotor by rotor
    rotor_drag: bool = False
    inflow: bool = False  #: thrust in climb, descent and sideways flight
    flapping: bool = False
    wake: bool = False
    battery_cells: int = 0  #: of a lithium pack in series, whose voltage a flight records as battery_voltage
    battery_Ah: float = 2.2
    battery_charge: float = 1.0  #: at the start: 1 full, 0 empty
    battery_resistance_ohm_Ah: float = 0.02  #: of a cell, times its capacity
    fault_rotor: int = 0  #: 0 to 3: front right, rear left, front left, rear right
    fault_share: float = 1.0  #: of its thrust that this rotor gives
    fault_from_s: float = 0.0
    payload_kg: float = 0.0  #: at the centre of gravity
    payload_from_s: float = 0.0
    ground_contact: bool = False  #: four legs: the vehicle lands
    leg_length_m: float = 0.18
    #: an effect of one's own: wrench(motion) of a Motion returns (force_N, torque_N_m), (n, 3) or (3,), either may be
    #: None; the force in NED, the torque in FRD about the centre of gravity
    wrench: Callable | None = None

    def but(self, **changes):
        """The same effects with some changed."""
        return replace(self, **changes)

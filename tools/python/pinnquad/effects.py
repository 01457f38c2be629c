# SPDX-License-Identifier: MIT
"""The effects of a simulated vehicle, each with its switch (docs/simulator.md has equations and sources)."""
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Effects:
    """The air, the rotors in it, and the conditions of a flight. `but(wake=True)` is the same with a change.

    By default still air of the standard atmosphere, and drag: the paper's D1. An effect is off at False, at 0, and
    fault_share at 1.
    """

    wind_m_s: tuple = (0.0, 0.0, 0.0)  #: NED, m/s
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

    def but(self, **changes):
        """The same effects with some changed."""
        return replace(self, **changes)

# SPDX-License-Identifier: MIT
"""The flights of the paper, and a harder one, as `pinnquad fly` flies them: the same seed, the same bits."""
from ._core import Simulator
from .arrays import whole
from .effects import Effects

_NEAR_GROUND_M = (0.0, 0.0, 0.877 - 0.2)

#: name: effects, pilot, start (NED, m), rows
FLIGHTS = {
    "d1": (Effects(), "random", None, 15000),
    "d2": (Effects(ground_effect="conyers"), "near_ground", _NEAR_GROUND_M, 6000),
    "d3": (Effects(wind_m_s=(2.5, 0.0, 0.0), gust_m_s=(2.5, 0.0, 0.0)), "random", None, 5000),
    "harder": (Effects(rotor_drag=True, inflow=True, flapping=True, wake=True), "random", None, 15000),
}


def fly(flight="d1", *, airframe="paper_quadrotor", seed=1, rows=None, **simulator):
    """Flies and returns the Flight, a row every 0.05 s; rows: how many, by default as many as the paper has.

    flight: 'd1' agile up to 8 m/s; 'd2' near the ground, with ground effect; 'd3' in periodic wind; 'harder': d1 with
    inflow, flapping, wake and rotor drag. More arguments are Simulator's: effects, gyro_noise_rad_s ...
    """
    if flight not in FLIGHTS:
        raise ValueError(f"no flight named '{flight}'; known: {', '.join(FLIGHTS)}")
    effects, pilot, start_m, most = FLIGHTS[flight]
    if start_m is not None:
        simulator.setdefault("start_m", start_m)
    running = Simulator(airframe, seed, effects=simulator.pop("effects", effects), pilot=pilot, **simulator)
    running.fly((most if rows is None else whole("rows", rows)) * 0.05)
    return running.take_recording()

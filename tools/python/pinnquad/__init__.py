# SPDX-License-Identifier: MIT
"""Inverse dynamics of quadrotors: simulate, train, judge, certify, predict. World NED, body FRD, SI units, radians.

Rotors: front right, rear left, front left, rear right; a command is 0 to 1. docs/python.md shows the whole way.
"""
from ._core import (Airframe, Dataset, Error, Flight, FlightEnded, Model, Rotor, Simulator, Spin, Status, Training,
                    Vehicles, __version__, airframe_names, certify, evaluate, ground_effects, train)
from .effects import Effects

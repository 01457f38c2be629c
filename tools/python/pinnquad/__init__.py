# SPDX-License-Identifier: MIT
"""Inverse dynamics of quadrotors: simulate, train, judge, certify, predict. World NED, body FRD, SI units, radians.

Rotors: front right, rear left, front left, rear right; a command is 0 to 1. docs/python.md shows the whole way.
"""
from ._core import (Airframe, Dataset, Error, Flight, FlightEnded, Identification, Model, Rotor, Simulator, Spin, Status,
                    Training, Vehicles, __version__, airframe_names, certify, evaluate, ground_effects, identify,
                    instruction_set, train)
from .conversion import convert, save_network
from .effects import Effects
from .environment import HoverEnv, VectorHoverEnv
from . import tables as _tables  # noqa: F401: Flight.from_arrays, Dataset.from_dataframe
from .flights import fly

__all__ = ["Airframe", "Dataset", "Effects", "Error", "Flight", "FlightEnded", "HoverEnv", "Identification", "Model",
           "Rotor", "Simulator", "Spin", "Status", "Training", "VectorHoverEnv", "Vehicles", "airframe_names", "certify",
           "convert", "evaluate", "fly", "ground_effects", "identify", "instruction_set", "save_network", "train"]

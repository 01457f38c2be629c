# SPDX-License-Identifier: MIT
"""Inverse dynamics of quadrotors: simulate, train, judge, certify, predict. World NED, body FRD, SI units, radians.

Rotors: front right, rear left, front left, rear right; a command is 0 to 1. docs/python.md shows the whole way.
"""
import inspect as _inspect

from ._core import (Airframe, Dataset, Error, Flight, FlightEnded, Identification, Model, Rotor, Simulator, Spin, Status,
                    Training, Vehicles, __version__, airframe_names, ground_effects, identify, instruction_set, split, train)
from .conversion import convert, save_network
from .effects import Effects
from .environment import HoverEnv, VectorHoverEnv
from . import study
from . import tables as _tables  # noqa: F401: Flight.from_arrays, Dataset.from_dataframe
from .flights import fly
from .paths import Path
from .results import Certificate, Evaluation, FlightVerdict, IdentifiedNumber, ModelFlight, certify, evaluate, loop

__all__ = ["Airframe", "Certificate", "Dataset", "Effects", "Error", "Evaluation", "Flight", "FlightEnded", "FlightVerdict",
           "HoverEnv", "IdentifiedNumber", "Identification", "Model", "ModelFlight", "Path", "Rotor", "Simulator", "Spin",
           "Status", "StructuredInverse", "Training", "VectorHoverEnv", "Vehicles", "airframe_names", "certify", "convert",
           "evaluate", "fly", "ground_effects", "identify", "instruction_set", "loop", "save_network", "split", "study",
           "train"]

for _class in (Airframe, Dataset, Flight, Simulator, Vehicles):  # classes of the module, which inspect does not look into
    _signature = _inspect.signature(_class.__init__)
    _class.__signature__ = _signature.replace(parameters=list(_signature.parameters.values())[1:])


def __getattr__(name):
    """StructuredInverse, when it is asked for: scikit-learn takes a second to import."""
    if name != "StructuredInverse":
        raise AttributeError(f"module 'pinnquad' has no attribute {name!r}")
    from .estimator import StructuredInverse
    return StructuredInverse

# SPDX-License-Identifier: MIT
"""Networks that were trained elsewhere as models, and models as networks for elsewhere (docs/convert.md)."""
import json
import os

from . import _core, networks


def convert(source, features, out, *, name="TrainedQuadModel", prefix=None, output=None, double=False):
    """Writes model.hpp and model.block into the folder `out`, and returns the Model.

    `source`: a torch.nn.Module, a state_dict or flax parameters, a fitted scikit-learn MLPRegressor, or the path of a
    network (.onnx, .safetensors). `features`: the path of features.toml, which says what its numbers mean. `prefix`: of
    tensors by name those that begin with it; None: all. `output`: the name of one of several outputs. `double`: numbers in double.
    Raises pinnquad.Error, one line, for a network that the library has no layers for, or whose answers differ.
    """
    in_memory = not isinstance(source, (str, os.PathLike))
    words = type(source).__name__ if in_memory else os.fspath(source)

    def answer(request):
        return json.dumps(networks.answer(json.loads(request), source if in_memory else None))

    _core._convert(words, features, out, name, prefix or "", output or "", double, answer)
    return _core.Model.load(os.path.join(os.fspath(out), "model.block"))


def save_network(model, path):
    """Writes a model as a network from features in physical units to commands: .onnx, or .safetensors for PyTorch."""
    ending = os.path.splitext(os.fspath(path))[1]
    if ending not in (".onnx", ".safetensors"):
        raise ValueError(f"save_network: expected a path that ends in .onnx or .safetensors, found {os.fspath(path)!r}")
    data = _core._network_of(model, ending, lambda request: json.dumps(networks.answer(json.loads(request))))
    part = f"{os.fspath(path)}.part"
    with open(part, "wb") as file:
        file.write(data)
    os.replace(part, path)

# SPDX-License-Identifier: MIT
"""Networks in memory become models that answer as they do, and models networks; the judge is NumPy, PyTorch or scikit-learn."""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pinnquad
from pinnquad import networks

NAMES = ["wdot_x", "wdot_y", "wdot_z", "s_z", "w_x"]
REACH = [60, 60, 5, 40, 5]


@pytest.fixture(autouse=True)
def features(tmp_path, monkeypatch):
    """features.toml: standardised by mean 0 and a scale of half its range."""
    monkeypatch.chdir(tmp_path)
    units = {"s_z": "m/s^2", "w_x": "rad/s"}
    rows = "".join(f'{{ name = "{name}", unit = "{units.get(name, "rad/s^2")}", lower = -{reach}, upper = {reach}, scale = {reach / 2} }},\n'
                   for name, reach in zip(NAMES, REACH))
    Path("features.toml").write_text(f'activations = "tanh"\nfeature = [\n{rows}]\n[airframe]\nname = "paper_quadrotor"\n')


def agrees(model, answer, tolerance=1e-6):
    """The model's commands are answer(standardised rows in the order of NAMES)."""
    x = np.random.default_rng(1).uniform(*model.envelope, (300, len(NAMES)))
    places = [list(model.feature_names).index(name) for name in NAMES]
    expected = answer(x[:, places] / (np.array(REACH) / 2))
    assert np.abs(model.predict(x) - expected).max() <= tolerance * max(1, np.abs(expected).max())


def dense(inputs, outputs, seed):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(outputs, inputs)) / np.sqrt(inputs), rng.normal(size=outputs)


@pytest.mark.parametrize("names, transposed", [(("0", "2"), False), (("fc1", "fc2"), False), (("Dense_0", "Dense_1"), True)])
def test_arrays_by_name(names, transposed):
    """A state_dict and flax parameters."""
    first, second = dense(5, 8, 1), dense(8, 4, 2)
    part = lambda layer: {"kernel" if transposed else "weight": layer[0].T if transposed else layer[0], "bias": layer[1]}
    tree = {name: part(layer) for name, layer in zip(names, (first, second))}
    source = {"params": tree} if transposed else {f"{name}.{key}": one for name in tree for key, one in tree[name].items()}
    model = pinnquad.convert(source, "features.toml", "my_model", double=True)
    assert Path("my_model/model.hpp").exists()
    agrees(model, lambda z: np.tanh(z @ first[0].T + first[1]) @ second[0].T + second[1], 1e-9)


def test_one_of_two_networks():
    networks_of = {f"{name}.{layer}.{part}": one for name, seed in (("actor", 1), ("critic", 5))
                   for layer, shape in (("0", (5, 8, seed)), ("2", (8, 4, seed + 1)))
                   for part, one in zip(("weight", "bias"), dense(*shape))}
    with pytest.raises(pinnquad.Error, match="prefix"):
        pinnquad.convert(networks_of, "features.toml", "my_model")
    assert not Path("my_model").exists()
    model = pinnquad.convert(networks_of, "features.toml", "my_model", prefix="actor.")
    agrees(model, lambda z: np.tanh(z @ dense(5, 8, 1)[0].T + dense(5, 8, 1)[1]) @ dense(8, 4, 2)[0].T + dense(8, 4, 2)[1])


def test_scikit_learn():
    neural = pytest.importorskip("sklearn.neural_network")
    rng = np.random.default_rng(3)
    x = rng.normal(size=(200, 5))
    network = neural.MLPRegressor(hidden_layer_sizes=(12,), activation="logistic", max_iter=30, random_state=1).fit(x, x[:, :4] ** 2)
    agrees(pinnquad.convert(network, "features.toml", "my_model"), network.predict)


def test_pytorch_module():
    """A skip connection, a slice and a normalisation: no Sequential."""
    torch = pytest.importorskip("torch")

    class Skipping(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.first, self.second, self.last = torch.nn.Linear(4, 8), torch.nn.Linear(8, 8), torch.nn.Linear(8, 4)
            self.register_buffer("mean", torch.tensor([0.1, -0.2, 0.3, 0.4]))

        def forward(self, x):
            h = torch.nn.functional.gelu(self.first((x[:, :4] - self.mean) / 2))
            return torch.clamp(self.last(h + torch.nn.functional.gelu(self.second(h))), 0, 1)

    torch.manual_seed(1)
    module = Skipping()
    model = pinnquad.convert(module, "features.toml", "my_model")
    with torch.no_grad():
        agrees(model, lambda z: module.double()(torch.tensor(z)).numpy())
    nn = torch.nn
    module = nn.Sequential(nn.Linear(5, 8), nn.LayerNorm(8), nn.ReLU(), nn.Linear(8, 16), nn.GLU(), nn.Linear(8, 4))
    model = pinnquad.convert(module, "features.toml", "my_model")
    with torch.no_grad():
        agrees(model, lambda z: module.double()(torch.tensor(z)).numpy())
    with pytest.raises(pinnquad.Error, match="of a norm"):
        pinnquad.convert(module.state_dict(), "features.toml", "other")
    with pytest.raises(pinnquad.Error, match="Softmax"):
        pinnquad.convert(nn.Sequential(nn.Linear(5, 4), nn.Softmax(-1)), "features.toml", "other")


def test_there_and_back():
    first, second = dense(5, 8, 1), dense(8, 4, 2)
    source = {"0.weight": first[0], "0.bias": first[1], "2.weight": second[0], "2.bias": second[1]}
    model = pinnquad.convert(source, "features.toml", "my_model")
    pinnquad.save_network(model, "net.safetensors")
    tensors = networks.read_safetensors(Path("net.safetensors").read_bytes())
    x = np.random.default_rng(1).uniform(*model.envelope, (50, 5))
    answers = np.tanh(x @ tensors["0.weight"].T + tensors["0.bias"]) @ tensors["2.weight"].T + tensors["2.bias"]
    assert np.abs(answers - model.predict(x)).max() <= 1e-5
    with pytest.raises(ValueError, match="onnx"):
        pinnquad.save_network(model, "net.txt")


def test_command_line():
    Path("net.safetensors").write_bytes(b"none")
    command = [sys.executable, "-m", "pinnquad", "convert", "net.safetensors", "--features", "features.toml", "--out", "my_model"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "net.safetensors" in done.stderr


def test_request_is_json():
    """As a script it answers on standard output."""
    asked = json.dumps({"source": "none.onnx", "rows": [[0.0]]})
    done = subprocess.run([sys.executable, networks.__file__], input=asked, capture_output=True, text=True)
    said = json.loads(done.stdout)
    assert said["found"] == "no such file" or "package onnx" in said["expected"], said

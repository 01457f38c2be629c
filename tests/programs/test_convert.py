# SPDX-License-Identifier: MIT
"""convert: a network of safetensors or ONNX becomes a model that answers as its source does, and a model a network that
answers as the model does. The source's answers are worked out here by loops in double, and by PyTorch where it is."""
import csv
import json
import math
import random
import re
import runpy
import statistics
import struct
import sys
import tomllib
from pathlib import Path

import pytest
from conftest import SOURCE, Program, listing, no_partial_files
from exported import Header

TOLERANCE = 1e-6  # of a command
UNITS = {"vdot_bx": "m/s^2", "s_z": "m/s^2", "wdot_x": "rad/s^2", "wdot_y": "rad/s^2", "wdot_z": "rad/s^2",
         "w_x": "rad/s", "down_z": "1", "altitude": "m", "battery_voltage": "V"}
# name, lower, upper: in an order of no feature set of the library
FEATURES = [("s_z", -25, 0), ("wdot_y", -60, 60), ("wdot_x", -60, 60), ("w_x", -5, 5), ("wdot_z", -10, 10)]
ACTIVATIONS = {"relu": lambda v: max(v, 0.0), "tanh": math.tanh, "sigmoid": lambda v: 1 / (1 + math.exp(-v)),
               "gelu": lambda v: v * (1 + math.erf(v / math.sqrt(2))) / 2, "silu": lambda v: v / (1 + math.exp(-v)),
               "softplus": lambda v: math.log1p(math.exp(v)), "sine": math.sin,
               "mish": lambda v: v * math.tanh(math.log1p(math.exp(v))), "softsign": lambda v: v / (1 + abs(v)),
               "hard_swish": lambda v: v * min(max(v + 3, 0), 6) / 6,
               "gelu_tanh": lambda v: v * (1 + math.tanh(math.sqrt(2 / math.pi) * (v + 0.044715 * v**3))) / 2, "elu": lambda v: v if v > 0 else math.expm1(v),
               "leaky_relu": lambda v: v if v > 0 else 0.01 * v, "identity": lambda v: v}
AIRFRAME = '[airframe]\nname = "paper_quadrotor"\n'


def features_toml(*lines, features=FEATURES, per_feature=lambda lower, upper: "", units=UNITS, tables=AIRFRAME):
    """Writes features.toml."""
    rows = "".join(f'  {{ name = "{name}", unit = "{units[name]}", lower = {lower}, upper = {upper}'
                   f'{per_feature(lower, upper)} }},\n' for name, lower, upper in features)
    Path("features.toml").write_text("\n".join([f"feature = [\n{rows}]", *lines, tables]))


def mean_and_scale(lower, upper):
    return f", mean = {(lower + upper) / 2 + 0.1}, scale = {(upper - lower) / 4}"


def standardised(row, features=FEATURES):
    return [(row[name] - (lower + upper) / 2 - 0.1) / ((upper - lower) / 4) for name, lower, upper in features]


def safetensors(path, tensors, number="f", change=lambda header: None):
    """Writes {name: (shape, values)}; change(header) edits its JSON."""
    header, data = {}, b""
    for name, (shape, values) in tensors.items():
        raw = struct.pack(f"<{len(values)}{number}", *values)
        header[name] = {"dtype": {"f": "F32", "d": "F64"}[number], "shape": list(shape),
                        "data_offsets": [len(data), len(data) + len(raw)]}
        data += raw
    edited = change(header)
    text = edited if isinstance(edited, bytes) else json.dumps(header).encode()
    Path(path).write_bytes(struct.pack("<Q", len(text)) + text + data)
    return path


def as_float(values):
    return list(struct.unpack(f"{len(values)}f", struct.pack(f"{len(values)}f", *values)))


class Network:
    """Layers of random numbers, as floats: a width is Linear, "norm" is BatchNorm1d, a word an activation."""

    def __init__(self, inputs, *layers, seed=1):
        rng = random.Random(seed)
        self.tensors, self.layers, width = {}, [], inputs
        draw = lambda count, least, most: as_float([rng.uniform(least, most) for _ in range(count)])
        for number, layer in enumerate(layers):
            if layer == "norm":
                parts = {"weight": draw(width, 0.5, 2), "bias": draw(width, -1, 1), "running_mean": draw(width, -1, 1),
                         "running_var": draw(width, 0.3, 2)}
                self.tensors.update({f"{number}.{name}": ((width,), values) for name, values in parts.items()})
                self.layers.append(("norm", *parts.values()))
            elif isinstance(layer, int):
                bound = 1 / math.sqrt(width)
                weights, biases = draw(width * layer, -bound, bound), draw(layer, -bound, bound)
                self.tensors[f"{number}.weight"] = (layer, width), weights
                self.tensors[f"{number}.bias"] = (layer,), biases
                self.layers.append((layer, weights, biases))
                width = layer
            else:
                self.layers.append((layer,))

    def __call__(self, x):
        for kind, *numbers in self.layers:
            if kind == "norm":
                x = [(v - mean) / math.sqrt(variance + 1e-5) * gamma + beta
                     for v, gamma, beta, mean, variance in zip(x, *numbers)]
            elif isinstance(kind, int):
                x = dense((kind, *numbers), x)
            else:
                x = [ACTIVATIONS[kind](v) for v in x]
        return x


def dense(layer, x):
    _, weights, biases = layer
    return [bias + sum(w * v for w, v in zip(weights[row * len(x) : (row + 1) * len(x)], x))
            for row, bias in enumerate(biases)]


def golden(header):
    """Features by name, and commands, of each golden vector."""
    names = header.names()
    features, commands = header.numbers("golden_features"), header.numbers("golden_commands")
    rows = [dict(zip(names, features[at : at + len(names)])) for at in range(0, len(features), len(names))]
    assert len(rows) == 8 and len(commands) == 32
    return [(row, commands[4 * i : 4 * i + 4]) for i, row in enumerate(rows)]


def worst(header, answer):
    """Largest difference of a golden command from answer({feature: value})."""
    return max(abs(a - b) for row, commands in golden(header) for a, b in zip(answer(row), commands))


def converted(pinnquad, source, *words):
    done = pinnquad("convert", source, "--features", "features.toml", "--out", "model", *words)
    said = json.loads(pinnquad("block --json model/model.block").out)
    assert said["golden_difference"] <= TOLERANCE
    header = Header("model/model.hpp")
    assert said["contents_hash"] in header.text
    assert float(re.search(r"at most (\S+) from", done.out).group(1)) <= TOLERANCE
    return header


# three of them a network: each has a layer's width of numbers to answer for
TRIPLES = [["relu", "tanh", "sigmoid"], ["gelu", "silu", "softplus"], ["sine", "mish", "softsign"],
           ["hard_swish", "gelu_tanh", "elu"], ["leaky_relu", "gelu", "gelu_tanh"]]
assert {name for names in TRIPLES for name in names} == set(ACTIVATIONS) - {"identity"}


@pytest.mark.parametrize("names, norm", zip(TRIPLES, ["", "before", "behind", "before", "behind"]))
def test_safetensors(pinnquad, names, norm):
    """Each activation, with batch norm before it or behind it; a sigmoid behind the last layer."""
    layers = [layer for name in names
              for layer in (12, *["norm"] * (norm == "before"), name, *["norm"] * (norm == "behind"))]
    network = Network(len(FEATURES), *layers, 4, "sigmoid")
    safetensors("net.safetensors", network.tensors)
    features_toml(f"activations = {json.dumps([*names, 'sigmoid'])}", per_feature=mean_and_scale)
    header = converted(pinnquad, "net.safetensors")
    assert worst(header, lambda row: network(standardised(row))) <= TOLERANCE
    # as the library's own models: the header has no sigmoid and no norm
    assert "Sigmoid" not in header.text and "BatchNorm" not in header.text


def test_physical_values(pinnquad):
    """A network that reads no standardised numbers, in units of its own; one that names its tensors behind a prefix;
    modules without numbers that do nothing."""
    network = Network(len(FEATURES), "norm", 8, "tanh", "identity", 4)
    # what reads degrees has weights as small
    network.tensors = {f"model.net.{name}": tensor for name, tensor in network.tensors.items()}
    safetensors("net.safetensors", network.tensors, "d")
    other = {**UNITS, "w_x": "deg/s", "wdot_z": "deg/s^2", "s_z": "g"}
    features_toml('activations = ["tanh", "identity"]', units=other)
    header = converted(pinnquad, "net.safetensors")
    factor = {"w_x": 180 / math.pi, "wdot_z": 180 / math.pi, "s_z": 1 / 9.80665}
    shown = lambda row: [row[name] * factor.get(name, 1) for name, *_ in FEATURES]
    assert worst(header, lambda row: network(shown(row))) <= TOLERANCE
    lower = dict(zip(header.names(), header.numbers("envelope_lower")))
    assert lower["w_x"] == pytest.approx(math.radians(-5)) and lower["s_z"] == pytest.approx(-25 * 9.80665)


def test_outputs(pinnquad):
    """Commands in another order, scaled; and a network that makes the sums about the axes."""
    network = Network(len(FEATURES), 8, "relu", 4)
    safetensors("net.safetensors", network.tensors)
    output = "[output]\nnames = {}\nmean = [0.5, 0.4, 0.3, 0.2]\nscale = [0.1, 0.2, 0.3, 0.4]\n"
    made = lambda row: [y * scale + mean for y, scale, mean in zip(
        network([row[name] for name, *_ in FEATURES]), (0.1, 0.2, 0.3, 0.4), (0.5, 0.4, 0.3, 0.2))]
    features_toml('activations = "relu"', tables=output.format('["u3", "u1", "u4", "u2"]') + AIRFRAME)
    header = converted(pinnquad, "net.safetensors")
    assert worst(header, lambda row: [made(row)[place] for place in (1, 3, 0, 2)]) <= TOLERANCE
    features_toml('activations = "relu"', tables=output.format('["sum", "roll_sum", "pitch_sum", "yaw_sum"]') + AIRFRAME)
    header = converted(pinnquad, "net.safetensors")
    assert "pinnquad::AxisCommandOutputs" in header.text
    signs = header.signs()
    commands = lambda y: [(y[0] + sum(signs[3 * i + k] * y[k + 1] for k in range(3))) / 4 for i in range(4)]
    assert worst(header, lambda row: commands(made(row))) <= TOLERANCE


def test_double(pinnquad):
    """A network whose numbers float has no digits for: refused, and taken in double."""
    network = Network(len(FEATURES), 8, "tanh", 4)
    shape, weights = network.tensors["2.weight"]
    network.tensors["2.weight"] = shape, [3000 * w for w in weights]
    network.layers[2] = (4, network.tensors["2.weight"][1], network.layers[2][2])
    safetensors("net.safetensors", network.tensors, "d")
    features_toml('activations = "tanh"', per_feature=mean_and_scale)
    pinnquad.refused("convert net.safetensors --features features.toml --out model", at="net.safetensors",
                     keyword="--double")
    assert not Path("model").exists()
    header = converted(pinnquad, "net.safetensors", "--double")
    assert "using Scalar = double;" in header.text


def test_feature_sets(pinnquad, compiler):
    """A set of the library by its name; else a choice of its features, with the altitude and measured columns. The
    header compiles without exceptions and run-time types, passes its self test and refuses what is outside."""
    columns = [("battery_voltage", 13, 17), *FEATURES, ("altitude", 0.1, 3)]
    for name, features in {"InverseAccelerations": [FEATURES[i] for i in (4, 2, 0, 1)], "WithColumns": columns}.items():
        network = Network(len(features), 8, "gelu", 4)
        safetensors("net.safetensors", network.tensors)
        features_toml('activations = "gelu"', features=features, per_feature=mean_and_scale)
        header = converted(pinnquad, "net.safetensors")
        features_type = re.search("using Features = (.*);", header.text).group(1)
        assert features_type.startswith(f"pinnquad::{name}")
        assert worst(header, lambda row: network(standardised(row, features))) <= TOLERANCE
    assert features_type == ("pinnquad::WithColumns<pinnquad::Chosen<pinnquad::NamedFeaturesWithAltitude, 3, 4, 5, 9, "
                             "18, 28>, TrainedQuadModelColumn1>")
    Path("main.cpp").write_text("""
#include "model/model.hpp"
#include <cmath>
int main() {
  const pinnquad::InverseDynamics<TrainedQuadModel> inverse;
  if (pinnquad::self_test(inverse) != pinnquad::Status::ok) return 1;
  TrainedQuadModel::Inputs hover;
  pinnquad::Commands<float> u{};
  if (inverse.predict(hover, u) != pinnquad::Status::not_finite) return 2;
  hover.altitude_m = 1;
  hover.column<TrainedQuadModelColumn1>() = 15;
  if (inverse.predict(hover, u) != pinnquad::Status::ok) return 3;
  for (const float one : u) {
    if (!std::isfinite(one)) return 4;
  }
  return 0;
}
""")
    compiler("-O1 -fno-exceptions -fno-rtti -ffp-contract=off -Wall -Wextra -Werror -I. main.cpp -o main")
    Program("./main")()


def test_commands_take_it(pinnquad, flown):
    """certify, evaluate and loop know no difference. An affine network is proven where its slopes are."""
    features = [("wdot_x", -200, 200), ("wdot_y", -200, 200), ("wdot_z", -50, 50), ("s_z", -40, 10)]
    features_toml(features=features)
    signs = [(-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, -1, -1)]
    slopes = [0.002, 0.002, 0.01]
    weights = [w for row in signs for w in [*(s * k for s, k in zip(row, slopes)), -0.05]]
    safetensors("affine.safetensors", {"0.weight": ((4, 4), weights), "0.bias": ((4,), [0.0] * 4)})
    header = converted(pinnquad, "affine.safetensors")
    assert "PROVEN" in header.text and "NOT PROVEN" not in header.text
    assert "proven" in pinnquad("certify model/model.hpp").out
    report = json.loads(pinnquad("certify model/model.block --json").out)
    assert report["held_slope"]["roll"] == pytest.approx(4 * slopes[0], rel=1e-5)
    flight = flown("--seed 9 --samples 500")
    assert "derivative" in pinnquad("evaluate model/model.block", flight, code=(0, 1)).out
    # the other way round: refuted
    safetensors("affine.safetensors", {"0.weight": ((4, 4), [-w for w in weights]), "0.bias": ((4,), [0.5] * 4)})
    header = converted(pinnquad, "affine.safetensors")
    assert "NOT PROVEN" in header.text
    assert "provable" in pinnquad("certify model/model.block --seconds 1", code=1).out
    # one verdict, whoever gives it: of this one, and of a network that is refuted and flies well
    def verdicts(model, *more):
        said = [pinnquad(words, model, *rest, code=(0, 1)).flat for words, *rest in (
            ["certify"], ["loop"], ["loop", "--controllers", "structured"], *more)]
        assert all("evidence R^2" in text or "evidence judged" in text for text in said), said
        return {re.search("verdict ([a-z ]+): ", text).group(1) for text in said}
    assert verdicts("model/model.block", ["evaluate", flight]) == {"do not fly"}
    assert "verdict do not fly: " in pinnquad("convert affine.safetensors --features features.toml --out model").flat
    assert verdicts(SOURCE / "examples/models/demo_quadrotor.block") == {"fly with care"}


def test_networks_py_knows_each_activation(pinnquad):
    """The program has them of the library's list, networks.py by hand."""
    safetensors("net.safetensors", Network(len(FEATURES), 4).tensors)
    features_toml('activations = "swish"')
    said = refused_features(pinnquad, "*:15", "swish").lines[0]
    words = re.findall(r'"(\w+)"', said.partition(", found")[0])
    assert "relu" in words and set(words) == set(NETWORKS["ACTIVATIONS"])


def refused_features(pinnquad, place, keyword):
    done = pinnquad.refused("convert net.safetensors --features features.toml --out model",
                            at="features.toml" + (f":{place}" if place else ""), keyword=keyword)
    assert listing(".") == ["features.toml", "net.safetensors"], "nothing is left behind"
    return done


FEATURE = '{ name = "w_x", unit = "rad/s", lower = -5, upper = 5 }'
WRONG_FEATURES = {
    "no feature": ("", "", "feature"),
    "empty": ("feature = []", "1:11", "an array of 0"),
    "numbers": ("feature = [1]", "1:11", "array"),
    "unit": (f"feature = [{FEATURE.replace('rad/s', 'rpm')}]", "1:35", "deg/s"),
    "no unit": ('feature = [{ name = "w_x", lower = 0, upper = 1 }]', "1:12", "unit"),
    "unknown": (f"feature = [{FEATURE[:-2]}, least = 1 }}]", "1:67", "least"),
    "upside down": ('feature = [{ name = "w_x", unit = "rad/s", lower = 5, upper = -5 }]', "1:63", "above"),
    "scale": (f"feature = [{FEATURE[:-2]}, scale = 0 }}]", "1:75", "1e-9"),
    "tiny scale": (f"feature = [{FEATURE[:-2]}, scale = 1e-8 }}]", "1:75", "131072"),
    "twice": (f"feature = [{FEATURE}, {FEATURE}]", "1:69", "again"),
    "window": (f"feature = [{FEATURE.replace('w_x', 'w_x[-1]')}]", "1:21", "window"),
    "text": (f"feature = [{FEATURE.replace('-5', chr(34) + 'five' + chr(34))}]", "1:52", "five"),
    "not finite": (f"feature = [{FEATURE.replace('-5', 'nan')}]", "1:52", "nan"),
    "columns alone": ('feature = [{ name = "volts", unit = "V", lower = 0, upper = 5 }]', "", "columns alone"),
    "no TOML": ("feature = [", "*:*", "TOML"),
    "outputs": (f'feature = [{FEATURE}]\noutput = {{ names = ["u1", "u2", "u2", "u4"] }}', "2:20", "u2"),
    "output mean": (f"feature = [{FEATURE}]\noutput = {{ mean = [1, 2] }}", "2:19", "4"),
    "output table": (f"feature = [{FEATURE}]\noutput = 3", "2:10", "table"),
    "unknown key": (f"feature = [{FEATURE}]\nmotors = 4", "2:1", "motors"),
    "activation": (f'feature = [{FEATURE}]\nactivations = "swish"', "2:15", "swish"),
    "activation list": (f'feature = [{FEATURE}]\nactivations = ["tanh", 3]', "2:24", "3"),
    "period": (f"feature = [{FEATURE}]\nsample_period_s = 5", "2:19", "5"),
    "meaning": (f'feature = [{FEATURE}]\ncommands_are = "volts"', "2:16", "volts"),
    "no airframe": (f"feature = [{FEATURE}]\n# airframe", "1:1", "airframe"),
    "airframe 3": (f"feature = [{FEATURE}]\nairframe = 3", "2:12", "3"),
    "empty airframe": (f"feature = [{FEATURE}]\n[airframe]", "2:1", "none of them"),
    "zeppelin": (f'feature = [{FEATURE}]\n[airframe]\nname = "zeppelin"', "3:8", "zeppelin"),
    "mass": (f"feature = [{FEATURE}]\n[airframe]\nmass = 3", "3:1", "mass"),
    "two airframes": (f'feature = [{FEATURE}]\n{AIRFRAME}file = "a.toml"', "2:1", "both"),
}


@pytest.mark.parametrize("case", WRONG_FEATURES)
def test_wrong_features(pinnquad, case):
    text, place, keyword = WRONG_FEATURES[case]
    safetensors("net.safetensors", Network(1, 4).tensors)
    Path("features.toml").write_text(text + "\n" + ("" if "airframe" in text else AIRFRAME))
    refused_features(pinnquad, place, keyword)


def test_airframe_file(pinnquad):
    """Beside features.toml, wherever the program runs."""
    Path("there").mkdir()
    pinnquad("airframe convert racer_5_inch --out there/mine.toml")
    safetensors("net.safetensors", Network(1, 4).tensors)
    Path("there/features.toml").write_text(f'feature = [{FEATURE}]\n[airframe]\nfile = "mine.toml"\n')
    pinnquad("convert net.safetensors --features there/features.toml --out model")
    assert json.loads(pinnquad("block --json model/model.block").out)["airframe"] == "racer_5_inch"


def test_widths(pinnquad):
    """Features, outputs and activations that are not the network's."""
    safetensors("net.safetensors", Network(3, 4).tensors)
    features_toml()
    refused_features(pinnquad, "", "5 features")
    safetensors("net.safetensors", Network(5, 3).tensors)
    refused_features(pinnquad, "", "4 outputs")
    safetensors("net.safetensors", Network(5, 8, "relu", 4).tensors)
    refused_features(pinnquad, "", "activations")
    features_toml('activations = ["relu", "relu", "relu"]')
    refused_features(pinnquad, "", "3")


def header_of(**entry):
    """A change of the entry of 0.weight."""
    return lambda header: header["0.weight"].update(entry)


HOSTILE = {
    "array": (lambda header: b"[1, 2]", "JSON object"),
    "no JSON": (lambda header: b"{", "JSON object"),
    "bytes": (lambda header: b"\xff" * 40, "JSON object"),
    "deep": (lambda header: b"[" * 100000, "nest"),
    "twice": (lambda header: json.dumps(header).replace("0.bias", "0.weight").encode(), "twice"),
    "no object": (lambda header: header.update({"0.weight": 3}), "number"),
    "half": (header_of(dtype="F16"), "40 bytes"),
    "whole": (header_of(dtype="I64"), "I64"),
    "no dtype": (header_of(dtype=3), "dtype"),
    "no shape": (header_of(shape="wide"), "shape"),
    "negative": (header_of(shape=[-4, -5]), "-4"),
    "fraction": (header_of(shape=[4.5, 5]), "4.5"),
    "huge": (header_of(shape=[2**63, 2]), "2^28"),
    "huge product": (header_of(shape=[2**20, 2**20, 2**24]), "2^28"),
    "another shape": (header_of(shape=[5, 5]), "100 bytes"),
    "offsets": (header_of(data_offsets=[0]), "data_offsets"),
    "negative offset": (header_of(data_offsets=[-1, 79]), "data_offsets"),
    "backwards": (header_of(data_offsets=[80, 0]), "80"),
    "beyond": (header_of(data_offsets=[8, 2**62]), "96"),
    "overlap": (lambda header: header["0.bias"].update(data_offsets=[64, 80]), "one before"),
    "hole": (lambda header: header["0.weight"].update(shape=[4, 4], data_offsets=[0, 64]), "hole"),
    "behind": (lambda header: header.pop("0.bias") and None, "80 bytes"),
    "a matrix of one dimension": (header_of(shape=[20]), "two dimensions"),
    "convolution": (header_of(shape=[4, 5, 1]), "two dimensions"),
    "bias": (lambda header: header["0.bias"].update(shape=[2, 2]), "[4]"),
    "names": (lambda header: header.update({"weight": header.pop("0.weight")}), "Sequential"),
    "two networks": (lambda header: header.update({"a.0.weight": header.pop("0.weight")}), "beside"),
    "unknown": (lambda header: header.update({"0.scale": header.pop("0.bias")}), "0.scale"),
}


@pytest.mark.parametrize("case", HOSTILE)
def test_hostile(case):
    change, keyword = HOSTILE[case]
    safetensors("net.safetensors", Network(5, 4).tensors, change=change)
    refused_network("net.safetensors", keyword)


NETWORKS = runpy.run_path(SOURCE / "tools/python/pinnquad/networks.py")


def refused_network(name, keyword):
    """By networks.py: the program has what is wrong of it (test_refused_by_the_program)."""
    said = NETWORKS["answer"]({"source": name, "rows": [[0.0] * 5]})
    assert keyword in f"{said['expected']}, found {said['found']}" and "\n" not in said["expected"] + said["found"], said
    return said


@pytest.mark.parametrize("case", ["array", "half", "bias", "cut", "not finite"])
def test_refused_by_the_program(pinnquad, case):
    """In one line, with nothing left behind."""
    change, keyword = HOSTILE.get(case, (lambda header: None, "cut short" if case == "cut" else "0.bias"))
    network = Network(5, 4)
    if case == "not finite":
        network.tensors["0.bias"] = (4,), [0, math.nan, 0, 0]
    safetensors("net.safetensors", network.tensors, change=change)
    if case == "cut":
        Path("net.safetensors").write_bytes(Path("net.safetensors").read_bytes()[:100])
    features_toml()
    pinnquad.refused("convert net.safetensors --features features.toml --out model", at="net.safetensors", keyword=keyword)
    assert listing(".") == ["features.toml", "net.safetensors"], "nothing is left behind"


@pytest.mark.parametrize("content, keyword", [
    (b"", "0 bytes"), (b"\x02\0\0", "3 bytes"), (b"\xff" * 8, "16 MiB"), (struct.pack("<Q", 100) + b"{}", "cut short"),
    (struct.pack("<Q", 2) + b"{}", "none")])
def test_cut_short(content, keyword):
    Path("net.safetensors").write_bytes(content)
    refused_network("net.safetensors", keyword)


def test_arguments(pinnquad):
    safetensors("net.safetensors", Network(5, 4).tensors)
    features_toml(per_feature=mean_and_scale)
    block = SOURCE / "examples/models/demo_quadrotor.block"
    for words, keyword in {"net.safetensors --out model": "--features", "features.toml --features features.toml --out model": ".onnx",
                           f"{block} --out net.txt": ".onnx",
                           f"{block} --features features.toml --out net.onnx": "--features",
                           "net.safetensors --features features.toml --out model --name 3": "--name",
                           "none.safetensors --features features.toml --out model": "none.safetensors",
                           "net.safetensors --features features.toml --out features.toml": "features.toml"}.items():
        pinnquad.refused(f"convert {words}", keyword=keyword)
        assert listing(".") == ["features.toml", "net.safetensors"]
    no_partial_files()


# ONNX

def has_onnx():
    """Skips where Python has no package onnx."""
    pytest.importorskip("onnx.numpy_helper")
    return pytest.importorskip("onnx")


class Graph:
    """A chain of nodes under construction: net.onnx."""

    def __init__(self, onnx, inputs=5, outputs=4, number="FLOAT"):
        self.onnx, self.nodes, self.constants, self.x = onnx, [], [], "x"
        self.number = getattr(onnx.TensorProto, number)
        self.shapes = [("rows", inputs), ("rows", outputs)]
        self.opset, self.change = 13, lambda model: None
        features_toml()

    def constant(self, values, shape, number=None):
        name = f"c{len(self.constants)}"
        self.constants.append(self.onnx.helper.make_tensor(name, number or self.number, shape, values))
        return name

    def node(self, op, *inputs, **attributes):
        self.x = f"y{len(self.nodes)}"
        self.nodes.append(self.onnx.helper.make_node(op, list(inputs), [self.x], name=f"{op}_{len(self.nodes)}",
                                                     **attributes))
        return self.x

    def write(self):
        helper = self.onnx.helper
        described = [helper.make_tensor_value_info(name, self.number, shape)
                     for name, shape in zip(("x", self.x), self.shapes)]
        graph = helper.make_graph(self.nodes, "net", described[:1], described[1:], self.constants)
        model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", self.opset)])
        model.ir_version = 7
        self.change(model)
        Path("net.onnx").write_bytes(model.SerializeToString())


def linear(graph, layer, inputs, how):
    """A layer of Network by Gemm or MatMul and Add."""
    outputs, weights, biases = layer
    columns = [weights[row * inputs + column] for column in range(inputs) for row in range(outputs)]
    if how == "gemm":
        graph.node("Gemm", graph.x, graph.constant(weights, [outputs, inputs]), graph.constant(biases, [outputs]), transB=1)
    elif how == "scaled":
        graph.node("Gemm", graph.x, graph.constant([2 * v for v in columns], [inputs, outputs]),
                   graph.constant([4 * v for v in biases], [1, outputs]), alpha=0.5, beta=0.25)
    elif how == "transposed":
        matrix = graph.constant(weights, [outputs, inputs])
        x = graph.x
        transposed = graph.node("Transpose", matrix, perm=[1, 0])
        graph.node("Add", graph.node("MatMul", x, transposed), graph.constant(biases, [outputs]))
    else:
        graph.node("Add", graph.constant(biases, [outputs]),
                   graph.node("MatMul", graph.x, graph.constant(columns, [inputs, outputs])))


def activation(graph, name):
    x, number = graph.x, lambda value: graph.constant([value], [])
    if name == "gelu":
        gate = graph.node("Add", graph.node("Erf", graph.node("Div", x, number(math.sqrt(2)))), number(1.0))
        graph.node("Mul", graph.node("Mul", x, gate), number(0.5))
    elif name == "silu":
        graph.node("Mul", graph.node("Sigmoid", x), x)
    elif name == "mish":  # as exporters before opset 18
        graph.node("Mul", graph.node("Tanh", graph.node("Softplus", x)), x)
    elif name == "hard_swish":
        graph.node("Mul", graph.node("HardSigmoid", x, alpha=1 / 6, beta=0.5), x)
    elif name == "gelu_tanh":
        cube = graph.node("Pow", x, number(3.0))
        inner = graph.node("Add", x, graph.node("Mul", cube, number(0.044715)))
        gate = graph.node("Add", graph.node("Tanh", graph.node("Mul", inner, number(math.sqrt(2 / math.pi)))), number(1.0))
        graph.node("Mul", graph.node("Mul", x, gate), number(0.5))
    else:
        graph.node({"relu": "Relu", "tanh": "Tanh", "sigmoid": "Sigmoid", "softplus": "Softplus", "sine": "Sin", "elu": "Elu",
                    "leaky_relu": "LeakyRelu", "softsign": "Softsign"}[name], x)


def layered(graph, network, how="gemm"):
    """The network's layers, one behind the other."""
    width = 5
    for layer in network.layers:
        if layer[0] == "norm":
            graph.node("BatchNormalization", graph.x, *(graph.constant(values, [width]) for values in layer[1:]))
        elif isinstance(layer[0], int):
            linear(graph, layer, width, how)
            width = layer[0]
        else:
            activation(graph, layer[0])


@pytest.mark.parametrize("how, names", zip(["gemm", "scaled", "matmul", "transposed", "scaled"], TRIPLES))
def test_onnx(pinnquad, how, names):
    """Each activation and each way to write a layer, batch norm behind the first."""
    onnx = has_onnx()
    network = Network(5, 12, "norm", names[0], 12, names[1], 12, names[2], 4)
    graph = Graph(onnx, number="DOUBLE" if how == "scaled" else "FLOAT")
    graph.node("Flatten", graph.node("Identity", "x"))
    layered(graph, network, how)
    graph.write()
    onnx.checker.check_model(onnx.load("net.onnx"), full_check=True)
    features_toml(per_feature=mean_and_scale)
    header = converted(pinnquad, "net.onnx")
    assert worst(header, lambda row: network(standardised(row))) <= TOLERANCE


def normalised(graph, how, width, rng):
    """The numbers of graph.x normalised as `how` writes it, with an epsilon of its own; what it answers."""
    x, number = graph.x, lambda value: graph.constant([value], [])
    gamma, beta = as_float([rng.uniform(0.5, 2) for _ in range(width)]), as_float([rng.uniform(-1, 1) for _ in range(width)])
    scale, shift = graph.constant(gamma, [width]), graph.constant(beta, [width])
    centred, epsilon = not how.startswith("rms"), {"layer_norm": 1e-5, "rms_operator": 1.1920929e-07}.get(how, 1e-3)
    if how == "layer_norm":
        graph.node("LayerNormalization", x, scale, shift)
    elif how == "rms_operator":
        graph.node("RMSNormalization", x, scale, epsilon=epsilon)
        beta = [0.0] * width
    else:  # as exporters before opset 17, and of RMSNorm today
        off = graph.node("Sub", x, graph.node("ReduceMean", x, axes=[-1])) if centred else x
        variance = graph.node("ReduceMean", graph.node("Pow", off, number(2.0)), axes=[-1])
        root = graph.node("Sqrt", graph.node("Add", variance, number(epsilon)))
        made = graph.node("Div", off, root) if centred else graph.node("Mul", off, graph.node("Reciprocal", root))
        graph.node("Add", graph.node("Mul", made, scale), shift)

    def answer(x):
        mean = sum(x) / width if centred else 0
        root = math.sqrt(sum((v - mean) ** 2 for v in x) / width + epsilon)
        return [(v - mean) / root * g + b for v, g, b in zip(x, gamma, beta)]

    return answer


@pytest.mark.parametrize("how, behind", [("layer_norm", "relu"), ("rms_operator", "gelu"), ("layer_steps", "gelu"),
                                         ("rms_steps", "relu")])
def test_norms(pinnquad, how, behind):
    """LayerNorm and RMSNorm as operators and step by step, before an activation and behind it, a GLU, a skip connection
    past all of them: as the source answers, back to ONNX, and flown."""
    onnx, numpy = has_onnx(), pytest.importorskip("numpy")
    first, second, third, last = (Network(inputs, outputs, seed=seed).layers[0]
                                  for seed, (inputs, outputs) in enumerate([(5, 12), (12, 24), (12, 12), (12, 4)]))
    graph, rng = Graph(onnx), random.Random(4)
    graph.opset = 17
    linear(graph, first, 5, "gemm")
    one = normalised(graph, how, 12, rng)
    activation(graph, behind)
    skipped = graph.x
    two = normalised(graph, how, 12, rng)
    linear(graph, second, 12, "gemm")
    graph.nodes.append(onnx.helper.make_node("Split", [graph.x], ["a", "b"], "Split", axis=-1))
    graph.node("Mul", graph.node("Sigmoid", "b"), "a")
    linear(graph, third, 12, "gemm")
    activation(graph, behind)
    graph.node("Add", graph.x, skipped)
    linear(graph, last, 12, "gemm")
    graph.write()
    features_toml(per_feature=mean_and_scale)
    header = converted(pinnquad, "net.onnx")
    assert ("RmsNorm<12>" if "rms" in how or how == "layer_steps" else "LayerNorm<12>") in header.text

    def answer(row):
        h = [ACTIVATIONS[behind](v) for v in one(dense(first, standardised(row)))]
        both = dense(second, two(h))
        gate = [a * ACTIVATIONS["sigmoid"](b) for a, b in zip(both[:12], both[12:])]
        return dense(last, [ACTIVATIONS[behind](a) + b for a, b in zip(dense(third, gate), h)])

    assert worst(header, answer) <= TOLERANCE
    pinnquad("convert model/model.block --out back.onnx")
    answers_as(onnx, numpy, onnx.load("back.onnx"), header)
    pinnquad.refused("convert model/model.block --out back.safetensors", keyword="a norm or a gate")
    assert "NOT PROVEN" in header.text
    assert json.loads(pinnquad("loop model/model.block --json", code=(0, 1)).out)


@pytest.mark.parametrize("shape", [[5], [1, 1, 5], ["rows", "steps", 5]])
def test_input_shapes(pinnquad, shape):
    """One motion without a row of its own, or as the only step of a sequence."""
    network = Network(5, 12, "relu", 4)
    graph = Graph(has_onnx())
    layered(graph, network, "matmul")
    graph.shapes = [shape, [*shape[:-1], 4]]
    graph.write()
    features_toml(per_feature=mean_and_scale)
    header = converted(pinnquad, "net.onnx")
    assert worst(header, lambda row: network(standardised(row))) <= TOLERANCE


def wrong_onnx():
    """By case change(graph), and a word of the refusal; the sound graph is a Gemm and a Relu."""
    op = lambda name, *more, **how: lambda graph: graph.node(name, graph.x, *(more), **how)
    model = lambda change: lambda graph: setattr(graph, "change", change)
    weights = lambda change: model(lambda m: change(m.graph.initializer[0]))
    width = lambda change: model(lambda m: change(m.graph.input[0].type.tensor_type))
    return {
        "unknown": (op("Softmax"), "Softmax"),
        "domain": (op("Relu", domain="com.example"), "com.example"),
        "product": (lambda g: g.node("Mul", g.x, g.x), "'Mul_2' (Mul): an activation"),
        "two products": (lambda g: g.node("Mul", g.x, "y0"), "'Mul_2' (Mul)"),
        "over numbers": (op("ReduceMean", axes=[0]), "rows"),
        "erf": (op("Erf"), "an activation"),
        "quotient": (lambda g: g.node("Div", g.constant([1.0], []), g.x), "an activation"),
        "by zero": (lambda g: g.node("Div", g.x, g.constant([0.0], [])), "'Div_2'"),
        "shape": (lambda g: g.node("Add", g.x, g.constant([1.0] * 3, [3])), "[3]"),
        "column": (lambda g: g.node("Add", g.x, g.constant([1.0] * 4, [4, 1])), "'Add_2'"),
        "matrix": (lambda g: g.node("MatMul", g.x, g.constant([1.0] * 12, [3, 4])), "[3, 4]"),
        "made of nothing": (lambda g: g.node("Add", g.x, "nowhere"), "nowhere"),
        "cast": (op("Cast", to=7), "'Cast_2'"),
        "training": (lambda g: g.node("BatchNormalization", g.x, *[g.constant([1.0] * 4, [4]) for _ in range(4)],
                                      training_mode=1), "training_mode"),
        "variance": (lambda g: g.node("BatchNormalization", g.x, *[g.constant([-1.0] * 4, [4]) for _ in range(4)]), "-1"),
        "NaN": (lambda g: g.node("Add", g.x, g.constant([math.nan], [])), "NaN"),
        "inputs": (lambda g: g.node("Relu", g.x, g.x), "inputs that it takes"),
        "features": (width(lambda t: t.shape.dim[1].ClearField("dim_value")), "dynamic"),
        "named": (width(lambda t: setattr(t.shape.dim[1], "dim_param", "columns")), "'columns'"),
        "no features": (width(lambda t: setattr(t.shape.dim[1], "dim_value", -3)), "-3"),
        "huge": (width(lambda t: setattr(t.shape.dim[1], "dim_value", 2**62)), "features"),
        "rank": (width(lambda t: t.shape.dim.add()), "no window"),
        "recurrent": (op("GRU", hidden_size=4), "without a state"),
        "input type": (width(lambda t: setattr(t, "elem_type", 7)), "INT64"),
        "two inputs": (model(lambda m: m.graph.input.add().CopyFrom(m.graph.input[0]) or
                             setattr(m.graph.input[1], "name", "z")), "one input"),
        "two outputs": (model(lambda m: m.graph.output.add().CopyFrom(m.graph.output[0])), "one output"),
        "no output": (model(lambda m: setattr(m.graph.output[0], "name", "c0")), "c0"),
        "twice": (model(lambda m: m.graph.node.add().CopyFrom(m.graph.node[1])), "again"),
        "external": (weights(lambda t: setattr(t, "data_location", 1)), "location"),
        "negative dims": (weights(lambda t: t.dims.__setitem__(0, -4)), "-4"),
        "huge dims": (weights(lambda t: t.dims.__setitem__(0, 2**40)), "2^28"),
        "huge product": (weights(lambda t: (t.dims.__setitem__(0, 2**28), t.dims.__setitem__(1, 2**28))), "2^28"),
        "other dims": (weights(lambda t: t.dims.__setitem__(0, 5)), "25 numbers"),
        "raw": (weights(lambda t: setattr(t, "raw_data", b"123")), "20 numbers"),
        "opset": (lambda g: setattr(g, "opset", 6), "version 6"),
    }


WRONG_ONNX = wrong_onnx()


@pytest.mark.parametrize("case", WRONG_ONNX)
def test_wrong_onnx(case):
    change, keyword = WRONG_ONNX[case]
    graph = Graph(has_onnx())
    layered(graph, Network(5, 4, "relu"))
    change(graph)
    graph.write()
    refused_network("net.onnx", keyword)


def test_cut_onnx(pinnquad):
    """At every place one line; by the program too."""
    graph = Graph(has_onnx())
    layered(graph, Network(5, 4))
    graph.write()
    whole = Path("net.onnx").read_bytes()
    for length in range(0, len(whole), 7):
        Path("net.onnx").write_bytes(whole[:length])
        refused_network("net.onnx", "")
    pinnquad.refused("convert net.onnx --features features.toml --out model", at="net.onnx", keyword="expected")


def test_without_python(pinnquad, monkeypatch):
    """It says what to install, and how another Python is named."""
    Path("net.onnx").write_bytes(b"none")
    features_toml()
    Path("without").mkdir()
    Path("without/numpy.py").write_text("raise ImportError\n")
    for variable, value, keyword in (("PYTHONPATH", "without", "pip install numpy"),
                                     ("PINNQUAD_PYTHON", "/nowhere/python3", "PINNQUAD_PYTHON")):
        monkeypatch.setenv(variable, value)
        pinnquad.refused("convert net.onnx --features features.toml --out model", keyword=keyword)
    assert not Path("model").exists()


def test_wide_policy(pinnquad):
    """The size that legged_gym and Isaac Lab train by default: float loses more than 1e-6 in 512 terms."""
    network = Network(len(FEATURES), 512, "elu", 256, "elu", 128, "elu", 4)
    safetensors("net.safetensors", network.tensors)
    features_toml('activations = "elu"')
    pinnquad("convert net.safetensors --features features.toml --out model")


def test_second_python(pinnquad, monkeypatch):
    """A python3 of PATH that lacks NumPy, or fails, is passed over for the next."""
    safetensors("net.safetensors", Network(5, 4).tensors)
    features_toml()
    Path("without").mkdir()
    Path("without/numpy.py").write_text("raise ImportError\n")
    for folder, text in (("lacks", f'PYTHONPATH={Path.cwd()}/without exec {sys.executable} "$@"'), ("fails", "exit 1"),
                         ("works", f'exec {sys.executable} "$@"')):
        Path(folder).mkdir()
        Path(folder, "python3").write_text(f"#!/bin/sh\n{text}\n")
        Path(folder, "python3").chmod(0o755)
    monkeypatch.delenv("PINNQUAD_PYTHON")
    for folders, keyword in ((["lacks", "fails"], "pip install numpy"), (["fails"], "expected a python3")):
        monkeypatch.setenv("PATH", ":".join(str(Path.cwd() / one) for one in folders))
        pinnquad.refused("convert net.safetensors --features features.toml --out model", keyword=keyword)
    monkeypatch.setenv("PATH", ":".join(str(Path.cwd() / one) for one in ("lacks", "fails", "works")))
    pinnquad("convert net.safetensors --features features.toml --out model")


# as PyTorch's exporter writes: weights beside the model, bounds, halves

def external(graph, change=lambda entries: None, name="net.onnx.data"):
    """Moves each initializer's numbers into a file beside, as torch.onnx.export does since PyTorch 2.9."""
    def move(model):
        data = b""
        for tensor in model.graph.initializer:
            raw = graph.onnx.numpy_helper.to_array(tensor).tobytes()
            copied = graph.onnx.TensorProto(name=tensor.name, data_type=tensor.data_type, dims=tensor.dims, data_location=1)
            entries = {"location": name, "offset": str(len(data)), "length": str(len(raw))}
            change(entries)
            for key, value in entries.items():
                copied.external_data.add(key=key, value=value)
            tensor.CopyFrom(copied)
            data += raw
        Path(name).write_bytes(data)
    graph.change = move


def test_external_data(pinnquad):
    """Numbers in the file beside; a folder of its own; what the author's machine is called reaches no model."""
    onnx = has_onnx()
    network = Network(5, 12, "elu", 4)
    graph = Graph(onnx)
    layered(graph, network)
    external(graph)
    graph.nodes[0].doc_string = "File /home/author/secret.py, line 3"
    Path("there").mkdir()
    graph.write()
    for file in "net.onnx", "net.onnx.data":
        Path(file).rename(f"there/{file}")
    features_toml(per_feature=mean_and_scale)
    header = converted(pinnquad, "there/net.onnx")
    assert worst(header, lambda row: network(standardised(row))) <= TOLERANCE
    assert "author" not in header.text and b"author" not in Path("model/model.block").read_bytes()
    Path("there/net.onnx.data").unlink()
    done = pinnquad.refused("convert there/net.onnx --features features.toml --out other", at="there/net.onnx",
                            keyword="net.onnx.data")
    assert "external_data=False" in done.err


WRONG_EXTERNAL = {
    "absolute": ({"location": "/etc/passwd"}, "/etc/passwd"), "up": ({"location": "../net.onnx.data"}, "folder"),
    "within": ({"location": "a/../net.onnx.data"}, "folder"), "nowhere": ({"location": ""}, "folder"),
    "link": ({"location": "link"}, "link"), "offset": ({"offset": "97"}, "offset 97"),
    "huge offset": ({"offset": str(2**64 - 1)}, "96 bytes"), "length": ({"length": "97"}, "length 97"),
    "huge length": ({"length": str(2**64 - 1)}, "96 bytes"), "shape": ({"length": "76"}, "76 bytes"),
    "no number": ({"offset": "-4"}, "-4"), "overflow": ({"offset": "9" * 30}, "999"),
}


@pytest.mark.parametrize("case", WRONG_EXTERNAL)
def test_wrong_external(case, tmp_path_factory):
    entries, keyword = WRONG_EXTERNAL[case]
    graph = Graph(has_onnx())
    layered(graph, Network(5, 4))
    external(graph, lambda own: own.update(entries) if own["offset"] == "0" else None)
    graph.write()
    outside = tmp_path_factory.mktemp("outside") / "data"
    outside.write_bytes(b"\0" * 96)
    Path("link").symlink_to(outside)
    refused_network("net.onnx", keyword)


@pytest.mark.parametrize("opset, op, given, answer", [
    (7, "Clip", {"min": 0.0, "max": 0.5}, lambda v: min(max(v, 0), 0.5)), (7, "Clip", {"max": 0.25}, lambda v: min(v, 0.25)),
    (13, "Clip", {"min": -1.0, "max": 1.0}, lambda v: min(max(v, -1), 1)), (13, "Clip", {"min": 0.0}, lambda v: max(v, 0)),
    (13, "Clip", {"max": 0.25}, lambda v: min(v, 0.25)), (13, "Clip", {}, lambda v: v),
    (13, "Elu", {"alpha": 0.5}, lambda v: v if v > 0 else 0.5 * math.expm1(v)),
    (13, "LeakyRelu", {"alpha": 0.25}, lambda v: v if v > 0 else 0.25 * v)])
def test_bounds_and_alphas(pinnquad, op, given, answer, opset):
    """Between layers and behind the last one: bounds as attributes and as inputs, alphas that no layer has."""
    network = Network(5, 12, 4)
    graph = Graph(has_onnx())
    graph.opset = opset
    for layer, inputs in (network.layers[0], 5), (network.layers[1], 12):
        linear(graph, layer, inputs, "gemm")
        if op == "Clip" and opset > 10:
            graph.node(op, graph.x, *[graph.constant([given[key]], []) if key in given else "" for key in ("min", "max")])
        else:
            graph.node(op, graph.x, **given)
    graph.write()
    features_toml(per_feature=mean_and_scale)
    header = converted(pinnquad, "net.onnx")
    bounded = lambda layer, x: list(map(answer, dense(layer, x)))
    assert worst(header, lambda row: bounded(network.layers[1], bounded(network.layers[0], standardised(row)))) <= TOLERANCE


@pytest.mark.parametrize("kind, raw", [("FLOAT16", False), ("BFLOAT16", True)])
def test_halves(pinnquad, kind, raw):
    """Weights of half precision are what they are in float; both files, both ways to store them in ONNX."""
    onnx = has_onnx()
    bits_of = {"FLOAT16": lambda v: struct.unpack("<H", struct.pack("<e", v))[0],
               "BFLOAT16": lambda v: struct.unpack("<I", struct.pack("<f", v))[0] >> 16}[kind]
    number_of = {"FLOAT16": lambda b: struct.unpack("<e", struct.pack("<H", b))[0],
                 "BFLOAT16": lambda b: struct.unpack("<f", struct.pack("<I", b << 16))[0]}[kind]
    network = Network(5, 4)
    (outputs, weights, biases), = network.layers
    biases = [-6e-6, 2.0**-14, *biases[2:]]  # a subnormal half among them
    stored = {"0.weight": ((4, 5), [bits_of(v) for v in weights]), "0.bias": ((4,), [bits_of(v) for v in biases])}
    network.layers = [(outputs, *([number_of(b) for b in bits] for _, bits in stored.values()))]
    features_toml(per_feature=mean_and_scale)
    data = [struct.pack(f"<{len(bits)}H", *bits) for _, bits in stored.values()]
    safetensors("net.safetensors", {}, change=lambda header: header.update({
        name: {"dtype": {"FLOAT16": "F16"}.get(kind, "BF16"), "shape": shape, "data_offsets": [40 * at, 40 + 8 * at]}
        for at, (name, (shape, _)) in enumerate(stored.items())}))
    Path("net.safetensors").write_bytes(Path("net.safetensors").read_bytes() + b"".join(data))
    graph = Graph(onnx)
    features_toml(per_feature=mean_and_scale)
    graph.node("Gemm", "x", "0.weight", "0.bias", transB=1)
    for (name, (shape, bits)), packed in zip(stored.items(), data):
        tensor = onnx.TensorProto(name=name, dims=shape, data_type=getattr(onnx.TensorProto, kind))
        if raw:
            tensor.raw_data = packed
        else:
            tensor.int32_data.extend(bits)
        graph.constants.append(tensor)
    graph.write()
    for file in "net.safetensors", "net.onnx":
        assert worst(converted(pinnquad, file), lambda row: network(standardised(row))) <= TOLERANCE


PAPER = [(name, -5, 5) for name in ("vdot_bx vdot_by vdot_bz wdot_x wdot_y wdot_z v_bx v_by v_bz w_x w_y w_z roll pitch "
                                    "sin_yaw cos_yaw").split()]
REFERENCE_NETWORKS = (
    "bfloat16.default bn.default bn.legacy clamp.default elu.default float16.default float64.default gelu.default "
    "hardtanh.default leaky.default paper_bn.default relu.axes relu.default relu.dynamic relu.legacy relu.noext "
    "scaled.default scaled_bn.default silu.default softplus.default tanh.default gelu_tanh.default layernorm.default "
    "residual.default").split()


@pytest.mark.parametrize("name", REFERENCE_NETWORKS)
def test_reference(pinnquad, name, request):
    """What PyTorch 2.11 exported answers as PyTorch did, within 1e-6 of the outputs' scale."""
    folder = request.config.getoption("--reference") / "exported_networks"
    if not folder.exists():
        pytest.skip("no reference networks")
    onnx, numpy = has_onnx(), pytest.importorskip("numpy")
    unit = lambda name: {"vdot": "m/s^2", "wdot": "rad/s^2", "v": "m/s", "w": "rad/s"}.get(name.split("_")[0])
    units = {name: unit(name) or ("rad" if name in ("roll", "pitch") else "1") for name, *_ in PAPER}
    features_toml(features=PAPER, units=units)
    source = folder / f"{name}.onnx"
    pinnquad("convert", source, "--features", "features.toml", "--out", "model")
    assert b"/root/" not in Path("model/model.block").read_bytes() and "torch" not in Path("model/model.hpp").read_text()
    rows_of = folder / f"{name.split('.')[0]}.golden.csv"
    if not rows_of.exists():
        return  # halves: PyTorch answers in their arithmetic
    pinnquad("convert model/model.block --out back.onnx")
    rows = numpy.loadtxt(rows_of, delimiter=",")
    answers = run(onnx, numpy, onnx.load("back.onnx"), rows[:, :16].astype("f4"))
    assert numpy.abs(answers - rows[:, 16:]).max() <= TOLERANCE * max(1, numpy.abs(rows[:, 16:]).max())


# back

SHIPPED = [*sorted((SOURCE / "examples/models").glob("*.block")), SOURCE / "tests/models/near_ground_quadrotor.block",
           SOURCE / "tests/models/own_racer.block"]


@pytest.mark.parametrize("block", SHIPPED, ids=lambda path: path.stem)
def test_back_to_onnx(pinnquad, block):
    """A valid ONNX model that numpy finds to answer as the golden vectors do. A residual between bounds that is not shown
    the angular acceleration is gathered, clipped, added."""
    onnx, numpy = has_onnx(), pytest.importorskip("numpy")
    pinnquad("convert", block, "--out", "net.onnx")
    model = onnx.load("net.onnx")
    onnx.checker.check_model(model, full_check=True)
    header = Header(block.with_suffix(".hpp"))
    assert {"features", "airframe", "contents_hash"} <= {fact.key for fact in model.metadata_props}
    assert "near" not in block.stem or {"Gather", "Max", "Min"} <= {node.op_type for node in model.graph.node}
    answers_as(onnx, numpy, model, header)


def answers_as(onnx, numpy, model, header):
    exact = "using Scalar = double" in header.text
    listed = lambda name: [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?[,}\s])", header.listed(name))]
    x = numpy.array(listed("golden_features"), "f8" if exact else "f4").reshape(-1, len(header.names()))
    u = numpy.array(listed("golden_commands")).reshape(-1, 4)
    assert numpy.abs(run(onnx, numpy, model, x) - u).max() <= TOLERANCE


def run(onnx, numpy, model, x):
    """The nodes of a model one by one."""
    values = {tensor.name: onnx.numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    values[model.graph.input[0].name] = x
    sigmoid = lambda v: 1 / (1 + numpy.exp(-v))
    operators = {"Sub": lambda a, b: a - b, "Div": lambda a, b: a / b, "Mul": lambda a, b: a * b,
                 "Add": lambda a, b: a + b, "Gemm": lambda a, b, c: a @ b.T + c, "Relu": lambda a: numpy.maximum(a, 0),
                 "Tanh": numpy.tanh, "Sigmoid": sigmoid, "Softplus": lambda a: numpy.log1p(numpy.exp(a)),
                 "Sin": numpy.sin, "Softsign": lambda a: a / (1 + abs(a)),
                 "HardSigmoid": lambda a: numpy.clip(a / a.dtype.type(6) + a.dtype.type(0.5), 0, 1), "Erf": numpy.vectorize(math.erf), "Min": numpy.minimum, "Max": numpy.maximum,
                 "Gather": lambda a, places: a[:, places], "Clip": numpy.clip, "Sqrt": numpy.sqrt,
                 "ReduceMean": lambda a: a.mean(1, keepdims=True), "Concat": lambda *a: numpy.hstack(a),
                 "Elu": lambda a: numpy.where(a > 0, a, numpy.expm1(numpy.minimum(a, 0))),
                 "LeakyRelu": lambda a: numpy.where(a > 0, a, a * a.dtype.type(0.01))}
    for node in model.graph.node:
        values[node.output[0]] = operators[node.op_type](*(values[name] for name in node.input))
    return values[model.graph.output[0].name]


@pytest.mark.parametrize("ending, names", [("safetensors", TRIPLES[0]), *(("onnx", names) for names in TRIPLES)])
def test_there_and_back(pinnquad, ending, names):
    """A network that comes back answers as before it went."""
    if ending == "onnx":
        has_onnx()
    network = Network(5, 8, names[0], 8, names[1], 8, names[2], 4)
    safetensors("net.safetensors", network.tensors)
    features_toml(f"activations = {json.dumps(names)}", per_feature=mean_and_scale)
    first = converted(pinnquad, "net.safetensors")
    pinnquad("convert model/model.block --out", f"back.{ending}")
    order = [next(feature for feature in FEATURES if feature[0] == n) for n in first.names()]
    words = ["tanh" if name == "sigmoid" else name for name in names]  # as the model has it
    features_toml(f"activations = {json.dumps(words)}", features=order)
    second = converted(pinnquad, f"back.{ending}")
    for (row, commands), (again, others) in zip(golden(first), golden(second)):
        assert row == pytest.approx(again, rel=1e-6) and commands == pytest.approx(others, abs=TOLERANCE)
    if ending == "safetensors":
        raw = Path("back.safetensors").read_bytes()
        metadata = json.loads(raw[8 : 8 + struct.unpack("<Q", raw[:8])[0]])["__metadata__"]
        assert metadata["activations"] == ", ".join(words) and metadata["features"].startswith("wdot_x [rad/s^2]")


def test_not_back(pinnquad, flown):
    """What safetensors can't hold; what is no model."""
    pinnquad.refused("convert", SHIPPED[-1], "--out", "net.safetensors", at=str(SHIPPED[-1]), keyword="columns")
    Path("cut.block").write_bytes(SHIPPED[0].read_bytes()[:1000])
    pinnquad.refused("convert cut.block --out net.onnx", at="cut.block", keyword="cut short")
    assert listing(".") == ["cut.block"]


@pytest.mark.parametrize("inputs, count", [("paper", 16), ("inverse", 19), ("physics", 21)])
def test_features_to_begin_with(pinnquad, made, inputs, count):
    """Of a flight: each feature's name, unit and range, which a network then has; what its comments say is of the rows."""
    flight = made("fly d3 --seed 1 --samples 300 --out flight.csv") / "flight.csv"
    pinnquad("convert", flight, "--inputs", inputs, "--out", "features.toml")
    begun = tomllib.loads(Path("features.toml").read_text())
    assert len(begun["feature"]) == count and begun["airframe"] == {"name": "paper_quadrotor"}
    with open(flight) as file:
        rows = list(csv.DictReader(file))
    for feature in begun["feature"]:
        if feature["name"] not in rows[0]:
            continue  # worked out of several columns
        values = [float(row[feature["name"]]) for row in rows]
        reach = max(values) - min(values)
        assert min(values) - reach < feature["lower"] < min(values) <= max(values) < feature["upper"] < max(values) + reach
        said = re.search(rf'"{feature["name"]}".*# mean = (\S+), scale = (\S+)$', Path("features.toml").read_text(), re.M)
        assert float(said[1]) == pytest.approx(statistics.fmean(values), rel=1e-4, abs=1e-6)
        assert float(said[2]) == pytest.approx(statistics.pstdev(values), rel=1e-4)
    safetensors("net.safetensors", Network(count, 8, "tanh", 4).tensors)
    Path("features.toml").write_text('activations = "tanh"\n' + Path("features.toml").read_text())
    pinnquad("convert net.safetensors --features features.toml --out my_model")


def test_no_features_to_begin_with(pinnquad, made):
    flight = made("fly d3 --seed 1 --samples 300 --out flight.csv") / "flight.csv"
    pinnquad.refused("convert", flight, "--out", "features.txt", keyword=".toml was expected")
    pinnquad.refused("convert", flight, "--out", "features.toml", "--inputs", "all", keyword="paper, physics or inverse")
    Path("no_flight.csv").write_text("a,b\n1,2\n")
    pinnquad.refused("convert no_flight.csv --out features.toml", at="no_flight.csv")
    assert listing(".") == ["no_flight.csv"]


# PyTorch

def torch_network(torch, names, norm, number):
    nn = torch.nn

    class Sine(nn.Module):
        def forward(self, x):
            return torch.sin(x)

    kinds = {"relu": nn.ReLU, "tanh": nn.Tanh, "sigmoid": nn.Sigmoid, "gelu": nn.GELU, "silu": nn.SiLU,
            "softplus": nn.Softplus, "sine": Sine, "mish": nn.Mish, "softsign": nn.Softsign,
            "hard_swish": nn.Hardswish, "gelu_tanh": lambda: nn.GELU(approximate="tanh"), "elu": nn.ELU, "leaky_relu": nn.LeakyReLU}
    one, two, three = (kinds[name]() for name in names)
    torch.manual_seed(3)
    network = nn.Sequential(nn.Linear(5, 24), *[nn.BatchNorm1d(24)] * norm, one, nn.Linear(24, 24, bias=False), two,
                            nn.Linear(24, 24), three, nn.Linear(24, 4)).to(number)
    if norm:  # statistics as a training leaves them
        for _ in range(20):
            network(3 * torch.randn(64, 5, dtype=number))
    return network.eval()


@pytest.mark.parametrize("names, norm, number", [
    (names, norm, number) for names, norm, number in zip(TRIPLES, [False, True] * 3, ["float32", "float64"] * 3)])
def test_torch(pinnquad, names, norm, number):
    """torch.nn.Sequential by its state_dict and by torch.onnx.export, against what PyTorch makes of the golden vectors."""
    torch = pytest.importorskip("torch")
    has_onnx()
    number = getattr(torch, number)
    network = torch_network(torch, names, norm, number)
    tensors = {key: (tuple(tensor.shape), tensor.flatten().tolist()) for key, tensor in network.state_dict().items()
               if "num_batches" not in key}
    safetensors("net.safetensors", tensors, "f" if number == torch.float32 else "d")
    torch.onnx.export(network, torch.zeros(1, 5, dtype=number), "net.onnx", opset_version=13, input_names=["x"],
                      dynamic_axes={"x": {0: "rows"}})
    features_toml(f"activations = {json.dumps(names)}", per_feature=mean_and_scale)
    for source in "net.safetensors", "net.onnx":
        header = converted(pinnquad, source)
        rows = [standardised(row) for row, _ in golden(header)]
        answers = iter(network(torch.tensor(rows, dtype=number)).tolist())
        assert worst(header, lambda row: next(answers)) <= TOLERANCE

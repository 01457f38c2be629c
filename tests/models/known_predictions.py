#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes known_predictions.hpp: what each header of tests/models/ that is one network must answer.

    python3 tests/models/known_predictions.py > tests/models/known_predictions.hpp

Reads the headers as text and computes in double, without the library: drawn feature vectors inside the envelope.
"""
import math
import pathlib
import random
import re

FOLDER = pathlib.Path(__file__).parent
COUNT = 6


def numbers(text, name):
    body = re.search(r" %s = \{(.*?)\};" % name, text, re.S).group(1)
    return [float(v.rstrip("f")) for v in re.findall(r"-?[0-9][0-9.]*(?:e[-+]?[0-9]+)?f?", body)]


def layers(text):
    """[(outputs, activation)] and the number of inputs."""
    network = re.search(r"using Network = pinnquad::Network<(.*)>;", text).group(1)
    parts = [part.strip().replace("pinnquad::", "") for part in network.split(",")][1:]
    inputs = int(re.match(r"InputSize<(\d+)>", parts[0]).group(1))
    result = []
    for part in parts[1:]:
        dense = re.match(r"Dense<(\d+)>", part)
        if dense:
            result.append([int(dense.group(1)), None])
        else:
            result[-1][1] = {"Relu": lambda v: max(v, 0.0), "Tanh": math.tanh}[part]
    return inputs, result


def predictor(text):
    inputs, shape = layers(text)
    scale_in, scale_out, weights = numbers(text, "input"), numbers(text, "output"), numbers(text, "parameters")

    def predict(x):
        v = [(x[i] - scale_in[i]) / scale_in[inputs + i] for i in range(inputs)]
        at = 0
        for outputs, activation in shape:
            width = len(v)
            rows = [weights[at + r * width : at + (r + 1) * width] for r in range(outputs)]
            biases = weights[at + outputs * width : at + outputs * (width + 1)]
            v = [math.fsum([w * a for w, a in zip(row, v)] + [bias]) for row, bias in zip(rows, biases)]
            if activation:
                v = [activation(a) for a in v]
            at += outputs * (width + 1)
        assert at == len(weights)
        return [v[i] * scale_out[4 + i] + scale_out[i] for i in range(4)]

    return predict


def array(vectors, size):
    rows = ",\n".join("    {" + ", ".join(repr(v) for v in vector) + "}" for vector in vectors)
    return "std::array<std::array<double, %d>, %d>" % (size, len(vectors)), rows


def main():
    print("// SPDX-License-Identifier: MIT")
    print("// What the headers beside it must answer. Written by known_predictions.py, which computes it without the library.")
    print("#pragma once\n\n#include <array>\n\nnamespace pinnquad::test {\n")
    draw = random.Random(42)
    for path in sorted(FOLDER.glob("*.hpp")):
        text = path.read_text()
        if "using Network = pinnquad::Network<" not in text:
            continue  # a sum of predictors: its own golden vectors are enough
        name = re.findall(r"struct (\w+) \{", text)[-1]  # an airframe of its own stands before the model
        lower, upper = numbers(text, "envelope_lower"), numbers(text, "envelope_upper")
        predict = predictor(text)
        features = []
        for _ in range(COUNT):
            # a third of the way around the middle: where flights are
            vector = [(l + u) / 2 + draw.uniform(-1 / 3, 1 / 3) * (u - l) / 2 for l, u in zip(lower, upper)]
            features.append([round(v * 4096) / 4096 for v in vector])  # floats
        commands = [predict(x) for x in features]
        print("/// %s" % path.relative_to(FOLDER))
        print("struct Known%s {" % name)
        for label, vectors in (("features", features), ("commands", commands)):
            kind, rows = array(vectors, len(vectors[0]))
            print("  static constexpr %s %s = {{\n%s}};" % (kind, label, rows.replace("{", "{{").replace("}", "}}")))
        print("};\n")
    print("}  // namespace pinnquad::test")


if __name__ == "__main__":
    main()

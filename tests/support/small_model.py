#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes small_model.hpp: a 16 -> 8 -> 4 ReLU network in the form of an exported header.

    python3 tests/support/small_model.py > tests/support/small_model.hpp

Nothing of the library is used. Every constant is a float; the golden commands are computed from those floats in double.
"""
import random
import struct


def f32(v):
    return struct.unpack("f", struct.pack("f", v))[0]


def floats(values, indent):
    """Float literals, a few per line; 9 significant digits give each float back."""
    lines, line = [], indent
    for v in values:
        text = "%.9g" % v
        text += ("" if any(c in text for c in ".e") else ".0") + "F, "
        if len(line) + len(text) > 118:
            lines.append(line.rstrip())
            line = indent
        line += text
    lines.append(line.rstrip().rstrip(","))
    return "\n".join(lines)


INPUTS, HIDDEN, OUTPUTS, GOLDEN = 16, 8, 4, 6
draw = random.Random(2024)


def uniform(low, high):
    return f32(draw.uniform(low, high))


def dense(inputs, outputs):
    limit = (6.0 / (inputs + outputs)) ** 0.5
    weight = [[uniform(-limit, limit) for _ in range(inputs)] for _ in range(outputs)]
    return weight, [uniform(-0.2, 0.2) for _ in range(outputs)]


layers = [dense(INPUTS, HIDDEN), dense(HIDDEN, OUTPUTS)]
parameters = [v for weight, bias in layers for row in weight + [bias] for v in row]

# metres, radians, seconds: what a multirotor does in agile flight
ranges = [12.0] * 3 + [40.0, 40.0, 6.0] + [8.0] * 3 + [4.0] * 3 + [0.9, 0.9] + [1.0, 1.0]
lower = [f32(-1.1 * r) for r in ranges]
upper = [f32(1.1 * r) for r in ranges]
mean_in = [uniform(-0.1 * r, 0.1 * r) for r in ranges]
spread_in = [uniform(0.3 * r, 0.5 * r) for r in ranges]
mean_out = [uniform(0.45, 0.55) for _ in range(OUTPUTS)]
spread_out = [uniform(0.08, 0.12) for _ in range(OUTPUTS)]


def predict(x):
    v = [(x[i] - mean_in[i]) / spread_in[i] for i in range(INPUTS)]
    for index, (weight, bias) in enumerate(layers):
        v = [sum(w * a for w, a in zip(row, v)) + b for row, b in zip(weight, bias)]
        if index + 1 < len(layers):
            v = [max(a, 0.0) for a in v]
    return [v[i] * spread_out[i] + mean_out[i] for i in range(OUTPUTS)]


features, commands = [], []
for _ in range(GOLDEN):
    x = [uniform(-0.9 * r, 0.9 * r) for r in ranges]
    features.append(x)
    commands.append(predict(x))


def rows(vectors):
    return ",\n".join("      {\n%s}" % floats(v, "          ") for v in vectors)


print(f"""// SPDX-License-Identifier: MIT
// A small model in the form of an exported header, for tests: 16 -> 8 -> 4, ReLU, weights drawn at random.
// Written by small_model.py, which computes the golden commands in double without the library.
#pragma once

#include <array>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/exported/model.hpp"
#include "pinnquad/nn/relu.hpp"
#include "as_header.hpp"

namespace pinnquad::test {{

struct SmallNumbers {{
  using Scalar = float;
  using Network =
      Mlp<float, pinnquad::InputSize<{INPUTS}>, pinnquad::Hidden<1, {HIDDEN}>, pinnquad::OutputSize<{OUTPUTS}>, pinnquad::Relu>;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;

  static constexpr const char* name = "small_model";
  static constexpr const char* provenance = "tests/support/small_model.py";

  static constexpr std::array<float, {len(parameters)}> parameters = {{
{floats(parameters, "      ")}}};

  static constexpr Scaler<float, {INPUTS}> input{{
      {{
{floats(mean_in, "          ")}}},
      {{
{floats(spread_in, "          ")}}}}};
  static constexpr Scaler<float, {OUTPUTS}> output{{
      {{
{floats(mean_out, "          ")}}},
      {{
{floats(spread_out, "          ")}}}}};

  static constexpr std::array<float, {INPUTS}> envelope_lower = {{
{floats(lower, "      ")}}};
  static constexpr std::array<float, {INPUTS}> envelope_upper = {{
{floats(upper, "      ")}}};

  static constexpr std::array<std::array<float, {INPUTS}>, {GOLDEN}> golden_features = {{{{
{rows(features)}}}}};
  static constexpr std::array<std::array<float, {OUTPUTS}>, {GOLDEN}> golden_commands = {{{{
{rows(commands)}}}}};
}};

using SmallModel = AsHeader<SmallNumbers>;

}}  // namespace pinnquad::test""")

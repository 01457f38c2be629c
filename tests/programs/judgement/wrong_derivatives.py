# SPDX-License-Identifier: MIT
"""Counts wrong derivatives of an exported header on a flight's last 20 % of rows, with nothing of the library: numbers from the
header's text, features from the flight's columns, the network as a loop, differences in double. Compares with evaluate's JSON."""
import csv
import json
import math
import re
import sys

header, flight, judged = sys.argv[1:4]
text = open(header).read()


def numbers(name):
    found = re.search(r"\b%s = (\{.*?\});" % name, text, re.S)
    return [float(n) for n in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?[,}\s])", found.group(1))]


widths = [int(w) for w in re.findall(r"(?:Inputs|Dense)<(\d+)>", re.search(r'answer = "(.*)"', text).group(1))]
assert "Relu" in text and widths[0] == 16 and widths[-1] == 4, widths
parameters, scale_in, scale_out = numbers("parameters"), numbers("input"), numbers("output")
assert len(parameters) == sum((a + 1) * b for a, b in zip(widths, widths[1:])), len(parameters)
assert len(scale_in) == 32 and len(scale_out) == 8
signs = numbers("motor_torque_signs")  # rotor by rotor: roll, pitch, yaw
layers, at = [], 0
for inputs, outputs in zip(widths, widths[1:]):
    weights = [parameters[at + row * inputs : at + (row + 1) * inputs] for row in range(outputs)]
    layers.append((weights, parameters[at + inputs * outputs : at + (inputs + 1) * outputs]))
    at += (inputs + 1) * outputs


def commands(x):
    v = [(a - mean) / spread for a, mean, spread in zip(x, scale_in[:16], scale_in[16:])]
    for index, (weights, biases) in enumerate(layers):
        v = [sum(w * a for w, a in zip(row, v)) + bias for row, bias in zip(weights, biases)]
        if index + 1 < len(layers):
            v = [max(0.0, a) for a in v]
    return [a * spread + mean for a, mean, spread in zip(v, scale_out[:4], scale_out[4:])]


def features(row):
    motion = [float(row[i]) for i in range(1, 13)]  # v_dot, omega_dot, v, omega behind t
    roll, pitch, yaw = (float(row[i]) for i in range(13, 16))
    return motion + [roll, pitch, math.sin(yaw), math.cos(yaw)]


rows = list(csv.reader(open(flight)))[1:]
rows = rows[len(rows) * 4 // 5 :]
wrong = [0, 0, 0]
for row in rows:
    x = features(row)
    for axis in range(3):
        above, below = list(x), list(x)
        above[3 + axis] += 1e-6
        below[3 + axis] -= 1e-6
        rise = [a - b for a, b in zip(commands(above), commands(below))]
        wrong[axis] += sum(signs[3 * rotor + axis] * rise[rotor] for rotor in range(4)) < 0
shares = dict(zip(("roll", "pitch", "yaw"), (count / len(rows) for count in wrong)))
found = json.load(open(judged))
assert found["rows"] == len(rows), (found["rows"], len(rows))
print("wrong derivatives:", shares)
for axis, share in shares.items():
    # a row may differ: differences of rounded sums where the derivative is nearly 0, and a kink in between
    assert abs(found["wrong_derivative_share"][axis] - share) <= 2 / len(rows), (axis, found["wrong_derivative_share"], share)

# SPDX-License-Identifier: MIT
"""Counts wrong derivatives of an exported header on a flight's last 20 % of rows, with nothing of the library: numbers from the
header's text, features from the flight's columns, the network as a loop, differences in double; and violations among large
steps. Compares with evaluate's JSON. The vehicle is the paper's."""
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
wrong, least = [0, 0, 0], [math.inf] * 3
made = []
for row in rows:
    x = features(row)
    made.append(commands(x))
    for axis in range(3):
        above, below = list(x), list(x)
        above[3 + axis] += 1e-6
        below[3 + axis] -= 1e-6
        rise = [a - b for a, b in zip(commands(above), commands(below))]
        risen = sum(signs[3 * rotor + axis] * rise[rotor] for rotor in range(4))
        wrong[axis] += risen < 0
        least[axis] = min(least[axis], risen / 2e-6)
shares = dict(zip(("roll", "pitch", "yaw"), (count / len(rows) for count in wrong)))
found = json.load(open(judged))
assert found["rows"] == len(rows), (found["rows"], len(rows))
print("wrong derivatives:", shares)
for axis, share in shares.items():
    # a row may differ: differences of rounded sums where the derivative is nearly 0, and a kink in between
    assert abs(found["wrong_derivative_share"][axis] - share) <= 2 / len(rows), (axis, found["wrong_derivative_share"], share)

# over the airframe's own in hover: inertia over what full thrust and full torque of the rotors turn it with
arm_m, thrust_N = 0.243952, 0.1099 * 1.225 * (8500 / 60) ** 2 * 0.2286**4
torque_N_m = 0.04016 * 1.225 * (8500 / 60) ** 2 * 0.2286**5 / (2 * math.pi)
nominal = 0.01469 / (arm_m * thrust_N), 0.01686 / (arm_m * thrust_N), 0.03093 / torque_N_m
for axis, (own, slope) in enumerate(zip(nominal, least)):
    said = found["least_derivative_over_nominal"][("roll", "pitch", "yaw")[axis]]
    assert abs(said - slope / own) <= 1e-3 * max(1, abs(said)), (axis, said, slope / own)

for axis, name in enumerate(("roll", "pitch", "yaw")):
    asked = [float(row[4 + axis]) for row in rows]
    mean = sum(asked) / len(asked)
    large = 0.5 * math.sqrt(sum((a - mean) ** 2 for a in asked) / (len(asked) - 1))
    flown = [[float(u) for u in row[-4:]] for row in rows]
    for figure, of in ("large_step_violations", made), ("large_step_violations_flown", flown):
        sums = [sum(signs[3 * rotor + axis] * u[rotor] for rotor in range(4)) for u in of]
        pairs = [(b - a, d - c) for a, b, c, d in zip(asked, asked[1:], sums, sums[1:]) if abs(b - a) > large]
        share = sum(a * s < 0 for a, s in pairs) / len(pairs)
        assert abs(found[figure][name] - share) <= 2 / len(pairs), (figure, name, found[figure][name], share)

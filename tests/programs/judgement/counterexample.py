# SPDX-License-Identifier: MIT
"""Is certify's counterexample one? Nothing of the library: numbers from the header's text, the network as a loop in double. The two
motions lie inside the envelope and differ in one angular acceleration, and the signed sum falls from the first to the second."""
import json
import math
import re
import struct
import sys

header, found = sys.argv[1:3]
text = open(header).read()


def numbers(name):
    listed = re.search(r"\b%s = (\{.*?\});" % name, text, re.S)
    found = re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?[,}\s])", listed.group(1))
    return [struct.unpack("f", struct.pack("f", float(n)))[0] for n in found]  # the float that is meant


network = re.search(r"using Network = (.*);", text).group(1)
widths = [int(w) for w in re.findall(r"(?:InputSize|Inputs|Dense)<(\d+)>", network)]
activate = math.tanh if "Tanh" in network else lambda v: max(0.0, v)
parameters, scale_in, scale_out = numbers("parameters"), numbers("input"), numbers("output")
size = widths[0]
signs = numbers("motor_torque_signs")  # rotor by rotor: roll, pitch, yaw


def commands(x):
    v = [(a - mean) / spread for a, mean, spread in zip(x, scale_in[:size], scale_in[size:])]
    at = 0
    for index, (inputs, outputs) in enumerate(zip(widths, widths[1:])):
        biases = parameters[at + inputs * outputs : at + (inputs + 1) * outputs]
        rows = [parameters[at + row * inputs : at + (row + 1) * inputs] for row in range(outputs)]
        v = [sum(w * a for w, a in zip(row, v)) + bias for row, bias in zip(rows, biases)]
        if index + 2 < len(widths):
            v = [activate(a) for a in v]
        at += (inputs + 1) * outputs
    return [a * spread + mean for a, mean, spread in zip(v, scale_out[:4], scale_out[4:])]


report = json.load(open(found))
assert report["verdict"] == "counterexample", report["verdict"]
example = report["counterexample"]
axis = ("roll", "pitch", "yaw").index(example["axis"])
names = re.findall(r'"(.*?)"', re.search(r"feature_names = \{(.*?)\};", text, re.S).group(1))
x = [example["features"][name] for name in names]
more = list(x)
assert names.index("wdot_" + "xyz"[axis]) == names.index(example["moved"][0])
for name in example["moved"]:
    more[names.index(name)] += example["step"]
assert example["step"] > 0
for motion in x, more:
    for name, low, value, high in zip(names, numbers("envelope_lower"), motion, numbers("envelope_upper")):
        assert low <= value <= high, (name, low, value, high)
sums = [sum(signs[3 * rotor + axis] * u for rotor, u in enumerate(commands(motion))) for motion in (x, more)]
assert sums[1] < sums[0] - 5e-6, sums
assert abs(sums[0] - example["signed_sum"]) < 1e-5 and abs(sums[1] - example["signed_sum_after_step"]) < 1e-5, (sums, example)
assert report["seconds"] < float(sys.argv[3]), report["seconds"]
print(header, "after", report["evaluations"], "motions:", example["axis"], sums)

# SPDX-License-Identifier: MIT
"""An exported header read as text, with nothing of the library: its numbers, and its network as a loop in double."""
import math
import re
import struct
from pathlib import Path

AXES = "roll", "pitch", "yaw"
NUMBER = r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?[,}\s])"


class Header:
    def __init__(self, path):
        self.text = Path(path).read_text()

    def listed(self, name):
        return re.search(rf"\b{name} = (\{{.*?\}});", self.text, re.S).group(1)

    def numbers(self, name):
        """The floats that are meant."""
        return [struct.unpack("f", struct.pack("f", float(n)))[0] for n in re.findall(NUMBER, self.listed(name))]

    def names(self):
        words = re.search(r"^// Features: (.*?)\.\n// Outputs: ", self.text, re.S | re.M).group(1)
        return [word.rsplit(" [", 1)[0] for word in words.replace("\n//", "").split(", ")]

    def signs(self):
        """Rotor by rotor, of its torques: roll, pitch, yaw."""
        rows = self.numbers("allocation")
        return [math.copysign(1, rows[4 * (1 + axis) + rotor]) for rotor in range(4) for axis in range(3)]

    def commands(self):
        """The function from features to commands."""
        network = re.search(r"using Network = (.*);", self.text).group(1)
        widths = [int(width) for width in re.findall(r"(?:InputSize|Inputs|Dense)<(\d+)>", network)]
        activate = math.tanh if "Tanh" in network else lambda v: max(0.0, v)
        parameters, scale_in, scale_out = (self.numbers(name) for name in ("parameters", "input", "output"))
        assert len(parameters) == sum((a + 1) * b for a, b in zip(widths, widths[1:])) and widths[-1] == 4
        layers, at = [], 0
        for inputs, outputs in zip(widths, widths[1:]):
            weights = [parameters[at + row * inputs : at + (row + 1) * inputs] for row in range(outputs)]
            layers.append((weights, parameters[at + inputs * outputs : at + (inputs + 1) * outputs]))
            at += (inputs + 1) * outputs

        def evaluate(x):
            v = [(a - mean) / spread for a, mean, spread in zip(x, scale_in[: widths[0]], scale_in[widths[0] :])]
            for index, (weights, biases) in enumerate(layers):
                v = [sum(w * a for w, a in zip(row, v)) + bias for row, bias in zip(weights, biases)]
                if index + 1 < len(layers):
                    v = [activate(a) for a in v]
            return [a * spread + mean for a, mean, spread in zip(v, scale_out[:4], scale_out[4:])]

        return evaluate

    def sums(self):
        """The function from four commands to the signed sum of an axis."""
        signs = self.signs()
        return lambda u, axis: sum(signs[3 * rotor + axis] * u[rotor] for rotor in range(4))

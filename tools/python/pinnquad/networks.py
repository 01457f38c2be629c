# SPDX-License-Identifier: MIT
"""Networks from elsewhere as layers of the library, and models as networks for elsewhere.

`answer(request)` is what `pinnquad convert` and `pinnquad.convert()` ask: a request in, layers and the source's own
answers out, as JSON has them. As a script it reads a request from standard input and writes the answer to standard output.

An operator is known by what it does to numbers, not by its name: an affine one by its values at 0 and at each unit
vector, an elementwise one because a change of one element changes that element alone, an activation because it fits one of
the library's, scaled and shifted, on a grid. How an exporter spells GELU or softplus does not matter then.
"""
from __future__ import annotations

import json
import math
import re
import struct
import sys
from pathlib import Path

try:
    import numpy as np
except ImportError:
    np = None

WIDEST = 4096  # numbers between two operators; the library's own limit is lower, and says so
MOST_NUMBERS = 1 << 24
LEAKY = 0.01  # slope of the library's LeakyRelu
CLIP_BOUND = 3.5  # of its Clip, either way
NORM_EPSILON = 1e-5  # of its LayerNorm and RmsNorm
NORMS = ("layer_norm", "rms_norm")
WHOLE_LAYERS = (*NORMS, "glu")  # each reads many numbers; those behind them pass on


class Refused(Exception):
    """One line: `path: expected ..., found ...`."""

    def __init__(self, expected, found, path=None):
        super().__init__(f"expected {expected}, found {found}")
        self.expected, self.found, self.path = expected, found, path


class Missing(Refused):
    """A package that this Python lacks: the program asks the next Python of PATH."""

    def __init__(self, package):
        super().__init__(f"Python's package {package} (pip install {package}; Debian: python3-{package})",
                         f"none in {sys.executable} (PINNQUAD_PYTHON names another Python)")


def one_line(error):
    return " ".join(str(error).split())[:300] or type(error).__name__


# ----------------------------------------------------------------------------------------------------------------------
# Graphs: operators that make one array of others, for a row at a time


class Node:
    """An operator: `apply` makes the value `output` of `inputs`, each the name of a value or a constant."""

    def __init__(self, name, apply, inputs, output):
        self.name, self.apply, self.inputs, self.output = name, apply, inputs, output

    def __call__(self, arrays):
        try:
            with np.errstate(all="ignore"):
                return self.apply(*arrays)
        except Refused:
            raise
        except Exception as error:  # whatever an operator of another library says of shapes and types
            shapes = ", ".join(str(list(one.shape)) for one in arrays if hasattr(one, "shape"))
            raise Refused(f"{self.name}: inputs that it takes", f"shapes {shapes} ({one_line(error)})") from None


class Graph:
    """Operators in their order, from the value `input`, rows of `width` numbers, to `output`. One row is shown in the
    shape `shape`: [1, width], or as the file has it."""

    def __init__(self, width, nodes, input="x", output=None, rows_are_free=True, shape=None):
        if not 1 <= width <= WIDEST:
            raise Refused(f"1 to {WIDEST} features", str(width))
        self.width, self.nodes, self.input = width, nodes, input
        self.output = output if output is not None else (nodes[-1].output if nodes else input)
        self.rows_are_free = rows_are_free  # however many rows; False: one alone
        self.shape = shape or (1, width)

    def __call__(self, rows):
        """The outputs of rows, a row of both at a time, in double."""
        return np.array([self._values(row.reshape(self.shape)).reshape(-1) for row in np.asarray(rows, "f8")])

    def _values(self, x):
        values = {self.input: x}
        for node in self.nodes:
            values[node.output] = node([values[one] if isinstance(one, str) else one for one in node.inputs])
        return np.asarray(values[self.output], "f8")

    def require_rows(self):
        """Rows must not depend on each other, which a row at a time does not show."""
        if not self.rows_are_free:
            return
        rows = np.random.default_rng(3).normal(size=(2, self.width))
        alone = self(rows)
        try:
            together = self._values(rows.reshape((2, *self.shape[1:])))
        except Refused as refused:
            raise Refused("rows that do not depend on each other", f"two at once, in {refused.expected}") from None
        if together.size != alone.size or not np.allclose(together.reshape(alone.shape), alone, 1e-9, 1e-9, True):
            raise Refused("rows that do not depend on each other", "others where two are asked at once")


# ----------------------------------------------------------------------------------------------------------------------
# Lowering


class Affine:
    """sum of weights[stage] @ (numbers of the stage) + shift; stage 0 is the input, each other one an activation's."""

    def __init__(self, weights, shift):
        self.weights, self.shift = weights, shift

    def mapped(self, matrix, shift):
        return Affine({stage: matrix @ weights for stage, weights in self.weights.items()}, matrix @ self.shift + shift)

    def plus(self, other):
        weights = dict(self.weights)
        for stage, own in other.weights.items():
            weights[stage] = weights[stage] + own if stage in weights else own
        return Affine(weights, self.shift + other.shift)


class Value:
    """What an operator made: affine in the stages, or a function `of_root` of a value that is, `root`: elementwise, or
    of several numbers. `marks`: scales and shifts of the root's elements with which operators met them."""

    def __init__(self, shape, affine, root=None, of_root=None, marks=(), node=None, inputs=(), elementwise=True):
        self.shape, self.affine = shape, affine
        self.size = int(np.prod(shape))
        self.root = affine if root is None else root
        self.of_root = of_root or (lambda z: z.reshape(shape))
        self.marks = list(marks) or [(np.ones(self.size), np.zeros(self.size))]
        self.node, self.inputs, self.elementwise = node, inputs, elementwise
        self.made = None  # the same, affine in a stage of its own, or why there is none
        self.nearer = None  # the same, a function of what a later layer makes


def stacked(parts):
    """The numbers of several, one behind the other."""
    wide = {stage: own.shape[1] for part in parts for stage, own in part.weights.items()}
    return Affine({stage: np.vstack([part.weights.get(stage, np.zeros((len(part.shift), width))) for part in parts])
                   for stage, width in wide.items()}, np.concatenate([part.shift for part in parts]))


def same(root, other):
    return root is other or (root.weights.keys() == other.weights.keys() and np.array_equal(root.shift, other.shift) and
                             all(np.array_equal(own, other.weights[stage]) for stage, own in root.weights.items()))


def relu(q):
    return np.maximum(q, 0.0)


def erf(q):
    return np.vectorize(math.erf, otypes=["f8"])(q)


def softplus(q):
    return np.logaddexp(q, 0.0)


def sigmoid(q):
    return np.exp(-np.logaddexp(0.0, -q))


def gelu(q):
    return 0.5 * q * (1 + erf(q / math.sqrt(2)))


def gelu_tanh(q):
    return q * sigmoid(2 * math.sqrt(2 / math.pi) * (q + 0.044715 * q**3))


def hard_swish(q):
    return q * np.clip(q / 6 + 0.5, 0, 1)


def mish(q):
    return q * np.tanh(softplus(q))


def softsign(q):
    return q / (1 + np.abs(q))


ACTIVATIONS = {
    "relu": relu, "tanh": lambda v: np.tanh(v), "sigmoid": sigmoid, "gelu": gelu, "silu": lambda v: v * sigmoid(v),
    "softplus": softplus, "sine": lambda v: np.sin(v), "clip": lambda v: np.clip(v, -CLIP_BOUND, CLIP_BOUND),
    "elu": lambda v: np.where(v > 0, v, np.expm1(np.minimum(v, 0))), "leaky_relu": lambda v: np.where(v > 0, v, LEAKY * v),
    "relu6": lambda v: np.clip(v, 0, 6), "hardtanh": lambda v: np.clip(v, -1, 1), "identity": lambda v: v,
    "gelu_tanh": gelu_tanh, "hard_swish": hard_swish, "mish": mish, "softsign": softsign,
}
# an activation is a sum of these, scaled, and a constant; the simplest first
FAMILIES = {
    "slopes": lambda q: (relu(q), relu(-q)),
    "elu": lambda q: (relu(q), np.expm1(np.minimum(q, 0))),
    "clip": lambda q: (np.clip(q, -1, 1),),
    **{name: lambda q, of=ACTIVATIONS[name]: (of(q),) for name in (
        "tanh", "sigmoid", "gelu", "silu", "softplus", "sine", "gelu_tanh", "hard_swish", "mish", "softsign")},
}
# act(v) - act(-v) = this times v: what goes past such an activation does so in two halves
ODD_PARTS = {"relu": 1, "leaky_relu": 1 + LEAKY, "gelu": 1, "silu": 1, "softplus": 1, "gelu_tanh": 1, "hard_swish": 1}


class Lowering:
    def __init__(self, graph):
        self.graph = graph
        self.stages = [None]  # of each activation its name and what it takes

    def layers(self):
        """Layers of the library: {"weights", "bias"} or the name of an activation."""
        graph = self.graph
        values = {graph.input: Value(graph.shape, Affine({0: np.eye(graph.width)}, np.zeros(graph.width)))}
        for node in graph.nodes:
            values[node.output] = self.taken(node, [values[one] if isinstance(one, str) else one for one in node.inputs])
        last = values[graph.output]
        if not isinstance(last, Value):
            raise Refused("an output that depends on the input", "one that does not")
        return self.scheduled(self.made_affine(last).affine)

    # -- operators

    def taken(self, node, inputs):
        running = [one for one in inputs if isinstance(one, Value)]
        made = self.fixed(node, inputs, running)
        if made is not None:
            return made
        all_affine = all(one.affine for one in running)
        for known in (*[self.affine_value] * all_affine, self.elementwise_value, self.gated):
            made = known(node, inputs, running)
            if made:
                return made
        try:
            if not all_affine:
                return self.taken(node, [one if not isinstance(one, Value) or one.affine else self.made_affine(one)
                                         for one in inputs])
            if len(running) > 1:
                raise Refused(f"{node.name}: sums of layers, and activations of one of them",
                              "a function of several that depend on the input")
            raise Refused(f"{node.name}: affine maps, norms, and activations of each number", "a function of several numbers")
        except Refused:
            made = self.joint_value(node, [self.nearest(one) if isinstance(one, Value) else one for one in inputs])
            if not made:
                raise
            try:
                return self.made_affine(made)
            except Refused:
                return made

    def fixed(self, node, inputs, running):
        """What no input changes: a shape, a number that is no array."""
        tried = [node([one if not isinstance(one, Value) else one.of_root(z[: len(one.root.shift)]) for one in inputs])
                 for z in (np.zeros(WIDEST), self.random(WIDEST), 100 * self.random(WIDEST))] if running else [node(inputs)]
        if not isinstance(tried[0], np.ndarray):
            return tried[0]
        if tried[0].size > WIDEST and running:
            raise Refused(f"{node.name}: at most {WIDEST} numbers", str(tried[0].size))
        if not running or (tried[0].dtype.kind in "iu" and all(np.array_equal(tried[0], one) for one in tried)):
            return tried[0]
        return None

    @staticmethod
    def random(count, seed=1):
        return np.random.default_rng(seed).normal(size=count)

    def affine_value(self, node, inputs, running):
        sizes = [one.size for one in running]
        ends = np.cumsum(sizes)

        def apply(flat):
            parts = iter(np.split(flat, ends[:-1]))
            return node([one if not isinstance(one, Value) else next(parts).reshape(one.shape) for one in inputs])

        zero = apply(np.zeros(ends[-1]))
        if zero.dtype.kind == "b":
            return None
        shape, shift = zero.shape, zero.astype("f8").reshape(-1)
        of = lambda flat: np.asarray(apply(flat), "f8").reshape(-1) - shift
        for reach in (1e-3, 1.0, 1e3):
            r = reach * self.random(ends[-1])
            once, back, twice = of(r), of(-r), of(2 * r)
            near = 1e-9 * (np.abs(twice).max(initial=0) + np.abs(shift).max(initial=0))
            if not (np.abs(once + back).max(initial=0) <= near and np.abs(twice - 2 * once).max(initial=0) <= near):
                return None  # NaN too
        matrix = np.array([of(unit) for unit in np.eye(ends[-1])]).T
        r = self.random(ends[-1], 2)
        if not np.allclose(matrix @ r, of(r), rtol=1e-9, atol=1e-9 * (1 + np.abs(shift).max(initial=0))):
            return None
        parts = np.split(matrix, ends[:-1], axis=1)
        made = Affine({}, shift)
        for one, part in zip(running, parts):
            made = made.plus(one.affine.mapped(part, np.zeros(len(shift))))
        root = running[0].root
        if all(same(one.root, root) and one.size == len(shift) and np.array_equal(part, np.diag(np.diag(part)))
               for one, part in zip(running, parts)):
            scale = sum(np.diag(part) * one.marks[-1][0] for one, part in zip(running, parts))
            offset = shift + sum(np.diag(part) * one.marks[-1][1] for one, part in zip(running, parts))
            marks = [mark for one in running for mark in one.marks] + [(scale, offset)]
            return Value(shape, made, root, lambda z: (scale * z + offset).reshape(shape), marks)
        return Value(shape, made)

    def elementwise_value(self, node, inputs, running):
        root, size = running[0].root, running[0].size
        if not all(same(one.root, root) and one.size == size and one.elementwise for one in running):
            return None

        def of_root(z):
            return node([one if not isinstance(one, Value) else one.of_root(z) for one in inputs])

        first = of_root(self.random(size))
        if not isinstance(first, np.ndarray) or first.size != size:
            return None
        for seed in range(4):
            z, changed = self.random(size), np.random.default_rng(seed).random(size) < 0.5
            z[changed] = (10.0 ** (seed - 1) * self.random(size, seed + 5))[changed]
            kept = of_root(z).reshape(-1)[~changed] == first.reshape(-1)[~changed]
            if not np.all(kept):
                return None
        marks = [mark for one in running for mark in one.marks]
        return Value(first.shape, None, root, of_root, marks, node, inputs)

    def joint_value(self, node, inputs):
        """A function of several numbers, which operators behind it may complete to a norm."""
        roots = []
        for one in inputs:
            if isinstance(one, Value) and not any(same(one.root, root) for root in roots):
                roots.append(one.root)
        root = roots[0] if len(roots) == 1 else stacked(roots)
        ends = np.cumsum([0, *(len(own.shift) for own in roots)])

        def of_root(z):
            parts = [z[begin:end] for begin, end in zip(ends, ends[1:])]
            own = lambda one: one.of_root(next(part for part, root in zip(parts, roots) if same(one.root, root)))
            return node([own(one) if isinstance(one, Value) else one for one in inputs])

        first = of_root(self.random(len(root.shift)))
        if not isinstance(first, np.ndarray) or first.dtype.kind != "f":
            return None
        return Value(first.shape, None, root, of_root, (), node, inputs, False)

    def nearest(self, value):
        """The value affine in a stage of its own; else as a function of the last stage that it needs."""
        try:
            return self.made_affine(value)
        except Refused:
            while value.nearer:
                value = value.nearer
            return value

    # -- activations

    def made_affine(self, value):
        """The value behind a stage of its own; operators that are together no activation become one each."""
        if value.affine:
            return value
        if not value.made:
            try:
                value.made = self.own_stage(value)
            except Refused as refused:
                value.made = refused
        if isinstance(value.made, Refused):
            raise value.made
        return value.made

    def own_stage(self, value):
        found = self.recognised(value) if value.elementwise else None
        if found:
            return self.stage_of(value, *found)
        found = None if value.elementwise else self.norm_of(value)
        if found:
            return found
        inputs = [one if not isinstance(one, Value) or one.affine else self.made_affine(one) for one in value.inputs]
        if all(new is old for new, old in zip(inputs, value.inputs)):
            raise Refused(f"{value.node.name}: an activation that the library has (docs/convert.md)",
                          "another function" if value.elementwise else "a function of several numbers")
        made = value.nearer = self.taken(value.node, inputs)
        return made if made.affine else self.made_affine(made)

    def gated(self, node, inputs, running):
        """Numbers times the sigmoid of as many others, in a stage of its own; None."""
        for one in [None, *running] if len(running) == 2 else [None]:
            try:  # the numbers may be an activation's
                value = self.joint_value(node, [self.made_affine(other) if other is one else other for other in inputs])
            except Refused:
                continue
            half = len(value.root.shift) // 2 if value else 0
            if not half or value.size != half:
                continue
            for turn in (0, half):
                rows = [np.roll(scale * self.random(2 * half, seed), turn) for scale in (0.1, 1.0, 30.0) for seed in range(3)]
                of = lambda z: np.asarray(value.of_root(np.roll(z, turn)), "f8").reshape(-1)
                if all(np.allclose(of(z), z[:half] * sigmoid(z[half:]), 1e-9, 1e-9) for z in rows):
                    q = value.root.mapped(np.roll(np.eye(2 * half), turn, 0), np.zeros(2 * half))
                    return Value(value.shape, Affine({self.stage("glu", q): np.eye(half)}, np.zeros(half)))
        return None

    def norm_of(self, value):
        """A value that is weights times the normalised root, and a shift, behind a stage of its own; None."""
        count = len(value.root.shift)
        of = lambda z: np.asarray(value.of_root(z), "f8").reshape(-1)
        z, shift, far = self.random(count), of(np.zeros(count)), 1e8
        if not np.all(np.isfinite(shift)):
            return None
        for norm, u in (("layer_norm", lambda z: z - z.mean()), ("rms_norm", lambda z: z)):
            spread = lambda z: math.sqrt(np.mean(u(z) ** 2))
            weights = np.array([(of(far * unit) - shift) * spread(unit) for unit in np.eye(count)]).T
            if norm == "layer_norm" and value.size == count:  # only differences count: none off the diagonal, if they can
                weights -= (weights.sum(1) - np.diag(weights))[:, None] / max(count - 1, 1)
            weights[np.abs(weights) <= 1e-12 * np.abs(weights).max(initial=0)] = 0
            limit = weights @ u(z) / spread(z)
            if not np.all(np.isfinite(limit)) or not limit.any():
                continue
            place = np.abs(limit).argmax()
            low, high = -30.0, 30.0  # of log(s), where s z gives the half of the limit's square: spread(s z)^2 is epsilon
            for _ in range(80):
                middle = (low + high) / 2
                less = 2 * (of(math.exp(middle) * z)[place] - shift[place]) ** 2 < limit[place] ** 2
                low, high = (middle, high) if less else (low, middle)
            epsilon = (math.exp(low) * spread(z)) ** 2
            if not 1e-20 < epsilon < 1e3:
                continue
            made = lambda z: weights @ u(z) / math.sqrt(np.mean(u(z) ** 2) + epsilon) + shift
            others = [scale * self.random(count, seed) + seed for scale in (1e-3, 1.0, 1e3) for seed in range(3)]
            if all(np.allclose(made(one), of(one), 1e-9, 1e-9 * (1 + np.abs(limit).max())) for one in others):
                q = value.root.mapped(math.sqrt(NORM_EPSILON / epsilon) * np.eye(count), 0)
                return Value(value.shape, Affine({self.stage(norm, q): weights}, shift))
        return None

    @staticmethod
    def bends(of, size):
        """Where functions of one number each bend that are lines on both sides, or bounded: scales and shifts by which the
        bend lies at 0, or the bounds at -1 and 1."""
        far = 1e5
        left, left_2, right, right_2 = (of(np.full(size, z)) for z in (-far, -2 * far, far, 2 * far))
        slopes = (left - left_2) / far, (right_2 - right) / far
        flat = 1e-9
        marks = []
        with np.errstate(all="ignore"):
            kink = -(left + slopes[0] * far - (right - slopes[1] * far)) / (slopes[0] - slopes[1])
            kink = np.where(np.isfinite(kink), kink, 0.0)
            marks.append((np.ones(size), -kink))
            # as softplus and ELU: how far off its line it is at the bend says how wide
            off = np.abs(of(np.zeros(size)) - (left + slopes[0] * far)) / np.abs(slopes[1])
            marks += [(np.log(2) / off, np.zeros(size)), (1 / off, np.zeros(size))]
            width = np.abs(left + slopes[0] * far - (right - slopes[1] * far)) / np.abs(slopes[1])
            marks.append((1 / width, np.zeros(size)))
        if np.all(np.abs(slopes[0]) < flat) and np.all(np.abs(slopes[1]) < flat):
            places = []
            for share in (0.25, 0.75):
                wanted, low, high = left + share * (right - left), np.full(size, -far), np.full(size, far)
                for _ in range(80):
                    middle = (low + high) / 2
                    above = (of(middle) - wanted) * np.sign(right - left) > 0
                    low, high = np.where(above, low, middle), np.where(above, middle, high)
                places.append((low + high) / 2)
            span = places[1] - places[0]  # half of what lies between the bounds
            marks.append((1 / span, -(places[0] + places[1]) / 2 / span))
        return [(scale, shift) for scale, shift in marks if np.all(np.isfinite(scale) & np.isfinite(shift))]

    def recognised(self, value):
        """(family, scale, shift, coefficients) of an activation that the value is of its root; None."""
        size = value.size
        if value.of_root(np.zeros(size)).dtype.kind == "b":
            return None
        of = lambda z: np.asarray(value.of_root(z), "f8").reshape(-1)
        grid = np.concatenate([np.linspace(-9.05, 8.95, 61), [-41.3, -23.7, -14.1, 13.9, 22.3, 40.7]])
        marks, tried = list(value.marks), []
        last, offset = marks[-1]
        if np.all(np.abs(last) > 1e-12):
            bends = self.bends(lambda q: of((q - offset) / last), size)
            marks += [(scale * last, scale * offset + shift) for scale, shift in bends]
        for scale, shift in marks + [(-scale, -shift) for scale, shift in marks]:
            if np.any(np.abs(scale) < 1e-12) or any(np.array_equal(scale, a) and np.array_equal(shift, c) for a, c in tried):
                continue
            tried.append((scale, shift))
        answers = [np.array([of((q - shift) / scale) for q in grid]) for scale, shift in tried]
        for family, basis in FAMILIES.items():
            columns = np.array([*basis(grid), np.ones(len(grid))]).T
            for (scale, shift), wanted in zip(tried, answers):
                if not np.all(np.isfinite(wanted)):
                    continue
                coefficients = np.linalg.lstsq(columns, wanted, rcond=None)[0]
                near = 2e-7 * (1 + np.abs(wanted).max(axis=0))
                if not np.all(np.abs(columns @ coefficients - wanted) <= near):
                    continue
                # elsewhere than on that grid, which may have seen a part alone
                others = [z * np.ones(size) for z in np.linspace(-30.7, 29.3, 41)]
                there = np.array([sum(c * part for c, part in zip(coefficients, (*basis(scale * z + shift), 1.0)))
                                  - of(z) for z in others])
                if np.all(np.abs(there) <= near):
                    return family, scale, shift, coefficients
        return None

    def stage(self, activation, of):
        self.stages.append((activation, of))
        return len(self.stages) - 1

    def stage_of(self, value, family, scale, shift, coefficients):
        q = value.root.mapped(np.diag(scale), shift)
        *parts, constant = coefficients
        tiny = lambda numbers, beside: np.all(np.abs(numbers) <= 1e-9 * np.abs(beside).max(initial=1e-300))
        made = lambda activation, of, weights: Value(
            value.shape, Affine({self.stage(activation, of): weights}, constant))
        if family == "slopes":
            rising, falling = parts
            if tiny(falling, rising):
                return made("relu", q, np.diag(rising))
            if tiny(rising, falling):
                return made("relu", q.mapped(-np.eye(value.size), 0), np.diag(falling))
            if np.all(np.abs(falling + LEAKY * rising) <= 1e-8 * np.abs(rising)):
                return made("leaky_relu", q, np.diag(rising))
            return made("relu", self.halves(q), np.hstack([np.diag(rising), np.diag(falling)]))
        if family == "elu":
            above, below = parts
            if tiny(above - below, above):
                return made("elu", q, np.diag(above))
            # of relu(v) and -relu(-v) the library's ELU is relu(v) and exp(min(v, 0)) - 1
            count = 2 * value.size
            halves = Affine({self.stage("relu", self.halves(q)): np.diag([1.0] * value.size + [-1.0] * value.size)},
                            np.zeros(count))
            return made("elu", halves, np.hstack([np.diag(above), np.diag(below)]))
        weights = np.diag(parts[0])
        if family == "clip":
            return made("clip", q.mapped(CLIP_BOUND * np.eye(value.size), 0), weights / CLIP_BOUND)
        if family == "sigmoid":  # (1 + tanh(v / 2)) / 2
            constant = constant + parts[0] / 2
            return made("tanh", q.mapped(np.eye(value.size) / 2, 0), weights / 2)
        return made(family, q, weights)

    @staticmethod
    def halves(q):
        eye = np.eye(len(q.shift))
        return q.mapped(np.vstack([eye, -eye]), np.zeros(2 * len(q.shift)))

    # -- a chain of them

    def merged(self, output):
        """Stages that do not wait for each other, and have the same activation, as one; ordered by what they wait for."""
        level, groups = {0: 0}, {}
        for number in range(1, len(self.stages)):
            activation, of = self.stages[number]
            level[number] = 1 + max((level[stage] for stage in of.weights), default=0)
            groups.setdefault((level[number], activation, number if activation in WHOLE_LAYERS else 0), []).append(number)
        stages, moved = [None], {0: (0, 0)}  # of an old stage the new one, and where in it
        outputs = lambda activation, q: len(q.shift) // (2 if activation == "glu" else 1)

        def renamed(affine):
            weights = {}
            for stage, own in affine.weights.items():
                new, at = moved[stage]
                width = self.graph.width if new == 0 else outputs(*stages[new])
                wide = weights.setdefault(new, np.zeros((own.shape[0], width)))
                wide[:, at : at + own.shape[1]] += own
            return Affine(weights, affine.shift)

        for (_, activation, _), numbers in sorted(groups.items(), key=lambda group: group[0][0]):
            parts = [renamed(self.stages[number][1]) for number in numbers]
            sizes = [len(part.shift) for part in parts]
            stages.append((activation, stacked(parts)))
            for number, at in zip(numbers, np.cumsum([0, *sizes])):
                moved[number] = len(stages) - 1, int(at)
        return stages, renamed(output)

    def scheduled(self, output):
        """Layers one after the other. What a later one reads past an activation goes along in two halves."""
        stages, output = self.merged(output)
        count = len(stages)
        needed = [set(of.weights) for _, of in stages[1:]] + [set(output.weights)]
        carried_past = lambda number: sorted({stage for later in needed[number:] for stage in later if stage < number})
        for number in range(1, count):  # tanh(v) = 2 sigmoid(2 v) - 1 and clip(v) = relu(v + b) - relu(v - b) - b let pass
            activation, q = stages[number]
            size = len(q.shift)
            if activation not in ("tanh", "clip") or not carried_past(number):
                continue
            eye, two, bound = np.eye(size), Affine({}, np.full(size, 2.0)), CLIP_BOUND
            if activation == "tanh":
                stages[number], made, off = ("glu", stacked([two, q.mapped(2 * eye, 0)])), eye, 1.0
            else:
                parts = [q.mapped(eye, bound), q.mapped(eye, -bound)]
                stages[number], made, off = ("relu", stacked(parts)), np.hstack([eye, -eye]), bound
            for one in [of for _, of in stages[number + 1 :]] + [output]:
                if number in one.weights:
                    one.shift = one.shift - off * one.weights[number].sum(1)
                    one.weights[number] = one.weights[number] @ made
        place = {0: np.eye(self.graph.width)}  # stages by the numbers that the last layer made
        layers = []

        def dense(*parts, last=False):
            weights = [sum((own @ place[stage] for stage, own in part.weights.items()),
                           np.zeros((len(part.shift), next(iter(place.values())).shape[1]))) for part in parts]
            weights, bias = np.vstack(weights), np.concatenate([part.shift for part in parts])
            before = layers[-1] if layers and isinstance(layers[-1], dict) and "norm" in layers[-1] else None
            if before and not last and weights.shape == (len(before["bias"]),) * 2 and np.array_equal(
                    weights, np.diag(np.diag(weights))):  # the norm's own scales and shifts
                before["weights"], before["bias"] = np.diag(weights).tolist(), bias.tolist()
                return
            layers.append({"weights": weights.tolist(), "bias": bias.tolist()})

        def advance(activation, q, name, carried, odd):
            """Stage `name` = activation(q); the carried ones beside it, each as two halves times `odd`. A norm and
            a gate let them pass."""
            kept = [Affine({stage: np.eye(place[stage].shape[0])}, np.zeros(place[stage].shape[0])) for stage in carried]
            if activation in WHOLE_LAYERS:
                dense(q, *kept)
                size = len(q.shift)
                layers.append({"norm": activation, "weights": [1.0] * size, "bias": [0.0] * size})
                if activation == "glu":
                    size //= 2
                    layers[-1] = {"glu": size}
                sizes = [size, *(len(one.shift) for one in kept)]
                place.clear()
                place.update(zip([name, *carried], np.split(np.eye(sum(sizes)), np.cumsum(sizes)[:-1])))
                return
            dense(q, *(self.halves(one) for one in kept))
            layers.append(activation)
            width, at = sum(len(one.shift) * 2 for one in kept) + len(q.shift), len(q.shift)
            place.clear()
            place[name] = np.eye(width)[:at]
            for stage, one in zip(carried, kept):
                size = len(one.shift)
                place[stage] = (np.eye(width)[at : at + size] - np.eye(width)[at + size : at + 2 * size]) / odd
                at += 2 * size

        for number in range(1, count):
            activation, q = stages[number]
            carried = carried_past(number)
            if carried and activation == "elu":  # which is the identity of what a ReLU has made
                split = self.halves(q)
                advance("relu", split, "q", carried, 1)
                wide = next(iter(place.values())).shape[1]
                size, rest = len(q.shift), wide - 2 * len(q.shift)
                joined = np.zeros((size + rest, wide))
                joined[:size, :size], joined[:size, size : 2 * size] = np.eye(size), -np.eye(size)
                joined[size:, 2 * size :] = np.eye(rest)
                layers.append({"weights": joined.tolist(), "bias": [0.0] * (size + rest)})
                layers.append(activation)
                moved = {stage: np.hstack([np.zeros((place[stage].shape[0], size)), place[stage][:, 2 * size :]])
                         for stage in carried}
                place.clear()
                place.update(moved)
                place[number] = np.eye(size + rest)[:size]
                continue
            if carried and activation not in (*ODD_PARTS, *WHOLE_LAYERS):
                raise Refused("a skip connection past an activation other than sine, mish and softsign", f"past {activation}")
            advance(activation, q, number, carried, ODD_PARTS.get(activation, 1))
        dense(output, last=True)
        return layers


# ----------------------------------------------------------------------------------------------------------------------
# Sources: chains of tensors by name


def natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def chain_of_tensors(tensors, asked):
    """The chain of a state_dict {name: array}: linear layers and batch norms by their numbers, activations by the
    features file; the order that of numbers in the names, or of `layers` in the features file."""
    prefix = asked.get("prefix", "")
    tensors = {re.sub(r"^(_orig_mod\.|module\.)+", "", name): one for name, one in tensors.items()}
    known = {name[len(prefix):]: np.asarray(tensor) for name, tensor in tensors.items() if name.startswith(prefix)}
    if not known:
        raise Refused(f"tensors whose names begin with '{prefix}'" if tensors and prefix else "tensors of a network",
                      ", ".join(f"'{name}'" for name in list(tensors)[:4]) or "none")
    modules = {}
    for name, tensor in known.items():
        module, _, part = name.rpartition(".")
        if part == "kernel":  # flax, Keras
            part, tensor = "weight", tensor.T
        if part == "num_batches_tracked":
            modules.setdefault(module, {})
            continue
        modules.setdefault(module, {})[part] = tensor
    names = asked.get("layers") or sorted(modules, key=natural)
    for name in names:
        if name not in modules:
            raise Refused(f"'{name}.weight', a layer of the features file", ", ".join(f"'{one}'" for one in modules))
    for name in names:
        scale = modules[name].get("weight", modules[name].get("scale"))
        if scale is not None and scale.ndim == 1 and "running_mean" not in modules[name]:
            raise Refused(f"'{prefix}{name}.weight' of two dimensions, of Linear", f"{list(scale.shape)}, of a norm: tensors "
                          "say neither which nor its epsilon (convert the module, or its ONNX)")
    parents = {name.rpartition(".")[0] for name in names}
    if len(parents) > 1 and not asked.get("layers"):
        some = sorted(parents, key=natural)[:3]
        raise Refused("the tensors of one network (--prefix NAME, or `layers` in the features file)",
                      " beside ".join(f"'{one + '.' if one else one}'" for one in some))
    numbered = all(name.rpartition(".")[2].isdigit() for name in names)
    if not numbered and not asked.get("layers") and "" in modules:
        raise Refused("tensors as torch.nn.Sequential names them (0.weight, 0.bias, 2.weight, ...)",
                      f"'{next(iter(modules['']))}'")
    if not numbered and not asked.get("layers") and any("running_mean" in modules[name] for name in names):
        raise Refused("`layers` in the features file: names say no place of a batch norm", ", ".join(names[:4]))
    dense = [name for name in names if "running_mean" not in modules[name]]
    if numbered:
        gaps = int(names[-1].rpartition(".")[2]) + 1 - len(names)
        if gaps > 999:
            raise Refused("modules numbered from 0 to 999", f"'{names[-1]}'")
    else:
        gaps = len(dense) - 1
    given, single = asked.get("activations") or [], asked.get("one_activation", False)
    where = asked.get("features_path")
    if single:
        given = given * gaps
    elif not gaps <= len(given) <= gaps + 1:
        missing = "a module that has no numbers" if not given else str(len(given))
        raise Refused(f"`activations`, one for each of the {gaps} modules of the network that have no numbers, and at most "
                      "one behind them", f"none for {missing}" if not given else missing, where)
    graph, width, behind = ChainGraph(), None, list(given)
    place = 0
    for index, name in enumerate(names):
        number = int(name.rpartition(".")[2]) if numbered else place
        while place < number:
            graph.add(f"module {place}", ACTIVATIONS[behind.pop(0)])
            place += 1
        width = add_module(graph, f"'{prefix}{name}", modules[name], width)
        place += 1
        if not numbered and "running_mean" not in modules[name] and name is not dense[-1] and behind:
            later = names[index + 1] if index + 1 < len(names) else None
            if later is None or "running_mean" not in modules[later]:
                graph.add(f"behind {name}", ACTIVATIONS[behind.pop(0)])
        elif not numbered and "running_mean" in modules[name] and behind and name is not names[-1]:
            graph.add(f"behind {name}", ACTIVATIONS[behind.pop(0)])
    for last in behind:
        graph.add("the last activation", ACTIVATIONS[last])
    return Graph(graph.width, graph.nodes)


class ChainGraph:
    def __init__(self):
        self.width, self.nodes, self.last = None, [], "x"

    def add(self, name, apply):
        output = f"y{len(self.nodes)}"
        self.nodes.append(Node(name, apply, [self.last], output))
        self.last = output


def add_module(graph, name, module, width):
    """Linear or BatchNorm1d; the width that it makes."""
    if not module:
        raise Refused(f"{name}.weight'", "none")

    def tensor(part, shape):
        if part not in module:
            return None
        found = module[part]
        if tuple(found.shape) != shape:
            raise Refused(f"{name}.{part}' of shape {list(shape)}", str(list(found.shape)))
        if found.dtype.kind != "f":
            raise Refused(f"{name}.{part}' of floating-point numbers", str(found.dtype))
        return np.asarray(found, "f8")

    norm = "running_mean" in module
    parts = {"weight", "bias", "running_mean", "running_var"} if norm else {"weight", "bias"}
    for part in module:
        if part not in parts:
            raise Refused(f"{name}' numbers of Linear or BatchNorm1d", f"{name}.{part}' of shape {list(module[part].shape)}")
    if norm:
        size = int(module["running_mean"].size)
        graph.width = graph.width or size
        width = width or size
        mean, variance = tensor("running_mean", (width,)), tensor("running_var", (width,))
        gamma, beta = tensor("weight", (width,)), tensor("bias", (width,))
        if variance is None:
            raise Refused(f"{name}.running_var'", "none")
        if np.any(variance < 0):
            raise Refused(f"variances of 0 or more in {name}.running_var'", str(variance.min()))
        deviation = np.sqrt(variance + 1e-5)  # PyTorch's, which a state_dict does not say
        gamma, beta = (1.0 if gamma is None else gamma), (0.0 if beta is None else beta)
        graph.add(f"{name}'", lambda v: (v - mean) / deviation * gamma + beta)
        return width
    weights = module.get("weight")
    if weights is None or weights.ndim != 2:
        raise Refused(f"{name}.weight' of two dimensions, of Linear",
                      "none" if weights is None else f"shape {list(weights.shape)}")
    outputs, inputs = weights.shape
    if not outputs or not inputs:
        raise Refused(f"{name}.weight' with numbers", "none")
    graph.width = graph.width or inputs
    weights = tensor("weight", (outputs, width or inputs))
    bias = tensor("bias", (outputs,))
    graph.add(f"{name}'", lambda v: v @ weights.T + (0.0 if bias is None else bias))
    return outputs


def finite(name, array):
    if array.dtype.kind == "f" and not np.all(np.isfinite(array)):
        bad = array[~np.isfinite(array)].reshape(-1)[0]
        raise Refused(f"finite numbers in '{name}'", "NaN" if np.isnan(bad) else "Inf")
    return array


def from_bfloat16(bits):
    """The upper half of a float."""
    return (bits.astype("u4") << 16).view("f4").astype("f8")


SAFETENSORS_TYPES = {"F64": "<f8", "F32": "<f4", "F16": "<f2", "BF16": "<u2", "I64": "<i8"}


def read_safetensors(data):
    """{name: array in double} of a file (https://github.com/huggingface/safetensors)."""
    if len(data) < 8:
        raise Refused("a safetensors file", f"one of {len(data)} bytes")
    length = struct.unpack("<Q", data[:8])[0]
    if length > 1 << 24:
        raise Refused("a safetensors header of at most 16 MiB", f"a length of {length} bytes")
    if length > len(data) - 8:
        raise Refused(f"a header of {length} bytes", "a file that is cut short")
    if data[8 : 8 + length].count(b"[") > 1 << 16:
        raise Refused("a header whose lists do not nest", "one that nests")

    def once(pairs):
        names = [name for name, _ in pairs]
        for name in names:
            if names.count(name) > 1 and len(names) < 1 << 12:
                raise Refused("each name once in the header", f"'{name}' twice")
        return dict(pairs)

    try:
        header = json.loads(data[8 : 8 + length].decode(), object_pairs_hook=once)
    except (ValueError, RecursionError):
        header = None
    if not isinstance(header, dict):
        raise Refused("a JSON object as the header", "none")
    body, tensors, places = data[8 + length :], {}, []
    whole = lambda number: isinstance(number, int) and not isinstance(number, bool) and number >= 0
    for name, entry in header.items():
        if name == "__metadata__":
            continue
        what = f"tensor '{name}': "
        if not isinstance(entry, dict):
            raise Refused(what + "an object with dtype, shape and data_offsets",
                          "a number" if isinstance(entry, (int, float)) else "none")
        kind, shape, offsets = (entry.get(key) for key in ("dtype", "shape", "data_offsets"))
        if not isinstance(kind, str):
            raise Refused(what + "a text dtype", "none")
        if kind not in SAFETENSORS_TYPES or (kind == "I64" and not name.endswith("num_batches_tracked")):
            raise Refused(what + "numbers of type F64, F32, F16 or BF16", kind)
        if not isinstance(shape, list):
            raise Refused(what + "an array shape", "none")
        count = 1
        for size in shape:
            if not whole(size) or size > 1 << 28:
                raise Refused(what + "sizes from 0 to 2^28", json.dumps(size))
            count *= size
            if count > 1 << 28:
                raise Refused(what + "at most 2^28 numbers", "more")
        if not isinstance(offsets, list) or len(offsets) != 2 or not all(whole(one) for one in offsets):
            raise Refused(what + "two data_offsets", "others")
        begin, end = offsets
        if begin > end or end > len(body):
            raise Refused(what + f"data_offsets within the {len(body)} bytes of data", str(offsets))
        number = np.dtype(SAFETENSORS_TYPES[kind])
        if end - begin != count * number.itemsize:
            raise Refused(what + f"{count * number.itemsize} bytes for its shape", str(offsets))
        places.append((begin, end, name))
        array = np.frombuffer(body, number, count, begin).reshape(shape)
        tensors[name] = finite(name, from_bfloat16(array) if kind == "BF16" else array.astype(number.kind + "8"))
    at = 0
    for begin, end, name in sorted(places):
        if begin != at:
            raise Refused("tensors one after the other", f"'{name}' {'over the one before' if begin < at else 'behind a hole'}")
        at = end
    if at != len(body):
        raise Refused(f"{at} bytes of data", str(len(body)))
    return tensors


# ----------------------------------------------------------------------------------------------------------------------
# Sources: ONNX

FLOATS, WHOLE = (1, 10, 11, 16), {2: "u1", 3: "i1", 4: "u2", 5: "i2", 6: "i4", 7: "i8", 9: "?", 12: "u4", 13: "u8"}


def squeezed(x, axes):
    return np.squeeze(x, tuple(int(one) for one in np.ravel(axes))) if axes is not None else np.squeeze(x)


def sliced(x, starts, ends, axes=None, steps=None):
    at = [slice(None)] * x.ndim
    axes = range(len(np.ravel(starts))) if axes is None else np.ravel(axes)
    steps = np.ones(len(np.ravel(starts)), int) if steps is None else np.ravel(steps)
    for axis, start, end, step in zip(axes, np.ravel(starts), np.ravel(ends), steps):
        size, end = x.shape[int(axis)], int(end)
        at[int(axis)] = slice(int(start), None if (step < 0 and end < -size) or end > 2**31 else end, int(step))
    return x[tuple(at)]


def reshaped(x, shape, allowzero=0):
    return x.reshape([x.shape[i] if size == 0 and not allowzero else int(size) for i, size in enumerate(np.ravel(shape))])


def unsqueezed(x, axes):
    rank = x.ndim + len(np.ravel(axes))
    for axis in sorted(int(one) % rank for one in np.ravel(axes)):
        x = np.expand_dims(x, axis)
    return x


def flattened(x, axis):
    return x.reshape(int(np.prod(x.shape[:axis])), -1)


def batch_norm(x, gamma, beta, mean, variance, epsilon):
    if np.any(variance < 0):
        raise Refused("variances of 0 or more", str(variance.min()))
    column = lambda v: v.reshape([1, -1] + [1] * (x.ndim - 2))
    return (x - column(mean)) / np.sqrt(column(variance) + epsilon) * column(gamma) + column(beta)


def norm(x, gamma, beta, axis, epsilon, centred):
    axes = tuple(range(axis % x.ndim, x.ndim))
    off = x - x.mean(axes, keepdims=True) if centred else x
    return off / np.sqrt((off**2).mean(axes, keepdims=True) + epsilon) * gamma + (0.0 if beta is None else beta)


def reduced(of, x, axes, keep):
    return of(x, axis=None if axes is None else tuple(int(one) for one in np.ravel(axes)), keepdims=bool(keep))


def split(x, number, axis, count, sizes):
    if sizes is not None:
        return np.split(x, np.cumsum(np.ravel(sizes).astype(int))[:-1], axis)[number]
    return np.array_split(x, count, axis)[number]


def operators(a):
    """Operators of ONNX by name, made of a node's attributes `a(name, default)`."""
    axes = lambda given: given if given is not None else a("axes", None)
    return {
        "Add": np.add, "Sub": np.subtract, "Mul": np.multiply, "Div": np.divide, "Neg": np.negative, "Abs": np.abs,
        "Pow": np.power, "Sqrt": np.sqrt, "Exp": np.exp, "Log": np.log, "Erf": erf, "Sin": np.sin, "Cos": np.cos,
        "Reciprocal": np.reciprocal, "Tanh": np.tanh, "Sigmoid": sigmoid, "Relu": relu, "Softplus": softplus,
        "Softsign": softsign, "Mish": mish, "HardSwish": hard_swish,
        "LeakyRelu": lambda x: np.where(x < 0, a("alpha", 0.01) * x, x), "PRelu": lambda x, s: np.where(x < 0, s * x, x),
        "Elu": lambda x: np.where(x > 0, x, a("alpha", 1.0) * np.expm1(np.minimum(x, 0))),
        "Selu": lambda x: a("gamma", 1.0507009873554805) * np.where(
            x > 0, x, a("alpha", 1.6732632423543772) * np.expm1(np.minimum(x, 0))),
        "Celu": lambda x: relu(x) + a("alpha", 1.0) * np.expm1(np.minimum(x, 0) / a("alpha", 1.0)),
        "ThresholdedRelu": lambda x: np.where(x > a("alpha", 1.0), x, 0.0),
        "HardSigmoid": lambda x: np.clip(a("alpha", 0.2) * x + a("beta", 0.5), 0, 1),
        "Gelu": lambda x: gelu_tanh(x) if a("approximate", b"none") in ("tanh", b"tanh") else gelu(x),
        "Clip": lambda x, low=None, high=None: np.clip(x, a("min", -np.inf) if low is None else low,
                                                       a("max", np.inf) if high is None else high),
        "Min": lambda *x: np.minimum.reduce(np.broadcast_arrays(*x)),
        "Max": lambda *x: np.maximum.reduce(np.broadcast_arrays(*x)),
        "Sum": lambda *x: sum(x), "Where": np.where, "Greater": np.greater, "Less": np.less, "Equal": np.equal,
        "GreaterOrEqual": np.greater_equal, "LessOrEqual": np.less_equal, "Not": np.logical_not, "And": np.logical_and,
        "Or": np.logical_or, "MatMul": np.matmul,
        "Gemm": lambda x, w, c=0.0: a("alpha", 1.0) * ((x.T if a("transA", 0) else x) @ (w.T if a("transB", 0) else w))
        + a("beta", 1.0) * c,
        "BatchNormalization": lambda x, g, b, m, v: batch_norm(x, g, b, m, v, a("epsilon", 1e-5)),
        "LayerNormalization": lambda x, g, b=None: norm(x, g, b, a("axis", -1), a("epsilon", 1e-5), True),
        "RMSNormalization": lambda x, g: norm(x, g, None, a("axis", -1), a("epsilon", 1e-5), False),
        "SimplifiedLayerNormalization": lambda x, g: norm(x, g, None, a("axis", -1), a("epsilon", 1e-5), False),
        "Identity": lambda x: x, "Dropout": lambda x, *more: x, "CastLike": lambda x, other: x,
        "Cast": lambda x: x.astype("f8") if a("to", 1) in FLOATS else x.astype(WHOLE.get(a("to", 1), "i8")),
        "Flatten": lambda x: flattened(x, a("axis", 1)), "Reshape": lambda x, s: reshaped(x, s, a("allowzero", 0)),
        "Squeeze": lambda x, ax=None: squeezed(x, axes(ax)), "Unsqueeze": lambda x, ax=None: unsqueezed(x, axes(ax)),
        "Transpose": lambda x: np.transpose(x, a("perm", None)), "Concat": lambda *x: np.concatenate(x, a("axis", 1)),
        "Slice": lambda x, s=None, e=None, ax=None, st=None: sliced(
            x, a("starts", None) if s is None else s, a("ends", None) if e is None else e, axes(ax), st),
        "Gather": lambda x, i: np.take(x, np.asarray(i, int), a("axis", 0)), "Shape": lambda x: np.array(x.shape),
        "Size": lambda x: np.array(x.size), "Expand": lambda x, s: np.broadcast_to(
            x, np.broadcast_shapes(x.shape, tuple(int(one) for one in s))),
        "Range": lambda b, e, s: np.arange(b, e, s),
        "ConstantOfShape": lambda s: np.full([int(one) for one in s], a("value", np.zeros(1)).reshape(-1)[0]),
        "ReduceMean": lambda x, ax=None: reduced(np.mean, x, axes(ax), a("keepdims", 1)),
        "ReduceSum": lambda x, ax=None: reduced(np.sum, x, axes(ax), a("keepdims", 1)),
    }


class OnnxReader:
    def __init__(self, path, asked):
        try:
            import onnx
        except ImportError:
            raise Missing("onnx") from None
        self.onnx, self.path, self.files, self.asked = onnx, Path(path), {}, asked
        model, data = onnx.ModelProto(), network_bytes(path)
        try:
            model.ParseFromString(data)
        except Exception:
            model = None
        if not model or not model.HasField("graph"):
            raise Refused("an ONNX model", "none, or one that is cut short")
        for opset in model.opset_import:
            if opset.domain in ("", "ai.onnx") and opset.version < 7:
                raise Refused("operators of ONNX 7 or later", f"version {opset.version}")
        self.model = model.graph

    def graph(self):
        if len(self.model.node) > 1000:
            raise Refused("at most 1000 nodes", str(len(self.model.node)))
        stored = {tensor.name: tensor for tensor in self.model.initializer}
        inputs = [one for one in self.model.input if one.name not in stored]
        if len(inputs) != 1:
            raise Refused("a graph with one input", str(len(inputs)))
        shape, free = self.described(inputs[0])
        constants, made, nodes = {}, {inputs[0].name}, []

        def constant(name, what):
            if name not in constants:
                if name not in stored:
                    raise Refused(f"{what}: inputs that the graph makes before", f"'{name}'")
                constants[name] = self.array(stored[name], f"tensor '{name}'")
            return constants[name]

        for number, node in enumerate(self.model.node):
            label = f"'{node.name}'" if node.name else str(number)
            what = f"node {label} ({node.op_type})"
            for output in node.output:
                if output and (output in made or output in constants or output in stored):
                    raise Refused(f"{what}: outputs that nothing else makes", f"'{output}' again")
            taken = [None if not name else name if name in made else constant(name, what) for name in node.input]
            for place, output in enumerate(node.output):
                if not output or (place > 0 and node.op_type != "Split"):
                    continue
                apply = self.operator(node, what, place)
                own = Node(what, apply, taken, output)
                if any(isinstance(one, str) for one in taken):
                    nodes.append(own)
                    made.add(output)
                else:
                    constants[output] = finite(output, np.asarray(own(taken)))
                    if constants[output].size > MOST_NUMBERS:
                        raise Refused(f"{what}: at most 2^24 numbers", str(constants[output].size))
        return Graph(shape[-1], nodes, inputs[0].name, self.output(made), free, shape)

    def output(self, made):
        outputs, wanted = [one.name for one in self.model.output], self.asked.get("output", "")
        if wanted and wanted not in outputs:
            raise Refused(f"an output '{wanted}'", ", ".join(f"'{name}'" for name in outputs))
        if not wanted and len(outputs) != 1:
            raise Refused("a graph with one output, or --output NAME", ", ".join(f"'{name}'" for name in outputs) or "none")
        name = wanted or outputs[0]
        if name not in made:
            raise Refused(f"output '{name}': a number that depends on the input", "none")
        return name

    def described(self, one):
        what, kind = f"input '{one.name}': ", one.type.tensor_type
        if kind.elem_type not in FLOATS:
            raise Refused(what + "a tensor of FLOAT, DOUBLE, FLOAT16 or BFLOAT16", self.type_name(kind.elem_type))
        sizes = kind.shape.dim
        rows = [one.dim_value if one.HasField("dim_value") else 0 for one in sizes]
        if not kind.HasField("shape") or not sizes or any(size > 1 for size in rows[1:-1]):
            raise Refused(what + "a shape [rows, features]", f"[{', '.join(map(str, rows))}] (one motion a row: no window)")
        if not rows[-1]:
            raise Refused(what + "a number of features", f"a dynamic one, '{sizes[-1].dim_param}'")
        if not 1 <= rows[-1] <= WIDEST:
            raise Refused(what + f"1 to {WIDEST} features", str(rows[-1]))
        return (*[1] * (len(sizes) - 1), rows[-1]), len(sizes) > 1 and rows[0] != 1

    def type_name(self, number):
        try:
            return self.onnx.TensorProto.DataType.Name(number)
        except ValueError:
            return str(number)

    def operator(self, node, what, place):
        given = {}
        for one in node.attribute:
            value = self.onnx.helper.get_attribute_value(one)
            if isinstance(value, self.onnx.TensorProto):
                value = self.array(value, f"{what}: `{one.name}`")
            if isinstance(value, float) and not math.isfinite(value):
                raise Refused(f"{what}: a number `{one.name}`", "NaN or Inf")
            given[one.name] = value
        attribute = lambda name, otherwise: given.get(name, otherwise)
        if node.domain not in ("", "ai.onnx"):
            raise Refused(f"{what}: operators of ONNX", f"the domain '{node.domain}'")
        if node.op_type == "Constant":
            for key in ("value", "value_float", "value_int", "value_floats", "value_ints"):
                if key in given:
                    value = np.asarray(given[key])
                    return lambda: value.astype("f8") if value.dtype.kind == "f" else value
        if node.op_type == "Split":
            return lambda x, sizes=None: split(x, place, given.get("axis", 0), len(node.output),
                                               sizes if sizes is not None else given.get("split"))
        if given.get("training_mode"):
            raise Refused(f"{what}: a network that no longer trains", "training_mode 1")
        table = operators(attribute)
        if node.op_type in ("GRU", "LSTM", "RNN"):
            raise Refused(f"{what}: layers without a state (a model is asked for one motion; `pinnquad train --models "
                          "structured_causal` fits one of the last motions)", node.op_type)
        if node.op_type not in table:
            raise Refused(f"{what}: an affine map or an activation of each number (docs/convert.md)", node.op_type)
        return table[node.op_type]

    def array(self, tensor, what):
        """Its numbers, of floating point in double. Throws for dims that do not fit its data, and for NaN."""
        kind = tensor.data_type
        if kind not in FLOATS and kind not in WHOLE:
            raise Refused(f"{what}: numbers", self.type_name(kind))
        count = 1
        for size in tensor.dims:
            if not 0 <= size <= 1 << 28:
                raise Refused(f"{what}: dims from 0 to 2^28", str(size))
            count *= size
            if count > 1 << 28:
                raise Refused(f"{what}: at most 2^28 numbers", "more")
        stored = np.dtype({1: "<f4", 10: "<f2", 11: "<f8", 16: "<u2"}.get(kind) or WHOLE[kind]).newbyteorder("<")
        outside = tensor.data_location == self.onnx.TensorProto.EXTERNAL or len(tensor.external_data) > 0
        if outside or tensor.HasField("raw_data"):
            raw = self.beside(tensor, what) if outside else tensor.raw_data
            if len(raw) != count * stored.itemsize:
                raise Refused(f"{what}: {count} numbers for its shape {list(tensor.dims)}", f"{len(raw)} bytes")
            array = np.frombuffer(raw, stored)
        else:
            listed = {1: tensor.float_data, 11: tensor.double_data, 7: tensor.int64_data, 12: tensor.uint64_data,
                      13: tensor.uint64_data}.get(kind, tensor.int32_data)
            if len(listed) != count:
                raise Refused(f"{what}: {count} numbers for its shape {list(tensor.dims)}", str(len(listed)))
            array = np.array(listed, "u2").view(stored) if kind in (10, 16) else np.array(listed).astype(stored)
        array = from_bfloat16(array) if kind == 16 else array.astype("f8") if kind in FLOATS else array
        return finite(what.removeprefix("tensor '").rstrip("'"), array.reshape(list(tensor.dims)))

    def beside(self, tensor, what):
        """The bytes of a tensor that lie in a file beside the model: what it names leads to no other folder."""
        said = {}
        for entry in tensor.external_data:
            if entry.key in said:
                raise Refused(f"{what}: each key of its external data once", f"'{entry.key}' twice")
            said[entry.key] = entry.value

        def whole(key, otherwise):
            if key not in said:
                return otherwise
            if not re.fullmatch(r"\d{1,20}", said[key]) or int(said[key]) >= 1 << 64:
                raise Refused(f"{what}: a whole number `{key}` of its external data", f"'{said[key]}'")
            return int(said[key])

        offset, length, location = whole("offset", 0), whole("length", None), said.get("location", "")
        if location not in self.files:
            folder = self.path.parent.resolve()
            target = self.path.parent / location
            if not location or Path(location).is_absolute() or ".." in Path(location).parts:
                raise Refused(f"{what}: external data in the folder of the model (location)", f"'{location}'")
            if not target.exists():
                raise Refused(f"{what}: its numbers in {location} beside the model (or export with external_data=False)",
                              "no such file")
            if target.is_symlink() or not target.resolve().is_relative_to(folder):
                raise Refused(f"{what}: external data in the folder of the model", f"a link, '{location}'")
            self.files[location] = network_bytes(target)
            if sum(map(len, self.files.values())) > 1 << 26:
                raise Refused("at most 64 MiB of external data", "more")
        data = self.files[location]
        end = len(data) if length is None else offset + length
        if offset > len(data) or end > len(data):
            raise Refused(f"{what}: its data within the {len(data)} bytes of {location}",
                          f"offset {offset}" + ("" if length is None else f", length {length}"))
        return data[offset:end]


def network_bytes(path):
    path = Path(path)
    try:
        if not path.is_file():
            raise Refused("a file", "no such file" if not path.exists() else "none that is regular")
        if path.stat().st_size > 1 << 26:
            raise Refused("a network of at most 64 MiB", f"{path.stat().st_size} bytes")
        return path.read_bytes()
    except OSError as error:
        raise Refused("a file that can be read", error.strerror or "none") from None


# ----------------------------------------------------------------------------------------------------------------------
# Sources in memory


def graph_of_module(module, width, asked):
    """The graph of a torch.nn.Module, traced by torch.fx; its operators are PyTorch's own, in double."""
    import copy

    import torch
    import torch.fx
    module = copy.deepcopy(module).cpu().double().eval()
    try:
        traced = torch.fx.symbolic_trace(module)
    except Exception as error:
        raise Refused("a module that torch.fx traces (or export it to ONNX)", one_line(error)) from None
    parts = dict(traced.named_modules())
    nodes, named, source, output = [], {}, None, None
    tensor = lambda one: torch.from_numpy(np.ascontiguousarray(one)) if isinstance(one, np.ndarray) else one

    def reached(target):
        at = traced
        for part in target.split("."):
            at = getattr(at, part)
        return at.detach().numpy()

    for node in traced.graph.nodes:
        if node.op == "placeholder":
            if source:
                raise Refused("a module of one input", f"'{node.target}' beside")
            source = node.name
        elif node.op == "get_attr":
            named[node.name] = reached(node.target)
        elif node.op == "output":
            output = chosen_output(node.args[0], asked.get("output", ""))
        else:
            names = [one.name for one in node.all_input_nodes]

            def apply(*arrays, node=node, names=names):
                given = dict(zip(names, arrays))
                at = lambda one: tensor(given[one.name])
                args, kwargs = torch.fx.node.map_arg(node.args, at), torch.fx.node.map_arg(node.kwargs, at)
                if node.op == "call_module":
                    made = parts[node.target](*args, **kwargs)
                elif node.op == "call_method":
                    made = getattr(args[0], node.target)(*args[1:], **kwargs)
                else:
                    made = node.target(*args, **kwargs)
                return made.detach().numpy() if isinstance(made, torch.Tensor) else made

            kind = type(parts[node.target]).__name__ if node.op == "call_module" else getattr(node.target, "__name__", node.target)
            nodes.append(Node(f"module '{node.name}' ({kind})", apply, [named.get(name, name) for name in names], node.name))
    with torch.no_grad():
        return Graph(width, nodes, source, output)


def chosen_output(given, wanted):
    """The name of a traced module's output; of several the one of a key or a place."""
    several = given if isinstance(given, dict) else dict(enumerate(given)) if isinstance(given, (tuple, list)) else {"": given}
    named = {str(name): one.name for name, one in several.items()}
    if wanted not in named and len(named) != 1:
        raise Refused("a module of one output, or output=NAME", ", ".join(map(repr, named)))
    return named.get(wanted, next(iter(named.values())))


def flattened_names(tree, prefix=""):
    """{"a.b.kernel": array} of a tree of dicts, as flax has parameters."""
    found = {}
    for name, one in tree.items():
        if hasattr(one, "items"):
            found.update(flattened_names(one, f"{prefix}{name}."))
        else:
            found[prefix + str(name)] = np.asarray(one.detach().cpu().numpy() if hasattr(one, "detach") else one)
    return found


def graph_in_memory(source, width, asked):
    """Of a torch.nn.Module, a fitted scikit-learn MLPRegressor, or arrays by name: a state_dict, flax parameters."""
    if hasattr(source, "named_parameters"):
        return graph_of_module(source, width, asked)
    if hasattr(source, "coefs_"):
        graph = ChainGraph()
        word = {"logistic": "sigmoid"}.get(source.activation, source.activation)
        for number, (weights, bias) in enumerate(zip(source.coefs_, source.intercepts_)):
            graph.add(f"layer {number}", lambda v, w=np.asarray(weights, "f8"), b=np.asarray(bias, "f8"): v @ w + b)
            if number + 1 < len(source.coefs_):
                graph.add(f"activation {number}", ACTIVATIONS[word])
        return Graph(source.coefs_[0].shape[0], graph.nodes)
    if hasattr(source, "items"):
        tensors = {name.removeprefix("params."): one for name, one in flattened_names(source).items()}
        return chain_of_tensors({name: finite(name, one) for name, one in tensors.items()}, asked)
    raise Refused("a path, a torch.nn.Module, arrays by name or a scikit-learn MLPRegressor", type(source).__name__)


OTHERS = {".pt": "torch.onnx.export(network.eval(), (torch.zeros(1, features),), 'net.onnx')",
          ".h5": "tf2onnx.convert.from_keras(network, output_path='net.onnx')",
          ".tflite": "tf2onnx.convert.from_tflite('net.tflite', output_path='net.onnx')"}
OTHERS.update({".pth": OTHERS[".pt"], ".ckpt": OTHERS[".pt"], ".keras": OTHERS[".h5"]})


def graph_of_file(path, asked):
    ending = Path(path).suffix
    if ending == ".onnx":
        return OnnxReader(path, asked).graph()
    if ending == ".safetensors":
        return chain_of_tensors(read_safetensors(network_bytes(path)), asked)
    raise Refused("a network in .onnx or .safetensors", f"{ending}: write one by {OTHERS[ending]}"
                  if ending in OTHERS else f"'{ending}'")


def read_network(asked, source=None):
    """{"inputs", "outputs", "layers", "answers"}: layers of the library, and what the source itself makes of `rows`."""
    width = len(asked["rows"][0])
    graph = graph_of_file(asked["source"], asked) if source is None else graph_in_memory(source, width, asked)
    graph.require_rows()
    layers = Lowering(graph).layers()
    outputs = len(layers[-1]["bias"])
    made = {"inputs": graph.width, "outputs": outputs, "layers": layers, "answers": []}
    if graph.width == width:
        answers = graph(asked["rows"])
        if not np.all(np.isfinite(answers)):
            raise Refused("finite answers inside the envelope", "NaN or Inf")
        made["answers"] = answers.tolist()
    return made


# ----------------------------------------------------------------------------------------------------------------------
# Back: a model as a network for elsewhere


def applied(step, v):
    """A layer as the library has it, of rows."""
    if isinstance(step, str):
        return ACTIVATIONS[step](v)
    if "glu" in step:
        count = step["glu"]
        return np.hstack([v[:, :count] * sigmoid(v[:, count : 2 * count]), v[:, 2 * count :]])
    if "norm" not in step:
        return v @ np.array(step["weights"]).T + step["bias"]
    count = len(step["bias"])
    made = norm(v[:, :count], step["weights"], np.array(step["bias"]), -1, NORM_EPSILON, step["norm"] == "layer_norm")
    return np.hstack([made, v[:, count:]])


class Model:
    """A model in numbers: standardised features, a sum of chains, each between bounds, an affine map to commands."""

    def __init__(self, said):
        self.said = said
        array = lambda name: None if said.get(name) is None else np.array(said[name], "f8")
        self.least, self.most, self.mean, self.deviation = map(array, ("least", "most", "mean", "deviation"))
        self.output_mean, self.output_deviation = array("output_mean"), array("output_deviation")
        self.weights, self.bias = array("weights"), array("bias")
        self.of_features = array("of_features")
        self.parts = said["parts"]

    def scales_outputs(self):
        return np.any(self.output_deviation != 1) or np.any(self.output_mean != 0)

    def is_plain_output(self):
        return (self.of_features is None and not self.bias.any() and self.weights.shape[0] == self.weights.shape[1]
                and np.array_equal(self.weights, np.eye(len(self.weights))))

    def __call__(self, features):
        features = np.asarray(features, "f8")
        x = features if self.least is None else np.clip(features, self.least, self.most)
        z = (x - self.mean) / self.deviation
        y = np.zeros((len(x), len(self.output_mean)))
        for part in self.parts:
            v = z[:, part["shown"]] if part["shown"] else z
            for step in part["steps"]:
                v = applied(step, v)
            y += np.clip(v, part["lower"], part["upper"]) if part["lower"] else v
        u = (y * self.output_deviation + self.output_mean) @ self.weights.T + self.bias
        return u if self.of_features is None else u + features @ self.of_features.T

    def checked(self):
        off = np.abs(self(self.said["golden_features"]) - self.said["golden_commands"]).max()
        if not off <= 1e-6:
            raise Refused("a model whose arithmetic double follows within 1e-6 of a command", f"{off:.1e}")
        return self


def onnx_of(model):
    """The bytes of an ONNX model, opset 13: input `features` in physical units, output `commands`."""
    try:
        from onnx import TensorProto, helper
    except ImportError:
        raise Missing("onnx") from None
    kind = TensorProto.DOUBLE if model.said["is_double"] else TensorProto.FLOAT
    nodes, constants = [], []

    def constant(values, number=kind):
        values = np.asarray(values, "i8" if number == TensorProto.INT64 else "f8" if kind == TensorProto.DOUBLE else "f4")
        constants.append(helper.make_tensor(f"constant_{len(constants)}", number, values.shape, values.reshape(-1)))
        return constants[-1].name

    def node(operator, *inputs, **attributes):
        name = f"{operator}_{len(nodes)}"
        nodes.append(helper.make_node(operator, list(inputs), [name], name, **attributes))
        return name

    def gemm(x, weights, bias):
        return node("Gemm", x, constant(weights), constant(bias), transB=1)

    def activation(x, word):
        plain = {"relu": "Relu", "tanh": "Tanh", "softplus": "Softplus", "sine": "Sin", "elu": "Elu", "leaky_relu": "LeakyRelu",
                 "softsign": "Softsign"}
        if word == "silu":
            return node("Mul", x, node("Sigmoid", x))
        if word == "gelu":
            gate = node("Add", node("Erf", node("Div", x, constant(math.sqrt(2)))), constant(1))
            return node("Mul", node("Mul", x, gate), constant(0.5))
        if word == "clip":
            return node("Clip", x, constant(-CLIP_BOUND), constant(CLIP_BOUND))
        if word == "gelu_tanh":  # opset 13 has none
            cubic = node("Mul", node("Mul", node("Mul", x, x), x), constant(0.044715))
            z = node("Mul", node("Add", x, cubic), constant(2 * math.sqrt(2 / math.pi)))
            return node("Mul", x, node("Sigmoid", z))
        if word == "hard_swish":
            return node("Mul", x, node("HardSigmoid", x, alpha=1 / 6, beta=0.5))
        if word == "mish":
            return node("Mul", x, node("Tanh", node("Softplus", x)))
        return node(plain[word], x)

    def whole_layer(x, step, width):
        """A norm or a gate, as operators of opset 13."""
        some = lambda *places: node("Gather", x, constant(range(*places), TensorProto.INT64), axis=1)
        if "glu" in step:
            count = step["glu"]
            made = node("Mul", some(count), node("Sigmoid", some(count, 2 * count)))
            return node("Concat", made, some(2 * count, width), axis=1) if 2 * count < width else made
        count = len(step["bias"])
        own = some(count) if count < width else x
        off = node("Sub", own, node("ReduceMean", own, axes=[1])) if step["norm"] == "layer_norm" else own
        variance = node("Add", node("ReduceMean", node("Mul", off, off), axes=[1]), constant(NORM_EPSILON))
        made = node("Add", node("Mul", node("Div", off, node("Sqrt", variance)), constant(step["weights"])), constant(step["bias"]))
        return node("Concat", made, some(count, width), axis=1) if count < width else made

    clipped = lambda x, lower, upper: node("Min", node("Max", x, constant(lower)), constant(upper))
    x = "features" if model.least is None else clipped("features", model.least, model.most)
    z, total = node("Div", node("Sub", x, constant(model.mean)), constant(model.deviation)), None
    for part in model.parts:
        v = node("Gather", z, constant(part["shown"], TensorProto.INT64), axis=1) if part["shown"] else z
        width = len(part["shown"] or model.mean)
        for step in part["steps"]:
            if isinstance(step, str):
                v = activation(v, step)
            elif "bias" not in step or "norm" in step:
                v = whole_layer(v, step, width)
                width -= step.get("glu", 0)
            else:
                v, width = gemm(v, step["weights"], step["bias"]), len(step["bias"])
        if part["lower"]:
            v = clipped(v, part["lower"], part["upper"])
        total = node("Add", total, v) if total else v
    if model.scales_outputs():
        total = node("Add", node("Mul", total, constant(model.output_deviation)), constant(model.output_mean))
    if not model.is_plain_output():
        total = gemm(total, model.weights, model.bias)
    if model.of_features is not None:
        total = node("Add", total, gemm("features", model.of_features, np.zeros(len(model.of_features))))
    nodes[-1].output[0] = "commands"
    described = lambda name, width: helper.make_tensor_value_info(name, kind, ["rows", width])
    graph = helper.make_graph(nodes, model.said["name"], [described("features", len(model.mean))],
                              [described("commands", len(model.bias))], constants)
    made = helper.make_model(graph, producer_name="pinnquad", opset_imports=[helper.make_opsetid("", 13)])
    made.ir_version = 7
    helper.set_model_props(made, model.said["facts"])
    return made.SerializeToString()


def safetensors_of(model):
    """The bytes of a state_dict of torch.nn.Sequential: one chain, its scalers folded."""
    refuse = lambda found: Refused("one chain of layers, for safetensors (.onnx holds any model)", found)
    if len(model.parts) != 1:
        raise refuse(f"a sum of {len(model.parts)}")
    part = model.parts[0]
    if part["lower"]:
        raise refuse("bounds")
    if model.least is not None:
        raise refuse("columns that are clipped to their range")
    if model.of_features is not None:
        raise refuse("a base that reads the features")
    if any(not isinstance(step, str) and ("norm" in step or "glu" in step) for step in part["steps"]):
        raise refuse("a norm or a gate, which tensors don't name")
    graph = ChainGraph()
    graph.add("model", lambda v: (v - model.mean) / model.deviation)
    if part["shown"]:
        graph.add("shown", lambda v: v[:, part["shown"]])
    for step in part["steps"]:
        graph.add("step", lambda v, step=step: applied(step, v))
    graph.add("commands", lambda v: (v * model.output_deviation + model.output_mean) @ model.weights.T + model.bias)
    layers = Lowering(Graph(len(model.mean), graph.nodes)).layers()
    number, data, header = "<f8" if model.said["is_double"] else "<f4", b"", {}
    words = [layer for layer in layers if isinstance(layer, str)]
    header["__metadata__"] = {**model.said["facts"], "activations": ", ".join(words)}
    for place, layer in enumerate(layers):
        if isinstance(layer, str):
            continue
        for name, values in (("weight", layer["weights"]), ("bias", layer["bias"])):
            array = np.array(values, number)
            header[f"{place}.{name}"] = {"dtype": "F64" if number == "<f8" else "F32", "shape": list(array.shape),
                                         "data_offsets": [len(data), len(data) + array.nbytes]}
            data += array.tobytes()
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    return struct.pack("<Q", len(text)) + text + data


# ----------------------------------------------------------------------------------------------------------------------


def answer(asked, source=None):
    """Of a request {"source", "rows", ...} a network; of {"model", "ending"} {"bytes": latin-1 text}. What is wrong with
    a source is {"expected", "found", "path"}."""
    try:
        if np is None:
            raise Missing("numpy")
        if "model" in asked:
            write = {".onnx": onnx_of, ".safetensors": safetensors_of}[asked["ending"]]
            return {"bytes": write(Model(asked["model"]).checked()).decode("latin-1")}
        return read_network(asked, source)
    except Refused as refused:
        return {"expected": refused.expected, "found": refused.found, "path": refused.path,
                "missing": isinstance(refused, Missing)}


def main():
    """Exit code 3: this Python lacks a package."""
    said = answer(json.load(sys.stdin))
    json.dump(said, sys.stdout)
    return 3 if said.get("missing") else 0


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: MIT
"""Headers that lie, a row each: edits of a structured model with a residual and of one with a window. The compiler, certify,
evaluate and block refuse each; block writes nothing. With a hash over all of it (exported/contents_hash.hpp) every edit is
refused; without one, as in headers of before, whatever contradicts itself.
    lies.py SOURCE_DIR PINNQUAD HASH FLIGHT COMPILER [FLAG]..."""
import os
import re
import subprocess
import sys

source, pinnquad, contents_hash, flight, *compiler = sys.argv[1:]


def constant(name):
    return re.compile(r"(static constexpr [^;=]* %s = )([^;]*);" % name)


def edited(name, change):
    """The header with another value of a constant: `change` of its text."""

    def edit(text):
        changed, count = constant(name).subn(lambda found: found.group(1) + change(found.group(2)) + ";", text)
        assert count == 1 and changed != text, name
        return changed

    return edit


def number(place, change):
    """Of a list: the number at this place, from 0."""

    def edit(value):
        found = list(re.finditer(r"-?\d+\.?\d*(?:e[-+]?\d+)?f?", value))
        at = found[place if place >= 0 else len(found) + place]
        new = change(float(at.group().rstrip("f"))) if callable(change) else change
        if not isinstance(new, str):
            new = ("%.9g" % new) if "." in "%.9g" % new or "e" in "%.9g" % new else "%.1f" % new
            new += "f" if at.group().endswith("f") else ""
        return value[: at.start()] + new + value[at.end() :]

    return edit


def all_numbers(change):
    return lambda value: re.sub(r"-?\d+\.?\d*(?:e[-+]?\d+)?(?=f?)", lambda n: change(n.group()), value)


def several(*edits):
    def edit(text):
        for one in edits:
            text = one(text)
        return text

    return edit


def at_places(places, change):
    def edit(value):
        for place in places:
            value = number(place, change)(value)
        return value

    return edit


def swapped(first, second):
    return lambda value: value.replace(first, "\0").replace(second, first).replace("\0", second)


def exchanged(name, other):
    def edit(text):
        one, two = constant(name).search(text).group(2), constant(other).search(text).group(2)
        return edited(other, lambda _: one)(edited(name, lambda _: two)(text))

    return edit


base = 3 + 4 * 17 + 4  # parameters of the affine base: its slopes first; then the residual's bounds
scaled = lambda factor: lambda value: value * factor
negated = all_numbers(lambda n: n[1:] if n.startswith("-") else "-" + n if float(n) else n)

# the compiler's word where there is no hash; None: only a replay of the golden vectors finds it; "": only the hash does
RANGE = "range of a residual is upside down, or not that of the bounds among its"
SIGNS = "a slope sign of the model is not that of the torque"
SLOPE = "a slope of the model is not above"
TIME = "removed lag is no time of 0 to 4 s"
ENVELOPE = "envelope is upside down, or ends where no training"
residual_lies = [
    ("bounds of the residual x 10^6", edited("parameters", at_places(range(base, base + 8), scaled(1e6))), RANGE),
    ("one bound of the residual x 1.01", edited("parameters", number(base + 5, scaled(1.01))), RANGE),
    ("stated range halved", edited("residual_upper", at_places(range(4), scaled(0.5))), RANGE),
    ("stated range 1e30", edited("residual_lower", lambda _: "{{-1e30f, -1e30f, -1e30f, -1e30f}}"), RANGE),
    ("slope signs negated", edited("slope_signs", negated), SIGNS),
    ("slope 1e-45", edited("parameters", number(1, "1e-45f")), None),
    ("slope 0", edited("parameters", number(1, "0.0f")), SLOPE),
    ("slope negative", edited("parameters", number(0, scaled(-1))), SLOPE),
    ("frame", edited("frame", lambda _: '"body FLU, world ENU"'), "trained in other frames"),
    ("lag -3", edited("lag_removed_s", lambda _: "-3.0"), TIME),
    ("lag NaN", edited("lag_removed_s", lambda _: "std::numeric_limits<double>::quiet_NaN()"), TIME),
    ("envelope reversed", exchanged("envelope_lower", "envelope_upper"), ENVELOPE),
    ("envelope 1e30", edited("envelope_upper", number(4, "1e30f")), ENVELOPE),
    ("golden command off", edited("golden_commands", number(0, scaled(1.001))), None),
    ("golden feature NaN", edited("golden_features", number(3, "std::numeric_limits<float>::quiet_NaN()")),
     "golden vector lies outside"),
    ("parameter edited", edited("parameters", number(3, scaled(1.05))), None),
    # one that moves no golden command by more than rounding
    ("last parameter edited", edited("parameters", number(-1, scaled(1.05))), ""),
    ("input spread 0", edited("input", number(22, "0.0f")), "standard deviation is not positive"),
    ("input spread negative", edited("input", number(22, scaled(-1))), "standard deviation is not positive"),
    ("output spread doubled", edited("output", at_places(range(4, 8), scaled(2))), RANGE),
    ("allocation edited", edited("allocation", number(1, scaled(1.00001))), "trained for another allocation"),
    ("motor order edited", edited("motor_torque_signs", number(0, "1")), "trained with another motor order"),
    ("feature names swapped", edited("feature_names", swapped('"wdot_x"', '"wdot_y"')), "trained on other features"),
    ("output names swapped", edited("output_names", swapped('"roll_sum"', '"yaw_sum"')), "has other outputs"),
    ("window taps", edited("window_taps", lambda _: "3"), "has another window"),
    ("command range swapped", exchanged("command_lower", "command_upper"), "range of the model's commands is none"),
    ("sample period", edited("sample_period_s", lambda _: "0.01"), ""),  # of a model without window: nothing else says it
    ("judgement", edited("beats_linear_regression", lambda _: "false"), ""),
]
window_lies = [
    ("window taps", edited("window_taps", lambda _: "3"), "has another window"),
    ("window not causal", edited("causal", lambda _: "false"), "has another window"),
    ("period of the window", edited("sample_period_s", lambda _: "0.02"), "sample period is another"),
    ("columns", edited("column_names", lambda _: '{{"air_speed"}}'), "has other extra columns"),
    ("distance limit NaN", edited("distance_limit", lambda _: "std::numeric_limits<double>::quiet_NaN()"),
     "statistics of a distance"),
    ("distance limit negative", edited("distance_limit", lambda _: "-8.5"), "statistics of a distance"),
    ("distance mean outside", edited("distance_mean", number(0, "1000000.0")), "statistics of a distance"),
    ("distance diagonal negative", edited("distance_inverse_cholesky", number(0, scaled(-1))), "statistics of a distance"),
]
airframe_lies = [
    ("mass", lambda text: text.replace("a.mass_kg = Scalar(1.5)", "a.mass_kg = Scalar(1.6)")),
    ("inertia", lambda text: text.replace("Scalar(0.01469)", "Scalar(0.01470)")),
    ("rotor", lambda text: text.replace("{Scalar(0.243952), Scalar(0.243952)", "{Scalar(0.25), Scalar(0.243952)")),
]
believed = 0


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    return done.returncode, done.stdout + done.stderr


def expect(right, what, said):
    global believed
    if right:
        return
    believed += 1
    print("BELIEVED: %s\n%s" % (what, said))


def tell(what, text, message, by_program=True, compiled=True):
    with open("lie.hpp", "w") as file:
        file.write(text)
    if compiled:
        code, said = run([*compiler, "lie.hpp"])
        errors = "\n".join(line for line in said.split("\n") if "error" in line)
        expect(code != 0 and message in errors, what + ": compiler", said)
    if not by_program:
        return
    commands = [["block", "lie.hpp", "--out", "lie.block"], ["certify", "lie.hpp"], ["evaluate", "lie.hpp", "--flight", flight]]
    for command in commands:
        code, said = run([pinnquad, *command])
        expect(code == 2 and said.count("\n") == 1, what + ": " + command[0], said)
    expect(not os.path.exists("lie.block"), what + ": a block was written", "")
    if os.path.exists("lie.block"):
        os.remove("lie.block")


def header(path):
    return open(os.path.join(source, path)).read()


# every header includes what flies: compiled once for all of them
with open("precompiled.hpp", "w") as file:
    file.write("#include <pinnquad/flight.hpp>\n")
code, said = run([*compiler, "-x", "c++-header", "precompiled.hpp", "-o", "precompiled.hpp.gch"])
expect(code == 0, "what flies", said)
compiler += ["-fsyntax-only", "-include", "precompiled.hpp", "-x", "c++"]

EDITED = "was edited since it was exported"
ends = [text for text in (header("tests/models/v3/near_ground_quadrotor.hpp"), header("tests/models/v3/own_racer.hpp"))]
bare, window = ends
hash_line = "  static constexpr std::uint64_t contents_hash = %s;\n" % contents_hash
hashed = bare.replace("};\n\nstatic_assert(pinnquad::require_model<", hash_line + "};\n\nstatic_assert(pinnquad::require_model<")
for name, text in ("without a hash", bare), ("with it", hashed), ("with a window", window):
    with open("truth.hpp", "w") as file:
        file.write(text)
    for command in [[*compiler, "truth.hpp"], [pinnquad, "block", "truth.hpp", "--out", "truth.block"]]:
        code, said = run(command)
        expect(code == 0, "the truth, " + name, said)
for name, edit, message in residual_lies:
    tell(name, edit(hashed), EDITED)
    if message != "":
        tell(name + ", no hash", edit(bare), message or "", compiled=message is not None)
for name, edit, message in window_lies:
    # its features are of no kind that the program knows: it can't tell what their window is
    tell(name + ", no hash", edit(window), message, by_program=name.startswith("distance"))
for name, edit in airframe_lies:
    assert edit(hashed) != hashed
    tell("airframe: " + name, edit(hashed), EDITED)
print("%d lies believed" % believed)
sys.exit(believed != 0)

# SPDX-License-Identifier: MIT
"""Headers and blocks that lie are refused: headers, edits of a structured model with a residual and of one with a
window, a row each, by the compiler; blocks by certify and evaluate. The hash over all of a header
(exported/contents_hash.hpp) refuses every edit; what the compiler names besides is in compile_fail."""
import os
import re
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from conftest import SOURCE, Program


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


def at_places(places, change):
    def edit(value):
        for place in places:
            value = number(place, change)(value)
        return value

    return edit


def exchanged(name, other):
    def edit(text):
        one, two = constant(name).search(text).group(2), constant(other).search(text).group(2)
        return edited(other, lambda _: one)(edited(name, lambda _: two)(text))

    return edit


base = 3 + 4 * 17 + 4  # parameters of the affine base: its slopes first; then the residual's bounds
scaled = lambda factor: lambda value: value * factor

def other(before, now):
    return lambda text: text.replace(before, now, 1)


# edits of a header, and what the compiler names besides; "": the hash alone
LIES = {
    "bounds of the residual x 10^6": (edited("parameters", at_places(range(base, base + 8), scaled(1e6))), ""),
    "one bound of the residual x 1.01": (edited("parameters", number(base + 5, scaled(1.01))), ""),
    "golden command off": (edited("golden_commands", number(0, scaled(1.001))), ""),
    "parameter edited": (edited("parameters", number(3, scaled(1.05))), ""),
    # one that moves no golden command by more than rounding
    "last parameter edited": (edited("parameters", number(-1, scaled(1.05))), ""),
    "input spread 0": (edited("input", number(22, "0.0f")), "standard deviation is not positive"),
    "envelope reversed": (exchanged("envelope_lower", "envelope_upper"), "envelope is upside down"),
    "output spread doubled": (edited("output", at_places(range(4, 8), scaled(2))), ""),
    "allocation edited": (edited("allocation", number(1, scaled(1.00001))), "trained for another allocation"),
    "a rotor that turns the other way": (other("Spin::clockwise", "Spin::counter_clockwise"), "trained for another shape"),
    "sample period": (edited("sample_period_s", lambda _: "0.01"), ""),
    "judgement": (edited("beats_linear_regression", lambda _: "false"), ""),
    "mass": (other("a.mass_kg = Scalar(1.5)", "a.mass_kg = Scalar(1.6)"), ""),
    "inertia": (other("Scalar(0.01469)", "Scalar(0.01470)"), ""),
    "rotor": (other("{Scalar(0.243952), Scalar(0.243952)", "{Scalar(0.25), Scalar(0.243952)"), ""),
}

EDITED = "was edited since it was exported"
PRECOMPILED = "precompiled.hpp"  # what flies, which every header includes


@pytest.fixture(scope="module")
def checked(compiler, tmp_path_factory):
    """checked(header, code): the errors of a compiler that has what flies."""
    folder = tmp_path_factory.mktemp("precompiled")
    (folder / PRECOMPILED).write_text("#include <pinnquad/flight.hpp>\n")
    compiler(f"-x c++-header {PRECOMPILED} -o {PRECOMPILED}.gch", cwd=folder)
    whole = Program(*compiler.words, "-fsyntax-only", "-include", folder / PRECOMPILED, "-x", "c++")

    def errors(header, code):
        said = whole("", header, code=code, env={**os.environ, "LC_ALL": "C"}).err
        return "\n".join(line for line in said.split("\n") if "error" in line)

    return errors


RESIDUAL = (SOURCE / "tests/models/near_ground_quadrotor.hpp").read_text()
WINDOW = (SOURCE / "tests/models/own_racer.hpp").read_text()


def test_truth(checked):
    for text in RESIDUAL, WINDOW:
        Path("truth.hpp").write_text(text)
        checked("truth.hpp", 0)


def test_headers(checked, work):
    period = edited("sample_period_s", lambda _: "0.02")(WINDOW)
    told = [("period of the window", period, "sample period is another")]
    told += [(name, edit(RESIDUAL), message) for name, (edit, message) in LIES.items()]

    def believed(lie):
        name, text, message = lie
        file = work / f"{name}.hpp"
        file.write_text(text)
        try:
            said = checked(file, 1)
            assert EDITED in said and message in said
        except AssertionError as fault:
            return f"{name}: {fault}"

    assert RESIDUAL not in [text for _, text, _ in told]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [fault for fault in pool.map(believed, told) if fault]
    assert not found, "\n".join(found)


def test_blocks(pinnquad, flown):
    """Bytes of header, records, scalers and weights are others under a right checksum (all bytes: exported room)."""
    block, flight = (SOURCE / "tests/models/near_ground_quadrotor.block").read_bytes(), flown("--seed 3 --samples 300")
    for place in (12, 40, 90, 300, len(block) // 2, len(block) - 100, len(block) - 7):
        lie = bytearray(block[:-4])
        lie[place] ^= 1
        Path("lie.block").write_bytes(bytes(lie) + zlib.crc32(lie).to_bytes(4, "little"))
        for words in ("certify lie.block",), ("evaluate lie.block", flight):
            pinnquad.refused(*words, at="lie.block")

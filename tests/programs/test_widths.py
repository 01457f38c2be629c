# SPDX-License-Identifier: MIT
"""No line that a command prints is wider than 100 columns, on a terminal nor in a file; the verdict comes first."""
import re
from pathlib import Path

import pytest
from conftest import SOURCE, on_terminal
from made_logs import FLIGHT_MAPPING

MODELS = SOURCE / "examples/models"
WIDEST = 100


@pytest.fixture(scope="module")
def trained(made, flown):
    flight = flown("--seed 3 --samples 3000")
    return made(f"train {flight} --models structured,ridge --seeds 1 --out ."), flight


@pytest.mark.parametrize("words", [
    "fly d1 --samples 200 --out f.csv", "import {flight} --mapping mine.toml --out logs", "identify {flight}", "evaluate {model} {flight}",
    "certify {model}", f"certify --seconds 0.5 {MODELS}/demo_quadrotor.block", "loop {model}",
    "loop {model} --controllers pid,formula,indi,structured,adaptive --conditions calm,gusts,payload,weak_rotor,battery,wind_8",
    "loop --vehicles 1 --controllers start --out flown", "block {model}", "convert {flight} --out features.toml",
    "airframe list", "airframe check light_quadrotor", "import --list", "replay {flight} --model {model}",
    "train {flight} --models structured,paper_vanilla --epochs 2 --seeds 1 --out trained --verbose", "train {flight} --models linear --seeds 1 --out a"])
def test_width(pinnquad, trained, words):
    folder, flight = trained
    Path("mine.toml").write_text(FLIGHT_MAPPING)
    words = words.format(flight=flight, model=folder / "model.block")
    code, out = on_terminal([str(pinnquad), *words.split()])
    assert code in (0, 1), out
    names = (str(folder), str(flight), str(SOURCE))  # a path may be as long as it is: it is not broken

    def shortened(line):
        for name in names:
            line = line.replace(name, "")
        return line

    assert [line for line in map(shortened, out.splitlines()) if len(line) > WIDEST] == []
    if words.split()[0] in ("certify", "train", "identify", "loop") and "--vehicles" not in words:
        first = out.split("\n\n")[-1] if words.startswith("train") else out
        assert first.startswith("verdict "), first
        assert re.match(r"verdict +(fit for simulation and bench|fly with care|do not fly): ", first), first
        assert re.search("^next +[a-z]", first, re.M), first


def test_a_terminal_gets_warnings_wrapped(pinnquad):
    """One line in a file; on a terminal no wider than the rest."""
    command = [str(pinnquad), "train", "nothing-" + "that-is " * 20]
    assert len(pinnquad.run(*command[1:]).lines) == 1
    said = on_terminal(command, "stderr")[1].splitlines()
    assert len(said) > 1 and all(len(line) <= WIDEST for line in said), said

# SPDX-License-Identifier: MIT
"""The module in builds for several instruction sets: the best that runs here, or the one that is asked for."""
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import MODELS

import pinnquad
from pinnquad import _core

SETS = {"x86-64": "baseline x86-64 (SSE2)", "x86-64-v3": "AVX2 + FMA", "x86-64-v4": "AVX-512"}
PROGRAM = f"""
import numpy, pinnquad, sys
print(pinnquad.instruction_set)
model = pinnquad.Model.load({str(MODELS / "demo_quadrotor.block")!r})
x = numpy.random.default_rng(1).uniform(*model.envelope, (37, 16)).astype(numpy.float32)
many = model.predict(x)
vehicles = pinnquad.Vehicles(11)
vehicles.step(numpy.tile(vehicles.hover_commands() * 1.01, (11, 1)), 0.1)
numpy.savez(sys.argv[1], many=many, single=[model.predict(row) for row in x], state=vehicles.state)
"""


def said_with(wanted, *words):
    return subprocess.run([sys.executable, "-c", PROGRAM, *map(str, words)], capture_output=True, text=True,
                          env={**os.environ, "PINNQUAD_INSTRUCTION_SET": wanted})


@pytest.fixture(scope="module")
def sets():
    """Those that the module is built for and that run here, the best first."""
    if not Path(_core.__file__).with_name("_core-x86-64.so").exists():
        pytest.skip("the module is built for one instruction set")
    refused = said_with("none")
    assert refused.returncode == 1
    line = refused.stderr.strip().split("\n")[-1]
    assert line.startswith("ImportError: PINNQUAD_INSTRUCTION_SET is 'none'; here run: ")
    return line.split(": ")[2].split(", ")


def test_the_best_is_taken(sets):
    if "PINNQUAD_INSTRUCTION_SET" in os.environ:
        pytest.skip("PINNQUAD_INSTRUCTION_SET is set")
    assert pinnquad.instruction_set == SETS[sets[0]]


def test_sets_agree(sets, tmp_path):
    answers = {}
    for name in sets:
        said = said_with(name, tmp_path / f"{name}.npz")
        assert said.stdout == SETS[name] + "\n", said.stderr
        answers[name] = np.load(tmp_path / f"{name}.npz")
    for name, found in answers.items():
        np.testing.assert_allclose(found["many"], answers["x86-64"]["many"], atol=1e-5, err_msg=name)
        np.testing.assert_allclose(found["single"], found["many"], atol=1e-5, err_msg=name)
        np.testing.assert_array_equal(found["state"], answers["x86-64"]["state"], err_msg=name)

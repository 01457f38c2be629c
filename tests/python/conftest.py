# SPDX-License-Identifier: MIT
"""What the tests of the Python package share. scripts/heavy/python installs it in a venv and runs them; --program is
the program pinnquad, to compare with."""
import subprocess
from pathlib import Path

import pytest

import pinnquad

SOURCE = Path(__file__).resolve().parents[2]
MODELS = SOURCE / "examples/models"


def pytest_addoption(parser):
    parser.addoption("--program", help="the program pinnquad; what compares with it is skipped without")


@pytest.fixture(scope="session")
def program(request):
    """Runs the program, and returns what it printed; `fails`: it may, as with a model that may not fly."""
    path = request.config.getoption("--program")
    if not path:
        pytest.skip("--program does not say where the program is")

    def run(*words, fails=False):
        return subprocess.run([path, *map(str, words)], check=not fails, capture_output=True, text=True).stdout

    return run


@pytest.fixture(scope="session")
def flight():
    """Two minutes of the paper's D1."""
    return pinnquad.fly("d1", seed=1, rows=2400)


@pytest.fixture(scope="session")
def trained(flight):
    """The structured model alone, a first look."""
    return pinnquad.train(flight, models=["structured"], seeds=1, epochs=2)


@pytest.fixture(scope="session")
def structured():
    return pinnquad.Model.load(MODELS / "structured_quadrotor.block")


@pytest.fixture(scope="session")
def network():
    return pinnquad.Model.load(MODELS / "demo_quadrotor.block")

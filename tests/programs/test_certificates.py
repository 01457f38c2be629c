# SPDX-License-Identifier: MIT
"""What certify says of every exported model in the tree: a row each, and no model without one."""
import json

import pytest
from conftest import SOURCE

# exit code: 0 proven, 1 refuted; 2: no block stands beside it
MODELS = {
    "examples/models/crazyflie_2_1.hpp": 1,
    "examples/models/demo_quadrotor.hpp": 1,
    "examples/models/model.hpp": 2,  # the demo's under another name
    "examples/models/structured_quadrotor.hpp": 0,
    "tests/models/near_ground_quadrotor.hpp": 0,
    "tests/models/own_racer.hpp": 1,
    "tests/support/small_model.hpp": 2,
}


@pytest.mark.parametrize("model, code", MODELS.items())
def test_certificate(pinnquad, flags, model, code):
    if code == 2:
        pinnquad.refused("certify --json", SOURCE / model, keyword=".block")
        return
    said = json.loads(pinnquad("certify --json", SOURCE / model, code=code).out)
    assert said["verdict"] == ("counterexample" if code else "proven")
    # of the processor, to refute one
    assert not code or said["seconds"] < (30 if any("sanitize" in flag for flag in flags) else 1)


def test_every_model_has_a_row():
    found = [SOURCE / "tests/support/small_model.hpp"]
    for folder in "examples/models", "tests/models":
        found += [path for path in (SOURCE / folder).glob("*.hpp") if path.name != "known_predictions.hpp"]
    assert sorted(str(path.relative_to(SOURCE)) for path in found) == sorted(MODELS)

# SPDX-License-Identifier: MIT
"""An airframe that no library knows: unequal arms, the centre of gravity off the middle."""
import json
import re
from pathlib import Path

import pytest
from conftest import report_of

ASYMMETRIC = """name = "asym"
mass_kg = 1.2
inertia_kg_m2 = [0.011, 0.016, 0.024]
thrust_coefficient = 0.11
power_coefficient = 0.05
propeller_diameter_m = 0.25
max_rotor_speed_rev_s = 110.0
rotor_time_constant_s = 0.035
drag_area_m2 = [0.02, 0.025, 0.035]
drag_deadband_m_s = 0.0
""" + "".join(f"""
[[rotor]]
x_m = {x}
y_m = {y}
spin = "{spin}"
""" for x, y, spin in ((0.12, 0.17, "counter_clockwise"), (-0.18, -0.14, "counter_clockwise"),
                       (0.105, -0.19, "clockwise"), (-0.17, 0.13, "clockwise")))


@pytest.fixture
def asymmetric():
    """Conyers' ground effect has no fit for it."""
    Path("asym.toml").write_text(ASYMMETRIC)
    return "--airframe asym.toml"


def test_an_asymmetric_vehicle_hovers_near_the_ground(pinnquad, asymmetric):
    said = pinnquad(f"fly d2 {asymmetric} --samples 300 --out near.csv").out
    assert "ground effect cheeseman-bennett" in said and "conyers, has no fit" in said, said
    pinnquad.refused(f"fly d2 {asymmetric} --ground-effect conyers --samples 300 --out not.csv", keyword="no fit")
    assert not Path("not.csv").exists()


def test_what_flies_worse_than_without_jerk_is_not_exported_without_a_word(pinnquad, asymmetric):
    """The one that errs least leaves the flight to its guard: the best that flies is exported, or header, report and
    terminal say do not fly."""
    pinnquad(f"fly d1 {asymmetric} --seed 11 --interval 20 --samples 9000 --out a.csv")
    words = f"train a.csv {asymmetric} --models physics,ridge,ridge_causal --seeds 1"
    done = pinnquad(f"{words} --export causal --out best")
    report = report_of("best")
    assert report["models"]["ridge_causal"]["r2"]["mean"] > report["models"]["ridge"]["r2"]["mean"] > 0.9
    loop = report["closed_loop"]
    assert report["exported_model"] != "ridge_causal" and loop["model"]["rmse_m"] < loop["without_jerk"]["rmse_m"], loop
    assert loop["formula"]["rmse_m"] < 0.5 * loop["without_jerk"]["rmse_m"]
    assert "not fit to fly; the next best is tried" in done.err and "do not fly" not in done.err
    assert "do not fly" not in Path("best/model.hpp").read_text()
    flown = json.loads(pinnquad("loop best/model.block --json").out)
    assert flown["model"]["rmse_m"] == pytest.approx(loop["model"]["rmse_m"])

    done = pinnquad(f"{words} --export ridge_causal --out asked")
    report, comment = report_of("asked"), Path("asked/model.hpp").read_text().split("#pragma once")[0]
    loop = report["closed_loop"]
    assert report["exported_model"] == "ridge_causal" and loop["model"]["rmse_m"] > loop["without_jerk"]["rmse_m"]
    assert re.search("^train: warning: do not fly: .* without the path's jerk .* cm", done.err, re.M), done
    assert any("do not fly" in warning for warning in report["warnings"])
    assert comment.splitlines()[2].startswith("// do not fly: ") and "without the path's jerk" in comment
    assert all(len(line) <= 120 for line in comment.splitlines())
    assert "do not fly" in Path("asked/report.html").read_text()

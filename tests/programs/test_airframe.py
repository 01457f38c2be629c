# SPDX-License-Identifier: MIT
"""Airframes listed, checked and converted: a converted one flies the same flight, bit for bit, from its file and from
its struct."""
import re
from pathlib import Path

import pytest
from conftest import no_partial_files, replaced, same_bytes

BODY = """name = "a \\"tilted\\" \\\\ one"
mass_kg = 1.0
inertia_kg_m2 = [0.01, 0.012, 0.02]
inertia_products_kg_m2 = [1e-04, 0.0, -2e-04]
thrust_coefficient = 0.1
power_coefficient = 0.05
propeller_diameter_m = 0.25
max_rotor_speed_rev_s = 150.0
rotor_time_constant_s = 0.05
"""
ROTOR = """[[rotor]]
x_m = {}
y_m = {}
spin = "{}clockwise"
z_m = 0.02
axis = [0.0, 0.6, -0.8]
thrust_scale = 1.1
thrust_curve = 0.3
rise_time_constant_s = 0.04
fall_time_constant_s = 0.06
"""
CORNERS = [(0.1, 0.1, "counter_"), (-0.1, -0.1, "counter_"), (0.1, -0.1, ""), (-0.1, 0.1, "")]


@pytest.fixture
def tilted(work):
    """What a file may say and a plain quadrotor does not."""
    Path("tilted.toml").write_text(BODY + "".join(ROTOR.format(*corner) for corner in CORNERS))


def test_from_file_and_by_name(pinnquad):
    listed = pinnquad("airframe list").out
    assert pinnquad("fly --list-airframes").out == listed
    names = [line.split()[0] for line in listed.splitlines()[::2]]
    assert len(names) >= 5, names
    for name in names:
        pinnquad(f"airframe convert {name} --out {name}.toml")
        by_file, by_name = (pinnquad(f"airframe check {which}").out.splitlines() for which in (f"{name}.toml", name))
        assert by_file[1:] == by_name[1:] and len(by_name) == 5, name  # a line, and one per rotor
        pinnquad(f"fly --airframe {name} --samples 30 --out by_name.csv")
        pinnquad(f"fly --airframe {name}.toml --samples 30 --out by_file.csv")
        same_bytes("by_name.csv", "by_file.csv")
        pinnquad(f"airframe convert {name}.toml --out again.toml")
        same_bytes(f"{name}.toml", "again.toml")
    assert pinnquad("airframe check racer_5_inch").out.startswith("racer_5_inch: 0.752 kg")


def test_tilted(pinnquad, tilted, compiler):
    pinnquad("airframe convert tilted.toml --out once.toml")
    pinnquad("airframe convert once.toml --out twice.toml")
    same_bytes("once.toml", "twice.toml")
    once = Path("once.toml").read_text().splitlines()
    for line in (BODY + ROTOR).splitlines():
        if re.match("name|inertia_products|axis|thrust_scale|thrust_curve|z_m|rise|fall", line):
            assert line in once, f"lost: {line}"
    pinnquad("airframe convert tilted.toml --out tilted.hpp --name Tilted")
    Path("tilted.cpp").write_text('#include "tilted.hpp"\nstatic_assert(pinnquad::is_airframe<Tilted>);\n'
                                  "static_assert(Tilted::value<double>().rotors[2].thrust_scale == 1.1);\n")
    compiler("-fsyntax-only -I. tilted.cpp")


@pytest.mark.parametrize("words, at, keyword", [
    ("check zeppelin", "", "'zeppelin'"), ("check none.toml", "none.toml", "found none"),
    ("convert tilted.toml --out third.hpp --name 3rd", "", "'3rd'"), ("convert tilted.toml --out tilted.txt", "",
                                                                      ".hpp"),
    ("convert tilted.toml --out ./tilted.toml", "", "same file"),
    ("convert tilted.toml --out absent/a.toml", "absent/a.toml", "cannot write"), ("", "", "expected a command"),
    ("check broken.toml", "broken.toml:2:11", "above 0")])
def test_refused(pinnquad, tilted, words, at, keyword):
    before = Path("tilted.toml").read_bytes()
    replaced("tilted.toml", "broken.toml", ("^mass_kg = .*", "mass_kg = -1"))
    pinnquad.refused(f"airframe {words}", at=at, keyword=keyword)
    assert Path("tilted.toml").read_bytes() == before, "the input was overwritten"
    assert sorted(path.name for path in Path().iterdir()) == ["broken.toml", "tilted.toml"]
    no_partial_files()

# SPDX-License-Identifier: MIT
"""block writes from a header's text what the library writes from its types, byte by byte; evaluate then judges it."""
import re
import shutil
from pathlib import Path

import pytest
from conftest import SOURCE, replaced, same_bytes

HEADERS = {
    "demo_quadrotor": "examples/models/demo_quadrotor.hpp",
    "crazyflie_2_1": "examples/models/crazyflie_2_1.hpp",
    "crazyflie_tanh": "tests/models/v2/crazyflie_tanh.hpp",
    "v3_demo_quadrotor": "tests/models/v3/demo_quadrotor.hpp",
    "v3_own_racer": "tests/models/v3/own_racer.hpp",
}


@pytest.fixture(scope="module")
def library(program, tmp_path_factory):
    """Blocks that the library writes from the headers' types."""
    folder = tmp_path_factory.mktemp("library")
    program("block_driver")("", folder)
    return folder


@pytest.mark.parametrize("name", HEADERS)
def test_same_bytes(pinnquad, library, name):
    said = pinnquad("block", SOURCE / HEADERS[name], "--out", "text.block").out
    same_bytes(library / f"{name}.block", "text.block")
    assert f"{Path('text.block').stat().st_size} bytes" in said, said


def test_evaluated(pinnquad, library, flown):
    flight = flown("--seed 9 --samples 500")
    judged = pinnquad("evaluate --json", library / "demo_quadrotor.block", "--flight", flight, code=(0, 1)).out
    assert '"airframe": "paper_quadrotor"' in judged
    tanh = library / "crazyflie_tanh.block"
    pinnquad.refused("evaluate", tanh, "--flight", flight, at="crazyflie_tanh.block", keyword="167 parameters")
    answer = re.search("using Network = (.*);", (SOURCE / HEADERS["crazyflie_tanh"]).read_text()).group(1)
    assert "pinnquad::Tanh" in pinnquad("evaluate", tanh, "--flight", flight, "--answer", answer, code=(0, 1)).out
    pinnquad.refused("evaluate", library / "v3_own_racer.block", "--flight", flight, keyword="shape is unknown")


@pytest.mark.parametrize("place, keyword, pattern, new", [
    (":*", "found 4", "format_version = 3", "format_version = 4"), (":*", "`moon`", '"answer", "commands"',
                                                                    '"moon", "commands"'),
    (":49", "`low`", "command_lower = 0.0", "command_lower = low"), ("", "`answer`", ".* answer = .*\n", ""),
    (":*", "`body FLU", "body FRD, world NED", "body FLU, world ENU"),
    (":*", "found -3", "lag_removed_s = .*;", "lag_removed_s = -3.0;"),
    (":*", "found 12", ".*7.378601163836665.*\n", "")])
def test_refused(pinnquad, place, keyword, pattern, new):
    """What is no longer a header, and what open() or the self test would refuse (test_lies.py has many): nothing is
    written."""
    replaced(SOURCE / HEADERS["v3_demo_quadrotor"], "changed.hpp", (pattern, new))
    pinnquad.refused("block changed.hpp --out changed.block", at=f"changed.hpp{place}", keyword=keyword)
    assert not Path("changed.block").exists()


def test_no_header(pinnquad, flown):
    shutil.copy(SOURCE / HEADERS["v3_demo_quadrotor"], "model.hpp")
    pinnquad.refused("block none.hpp --out changed.block", at="none.hpp", keyword="found none")
    pinnquad.refused("block --out changed.block", flown("--seed 9 --samples 500"), at="flight.csv", keyword="header")
    pinnquad.refused("block model.hpp --out ./model.hpp", keyword="same file")
    assert not Path("changed.block").exists()


def test_ends_of_lines(pinnquad):
    """A checkout that made them CRLF: the same block."""
    text = (SOURCE / HEADERS["v3_demo_quadrotor"]).read_bytes()
    Path("given.hpp").write_bytes(text)
    Path("changed.hpp").write_bytes(text.replace(b"\n", b"\r\n"))
    for name in "given", "changed":
        pinnquad(f"block {name}.hpp --out {name}.block")
    same_bytes("given.block", "changed.block")

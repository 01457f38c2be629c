# SPDX-License-Identifier: MIT
"""The charts of flights and judgements: the same bytes each time; pictures/check.py looks at them."""
import os
import sys
from pathlib import Path

from conftest import SOURCE, Program, listing, same_bytes


def test_pictures(program):
    driver = program("pictures_driver")
    for folder in "first", "again":
        os.mkdir(folder)
        driver("", folder)
    assert listing("first") == listing("again") != []
    for name in listing("first"):
        same_bytes(Path("first", name), Path("again", name))
    Program(sys.executable)("", SOURCE / "tests/programs/pictures/check.py", "first", SOURCE)

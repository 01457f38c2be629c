# SPDX-License-Identifier: MIT
"""The calls of examples/train.cpp write the bytes that `pinnquad train` writes."""
import shutil
from pathlib import Path

from conftest import no_partial_files, same_bytes


def test_train_from_cpp(pinnquad, program, flown):
    train, flight = program("train"), flown("--seed 3 --samples 9000")
    shutil.copy(flight, "flight.csv")
    pinnquad("train --flight flight.csv --out a --name MyModel --loss vanilla --seeds 1 "
             "--epochs 20")
    said = train("b flight.csv").out
    for file in "model.hpp", "model.block", "trust.hpp":
        same_bytes(f"a/{file}", f"b/{file}")
    assert said.startswith("test rows: R^2 0.9") or "\ntest rows: R^2 0.9" in said, said

    # too few validation rows: limits of an earlier export do not stay
    Path("short.csv").write_text("".join(Path("flight.csv").read_text().splitlines(True)[:3001]))
    assert "no trust.hpp: " in train("b short.csv").out
    assert not Path("b/trust.hpp").exists()

    # all or nothing
    before = Path("b/model.hpp").read_bytes()
    Path("b/model.block").unlink()
    Path("b/model.block").mkdir()
    train.refused("b flight.csv", code=1, keyword="is a folder")
    assert Path("b/model.hpp").read_bytes() == before, "a header was written without its block"
    assert not Path("b/trust.hpp").exists()
    no_partial_files("b")

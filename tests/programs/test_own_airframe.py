# SPDX-License-Identifier: MIT
"""An airframe that no library knows: from its file to a flight, a training, and a header that flies without file or
trainer."""
from pathlib import Path

from conftest import SOURCE, Program, replaced

TRAIN = "train --flight flight.csv --seeds 1 --epochs 2 --threads 1 --allow-poor"


def test_own_airframe(pinnquad, compiler, flags):
    replaced(SOURCE / "examples/airframes/paper_quadrotor.toml", "mine.toml",
             ("^name = .*", r'name = "my \\"own\\" quad"'), ("^mass_kg = .*", "mass_kg = 1.31"))
    pinnquad("fly --airframe mine.toml --seed 3 --samples 2500 --out flight.csv")
    pinnquad(f"{TRAIN} --airframe mine.toml --out a")
    header = Path("a/model.hpp").read_text()
    assert "using Vehicle = TrainedQuadModelAirframe;" in header
    assert 'vehicle_name = "my \\"own\\" quad";' in header
    assert '"airframe": "my \\"own\\" quad"' in Path("a/report.json").read_text()

    compiler(*flags, "-O1", "-DPINNQUAD_INLINE_AS_COMPILER_LIKES", "-Ia",
             SOURCE / "tests/programs/own_airframe/replay.cpp", "-o", "replay")
    Program("./replay")("a/replay.txt a/model.block")
    # the weights of the same training for the library's airframe are those of another vehicle
    pinnquad(f"{TRAIN} --airframe paper_quadrotor --out b")
    assert "block: block_incompatible" in Program("./replay")("a/replay.txt b/model.block", code=1).out

    replaced("mine.toml", "broken.toml", ("^mass_kg = .*", "mass_kg = -1"))
    pinnquad.refused("train --flight flight.csv --airframe broken.toml --out c", at="broken.toml:*:*",
                     keyword="above 0")
    pinnquad.refused("train --flight flight.csv --airframe none.toml --out c", at="none.toml", keyword="found none")

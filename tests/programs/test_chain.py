# SPDX-License-Identifier: MIT
"""fly -> train -> judge -> export, small; and the same seed gives the same bits. own_airframe compiles an export."""
import re
from pathlib import Path

import pytest
from conftest import report_of, same_bytes

PARTS = "part_1.csv part_2.csv part_3.csv"


@pytest.fixture(scope="module")
def flight(flown):
    return flown("--seed 3 --samples 3000")


@pytest.fixture(scope="module")
def other(flown):
    return flown("--seed 4 --samples 3000")


@pytest.fixture(scope="module")
def trained(pinnquad, flight, tmp_path_factory):
    """A folder, and what train said of it."""
    folder = tmp_path_factory.mktemp("trained")
    return folder, pinnquad(f"train {flight} --seeds 2 --epochs 8 --threads 2 --out . --verbose", cwd=folder)


def test_trained(pinnquad, trained):
    folder, done = trained
    rows = [re.search(rf"^  {model} +-?\d.*$", done.out, re.M).group() for model in
            ("structured", "paper_vanilla", "paper_physics_informed", "formula of the airframe")]
    assert len({row.rstrip().rfind(".") for row in rows}) == 1, "the table's columns do not stand below each other"
    assert done.flat.count("1 held-out flight can't tell") >= 1, "one flight decided"
    assert "proven more angular acceleration asked is more torque" in done.flat
    assert done.out.index("\nverdict ") < done.out.index("\nnext ") < done.out.index("\nmodels ")
    pinnquad("certify", folder / "model.hpp")
    for file in ["results.csv", "report.json", "report.html", "model.hpp", "model.block", "replay.txt"]:
        assert (folder / file).stat().st_size, file
    page = (folder / "report.html").read_text()
    for text in ["the end of", "What is proven, and when not to trust it", "over the airframe’s own in hover",
                 "No limits of trust beside the envelope", "paper_physics_informed"]:
        assert text in page, text
    assert "{{" not in page and "looking ahead" not in page and "nan" not in page
    # a header, the linearized model, 4 networks and 2 structured models
    assert len((folder / "results.csv").read_text().splitlines()) == 8


def test_same_bits(pinnquad, flight, other, trained):
    """Whatever the number of threads."""
    assert len(flight.read_text().splitlines()) == 3001
    pinnquad("fly --seed 3 --samples 3000 --out again.csv")
    same_bytes(flight, "again.csv")
    assert flight.read_bytes() != other.read_bytes(), "another seed flew the same flight"
    pinnquad(f"train {flight} --out b --seeds 2 --epochs 8 --threads 1")
    for file in "model.hpp", "model.block":
        same_bytes(trained[0] / file, f"b/{file}")


def test_several_flights(pinnquad, flight, other):
    """Whole ones train, validate and test."""
    header, *rows = flight.read_text().splitlines(True)
    for part in 1, 2, 3:
        Path(f"part_{part}.csv").write_text(header + "".join(rows[1000 * (part - 1) : 1000 * part]))
    said = pinnquad(f"train {PARTS} --out d --seeds 1 --epochs 2 --allow-poor").out
    for text in "held out: part_3.csv (1000 rows)", "validate: part_2.csv (1000 rows)", "train: part_1.csv (1000 rows)":
        assert text in said, said
    assert 'training_data = "part_1.csv"' in Path("d/model.hpp").read_text()
    first, *replayed = Path("d/replay.txt").read_text().splitlines()
    assert first == "pinnquad-replay 1 1000 24"
    flown = [[float(u) for u in row.split(",")[17:21]] for row in rows[2000:]]  # of part_3.csv, which is held out
    assert [[float(u) for u in line.split()[-4:]] for line in replayed] == flown
    (fold,) = report_of("d")["folds"]
    assert (fold["train"], fold["validation"], fold["held_out"]) == (["part_1.csv"], ["part_2.csv"], ["part_3.csv"])
    # two of them named, and each in its turn: the export is fitted to all, and no flight decides alone
    pinnquad(f"train {PARTS} --hold-out part_1.csv --out n --seeds 1 --epochs 2 --allow-poor --models constant,linear")
    assert report_of("n")["held_out"] == ["part_1.csv"]
    pinnquad(f"train {PARTS} --hold-out-each flight --models small_vanilla,small_physics_informed --out n --seeds 1 --epochs 2 --allow-poor")
    each = report_of("n")
    assert len(each["folds"]) == 3 and each["exported_model"] == "small_physics_informed"
    pinnquad.refused(f"train --out e part_1.csv {other}", keyword="3 flights")
    pinnquad.refused("train --out e part_1.csv part_1.csv part_2.csv", keyword="same flight")
    pinnquad.refused("train --out e part_1.csv part_2.csv", keyword="2200 rows")

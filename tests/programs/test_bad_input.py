# SPDX-License-Identifier: MIT
"""Bad input: one line that says where and what, exit code 2, nothing written."""
import json
import os
from pathlib import Path

import pytest
from conftest import SOURCE, cell, column, edited, replaced

TRAIN = "train --out out --epochs 1 --seeds 1"


@pytest.fixture(scope="module")
def good(flown):
    return flown("--seed 1 --samples 2400")


@pytest.fixture(autouse=True)
def empty_folder(work):
    """Which every refused command leaves empty."""
    Path("out").mkdir()
    yield
    assert not os.listdir("out")


def first(lines):
    return lambda line, cells: None if line <= lines else False


def still_gyro(line, cells):
    """An attitude that turns slowly: no degrees."""
    if line > 1:
        for at in 11, 12, 14, 15:
            cells[at - 1] = 0
        cells[12], cells[15] = 0.5, float(cells[0]) * 0.5 / 57.3


@pytest.mark.parametrize("place, keyword, change", [
    ("1", "wdot_x", cell(1, 5, "wrong")), ("7:3", "fast", cell(7, 3, "fast")), ("9:4", "nan", cell(9, 4, "nan")),
    ("9:4", "", cell(9, 4, "")), ("11:*", "", lambda line, cells: cells[:-1] if line == 11 else None),
    ("12:*", "", lambda line, cells: [*cells, "1"] if line == 12 else None), ("1", "", first(0)),
    ("*", "rows", first(1)), ("*", "rows", first(500)), ("3:1", "milliseconds", column(1, to=lambda t: 1000 * t)),
    ("2:11", "w_x", still_gyro)])
def test_flight(pinnquad, good, place, keyword, change):
    edited(good, "bad.csv", change)
    pinnquad.refused(TRAIN, "bad.csv", at=f"bad.csv:{place}", keyword=keyword)


@pytest.mark.parametrize("separator, name", [(";", "semicolons"), ("\t", "tabs")])
def test_separators(pinnquad, good, separator, name):
    edited(good, "bad.csv", lambda line, cells: None, separator)
    pinnquad.refused(TRAIN, "bad.csv", at="bad.csv:1", keyword=name)


@pytest.mark.parametrize("begin, each, end", [("a", ".a", " = 1"), ("[a", ".a", "]"), ("a = ", "[", ""),
                                              ("a = ", "{a = ", ""), ("", "['x'.", ""),
                                              ('a = "x" # .\n"b"', '."b"', " = 1")])
def test_deep_toml(pinnquad, good, begin, each, end):
    """Nested deeper than any parser's stack: TOML of every kind; JSON of a study is in programs.report."""
    Path("deep.toml").write_text(begin + 50000 * each + end + "\n")
    for words in ["fly --out out/f.csv --airframe deep.toml", f"import {good} --out out/d --mapping deep.toml",
                  "airframe check deep.toml", "fly --out out/f.csv --config deep.toml"]:
        pinnquad.refused(words, at="deep.toml:*:*", keyword="64 levels")


def test_json(pinnquad):
    Path("nested").mkdir()
    Path("nested/dataset.json").write_text('{"format": 1, "x": ' + 100000 * '{"a": ')
    pinnquad.refused("train nested --hold-out x --out out/d", at="nested/dataset.json:1:*",
                     keyword="64 levels")
    flight = {"file": "good.csv\0.csv", "name": "", "rows": 1}
    dataset = {"format": 1, "sample_period_s": 0.05, "lag_removed_s": 0, "flights": [flight]}
    Path("nested/dataset.json").write_text(json.dumps(dataset))
    pinnquad.refused("train nested --hold-out x --out out/d", at="nested/dataset.json",
                     keyword="name of a file")


@pytest.mark.parametrize("output", ["out/f.csv", "out/results.csv", "out/model.hpp"])
def test_write_protected(pinnquad, good, output):
    """It stays, though its folder would let it be replaced."""
    Path(output).write_text("kept\n")
    os.chmod(output, 0o444)
    words = ("fly --samples 20 --out", output) if output == "out/f.csv" else (TRAIN, good)
    pinnquad.refused(*words, at=output, keyword="write-protected")
    assert Path(output).read_text() == "kept\n"
    os.remove(output)


@pytest.mark.parametrize("words, at, keyword", [
    (f"{TRAIN} absent.csv", "absent.csv", "found none"),
    ("train FLIGHT --out a_file/out --epochs 1 --seeds 1", "a_file/out", ""),
    ("fly --samples 10 --out a_file/flight.csv", "a_file/flight.csv", ""),
    ("train FLIGHT --airframe zeppelin --out out", "", "'zeppelin'"),
    ("fly --airframe zeppelin --out out/f.csv", "", "'zeppelin'"),
    ("fly --airframe no.toml --out out/f.csv", "no.toml", "found none"),
    ("fly --airframe folder.toml --out out/f.csv", "folder.toml", "folder"),
    ("fly --airframe heavy.toml --out out/f.csv", "heavy.toml:4:11", "truth value"),
    ("train FLIGHT --epochs 0", "", "--epochs"), ("train FLIGHT --name 3rd", "", "--name"),
    ("train FLIGHT --seeds many", "", "--seeds")])
def test_files_and_options(pinnquad, good, words, at, keyword):
    Path("a_file").touch()
    Path("folder.toml").mkdir()
    replaced(SOURCE / "examples/airframes/racer_5_inch.toml", "heavy.toml", ("mass_kg = .*", "mass_kg = true"))
    pinnquad.refused(words.replace("FLIGHT", str(good)), at=at, keyword=keyword)

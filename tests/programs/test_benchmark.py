# SPDX-License-Identifier: MIT
"""Public data sets (tools/study/benchmark.py, pinnquad benchmark): a set of a user's own from import to row, and
predictions of others."""
import csv
import json
import shutil
import sys
from pathlib import Path
from statistics import fmean

import pytest

from conftest import SOURCE, Program
from made_logs import FLIGHT_MAPPING as MAPPING

benchmark = Program(sys.executable, SOURCE / "tools/study/benchmark.py")
SET = """about = "three flights"
url = "here"
licence = "none"
flights = ["*.csv"]
mapping = "mapping.toml"
airframe = "paper_quadrotor"
hold_out = "flight5"
train = ["--models", "constant,ridge"]
"""


def rows_of(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def write_predictions(rows, of, path="mine.csv"):
    lines = ["t,u1,u2,u3,u4"] + [",".join(repr(one) for one in (row["t"], *of(row))) for row in rows]
    Path(path).write_text("\n".join(lines) + "\n")


def test_a_set(pinnquad, flown):
    """The mean of the training commands scores as the program's own row of it; what is right scores 1."""
    Path("copy").mkdir()
    for seed in 3, 4, 5:  # by a clock that counts since 1970
        header, *rows = Path(flown(f"--seed {seed} --samples 2400")).read_text().splitlines()
        later = [f"{1_772_421_802 + float(row.split(',', 1)[0]):.3f},{row.split(',', 1)[1]}" for row in rows]
        Path(f"copy/flight{seed}.csv").write_text("\n".join([header, *later]) + "\n")
    shutil.copy("copy/flight3.csv", "copy/twice.csv")
    Path("mapping.toml").write_text(MAPPING)
    Path("mine.toml").write_text(SET)
    done = benchmark("run", "mine.toml", "copy", "--program", str(pinnquad), "--out", "out")
    assert "twice.csv: left out" in done.out and "cannot write" not in done.err
    report = json.loads(Path("out/model/report.json").read_text())
    ridge, = (one["r2"] for one in report["results"] if one["model"] == "ridge")
    assert f"| out | 3, {report['settings']['rows']} | flight5 |" in done.out and f"| **{ridge:.3f}** |" in done.out
    assert "imported before" in benchmark("run", "mine.toml", "copy", "--program", str(pinnquad), "--out", "out").out

    held_out = rows_of("out/dataset/flight5.csv")
    training = rows_of("out/dataset/flight3.csv") + rows_of("out/dataset/flight4.csv")
    mean = [fmean(one[f"u{motor}"] for one in training) for motor in range(1, 5)]
    truth = lambda row: [row[f"u{motor}"] for motor in range(1, 5)]
    write_predictions(held_out, lambda row: mean)
    pinnquad("benchmark out --predictions mine.csv --name mean")
    write_predictions(held_out, truth)
    shown = pinnquad("benchmark out/ --predictions mine.csv --name truth").out
    others = json.loads(Path("out/others.json").read_text())
    constant, = (one["r2"] for one in report["results"] if one["model"] == "constant")
    assert others["mean"]["r2"] == pytest.approx(constant, abs=0.01)
    assert others["truth"]["r2"] == 1 and others["truth"]["rmse"] == 0 and others["truth"]["rows"] == len(held_out)
    assert "| mean | truth |" in shown and "| out |" in shown and shown.rstrip().endswith("| 1.000 |")
    assert pinnquad("benchmark out").out == shown

    write_predictions(held_out[1:], truth)
    pinnquad.refused("benchmark out --predictions mine.csv", at="mine.csv", keyword="none for 1, the first at t = 177")
    write_predictions([held_out[0], *held_out], truth)
    pinnquad.refused("benchmark out --predictions mine.csv", at="mine.csv:3:1", keyword="a time of its own")
    Path("mine.csv").write_text("t,u1,u2,u3,u4\n0,1,2,3,x\n")
    pinnquad.refused("benchmark out --predictions mine.csv", at="mine.csv:2:5", keyword='"x"')
    Path("mine.csv").write_text("t,u1,u2,u3\n")
    pinnquad.refused("benchmark out --predictions mine.csv", at="mine.csv:1", keyword="u4")
    pinnquad.refused("benchmark out out --predictions mine.csv", keyword="of one set")
    pinnquad.refused("benchmark copy", at="copy/model/report.json", keyword="expected")
    assert json.loads(Path("out/others.json").read_text()) == others


def test_predictions_of_several_flights(pinnquad, flown):
    """A CSV for each flight that is held out."""
    Path("mine").mkdir()
    for seed in 3, 4, 5:
        shutil.copy(flown(f"--seed {seed} --samples 2400"), f"flight{seed}.csv")
    Path("mapping.toml").write_text(MAPPING)
    pinnquad("import flight3.csv flight4.csv flight5.csv --mapping mapping.toml --out out/dataset")
    pinnquad("train out/dataset --airframe paper_quadrotor --models constant,ridge --seeds 1 --hold-out flight4,flight5 "
             "--out out/model")
    for name in "flight4", "flight5":
        rows = rows_of(f"out/dataset/{name}.csv")
        write_predictions(rows, lambda row: [row[f"u{motor}"] for motor in range(1, 5)], f"mine/{name}.csv")
    assert "| 1.000 |" in pinnquad("benchmark out --predictions mine --name truth").out
    pinnquad.refused("benchmark out --predictions mine/flight4.csv", keyword="a folder with NAME.csv")
    Path("mine/flight5.csv").unlink()
    pinnquad.refused("benchmark out --predictions mine", at="mine/flight5.csv", keyword="expected")
    report = json.loads(Path("out/model/report.json").read_text())
    for key in "held_out", "settings", "results":
        Path("out/model/report.json").write_text(json.dumps({**report, key: 3}))
        pinnquad.refused("benchmark out", at="out/model/report.json", keyword="other JSON")


def test_sets_and_refusals(pinnquad):
    """Each set of the tree names a mapping that the program, or the set's folder, has."""
    ready = pinnquad("import --list").out
    names = [path.stem for path in sorted((SOURCE / "tools/study/data_sets").glob("*.toml"))]
    listed = benchmark("list").out
    for name in names:
        assert name in listed
    for path in (SOURCE / "tools/study/data_sets").glob("*.toml"):
        mapping = path.read_text().split('mapping = "')
        if len(mapping) > 1:
            assert mapping[1].split('"')[0] in ready or (path.parent / mapping[1].split('"')[0]).is_file()
    benchmark.refused("run", "nowhere", ".", keyword="one of")
    benchmark.refused("run", names[0], ".", keyword="expected flights")
    Path("mine.toml").write_text('about = "x"\n')
    benchmark.refused("run", "mine.toml", ".", at="mine.toml", keyword="`url`")


def test_lists_in_cells(pinnquad, flown):
    """A table that pandas wrote of arrays: vectors and matrices in quoted cells, between commas or blanks."""
    rows = rows_of(flown("--seed 3 --samples 2400"))
    text = lambda row, names, between: between.join(repr(row[name]) for name in names)
    lines = [",t,w,M,u"]
    for number, row in enumerate(rows):
        vectors = [f'"[{text(row, ("w_x", "w_y", "w_z"), " ")}]"',
                   f'"[[{text(row, ("v_bx", "v_by", "v_bz"), ", ")}], [{text(row, ("roll", "pitch", "yaw"), ", ")}]]"',
                   f'"[{text(row, ("u1", "u2", "u3", "u4"), ", ")}]"']
        lines.append(",".join([str(number), f'[{row["t"]!r}]', *vectors]))
    Path("log.csv").write_text("\n".join(lines) + "\n")
    mapping = MAPPING.replace('["w_x", "w_y", "w_z"]', '["w[0]", "w[1]", "w[2]"]').replace(
        '["v_bx", "v_by", "v_bz"]', '["M[0][0]", "M[0][1]", "M[0][2]"]').replace(
        '["roll", "pitch", "yaw"]', '["M[1][0]", "M[1][1]", "M[1][2]"]').replace(
        '["u1", "u2", "u3", "u4"]', '["u[0]", "u[1]", "u[2]", "u[3]"]')
    Path("mapping.toml").write_text("".join(line for line in mapping.splitlines(True) if "altitude" not in line))
    Path("plain.toml").write_text("".join(line for line in MAPPING.splitlines(True) if "altitude" not in line))
    pinnquad("import log.csv --mapping mapping.toml --lag 0 --out lists")
    shutil.copy(flown("--seed 3 --samples 2400"), "log.csv")
    pinnquad("import log.csv --mapping plain.toml --lag 0 --out plain")
    assert Path("lists/log.csv").read_text() == Path("plain/log.csv").read_text()

    def with_note(number, note):
        return ",".join([lines[number], note])

    lines[0:2] = with_note(0, "note"), with_note(1, "[1]")
    lines[2:] = (with_note(number, '"[1, 2]"') for number in range(2, len(lines)))
    Path("log.csv").write_text("\n".join(lines) + "\n")  # whose lengths nothing depends on
    pinnquad("import log.csv --mapping mapping.toml --lag 0 --out lists")
    assert Path("lists/log.csv").read_text() == Path("plain/log.csv").read_text()
    lines[40] = lines[40].replace("[[", "[[1.0, ", 1)
    Path("log.csv").write_text("\n".join(lines) + "\n")
    pinnquad.refused("import log.csv --mapping mapping.toml --out other", at="log.csv:41:4", keyword="lists of one length in column M")

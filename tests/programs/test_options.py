# SPDX-License-Identifier: MIT
"""Hostile values for every number and every text that a command takes, by what its --help says: one line that names the
option, exit code 2, no work begun."""
import os
import re
from pathlib import Path

import pytest
from conftest import commands_of

LAGS = ["nan", "inf", "1e400", "0x10", "-2", " "]


def hostile_values(kind):
    """Of what the help says that an option takes."""
    span = re.search(r"\d\.\.(\d.*)", kind)
    if span:
        values = ["nan", "-nan", "inf", "-1", "1e400", "0x10", " ", "1 2", "1,5", f"1{span.group(1)}0"]
        return values if kind.startswith("0") else values + ["0"]
    return ["nan", "inf", "-1", "1e400", "0x10", "1.5", "18446744073709551616"] if kind == "N" else []


def test_by_help(commands):
    assert check_options(commands) >= 200


def test_of_the_study_by_help(study):
    assert check_options(commands_of(study)) >= 60


def check_options(commands):
    tried = 0
    for command, text in commands[1:]:
        assert not re.search(r"^  --[a-z-]+ (FLOAT|INT|UINT|NUMBER)", text,
                             re.M), f"{command.name}: a number without its range"
        for option, kind in re.findall(r"^  (--[a-z-]+) (\S+)", text, re.M):
            for value in ["", *hostile_values(kind.split("=")[0])]:
                line = command.refused(option, value, keyword=option, timeout=20).lines[0]
                assert re.match(rf"[a-z]+: {option}\b", line), line
                assert not os.listdir(), (command.name, option, value)
                tried += 1
    return tried


def test_lag(pinnquad):
    for value in LAGS:
        for command in "import x.csv --mapping px4 --out o", "train x.csv --out o":
            pinnquad.refused(f"{command} --lag", value, keyword="--lag", timeout=20)
    assert not os.listdir()


@pytest.mark.parametrize("entry", ["seconds = nan", 'seconds = "nan"', "seconds = inf", "seconds = 0", "seed = -1",
                                   'seed = ""', "seed = 1e400"])
def test_entries_of_a_file(pinnquad, entry):
    Path("wrong.toml").write_text(f"[certify]\n{entry}\n")
    pinnquad.refused("certify model.hpp --config wrong.toml", at="wrong.toml:2:*", timeout=20)


def test_nul_would_cut_a_path(pinnquad):
    Path("wrong.toml").write_text('[fly]\nout = "o.csv\\u0000.txt"\n')
    pinnquad.refused("fly --samples 20 --config wrong.toml", at="wrong.toml:2:7", keyword="NUL", timeout=20)
    assert os.listdir() == ["wrong.toml"]

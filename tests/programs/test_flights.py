# SPDX-License-Identifier: MIT
"""The paper's flights: bounds by --statistics, stick recordings flown again, recorder errors, pictures, bad input,
Ctrl-C."""
import math
import os
import re
import time
from pathlib import Path

import pytest
from conftest import SOURCE, ended, on_terminal, same_bytes, table


def rows(path):
    return len(Path(path).read_text().splitlines()) - 1


def differ(one, other):
    return Path(one).read_bytes() != Path(other).read_bytes()


@pytest.fixture(scope="module")
def sticks(made):
    """A recording, and the flight that it was made of."""
    return made("fly d3 --seed 4 --samples 200 --record-sticks sticks.csv --out first.csv")


def test_default_flight(pinnquad):
    pinnquad("fly --seed 2 --samples 500 --out unnamed.csv")
    pinnquad("fly d1 --seed 2 --samples 500 --out named.csv")
    same_bytes("unnamed.csv", "named.csv")


@pytest.mark.parametrize("flight, samples", [("d1", 15000), ("d2", 6000), ("d3", 5000)])
def test_rows_and_bounds(pinnquad, flight, samples):
    pinnquad(f"fly {flight} --out flight.csv")
    assert rows("flight.csv") == samples
    assert re.search("^  mean ", pinnquad(f"fly {flight} --statistics 3 --out table.csv").out,
                     re.M), "the table has no means"
    seeds = [{name: float(value) for name, value in row.items()} for row in table("table.csv")]
    assert len(seeds) == 3
    tilt = max(math.acos(math.cos(float(row["roll"])) * math.cos(float(row["pitch"]))) for row in table("flight.csv"))
    assert math.degrees(tilt) - 0.01 <= seeds[0]["max_tilt_deg"] <= 1.2 * math.degrees(tilt), seeds[0]
    for seed in seeds:
        assert seed["max_speed_m_s"] <= 8 and seed["min_altitude_m"] > 0 and seed["saturated_percent"] < 5, seed
        assert min(seed["pcc_roll"], seed["pcc_pitch"], seed["pcc_yaw"]) >= 0.95, seed
        if flight == "d2":
            assert seed["min_altitude_m"] >= 0.1 and seed["max_altitude_m"] <= 2, seed
        else:
            assert seed["max_speed_m_s"] > 7, seed


def test_sticks(pinnquad, sticks):
    """Written at every control tick and flown again, the same bits; the example flies."""
    assert rows(sticks / "sticks.csv") == 5000
    pinnquad("fly d3 --sticks", sticks / "sticks.csv", "--out", "again.csv")
    same_bytes(sticks / "first.csv", "again.csv")
    pinnquad("fly d1 --sticks", SOURCE / "examples/sticks/agile_20s.csv", "--out", "example.csv")
    assert rows("example.csv") == 399  # of 19.95 s


def test_recorder_errors(pinnquad):
    """They lower the correlation, and by the same seed in the same way."""
    words = "fly d1 --samples 2000 --gyro-noise 0.05 --latency 40 --jitter 5 --out"
    assert re.search(r"roll 0\.[0-7]", pinnquad(words, "noisy.csv").out)
    pinnquad(words, "noisy_again.csv")
    same_bytes("noisy.csv", "noisy_again.csv")


def test_ground_effect(pinnquad):
    for name, words in ("default", ""), ("none", "--ground-effect none"), ("conyers", "--ground-effect conyers"):
        pinnquad(f"fly d2 --samples 400 --out {name}.csv {words}")
    same_bytes("conyers.csv", "default.csv")
    assert differ("none.csv", "default.csv")


def test_airframes(pinnquad):
    said = pinnquad("fly d1 --samples 20 --airframe racer_5_inch --out by_name.csv").out
    assert re.search("^airframe    racer_5_inch: ", said, re.M), said
    listed = pinnquad("fly --list-airframes").out
    assert re.search(r"paper_quadrotor .*1\.500 kg.*thrust-to-weight 2\.006", listed) and "Table 1" in listed, listed


def test_pictures(pinnquad):
    """No other program draws them."""
    for flight in "d2", "d3":
        pinnquad(f"fly {flight} --samples 1000 --pictures pictures", env={"PATH": "/nonexistent"})
    assert sorted(os.listdir("pictures")) == ["correlation.svg", "ground_effect.svg", "trajectory.svg", "wind.svg"]
    for picture in Path("pictures").iterdir():
        assert "</svg>" in picture.read_text(), f"{picture} is not whole"


@pytest.mark.parametrize("words, at, keyword", [
    ("--sticks bad.csv --out out/f.csv", "bad.csv:4:3", "fast"), ("--sticks absent.csv --out out/f.csv", "absent.csv",
                                                                  ""),
    ("d4 --out out/f.csv", "", "'d4'"), ("d2 --ground-effect some --out out/f.csv", "", "'some'"), ("d1", "", "--out"),
    ("d1 --statistics 2 --sticks STICKS", "", "--statistics"), ("d1 --statistics 2 --pictures out", "", "--statistics"),
    ("d1 --max-speed 3 --sticks STICKS --out out/f.csv", "", "--max-speed"),
    ("d1 --gyro-noise -1 --out out/f.csv", "", "--gyro-noise"), ("d1 --latency much --out out/f.csv", "", "--latency"),
    ("d1 --record-sticks absent/s.csv --out out/f.csv", "absent/s.csv", ""),
    ("d2 --samples 5 --pictures pictures --out out/f.csv", "", "--pictures"),
    ("d1 --pictures absent/pictures --out out/f.csv", "absent/pictures", "")])
def test_refused(pinnquad, sticks, words, at, keyword):
    Path("out").mkdir()
    lines = (sticks / "sticks.csv").read_text().splitlines()[:3]
    Path("bad.csv").write_text("\n".join([*lines, "9,1,fast,0,0,0,0,0", ""]))
    pinnquad.refused(f"fly {words}".replace("STICKS", str(sticks / "sticks.csv")), at=at, keyword=keyword)
    assert not os.listdir("out") and not Path("pictures").exists()


@pytest.mark.parametrize("words", ["--samples 10000000 --out out/f.csv --record-sticks out/s.csv",
                                   "--statistics 10000 --out out/table.csv"])
def test_interrupted(pinnquad, words):
    """Two seconds into minutes of flight: nothing is left."""
    Path("out").mkdir()
    process = pinnquad.start(f"fly d1 {words}")
    time.sleep(2)
    done = ended(process)
    assert done.code == 130 and any("interrupted" in line for line in done.lines), done
    assert not os.listdir("out")


def test_progress_on_a_terminal(pinnquad):
    """Each part of the work shows how far it is."""
    _, seen = on_terminal([pinnquad, *"fly --samples 400 --out f.csv".split()], "stderr")
    for part in "flying:", "writing f.csv:":
        assert re.search(rf"{part} +[0-9]+ %, [0-9]+ s left", seen), (part, seen)

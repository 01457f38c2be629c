# SPDX-License-Identifier: MIT
"""Logs as vehicles write them, told apart by their content: a flight in closed form as a blackbox log of Betaflight and
of INAV, and as a DataFlash log; containers that are not read."""
import json
import re
import struct
from pathlib import Path

import pytest
from made_logs import BEGIN_S, LAG_S, blackbox, dataflash, facts, flight_in, inav, like_closed_form

@pytest.mark.parametrize("log, mapping, why", [
    (blackbox, "betaflight", "a blackbox log of Betaflight 2025.12.1"), (inav, "inav", "a blackbox log of INAV 7.1.2"),
    (dataflash, "ardupilot", "a DataFlash log")])
def test_a_vehicles_log_is_known_by_its_content(pinnquad, log, mapping, why):
    Path("any.name").write_bytes(log())
    done = pinnquad("import any.name --rate 100 --out dataset")
    assert done.out.startswith(f"mapping {mapping} taken: {why}"), done.out
    dataset = facts("dataset")
    assert dataset["mapping"] == mapping and dataset["lag_removed_s"] == pytest.approx(LAG_S, abs=0.01)
    like_closed_form(flight_in("dataset"), 0.003, least_rows=1500, begin_s=BEGIN_S, rounded=0.01)


def test_logs_of_several_kinds_and_several_flights_in_one_list(pinnquad):
    Path("two.bbl").write_bytes(b"\xff" * 100 + blackbox() + blackbox()[:2000])
    Path("one.bin").write_bytes(dataflash(30))
    done = pinnquad("import two.bbl one.bin --rate 100 --out dataset")
    assert "mapping betaflight taken" in done.out and "mapping ardupilot taken" in done.out
    kept = facts("dataset")
    assert [flight["name"] for flight in kept["flights"]] == ["two.01", "one"]
    assert kept["mapping"] == "betaflight, ardupilot"
    pinnquad.refused("import two.bbl --mapping px4 --out other", keyword="vehicle_attitude")


def test_no_order_of_logs_decides_whose_airframe_they_have(pinnquad):
    Path("craft.bin").write_bytes(dataflash())
    Path("crazyflie.usd").write_bytes(b"\xbc\x01\x00")
    for logs in "craft.bin crazyflie.usd", "crazyflie.usd craft.bin":
        pinnquad.refused(f"import {logs} --out dataset", keyword="the mapping crazyflie is of crazyflie_2_1")


def test_logs_of_one_name_are_called_by_their_folders(pinnquad):
    for begin, folder in enumerate(("monday/logs", "tuesday/logs")):
        Path(folder).mkdir(parents=True)
        Path(folder, "00000001.BIN").write_bytes(dataflash(30 * begin))
    pinnquad("import monday/logs/00000001.BIN tuesday/logs/00000001.BIN --rate 100 --out dataset")
    flights = facts("dataset")["flights"]
    assert [one["trajectory"] for one in flights] == ["monday_00000001", "tuesday_00000001"]


def test_a_craft_without_accelerometer_is_named(pinnquad):
    none = blackbox().replace(b"acc_1G:2048", b"acc_1G:0")
    for log in none, none.replace(b"accSmooth", b"debugging"):
        Path("none.bbl").write_bytes(log)
        pinnquad.refused("import none.bbl --out dataset", at="none.bbl", keyword="one that flew without (acc_1G 0")


def parameter(name, value):
    return struct.pack("<16sf", name.encode(), value)


@pytest.mark.parametrize("changes, keyword", [
    ([(b"FRAME_CLASS", b"NOTHING_YET"), (parameter("FRAME_TYPE", 1), parameter("FRAME", 0))], "FRAME 0: a '+' frame"),
    ([(parameter("FRAME_CLASS", 1), parameter("FRAME_CLASS", 2))], "hexacopter")])
def test_another_frame_is_named(pinnquad, changes, keyword):
    log = dataflash()
    for before, now in changes:
        assert before in log
        log = log.replace(before, now)
    Path("other.bin").write_bytes(log)
    pinnquad.refused("import other.bin --out dataset", keyword=keyword)


@pytest.mark.parametrize("begin, keyword", [
    (b"\x89MCAP0\r\n", "ros2 topic echo --csv"), (b"#ROSBAG V2.0\n", "rostopic echo"), (b"SQLite format 3\0", "ROS 2 bag"),
    (struct.pack(">Q", 1_700_000_000_000_000) + b"\xfd\x09\0\0", "mavlogdump.py"), (b"\x89HDF\r\n\x1a\n", "with [()].T"),
    (b"MATLAB 5.0 MAT-file, Platform", "writetable"), (b"PK\x03\x04" + 20 * b"\0" + b"archive/data.pkl", "PyTorch"),
    (b"PK\x03\x04" + 20 * b"\0" + b"flight.ulg", "unzip"), (b"\x1f\x8b\x08\0", "gzip -d"), (b"\xfd7zXZ\0\0", "xz -d"),
    (b"<?xml version='1.0'?>\n<root><tabbed_widget/></root>", "PlotJuggler"), (b"FMT, 128, 89, FMT, BBnNZ", "the .bin"),
    (b'{"t": 0.01, "w_x": 0.1}\n', "read_json")])
def test_other_containers_are_named_with_what_to_do(pinnquad, begin, keyword):
    Path("flight.csv").write_bytes(begin + bytes(40))
    for command in "import flight.csv --out out", "train flight.csv --out out", "identify flight.csv":
        pinnquad.refused(command, keyword=keyword)
    assert not Path("out").exists()


def test_the_advice_for_json_leaves_stamps_numbers(pinnquad):
    pandas = pytest.importorskip("pandas")
    rows = [[50_000_000 + 4000 * i, 0.5 * i] for i in range(3)]  # by default pandas makes dates of 1971 of `timestamp`
    Path("flight.json").write_text("\n".join(json.dumps(dict(zip(("timestamp", "roll"), row))) for row in rows))
    refusal = pinnquad.refused("import flight.json --out out").lines[0]
    advice = re.search(r"pandas\.read_json.*index=False\)", refusal)[0]
    exec(advice.replace("FILE", "'flight.json'"), {"pandas": pandas})
    header, *table = Path("log.csv").read_text().splitlines()
    assert header == "timestamp,roll" and [[float(cell) for cell in row.split(",")] for row in table] == rows

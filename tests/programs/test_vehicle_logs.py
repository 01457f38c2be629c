# SPDX-License-Identifier: MIT
"""Logs as vehicles write them, told apart by their content: a flight in closed form as a blackbox log of Betaflight and
of INAV, and as a DataFlash log; containers that are not read."""
import json
import struct
from math import degrees
from pathlib import Path

import pytest
from test_import import angles, errors, numbers, quaternion_enu_flu, rates, slope, specific_force

G, RATE_HZ, SECONDS, LAG_S = 9.80665, 200, 24, 0.04
MAGIC = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n"


def motors(t):
    """Front right, rear left, front left, rear right, 0..1: ahead of the motion that they cause."""
    c = -specific_force(t + LAG_S)[2] / 20
    kx, ky, kz = (dot / size for dot, size in zip(slope(rates, t + LAG_S, 1e-3), (160, 160, 80)))
    return c - kx + ky + kz, c + kx - ky + kz, c + kx + ky - kz, c - kx - ky - kz


def number(value):
    """A signed number: zigzag, seven bits a byte."""
    value = round(value)
    rest, out = (value << 1) ^ (value >> 63), b""
    while rest > 127:
        out, rest = out + bytes([rest & 127 | 128]), rest >> 7
    return out + bytes([rest])


def blackbox(firmware, extra, numbers_of, motor_range):
    """Full frames alone, every field a signed number but the count and the time."""
    names = ["loopIteration", "time", *(f"gyroADC[{i}]" for i in range(3)), *(f"accSmooth[{i}]" for i in range(3)),
             *(f"motor[{i}]" for i in range(4)), *extra]
    lists = {"name": names, "signed": [0, 0] + [1] * (len(names) - 2), "predictor": [0] * len(names),
             "encoding": [0] * len(names)}
    head = MAGIC + "H Data version:2\n"
    head += "".join(f"H Field I {key}:{','.join(map(str, values))}\n" for key, values in lists.items())
    low, high = motor_range
    head += f"H I interval:1\nH Firmware revision:{firmware}\nH gyro_scale:0x3d800000\nH acc_1G:2048\n"
    head += f"H motorOutput:{low},{high}\n"
    log = head.encode()
    for i in range(RATE_HZ * SECONDS):
        t = i / RATE_HZ
        (p, q, r), (fx, fy, fz), (fr, rl, fl, rr) = rates(t), specific_force(t), motors(t)
        row = [i, 1e6 * t + 7e6, *(16 * degrees(w) for w in (p, -q, -r)), *(2048 * f / G for f in (fx, -fy, -fz)),
               *(low + (high - low) * u for u in (rr, fr, rl, fl)), *numbers_of(t)]
        log += b"I" + b"".join(map(number, row))
    return log + b"E\xffEnd of log\0"


def betaflight():
    def quaternion(t):
        x, y, z, w = quaternion_enu_flu(t)
        return [32767 * (v if w >= 0 else -v) for v in (x, y, z)]
    return blackbox("Betaflight 2025.12.1 (abc) STM32H743", [f"imuQuaternion[{i}]" for i in range(3)], quaternion,
                    (158, 2047))


def inav():
    def attitude(t):
        roll, pitch, yaw = angles(t)
        return [10 * degrees(roll), -10 * degrees(pitch), 10 * degrees(yaw) % 3600]
    return blackbox("INAV 7.1.2 (def) MATEKF765", [f"attitude[{i}]" for i in range(3)], attitude, (1000, 2000))


def dataflash(begin_s=0):
    def message(kind, form, *values):
        return struct.pack("<BBB" + form, 0xa3, 0x95, kind, *values)

    def announced(kind, form, letters, name, names):
        size = 3 + struct.calcsize("<" + form)
        return message(128, "BB4s16s64s", kind, size, name.encode(), letters.encode(), names.encode())
    log = announced(128, "BB4s16s64s", "BBnNZ", "FMT", "Type,Length,Name,Format,Columns")
    log += announced(1, "Q16sf", "QNf", "PARM", "TimeUS,Name,Value")
    log += announced(2, "QBffffff", "QBffffff", "IMU", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ")
    log += announced(3, "Qfff", "Qfff", "ATT", "TimeUS,Roll,Pitch,Yaw")
    log += announced(4, "QHHHHH", "QHHHHH", "RCOU", "TimeUS,C1,C2,C3,C4,C5")
    for name, value in ("MOT_SPIN_MIN", 0.1), ("MOT_SPIN_MAX", 0.9), ("FRAME_CLASS", 1), ("FRAME_TYPE", 1), *(
            (f"SERVO{i + 1}_FUNCTION", 33 + i) for i in range(4)):
        log += message(1, "Q16sf", 0, name.encode(), value)
    for i in range(RATE_HZ * SECONDS):
        t = begin_s + i / RATE_HZ
        time = round(1e6 * t + 7e6)
        log += message(2, "QBffffff", time, 0, *rates(t), *specific_force(t))
        log += message(3, "Qfff", time, *map(degrees, angles(t)))
        log += message(4, "QHHHHH", time, *(round(1100 + 800 * u) for u in motors(t)), 1500)  # an unused servo
    return log


@pytest.mark.parametrize("log, mapping, why", [
    (betaflight, "betaflight", "a blackbox log of Betaflight 2025.12.1"), (inav, "inav", "a blackbox log of INAV 7.1.2"),
    (dataflash, "ardupilot", "a DataFlash log")])
def test_a_vehicles_log_is_known_by_its_content(pinnquad, log, mapping, why):
    Path("any.name").write_bytes(log())
    done = pinnquad("import any.name --rate 100 --out dataset")
    assert done.out.startswith(f"mapping {mapping} taken: {why}"), done.out
    assert json.loads(Path("dataset/dataset.json").read_text())["mapping"] == mapping
    truth = [[7 + i / 1000, *rates(i / 1000), *motors(i / 1000 - LAG_S), *angles(i / 1000)[:2]]
             for i in range(1000 * SECONDS)]
    names = ["w_x", "w_y", "w_z", "u1", "u2", "u3", "u4", "roll", "pitch"]
    flight = numbers(next(Path("dataset").glob("*.csv")), *names)
    lag_s = json.loads(Path("dataset/dataset.json").read_text())["lag_removed_s"]
    assert lag_s == pytest.approx(LAG_S, abs=0.01)
    rows, found = errors(truth, flight)
    assert rows > 1500
    assert max(found[:3]) < 0.01  # rad/s: a sixteenth of a degree is .001
    assert max(found[7:]) < 0.003  # rad: a tenth of a degree is .0017


def test_logs_of_several_kinds_and_several_flights_in_one_list(pinnquad):
    Path("two.bbl").write_bytes(b"\xff" * 100 + betaflight() + betaflight()[:2000])
    Path("one.bin").write_bytes(dataflash(30))
    done = pinnquad("import two.bbl one.bin --rate 100 --out dataset")
    assert "mapping betaflight taken" in done.out and "mapping ardupilot taken" in done.out
    kept = json.loads(Path("dataset/dataset.json").read_text())
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
    flights = json.loads(Path("dataset/dataset.json").read_text())["flights"]
    assert [one["trajectory"] for one in flights] == ["monday_00000001", "tuesday_00000001"]


def test_a_craft_without_accelerometer_is_named(pinnquad):
    none = betaflight().replace(b"acc_1G:2048", b"acc_1G:0")
    for log in none, none.replace(b"accSmooth", b"debugging"):
        Path("none.bbl").write_bytes(log)
        pinnquad.refused("import none.bbl --out dataset", at="none.bbl", keyword="one that flew without (acc_1G 0")


def test_an_old_plus_frame_is_named(pinnquad):
    log = dataflash().replace(b"FRAME_CLASS", b"NOTHING_YET").replace(
        struct.pack("<16sf", b"FRAME_TYPE", 1), struct.pack("<16sf", b"FRAME", 0))
    Path("plus.bin").write_bytes(log)
    pinnquad.refused("import plus.bin --out dataset", keyword="FRAME 0: a '+' frame")


def test_a_hexacopter_is_named(pinnquad):
    log = dataflash().replace(struct.pack("<16sf", b"FRAME_CLASS", 1), struct.pack("<16sf", b"FRAME_CLASS", 2))
    Path("hexa.bin").write_bytes(log)
    pinnquad.refused("import hexa.bin --out dataset", keyword="hexacopter")


@pytest.mark.parametrize("begin, keyword", [
    (b"\x89MCAP0\r\n", "ros2 topic echo --csv"), (b"#ROSBAG V2.0\n", "rostopic echo"), (b"SQLite format 3\0", "ROS 2 bag"),
    (struct.pack(">Q", 1_700_000_000_000_000) + b"\xfd\x09\0\0", "mavlogdump.py"), (b"\x89HDF\r\n\x1a\n", "HDF5"),
    (b"MATLAB 5.0 MAT-file, Platform", "writetable"), (b"PK\x03\x04" + 20 * b"\0" + b"archive/data.pkl", "PyTorch"),
    (b"PK\x03\x04" + 20 * b"\0" + b"flight.ulg", "unzip"), (b"\x1f\x8b\x08\0", "gzip -d"), (b"\xfd7zXZ\0\0", "xz -d"),
    (b"<?xml version='1.0'?>\n<root><tabbed_widget/></root>", "PlotJuggler"), (b"FMT, 128, 89, FMT, BBnNZ", "the .bin"),
    (b'{"t": 0.01, "w_x": 0.1}\n', "read_json")])
def test_other_containers_are_named_with_what_to_do(pinnquad, begin, keyword):
    Path("flight.csv").write_bytes(begin + bytes(40))
    for command in "import flight.csv --out out", "train flight.csv --out out", "identify flight.csv":
        pinnquad.refused(command, keyword=keyword)
    assert not Path("out").exists()


def test_every_cut_of_a_log_is_read_or_refused_in_one_line(pinnquad):
    for log in betaflight(), dataflash():
        for size in 5, 70, 200, 600, 2000:
            Path("cut").write_bytes(log[:size])
            pinnquad.refused("import cut --out out")

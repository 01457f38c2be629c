# SPDX-License-Identifier: MIT
"""Logs as loggers and users leave them: what stands around a table, what stands beside a log, scales and units, cells that
are empty, slots that nobody uses, stamps that are wild. One flight in closed form is written each way, and must come
out as that flight; what cannot is refused in one line."""
import re
import struct
from math import cos, degrees, pi, sin
from pathlib import Path

import pytest
from conftest import table
from made_logs import (BLACKBOX, GRAVITY, angles, blackbox_row, commands_at, facts, flight_in, imported, imu_quaternion,
                       like_closed_form, numbers, position, quaternion, rates, specific_force, ulog, usd_log, velocity)

ROWS = 2000
LAG = ("--lag", "0.04")
TABLE = """\
world = "ned"
[time]
column = "t"
[attitude]
euler = ["roll", "pitch", "yaw"]
[body_rates]
columns = ["p", "q", "r"]
[specific_force]
columns = ["fx", "fy", "fz"]
[motors]
columns = ["u1", "u2", "u3", "u4"]
order = "px4"
"""
NAMES = "t roll pitch yaw p q r fx fy fz u1 u2 u3 u4".split()


def row_at(n):
    """SI units, NED, FRD."""
    t = n / 100
    return [t, *angles(t), *rates(t), *specific_force(t), *commands_at(t)]


def text_of(value):
    return value if isinstance(value, str) else f"{value:.9g}"


def write(path, head, rows, separator=","):
    Path(path).write_text("".join(separator.join(map(text_of, row)) + "\n" for row in [*head, *rows]))


def plain(path, head=None, separator=",", change=lambda row: row):
    write(path, [NAMES] if head is None else head, [change(row_at(n)) for n in range(ROWS)], separator)


def comes_out(pinnquad, log, *words, mapping=TABLE, rounding=1e-5, rows=1900):
    """The log imports and is the flight."""
    Path("table.toml").write_text(mapping)
    said = imported(pinnquad, log, "--mapping", "table.toml", *LAG, *words, out="out")
    like_closed_form(flight_in("out"), rounding, rows)
    return said


def test_units_behind_names(pinnquad):
    """`roll (deg)` is found as `roll`, and its unit is the log's, whatever the mapping says."""
    head = [f"{name} (deg)" if name in ("roll", "pitch", "yaw") else name for name in NAMES]
    plain("log.csv", [head], change=lambda row: [row[0], *map(degrees, row[1:4]), *row[4:]])
    comes_out(pinnquad, "log.csv")
    comes_out(pinnquad, "log.csv", mapping=TABLE.replace('"yaw"]', '"yaw"]\nunit = "mrad"'))


def test_scale_and_offset(pinnquad):
    """In every table of a mapping; units of tenths."""

    def change(row):
        t, *rest = row
        return [t, *(10 * degrees(angle) for angle in rest[:3]), *(rate * 16.4 + 7 for rate in rest[3:6]),
                *(force / GRAVITY * 512 for force in rest[6:9]), *rest[9:]]

    plain("log.csv", change=change)
    mapping = TABLE.replace('"yaw"]', '"yaw"]\nunit = "ddeg"').replace(
        '"r"]', f'"r"]\nscale = {1 / 16.4!r}\noffset = {-7 / 16.4!r}').replace(
            '"fz"]', '"fz"]\nunit = "g"\nscale = "1/512"')
    comes_out(pinnquad, "log.csv", mapping=mapping)
    comes_out(pinnquad, "log.csv", mapping=mapping.replace('unit = "ddeg"', 'unit = "deg"\nscale = 0.1'))
    plain("log.csv", [["acc", "512"], NAMES], change=change)
    comes_out(pinnquad, "log.csv", mapping=mapping.replace("1/512", "1/acc"))
    Path("none.toml").write_text(mapping.replace("1/512", "1/acc_1G"))
    pinnquad.refused("import log.csv --mapping none.toml --out bad", at="none.toml:11:*", keyword="acc_1G")
    Path("zero.toml").write_text(mapping.replace('"1/512"', "0"))
    pinnquad.refused("import log.csv --mapping zero.toml --out bad", at="zero.toml:*", keyword="scale other than 0")


def test_advice_is_not_what_the_mapping_says(pinnquad):
    """Tenths of a degree as degrees: the advice names the unit that fits, not the one that is there."""
    plain("log.csv", change=lambda row: [row[0], *(10 * degrees(angle) for angle in row[1:4]), *row[4:]])
    Path("deg.toml").write_text(TABLE.replace('"yaw"]', '"yaw"]\nunit = "deg"'))
    refused = pinnquad.refused("import log.csv --mapping deg.toml --out bad", at="log.csv:*", keyword='unit = "ddeg"')
    assert 'unit = "deg"' not in str(refused)


def blackbox_table(path, head, *more, acc_1g=2048, motors=(158, 2047)):
    """A blackbox log as CSV, its columns of head; more(t): further cells of a row."""
    write(path, head, [[*blackbox_row(n / 100, motors, acc_1g), *(cell for of in more for cell in of(n / 100))]
                       for n in range(ROWS)])


def flies_betaflight(pinnquad, log):
    """It imports by Betaflight's mapping and is the flight."""
    said = imported(pinnquad, log, "--mapping", "betaflight", "--airframe", "paper_quadrotor", *LAG, out="out")
    like_closed_form(flight_in("out"), 2e-3, 1900)
    assert 15 < float(table(flight_in("out"))[0]["battery_voltage [V]"]) < 17
    return said


def test_explorer(pinnquad):
    """Blackbox Explorer's CSV: keys and values above the table, of which its scales are read; angles in radians."""
    def head(acc_1g):
        return [['"Product"', '"Blackbox flight data recorder"'], ['"acc_1G"', acc_1g], ['"motorOutput"', '"158,2047"'],
                ['"rates"', '""'], [f'"{name}"' for name in [*BLACKBOX, "heading[0]", "heading[1]", "heading[2]"]]]

    def flu(t):
        roll, pitch, yaw = angles(t)
        return roll, -pitch, yaw % (2 * pi)

    for acc_1g in 2048, 1024:
        blackbox_table("explorer.csv", head(acc_1g), flu, acc_1g=acc_1g)
        flies_betaflight(pinnquad, "explorer.csv")


DECODED = [name.replace("time", "time (us)") for name in BLACKBOX]
IMU = [f"imuQuaternion[{i}]" for i in range(3)]


def test_blackbox_decode(pinnquad):
    """The angles that it integrates, in degrees; a log has no velocity."""
    def flu(t):
        roll, pitch, yaw = map(degrees, angles(t))
        return roll, -pitch, yaw % 360

    blackbox_table("log.csv", [[*DECODED, "roll", "pitch", "heading"]], flu, motors=(48, 2047))
    said = flies_betaflight(pinnquad, "log.csv")
    warnings = facts("out")["warnings"]
    assert "velocity" in facts("out")["absent"] and not [w for w in warnings if "axis" in w or "attitude" in w], said


def test_imu_quaternion(pinnquad):
    """Three of its four numbers, times 32767; before the angles that blackbox_decode integrates, which are wrong here."""
    wrong = lambda t: (40, 50, 60)  # noqa: E731
    blackbox_table("log.csv", [[*DECODED, *IMU, "roll", "pitch", "heading"]], imu_quaternion, wrong, motors=(48, 2047))
    flies_betaflight(pinnquad, "log.csv")
    mapping = """\
world = "enu"
body = "flu"
[time]
column = "time (us)"
unit = "us"
[attitude]
quaternion = ["imuQuaternion[0]", "imuQuaternion[1]", "imuQuaternion[2]"]
[body_rates]
columns = ["gyroADC[0]", "gyroADC[1]", "gyroADC[2]"]
unit = "deg/s"
[specific_force]
columns = ["accSmooth[0]", "accSmooth[1]", "accSmooth[2]"]
unit = "g"
scale = "1/2048"
[motors]
columns = ["motor[0]", "motor[1]", "motor[2]", "motor[3]"]
numbers = "signal"
least = 48
most = 2047
order = "betaflight"
"""
    said = comes_out(pinnquad, "log.csv", mapping=mapping, rounding=2e-3)
    assert "32767" in said


def test_imu_quaternion_of_another_scale(pinnquad):
    """Its x, y and z stand for another number than 32767, so the attitude turns by too little: it passed."""
    too_little = lambda t: [round(0.6 * part) for part in imu_quaternion(t)]  # noqa: E731
    blackbox_table("log.csv", [[*DECODED, *IMU]], too_little, motors=(48, 2047))
    pinnquad.refused("import log.csv --mapping betaflight --airframe paper_quadrotor --out bad", at="log.csv",
                     keyword="the scale of the quaternion or the angles, or the range of the gyro")


def test_a_cut_table(pinnquad):
    """A last row without a line end is left out with a word. A short row before it is refused."""
    plain("log.csv")
    whole = Path("log.csv").read_text()
    last = whole.splitlines()[-1]
    Path("log.csv").write_text(whole[:-len(last) // 2])
    assert f"line {ROWS + 1}, the last, has no line end" in comes_out(pinnquad, "log.csv")
    Path("log.csv").write_text(whole[:-len(last) // 2] + "\n")
    pinnquad.refused("import log.csv --mapping table.toml --out bad", at=f"log.csv:{ROWS + 1}:*", keyword="14 cells")


def test_keys_without_a_table(pinnquad):
    """Explorer's first rows alone: said so, and no list of nearest names that is empty."""
    Path("log.csv").write_text('"Product","Blackbox flight data recorder"\n"firmware","4.4.2"\n"craft","mine"\n')
    said = pinnquad.refused("import log.csv --mapping betaflight --out bad", at="betaflight.toml:*", keyword="no column of numbers")
    assert "nearest" not in str(said)


@pytest.mark.parametrize("coding", ["utf-16", "utf-16-be"])
def test_another_coding(pinnquad, coding):
    plain("log.csv")
    text = Path("log.csv").read_text()
    Path("log.csv").write_bytes((text if coding == "utf-16" else "\ufeff" + text).encode(coding))
    Path("table.toml").write_text(TABLE)
    pinnquad.refused("import log.csv --mapping table.toml --out bad", at="log.csv", keyword="iconv")


@pytest.mark.parametrize("beside", ["LOG.01.GPS.CSV", "LOG.01.headers.csv", "LOG.01.event"])
def test_beside_a_log(pinnquad, beside):
    """What blackbox_decode writes beside a log is skipped with a word, named alone it is refused."""
    Path("folder").mkdir()
    plain("folder/LOG.01.csv")
    Path("folder", beside).write_text("time (us), GPS_numSat\n1, 9\n")
    Path("table.toml").write_text(TABLE)
    for given in (["folder/LOG.01.csv", f"folder/{beside}"], ["folder"]):
        said = pinnquad("import", *given, "--mapping", "table.toml", *LAG, "--out", "out").out
        assert len(facts("out")["flights"]) == 1
        assert ("skipped" in said) == (beside.endswith(".csv") or len(given) > 1), said
    for words in ("--mapping table.toml", ""):
        pinnquad.refused(f"import folder/{beside} {words} --out bad", at=f"folder/{beside}", keyword="beside")


def test_beside_a_log_without_a_mapping(pinnquad):
    """It asks for no mapping of its own."""
    blackbox_table("LOG.01.csv", [[*DECODED, *IMU]], imu_quaternion, motors=(48, 2047))
    Path("LOG.01.gps.csv").write_text("time (us), GPS_numSat\n1, 9\n")
    for out, given in enumerate((["LOG.01.csv", "LOG.01.gps.csv"], ["LOG.01.gps.csv", "LOG.01.csv"])):
        said = pinnquad("import", *given, "--airframe", "paper_quadrotor", *LAG, "--out", f"out{out}").out
        assert "mapping betaflight taken" in said and "skipped" in said, said


def sparse(path, *, forward=0):
    """A row a message: attitude, rates, force and motors at times of their own."""
    rows = []
    for n in range(ROWS):
        for late, first, last in ((0, 1, 4), (0.0011, 4, 7), (0.0022, 7, 10), (0.0031, 10, 14)):
            t = n / 100 + late
            full = [t, *angles(t), *rates(t), *specific_force(t), *commands_at(t)]
            rows.append([t, *(full[i] if first <= i < last else "" for i in range(1, 14))])
    write(path, [NAMES], rows)


def test_sparse_table(pinnquad):
    """PlotJuggler's and pandas' joins: each quantity is resampled by its own rows."""
    sparse("log.csv")
    said = comes_out(pinnquad, "log.csv", rounding=2e-3)
    assert "gaps" not in said, said


def test_sparse_extra(pinnquad):
    """A battery once in half a second in a table of even rows: the rows stay, the voltage is held."""
    write("log.csv", [[*NAMES, "bat"]], [[*row_at(n), 12 - n / 1000 if n % 50 == 0 else ""] for n in range(ROWS)])
    mapping = TABLE + '[[extra]]\nname = "battery_voltage"\nunit = "V"\ncolumn = "bat"\n'
    comes_out(pinnquad, "log.csv", mapping=mapping)
    values = {float(line.split(",")[-1]) for line in flight_in("out").read_text().splitlines()[1:]}
    assert len(values) == 40 and max(values) == 12


@pytest.mark.parametrize("row, stamp", [(700, 9.2e12), (700, -50)])
def test_wild_stamp(pinnquad, row, stamp):
    plain("log.csv", change=lambda cells: [stamp, *cells[1:]] if cells[0] == row / 100 else cells)
    said = comes_out(pinnquad, "log.csv")
    assert "1 row has a stamp" in said, said


def motors_table(path, motors):
    """`motors(u1..u4)` are the log's columns control[0] on."""
    columns = [motors(commands_at(n / 100)) for n in range(ROWS)]
    write(path, [[*NAMES[:10], *(f"control[{i}]" for i in range(len(columns[0])))]],
          [[*row_at(n)[:10], *columns[n]] for n in range(ROWS)])


CONTROLS = TABLE.replace('["u1", "u2", "u3", "u4"]', '["control[0]", "control[1]", "control[2]", "control[3]"]')


@pytest.mark.parametrize("unused", ["nan", 0.0025])
def test_unused_slots(pinnquad, unused):
    """ROS 2's twelve motors: slots that never move from 0 are no motors."""
    motors_table("log.csv", lambda u: [*u, *8 * [unused]])
    comes_out(pinnquad, "log.csv", mapping=CONTROLS)


def test_a_wild_row_is_no_motor(pinnquad):
    """One row in 2,000 in which unused slots have a number."""
    rows = iter(range(ROWS))
    motors_table("log.csv", lambda u: [*u, *8 * [0.5 if next(rows) == 1000 else 0]])
    comes_out(pinnquad, "log.csv", mapping=CONTROLS)


@pytest.mark.parametrize("motors, kind", [
    (lambda u: [*u, *u[:2], *6 * [0]], "a hexacopter"), (lambda u: [*u, *u, *4 * ["nan"]], "an octocopter"),
    (lambda u: [u[0], *11 * ["nan"]], "a plane"), (lambda u: [u[0], *11 * [0]], "a plane"),
    (lambda u: [*u[:3], *9 * [0.0025]], "a tricopter"), (lambda u: [*u, u[0], *7 * [0]], "a pusher")])
def test_other_vehicles(pinnquad, motors, kind):
    motors_table("log.csv", motors)
    Path("table.toml").write_text(CONTROLS)
    pinnquad.refused("import log.csv --mapping table.toml --out bad", at="table.toml:11:*", keyword=kind)


def test_torque_in_si(pinnquad):
    """Torque in N m and thrust in N by the airframe; taken as shares they are refused."""
    rows = []
    for n in range(ROWS):
        u = [0.3 + 0.02 * (u - 0.5) for u in commands_at(n / 100)]
        rows.append([*row_at(n)[:10], 3e-4 * (u[1] - u[0]), 3e-4 * (u[0] - u[1]), 1e-5, 0.27 + 0.01 * sin(n / 50)])
    write("log.csv", [[*NAMES[:10], "tx", "ty", "tz", "thrust"]], rows)
    begin = TABLE[:TABLE.index("[motors]")] + '[torque_and_thrust]\ntorque = ["tx", "ty", "tz"]\nthrust = "thrust"\n' \
        'thrust_is = "up"\n'
    Path("shares.toml").write_text(begin)
    pinnquad.refused("import log.csv --mapping shares.toml --airframe crazyflie_2_1 --out bad", at="shares.toml:10:*",
                     keyword="torque_unit")
    Path("units.toml").write_text(begin + 'torque_unit = "N m"\nthrust_unit = "N"\n')
    pinnquad("import log.csv --mapping units.toml --airframe crazyflie_2_1 --lag 0 --out out")
    # the commands make that thrust: four rotors of the airframe
    rows = flight_in("out").read_text().splitlines()
    header = rows[0].split(",")
    shares = [sum(float(row.split(",")[header.index(f"u{i}")]) for i in (1, 2, 3, 4)) for row in rows[1:]]
    assert 0.27 / max(shares) == pytest.approx(0.27 / min(shares), rel=0.1)
    pinnquad.refused("import log.csv --mapping units.toml --out bad", at="units.toml:10:*", keyword="--airframe")
    write("large.csv", [[*NAMES[:10], "tx", "ty", "tz", "thrust"]],
          [[*row_at(n)[:10], 0.2 * sin(n), 0.2 * cos(n), 0.02, 15 + sin(n / 50)] for n in range(ROWS)])
    pinnquad.refused("import large.csv --mapping shares.toml --airframe crazyflie_2_1 --out bad", at="shares.toml:10:*",
                     keyword="thrust_unit")
    Path("half.toml").write_text(begin + 'torque_unit = "N m"\n')
    pinnquad.refused("import log.csv --mapping half.toml --out bad", keyword="thrust_unit")


def test_usd_log(pinnquad):
    usd_log("log00")
    said = imported(pinnquad, "log00", "--mapping", "crazyflie", *LAG, out="flown")
    dataset = facts("flown")
    assert dataset["absent"] == [] and not [w for w in dataset["warnings"] if "attitude" in w], said
    assert "battery_voltage [V]" in table(flight_in("flown"))[0]
    like_closed_form(flight_in("flown"), 1e-4, least_rows=1500)  # the lowest are taken for ground


def test_usd_log_without_an_attitude(pinnquad):
    """Roll and pitch are made of gyroscope and accelerometer."""
    usd_log("log00", leave_out="stateEstimate")
    imported(pinnquad, "log00", *LAG, out="flown")
    rows = numbers(flight_in("flown"), "roll", "pitch")
    assert "velocity" in facts("flown")["absent"] and len(rows) > 1500
    for t, roll, pitch in rows:
        assert abs(roll - angles(t)[0]) < 0.2 and abs(pitch - angles(t)[1]) < 0.2


def test_event_without_variables(pinnquad):
    """A Crazyflie's log whose event names no variable."""
    head = b"\xbc" + struct.pack("<HHH", 2, 1, 0) + b"fixedFrequency\0" + struct.pack("<H", 0)
    Path("log00").write_bytes(head + b"".join(struct.pack("<HQ", 0, 10000 * n) for n in range(ROWS)))
    pinnquad.refused("import log00 --mapping crazyflie --out bad", at="crazyflie.toml:*", keyword="no variable at all")


def test_clock_that_runs_wrong_is_found(pinnquad):
    """By attitude, velocity and altitude alike; with the scale it is not."""
    names = [*NAMES, "vn", "ve", "vd", "x", "y", "z"]
    mapping = TABLE + '[velocity]\ncolumns = ["vn", "ve", "vd"]\naxes = "world"\n[position]\ncolumns = ["x", "y", "z"]\n'
    for factor, scale, found in ((84 / 85, "", True), (84 / 85, f"\nscale = {85 / 84!r}", False), (1, "", False)):
        write("log.csv", [names], [[n / 100 * factor, *row_at(n)[1:], *velocity(n / 100), *position(n / 100)] for n in range(ROWS)])
        Path("table.toml").write_text(mapping.replace('"t"', f'"t"{scale}'))
        said = imported(pinnquad, "log.csv", "--mapping", "table.toml", *LAG, "--rate", "100", out="out")
        assert bool(re.search("lasts 1.01(19|20) s, .*runs wrong", said)) == found, said


def px4_log(path, *, parameters=(), sample=lambda stamp: stamp, battery=lambda stamp: stamp, every=1, slots=12, unused=0.0):
    at, stamps = [10**4 * n for n in range(ROWS)], ["uint64_t timestamp", "uint64_t timestamp_sample"]

    def topic(name, values, count, each=at):
        return name, [*stamps, f"double[{count}] v"], [[s, sample(s), *values(s / 1e6)] for s in each]

    motors = lambda t: [*commands_at(t), *(slots - 4) * [unused]]  # noqa: E731
    ulog(path, [topic("vehicle_attitude", quaternion, 4), topic("vehicle_angular_velocity", rates, 3),
                topic("vehicle_acceleration", specific_force, 3), topic("actuator_motors", motors, slots, at[::every]),
                ("battery_status", ["uint64_t timestamp", "double voltage_v"], [[battery(s), 12] for s in at[::50]])],
         parameters)


PX4 = """\
world = "ned"
[attitude]
topic = "vehicle_attitude"
quaternion = ["v[0]", "v[1]", "v[2]", "v[3]"]
time = "timestamp_sample"
[body_rates]
topic = "vehicle_angular_velocity"
columns = ["v[0]", "v[1]", "v[2]"]
time = "timestamp_sample"
[specific_force]
topic = "vehicle_acceleration"
columns = ["v[0]", "v[1]", "v[2]"]
time = "timestamp_sample"
[motors]
topic = "actuator_motors"
columns = ["v[0]", "v[1]", "v[2]", "v[3]"]
order = "px4"
time = "timestamp_sample"
[[extra]]
name = "battery_voltage"
unit = "V"
topic = "battery_status"
column = "voltage_v"
optional = true
"""


@pytest.mark.parametrize("how, warned", [
    ({}, False), ({"sample": lambda stamp: 0}, False), ({"battery": lambda s: 2**63 if s == 5 * 10**6 else s}, True),
    ({"sample": lambda s: 2**63 if s == 5 * 10**6 else s}, False),
    ({"battery": lambda s: s - 5 * 10**6 if s > 10**7 else s}, "its time begins again"),
    ({"battery": lambda s: 2**62 + s}, "its time is none of the flight's"),
    ({"battery": lambda s: 2**63}, "its time is none of the flight's")])
def test_ulog_stamps(pinnquad, how, warned):
    """A sample's time that is 0 or wild is that of its message; a wild message is left out."""
    px4_log("log.ulg", **how)
    said = comes_out(pinnquad, "log.ulg", mapping=PX4, rounding=1e-4)
    assert ("1 row has a stamp" in said) == (warned is True) and (not isinstance(warned, str) or warned in said), said
    assert ("battery_voltage" in flight_in("out").read_text().split("\n")[0]) == (not isinstance(warned, str))


def test_profile_that_is_set(pinnquad):
    """The advice to set SDLOG_PROFILE, unless the log says that it is."""
    for profile, advised in ((1, True), (25, False), (155, False)):
        px4_log("log.ulg", parameters=[("SDLOG_PROFILE", profile)], every=10)
        mapping = PX4.replace("world", 'name = "px4"\nworld', 1)
        Path("table.toml").write_text(mapping)
        said = imported(pinnquad, "log.ulg", "--mapping", "table.toml", *LAG, "--rate", "50", out="out")
        assert "too slow" in said and ("set SDLOG_PROFILE" in said) == advised, said


def test_plus_frame(pinnquad):
    """Motors ahead, right, left and behind: named as such, by how roll and pitch follow the commands."""
    rows = []
    for n in range(ROWS):
        u1, u2, u3, u4 = commands_at(n / 100)
        c, roll, pitch, yaw = (u1 + u2 + u3 + u4) / 4, (u2 + u3 - u1 - u4) / 4, (u1 + u3 - u2 - u4) / 4, \
            (u1 + u2 - u3 - u4) / 4
        rows.append([*row_at(n)[:10], c + 1.4 * pitch + yaw, c - 1.4 * roll - yaw, c + 1.4 * roll - yaw,
                     c - 1.4 * pitch + yaw])
    write("log.csv", [NAMES], rows)
    Path("table.toml").write_text(TABLE)
    said = imported(pinnquad, "log.csv", "--mapping", "table.toml", *LAG, out="out")
    assert re.search("a '[+]' frame, u2 right, u3 left, u1 front, u4 rear", said), said
    plain("x.csv")
    assert "'+' frame" not in imported(pinnquad, "x.csv", "--mapping", "table.toml", *LAG, out="x")


def test_force_that_was_read_as_said(pinnquad):
    """A force along +z: the advice is the body that the mapping does not say."""
    for body, fz, advice in (("frd", -1, "z up (FLU)"), ("flu", 1, "z down (FRD)")):
        plain("log.csv", change=lambda row: [*row[:9], fz * row[9], *row[10:]])
        Path("table.toml").write_text(TABLE.replace('"fz"]', f'"fz"]\nbody = "{body}"'))
        done = pinnquad("import log.csv --mapping table.toml --lag 0.04 --out out", code=(0, 2))
        assert advice in done.out + done.err, done

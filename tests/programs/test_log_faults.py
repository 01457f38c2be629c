# SPDX-License-Identifier: MIT
"""Faults that a pilot's logs have, planted one by one into good flights: the import names file, column and evidence, or
refuses. Good flights, calm ones and recorded ones pass without a word. docs/import.md has the table."""
import csv
import json
import lzma
import math
import random
import re
import shutil
from math import cos, sin
from pathlib import Path

import pytest
from conftest import SOURCE, listing, replaced, table
from made_logs import GRAVITY, to_body

DEGREES = 180 / math.pi
ANGLES, RATES, FORCES = ("roll", "pitch", "yaw"), ("p", "q", "r"), ("fx", "fy", "fz")
VELOCITY, POSITION, MOTORS = ("vn", "ve", "vd"), ("x", "y", "z"), ("u1", "u2", "u3", "u4")
COLUMNS = ("t", *ANGLES, *RATES, *FORCES, *VELOCITY, *POSITION, *MOTORS)
MAPPING = """\
world = "ned"
body = "frd"
[time]
column = "t"
[attitude]
euler = ["roll", "pitch", "yaw"]
[body_rates]
columns = ["p", "q", "r"]
[specific_force]
columns = ["fx", "fy", "fz"]
[velocity]
columns = ["vn", "ve", "vd"]
[position]
columns = ["x", "y", "z"]
[motors]
columns = ["u1", "u2", "u3", "u4"]
order = "px4"
"""
MAPPED = "--mapping log.toml --airframe px4_sih"
SIH = SOURCE / "examples/airframes/px4_sih.toml"


def to_world(angles, vector):
    """From FRD to NED."""
    (sr, sp, sy), (cr, cp, cy) = map(sin, angles), map(cos, angles)
    x, y, z = vector
    return (cp * cy * x + (sr * sp * cy - cr * sy) * y + (cr * sp * cy + sr * sy) * z,
            cp * sy * x + (sr * sp * sy + cr * cy) * y + (cr * sp * sy - sr * cy) * z,
            -sp * x + sr * cp * y + cr * cp * z)


def down(angles):
    """The world's z in the body's axes."""
    roll, pitch, _ = angles
    return -sin(pitch), sin(roll) * cos(pitch), cos(roll) * cos(pitch)


def logged(flight):
    """The rows of a flight of the simulator as a vehicle logs them."""
    rows, place = [], [0.0, 0.0]
    for cells in table(flight):
        f = {name: float(value) for name, value in cells.items()}
        angles, (vx, vy, vz), (p, q, r) = ([f[name] for name in names] for names in (
            ANGLES, ("v_bx", "v_by", "v_bz"), ("w_x", "w_y", "w_z")))
        turned = (q * vz - r * vy, r * vx - p * vz, p * vy - q * vx)
        force = [f[f"vdot_b{axis}"] + turn - GRAVITY * g for axis, turn, g in zip("xyz", turned, down(angles))]
        velocity = to_world(angles, (vx, vy, vz))
        if rows:
            step = f["t"] - rows[-1]["t"]
            place = [at + step * (rows[-1][name] + v) / 2 for at, name, v in zip(place, VELOCITY, velocity)]
        motors = [f[name] for name in MOTORS]
        rows.append(dict(zip(COLUMNS, (f["t"], *angles, p, q, r, *force, *velocity, *place, -f["altitude"], *motors))))
    return rows


def written(path, rows):
    with open(path, "w", newline="") as file:
        out = csv.DictWriter(file, rows[0], lineterminator="\n")
        out.writeheader()
        out.writerows(rows)


# faults: each changes the rows of a log


def each(change, *columns):
    def plant(rows):
        for row in rows:
            for name in columns:
                row[name] = change(row[name])

    return plant


def scaled(factor, *columns):
    return each(lambda value: factor * value, *columns)


def exchanged(one, other):
    def plant(rows):
        for row in rows:
            row[one], row[other] = row[other], row[one]

    return plant


def half_range(rows):
    """As a range of twice the width reads it."""
    each(lambda u: 0.25 + u / 2, *MOTORS)(rows)


def off(*columns):
    return each(lambda _: 0.0, *columns)


def stopped(*columns):
    """From two thirds of the time on."""
    def plant(rows):
        last = rows[2 * len(rows) // 3]
        for row in rows[2 * len(rows) // 3:]:
            row.update({name: last[name] for name in columns})

    return plant


def crashed(rows):
    """The last half second: a gyro at its end, blows, motors from stop to stop."""
    wild = random.Random(1)
    for row in rows[-10:]:
        row.update({name: wild.choice((-34.9, 34.9, wild.uniform(-30, 30))) for name in RATES})
        row.update({name: wild.uniform(-150, 150) for name in FORCES})
        row.update({name: wild.choice((0.0, 1.0)) for name in MOTORS})


def late(seconds, *columns):
    def plant(rows):
        shift = round(seconds / (rows[1]["t"] - rows[0]["t"]))
        old = [dict(row) for row in rows]
        for row, before in zip(rows[shift:], old):
            row.update({name: before[name] for name in columns})
        del rows[:shift]

    return plant


def turned(columns, turn):
    """These three columns as turn(angles, vector) makes them."""
    def plant(rows):
        for row in rows:
            row.update(zip(columns, turn([row[name] for name in ANGLES], [row[name] for name in columns])))

    return plant


def flu(_, vector):
    return vector[0], -vector[1], -vector[2]


def to_enu(angles, vector):
    """From FRD to the world's axes east, north, up, where x, y, z are read as forward, left, up."""
    north, east, down = to_world(angles, vector)
    return east, -north, down


def without_gravity(angles, force):
    return [f + GRAVITY * g for f, g in zip(force, down(angles))]


NAMES = "first", "second", "third", "fourth"


@pytest.fixture(scope="module")
def flights(flown):
    """The rows of four flights, by how long they are, in minutes."""
    return {minutes: {name: logged(flown(f"d1 --airframe px4_sih --seed {seed} --samples {1200 * minutes}"))
                      for seed, name in enumerate(NAMES, start=11)} for minutes in (1, 2)}


@pytest.fixture(scope="module")
def loaded(flown, tmp_path_factory):
    """A flight with a payload of a fifth of the mass."""
    heavy = replaced(SIH, tmp_path_factory.mktemp("heavy") / "heavy.toml", ("^mass_kg = 1.0", "mass_kg = 1.2"))
    return logged(flown(f"d1 --airframe {heavy} --seed 21 --samples 1200"))


@pytest.fixture
def logs(flights):
    """logs(plant, names): log.toml, and the four flights, or those given, as logs/NAME.csv, the fault planted into those.
    A minute is enough for most faults."""

    def write(plant=None, names=NAMES, minutes=1, flown=NAMES):
        Path("log.toml").write_text(MAPPING)
        Path("logs").mkdir()
        for name in flown:
            rows = [dict(row) for row in flights[minutes][name]]
            if plant and name in names:
                plant(rows)
            written(f"logs/{name}.csv", rows)

    return write


ALL, ONE = NAMES, ("third",)
# fault: plant, flights, words of the line that tells it, and exit code of the import: 0 where it is a warning
FAULTS = {
    "degrees as radians": (scaled(DEGREES, *ANGLES), ALL, ("degrees", "logs/first.csv:", "90"), 2),
    "radians as degrees": (scaled(1 / DEGREES, *ANGLES), ALL, ("57", "roll", "w_x"), 2),
    "rates 57 times too small": (scaled(1 / DEGREES, *RATES), ALL, ("57", "w_x"), 2),
    "rates in deg/s": (scaled(DEGREES, *RATES), ALL, ("degrees per second", "w_x", "agreement 0.03"), 2),
    "roll negated": (scaled(-1, "roll"), ALL, ("w_x or roll is negated", "correlation -"), 2),
    "pitch negated": (scaled(-1, "pitch"), ALL, ("w_y or pitch is negated", "correlation -"), 2),
    "yaw negated": (scaled(-1, "yaw"), ALL, ("w_z or yaw is negated", "correlation -"), 2),
    "roll and pitch swapped": (exchanged("roll", "pitch"), ALL, ("roll and pitch", "exchanged", "correlation"), 2),
    "rates in the world's axes": (turned(RATES, to_world), ALL, ("w_x", "rates in the world's axes", "agreement"), 2),
    "rates in the world's axes ENU, as FLU": (turned(RATES, to_enu), ALL, ("w_x", "east, north, up"), 2),
    "rates in FLU": (turned(RATES, flu), ALL, ("w_x", "x forward, y left, z up"), 2),
    "p and q swapped": (exchanged("p", "q"), ALL, ("w_x", "exchanged"), 2),
    "force without gravity": (turned(FORCES, without_gravity), ALL, ("vdot_bx",), 2),
    "velocity in ENU": (lambda rows: (exchanged("vn", "ve")(rows), scaled(-1, "vd")(rows)), ALL, ("v_bx",), 2),
    "velocity in km/h": (scaled(3.6, *VELOCITY), ALL, ("3.6 times", "v_bx"), 2),
    "velocity in the body's axes": (turned(VELOCITY, to_body), ALL, ("v_bx", "once more", "agreement"), 2),
    "z negated": (scaled(-1, "z"), ALL, ("altitude", "negated", "correlation -1"), 2),
    "vd negated": (scaled(-1, "vd"), ALL, ("v_bx", "negated along down", "correlation -0.9"), 2),
    "attitude late": (late(0.2, *ANGLES), ALL, ("roll, pitch and yaw 200 ms late",), 2),
    "rates late": (late(0.2, *RATES), ALL, ("w_x, w_y and w_z 200 ms late",), 2),
    "velocity late": (late(0.2, *VELOCITY), ALL, ("v_bx", "velocities 200 ms late"), 2),
    "frozen gyro": (each(lambda _: 0.01, *RATES), ALL, ("w_x, w_y, w_z", "the same in all"), 2),
    "accelerometer off": (off(*FORCES), ALL, ("vdot_bx, vdot_by, vdot_bz", "the same in all"), 2),
    "attitude off": (off(*ANGLES), ALL, ("roll, pitch, yaw", "the same in all"), 2),
    "one motor off": (each(lambda _: 0.4, "u3"), ALL, ("column u3", "the same in all"), 2),
    "a crash at the end": (crashed, ONE, ("third: ", "0.45 s of tumbling at 59.5 s left out"), 0),
    "gyro stops": (stopped(*RATES), ALL, ("first: ", "w_x, w_y, w_z: the same for 19.", "left out"), 0),
    "accelerometer stops": (stopped(*FORCES), ONE, ("third: ", "vdot_bz (specific force): the same for"), 0),
    "attitude stops": (stopped(*ANGLES), ONE, ("third: ", "roll, pitch, yaw: the same for", "left out"), 0),
    "a motor stops": (stopped("u2"), ONE, ("third: ", "u2: the same for", "left out"), 0),
    "the logger repeats": (stopped(*COLUMNS[1:]), ONE, ("third: ", "roll, pitch, yaw: the same for", "left out"), 0),
    "motors swapped": (exchanged("u1", "u3"), ALL, ("u1 to u4", "u3, u2, u1, u4", "% of roll"), 0),
    "motors swapped in one": (exchanged("u1", "u3"), ONE, ("third: ", "u1 to u4", "u3, u2, u1, u4", "% of roll"), 0),
    "pwm range, slopes halved": (half_range, ALL, ("u1", "roll effectiveness is ", "has 40"), 0),
    "pwm range halved": (scaled(0.5, *MOTORS), ALL, ("u1", "thrust of a rotor over mass is 9.8", "has 5"), 0),
    "pwm range in one": (half_range, ONE, ("third: ", "u1", "than in 3 other flights"), 0),
    "motors late": (late(0.2, *MOTORS), ALL, ("u1 to u4", "ms before the commands"), 0),
    "motors late in one": (late(0.2, *MOTORS), ONE, ("third: ", "u1", "before the commands, in the other flights"), 0),
    "motion late": (late(0.2, *ANGLES, *RATES, *FORCES, *VELOCITY, *POSITION), ALL, ("u1", "ms after the commands"), 0),
}


def told(done):
    """The lines that say what is wrong, but for a rate that is too slow, and for a lag: the simulator's."""
    lines = done.lines if done.code else [line for line in (done.out + done.err).splitlines() if "warning: " in line]
    slow = "was logged at 20 Hz", "rows 50 ms apart don't tell it to 5 ms"
    return [line for line in lines if not any(words in line for words in slow)]


def finds(done, words):
    """One line has them all, and no other line names another cause."""
    lines = told(done)
    assert any(all(word in line for word in words) for line in lines), (words, lines)
    if done.code:
        assert len(done.lines) == 1, done
    if not any("% of roll" in word for word in words):
        assert not any("motors 1 to 4" in line for line in lines), lines
    if not any("57" in word or "degrees" in word for word in words):
        assert not any("degrees" in line for line in lines), lines


def left_nothing(before):
    assert listing(".") == before


@pytest.mark.parametrize("name", FAULTS)
def test_import(pinnquad, logs, name):
    """What is refused is so log by log: one is enough."""
    plant, names, words, code = FAULTS[name]
    logs(plant, names, minutes=2 if name == "radians as degrees" else 1, flown=NAMES[:1] if code == 2 and names == ALL else NAMES)
    before = listing(".")
    finds(pinnquad(f"import logs {MAPPED} --out dataset", code=code), words)
    if code:
        left_nothing(before)


@pytest.mark.parametrize("turn, words, interval_ms", [
    (to_world, "axes north, east, down of the world", 10), (to_world, "axes north, east, down of the world", 50),
    (to_enu, "another convention (ENU, or z up)", 20), (to_enu, "another convention (ENU, or z up)", 50)])
def test_forces_in_the_worlds_axes(pinnquad, flown, turn, words, interval_ms):
    """Rows far apart, and gaps where a command is at its limit, tell them by the world's velocity alone."""
    rows = logged(flown(f"d1 --airframe px4_sih --seed 12 --samples {30000 // interval_ms} --interval {interval_ms}"))
    turned(FORCES, turn)(rows)
    written("log.csv", rows)
    Path("log.toml").write_text(MAPPING)
    pinnquad.refused(f"import log.csv {MAPPED} --out dataset", at="log.csv", keyword=words)


def test_good_flights_pass(pinnquad, logs):
    logs()
    assert told(pinnquad(f"import logs {MAPPED} --out dataset")) == []
    assert told(pinnquad(f"identify logs {MAPPED}")) == []


def test_a_part_of_the_logs(pinnquad, logs):
    logs(crashed, ONE)
    done = pinnquad(f"import logs {MAPPED} --from 10 --to 40 --out dataset")
    assert told(done) == [] and "before --from or after --to" in done.out
    for flight in json.loads(Path("dataset/dataset.json").read_text())["flights"]:
        assert 500 <= flight["rows"] <= 600, flight
    pinnquad.refused(f"import logs {MAPPED} --from 40 --to 10 --out other", keyword="--from")
    pinnquad.refused("identify dataset --from 10", keyword="go with logs")


def test_one_log_is_cut_into_flights_that_can_be_held_out(pinnquad, logs):
    logs()
    whole = json.loads(pinnquad(f"import logs {MAPPED} --out dataset --json").out)["flights"]
    parts = json.loads(pinnquad(f"import logs {MAPPED} --cut 20 --out dataset --json").out)["flights"]
    assert sum(one["rows"] for one in parts) == sum(one["rows"] for one in whole)
    first = [one for one in parts if one["name"].startswith(whole[0]["name"])]
    assert [one["name"] for one in first] == [f"{whole[0]['name']}_{part}" for part in (1, 2, 3)]  # of a minute
    assert [one["file"] for one in first] == [one["name"] + ".csv" for one in first]
    assert max(one["rows"] for one in first) - min(one["rows"] for one in first) < 0.2 * first[0]["rows"]
    assert len({one["trajectory"] for one in first}) == len(first)  # each may be held out, and chosen by
    log = sorted(Path("logs").glob("*.csv"))[0]
    pinnquad.refused(f"train {log} {MAPPED} --models constant --out trained", keyword="--cut")


TRAIN = "train --models constant,linearized --hold-out first --seeds 1 --out trained"
LEARNT = "roll negated", "motors swapped in one", "pwm range in one", "motors late in one"


@pytest.mark.parametrize("name", LEARNT)
@pytest.mark.parametrize("command", [TRAIN, "identify --out vehicle.toml"])
def test_train_and_identify(pinnquad, logs, name, command):
    """What contradicts the airframe's signs is refused, the rest told; nothing is left of what was refused."""
    plant, names, words, _ = FAULTS[name]
    logs(plant, names)
    before = listing(".")
    done = pinnquad(f"{command} logs {MAPPED}", code=(0, 1, 2))
    lines = done.lines + done.out.splitlines()
    assert any(all(word in line for word in words) for line in lines), (words, done)
    if "swapped" in name or "negated" in name:
        assert done.code == 2 and len(done.lines) == 1, done
    if done.code == 2:
        left_nothing(before)


def test_a_payload_in_one_flight(pinnquad, logs, loaded):
    logs()
    written("logs/third.csv", loaded)
    words = ("third: ", "u1 to u4", "thrust of a rotor over mass is 4.1", "17 % less than in 3 other flights")
    finds(pinnquad(f"import logs {MAPPED} --out dataset"), words)
    done = pinnquad(f"{TRAIN} dataset --airframe px4_sih", code=(0, 1))
    assert any(all(word in line for word in words) for line in done.lines), done
    assert "17 % less than in 3 other flights" in Path("trained/report.json").read_text()


def test_no_two_flights_that_agree(pinnquad, logs, flown, tmp_path):
    logs()
    Path("logs/fourth.csv").unlink()
    for name, mass in ("second", 1.2), ("third", 1.45):
        heavy = replaced(SIH, tmp_path / f"{name}.toml", ("^mass_kg = 1.0", f"mass_kg = {mass}"))
        pinnquad(f"fly d1 --airframe {heavy} --seed 31 --samples 1200 --out flight.csv")
        written(f"logs/{name}.csv", logged("flight.csv"))
    before = listing(".")
    for command in TRAIN, "identify --out vehicle.toml":
        done = pinnquad.refused(f"{command} logs {MAPPED}", keyword="no two flights agree")
        assert "logs/second.csv: " in done.lines[0] and "u1 to u4" in done.lines[0], done
        left_nothing(before)


def test_spins_against_the_motion(pinnquad, logs):
    """The signs of yaw would be certified."""
    logs()
    turned = replaced(SIH, "turned.toml", ('"counter_clockwise"', '"?"'), ('"clockwise"', '"counter_clockwise"'),
                      (r'"\?"', '"clockwise"'))
    before = listing(".")
    words = ("first", "u1 to u4", "spin", "yaw effectiveness -3", "w_z")
    mapped = f"--mapping log.toml --airframe {turned}"
    finds(pinnquad(f"import logs {mapped} --out dataset"), words)
    shutil.rmtree("dataset")
    for command in TRAIN, "identify --out vehicle.toml":
        done = pinnquad.refused(f"{command} logs {mapped}", at="logs/first.csv", keyword="spin")
        assert all(word in done.lines[0] for word in words), done
        left_nothing(before)


def test_without_an_accelerometer(pinnquad, logs):
    """A negated z then contradicts the commands alone."""
    logs(scaled(-1, "vd", "z"), minutes=2)
    replaced("log.toml", "log.toml", (r"\[specific_force\]\ncolumns.*\n", ""))
    finds(pinnquad(f"import logs {MAPPED} --out dataset"), ("first", "vdot_bz", "by its slope", "-4."))
    pinnquad.refused(f"{TRAIN} logs {MAPPED}", at="logs/first.csv", keyword="is negated")
    assert not Path("trained").exists()


NO_GRAVITY = {
    "off but for noise": (each(lambda _, noise=random.Random(3): noise.uniform(-0.02, 0.02), *FORCES), "is off"),
    "in g": (scaled(1 / GRAVITY, *FORCES), 'unit = "g"'),
    "in counts": (scaled(512 / GRAVITY, *FORCES), "a scale"),
}


@pytest.mark.parametrize("name", NO_GRAVITY)
def test_an_accelerometer_without_gravity(pinnquad, logs, name):
    """No velocity stands beside it that would say so."""
    plant, word = NO_GRAVITY[name]
    logs(plant)
    replaced("log.toml", "log.toml", (r"\[velocity\]\n.*\n", ""), (r"\[position\]\n.*\n", ""))
    before = listing(".")
    finds(pinnquad(f"import logs {MAPPED} --out dataset", code=2), ("vdot_bx, vdot_by, vdot_bz", "near 9.8 m/s^2", word))
    left_nothing(before)


def shifted(rows):
    return [{**row, "t": row["t"] + 100} for row in rows]


def rounded(rows):
    return [{name: round(value, 5) for name, value in row.items()} for row in rows]


@pytest.mark.parametrize("command, change", [
    ("import --out dataset", lambda rows: rows), ("import --out dataset", shifted), ("import --out dataset", rounded),
    ("import --out dataset", lambda rows: rows[150:750]), (TRAIN, shifted), ("identify --out vehicle.toml", rounded)])
def test_a_log_twice(pinnquad, logs, flights, change, command):
    logs(flown=NAMES[:2])
    written("logs/copy.csv", change(flights[1]["first"]))
    before = listing(".")
    pinnquad.refused(f"{command} logs {MAPPED}", keyword="hold the same flight")
    left_nothing(before)


# flights that are none of a fault


def calm(seed):
    """A hover at 100 Hz that turns slowly, by an estimate of roll and pitch that wanders: pitch spreads by 0.018 rad,
    its rate by 0.05 rad/s."""
    noise, rows, wander = random.Random(seed), [], [0.0, 0.0]
    for at in range(6000):
        t, kept = at / 100, math.exp(-0.01 / 0.3)
        wander = [kept * w + noise.gauss(0, 0.018 * math.sqrt(1 - kept**2)) for w in wander]
        climb = 0.3 * sin(1.1 * t)
        rates = noise.gauss(0, 0.05), noise.gauss(0, 0.05), 0.09 * cos(0.3 * t) + noise.gauss(0, 0.05)
        motors = [(GRAVITY - climb) / 20 + noise.gauss(0, 0.005) for _ in MOTORS]
        rows.append(dict(zip(COLUMNS, (
            t, *wander, 0.3 * sin(0.3 * t), *rates,
            *(GRAVITY * w + noise.gauss(0, 0.1) for w in (wander[1], -wander[0])),
            climb - GRAVITY + noise.gauss(0, 0.1), 0.0, 0.0, -0.3 / 1.1 * cos(1.1 * t), 0.0, 0.0,
            -5 - 0.3 / 1.21 * sin(1.1 * t), *motors))))
    return rows


def test_a_calm_flight_passes(pinnquad):
    Path("log.toml").write_text(MAPPING)
    for seed in 1, 2, 3:
        written("calm.csv", calm(seed))
        said = told(pinnquad(f"import calm.csv {MAPPED} --out dataset"))
        assert all("no lag stands out" in line for line in said), said


@pytest.fixture
def sih(unpacked):
    """Logs of PX4's simulation."""
    return unpacked("train_random", "train_excite", "payload")


def test_recorded_flights_pass(pinnquad, recorded):
    for log, mapping in ("nanobench_subset_50hz", "nanobench"), ("arpl_crazyflie", "arpl"):
        done = pinnquad("import", recorded(f"flight_logs/{log}.csv"), "--mapping", mapping, "--out", mapping)
        assert told(done) == [], log


def test_px4s_simulation(pinnquad, sih, recorded):
    """Its flights pass, the one with a payload is told from the others."""
    said = told(pinnquad("import --mapping px4 --airframe px4_sih --out all", sih, recorded("sih/test_circle.ulg")))
    assert len(said) == 1, said
    assert re.search(r"payload: columns u1 to u4: thrust .* 4\.1\d .* 1[67] % less than in 3", said[0])
    # flights of two masses have no one thrust: the slope is not that of either beside the other's hover
    pinnquad("train all --hold-out test_circle --models structured --seeds 1 --epochs 1 --out trained", code=(0, 1))
    assert json.loads(Path("trained/report.json").read_text())["models"]["structured"]["r2"]["mean"] > 0.35


@pytest.mark.parametrize("name", ["turning", "derivative"])
def test_a_tumble_at_the_end(pinnquad, recorded, name):
    """One row in a hundred, the last 0.4 s, blames no column."""
    with lzma.open(recorded(f"cases/crash_blames_columns/{name}.csv.xz")) as packed:
        Path("log.csv").write_bytes(packed.read())
    mapping = recorded("cases/crash_blames_columns/mapping.toml")
    pinnquad(f"import log.csv --rate 200 --airframe racer_5_inch --out dataset --mapping {mapping}")


@pytest.mark.parametrize("pattern, new, words, code", [
    ('order = "px4"', 'order = "betaflight"', ("u1 to u4", "% of roll"), 0),
    ('order = "wxyz"', 'order = "xyzw"', ("the attitude is in the order w, x, y, z",), 0),  # it hardly turns
    ('direction = "body_to_world"', 'direction = "world_to_body"', ("w_x", "turns the body into the world"), 2),
    ('^body = "frd"', 'body = "flu"', ("vdot_bz", "(FLU)", "-4.17"), 0),
    ('(topic = "vehicle_angular_velocity")', r'\1\nunit = "deg/s"', ("w_x", "57", "agreement"), 2),
    ('axes = "world"', 'axes = "body"', ("v_bx", "world's axes", "agreement"), 2)])
def test_a_mapping_that_errs(pinnquad, sih, pattern, new, words, code):
    replaced(SOURCE / "examples/mappings/px4.toml", "wrong.toml", (pattern, new))
    finds(pinnquad("import --mapping wrong.toml --out wrong", sih / "payload.ulg", code=code), words)


def test_an_order_of_quaternions_that_errs_in_a_flight_that_turns(pinnquad, recorded):
    replaced(SOURCE / "examples/mappings/px4.toml", "wrong.toml", ('order = "wxyz"', 'order = "xyzw"'))
    finds(pinnquad("import --mapping wrong.toml --out wrong", recorded("sih/test_circle.ulg"), code=2),
          ("w_x", "order w, x, y, z"))

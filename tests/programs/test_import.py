# SPDX-License-Identifier: MIT
"""Flight logs to a dataset: a flight in closed form in two conventions, bad input, and recorded logs where they are at
hand."""
import math
import os
import re
import shutil
import subprocess
import sys
from math import asin, atan2, cos, degrees, sin
from pathlib import Path

import pytest
from conftest import SOURCE, cell, column, edited, on_terminal, replaced, table
from made_logs import (GRAVITY, angles, commands_at, errors, facts, imported, like_closed_form, numbers, position,
                       quaternion_enu_flu, rates, specific_force, velocity)

HERE = SOURCE / "tests/programs/import"
FLIGHT = "A1_wave_rep1.csv"


@pytest.fixture(scope="module")
def logs(pinnquad, tmp_path_factory):
    """A flight in closed form as two tables: ned.csv in NED and FRD, SI units, PX4's motor order; enu.csv in ENU and
    FLU, degrees, g, mm, us, pulse widths and Betaflight's motor order. The motors are 40 ms ahead of the motion that
    they cause. And ned.csv imported: ned/, ned.txt."""
    folder = tmp_path_factory.mktemp("logs")
    with open(folder / "ned.csv", "w") as ned, open(folder / "enu.csv", "w") as enu:
        ned.write("t,roll,pitch,yaw,p,q,r,fx,fy,fz,vn,ve,vd,x,y,z,u1,u2,u3,u4,bat,label\n")
        enu.write("t_us,qx,qy,qz,qw,p_deg,q_deg,r_deg,gx,gy,gz,v_east,v_north,v_up,east,north,up,m1,m2,m3,m4,bat_mV,"
                  "label\n")
        for i in range(2000):
            t = i / 100
            (p, q, r), (vn, ve, vd), (x, y, z) = rates(t), velocity(t), position(t)
            (fx, fy, fz), (u1, u2, u3, u4), battery = specific_force(t), commands_at(t), 12 - 0.01 * t
            row = [t, *angles(t), p, q, r, fx, fy, fz, vn, ve, vd, x, y, z, u1, u2, u3, u4, battery]
            ned.write(",".join(map(repr, row)) + ",A1_wave_rep1\n")
            row = [*quaternion_enu_flu(t), degrees(p), -degrees(q), -degrees(r), *(f / GRAVITY for f in (fx, -fy, -fz)),
                   ve * 1000, vn * 1000, -vd * 1000, y, x, -z, *(1000 + 1000 * u for u in (u4, u1, u2, u3)), battery * 1000]
            enu.write(f"{i * 10000}," + ",".join(map(repr, row)) + ",A1_wave_rep1\n")
    done = pinnquad("import ned.csv --out ned --mapping", HERE / "ned.toml", cwd=folder)
    (folder / "ned.txt").write_text(done.out)
    return folder


@pytest.fixture(autouse=True)
def copies(logs, work):
    for name in "ned.csv", "enu.csv":
        shutil.copy(logs / name, work)


def largest_difference(one, other):
    """Of two tables, row by row, in any column but t."""
    most, (rows, others) = 0.0, ([line.split(",") for line in Path(path).read_text().splitlines()[1:]]
                                 for path in (one, other))
    assert len(rows) == len(others)
    for row, against in zip(rows, others):
        assert abs(float(row[0]) - float(against[0])) < 1e-7
        most = max([most, *(abs(float(a) - float(b)) for a, b in zip(row[1:], against[1:]))])
    return most


NED = ("--mapping", HERE / "ned.toml")
NED_LAG = (*NED, "--lag", "0.04")


def test_two_conventions(pinnquad, logs):
    said = (logs / "ned.txt").read_text()
    assert "warning" not in said and re.search("^saturated  *[0-9]", said, re.M), said
    dataset = facts(logs / "ned")
    assert 0.037 <= dataset["lag_removed_s"] <= 0.043 and dataset["sample_period_s"] == 0.01
    assert dataset["flights"][0]["trajectory"] == "wave"
    assert "battery_voltage [V]" in (logs / "ned" / FLIGHT).read_text().split("\n")[0]
    printed = imported(pinnquad, "enu.csv", "--mapping", HERE / "enu.toml", "--json")
    assert printed == Path("enu/dataset.json").read_text() and printed[0] == "{"
    assert largest_difference(logs / "ned" / FLIGHT, f"enu/{FLIGHT}") <= 2e-7


def test_against_closed_form(pinnquad):
    """What was computed: body velocity, angular acceleration, specific force, and commands 40 ms before."""
    imported(pinnquad, "ned.csv", *NED_LAG, out="given")
    flown = numbers("ned.csv", "p", "q", "r")
    truth = [[flown[n][0], *((a - b) / 0.02 for a, b in zip(flown[n + 1][1:], flown[n - 1][1:]))]
             for n in range(1, len(flown) - 1)]
    count, found = errors(truth, numbers(f"given/{FLIGHT}", "wdot_x", "wdot_y", "wdot_z"))
    assert 1900 <= count <= 2000 and max(found) <= 0.02
    like_closed_form(f"given/{FLIGHT}", 1e-5, 1900)


def test_between_two_rows(pinnquad):
    """At twice the table's rate a command is the mean of its two neighbours, or held: the one before."""
    commands = "u1", "u2", "u3", "u4"
    logged = {round(100 * t): row for t, *row in numbers("ned.csv", *commands)}
    for words, weight in ((), 0.5), (("--hold",), 0):
        imported(pinnquad, "ned.csv", *NED, "--lag", "0", "--rate", "200", *words, out="twice")
        rows = numbers(f"twice/{FLIGHT}", *commands)
        between = [(round(200 * t) // 2, row) for t, *row in rows if round(200 * t) % 2]
        assert len(between) > 1800
        for at, row in between:
            for before, after, command in zip(logged[at], logged[at + 1], row):
                assert abs(command - before - weight * (after - before)) < 1e-6, (words, at)


def test_logs_of_two_rates_are_named(pinnquad):
    names, *rows = Path("ned.csv").read_text().splitlines()
    Path("a.csv").write_text("\n".join([names, *rows[:1000]]))
    Path("b.csv").write_text("\n".join([names, *rows[1000::2]]))
    rates = "logged at 50 Hz, the first log at 100 Hz: all have rows at 100 Hz"
    assert rates in imported(pinnquad, "a.csv", "b.csv", *NED_LAG, out="both")
    assert rates not in imported(pinnquad, "a.csv", "b.csv", *NED_LAG, "--rate", "50", out="both")


def test_replaces_a_dataset_alone(pinnquad, logs):
    shutil.copytree(logs / "ned", "ned")
    assert imported(pinnquad, "ned.csv", *NED) == (logs / "ned.txt").read_text(), "the same log gave another dataset"
    Path("ned/mine.txt").touch()
    pinnquad.refused("import ned.csv --out ned", *NED, keyword="mine.txt")
    assert Path("ned", FLIGHT).exists(), "the dataset was destroyed"
    Path("file").write_text("kept\n")
    pinnquad.refused("import ned.csv --out file", *NED, at="file", keyword="there already")
    assert Path("file").read_text() == "kept\n"
    assert re.search("^nanobench ", pinnquad("import --list").out, re.M)


def test_what_looks_wrong(pinnquad):
    """It is warned of, and the right order proposed; rows that are no rows are counted."""

    def other_order(line, cells):
        if line > 1:
            cells[16], cells[17], cells[19] = cells[19], cells[16], cells[17]

    edited("ned.csv", "order.csv", other_order)
    assert re.search("warning: .*motors 1 to 4 are the log's u2, u4, u3, u1", imported(pinnquad, "order.csv", *NED_LAG))
    replaced(HERE / "enu.toml", "order.toml", ('^order = "xyzw"', 'order = "wxyz"'))
    pinnquad.refused("import enu.csv --mapping order.toml --lag 0.04 --out wrong", keyword="x, y, z, w")
    assert not Path("wrong").exists()
    body = (HERE / "enu.toml").read_text().replace('body = "flu"', 'body = "frd"', 1)
    Path("body.toml").write_text(body)
    assert re.search("warning: .*along [+]z", imported(pinnquad, "enu.csv", "--mapping", "body.toml", "--lag", "0.04"))

    lines = Path("ned.csv").read_text().splitlines()
    lines[299] = re.sub(r"^((?:[^,]*,){4})[^,]*", r"\1nan", lines[299])
    lines[499] = re.sub(r"^([^,]*,)[^,]*", r"\1", lines[499])
    lines.insert(699, lines[699])
    lines.insert(902, lines.pop(899))
    Path("rows.csv").write_text("\n".join([*lines, ""]))
    said = imported(pinnquad, "rows.csv", *NED_LAG)
    assert "1 rows had the time of another" in said and "1 rows were not in time" in said, said
    (step,) = [step for step in facts("rows")["steps"] if step["step"] == "incomplete rows"]
    assert step["rows_before"] - step["rows_after"] == 2


def test_memory(pinnquad):
    """A long table is held about once: 100,000 rows of 21 columns are 17 MB."""
    header, *rows = Path("ned.csv").read_text().splitlines()
    with open("long.csv", "w") as long:
        long.write(header + "\n")
        for copy in range(50):
            for row in rows:
                time, others = row.split(",", 1)
                long.write(f"{float(time) + 20 * copy:.6g},{others}\n")

    def peak(log):  # kB
        measure = "import resource, subprocess, sys; " \
            "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL); " \
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
        command = [sys.executable, "-c", measure, pinnquad, "import", log, *NED_LAG, "--out", "peak"]
        return int(subprocess.run(command, check=True, capture_output=True,
                                  env={**os.environ, "MALLOC_MMAP_THRESHOLD_": "131072"}).stdout)

    assert peak("long.csv") - peak("ned.csv") <= 60000


MAPPINGS = [
    ('"roll"', '"roal"', "14:10", "nearest: roll"), ('column = "t"', 'column = "tt"', "7:10", "nearest: t"),
    ('column = "label"', 'column = "lable"', "10:10", "nearest: label"), ('"u3", "u4"', '"u3"', "29:11", "4 columns"),
    ('order = "px4"', 'order = "px5"', "30:9", '"betaflight"'), ('order = "px4"', 'ordr = "px4"', "*:*", "`order`"),
    (r'columns = \["p", "q", "r"\]', 'columns = ["p", "q", "r"]\nunit = "rpm"', "18:8", '"rpm"'),
    (r"\[velocity\]", "[velociti]", "*:*", "`velociti`"), ('world = "ned"', 'world = "nwu"', "3:9", '"nwu"'),
    ('world = "ned"', "world = ", "3:*", "TOML"), (r'"\*_\(\*\)_\*"', '"*_(*_*"', "11:14", "pattern")]


def left_nothing(work):
    assert not list(work.glob("bad*"))


@pytest.mark.parametrize("pattern, new, place, keyword", MAPPINGS)
def test_mappings(pinnquad, work, pattern, new, place, keyword):
    replaced(HERE / "ned.toml", "mapping.toml", (pattern, new))
    pinnquad.refused("import ned.csv --mapping mapping.toml --out bad", at=f"mapping.toml:{place}", keyword=keyword)
    left_nothing(work)


TABLES = [
    ("table.csv:1", "header", lambda line, cells: False), ("table.csv", "64 rows", lambda line,
                                                           cells: None if line <= 50 else False),
    ("table.csv:400:6", '"fast"', cell(400, 6, "fast")), ("table.csv:400:6", "decimal point", cell(400, 6, '"0,5"')),
    ("table.csv:400:3", "22 cells", lambda line, cells: cells[:2] if line == 400 else None),
    ("ned.toml:17:*", "numbers in column", column(6, to="")), ("ned.toml:29:*", "u4", column(20, to="")),
    ("table.csv:2:17", "`least`", column(17, to=lambda u: 1000 + 1000 * u)),
    ("table.csv:1001:1", "step back", lambda line, cells: [float(cells[0]) - 9, *cells[1:]] if line > 1000 else None),
    ("table.csv", "degrees per second", column(5, 6, 7, to=lambda rate: 57.3 * rate))]


@pytest.mark.parametrize("at, keyword, change", TABLES)
def test_tables(pinnquad, work, at, keyword, change):
    edited("ned.csv", "table.csv", change)
    lag = ("--lag", "0.04") if "degrees" in keyword else ()
    pinnquad.refused("import table.csv --out bad", *NED, *lag, at=at, keyword=keyword)
    left_nothing(work)


@pytest.mark.parametrize("words, at, keyword", [
    ("ned.csv --mapping px5", "", "'px5'"), ("ned.csv --mapping missing.toml", "missing.toml", "readable file"),
    ("ned.csv", "", "--mapping"), ("missing.csv NED", "missing.csv", "readable file"),
    ("quaternion.csv --mapping ENU", "quaternion.csv:77:*", "unit quaternion"),
    # the same flight twice, by whatever name: one would be judged on what it was trained on
    ("ned.csv ned.csv NED", "", "the same flight"), ("ned.csv ./ned.csv NED", "", "the same flight"),
    ("ned.csv copy.csv NED", "", "A1_wave_rep1 (2) hold the same flight"), ("ned.csv NED --lag soon", "", "--lag"),
    ("ned.csv NED --rate 0", "", "--rate"), ("cut.ulg --mapping px4", "cut.ulg", ""),
    ("empty_folder --mapping px4", "empty_folder", "ulog2csv"), ("empty_folder", "empty_folder", "found a folder without logs")])
def test_refused(pinnquad, work, words, at, keyword):
    shutil.copy("ned.csv", "copy.csv")
    edited("enu.csv", "quaternion.csv", cell(77, 5, "0.9"))
    Path("cut.ulg").write_bytes(b"ULog\x01\x12\x35\x01 and no more")
    Path("empty_folder").mkdir()
    words = words.replace("NED", f"--mapping {HERE}/ned.toml").replace("ENU", f"{HERE}/enu.toml")
    pinnquad.refused(f"import {words} --out bad", at=at, keyword=keyword)
    left_nothing(work)


def lost_on_the_ground(dataset):
    return [step["rows_before"] - step["rows_after"] for step in dataset["steps"] if step["step"] == "on the ground"]


def test_nanobench(nanobench, recorded):
    """Its authors took a lag of 30 ms, and flew."""
    dataset = facts(nanobench)
    assert any(flight["trajectory"] == "lissajous" for flight in dataset["flights"])
    assert 0.02 <= dataset["lag_removed_s"] <= 0.04 and dataset["sample_period_s"] == 0.02
    assert lost_on_the_ground(dataset) == [0]
    assert len(list(nanobench.glob("*.csv"))) == 11
    everything = table(recorded("flight_logs/nanobench_subset_50hz.csv"))
    for name in "B10_lissajous_fast_rep1", "B5_helix_fast_rep1", "B9_trefoil_medium_rep1":
        rows = [{key: float(value or "nan") for key, value in row.items() if key not in ("flight",)
                 and is_number(value)}
                for row in everything if row["flight"] == name]

        def compare(ours, theirs):
            truth = [[row["t"], *(row[key] for key in theirs.split())] for row in rows]
            return errors(truth, numbers(nanobench / f"{name}.csv", *ours.split()))

        count, found = compare("v_bx v_by v_bz w_x w_y w_z wdot_x wdot_y wdot_z roll pitch",
                               "vbx vby vbz wx wy wz dwx dwy dwz roll pitch")
        assert 1000 <= count <= 1700 and max(found) <= 1e-9
        # the motion's acceleration is specific force + R^T g - w x v; its parts stand in the file
        for row in rows:
            (wx, wy, wz), (vx, vy, vz) = ([row[f"{of}{axis}"] for axis in "xyz"] for of in ("w", "vb"))
            r, p, g = row["roll"], row["pitch"], 9.80665
            row["ax"] = row["sfx"] - g * sin(p) - (wy * vz - wz * vy)
            row["ay"] = row["sfy"] + g * sin(r) * cos(p) - (wz * vx - wx * vz)
            row["az"] = row["sfz"] + g * cos(r) * cos(p) - (wx * vy - wy * vx)
        assert max(compare("vdot_bx vdot_by vdot_bz", "ax ay az")[1]) <= 1e-9
        # their own alignment is by 30 ms, from their faster log
        # front right, rear left, front left, rear right of FR RR RL FL
        assert max(compare("u1 u2 u3 u4", "ua1 ua3 ua4 ua2")[1]) <= 0.03


def is_number(text):
    try:
        return math.isfinite(float(text or "nan")) or not text
    except ValueError:
        return False


def test_arpl(pinnquad, recorded):
    """Its authors took a lag of 35 ms."""
    said = imported(pinnquad, recorded("flight_logs/arpl_crazyflie.csv"), "--mapping", "arpl", out="arpl")
    for name in "velocity", "altitude":
        assert re.search(f"^absent: {name}", said, re.M), said
    assert 0.029 <= facts("arpl")["lag_removed_s"] <= 0.041 and lost_on_the_ground(facts("arpl")) == [0]
    for _, *moved in numbers("arpl/arpl_cf_log10_5s.csv", "v_bx", "v_by", "v_bz"):
        assert not any(moved), "a velocity was made up"


def test_px4_simulated(pinnquad, recorded):
    """Against the simulator's truth."""
    folder = recorded("sih/test_circle_csv")
    imported(pinnquad, folder, "--mapping", "px4", out="circle")
    flight, lag_s = "circle/test_circle.csv", facts("circle")["lag_removed_s"]

    def truth(topic, *names):
        return numbers(folder / f"test_circle_{topic}_0.csv", *names, clock="timestamp_sample", ticks=1e6)

    # 6 ms of its filter before
    rates_found = errors(truth("vehicle_angular_velocity_groundtruth", "xyz[0]", "xyz[1]", "xyz[2]"),
                         numbers(flight, "w_x", "w_y", "w_z"), 0.006)
    assert max(rates_found[1]) <= 0.1
    attitude = [[t, atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)), asin(2 * (w * y - z * x))]
                for t, w, x, y, z in truth("vehicle_attitude_groundtruth", "q[0]", "q[1]", "q[2]", "q[3]")]
    assert max(errors(attitude, numbers(flight, "roll", "pitch"))[1]) <= math.radians(1.5)
    height = [[t, -z] for t, z in truth("vehicle_local_position_groundtruth", "z")]
    assert errors(height, numbers(flight, "altitude"))[1][0] <= 0.6
    logged = truth("actuator_motors", *(f"control[{i}]" for i in range(4)))
    assert max(errors(logged, numbers(flight, "u1", "u2", "u3", "u4"), lag_s)[1]) <= 0.03
    # in the air by the simulator, and nearly all of it
    (phases,) = [row for row in map(lambda line: line.split(","),
                                    (folder.parent / "phases.csv").read_text().splitlines())
                 if row[0] == "test_circle"]
    times = [row[0] for row in numbers(flight)]
    assert -0.1 <= times[0] - float(phases[3]) / 1e6 <= 3 and -3 <= times[-1] - float(phases[6]) / 1e6 <= 0.1
    imported(pinnquad, recorded("sih/test_circle.ulg"), "--mapping", "px4", out="ulog")
    assert largest_difference(flight, "ulog/test_circle.csv") <= 1e-6


def test_px4_recorded(pinnquad, recorded):
    """Commands that were not logged are rebuilt."""
    folder = recorded("ulog2csv/B_px4v117_x500v2_gps")
    said = imported(pinnquad, folder, "--mapping", "px4", out="B")
    assert "vehicle_torque_setpoint" in said
    assert "warning: lag not known: " in said, "a calm flight's lag was not doubted"
    assert "actuator_controls_0" in imported(pinnquad, recorded("ulog2csv/C_px4_2016_sitl_legacy"), "--mapping", "px4",
                                             out="C")
    rebuilt = numbers(folder / "derived/motors_reconstructed_50hz.csv", "motor1_FR", "motor2_RL", "motor3_FL",
                      "motor4_RR", clock="timestamp_sample", ticks=1e6)
    count, found = errors(rebuilt, numbers(sorted(Path("B").glob("*.csv"))[0], "u1", "u2", "u3", "u4"),
                          facts("B")["lag_removed_s"])
    assert 1000 <= count <= 5000 and max(found) <= 0.02


def test_progress_on_a_terminal(pinnquad, recorded):
    """Each part has shares of its own, which never fall; those of one flight move while it is compared."""
    _, seen = on_terminal([pinnquad, "import", recorded("sih/test_circle.ulg"), "--out", "dataset"], "stderr")
    shares = {}
    for job, share in re.findall(r"([a-z][a-z0-9_ ]*): +([0-9]+) %", seen):
        shares.setdefault(job, []).append(int(share))
    assert all(of == sorted(of) for of in shares.values()), shares
    assert "reading test_circle" in shares and any(0 < share < 100 for share in shares["comparing the flights"]), shares

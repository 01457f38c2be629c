# SPDX-License-Identifier: MIT
"""replay: a model over a flight answers as the compiled model does, row by row, and says why not; a flight stack's core
over what it logged answers as it did, from a CSV, a folder and a ULog file; what was changed is found, the first tick
named."""
import csv
import json
import math
import re
import struct
import zlib
from pathlib import Path

import pytest
from conftest import SOURCE, cell, edited, listing, replaced, table
from exported import Header
from made_logs import ulog

DEMO = SOURCE / "examples/models/demo_quadrotor.hpp"
TRUST = SOURCE / "tests/flight_stacks/structured_trust.hpp"
RECORD = "flight_pinnquad_record_0.csv"
SETTINGS = "flight_pinnquad_settings_0.csv"
REACTIONS = ["flies", "holds position", "levels", "keeps commands", "gives up"]


def spoilt(source, target):
    """A flight with what a log has: NaN, infinity, empty cells, motions that no training saw, gaps, a battery. Rows
    every 20 ms."""
    with open(source) as file:
        header, *rows = csv.reader(file)
    at = {name: i for i, name in enumerate(header)}
    # every so many rows, from this one on
    holes = [(97, 5, "wdot_x", "nan"), (89, 7, "v_by", ""), (83, 9, "w_z", "-inf"), (79, 11, "roll", "nan"),
             (300, 17, "altitude", "nan")]  # which only some models ask for
    for i, row in enumerate(rows):
        row[at["t"]] = f"{0.02 * i + (1 if i >= 800 else 0):.3f}"
        row.append(f"{4.1 - 1e-4 * i:.4f}")
        for every, first, name, value in holes:
            if i % every == first:
                row[at[name]] = value
        if 400 <= i < 460:
            row[at["wdot_y"]] = str(3 * float(row[at["wdot_y"]]) + 200)
        if 600 <= i < 620:
            row[at["vdot_bz"]] = "3000"  # outside, and the analytic inverse has no rotors for it
    with open(target, "w") as file:
        csv.writer(file, lineterminator="\n").writerows([[*header, "battery_voltage [V]"], *rows])


@pytest.fixture(scope="module")
def flights(program, flown, tmp_path_factory):
    """A folder with clean.csv, flight.csv, and what the judge's models, compiled, answer to the latter."""
    folder = tmp_path_factory.mktemp("flights")
    (folder / "clean.csv").symlink_to(flown("d1 --seed 3 --samples 1200"))
    spoilt(folder / "clean.csv", folder / "flight.csv")
    program("replay_log_judge")("flight.csv .", cwd=folder)
    return folder


@pytest.fixture
def in_flights(flights, work):
    """The test's folder has what is there, by links."""
    for name in listing(flights):
        (work / name).symlink_to(flights / name)


def answers_alike(replayed, judged):
    """As the compiled model, row by row: statuses alike, commands within 1e-5."""
    judged = [line.split() for line in Path(judged).read_text().splitlines()]
    assert len(replayed) == len(judged)
    for number, (row, (status, cause, *commands)) in enumerate(zip(replayed, judged), start=1):
        assert (row["status"], row["cause"], int(row["row"])) == (status, cause, number)
        answered = {"ok": "model", "limited": "model", "fell_back": "analytic_inverse"}.get(status, "nobody")
        assert row["answered_by"] == answered and bool(row["reason"]) == (status != "ok"), (number, row)
        for i, command in enumerate(commands, start=1):
            if math.isnan(float(command)):
                assert row[f"u{i}"] == "", (number, row)
            else:
                assert abs(float(row[f"u{i}"]) - float(command)) <= 1e-5, (number, row)
    assert len({row["status"] for row in replayed}) >= 3


@pytest.mark.parametrize("guard", ["training", "flight_stack"])
def test_flights(pinnquad, in_flights, guard):
    """A network, a model of speeds; a ridge and a network with a window, as train fits them to logs."""
    reasons = {}
    for name, model in ("demo", [DEMO]), ("speeds", ["speeds.block"]), \
            ("physics", ["physics.block"]):
        said = pinnquad(f"replay flight.csv --guard {guard} --out {name}.csv --model", *model).out
        rows = table(f"{name}.csv")
        answers_alike(rows, f"{name}_{guard}.txt")
        reasons[name] = " ".join(row["reason"] for row in rows)
        assert name != "demo" or "NaN or infinite: wdot_x" in said
    assert re.search(r"wdot_y = [-0-9.]+ rad/s\^2 is (above|below) [-0-9.]+, by [0-9.e+]+ half-widths", reasons["demo"])
    header = Header(DEMO)
    ends = {side: dict(zip(header.names(), header.numbers(f"envelope_{end}")))
            for side, end in (("below", "lower"), ("above", "upper"))}
    borders = re.findall(r"(\w+) = \S+(?: \S+)? is (above|below) (\S+), by \S+ half-widths", reasons["demo"])
    assert len(borders) > 50
    for name, side, border in borders:
        assert abs(float(border) - ends[side][name]) <= 1e-3 * abs(ends[side][name]) + 1e-6, (name, side, border)
    if guard == "flight_stack":
        assert "the analytic inverse declines too" in reasons["demo"]
        behind_gap = rows[800]
        assert "warming_up" in behind_gap["cause"] and "from 160 ms before" in behind_gap["reason"], behind_gap
    assert "altitude" not in Path("demo.csv").read_text(), "complains of a column that the model does not ask for"
    assert "NaN or infinite: altitude" in reasons["speeds"]


def test_summary(pinnquad, in_flights):
    said = json.loads(pinnquad("replay flight.csv --json --out demo.csv --model", DEMO).out)
    rows = table("demo.csv")
    assert said["rows"] == len(rows) == 1200 and said["run_by"] == "flight_stack"
    for key, counts in ("answered_by", said["answered_by"]), ("status", said["statuses"]):
        for value, number in counts.items():
            assert number == sum(row[key] == value for row in rows), value
    states = [row["state"] for row in rows]
    starts = [i for i in range(len(rows)) if i == 0 or states[i] != states[i - 1]]
    assert said["event_count"] == len(starts) and [event["row"] for event in said["events"]] == [i + 1
                                                                                                 for i in starts[:10]]
    assert all(event["reason"] == rows[event["row"] - 1]["reason"] for event in said["events"])
    runs = "".join("m" if row["answered_by"] == "model" else "x" for row in rows).split("m")
    assert said["longest_without_model"]["rows"] == max(map(len, runs)) >= 60

    def difference(row):
        return max(abs(float(row[f"u{i}"]) - float(row[f"logged_u{i}"])) for i in range(1, 5))

    answered = [row for row in rows if row["u1"]]
    assert 0 < len(answered) < len(rows)
    worst, differences = max(answered, key=difference), list(map(difference, answered))
    assert said["largest_difference"]["row"] == int(worst["row"])
    assert abs(said["largest_difference"]["difference"] - difference(worst)) < 1e-12
    assert abs(said["mean_difference"] - sum(differences) / len(differences)) < 1e-12


def test_no_answer(pinnquad, in_flights):
    edited("clean.csv", "far.csv", lambda line, cells: [cells[0], 9000, *cells[2:]] if line > 1 else None)
    assert "answers no row" in pinnquad("replay far.csv --guard training --model", DEMO, code=1).err


# ---- cores


@pytest.fixture(scope="module")
def core(program, tmp_path_factory):
    """core(stack, path): the folder with what a flight stack's core logged, and its models; once."""
    made = {}

    def fly(stack, path):
        if (stack, path) not in made:
            made[stack, path] = tmp_path_factory.mktemp("core")
            program("flight_stacks_record")(stack, path, made[stack, path])
        return made[stack, path]

    return fly


def models(folder, *names):
    return [word for name in names or ("sound", "other", "narrow") for word in ("--model", folder / f"{name}.block")]


@pytest.fixture(scope="module")
def eight(core):
    return core("px4", "eight")


@pytest.fixture
def same(pinnquad):
    """same(words...): what replay says of a log that the core answers as it did."""

    def check(*words):
        said = pinnquad("replay", *words).out
        assert re.search("^same ", said, re.M), said
        return said

    return check


@pytest.fixture
def differs(pinnquad):
    """differs(pattern, words...): the last line matches."""

    def check(pattern, *words):
        done = pinnquad("replay", *words, code=1)
        last = done.out.splitlines()[-1]
        assert last.startswith("DIFFERS ") and re.search(pattern, last), (pattern, last)
        return done.out

    return check


@pytest.mark.parametrize("stack, path", [("px4", "eight"), ("crazyflie", "random_places")])
def test_cores(pinnquad, core, stack, path):
    folder = core(stack, path)
    said = json.loads(pinnquad("replay", folder, *models(folder), "--json", "--out", "replayed.csv").out)
    logged, replayed = table(folder / RECORD), table("replayed.csv")
    assert len(logged) == len(replayed) == said["rows"] == said["compared"] > 15000
    for was, now in zip(logged, replayed):
        assert was["tick"] == now["tick"] and REACTIONS[int(was["reaction"])] == now["reaction"], (was, now)
        for i in range(4):
            command, again = float(was[f"commands[{i}]"]), now[f"u{i + 1}"]
            assert again == "" if math.isnan(command) else abs(command - float(again)) <= 1e-5, (was, now)
    assert said["differing"] == 0 and said["first_difference"] is None
    assert sorted(said["reactions"]) == sorted(REACTIONS)
    assert said["statuses"]["fell_back"] > 500 and said["causes"]["outside_envelope"] > 500
    by_hand = len(logged) - sum(int(was["asked"]) for was in logged)
    assert said["answered_by"]["not_asked"] == by_hand == (0 if stack == "px4" else 750)
    assert {row["state"].split("[")[-1] for row in replayed if "[" in row["state"]} == \
        {"sound.block]", "other.block]", "narrow.block]"}
    assert {"body rates", "attitude"} <= {row["reason"].split(":")[0] for row in replayed
                                          if row["reaction"] == "keeps commands"}
    reasons = " ".join(row["reason"] for row in replayed)
    for words in "body_rates_rad_s[0] is NaN", "its norm is 1.2", "ms old, limit", "its time stamp is 1000.0 ms ahead":
        assert words in reasons, words


def test_structured(pinnquad, core, same, differs):
    """A structured model, other effects in the analytic inverse, limits of trust: to the bit."""
    folder = core("structured", "eight")
    words = [folder, *models(folder, "sound")]
    same(*words, "--out", "structured.csv")
    logged, replayed = table(folder / RECORD), table("structured.csv")
    assert len(logged) == len(replayed) > 15000
    for was, now in zip(logged, replayed):
        for i in range(4) if was["commands[0]"] != "nan" else ():
            assert struct.pack("f", float(was[f"commands[{i}]"])) == struct.pack("f", float(now[f"u{i + 1}"])), (was,
                                                                                                                 now)
    assert sum(row["answered_by"] == "model" for row in replayed) > 20000
    assert sum(row["cause"] == "distrusted" for row in replayed) > 1500
    assert re.search(r"command residual 0\..*limit 0\.018", " ".join(row["reason"] for row in replayed))
    # the analytic inverse with other effects answers otherwise, where it answers; one that is not known is refused
    differs(r"first at 5\.[0-9]* s .*: analytic_bias_sums", *words, "--set", "effects=1")
    pinnquad.refused("replay", *words, "--set", "effects=241", keyword="effects f1")
    # limits that flew are asked for: a block without is refused
    pinnquad.refused("replay", words[0], "--model", TRUST.parents[2] / "examples/models/structured_quadrotor.block",
                     keyword="limits of distance")
    # behind gaps what was distrusted still is
    drop(folder / RECORD, "planted.csv", 9000, 9100, 13000, 13003, 14000, 15000)
    settings = ["effects=18", "drag_n_s_m=1", "rate_damping_n_m_s=0.025", "distance_limit=235.03697",
                "innovation_limit=0.01800841"]
    same("planted.csv", *words[1:], *(word for setting in settings for word in ("--set", setting)))


def drop(source, target, *ticks):
    """Writes a core's log without these ticks: first, last, first, last..."""
    gaps = list(zip(ticks[::2], ticks[1::2]))
    at = Path(source).open().readline().rstrip("\n").split(",").index("tick")
    gone = lambda cells: any(first <= int(cells[at]) <= last for first, last in gaps)
    return edited(source, target, lambda line, cells: not (line > 1 and gone(cells)) and None)


def plant(source, target, tick, name, change):
    """Writes a core's log with another cell: a text, or what `change` makes of the number."""
    header = Path(source).open().readline().rstrip("\n").split(",")

    def planted(line, cells):
        if cells[header.index("tick")] == str(tick):
            at = header.index(name)
            cells[at] = repr(change(float(cells[at]))) if callable(change) else change

    return edited(source, target, planted)


def head(source, target, lines):
    return edited(source, target, lambda line, cells: None if line <= lines else False)


def test_payload(core, same, differs):
    """A model that needs much of its bias without it: the reason of the hand-over in words. To the bit, also from the
    middle, behind gaps, and of every third tick. What a tick learns is its own: a bias that was changed is found."""
    folder = core("payload", "hover")
    low = models(folder, "sound", "low")
    said = same(folder, *low)
    assert re.search("^because .*distrusted [0-9]{4,}", said,
                     re.M) and "the bias stood at its bound" in said, said
    part = Path("part")
    part.mkdir()
    (part / SETTINGS).symlink_to(folder / SETTINGS)

    def to_the_bit():
        said = same(part, *low, "--tolerance", "0")
        ticks = len(table(part / RECORD))
        assert ticks > 10000 and int(re.search("all ([0-9]+) ticks compared", said)[1]) > 0.9 * ticks, said

    drop(folder / RECORD, part / RECORD)
    to_the_bit()
    drop(folder / RECORD, part / RECORD, 1, 8123)  # from the middle, under the payload
    to_the_bit()
    drop(folder / RECORD, part / RECORD, 6500, 6900, 7500, 7600, 14000, 15000)
    to_the_bit()
    edited(folder / RECORD, part / RECORD, lambda line, cells: None if line == 1 or line % 3 == 0 else False)
    to_the_bit()
    plant(folder / RECORD, part / RECORD, 9000, "bias_sums[0]", lambda sum: sum + 0.01)
    differs(r"first at .*bias_sums\[0\]", part, *low)
    plant(folder / RECORD, part / RECORD, 9000, "analytic_bias_sums[2]", lambda sum: sum - 0.01)
    differs(r"first at .*analytic_bias_sums\[2\]", part, *low)


def test_jumps(core, same):
    """Set points that jump and fall silent at 8 m/s, a weak motor, the analytic inverse alone: no tick without an
    answer, and replay repeats them to the bit."""
    folder = core("jumps", "eight")
    same(folder, *models(folder), "--tolerance", "0")
    ticks = table(folder / RECORD)
    assert len(ticks) > 10000
    assert not [tick for tick in ticks if float(tick["reaction"]) > REACTIONS.index("holds position")]


@pytest.mark.parametrize("stack", ["px4", "crazyflie"])
def test_learnt(pinnquad, core, same, differs, stack):
    """A vehicle that is learnt in flight: to the bit, and as a model on the ground what flew."""
    folder = core("onboard", stack)
    words = [*models(folder, "sound"), "--tolerance", "0"]
    ticks = table(folder / RECORD)
    part = Path("part")
    part.mkdir()
    (part / SETTINGS).symlink_to(folder / SETTINGS)

    def learnt_of(log, into):
        said = same(log, *words, "--learnt", into)
        assert f"all {len(table(log / RECORD))} ticks compared" in said, said
        assert listing(into) == ["airframe.toml", "learnt.block", "learnt.hpp", "learnt.json", "slopes.csv", "slopes.svg"]
        return said, json.loads((Path(into) / "learnt.json").read_text())

    said, learnt = learnt_of(folder, "all")
    assert int(re.search(r"^learner +([0-9]+)", said, re.M)[1]) > 0.8 * len(ticks), said
    single = lambda number: struct.pack("f", float(number))
    proven = 0
    for name, line in zip(("thrust", "roll", "pitch", "yaw"), (folder / "flown.csv").read_text().splitlines()):
        flies, row, half_width, *terms = line.split(",")
        is_ = learnt[name]
        assert (is_["proven"], is_["proven_row"]) == (flies == "1", int(row)), (name, is_)
        assert list(map(single, is_["terms"])) == list(map(single, terms)), (name, is_)
        assert not is_["proven"] or single(is_["half_width"]) == single(half_width), (name, is_)
        assert is_["swaps"] and is_["swaps"][-1]["slope"] == is_["slope"], (name, is_)
        proven += is_["proven"]
    assert proven >= 3
    assert "kg" in pinnquad("airframe check all/airframe.toml").out
    # its model is one as any other: proven by its structure with the slopes that flew, and flies in a loop
    block = json.loads(pinnquad("block all/learnt.block --json").out)
    assert block["proven"] and block["provenance"]["training_data"].startswith("learnt in flight: "), block
    certified = json.loads(pinnquad("certify all/learnt.hpp --json").out)
    assert certified["verdict"] == "proven", certified
    for axis in ("roll", "pitch", "yaw"):
        assert certified["slope"][axis] * learnt[axis]["slope"] == pytest.approx(1, rel=1e-6), certified
    rows = json.loads(pinnquad("loop all/learnt.block --controllers adaptive --json", code=1).out)["rows"]
    assert len(rows) == 1 and rows[0]["rmse_cm"] < 2, rows  # with a bias, as it flew
    rows = table("all/slopes.csv")
    assert len(rows) >= 37 and float(rows[-1]["roll_slope"]) == learnt["roll"]["slope"]
    # a log that begins before the flight tells all of it; one that begins in flight, or has a gap there, does not
    drop(folder / RECORD, part / RECORD, 1, 400)
    assert learnt_of(part, "later")[1] == learnt
    late = len(ticks) // 2
    for first, last in (1, late), (late, late):
        drop(folder / RECORD, part / RECORD, first, last)
        left = len(table(part / RECORD))
        said = same(part, *words)
        assert re.search("all ([0-9]+) ticks compared", said) and int(
            re.search("([0-9]+) ticks not compared", said)[1]) > 0.3 * left, said
        pinnquad.refused("replay", part, *words, "--learnt", "none", keyword="flight that is not in this log")
    plant(folder / RECORD, part / RECORD, late, "learnt", "1")
    said = differs("learnt [0-9]+, logged 1", part, *words, "--learnt", "none")
    assert "nothing is written" in said and not Path("none").exists()
    plant(folder / RECORD, part / RECORD, late, "body_rates_rad_s[1]", lambda rate: rate + 0.3)
    differs("u1", part, *words)


def test_learnt_of_no_learner(pinnquad, eight, flown):
    head(eight / RECORD, RECORD, 101)
    pinnquad.refused("replay", RECORD, *models(eight), "--learnt", "none", keyword="in no tick of this log")
    flight = flown("d1 --seed 3 --samples 1200")
    pinnquad.refused("replay", flight, "--model", DEMO, "--learnt", "none", keyword="none of its records")


def test_earlier_core(pinnquad, eight):
    """Ticks of a core whose bias was an acceleration."""
    head(eight / RECORD, "short.csv", 101)
    replaced("short.csv", "earlier.csv", (r"\bbias_across_m_s2\b", "bias_m_s2"))
    pinnquad.refused("replay", "earlier.csv", *models(eight), at="earlier.csv:1", keyword="a core before flew")


def core_topic(folder, name):
    """One of the two messages of a core's log, for ulog()."""
    topic, message = f"pinnquad_{name.lower()}", SOURCE / f"examples/px4_module/msg/Pinnquad{name}.msg"
    types = {"float32": "float", **{kind: f"{kind}_t" for kind in ("uint64", "uint32", "int8", "uint8")}}
    fields = [f"{types[kind]}{count} {field}" for kind, count, field in
              re.findall(r"^(\w+)((?:\[\d+\])?) +(\w+) *(?:#.*)?$", message.read_text(), re.M)]
    return topic, fields, [list(row.values()) for row in table(folder / f"flight_{topic}_0.csv")]


def test_one_log_in_other_forms(pinnquad, eight, same):
    same(eight / RECORD, *models(eight))
    ulog("flight.ulg", [core_topic(eight, name) for name in ("Record", "Settings")])
    same("flight.ulg", *models(eight))
    # what is whole of it is run
    whole = Path("flight.ulg").read_bytes()
    Path("cut.ulg").write_bytes(whole[:3000])
    assert re.search("^note .*cut.ulg", same("cut.ulg", *models(eight)), re.M)
    Path("cut.ulg").write_bytes(whole[:600])
    pinnquad.refused("replay cut.ulg", *models(eight), at="cut.ulg", keyword="pinnquad_record")


def test_other_models(pinnquad, eight, differs):
    """In place of the one that flew; one bit of a weight; an edited block is refused."""
    said = differs(r"first at 5\.000 s \(tick 2\): u1 ", eight / RECORD, *models(eight, "other"))
    assert re.search("a model of checksum [0-9a-f]* flew from 5.000 s", said)
    differs(r"first at [0-9.]* s \(tick [0-9]*\): ", eight / RECORD, *models(eight, "bit"))
    block = bytearray((eight / "sound.block").read_bytes())
    block[-4 - 4 * 100 + 2] ^= 0x40  # high in the mantissa of a weight
    block[-4:] = struct.pack("<I", zlib.crc32(block[:-4]))
    Path("wrong.block").write_bytes(block)
    pinnquad.refused("replay", eight / RECORD, "--model", "wrong.block", at="wrong.block", keyword="contents")


@pytest.mark.parametrize("pattern, words", [
    (r"first at 5\.0[0-9]* s \(tick [0-9]*\): .*u[1-4] ", "--set tilt_1_s=9.01"),
    ("first at 13.*levels", "--set local_us=200000"), (" in 1 of", "--tolerance 1 --set keep_us=39000")])
def test_other_settings(eight, differs, pattern, words):
    differs(pattern, eight / RECORD, *models(eight), *words.split())


def test_other_gain_in_the_log(eight, differs):
    Path("gain").mkdir()
    Path("gain", RECORD).symlink_to(eight / RECORD)
    replaced(eight / SETTINGS, f"gain/{SETTINGS}", (",9,3,22,8,", ",9,3,22,8.01,"))
    differs("first at ", "gain", *models(eight))


def test_later_settings(eight, same):
    """Of several settings in a log those count that held when the core began."""
    Path("later").mkdir()
    Path("later", RECORD).symlink_to(eight / RECORD)
    lines = (eight / SETTINGS).read_text().splitlines()
    names, later = lines[0].split(","), lines[-1].split(",")
    later[names.index("timestamp")], later[names.index("tilt_1_s")] = str(10**9), "9.01"
    Path("later", SETTINGS).write_text("\n".join([*lines, ",".join(later)]) + "\n")
    same("later", *models(eight))


@pytest.mark.parametrize("tick, name, change, pattern", [
    (7000, "status", "11", r" in 1 of 9000 ticks, first at 11\.998 s \(tick 7000\): status ok, logged fell_back$"),
    (7001, "reaction", "2", r"\(tick 7001\): it flies, logged: levels$"),
    (7002, "commands[2]", lambda u: u + 2e-5, r"\(tick 7002\): u3 [0-9.]*, logged [0-9.]*$"),
    (7002, "commands[2]", lambda u: u + 5e-6, ""), (7003, "commands[1]", "nan",
                                                    r"\(tick 7003\): u2 [0-9.]*, logged nan$"),
    (7004, "stale_inputs", "4", r"\(tick 7004\): stale: none, logged: position and velocity$"),
    (7005, "refused_samples", "1", r"\(tick 7005\): 0 samples refused, logged 1$"),
    # 0.026 half-widths outside the envelope are no rounding
    (8605, "cause", "0", r" in 1 of 9000 ticks, .*\(tick 8605\): "),
    # an input: the answer is another
    (7001, "body_rates_rad_s[1]", lambda rate: rate + 0.01, r" in 1 of 9000 ticks, .*\(tick 7001\): u1 ")])
def test_one_cell(eight, same, differs, tick, name, change, pattern):
    head(eight / RECORD, "short.csv", 9001)
    plant("short.csv", "planted.csv", tick, name, change)
    if pattern:
        differs(pattern, "planted.csv", *models(eight))
    else:
        same("planted.csv", *models(eight))


def test_ticks_that_were_not_logged(pinnquad, eight, same):
    """In flight, while it levels, holds its place, keeps its commands, refuses NaN."""
    head(eight / RECORD, "short.csv", 17001)
    assert "no topic pinnquad_settings" in same("short.csv", *models(eight))
    drop("short.csv", "planted.csv", 3, 400, 7000, 7050, 8200, 8210, 11400, 11600, 11700, 11710, 15005, 15007, 15015,
         15018, 16005, 16010, 16025, 16026)
    assert re.search("^note +[0-9]+ ticks not compared: behind gaps", same("planted.csv", *models(eight)), re.M)
    drop("short.csv", "planted.csv", 2, 7000)
    same("planted.csv", *models(eight))
    # nothing of a log can be compared: a finding, not the same
    edited(eight / RECORD, "planted.csv", lambda line, cells: None if line == 1 or 16006 < line <= 16011 else False)
    for words in [], ["--json"]:
        done = pinnquad("replay planted.csv", *models(eight), *words, code=1)
        assert "planted.csv: nothing compared" in done.err and not re.search("^same", done.out, re.M), done
        assert '"compared": 0' in done.out if words else done.out.splitlines()[-1].startswith("NOTHING "), done


@pytest.mark.parametrize("tick, name, change, at, keyword", [
    (50, "reaction", "2.5", "planted.csv:50", "found 2.5"), (50, "timestamp", "nan", "planted.csv:50", "found nan"),
    (50, "attitude[0]", "text", "planted.csv:1", "attitude[0]"), (50, "attitude[0]", "1e300", "planted.csv:50",
                                                                  "32-bit"),
    (50, "model", "123", "", "0000007b")])
def test_refused_cells(pinnquad, eight, tick, name, change, at, keyword):
    head(eight / RECORD, "short.csv", 101)  # progress would be a line of its own
    plant("short.csv", "planted.csv", tick, name, change)
    pinnquad.refused("replay planted.csv", *models(eight), at=at, keyword=keyword)


@pytest.mark.parametrize("words, at, keyword", [
    ("none.csv DEMO", "none.csv", "readable"), ("short.csv --model none.block", "none.block", "readable file"),
    ("renamed.csv MODELS", "renamed.csv:1", "came"), ("short.csv MODELS --set tilt=7", "", "tilt_1_s"),
    ("short.csv MODELS --set tilt_1_s=x", "", "NUMBER"), ("short.csv MODELS --set keep_us=1.5", "", "NUMBER"),
    ("short.csv --model speeds.block", "", "float models"), ("flight.csv DEMO --model speeds.block", "", "one model"),
    ("flight.csv DEMO --set tilt_1_s=7", "", "--set"), ("back.csv DEMO", "back.csv:5", "found 0"),
    ("text.csv DEMO", "text.csv:7", '"abc"'), ("narrow.csv DEMO", "narrow.csv:1", "w_x"),
    ("empty DEMO", "empty", "expected"), ("flight.csv DEMO --out flight.csv", "", "same file")])
def test_refused(pinnquad, in_flights, eight, words, at, keyword):
    head(eight / RECORD, "short.csv", 101)
    replaced("short.csv", "renamed.csv", (r"\bcame\b", "cane"))
    edited("clean.csv", "back.csv", cell(5, 1, 0))
    edited("clean.csv", "text.csv", cell(7, 4, "abc"))
    edited("clean.csv", "narrow.csv", lambda line, cells: cells[:10])
    Path("empty").mkdir()
    words = [word for name in words.split() for word in
             {"DEMO": ["--model", DEMO], "MODELS": models(eight)}.get(name, [name])]
    before = listing(".")
    pinnquad.refused("replay", *words, at=at, keyword=keyword)
    assert listing(".") == before

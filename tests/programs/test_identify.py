# SPDX-License-Identifier: MIT
"""The vehicle that flew: found again in simulated flights and in PX4's simulation, whose numbers are known; what no
vehicle can be found in is refused, with file, column and evidence, and nothing is written."""
import json
import re
import shutil
import tomllib
from pathlib import Path

import pytest
from conftest import column, edited, no_partial_files, replaced, table
from made_logs import FLIGHT_MAPPING

FLOWN = "d1 --airframe px4_sih --seed 3 --samples 6000"
FLIGHT = {name: at for at, name in enumerate(
    "t vdot_bx vdot_by vdot_bz wdot_x wdot_y wdot_z v_bx v_by v_bz w_x w_y w_z roll pitch yaw altitude u1 u2 u3 u4".split(),
    start=1)}
MOTORS = [FLIGHT[f"u{motor}"] for motor in (1, 2, 3, 4)]
TURNS = "roll", "pitch", "yaw"


def identified(pinnquad, *words):
    return json.loads(pinnquad("identify --json", *words).out)


def value(found, key):
    return found["numbers"][key]["value"]


def holds(found, key, truth, slack=0.0):
    number = found["numbers"][key]
    return number["low"] - slack <= truth <= number["high"] + slack


@pytest.fixture
def flight(flown):
    return flown(FLOWN)


def test_simulated_flight(pinnquad, flight):
    found = identified(pinnquad, flight, "--airframe", "px4_sih", "--out", "vehicle.toml")
    thinner = 0.985  # the air at 157 m over that of the coefficients
    for turn, truth in zip(TURNS, (40, 40, 3.333)):
        assert value(found, f"{turn}_effectiveness_rad_s2") == pytest.approx(truth * thinner, rel=0.06), turn
    assert value(found, "thrust_m_s2") == pytest.approx(5 * thinner, rel=0.005)
    assert value(found, "response_s") == pytest.approx(0.05, rel=0.2)
    assert found["numbers"]["thrust_m_s2"]["excitation"] == "good"
    assert found["assumed"][0].startswith("mass 1 kg (of px4_sih)")
    assert "thrust-to-weight 2.0" in pinnquad("airframe check vehicle.toml").out
    pinnquad("fly d1 --airframe vehicle.toml --seed 4 --samples 4000 --out again.csv")
    again = identified(pinnquad, "again.csv", "--airframe", "vehicle.toml")
    assert value(again, "thrust_m_s2") == pytest.approx(value(found, "thrust_m_s2") * thinner, rel=0.02)


def test_told_for_people(pinnquad, flight):
    said = pinnquad("identify", flight).flat
    for words in ("95 % interval", "roll effectiveness", "not from the flights", "mass 1 kg (assumed)", "arms 0.2 m"):
        assert words in said, words
    assert re.search(r"not determined: gyroscopic term of roll .*; fly: ", said), said


def test_mass_and_arms_are_taken_from_options(pinnquad, flight):
    made = {}
    for words in ("--mass 1 --arm 0.2", "--mass 2 --arm 0.2", "--mass 1 --arm 0.1"):
        pinnquad(f"identify {words} --out made.toml", flight)
        made[words] = tomllib.loads(Path("made.toml").read_text())
    plain, heavy, short = made.values()
    assert heavy["mass_kg"] == 2 and short["rotor"][0]["x_m"] == pytest.approx(0.1, rel=0.02)
    for axis in range(3):
        assert heavy["inertia_kg_m2"][axis] == pytest.approx(2 * plain["inertia_kg_m2"][axis])
        assert short["inertia_kg_m2"][axis] == pytest.approx(plain["inertia_kg_m2"][axis] / 2)
    assert "# not of the flights: mass 1 kg (--mass)" in Path("made.toml").read_text()


def test_a_thrust_curve(pinnquad, flight):
    def square(line, cells):
        for at in MOTORS if line > 1 else ():
            cells[at - 1] = repr(float(cells[at - 1]) ** 0.5)

    edited(flight, "speeds.csv", square)  # the commands as rotor speeds
    found = identified(pinnquad, "speeds.csv", "--thrust-curve", "fit", "--out", "curved.toml")
    assert value(found, "thrust_curve") == pytest.approx(1, abs=0.05)
    assert value(found, "thrust_m_s2") == pytest.approx(4.925, rel=0.02)
    assert tomllib.loads(Path("curved.toml").read_text())["rotor"][3]["thrust_curve"] > 0.9


THROTTLE = FLIGHT_MAPPING.replace('"thrust"', '"signal", least = 1000, most = 2000')


def test_a_throttle(pinnquad, flown):
    """Pulse widths whose thrust follows 0.4 u + 0.6 u^2: the curve is found by default, and commands stay what the
    motors are given."""
    def pulses(curve):
        def edit(line, cells):
            for at in MOTORS if line > 1 else ():
                share = float(cells[at - 1])
                u = 2 * share / (1 - curve + ((1 - curve) ** 2 + 4 * curve * share) ** 0.5)
                cells[at - 1] = repr(1000 + 1000 * u)
        return edit

    flight = flown("d1 --airframe px4_sih --seed 3 --interval 10 --samples 6000")
    edited(flight, "throttle.csv", pulses(0.6))
    edited(flight, "straight.csv", pulses(0))
    Path("throttle.toml").write_text(THROTTLE)
    Path("stated.toml").write_text(THROTTLE.replace("2000", "2000, thrust_curve = 0.6"))
    said = pinnquad("import throttle.csv --mapping throttle.toml --out throttle").out
    assert re.search(r"^thrust curve of the commands, .*: k = 0\.(59|6|61) \(.* in flight throttle by roll 0\.\d.*overrules", said,
                     re.M), said
    assert "by its slope" not in said
    for words in ("throttle.csv --mapping throttle.toml", "throttle", "throttle.csv --mapping stated.toml"):
        found = identified(pinnquad, *words.split(), "--out", "found.toml")
        assert value(found, "thrust_m_s2") == pytest.approx(4.925, rel=0.02), words
        rotors = tomllib.loads(Path("found.toml").read_text())["rotor"]
        assert [rotor["thrust_curve"] for rotor in rotors] == pytest.approx([0.6] * 4, abs=0.02), words
    imported = {}
    for name in ("throttle", "stated"):
        pinnquad(f"import throttle.csv --mapping {name}.toml --lag 0 --out {name}")
        imported[name] = [float(row["u1"]) for row in table(next(Path(name).glob("*.csv")))]
        about = json.loads((Path(name) / "dataset.json").read_text())["thrust_curve"]
        assert about["k"] == pytest.approx(0.6, abs=0.02) and about["fitted"] == (name == "throttle")
    assert imported["throttle"] == pytest.approx(imported["stated"], abs=1e-9)
    pinnquad("import throttle.csv --mapping throttle.toml --lag 0 --thrust-curve 0.6 --out given")
    assert Path("given/throttle.csv").read_text() == Path("stated/throttle.csv").read_text()
    assert json.loads(Path("given/dataset.json").read_text())["thrust_curve"] == json.loads(
        Path("stated/dataset.json").read_text())["thrust_curve"]
    pinnquad.refused("import throttle.csv --mapping throttle.toml --thrust-curve 2 --out bad", keyword="--thrust-curve")
    Path("speeds.toml").write_text(THROTTLE.replace("signal", "speed"))
    pinnquad.refused("import throttle.csv --mapping speeds.toml --airframe px4_sih --thrust-curve 0.6 --out bad",
                     keyword="rotor speeds")
    pinnquad("import throttle.csv --mapping stated.toml --lag 0 --rate 200 --out between")
    thrusts = {round(200 * t): 0.4 * u + 0.6 * u ** 2 for t, u in
               ((float(row["t"]), float(row["u1"])) for row in table(next(Path("between").glob("*.csv"))))}
    middles = [(thrusts[at], (thrusts[at - 1] + thrusts[at + 1]) / 2) for at in thrusts
               if at % 2 and at - 1 in thrusts and at + 1 in thrusts]
    assert len(middles) > 5000  # thrusts have a mean, motor values have none
    assert max(abs(thrust - mean) for thrust, mean in middles) < 1e-9
    assert "straight, k = 0 taken" in pinnquad("import straight.csv --mapping throttle.toml --out straight").out


@pytest.fixture
def excited(unpacked):
    """A log of PX4's simulation with multisines, and its payload flight."""
    return unpacked("train_excite", "payload")


def test_px4_simulation(pinnquad, excited):
    found = identified(pinnquad, excited / "train_excite.ulg", "--mapping", "px4")
    for key, truth in (("thrust_m_s2", 5), ("roll_effectiveness_rad_s2", 40), ("pitch_effectiveness_rad_s2", 40),
                       ("yaw_effectiveness_rad_s2", 3.3333)):
        assert value(found, key) == pytest.approx(truth, rel=0.01), key
    for key, truth in (("thrust_m_s2", 5), ("roll_effectiveness_rad_s2", 40), ("pitch_effectiveness_rad_s2", 40),
                       ("rotor_lag_s", 0.048), ("roll_damping_1_s", 1), ("pitch_damping_1_s", 1),
                       ("yaw_damping_1_s", 0.8333), ("gyroscopic_roll", -0.2), ("gyroscopic_pitch", 0.2)):
        assert holds(found, key, truth), (key, found["numbers"][key])
    assert value(found, "delay_s") == pytest.approx(0.004, abs=0.004)
    payload = identified(pinnquad, excited / "payload.ulg", "--mapping", "px4", "--mass", "1.2")
    assert value(payload, "thrust_m_s2") == pytest.approx(4.1667, rel=0.01)


def test_a_dataset_says_what_its_import_shifted(pinnquad, excited):
    pinnquad("import --mapping px4 --lag 0.036 --out shifted", excited / "payload.ulg")
    shifted = identified(pinnquad, "shifted")
    log = identified(pinnquad, excited / "payload.ulg", "--mapping", "px4")
    assert shifted["lag_removed_s"] == 0.036
    assert value(shifted, "response_s") == pytest.approx(value(log, "response_s"), abs=0.002)


def standing(line, cells):
    """Rows of a vehicle that stands level on the ground, its motors idle."""
    if line > 1:
        for name, at in FLIGHT.items():
            if name not in ("t", "altitude"):
                cells[at - 1] = repr(1e-4 * ((line * at) % 7))
        for at in MOTORS:
            cells[at - 1] = repr(0.06 + 1e-3 * ((line * at) % 5))


def exchanged(line, cells):
    if line > 1:
        first, second = MOTORS[0] - 1, MOTORS[2] - 1
        cells[first], cells[second] = cells[second], cells[first]


def hovering(line, cells):
    if line > 1:
        for at in MOTORS:
            cells[at - 1] = "0.5"


@pytest.mark.parametrize("change, word, code", [
    (column(FLIGHT["w_y"], to="0.25"), "w_y", 2),
    (standing, "in the air", 2),
    (column(MOTORS[2], to="1"), "u3", 2),
    (exchanged, "motors", 2),
    (hovering, "roll effectiveness", 1),
    (column(FLIGHT["wdot_z"], FLIGHT["w_z"], to=lambda w: -w), "yaw", 2),
], ids=["frozen", "on the ground", "saturated", "motor order", "no excitation", "yaw reversed"])
def test_refused(pinnquad, flight, change, word, code):
    edited(flight, "bad.csv", change)
    pinnquad.refused("identify bad.csv --out vehicle.toml", at="bad.csv", keyword=word, code=code)
    assert not Path("vehicle.toml").exists()
    no_partial_files(".")


def test_roll_and_pitch_that_are_unlike(pinnquad):
    """One of four times the other's moment of inertia is told, and identified."""
    pinnquad("airframe convert px4_sih --out usual.toml")
    replaced("usual.toml", "long.toml", ("^inertia_kg_m2 = .*", "inertia_kg_m2 = [0.012, 0.048, 0.055]"))
    pinnquad("fly d1 --airframe long.toml --seed 3 --samples 6000 --out long.csv")
    said = pinnquad("identify long.csv --airframe long.toml --out made.toml").out
    assert re.search("^warning: roll effectiveness is .* pitch effectiveness .* factor of 3", said, re.M), said


def test_a_flight_of_a_dataset_is_named(pinnquad, flight, dataset):
    edited(flight, "bad.csv", column(FLIGHT["w_y"], to="0.25"))
    dataset("flights", {"good": flight, "bad": "bad.csv"})
    pinnquad.refused("identify flights", at="flights/bad.csv", keyword="w_y")


def test_too_short(pinnquad, flown):
    short = flown("d1 --samples 100")
    pinnquad.refused("identify --out vehicle.toml", short, at=short.name, keyword="10 s", code=1)
    assert not Path("vehicle.toml").exists()


@pytest.mark.parametrize("words, keyword", [
    ("", "expected FLIGHTS"), ("a raw.csv", "one dataset"), ("raw.csv", "none of these names"),
    ("--log raw.csv", "identify ... LOGS"),
    ("b.csv --rate 100", "--rate"), ("b.csv --out vehicle.hpp", ".toml"),
    ("b.csv --mass 0", "--mass"), ("nowhere.csv", "nowhere.csv")])
def test_options_that_make_no_sense(pinnquad, words, keyword):
    Path("a").mkdir()
    Path("a/dataset.json").touch()
    Path("raw.csv").write_text("a,b\n1,2\n")
    pinnquad.refused(f"identify {words}", keyword=keyword)


def test_a_curve_is_a_number_or_fit(pinnquad, flight):
    pinnquad.refused("identify --thrust-curve 2", flight, keyword="--thrust-curve")


def test_the_flight_is_not_overwritten(pinnquad, flight):
    shutil.copy(flight, "flight.toml")
    pinnquad.refused("identify flight.toml --out flight.toml", keyword="same file")
    Path("mine.toml").write_text("")
    pinnquad.refused("identify flight.toml --mapping mine.toml --out mine.toml", keyword="same file")

# SPDX-License-Identifier: MIT
"""The vehicle that flew, from Python: the program's numbers and file, an airframe that flies and trains, refusals."""
import dataclasses
import json
import lzma
import signal
import threading

import numpy as np
import pytest

import pinnquad
from conftest import SOURCE
from pinnquad import Airframe, Dataset, Flight


def as_printed(numbers):
    """As the program prints them: a number that is determined has no flight to fly."""
    printed = {name: dataclasses.asdict(number) for name, number in numbers.items()}
    return {name: {key: value for key, value in number.items() if key != "fly" or value} for name, number in printed.items()}


@pytest.fixture(scope="module")
def flown():
    """Five minutes of a vehicle whose numbers are known: PX4's simulation's."""
    return pinnquad.fly("d1", airframe="px4_sih", seed=3, rows=6000)


def test_the_numbers_and_the_file_of_the_program(program, flown, tmp_path):
    flown.save(tmp_path / "flight.csv")
    theirs = json.loads(program("identify", tmp_path / "flight.csv", "--airframe", "px4_sih", "--json", "--out",
                                tmp_path / "theirs.toml", "--name", "mine"))
    ours = pinnquad.identify(Flight.read(tmp_path / "flight.csv"), "px4_sih", name="mine")
    assert as_printed(ours.numbers) == theirs["numbers"]
    assert (ours.assumed, ours.warnings, ours.duration_s) == (theirs["assumed"], theirs["warnings"], theirs["duration_s"])
    ours.save(tmp_path / "ours.toml")
    assert (tmp_path / "ours.toml").read_bytes() == (tmp_path / "theirs.toml").read_bytes()
    assert Airframe(tmp_path / "ours.toml") == ours.airframe


def test_the_numbers_of_the_program_with_a_mass_and_a_curve(program, flown, tmp_path):
    flown.save(tmp_path / "flight.csv")
    theirs = json.loads(program("identify", tmp_path / "flight.csv", "--mass", 2, "--arm", 0.3,
                                "--thrust-curve", "fit", "--json"))
    ours = pinnquad.identify(Flight.read(tmp_path / "flight.csv"), mass_kg=2, arm_m=0.3, thrust_curve="fit")
    assert as_printed(ours.numbers) == theirs["numbers"] and "thrust_curve" in ours.numbers
    assert ours.assumed[0] == "mass 2 kg (mass_kg)" and ours.airframe.mass_kg == 2
    assert abs(ours.airframe.rotors[0].x_m) == pytest.approx(0.3, abs=0.01)


def test_the_vehicle_is_found_and_flies(flown):
    found = pinnquad.identify(flown, "px4_sih")
    number = found.numbers["roll_effectiveness_rad_s2"]
    assert number.low < number.value < number.high and number.unit == "rad/s^2"
    assert number.value == pytest.approx(0.985 * 40, rel=0.06)  # the air at 157 m is thinner
    assert number.excitation in ("good", "fair") and number.fly is None
    assert found.numbers["gyroscopic_roll"].excitation == "not determined" and found.numbers["gyroscopic_roll"].fly
    assert "numbers determined" in repr(found)
    airframe = found.airframe
    airframe.check()
    airframe.mass_kg = 9
    assert found.airframe.mass_kg == 1  # each a new one
    training = pinnquad.train(pinnquad.fly(airframe=found.airframe, rows=2400), found.airframe, models=["structured"],
                              seeds=1, epochs=1)
    assert training.r2 > 0.8 and training.model.airframe == found.airframe


def test_several_flights_and_a_dataset(flown):
    other = pinnquad.fly("d1", airframe="px4_sih", seed=4, rows=6000)
    together = pinnquad.identify([flown, other], "px4_sih")
    assert together.numbers == pinnquad.identify(Dataset([flown, other]), "px4_sih").numbers
    width = {count: found.numbers["thrust_m_s2"] for count, found in ((1, pinnquad.identify(flown, "px4_sih")),
                                                                      (2, together))}
    assert together.duration_s > 1.9 * pinnquad.identify(flown).duration_s
    assert width[2].high - width[2].low < width[1].high - width[1].low


def refused(kind, words, *arguments, **choices):
    with pytest.raises(kind, match=words) as caught:
        pinnquad.identify(*arguments, **choices)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("choices, words", [
    ({"mass_kg": 0}, "mass_kg"), ({"mass_kg": float("nan")}, "mass_kg"), ({"arm_m": -1}, "arm_m"),
    ({"thrust_curve": "steep"}, "thrust_curve"), ({"thrust_curve": 2}, "thrust_curve"), ({"airframe": "kite"}, "kite")])
def test_choices_that_make_no_sense(flown, choices, words):
    refused((ValueError, pinnquad.Error), words, flown, **choices)


def test_what_is_no_flight():
    for wrong in (None, 3, [], "flight.csv", np.zeros((100, 21))):
        with pytest.raises((TypeError, ValueError)):
            pinnquad.identify(wrong)
    with pytest.raises(TypeError, match="not pickled"):
        pinnquad.Identification.__reduce__(pinnquad.identify(pinnquad.fly(rows=2400)))


def test_ctrl_c_ends_it(flown):
    flights = [flown] + [pinnquad.fly("d1", airframe="px4_sih", seed=seed, rows=6000) for seed in (5, 6, 7)]
    main = threading.main_thread().ident
    threading.Timer(0.02, signal.pthread_kill, (main, signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        pinnquad.identify(flights)


def test_nothing_is_half_written(flown, tmp_path):
    found = pinnquad.identify(flown)
    with pytest.raises(OSError):
        found.save(tmp_path / "absent/vehicle.toml")
    assert not list(tmp_path.iterdir())


def test_a_log_as_the_program_reads_it(program, tmp_path):
    packed = SOURCE.parent / "shared/reference/sih/train_excite.ulg.xz"
    if not packed.exists():
        pytest.skip(f"no {packed}")
    log = tmp_path / "train_excite.ulg"
    log.write_bytes(lzma.open(packed).read())
    theirs = json.loads(program("identify", log, "--mapping", "px4", "--mass", 1.2, "--json"))
    rows = Dataset.read([log], mapping="px4", lag_s=0, keep_saturated=True)
    ours = pinnquad.identify(rows, mass_kg=1.2)
    assert (as_printed(ours.numbers), ours.warnings) == (theirs["numbers"], theirs["warnings"])

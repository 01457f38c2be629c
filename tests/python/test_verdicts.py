# SPDX-License-Identifier: MIT
"""May it fly? The verdict of the program on the same model, and its figures in the closed loop, to the digit."""
import json

import numpy as np
import pytest
from conftest import MODELS

import pinnquad
from pinnquad import Flight

BLOCKS = ["structured_quadrotor", "demo_quadrotor", "crazyflie_2_1"]


@pytest.mark.parametrize("name", BLOCKS)
def test_a_flight_in_the_loop_is_the_programs(program, name):
    model = pinnquad.Model.load(MODELS / f"{name}.block")
    flown = pinnquad.loop(model)
    said = json.loads(program("loop", MODELS / f"{name}.block", "--json", fails=True))
    assert flown.report == said
    assert flown.model["rmse_m"] == said["model"]["rmse_m"] and flown.flight_verdict.in_words == said["verdict"]["in_words"]
    assert model.flight_verdict == flown.flight_verdict  # by the same figure-eight
    assert repr(flown).splitlines()[0] == repr(model).splitlines()[0] == said["verdict"]["in_words"]


def test_other_flights_are_the_programs(program, structured, tmp_path):
    path = tmp_path / "path.csv"
    path.write_text("t,x,y,z,yaw\n0,0,0,0,0\n3,2,1,-1,0.3\n6,0,3,0,0\n9,0,0,0,0\n")
    airframe = tmp_path / "heavy.toml"
    heavy = structured.airframe
    heavy.mass_kg *= 1.2
    heavy.save(airframe)
    for words, arguments in ((("--trajectory", "circle"), {"trajectory": "circle"}),
                             (("--trajectory", path), {"trajectory": path}),
                             (("--guard", "none", "--trajectory", "yaw_eight"), {"guard": False, "trajectory": "yaw_eight"}),
                             (("--airframe", airframe, "--battery", "4x1500", "--battery-charge", 50),
                              {"airframe": airframe, "battery": "4x1500", "battery_charge": 50})):
        flown = pinnquad.loop(structured, **arguments)
        assert flown.report == json.loads(program("loop", MODELS / "structured_quadrotor.block", "--json", *words, fails=True))


def test_a_training_is_judged_as_the_program_judges_it(program, flight, tmp_path):
    """The whole header, whose first lines say the verdict, is compared in test_training.py."""
    flight.save(tmp_path / "flight.csv")
    out = tmp_path / "theirs"
    program("train", tmp_path / "flight.csv", "--models", "formula,structured", "--seeds", 1, "--epochs", 2, "--out", out)
    said = json.loads((out / "report.json").read_text())["verdict"]
    training = pinnquad.train(Flight.read(tmp_path / "flight.csv"), models=["formula", "structured"], seeds=1, epochs=2)
    found = training.flight_verdict
    for key in ("may_fly", "in_words", "why", "reasons", "evidence"):
        assert getattr(found, key) == said[key], key
    assert found.next == said["next"].replace(str(out / "model.block"), "model.block")
    assert found.may_fly == "fit" and repr(training).startswith(f"{found.in_words}\n<pinnquad.Training: structured")


def test_a_good_model_may_fly_and_a_turned_one_may_not():
    """Left and right motors are exchanged: the network explains its flight as well, and turns the wrong way."""
    flight = pinnquad.fly(rows=6000)
    turned = flight.rows.copy()
    turned[:, 17:] = flight.commands[:, [2, 3, 0, 1]]
    good, bad = (pinnquad.train(one, models=["small_vanilla"], seeds=1, epochs=600)
                 for one in (flight, Flight(turned, "turned")))
    assert min(good.r2, bad.r2) > 0.9
    assert good.flight_verdict.may_fly == "care" and "no proof" in good.flight_verdict.why
    for found in (bad.flight_verdict, bad.model.flight_verdict, pinnquad.loop(bad.model).flight_verdict,
                  pinnquad.evaluate(bad.model, flight).flight_verdict, pinnquad.certify(bad.model, 1).flight_verdict):
        assert found.may_fly == "no" and found.in_words.startswith("do not fly: ") and "loses the vehicle" in found.why


def test_what_is_known_of_a_model_counts(structured, network, flight):
    """Flights on which it is worse than its block records, and a counterexample."""
    other = Flight(flight.rows + np.r_[np.zeros(17), 0.5 * np.ones(4)] * (flight.rows[:, :1] > 60), "other")
    judged = pinnquad.evaluate(structured, other)
    assert structured.flight_verdict.may_fly == "fit" and judged.flight_verdict.may_fly == "no"
    assert "these flights" in judged.flight_verdict.why and repr(judged).startswith("do not fly: ")
    refuted = pinnquad.certify(network, seconds=20)
    assert refuted.verdict == "counterexample" and "it may command less torque" in refuted.flight_verdict.why
    assert repr(refuted).startswith("fly with care: ")


def test_an_estimator_shows_it(flight):
    estimator = pinnquad.StructuredInverse(epochs=2)
    assert repr(estimator).startswith("StructuredInverse(")
    found = estimator.fit(flight).flight_verdict_
    assert found.may_fly == "fit" and repr(estimator).startswith(f"{found.in_words}\nStructuredInverse(")


def test_a_verdict_is_no_truth_value(structured):
    with pytest.raises(TypeError, match="look at may_fly"):
        bool(structured.flight_verdict)
    assert str(structured.flight_verdict).splitlines()[1].startswith("next: pinnquad loop ")


@pytest.mark.parametrize("arguments, words", [
    ({"trajectory": "spiral"}, "no trajectory named 'spiral'; known: eight"), ({"columns": {"heat": 3}}, "no column 'heat'"),
    ({"battery": "big"}, "CELLSxMAH"), ({"battery_charge": float("nan")}, "battery_charge"),
    ({"airframe": "kite"}, "kite"), ({"trajectory": "none.csv"}, "none.csv")])
def test_flights_that_make_no_sense(structured, arguments, words):
    with pytest.raises((ValueError, pinnquad.Error), match=words) as caught:
        pinnquad.loop(structured, **arguments)
    assert "\n" not in str(caught.value)

# SPDX-License-Identifier: MIT
"""Airframes: from names and files, edited, checked, pickled."""
import copy
import math
import pickle

import numpy as np
import pytest
from conftest import SOURCE

import pinnquad
from pinnquad import Airframe, Spin


def test_paper_quadrotor_is_table_1():
    airframe = Airframe("paper_quadrotor")
    assert airframe.mass_kg == 1.5
    assert [rotor.spin for rotor in airframe.rotors] == [Spin.counter_clockwise] * 2 + [Spin.clockwise] * 2
    assert airframe.rotors[0].x_m > 0 and airframe.rotors[0].y_m > 0  # front right
    np.testing.assert_array_equal(airframe.rotors[0].axis, (0, 0, -1))


@pytest.mark.parametrize("path", sorted((SOURCE / "examples/airframes").glob("*.toml")), ids=lambda path: path.stem)
def test_files_of_the_library_are_its_airframes(path, tmp_path):
    airframe = Airframe(path)
    if airframe.name in pinnquad.airframe_names():
        assert airframe == Airframe(airframe.name)
    airframe.save(tmp_path / "again.toml")
    assert Airframe(tmp_path / "again.toml") == airframe
    airframe.check()


@pytest.mark.parametrize("copied", [Airframe.copy, copy.copy, copy.deepcopy, lambda a: pickle.loads(pickle.dumps(a))])
def test_a_copy_is_edited_alone(copied):
    airframe = Airframe("px4_sih")
    other = copied(airframe)
    assert other == airframe
    other.inertia_kg_m2[0] *= 1.1  # in place
    other.rotors[2].thrust_curve = 0.3
    other.rotors[3].spin = Spin.counter_clockwise
    other.drag_area_m2 = (0.1, 0.2, 0.3)
    assert other != airframe
    assert other.inertia_kg_m2[0] == 1.1 * airframe.inertia_kg_m2[0]
    assert other.rotors[2].thrust_curve == 0.3 and airframe.rotors[2].thrust_curve == 0
    assert pickle.loads(pickle.dumps(other)) == other


def test_its_arrays_keep_it_alive():
    inertia = Airframe("crazyflie_2_1").inertia_kg_m2
    rotor = Airframe("crazyflie_2_1").rotors[0]
    [Airframe("paper_quadrotor") for _ in range(100)]
    assert inertia[2] == Airframe("crazyflie_2_1").inertia_kg_m2[2]
    assert rotor.x_m == Airframe("crazyflie_2_1").rotors[0].x_m


@pytest.mark.parametrize("edit", [
    lambda a: setattr(a, "mass_kg", 0), lambda a: setattr(a, "mass_kg", math.nan),
    lambda a: setattr(a, "mass_kg", 50), lambda a: setattr(a, "inertia_kg_m2", (1, 1, 3)),
    lambda a: setattr(a, "propeller_diameter_m", -1), lambda a: setattr(a.rotors[1], "axis", (0, 0, 0)),
    lambda a: [setattr(rotor, "spin", Spin.clockwise) for rotor in a.rotors]])
def test_what_cannot_fly_is_refused(edit):
    airframe = Airframe("paper_quadrotor")
    edit(airframe)
    for use in (airframe.check, lambda: pinnquad.Simulator(airframe), lambda: pinnquad.Vehicles(2, airframe)):
        with pytest.raises(pinnquad.Error, match="paper_quadrotor.*(invalid_airframe|no_solution)") as caught:
            use()
        assert "\n" not in str(caught.value)


def test_files_that_are_none(tmp_path):
    with pytest.raises(ValueError, match="no airframe named 'kite'"):
        Airframe("kite")
    with pytest.raises(pinnquad.Error, match="nothing.toml"):
        Airframe(tmp_path / "nothing.toml")
    bad = tmp_path / "bad.toml"
    bad.write_text(Airframe("paper_quadrotor").to_toml().replace("mass_kg", "mass_g"))
    with pytest.raises(pinnquad.Error, match=r"bad.toml:\d+:\d+: expected"):
        Airframe(bad)
    for given in (3, None, b"paper_quadrotor", ["paper_quadrotor"]):
        with pytest.raises((TypeError, ValueError)):
            Airframe(given)
    with pytest.raises(TypeError):
        Airframe("paper_quadrotor").inertia_kg_m2 = (1, 2)
    with pytest.raises(OSError, match="/no/such"):
        Airframe("paper_quadrotor").save("/no/such/folder/a.toml")


def test_a_pickle_that_is_none():
    with pytest.raises(ValueError, match="60 numbers"):
        Airframe._of_state(("x", (1.0, 2.0)))
    for kind in (Airframe, pinnquad.Flight, pinnquad.Simulator, pinnquad.Vehicles, pinnquad.Model):
        for wrong in ((), None, ("x",), (1, 2), b"", [1] * 11, tuple(range(11))):
            with pytest.raises((TypeError, ValueError, RuntimeError, IndexError, pinnquad.Error)):
                kind._of_state(wrong)


@pytest.mark.parametrize("kind", [Airframe, pinnquad.Rotor, pinnquad.Flight, pinnquad.Dataset, pinnquad.Simulator,
                                  pinnquad.Vehicles, pinnquad.Model, pinnquad.Training])
def test_nothing_exists_that_was_not_made(kind):
    for made in (lambda: kind.__new__(kind), lambda: object.__new__(kind)):
        with pytest.raises(TypeError):
            made()


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_protocol_of_pickles(protocol):
    flight = pinnquad.fly(rows=20)
    for thing in (Airframe("px4_sih"), flight, pinnquad.Simulator(), pinnquad.Vehicles(2), pinnquad.Effects(wake=True)):
        assert type(pickle.loads(pickle.dumps(thing, protocol))) is type(thing)
    for thing in (pinnquad.Dataset(flight), Airframe("px4_sih").rotors[0]):
        with pytest.raises(TypeError, match="not pickled"):
            pickle.dumps(thing, protocol)

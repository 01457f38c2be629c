# SPDX-License-Identifier: MIT
"""loop flies a model from its block as the compiled model flies: of a model of a user's
own (a column, a window, a wrench, another activation) the same figures as its header's; what it can't fly is refused. It flies the controllers that one ships: what a bias
that learns in flight is worth."""
import csv
import json
import re
from pathlib import Path

import pytest
from conftest import SOURCE, Program, replaced

MODELS = SOURCE / "examples/models"
OWN = "loop --column battery_voltage=15.2 model.block"  # options of several values leave the model alone


def flown_by(pinnquad, words, code=0):
    return json.loads(pinnquad(f"{words} --json", code=code).out)


def test_as_fast_as_the_model_knows(pinnquad, flown):
    """Trained below the speed of the usual figure-eight, which is slowed down for it; shown the altitude, near the ground."""
    flight = flown("--seed 3 --samples 3000 --max-speed 3")
    pinnquad(f"train {flight} --models small_physics_informed --seeds 1 --epochs 60 --allow-poor --out slow")
    slow = flown_by(pinnquad, "loop slow/model.hpp")
    assert slow["period_s"] > 7.5 and slow["model"]["answered_share"] > 0.99, slow
    pinnquad(f"train {flown('d2 --seed 3 --samples 3000')} --altitude yes --seeds 1 --epochs 5 --allow-poor --out near")
    near = flown_by(pinnquad, "loop near/model.hpp")
    assert near["period_s"] < 7.5 and near["model"]["asked"] == 15000 and near["model"]["answered_share"] > 0.99, near
    assert near["model"]["rmse_m"] < 0.5 * near["without_jerk"]["rmse_m"], near


@pytest.fixture(scope="module")
def own(pinnquad, compiler, flown, tmp_path_factory):
    """A folder with a model of a user's own, by examples/own_training: its header, its block, and what flies the header."""
    folder = tmp_path_factory.mktemp("own")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        header, *rows = flown("--seed 3 --samples 3000").read_text().splitlines()
        volts = (f"{row},{14.5 + line % 100 / 50}" for line, row in enumerate(rows))
        Path("flight.csv").write_text("\n".join([f"{header},battery_voltage [V]", *volts, ""]))
        features = "Windowed<WithColumns<PaperFeatures, BatteryVoltage>, 2, PeriodMicroseconds<50000>>"
        replaced(SOURCE / "examples/own_training/main.cpp", "main.cpp", ('"MyModel"', '"Own"'),
                 ("^using MyFeatures = .*", f"using MyFeatures = {features};"),
                 ("^using MyOutputs = .*", "using MyOutputs = WrenchOutputs;"),
                 ("^using MyNetwork = .*", "using MyNetwork = Mlp<float, InputSize<34>, Hidden<2, 16>, OutputSize<4>, "
                  "Silu>;"), ("my_epochs = 300", "my_epochs = 60"), ("^using MyLoss = .*", "using MyLoss = Mse;"))
        compiler("-O2 main.cpp -o train")
        Program("./train")(". flight.csv")
        compiler("-O2 -ffp-contract=off -I.", SOURCE / "tests/programs/loop/compiled.cpp", "-o", "compiled")
    return folder


@pytest.fixture
def own_here(own, work):
    for path in own.iterdir():
        (work / path.name).symlink_to(path)


def test_model_of_a_users_own(pinnquad, own_here):
    rmse, largest, answered, asked = map(float, Program("./compiled")().out.split())
    looped = flown_by(pinnquad, OWN, code=1)  # further off than no model: not to be flown
    assert looped["verdict"]["may_fly"] == "no" and "cm off" in looped["verdict"]["why"]
    model = looped["model"]
    assert looped["columns"] == {"battery_voltage": 15.2}
    assert abs(model["rmse_m"] - rmse) < 1e-5 and abs(model["largest_error_m"] - largest) < 1e-5, (rmse, largest)
    assert abs(answered - asked * model["answered_share"]) < 2
    # two instants 50 ms apart, and 2 ms between two ticks
    assert model["declined"]["warming_up"] == 25
    # trained for 60 epochs, it answers the feedback by itself, and keeps the vehicle
    assert model["status"] == "ok" and model["largest_error_m"] < looped["half_length_m"], model
    said = pinnquad(OWN, code=1).flat
    assert "battery_voltage 15.2 V" in said and re.search(r"flew in place of the model: .*\b25 warming_up", said), said
    # what is held matters; of a voltage lower than any that was trained the lowest is taken
    assert flown_by(pinnquad, "loop model.hpp --column battery_voltage=14.7", code=(0, 1))["model"]["rmse_m"] != model["rmse_m"]
    low, lower = (flown_by(pinnquad, f"loop model.hpp --column battery_voltage={volts}", code=(0, 1))["model"] for volts in (9, 3))
    assert low == lower and low["declined"] == model["declined"]
    # the vehicle's own battery in its place
    on_battery = flown_by(pinnquad, "loop model.hpp --battery 4x5000 --battery-charge 80", code=(0, 1))
    assert 14 < on_battery["columns"]["battery_voltage"] < 16 and on_battery["model"]["status"] == "ok", on_battery


@pytest.mark.parametrize("words, keyword", [
    ("model.block", "--battery 3x2200"), ("model.block --battery 3", "CELLSxMAH"), ("model.block --battery 0x2200", "CELLSxMAH"),
    ("model.block --column battery_voltage=15 --battery 4x5000", "--column battery_voltage"),
    ("model.block --column battery_voltage", "=NUMBER in V"),
    ("model.block --column battery_voltage=fast", "'battery_voltage=fast'"), ("model.block --column battery_voltage=nan", "=NUMBER"),
    ("model.block --column battery_voltage=15 --column battery_voltage=16", "twice"), ("model.block --column pack=15", "'pack'"),
    (f"{MODELS}/demo_quadrotor.block --column pack=15", "none"), ("flight.csv", "block"), ("none.block", "none"),
    (f"{MODELS}/demo_quadrotor.hpp --airframe turned.toml", "stand or turn otherwise"),
    (f"{MODELS}/demo_quadrotor.hpp --airframe zeppelin", "'zeppelin'"),
    (f"{MODELS}/demo_quadrotor.hpp --trajectory helix", "--trajectory"), (f"{MODELS}/demo_quadrotor.hpp --guard all", "--guard")])
def test_refused(pinnquad, own_here, words, keyword):
    replaced(SOURCE / "examples/airframes/racer_5_inch.toml", "turned.toml", ('"counter_clockwise"', '"other"'),
             ('"clockwise"', '"counter_clockwise"'), ('"other"', '"clockwise"'))
    pinnquad.refused(f"loop {words}", keyword=keyword)


def test_a_window_that_looks_ahead(pinnquad, nanobench):
    pinnquad(f"train {nanobench} --airframe crazyflie_2_1 --hold-out B9_trefoil_fast_rep1 --seeds 1 --out c "
             "--models constant,ridge_centred --export ridge_centred --allow-poor")
    pinnquad.refused("loop c/model.hpp", at="c/model.block", keyword="ahead")


def test_loses_another_vehicle(pinnquad):
    """A network of which nothing is proven. A proven model keeps even a racer, 1.1 m off: its slopes have the right sign."""
    words = f"loop {MODELS}/demo_quadrotor.block --airframe reference_1.5kg --trajectory yaw_eight"
    done = pinnquad(words, code=1)
    assert "loses the vehicle" in done.lines[-1] and "outside_envelope" in done.out
    for trajectory in "eight", "yaw_eight", "circle":
        flown = flown_by(pinnquad, f"loop {MODELS}/structured_quadrotor.block --trajectory {trajectory}")
        assert flown["model"]["answered_share"] > 0.99 and flown["model"]["rmse_m"] < 0.02, trajectory


def waypoints(name, *rows, head="t,x,y,z,yaw"):
    Path(name).write_text("\n".join([head, *rows, ""]))


def test_waypoints_of_a_file(pinnquad):
    """The path goes through them, at rest at both ends; the flight is as long as they are; z is down."""
    model = f"loop {MODELS}/structured_quadrotor.block --trajectory own.csv"
    waypoints("own.csv", "10,0,0,0,0", "13,4,0,-2,0.4", "16,4,4,1,0.4", "20,0,0,0,0")
    flown = flown_by(pinnquad, model)
    low, high = flown["altitude_m"]
    assert flown["period_s"] == 10 and flown["model"]["asked"] == 5000, flown
    assert 2 <= flown["half_length_m"] < 4 and low > 18 and 3 <= high - low < 4, flown
    for who in "model", "analytic_inverse":
        assert 0 < flown[who]["rmse_m"] < 0.02, flown
    assert "own.csv" in pinnquad(model).out
    # controllers fly it too, their errors are of what comes after 10 s: here of the last point, where they wait
    rows = json.loads(pinnquad(f"{model} --controllers formula,pid --json").out)["rows"]
    assert all(row["rmse_cm"] < 2 and not row["crashed"] for row in rows), rows
    # without yaw, columns in any order
    waypoints("own.csv", "0,0,0,0", "0,8,0,0", head="y,t,z,x")
    assert flown_by(pinnquad, model)["model"]["rmse_m"] < 0.01
    # a file that is slower than one of the usual trajectories is as long as it says
    waypoints("own.csv", "0,0,0,0", "45,3,0,0", head="t,x,y,z")
    assert json.loads(pinnquad(f"{model} --controllers formula --json").out)["duration_s"] == 45


@pytest.mark.parametrize("rows, head, at, keyword", [
    (["0,0,0,0", "1,1,0,0"], "t,x,y", "own.csv:1", "column named z"), (["0,0,0,0"], None, "own.csv:2", "2 rows"),
    (["0,0,0,0", "1,a,0,0"], None, "own.csv:3:2", 'found "a"'), (["0,0,0,0", "2,1,0,0", "2,2,0,0"], None, "own.csv:4:1", "after"),
    (["0,0,0,0", "4000,1,0,0"], None, "own.csv:3:1", "at most 600"), (["0,0,0,0", "5,0,20000,0"], None, "own.csv:3:3", "10 km"),
    (["0,0,0,0,0", "5,1,0,0,90"], "t,x,y,z,yaw", "own.csv:3:5", "half a turn"),
    (["0,0,0,0", "3,1,0,0", "3.4,20,0,0", "9,0,0,0"], None, "own.csv:*", "times the weight"),
    (["0,0,0,0", "20,0,0,30"], None, "own.csv:3", "above the ground"), ([], None, "own.csv:1", "2 rows")])
def test_waypoints_refused(pinnquad, rows, head, at, keyword):
    waypoints("own.csv", *rows, head=head or "t,x,y,z")
    for more in "", " --controllers pid":
        pinnquad.refused(f"loop {MODELS}/structured_quadrotor.block --trajectory own.csv{more}", at=at, keyword=keyword)


def errors_of(pinnquad, *words, model="structured_quadrotor"):
    """By condition and controller, cm."""
    flown = json.loads(pinnquad("loop --json", *words, f"{MODELS}/{model}.block").out)
    errors = {}
    for row in flown["rows"]:
        assert not row["crashed"], row
        errors.setdefault(row["condition"], {})[row["controller"]] = row["rmse_cm"]
    return errors, flown["rows"]


def test_the_bias_carries_what_the_model_does_not_know(pinnquad):
    """The aims: a payload of 20 % and a rotor at 85 % within 1.2 cm on the figure-eight, in calm air 0.8."""
    errors, rows = errors_of(pinnquad, "--controllers=pid,formula,indi,structured,adaptive,formula_adaptive",
                             "--conditions=calm,payload,weak_rotor,wind_8")
    assert len(rows) == 24
    calm, payload, weak, wind = (errors[name] for name in ("calm", "payload", "weak_rotor", "wind_8"))
    for learns in "adaptive", "formula_adaptive":
        assert calm[learns] <= 0.8 and payload[learns] <= 1.2 and weak[learns] <= 1.2, rows
    for does_not in "formula", "structured":
        assert payload[does_not] > 20 and weak[does_not] > 10
    assert wind["adaptive"] < 0.5 * wind["structured"] and wind["adaptive"] < 1.1 * wind["indi"]
    assert all(row["answered_share"] == pytest.approx(1, abs=0.05) for row in rows if row["controller"] == "structured")


def test_the_table_of_controllers(pinnquad):
    """Their default, with the conditions as columns; the figures are those of --json."""
    words = ("--trajectory=circle", "--conditions", "calm,payload_half")
    said = pinnquad(f"loop {MODELS}/structured_quadrotor.block", *words)
    errors, _ = errors_of(pinnquad, *words)
    for controller, calm in errors["calm"].items():
        assert re.search(rf"^  {controller} +{calm:.2f} +{errors['payload_half'][controller]:.2f}$", said.out, re.M), said.out
    assert list(errors["calm"]) == ["pid", "formula", "indi", "structured", "adaptive"]


def test_no_cliff_with_mass(pinnquad):
    """A model of 1.5 kg on vehicles of up to half more: incremental inversion by it flies them as INDI by the airframe
    does."""
    pinnquad("airframe convert paper_quadrotor --out usual.toml")
    for percent in 0, 30, 35, 40, 50:
        replaced("usual.toml", "heavy.toml", ("^mass_kg = .*", f"mass_kg = {1.5 * (1 + percent / 100)}"))
        errors, rows = errors_of(pinnquad, "--airframe=heavy.toml", "--controllers=indi,structured_indi",
                                 "--trajectory=circle")
        calm = errors["calm"]
        assert calm["structured_indi"] < 1.1 * calm["indi"] + 0.03, (percent, calm)
        assert all(row["bias_at_bound_share"] == 0 for row in rows)


def test_a_bias_at_its_bound_is_said(pinnquad):
    """Adaptive, of a vehicle that hovers at 0.72 and is told so, in a payload of 20 %: more than 0.8 of the sum."""
    replaced(SOURCE / "examples/airframes/paper_quadrotor.toml", "heavy.toml", ("^mass_kg = .*", "mass_kg = 2.05"))
    words = (f"loop {MODELS}/structured_quadrotor.block --controllers=adaptive --conditions=payload",)
    said = pinnquad(*words, "--airframe=heavy.toml").flat
    assert "warning: adaptive, payload: its bias stood at its bound" in said, said
    assert "warning" not in pinnquad(*words).out


def test_many_seeds(pinnquad):
    """Seeds of vehicles and winds: a row each, the same bits in any order; a folder goes on with what it has not flown."""
    words = f"loop {MODELS}/structured_quadrotor.block --controllers adaptive --conditions drawn --duration 15 --out"
    pinnquad(f"{words} some --seeds 3")
    first = Path("some/loop.journal").read_text()
    said = pinnquad(f"{words} some --seeds 5")
    assert Path("some/loop.journal").read_text().startswith(first), "what was flown is flown once"
    pinnquad(f"{words} whole --seeds 5")
    assert Path("some/rows.csv").read_bytes() == Path("whole/rows.csv").read_bytes()
    rows = list(csv.DictReader(Path("some/rows.csv").open()))
    assert [row["seed"] for row in rows] == ["1", "2", "3", "4", "5"] and all(row["crashed"] == "false" for row in rows)
    for name, least, most in (("mass_factor", 0.85, 1.15), ("inertia_factor", 0.85, 1.15), ("thrust_factor", 0.85, 1.15),
                              ("rotor_factor", 0.85, 1), ("wind_north_m_s", -8, 8), ("wind_east_m_s", -8, 8)):
        drawn = [float(row[name]) for row in rows]
        assert len(set(drawn)) == 5 and all(least <= value <= most for value in drawn), (name, drawn)
    errors = sorted(float(row["rmse_cm"]) for row in rows)
    summary, = json.loads(Path("some/loop.json").read_text())["summary"]
    assert summary["flights"] == 5 and summary["lost"] == 0, summary
    assert summary["rmse_cm"]["median"] == errors[2] and summary["rmse_cm"]["worst"] == errors[-1], (summary, errors)
    assert re.search(rf"^  adaptive +drawn .* {errors[2]:.2f} .* {errors[-1]:.2f} +0 of 5$", said.out, re.M), said.out
    kept = Path("some/loop.journal").read_bytes(), Path("some/rows.csv").read_bytes()
    for other, more in ("airframe, airframe_numbers", "--airframe reference_1.5kg"), ("battery", "--battery 4x5000"):
        pinnquad.refused(f"{words} some --seeds 1 {more}", at="some/loop.journal", keyword=f"another plan ({other}): give --out")
    assert kept == (Path("some/loop.journal").read_bytes(), Path("some/rows.csv").read_bytes()), "what was flown stays"


def changed_vehicle(into, *changes):
    replaced(SOURCE / "examples/airframes/paper_quadrotor.toml", into, *changes)


def test_what_decides_a_row_is_in_the_plan(pinnquad):
    """An airframe of the same name and mass; another program."""
    words = f"loop {MODELS}/structured_quadrotor.block --airframe mine.toml --controllers pid --duration 15 --out d"
    changed_vehicle("mine.toml")
    pinnquad(words)
    changed_vehicle("mine.toml", ("^inertia_kg_m2 = .*", "inertia_kg_m2 = [0.02, 0.02, 0.04]"))
    pinnquad.refused(words, at="d/loop.journal", keyword="another plan (airframe_numbers): give --out")
    changed_vehicle("mine.toml")
    replaced("d/loop.journal", "d/loop.journal", ('"program":"', '"program":"0'))
    pinnquad.refused(words, at="d/loop.journal", keyword="another plan (program): give --out")


def test_lost_before_its_error_counts(pinnquad):
    """In air that stops it at once: no figure, where 0 would be the best."""
    changed_vehicle("thick.toml", ("^drag_area_m2 = .*", "drag_area_m2 = [1e5, 1e5, 1e5]"))
    pinnquad(f"loop {MODELS}/structured_quadrotor.block --airframe thick.toml --controllers pid --duration 15 --out d")
    row, = json.loads(Path("d/loop.json").read_text())["rows"]
    cells, = csv.DictReader(Path("d/rows.csv").open())
    assert row["crashed"] and row["rmse_cm"] is None and row["worst_cm"] is None, row
    assert cells["crashed"] == "true" and cells["rmse_cm"] == cells["worst_cm"] == "", cells


def test_do_not_fly_is_exit_code_1(pinnquad):
    """Where a controller that flies the model loses the vehicle, table and --json."""
    words = f"loop {MODELS}/demo_quadrotor.block --airframe reference_1.5kg --trajectory yaw_eight --duration 15 --controllers"
    assert "loses the vehicle under calm" in pinnquad(f"{words} structured", code=1).lines[-1]
    assert flown_by(pinnquad, f"{words} structured", code=1)["verdict"]["may_fly"] == "no"
    pinnquad(f"{words} pid")


def test_a_trajectory_with_commas(pinnquad):
    waypoints("a,\"b.csv", "0,0,0,0,0", "12,3,0,0,0")
    pinnquad("loop", MODELS / "structured_quadrotor.block", "--controllers=pid", "--out=d", "--trajectory=a,\"b.csv")
    row, = csv.DictReader(Path("d/rows.csv").open())
    assert row["trajectory"] == "a,\"b.csv" and row["seed"] == "1" and row["crashed"] == "false", row


@pytest.mark.parametrize("words, keyword", [
    ("--seeds 0", "--seeds"), ("--duration 5", "--duration"), ("--seeds 2 --guard none", "--guard"), ("--out own --guard none", "--guard"),
    ("--controllers autopilot", "--controllers"), ("--controllers mppi", "--controllers"), ("--conditions snow", "--conditions"),
    ("--controllers pid --guard none", "--guard")])
def test_controllers_refused(pinnquad, words, keyword):
    pinnquad.refused(f"loop {MODELS}/structured_quadrotor.block {words}", keyword=keyword)


def without_last_column(path, into):
    Path(into).write_text("".join(line.rsplit(",", 1)[0] + "\n" for line in Path(path).read_text().splitlines()))


def test_flies_on_a_battery(pinnquad, flown):
    """From the flights of a pack that empties to a model that is shown its voltage in flight: it knows a nearly empty pack
    better than a model without, and thrust goes with the square of the voltage, which identify finds without being told."""
    of_pack = {charge: flown(f"--airframe light_quadrotor --battery 3x2200 --battery-charge {charge} --samples 1500 --seed {charge}")
               for charge in (100, 70, 40, 25, 30)}
    for charge, path in of_pack.items():
        header, *rows = path.read_text().splitlines()
        assert header.endswith(",battery_voltage [V]") and 10 < float(rows[-1].split(",")[-1]) < 12.5
        Path(f"with_{charge}.csv").symlink_to(path)
        without_last_column(path, f"without_{charge}.csv")
    assert "battery_voltage" not in flown("--airframe light_quadrotor --samples 100 --seed 3").read_text()
    found = json.loads(pinnquad("identify with_100.csv with_40.csv --airframe light_quadrotor --json").out)
    assert abs(found["numbers"]["battery"]["value"] - 2) < 0.05, found
    errors, loops = {}, {}
    for kind in "with", "without":
        flights = " ".join(f"{kind}_{charge}.csv" for charge in of_pack)
        pinnquad(f"train {flights} --hold-out {kind}_30.csv --airframe light_quadrotor --models physics --seeds 1 --allow-poor --out {kind}")
        report = json.loads(Path(kind, "report.json").read_text())
        errors[kind] = report["verdict"]["held_out_rmse"]["exported"]
        flying = flown_by(pinnquad, f"loop {kind}/model.block --battery 3x2200 --battery-charge 30")
        assert flying["model"]["status"] == "ok" and flying["model"]["answered_share"] > 0.99
        loops[kind] = flying["model"]["rmse_m"]
        if kind == "with":
            assert 10.5 < flying["columns"]["battery_voltage"] < 11.3
            assert report["closed_loop"]["model"]["rmse_m"] < 0.1, report["closed_loop"]
    assert errors["with"] < 0.85 * errors["without"], errors
    assert loops["with"] < 0.5 * loops["without"], loops
    pinnquad.refused("loop with/model.block", at="with/model.block", keyword="battery_voltage")
    pinnquad.refused("loop with/model.block --controllers structured", at="with/model.block", keyword="battery_voltage")
    row, = json.loads(pinnquad("loop with/model.block --battery 3x2200 --battery-charge 30 --controllers structured --json").out)["rows"]
    assert not row["crashed"] and row["rmse_cm"] < 10, row

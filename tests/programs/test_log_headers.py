# SPDX-License-Identifier: MIT
"""A header of any log compiles and flies, whatever window and columns its model asks for: in the cores of both flight stacks. What the cores recorded replays to the bit."""
import json
import math
import re
from pathlib import Path

import pytest
from conftest import SOURCE, Program, edited

FLIGHT_FLAGS = ["-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Wshadow",
                "-Werror"]
INCLUDES = [f"-I{SOURCE}/{path}" for path in ("examples", "examples/crazyflie_app/src", "tests/flight_stacks")]
CORES = SOURCE / "tests/flight_stacks/header_flight.cpp"


def closer_rows(source, target, interval_s, number):
    """Writes a flight's table with rows closer together, on straight lines, and a battery that runs down."""
    head, *rows = Path(source).read_text().splitlines()
    rows = [[float(cell) for cell in row.split(",")] for row in rows]
    yaw = head.split(",").index("yaw")
    for before, row in zip(rows, rows[1:]):
        row[yaw] += 2 * math.pi * round((before[yaw] - row[yaw]) / (2 * math.pi))
    lines, start_s, apart_s = [head + ",battery_voltage [V]"], rows[0][0], rows[1][0] - rows[0][0]
    for line in range(int((rows[-1][0] - start_s) / interval_s)):
        at = int(line * interval_s / apart_s + 1e-9)
        share = line * interval_s / apart_s - at
        cells = [a + share * (b - a) for a, b in zip(rows[at], rows[at + 1])]
        cells.append(15.6 - 0.01 * cells[0] + 0.2 * math.sin(0.7 * cells[0] + number))
        lines.append(",".join(map(repr, cells)))
    Path(target).write_text("\n".join(lines) + "\n")
    return target


@pytest.fixture
def two_models(pinnquad):
    """two_models(kind, source, held out, held out): folders one/ and other/, two models of a kind and of one airframe:
    fitted to other rows of the same flights, or where those are asked for the airframe too, trained for longer."""

    def train(kind, source, *held_out):
        for folder, flight, epochs in zip(("one", "other"), held_out, (5, 6)):
            pinnquad(f"train {source} --models ridge,{kind} --export {kind} --seeds 1 --epochs {epochs} --allow-poor",
                     "--hold-out", flight, "--out", folder)

    return train


@pytest.fixture
def fly_cores(compiler, pinnquad):
    """fly_cores(): flies one/ in both cores, other/'s block from 3 s on, the battery silent from 6 to 9 s; the ticks of
    each stack and phase by who answered. What was recorded replays."""

    def fly():
        compiler("", "-O1", *FLIGHT_FLAGS, *INCLUDES, "-Ione", CORES, "-o", "cores")
        Path("logged").mkdir()
        said = Program(Path("cores").resolve())("one/model.block other/model.block logged").out
        for stack in "px4_module", "crazyflie_app":
            assert f"{stack} other block: ok" in said, said
            done = pinnquad(f"replay logged/{stack}_pinnquad_record_0.csv --model one/model.block --model other/model.block")
            assert "commands    equal to the log's, bit for bit" in done.out, done
        figures = re.findall(r"^(\w+) (\w+): ticks (\d+) model (\d+) warming_up (\d+) not_finite (\d+)", said, re.M)
        names = "ticks", "model", "warming_up", "not_finite"
        assert len(figures) == 6, said
        return {(stack, phase): dict(zip(names, map(int, numbers))) for stack, phase, *numbers in figures}

    return fly


def test_window_and_battery(two_models, fly_cores, pinnquad, dataset, flown):
    """Of the simulator's flights: the model flies all but what it can't know."""
    flights = {f"f{i}": closer_rows(flown(f"--seed {i} --samples 1500"), f"f{i}.csv", 0.02, i) for i in (1, 2, 3)}
    dataset("rows", flights)
    facts = json.loads(Path("rows/dataset.json").read_text())
    Path("rows/dataset.json").write_text(json.dumps({**facts, "sample_period_s": 0.02}))
    two_models("ridge_causal", "rows --airframe paper_quadrotor", "f3", "f1")
    header = Path("one/model.hpp").read_text()
    assert "PartlyWindowed<pinnquad::WithColumns<" in header and "BatteryVoltage" in header

    for (stack, phase), ticks in fly_cores().items():
        period = 1 if stack == "px4_module" else 2
        if phase == "start":  # a window of 160 ms
            assert ticks["warming_up"] == 160 / period and ticks["model"] == 40 / period
        elif phase == "silent":
            assert ticks["not_finite"] == ticks["ticks"] > 400
        else:  # again behind the silence
            assert ticks["warming_up"] == 160 / period
            assert ticks["model"] == ticks["ticks"] - ticks["warming_up"] - ticks["not_finite"]

    # a log from before the voltage was recorded is read, and its core had none
    record = Path("logged/px4_module_pinnquad_record_0.csv")
    names = record.open().readline().rstrip("\n").split(",")
    later = {names.index(name) for name in ("voltage_us", "battery_voltage")}
    edited(record, "earlier.csv", lambda _, cells: [cell for at, cell in enumerate(cells) if at not in later])
    done = pinnquad("replay earlier.csv --model one/model.block --model other/model.block", code=1)
    assert "battery voltage: never came" in done.out, done
    # behind a gap the window is not known: nothing is said of it
    at = names.index("tick")
    edited(record, "gap.csv", lambda line, cells: None if line == 1 or not 2000 < int(cells[at]) < 2100 else False)
    done = pinnquad("replay gap.csv --model one/model.block --model other/model.block")
    assert re.search(r"^same +as logged, in all 2000 ticks compared", done.out, re.M), done


LOGS = {
    "sih": ("train_figure8", 0.99),
    "nanobench_subset_50hz": ("B7_oval_fast_rep1", 0.1),  # of an airframe that is assumed, the loop leaves its path
    "arpl_crazyflie": ("arpl_cf_log15_12s", 0.99),
}


@pytest.mark.parametrize("logs", LOGS)
def test_real_logs(logs, two_models, fly_cores, recorded, unpacked):
    held_out, share = LOGS[logs]
    if logs == "sih":
        source = f"{unpacked('train_random', 'train_figure8', 'train_excite')} --mapping px4"
    else:
        source = f"{recorded(f'flight_logs/{logs}.csv')} --mapping {logs.split('_')[0]}"
    two_models("structured_causal", source, held_out, held_out)
    assert "PartlyWindowed<" in Path("one/model.hpp").read_text()
    for (_, phase), ticks in fly_cores().items():
        if phase == "flight":
            asked = ticks["ticks"] - ticks["warming_up"] - ticks["not_finite"]
            assert ticks["model"] >= share * asked > 0.8 * share * ticks["ticks"], ticks

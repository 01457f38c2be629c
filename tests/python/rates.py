# SPDX-License-Identifier: MIT
"""Rates from Python and from C++ in one run, by turns, of the processor's time; the best of some rounds.

predict() of a batch may take 1.2 times what C++ takes that asks the same block row by row: exit code 1 beyond."""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import pinnquad

SOURCE = Path(__file__).resolve().parents[2]
BLOCK = SOURCE / "examples/models/demo_quadrotor.block"
ROWS, ROUNDS, MOST = 20000, 15, 1.2
FLAGS = ["-std=c++17", "-O2", "-DNDEBUG", "-ffp-contract=off", "-I", SOURCE / "include", "-I", SOURCE / "examples",
         "-isystem", "/usr/include/eigen3"]


def processor_s(work):
    start = time.process_time()
    work()
    return time.process_time() - start


def predict():
    """ns a row: C++, and Python."""
    model = pinnquad.Model.load(BLOCK)
    x = np.random.default_rng(1).uniform(*model.envelope, (ROWS, 16)).astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "rates")
        subprocess.run(["c++", *FLAGS, SOURCE / "tests/python/rates.cpp", "-o", program], check=True)
        with subprocess.Popen([program, BLOCK, str(ROWS)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              text=True) as cpp:
            ours, theirs = [], []
            for _ in range(ROUNDS):
                cpp.stdin.write("\n")
                cpp.stdin.flush()
                theirs.append(float(cpp.stdout.readline()))
                ours.append(1e9 * processor_s(lambda: model.predict(x)) / ROWS)
            cpp.stdin.close()
    one = min(processor_s(lambda: [model.predict(x[0]) for _ in range(1000)]) for _ in range(5)) / 1000
    return min(theirs), min(ours), 1e9 * one


SPREADS = {"mass_kg": 0.2, "inertia_kg_m2": 0.1, "thrust_coefficient": 0.1, "thrust_scale": 0.05}


def steps(effects, airframe="paper_quadrotor"):
    """1 ms steps of a vehicle a second, a thousand vehicles a call."""
    vehicles = pinnquad.Vehicles(1000, airframe, effects=effects)
    commands = np.broadcast_to(vehicles.hover_commands(), (1000, 4)).copy()
    return 1e5 / min(processor_s(lambda: vehicles.step(commands, 0.1)) for _ in range(ROUNDS))


def environment_steps(environment, actions, count):
    environment.reset(seed=1)

    def run():
        for _ in range(count):
            environment.step(actions)

    return count / min(processor_s(run) for _ in range(5))


def main():
    cpp, python, one = predict()
    print(f"predict, 10 x 25 ReLU, {ROWS} rows: C++ row by row {cpp:.0f} ns, Python {python:.0f} ns a row, "
          f"{python / cpp:.2f} times; one row a call {one:.0f} ns")
    each = pinnquad.Airframe("paper_quadrotor").randomised(1000, SPREADS)
    for name, effects in (("drag", pinnquad.Effects()),
                          ("payload and battery", pinnquad.Effects(payload_kg=0.2, battery_cells=4)),
                          ("all effects of rotors", pinnquad.Effects(rotor_drag=True, inflow=True, flapping=True,
                                                                     wake=True))):
        print(f"1,000 vehicles, 1 ms steps, {name}: {steps(effects):,.0f} a second, "
              f"with an airframe each {steps(effects, each):,.0f}")
    alone = pinnquad.HoverEnv(step_s=0.01)
    many = pinnquad.VectorHoverEnv(1000, step_s=0.01)
    drawn = pinnquad.VectorHoverEnv(1000, step_s=0.01, randomise=SPREADS)
    hover = alone.vehicles.hover_commands()
    all_hover = np.tile(hover, (1000, 1))
    print(f"environment, steps of 10 ms: {environment_steps(alone, hover, 1000):,.0f} a second alone, "
          f"{1000 * environment_steps(many, all_hover, 20):,.0f} of 1,000 at once, with airframes drawn "
          f"{1000 * environment_steps(drawn, all_hover, 20):,.0f}")
    sys.exit(python > MOST * cpp)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Hovers close to the ground, switches the ground effect in flight, and prints what becomes of commands and thrust.

    PYTHONPATH=build/python /usr/bin/python3 examples/python/ground_effect.py [height in m, 0.4]
"""
import sys

import pinnquad_sim

GROUND_Z_M = 0.877  # NED


def main():
    height_m = float(sys.argv[1]) if len(sys.argv) > 1 else 0.4
    simulator = pinnquad_sim.Simulator(pilot="hover", start_m=(0.0, 0.0, GROUND_Z_M - height_m))
    print("hover %.2f m above ground" % simulator.state["altitude_m"])
    print("%-18s  command  rotor thrust  against none" % "ground effect")
    for model in pinnquad_sim.ground_effects():
        simulator.set_ground_effect(model)  # in flight: state, pilot and time go on
        simulator.fly(2.0)
        state = simulator.state
        thrust_N = state["rotor_thrust_N"]
        if model == "none":
            alone_N = thrust_N
        change = 100.0 * (thrust_N / alone_N - 1.0)
        print("%-18s  %.4f   %7.3f N     %+.2f %%" % (model, state["commands"].mean(), thrust_N, change))
    rows = simulator.recording()
    time_s, altitude_m = rows["time_s"][-1], rows["altitude_m"][-1]
    print("%d rows, the last at %.2f s, %.3f m above ground" % (simulator.rows, time_s, altitude_m))


if __name__ == "__main__":
    main()

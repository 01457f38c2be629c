# SPDX-License-Identifier: MIT
# A flight with what a log has: NaN, infinity, empty cells, motions that no training saw, gaps, a battery. Rows every 20 ms.
#   spoil.py FLIGHT.csv SPOILT.csv
import csv
import sys

rows = list(csv.reader(open(sys.argv[1])))
column = {name: i for i, name in enumerate(rows[0])}
rows[0].append("battery_voltage [V]")
for i, row in enumerate(rows[1:]):
    row[column["t"]] = f"{0.02 * i + (1 if i >= 800 else 0):.3f}"
    row.append(f"{4.1 - 1e-4 * i:.4f}")
    if i % 97 == 5:
        row[column["wdot_x"]] = "nan"
    if i % 89 == 7:
        row[column["v_by"]] = ""
    if i % 83 == 9:
        row[column["w_z"]] = "-inf"
    if i % 79 == 11:
        row[column["roll"]] = "nan"
    if 400 <= i < 460:
        row[column["wdot_y"]] = str(3 * float(row[column["wdot_y"]]) + 200)
    if 600 <= i < 620:
        row[column["vdot_bz"]] = "3000"  # outside, and the analytic inverse has no rotors for it
    if i % 300 == 17:
        row[column["altitude"]] = "nan"  # which only some models ask for
csv.writer(open(sys.argv[2], "w"), lineterminator="\n").writerows(rows)

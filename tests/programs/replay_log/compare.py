# SPDX-License-Identifier: MIT
# The table of a replay against what a compiled model answered, row by row: statuses alike, commands within 1e-5.
#   compare.py REPLAYED.csv JUDGED.txt LEAST_STATUSES
import csv
import math
import sys

replayed = list(csv.DictReader(open(sys.argv[1])))
judged = [line.split() for line in open(sys.argv[2])]
assert len(replayed) == len(judged), (len(replayed), len(judged))
worst, seen = 0, set()
for number, (row, (status, cause, *commands)) in enumerate(zip(replayed, judged), start=1):
    assert (row["status"], row["cause"]) == (status, cause), (number, row, status, cause)
    assert int(row["row"]) == number
    seen.add(status)
    answered = {"ok": "model", "limited": "model", "fell_back": "analytic_inverse"}.get(status, "nobody")
    assert row["answered_by"] == answered, (number, row)
    assert bool(row["reason"]) == (status != "ok"), (number, row)
    for i, command in enumerate(commands):
        mine = row[f"u{i + 1}"]
        if math.isnan(float(command)):
            assert mine == "", (number, row)
        else:
            worst = max(worst, abs(float(mine) - float(command)))
assert worst <= 1e-5, worst
assert len(seen) >= int(sys.argv[3]), seen
print(f"{len(judged)} rows, statuses {sorted(seen)}, commands within {worst:.1e}")

# SPDX-License-Identifier: MIT
# Changes a core's log: one cell, or rows taken out. Columns and rows by name and tick.
#   planted.py LOG.csv OUT.csv set TICK COLUMN VALUE | add TICK COLUMN VALUE | drop FIRST LAST [FIRST LAST...] | rename COLUMN NAME
import csv
import sys

source, target, how, *what = sys.argv[1:]
rows = list(csv.reader(open(source)))
column = {name: i for i, name in enumerate(rows[0])}
if how == "rename":
    rows[0][column[what[0]]] = what[1]
elif how == "drop":
    gaps = [(int(first), int(last)) for first, last in zip(what[::2], what[1::2])]
    gone = lambda tick: any(first <= tick <= last for first, last in gaps)
    rows = rows[:1] + [row for row in rows[1:] if not gone(int(row[column["tick"]]))]
else:
    (row,) = [row for row in rows[1:] if row[column["tick"]] == what[0]]
    at = column[what[1]]
    row[at] = what[2] if how == "set" else repr(float(row[at]) + float(what[2]))
csv.writer(open(target, "w"), lineterminator="\n").writerows(rows)

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: SciPy 1.10.1 (Debian 12's python3-scipy).
# One would guess: uniform_filter1d(x, 5) is a filter of finite memory: one NaN spoils the five rows that see it, as
#   correlate1d with five equal weights does; one wild row is forgotten as soon as it has left the window.
# What happens: it keeps a running sum. After one NaN every later row is NaN; after one row of 1e17 every later row is off.
# Seen: 60 rows, NaN in row 20: 42 NaN (rows 18 to 59), correlate1d 5. With 1e17 there: rows 23 to 59 are off by up to 0.74.
# Why it matters: logs have NaN where a sensor dropped out, and a wild row in a crash. One of them ends the filtered flight.
# pinnquad: import filters runs of finite rows, and weighs each window anew (tools/logs/savitzky_golay.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
from scipy import ndimage

flown = np.sin(0.1 * np.arange(60))
lost, wild = flown.copy(), flown.copy()
lost[20], wild[20] = np.nan, 1e17
running = int(np.isnan(ndimage.uniform_filter1d(lost, 5)).sum())
weighed = int(np.isnan(ndimage.correlate1d(lost, np.full(5, 0.2))).sum())
off = np.abs(ndimage.uniform_filter1d(wild, 5) - ndimage.uniform_filter1d(flown, 5))[23:]
print(f"one NaN spoils {running} of 60 rows (correlate1d: {weighed}); after one wild row the others are off by up to {off.max():.2f}")
assert running == 42 and weighed == 5 and off.min() > 0.01, "changed: uniform_filter1d forgets what has left the window"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

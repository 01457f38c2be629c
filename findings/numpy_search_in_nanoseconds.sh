#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: NumPy 1.24.2 (Debian 12's python3-numpy).
# One would guess: searchsorted(stamps, n) of uint64 stamps and a Python integer finds n exactly: both are integers.
# What happens: the integer becomes int64, and the common type of uint64 and int64 is float64. All stamps are converted to
#   doubles, which are 256 ns apart at nanoseconds since 1970: the place found is too early. Comparing with == is exact.
# Seen: in stamps 100 ns apart the stamp of row 5 is found at row 4; with numpy.uint64(n) at row 5.
# Why it matters: MCAP, ROS 2 and tlog carry nanoseconds since 1970 as uint64. Rows near the bounds of a time range are taken
#   from the wrong side, and side="left" may give a row that is before the time asked for. The array is copied at each call.
# pinnquad: nanoseconds of a CSV log become seconds in double, 0.24 us apart since 1970: far below a sample's length; a ULog's
#   microseconds are exact in double.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1:1.24.2-1+deb12u1
[ "$(dpkg-query -W -f '${Version}' python3-numpy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-numpy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np

first = 1_700_000_000_000_000_000
stamps = first + np.arange(0, 2000, 100, dtype=np.uint64)
wanted = first + 500
plain, typed = np.searchsorted(stamps, wanted), np.searchsorted(stamps, np.uint64(wanted))
print(f"{stamps.dtype} stamps: row {plain} by a Python integer, row {typed} by a uint64; right is 5")
assert stamps.dtype == np.uint64 and plain == 4 and typed == 5, "changed: searchsorted finds a Python integer among uint64 stamps"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

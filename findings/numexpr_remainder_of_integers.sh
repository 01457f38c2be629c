#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: numexpr 2.8.4 under pandas 1.5.3 (Debian 12's python3-numexpr and python3-pandas).
# One would guess: % in DataFrame.eval() and query() is that of pandas and Python, never negative for a positive divisor; for
#   integers as for floats.
# What happens: for floats it is. For integers numexpr takes C's: the remainder has the sign of what is divided. The same text
#   with engine="python", or on a machine without numexpr, gives something else.
# Seen: yaw of -1, -185, 1 and 185 degrees in hundredths: % 36000 gives -100, -18500, 100, 18500; as floats, and with
#   engine="python", 35900, 17500, 100, 18500. Wrapped to +-180 degrees -185 remains -185.
# Why it matters: ArduPilot and MAVLink send headings in hundredths of a degree: half of a turning flight is wrapped wrongly.
# pinnquad: angles are wrapped in floating point (std::remainder).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in python3-numexpr=2.8.4-1+b2 python3-pandas=1.5.3+dfsg-2 python3-numpy=1:1.24.2-1+deb12u1; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install $want"; exit 2; }
done
cat >"$dir/observe.py" <<'PYTHON'
import pandas as pd

log = pd.DataFrame({"yaw": [-100, -18500, 100, 18500]})
turned, right = log.eval("yaw % 36000").tolist(), log.eval("yaw % 36000", engine="python").tolist()
floats = log.astype(float).eval("yaw % 36000").tolist()
wrapped = log.eval("(yaw + 18000) % 36000 - 18000").tolist()
print(f"integers {turned}, floats {floats}, engine python {right}; wrapped to half a turn {wrapped}")
assert right == floats == [35900, 17500, 100, 18500], "changed: the remainder of floats"
assert turned == [-100, -18500, 100, 18500] and wrapped[1] == -18500, "changed: the remainder of integers"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: pandas 1.5.3 (Debian 12's python3-pandas).
# One would guess: resample("10ms").interpolate() interpolates the rows of a log at each 10 ms.
# What happens: first all rows are dropped whose stamp is not exactly one of the new ones. What is left is interpolated: often
#   the first row alone, which is then repeated to the end.
# Seen: sin(3 t) at 200 Hz for 2 s, its stamps off by up to 0.3 ms: all 200 new rows are 0. With exact stamps the same call is
#   exact; numpy.interp of the shaken rows is off by 7e-6.
# Why it matters: stamps of a real log are never exact. A simulated log passes through it, a flown one becomes a constant.
# pinnquad: import interpolates rows by their own stamps (tools/logs/common_rows.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in python3-pandas=1.5.3+dfsg-2 python3-numpy=1:1.24.2-1+deb12u1; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install $want"; exit 2; }
done
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
import pandas as pd


def observed(shaken):
    row = np.arange(400)
    microseconds = 5000 * row + np.round(shaken * np.sin(1.3 * row)).astype(int)
    log = pd.Series(np.sin(3e-6 * microseconds), index=pd.to_timedelta(microseconds, unit="us"))
    made = log.resample("10ms").interpolate()
    seconds = made.index.total_seconds()
    by_numpy = np.interp(seconds, 1e-6 * microseconds, log)
    return made, np.abs(made - np.sin(3 * seconds)).max(), np.abs(by_numpy - np.sin(3 * seconds)).max()


exact, flown = observed(0), observed(300)
print(f"exact stamps: off by {exact[1]:.2g}; 0.3 ms off: {flown[0].nunique()} value in {len(flown[0])} rows, off by {flown[1]:.2g}, "
      f"numpy.interp by {flown[2]:.2g}")
assert exact[1] < 1e-9 and flown[2] < 1e-3, "changed: the interpolation of exact stamps"
assert flown[0].nunique() == 1 and flown[1] > 0.99, "changed: resample().interpolate() takes the rows between"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: statsmodels 0.13.5 (Debian 12's python3-statsmodels 0.13.5+dfsg-7).
# One would guess: OLS of a straight line, with add_constant(), finds its slope whatever the unit and the begin of its clock; if
#   it could not, its standard error would say so.
# What happens: the default, method="pinv", takes the constant and seconds since 1970 for one column where the flight is short,
#   and fits the mean: of a minute, ten or sixty. The slope's standard error is below 1e-7, its p-value 0.
# Seen: y = 2 (t - first) + 1 over 600 s: slope 3.5e-07, standard error 4.6e-09, off by 600 at both ends. Right, by SciPy's
#   linregress of the same columns: 2.000000. Of t - first: 2.
# Why it matters: a drift of a sensor or of a clock is regressed on its stamps: none is found, and significantly so.
# pinnquad: fits regress on what was flown; the time of a row is no input of theirs.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in python3-statsmodels=0.13.5+dfsg-7 python3-numpy=1:1.24.2-1+deb12u1 python3-scipy=1.10.1-2; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install $want"; exit 2; }
done
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
import statsmodels.api as sm
from scipy.stats import linregress

for seconds in (60, 600, 3600):
    flown = np.linspace(0, seconds, 2000)
    unix, y = 1.7e9 + flown, 2 * flown + 1
    fit = sm.OLS(y, sm.add_constant(unix)).fit()
    right, from_zero = linregress(unix, y).slope, sm.OLS(y, sm.add_constant(flown)).fit().params[1]
    off = np.abs(fit.fittedvalues - y).max()
    slope, error, p = fit.params[1], fit.bse[1], fit.pvalues[1]
    print(f"{seconds} s: slope {slope:.2g} +- {error:.2g}, p = {p:.1g}, off by {off:.0f}; linregress {right:.6f}")
    assert abs(right - 2) < 1e-6 and abs(from_zero - 2) < 1e-9, "changed: the right slope"
    assert slope < 1e-5 and error < 1e-7 and p < 1e-9 and off > 0.99 * seconds, "changed: OLS of Unix time"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

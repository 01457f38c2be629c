#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: pandas 1.5.3 with bottleneck 1.3.5 and NumPy 1.24.2 (Debian 12: python3-pandas recommends python3-bottleneck).
# One would guess: Series.std() of a float32 column is the standard deviation to six digits or so, as that of numpy.std is.
# What happens: pandas hands the column to bottleneck, which adds up in float32, one number after the other. Of two million
#   rows of the vertical accelerometer (-9.81 m/s^2, deviation 0.05) std() says 0.142; of a motor value around 1500 with
#   deviation 1 it says 18.5. Without bottleneck the same call is right, so it depends on what else is installed.
# Seen: accelerometer 0.1424, motor 18.4610; without bottleneck 0.0500 and 1.0005; numpy.std in double 0.0500 and 1.0005.
# Why it matters: logs hold float32. Scaling of features, noise floors and limits of outliers are taken from std().
# pinnquad: C++ adds up in double and uses no pandas.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in python3-pandas=1.5.3+dfsg-2 python3-bottleneck=1.3.5+ds1-2+b1 python3-numpy=1:1.24.2-1+deb12u1; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install ${want}"; exit 2; }
done
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
import pandas as pd

random = np.random.default_rng(1)
for name, middle, deviation in (("accelerometer", -9.81, 0.05), ("motor", 1500, 1)):
    column = pd.Series((middle + deviation * random.standard_normal(2_000_000)).astype(np.float32))
    with pd.option_context("compute.use_bottleneck", True):
        fast = column.std()
    with pd.option_context("compute.use_bottleneck", False):
        slow = column.std()
    exact = column.to_numpy(np.float64).std(ddof=1)
    print(f"{name}: std {fast:.4f}, without bottleneck {slow:.4f}, in double {exact:.4f}")
    assert fast > 2 * exact and abs(slow / exact - 1) < 1e-3, "changed: pandas takes the deviation of float32 as it should"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

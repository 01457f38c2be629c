#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: SciPy 1.10.1 (Debian 12's python3-scipy).
# One would guess: least_squares() and minimize() of a model that calculates in float32 find its parameters to five digits or
#   so, or report that they have not converged.
# What happens: the step of the numerical gradient is 1.5e-8 of the parameter, far below what float32 resolves, so the gradient
#   is 0 and the start is returned at once: success is True, the message says that a tolerance is satisfied. Where the
#   residuals are returned as float32 least_squares() takes a larger step and converges: the last conversion decides.
# Seen: 2 exp(-3 t) from (1, 1): least_squares (1, 1), success True; minimize (1, 1), success True; float32 residuals (2, 3).
# Why it matters: networks, onnxruntime and compiled simulators are models in float32, and their outputs are added to doubles.
# pinnquad: thrust curve, lag and effects are identified in double.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
from scipy import optimize

time = np.linspace(0, 1, 200, dtype=np.float32)
flown = (2 * np.exp(-3 * time)).astype(np.float32)


def residuals(parameters):
    gain, rate = parameters.astype(np.float32)
    return gain * np.exp(-rate * time) - flown


start = np.ones(2)
wide = optimize.least_squares(lambda p: residuals(p).astype(np.float64), start)
least = optimize.minimize(lambda p: float((residuals(p) ** 2).sum()), start)
narrow = optimize.least_squares(residuals, start)
print("residuals as double:", wide.x, wide.success, "- minimize:", least.x, least.success, "- as float32:", narrow.x.round(4))
assert wide.success and (wide.x == 1).all() and least.success and (least.x == 1).all(), "changed: a float32 model is fitted, or refused"
assert abs(narrow.x - (2, 3)).max() < 1e-3, "changed: float32 residuals are not fitted"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

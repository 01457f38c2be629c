#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: SciPy 1.10.1 (Debian 12's python3-scipy).
# One would guess: signal.decimate() is a low pass without delay: what is constant stays.
# What happens: its filter is a Chebyshev one of type I and even order, whose gain at 0 Hz is the bottom of the ripple, 0.9943;
#   it is run forwards and backwards, so a constant is multiplied by 0.9886. With ftype="fir" it stays.
# Seen: 9.81 m/s^2 by 4 -> 9.6977, by 10 -> 9.6977; fir 9.8100 (in the middle; the FIR begins from 0 at both ends).
# Why it matters: a hover's specific force is 1.1 % too small after it: so are mass, thrust curve and every bias found with it.
# pinnquad: smoothing is by least-squares polynomials, which keep a constant (tools/logs/savitzky_golay.cpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
cat >"$dir/observe.py" <<'PYTHON'
import numpy as np
from scipy import signal

hover = np.full(1000, 9.81)
by_4, by_10 = signal.decimate(hover, 4)[125], signal.decimate(hover, 10)[50]
fir = signal.decimate(hover, 4, ftype="fir")[125]
print(f"9.81 decimated by 4: {by_4:.4f}, by 10: {by_10:.4f}, by 4 with ftype fir: {fir:.4f}")
assert abs(by_4 - 9.6977) < 1e-3 and abs(by_10 - 9.6977) < 1e-3 and abs(fir - 9.81) < 1e-3, "changed: decimate keeps a constant"
PYTHON
/usr/bin/python3 "$dir/observe.py" 2>"$dir/errors" || { tail -n 1 "$dir/errors"; exit 1; }

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: libsamplerate 0.2.2 (Debian 12's libsamplerate0 0.2.2-3).
# One would guess: SRC_LINEAR is linear interpolation: a ramp comes out as the same ramp, in place.
# What happens: linear and zero-order hold begin with the first sample twice: all of the output is one input sample late. The
#   three sinc converters are in place. The hold also returns one sample more.
# Seen: the ramp 0, 1, 2, ... of 1000 samples at a quarter of its rate: linear 0, 3, 7, ...; in its middle 1.0 sample late,
#   sinc 0.0001.
# Why it matters: a gyro at 250 Hz is 4 ms late, as much as a rotor lag differs between vehicles, and only with this method.
# pinnquad: rows are resampled by their own stamps.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1:1.24.2-1+deb12u1
[ "$(dpkg-query -W -f '${Version}' python3-numpy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-numpy=$want"; exit 2; }
cd "$dir"
package=libsamplerate0=0.2.2-3
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
cat >observe.py <<'PYTHON'
import ctypes
import glob

import numpy as np

library = ctypes.CDLL(glob.glob("packages/usr/lib/*/libsamplerate.so.0")[0])


class Data(ctypes.Structure):
    _fields_ = [("given", ctypes.c_void_p), ("made", ctypes.c_void_p), ("rows", ctypes.c_long), ("room", ctypes.c_long),
                ("used", ctypes.c_long), ("count", ctypes.c_long), ("ends", ctypes.c_int), ("ratio", ctypes.c_double)]


def late(converter, ratio=0.25):
    ramp, made = np.arange(1000, dtype=np.float32), np.zeros(2000, np.float32)
    data = Data(ramp.ctypes.data, made.ctypes.data, len(ramp), len(made), 0, 0, 1, ratio)
    assert library.src_simple(ctypes.byref(data), converter, 1) == 0
    middle = data.count // 2
    return middle / ratio - float(made[middle])


sinc, hold, linear = late(0), late(3), late(4)
print(f"input samples late: sinc {sinc:.4f}, hold {hold:.4f}, linear {linear:.4f}")
assert abs(sinc) < 0.01 and hold == 1 and linear == 1, "changed: linear or hold of libsamplerate is not one sample late"
PYTHON
/usr/bin/python3 observe.py 2>errors || { tail -n 1 errors; exit 1; }

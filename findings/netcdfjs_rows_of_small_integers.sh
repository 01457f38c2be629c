#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: netcdfjs 4.0.0 (npm), with files that SciPy 1.10.1 writes (Debian 12's python3-scipy).
# One would guess: rows of int8 and int16 beside a time come back as they were written.
# What happens: in the file each row of a variable with an unlimited dimension is padded to four bytes. The padding is read as
#   values: a row of int16 becomes two numbers, the second -32767, a row of int8 four. NC_BYTE is signed, and is read unsigned.
# Seen: int8 and int16 -2, -1, 0 -> 254, 129, 129, 129, 255, ... and -2, -32767, -1, -32767, ...; float and double are right.
# Why it matters: sensor counts and temperatures are such integers: a temperature of -1 degree is 255, a column of counts is
#   twice as long and swings to its end in every second row.
# pinnquad: import does not read netCDF.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" netcdfjs@4.0.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install netcdfjs"
  exit 2
}
cat >"$dir/write.py" <<'PYTHON'
import sys

import numpy as np
from scipy.io import netcdf_file

with netcdf_file(sys.argv[1], "w") as log:
    log.createDimension("row", None)
    for name, kind in (("time_s", "f8"), ("celsius", "i1"), ("counts", "i2"), ("volt", "f4")):
        log.createVariable(name, kind, ("row",))[:3] = np.array([-2, -1, 0], kind)
with netcdf_file(sys.argv[1], mmap=False) as log:
    assert all(column[:].tolist() == [-2, -1, 0] for column in log.variables.values())
PYTHON
/usr/bin/python3 "$dir/write.py" "$dir/log.nc"
cat >"$dir/observe.mjs" <<'JS'
import { readFileSync } from 'fs';
import { NetCDFReader } from 'netcdfjs';
const log = new NetCDFReader(readFileSync(new URL('log.nc', import.meta.url)));
const seen = ['time_s', 'celsius', 'counts', 'volt'].map((name) => log.getDataVariable(name).flat().join());
console.log(`-2, -1, 0 as double ${seen[0]}; int8 ${seen[1]}; int16 ${seen[2]}; float ${seen[3]}`);
const right = '-2,-1,0', bytes = '254,129,129,129,255,129,129,129,0,129,129,129', counts = '-2,-32767,-1,-32767,0,-32767';
if (seen.join('|') !== [right, bytes, counts, right].join('|')) {
  console.log('changed: rows of int8 or int16 are read otherwise');
  process.exit(1);
}
JS
node "$dir/observe.mjs"

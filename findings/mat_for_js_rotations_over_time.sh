#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: mat-for-js 1.1.0 (npm), with a file that SciPy 1.10.1 writes (Debian 12's python3-scipy).
# One would guess: an array of three dimensions comes back with its numbers, each once, at their places.
# What happens: from the third dimension on the offsets of elements overlap: some numbers come twice, others not at all.
#   Matrices are right.
# Seen: 0 to 7 as 2 x 2 x 2 -> 0, 2, 2, 1, 4, 6, 6, 5: neither 3 nor 7. As 2 x 4 all of them, in order.
# Why it matters: attitudes are kept as 3 x 3 x rows, covariances too: no error, and matrices that are no rotations.
# pinnquad: import refuses MAT files by their first bytes and names the table to make of them (docs/formats.md).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
want=1.10.1-2
[ "$(dpkg-query -W -f '${Version}' python3-scipy 2>/dev/null)" = "$want" ] || { echo "not run: install python3-scipy=$want"; exit 2; }
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" mat-for-js@1.1.0 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install mat-for-js"
  exit 2
}
cat >"$dir/write.py" <<'PYTHON'
import sys

import numpy as np
from scipy.io import loadmat, savemat

numbers = np.arange(8.0)
savemat(sys.argv[1], {"cube": numbers.reshape(2, 2, 2), "matrix": numbers.reshape(2, 4)})
read = loadmat(sys.argv[1])
assert (read["cube"].ravel() == numbers).all() and (read["matrix"].ravel() == numbers).all()
PYTHON
/usr/bin/python3 "$dir/write.py" "$dir/log.mat"
cat >"$dir/observe.mjs" <<'JS'
import { readFileSync } from 'fs';
import { read } from 'mat-for-js';
const bytes = readFileSync(new URL('log.mat', import.meta.url));
const { cube, matrix } = read(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length)).data;
const [three, two] = [cube, matrix].map((array) => array.flat(2).join());
console.log(`0 to 7 as 2 x 2 x 2: ${three}; as 2 x 4: ${two}`);
if (three !== '0,2,2,1,4,6,6,5' || two !== '0,1,2,3,4,5,6,7') {
  console.log('changed: arrays of three dimensions');
  process.exit(1);
}
JS
node "$dir/observe.mjs"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: csv-parse 7.0.3 (npm), with cast: true.
# One would guess: a hexadecimal cell becomes its number, as by Number(), or remains text.
# What happens: the cell is found to be a number because '0x1F' - 0 is one, and is then read by parseFloat(), which stops at
#   the x: each hexadecimal cell becomes 0. '0b11' too. A number too great for a double remains text.
# Seen: 0x1F -> 0, 0b11 -> 0, 1e400 -> '1e400', 1.5 -> 1.5.
# Why it matters: status words, arming flags and failsafe masks are logged as hexadecimal: all of them read 'nothing wrong'.
# pinnquad: a cell 0x1F is refused with its line and column: expected a finite number.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$dir" csv-parse@7.0.3 >"$dir/log" 2>&1 || {
  echo "not run: npm does not install csv-parse"
  exit 2
}
cat >"$dir/observe.cjs" <<'JS'
const { parse } = require('csv-parse/sync');
const [row] = parse('t,flags,mask,wild\n1.5,0x1F,0b11,1e400\n', { cast: true, columns: true });
console.log(JSON.stringify(row));
if (row.t !== 1.5 || row.flags !== 0 || row.mask !== 0 || row.wild !== '1e400') {
  console.log('changed: csv-parse reads a hexadecimal cell otherwise');
  process.exit(1);
}
JS
node "$dir/observe.cjs"

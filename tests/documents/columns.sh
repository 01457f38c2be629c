#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# docs/train.md defines the columns of a flight: those of data/dataset.hpp, each once, and no others.
#   columns.sh ROOT
set -euo pipefail
cd -- "$1"
code=$(awk '/sample_field_names = \{/ { inside = 1 } inside { print } inside && /\};/ { exit }' include/pinnquad/data/dataset.hpp |
  sed 's,//.*,,' | grep -oE '"[a-z0-9_]+"' | tr -d '"' | sort)
table=$(awk '/^\| column \|/ { inside = 1; next } inside && !/^\|/ { exit } inside { split($0, cell, "|"); print cell[2] }' docs/train.md |
  grep -oE '`[a-z0-9_]+`' | tr -d '`' | sort)
if [ -z "$code" ]; then echo "include/pinnquad/data/dataset.hpp:1: no sample_field_names found"; exit 1; fi
diff <(echo "$code") <(echo "$table") || { echo "docs/train.md: < not defined, > no column of a flight"; exit 1; }
echo "$(wc -l <<<"$code") columns, all defined"

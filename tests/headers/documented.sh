#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Every public type and function of a folder has a comment, as Doxygen reads it. Exit code 1 with file:line: for each that
# has none.
#   documented.sh DOXYGEN ROOT FOLDER
set -euo pipefail
cd -- "$2"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
{
  cat tools/site/Doxyfile
  printf '%s\n' "OUTPUT_DIRECTORY = $scratch" "GENERATE_HTML = NO" "INPUT = $3 tools/site/cpp.dox"
} | "$1" - 2>"$scratch/log"
faults=$(grep -E 'warning: (Compound|Member .*\((function|enumeration)\) of namespace) .* is not documented' "$scratch/log" || true)
if [ -n "$faults" ]; then
  echo "$faults"
  exit 1
fi
echo "every public type and function has a comment"

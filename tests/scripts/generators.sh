#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# generators.sh <folder>: every configure in the folder's scripts, build files and documents names its generator, by -G
# or by a preset. Without one CMake takes make, which a machine that follows the README does not have.
set -euo pipefail
cd -- "$1"

# commands of one line each: continued lines joined, chains taken apart
# shellcheck disable=SC2016
check='
  FNR == 1 { line = "" }
  { if (line == "") first = FNR; line = line $0 }
  sub(/\\$/, " ", line) { next }
  { count = split(line, commands, /&&|\|\||;|\|/)
    for (i = 1; i <= count; i++) {
      command = commands[i]
      if (command !~ /(^|[^A-Za-z_.])(cmake|\$?\{?CMAKE_COMMAND\}?)["\x27]?,?( |$)/) continue
      if (command !~ /[ ="\x27](-S|-B)([ "\x27]|$)/ && command !~ /cmake +(-D[^ ]+ +)*\.\.?(\/[^ ]*)?( |$)/) continue
      if (command ~ /[ "\x27](-G|--preset)([ "\x27=]|$)/) continue
      print FILENAME ":" first ": a configure without a generator:" command
    }
    line = "" }'
mapfile -t files < <(find . \( -name .git -o -name build -o -name 'demo_out*' -o -name node_modules -o -name generator_faults \) \
  -prune -o -type f -exec grep -lIi cmake {} + | sort)
[ ${#files[@]} -gt 0 ] || { echo "no file here speaks of cmake"; exit 1; }
faults=$(
  awk "$check" "${files[@]}"
  # configures too, over several lines
  { grep -lE -- '^ *--build-and-test' "${files[@]}" || true; } | while IFS= read -r file; do
    grep -q -- '--build-generator' "$file" || echo "$file: --build-and-test without --build-generator"
  done
)
[ -z "$faults" ] || echo "$faults"
echo "$(grep -c . <<<"$faults") faults"
[ -z "$faults" ]

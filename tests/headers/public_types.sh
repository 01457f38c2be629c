#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Public types of the library, and whether anything but a test needs each: another header, a program, an example, a bench,
# a page that shows it, or another line of its own header. Exit code 1 with file:line: message for each that nothing needs.
#   public_types.sh ROOT [--count]     --count: types by room, and all
set -euo pipefail
cd -- "$1"
mapfile -t headers < <(find include/pinnquad -name '*.hpp' | LC_ALL=C sort)
[ ${#headers[@]} -gt 0 ] || { echo "no headers below $1/include/pinnquad"; exit 1; }

# file:line<tab>name of each type that a header declares in namespace pinnquad; `detail` is the library's own
types() {
  awk 'FNR == 1 { hidden = 0 }
    /^namespace .*\{$/ { hidden += /detail/ }
    /^}  \/\/ namespace/ { hidden -= /detail/ }
    hidden == 0 && /^(struct|class|enum class|using) [A-Z]/ {
      name = $0
      sub(/^(enum class|struct|class|using) /, "", name)
      sub(/[^A-Za-z0-9_].*/, "", name)
      if (!(name in seen)) print FILENAME ":" FNR "\t" name
      seen[name] = 1
    }' "${headers[@]}"
}
if [ "${2:-}" = --count ]; then
  types | awk '{ split($1, part, "/"); room = part[3] ~ /\.hpp/ ? "." : part[3]; ++count[room]; ++all }
    END { for (room in count) print room, count[room]; print "all", all }' | LC_ALL=C sort
  exit
fi

folders=()
for folder in tools examples bench docs README.md; do [ ! -e "$folder" ] || folders+=("$folder"); done
mapfile -t readers < <(find "${folders[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.c' -o -name '*.in' \
  -o -name '*.md' \) | LC_ALL=C sort)
unused=$(types | awk -F'\t' 'FNR == NR { place[$2] = $1; next }
  FNR == 1 { fence = 0 }
  {
    line = $0
    if (FILENAME !~ /\.md$/) {
      sub(/\/\/.*/, "", line)
    } else if (/^```/) {
      fence = !fence
    } else if (!fence) {  # of prose, what is in code font
      parts = split($0, part, "`")
      line = ""
      for (i = 2; i <= parts; i += 2) line = line " " part[i]
    }
    while (match(line, /[A-Za-z_][A-Za-z0-9_]*/)) {
      word = substr(line, RSTART, RLENGTH)
      if (word in place && place[word] != FILENAME ":" FNR) needed[word] = 1
      line = substr(line, RSTART + RLENGTH)
    }
  }
  END { for (name in place) if (!(name in needed)) print place[name] ": nothing but tests needs " name }' - "${headers[@]}" "${readers[@]}" |
  LC_ALL=C sort)
if [ -n "$unused" ]; then
  echo "$unused"
  exit 1
fi
echo "$(types | wc -l) public types, each needed"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# The rooms of the program: a file includes headers of its own room and of those that tools/CMakeLists.txt names before it, all
# by their path from tools/; the program itself may include every room. Program and examples do not include each other.
#   rooms.sh TOOLS EXAMPLES
set -euo pipefail
examples=$(cd -- "$2" && pwd)
cd -- "$1"
faults=0
fault() {
  echo "$1"
  faults=$((faults + 1))
}
mapfile -t rooms < <(sed -n 's/^#   \([a-z_]*\)  .*/\1/p' CMakeLists.txt)
[ ${#rooms[@]} -gt 1 ] || fault "CMakeLists.txt:1: names no rooms"
declare -A place
for ((i = 0; i < ${#rooms[@]}; ++i)); do place[${rooms[i]}]=$i; done
for folder in */; do
  [ -n "${place[${folder%/}]:-}" ] || fault "${folder%/}: CMakeLists.txt does not name this room"
done
while IFS=: read -r file line text; do
  header=${text#*\"} header=${header%\"*}
  case $header in
    pinnquad/*) continue ;;
    *examples/*) fault "$file:$line: the program includes an example: $header" && continue ;;
  esac
  room=${file%%/*} other=${header%%/*}
  if [ ! -f "$header" ]; then
    fault "$file:$line: no such header from here: $header"
  elif [[ $file == */* ]] && [ "${place[$other]:-99}" -gt "${place[$room]:-0}" ]; then
    fault "$file:$line: $room comes before $other"
  fi
done < <(grep -rn '^#include "' --include='*.hpp' --include='*.cpp' .  | sed 's,^\./,,')
while IFS=: read -r file line text; do
  header=${text#*[<\"]} header=${header%[>\"]*}
  if [ -f "$header" ] || [[ $header == *tools/* ]]; then
    fault "$file:$line: an example includes the program: $header"
  fi
done < <(cd -- "$examples" && grep -rnE '^ *# *include *[<"]' --include='*.hpp' --include='*.cpp' --include='*.h' --include='*.c' .)
if [ "$faults" -ne 0 ]; then
  printf '\n%s faults\n' "$faults"
  exit 1
fi
echo "${#rooms[@]} rooms, one direction"

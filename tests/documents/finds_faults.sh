#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Each faults/*.md has a fault, and says at its head in a hidden comment by which message it must be found:
#   <!-- expect: regular expression -->
# control.md has none and expects 'nothing'.
#   finds_faults.sh ROOT BUILD PREFIX WORK
set -euo pipefail
root=$1 build=$2 prefix=$3 work=$4
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
failed=0
mkdir -p "$work"
for document in "$here"/faults/*.md; do
  name=$(basename "$document" .md)
  expected=$(sed -n '1s/^<!-- expect: \(.*\) -->$/\1/p' "$document")
  [ -n "$expected" ] || { echo "$document: its first line must say what to expect"; exit 1; }
  code=0
  {
    case $name in
      link_*) "$here/links.sh" "$root" "tests/documents/faults/$name.md" ;;
      *) "$here/check.sh" "$root" "$build" "$prefix" "$work/$name" "$document" ;;
    esac
  } >"$work/$name.output" 2>&1 || code=$?
  if [ "$expected" = nothing ]; then
    if [ "$code" -eq 0 ]; then continue; fi
    echo "$name: no fault is in it, but one was found:"
  elif [ "$code" -eq 1 ] && grep -qE -- "$name\.md:[0-9]+:.*$expected" "$work/$name.output"; then
    continue
  else
    echo "$name: expected '$expected', found (exit code $code):"
  fi
  cat "$work/$name.output"
  failed=1
done
exit "$failed"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Writes the manual page of pinnquad from what the program says of itself: help2man's page of --help and --version, with a section
# for each command.
#   manual_page.sh PINNQUAD PAGE      PAGE is an absolute path
set -euo pipefail
program=$1 page=$2
include=$(mktemp)
trap 'rm -f -- "$include"' EXIT

# sections <command>...: that of each command below it, and theirs
sections() {
  local help names name
  help=$("$program" "$@" --help)
  names=$(sed '1,/^Subcommands:/d' <<<"$help" | awk '/^  [a-z]/ { print $1 } /^[^ ]/ { exit }')
  if [ -z "$names" ]; then
    printf '[PINNQUAD %s]\n.nf\n' "${*^^}"
    sed "s/\\\\/\\\\e/g; s/-/\\\\-/g; s/^[.']/\\\\\\&&/" <<<"$help"
    printf '.fi\n\n'
  fi
  for name in $names; do sections "$@" "$name"; done
}
sections >"$include"
cd -- "$(dirname -- "$program")" # help2man takes a command, not a path with spaces in it
help2man --no-info --section 1 --name 'from a quadrotor'\''s flight to a network that may fly' --include "$include" \
  "./$(basename -- "$program")" >"$include.page"
mv -- "$include.page" "$page"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# packages.sh <repository> <working folder>: scripts/lib/packages.sh against an apt-get, a dpkg-query, an id and a sudo
# of our own, which write down how they are called.
# shellcheck disable=SC2015,SC2016
set -euo pipefail
root=$1 work=$2
rm -rf "$work"
mkdir -p "$work/tools" "$work/repository/scripts"
cp -r "$root/scripts/lib" "$work/repository/scripts"
cd "$work"

fail() {
  echo "FAILED: $*; said: $(cat said.txt)" >&2
  exit 1
}
# tool <name>: its text on stdin
tool() {
  { echo "#!$(command -v bash)"; cat; } >"tools/$1"
  chmod +x "tools/$1"
}
for name in bash cat dirname env grep mkdir tail true; do ln -s "$(type -P "$name")" "tools/$name"; done
tool dpkg-query <<<'case ${!#} in installed-*) echo -n installed ;; *) exit 1 ;; esac'
tool apt-get <<<'echo "apt-get $*" >>calls.txt; echo "apt-get speaks"
case "$*" in *install*unwilling*) echo "E: Packages need to be removed but remove is disabled."; exit 100 ;; esac'
tool apt-cache <<<'echo "$2:"; case $2 in new-name|lib-old-*) echo "  Candidate: 1.0" ;; gone-*) echo "  Candidate: (none)" ;; esac'
tool id <<<'echo "${USER_ID:-0}"'

# require <packages>...: calls.txt, said.txt, code
require() {
  : >calls.txt
  code=0
  PATH=$work/tools bash -c \
    'source repository/scripts/lib/stage.sh; source repository/scripts/lib/packages.sh; require_packages "$@"' \
    script "$@" >said.txt 2>&1 || code=$?
}

require installed-one installed-two
[ "$code" -eq 0 ] && [ ! -s calls.txt ] || fail "installed packages were installed"

# what is in PATH is there, whichever package it came from
for pair in ninja-build:ninja clang:clang++ nodejs:node g++:g++ npm:npm; do
  require "${pair%:*}"
  grep -q "install .*${pair%:*}" calls.txt || fail "$pair: not installed where it is missing"
  tool "${pair#*:}" </dev/null
  require installed-one "${pair%:*}"
  [ "$code" -eq 0 ] && [ ! -s calls.txt ] || fail "$pair: installed beside the program of that name"
done

require lib-missing installed-one
[ "$code" -eq 0 ] || fail "exit code $code"
grep -qE '^apt-get install .*--no-remove.* lib-missing$' calls.txt || fail "called: $(cat calls.txt)"
[ "$(cat said.txt)" = "Installing lib-missing" ] || fail "apt-get was not quiet"
grep -q 'apt-get speaks' repository/build/packages.log || fail "no log"

# a package by the name that it has in this Debian
require 'new-name|old-name' 'gone-now|lib-old-name' 'unknown|unheard-of' 'not-here|installed-old'
grep -qE '^apt-get install .* new-name lib-old-name unknown$' calls.txt || fail "alternatives: called: $(cat calls.txt)"

require unwilling
[ "$code" -eq 1 ] || fail "exit code $code"
[ "$(wc -l <said.txt)" -eq 2 ] || fail "more than the announcement and a line"
grep -q 'could not install unwilling: E: Packages need to be removed.*/build/packages.log$' said.txt || fail "no reason"

# who may not install is told what root is to run; without sudo no word of it
export USER_ID=1000
rm repository/build/packages.log
require lib-missing
[ "$code" -eq 1 ] && [ ! -s calls.txt ] || fail "a user without sudo: exit code $code"
[ "$(wc -l <said.txt)" -eq 1 ] || fail "not one line"
grep -q 'as root, run: apt-get update && apt-get install .*--no-remove lib-missing$' said.txt || fail "no command"
! grep -q sudo said.txt || fail "names sudo to who has none"
[ ! -e repository/build/packages.log ] || fail "a log of nothing"

tool sudo <<<'echo "sudo $*" >>calls.txt; [ "$1" = -n ] && shift; exec "$@"'
require lib-missing
[ "$code" -eq 0 ] || fail "exit code $code"
grep -qE '^sudo -n env .*apt-get install .*--no-remove' calls.txt || fail "called: $(cat calls.txt)"

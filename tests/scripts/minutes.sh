#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# minutes.sh <repository> <working folder>: heavy parts that there is no time for are named, and none is begun; with time all run.
# Warnings are errors with --all, and only then. What scripts/test calls is stood in for.
set -euo pipefail
root=$1 work=$2
rm -rf -- "$work"
mkdir -p "$work/repository/scripts/heavy"
cp "$root/scripts/test" "$work/repository/scripts"
cp "$root/CMakePresets.json" "$work/repository"
cp -r "$root/scripts/lib" "$work/repository/scripts"
echo 'require_packages() { :; }' >"$work/repository/scripts/lib/packages.sh"
echo 'cmake() { echo "$*" >>calls; }; ctest() { mkdir -p build && echo passed; }; tee() { cat; }' >>"$work/repository/scripts/lib/packages.sh"
cd "$work/repository"
for part in first second; do
  printf '#!/usr/bin/env bash\ntouch %s.ran\n' "$part" >"scripts/heavy/$part"
  chmod +x "scripts/heavy/$part"
done

fail() {
  echo "FAILED: $*; said: $said" >&2
  exit 1
}
said=$(scripts/test --all --minutes 0 2>&1) || fail "exit code $?"
[ "$(tail -1 <<<"$said")" = "LEFT OUT after 0 minutes: first second" ] || fail "it does not say last what it left out"
if [ -e first.ran ] || [ -e second.ran ]; then fail "a heavy part was begun"; fi

for enough in '' '--minutes 60'; do
  rm -f ./*.ran
  # shellcheck disable=SC2086 # two words or none
  said=$(scripts/test --all $enough 2>&1) || fail "exit code $?"
  grep -q '^All stages passed' <<<"$(tail -1 <<<"$said")" || fail "it does not end with all passed"
  if [ ! -e first.ran ] || [ ! -e second.ran ]; then fail "a heavy part was left out"; fi
done

# configures <argument>: how many, and how many of them with warnings as errors
configures() {
  rm -f calls
  # shellcheck disable=SC2086 # a word or none
  said=$(scripts/test $1 2>&1) || fail "exit code $?"
  echo "$(grep -c -- ' -B ' calls) $(grep -c -- '-DPINNQUAD_WARNINGS_AS_ERRORS=ON' calls || true)"
}
[ "$(configures '')" = "1 0" ] || fail "warnings may end scripts/test"
read -r all strict < <(configures --all)
if [ "$all" -lt 2 ] || [ "$all" != "$strict" ]; then fail "$strict of $all presets of --all take warnings for errors"; fi

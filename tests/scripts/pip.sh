#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# pip.sh <repository> <working folder>: `pip install .` asks pip for cmake and ninja where PATH has none; says in its last line,
# with the packages to install, which programs are missing and why CMake fails; no table names the license, which setuptools 77
# calls deprecated. What the build calls is stood in for. Returns 77 without setuptools.
set -euo pipefail
root=$1 work=$2
python=/usr/bin/python3
"$python" -c 'import setuptools, wheel' 2>/dev/null || { echo "skipped: no setuptools or wheel"; exit 77; }
rm -rf -- "$work"
mkdir -p "$work/tools" "$work/repository/include/pinnquad"
cp "$root/pyproject.toml" "$root/README.md" "$root/LICENSE" "$work/repository"
cp "$root/include/pinnquad/version.hpp" "$work/repository/include/pinnquad"
mkdir -p "$work/repository/tools"
cp -r "$root/tools/python" "$work/repository/tools"
cd "$work/repository"
export PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=tools/python
unset PYTHONHOME

fail() {
  echo "FAILED: $*; said: $(cat "$work/said.txt")" >&2
  exit 1
}
tool() {
  { echo "#!$(command -v bash)"; cat; } >"$work/tools/$1"
  chmod +x "$work/tools/$1"
}
# backend <expression>: with the programs of tools/ alone
backend() {
  PATH=$work/tools "$python" -W error:::setuptools.config -c "import backend; $1" >"$work/said.txt" 2>&1
}
everything='apt-get install g++ cmake ninja-build libeigen3-dev nlohmann-json3-dev libtomlplusplus-dev pybind11-dev python3-dev$'

backend 'print(backend.get_requires_for_build_wheel())' || fail "no requirements"
grep -q "'cmake>=3.22', 'ninja'" "$work/said.txt" || fail "does not ask for cmake and ninja"
if backend 'backend.build_wheel("wheels")'; then fail "built without programs"; fi
tail -n 1 "$work/said.txt" | grep -q "pinnquad: no cmake, ninja, c++ in PATH[.] .*$everything" || fail "programs are missing"

tool ninja </dev/null
tool c++ </dev/null
tool cmake <<'TEXT'
printf 'CMake Error at cmake/PinnquadPackages.cmake:14 (message):\n  pinnquad: every pinnquad header need(s) Eigen3 3.4 or newer, which\n  was not found.  On Debian or Ubuntu, as root: apt-get install libeigen3-dev\nCall Stack:\n  a\n\n' >&2
exit 1
TEXT
backend 'print(backend.get_requires_for_build_wheel())' || fail "no requirements"
if grep -q cmake "$work/said.txt"; then fail "asks for programs that are there"; fi
if backend 'backend.build_wheel("wheels")'; then fail "built without Eigen"; fi
tail -n 1 "$work/said.txt" | grep -q "pinnquad: every pinnquad header need(s) Eigen3 3.4 or newer, which was not found[.] All that [^:]*: $everything" ||
  fail "CMake fails"

backend 'import os; os.makedirs("made"); print(open("made/" + backend.prepare_metadata_for_build_wheel("made") + "/METADATA").read())' ||
  fail "no metadata"
grep -q '^License: MIT$' "$work/said.txt" || fail "no license"
if grep -qE '^license *= *\{' pyproject.toml; then fail "a table for the license"; fi

# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# The Python package of this tree in a fresh venv. Sourced, never run; needs stage.sh and packages.sh.

# install_python_package: builds the wheel and installs it without network, for Debian's Python, whatever python3 comes first
# in PATH: the packages are for this one. Sets venv. For any x86-64 alone, with the objects of the preset dev.
# PINNQUAD_INSTRUCTION_SETS adds what is shipped; then all is compiled from nothing, as for a user of pip.
install_python_package() {
  require_packages g++ cmake ninja-build libeigen3-dev nlohmann-json3-dev libtomlplusplus-dev pybind11-dev python3-dev \
    python3-venv python3-pip python3-setuptools python3-wheel python3-numpy
  unset PYTHONHOME PYTHONPATH # nothing of the caller's own gets in
  export PYTHONDONTWRITEBYTECODE=1 PYTHONNOUSERSITE=1 PINNQUAD_INSTRUCTION_SETS=${PINNQUAD_INSTRUCTION_SETS-}
  local build=$PWD/build/python
  venv=$build/venv
  rm -rf "$venv" "$build/wheels"
  /usr/bin/python3 -m venv --system-site-packages "$venv"
  CMAKE_BUILD_PARALLEL_LEVEL=$(parallel_jobs)
  export CMAKE_BUILD_PARALLEL_LEVEL
  if [ -z "$PINNQUAD_INSTRUCTION_SETS" ]; then
    configure dev build/dev -DPINNQUAD_BUILD_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3 >/dev/null
    export PINNQUAD_BUILD_TREE=$PWD/build/dev
  fi
  "$venv/bin/pip" wheel --quiet --no-build-isolation --no-index --no-deps --wheel-dir "$build/wheels" .
  "$venv/bin/pip" install --quiet --no-index "$build"/wheels/pinnquad-*.whl
}

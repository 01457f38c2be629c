#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# pinnquad as one header, through pkg-config, and from its Debian package: the quickstart gives the same answer each time.
#   packaged.sh ROOT PREFIX WORK EIGEN
# PREFIX: where it is installed. Environment: CXX. What Debian's dpkg-deb or pkg-config would say is left out where they are
# not there.
set -euo pipefail
root=$1 prefix=$2 work=$3 eigen=$4
rm -rf -- "$work"
mkdir -p "$work/header" "$work/unpacked"

# answer <name> <flag>...
answer() {
  "${CXX:-g++}" -std=c++17 -O1 "${@:2}" "$root/examples/quickstart.cpp" -o "$work/$1" && "$work/$1"
}
models=$root/examples/models
expected=$(answer tree "-I$root/include" "-I$models" "-I$eigen")
said() { # <way> <answer>
  [ "$2" = "$expected" ] || { echo "$1: expected '$expected', found '$2'"; exit 1; }
  echo "$1: $2"
}

"$root/tools/packaging/one_file.py" "$work/header/pinnquad_flight.hpp"
said "one header" "$(answer one -include "$work/header/pinnquad_flight.hpp" "-I$models" "-I$eigen")"

for system in arduino conan esp_idf platformio vcpkg zephyr; do
  "$root/tools/packaging/stage" "$system" "$work/staged/$system"
  if grep -rF "@VERSION@" "$work/staged/$system"; then echo "$system: no version"; exit 1; fi
done
if command -v arm-none-eabi-g++ >/dev/null; then # as Arduino and PlatformIO call it
  arm-none-eabi-g++ -std=gnu++17 -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -Os -fno-exceptions -fno-rtti -fsyntax-only \
    "-I$work/staged/arduino/src" -include pinnquad_flight.hpp "-I$models" "-I$eigen" "$root/examples/quickstart.cpp"
  echo "arduino, platformio: compiled for a Cortex-M4"
else
  echo "arduino, platformio: not run, arm-none-eabi-g++ is not installed"
fi

if command -v pkg-config >/dev/null; then
  read -r -a flags <<<"$(PKG_CONFIG_PATH=$prefix/share/pkgconfig pkg-config --cflags pinnquad)"
  said "pkg-config" "$(answer pkg_config "${flags[@]}" "-I$models")"
else
  echo "pkg-config: not run, it is not installed"
fi

if command -v dpkg-deb >/dev/null; then
  off=()
  for part in TESTS EXAMPLES TOOLS LOGS BENCH; do off+=("-DPINNQUAD_BUILD_$part=OFF"); done
  cmake -S "$root" -B "$work/build" -G Ninja "${off[@]}" -DCMAKE_CXX_COMPILER="${CXX:-g++}" >/dev/null
  (cd "$work/build" && cpack >/dev/null)
  dpkg-deb -x "$work"/build/pinnquad_*_all.deb "$work/unpacked"
  said ".deb" "$(answer deb "-I$work/unpacked/usr/include" "-I$models" "-I$eigen")"
else
  echo ".deb: not run, dpkg-deb is not installed"
fi

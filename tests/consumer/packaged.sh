#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# pinnquad as one header, through pkg-config, and from its Debian package: the quickstart gives the same answer each time.
# The package of the program has the page to watch a flight, and finds it where it is unpacked.
#   packaged.sh ROOT PREFIX WORK EIGEN PROGRAM
# PREFIX: where it is installed. Environment: CXX. What Debian's dpkg-deb or pkg-config would say is left out where they are
# not there, what the program would where it is not built.
set -euo pipefail
root=$1 prefix=$2 work=$3 eigen=$4 program=$5
rm -rf -- "$work"
mkdir -p "$work/header" "$work/unpacked"

# answer <name> <flag>...
answer() {
  "${CXX:-g++}" -std=c++17 -O0 -DPINNQUAD_INLINE_AS_COMPILER_LIKES "${@:2}" "$root/examples/quickstart.cpp" -o "$work/$1" && "$work/$1"
}
models=$root/examples/models
expected=$(answer tree "-I$root/include" "-I$models" "-I$eigen")
said() { # <way> <answer>
  [ "$2" = "$expected" ] || { echo "$1: expected '$expected', found '$2'"; exit 1; }
  echo "$1: $2"
}

"$root/tools/packaging/one_file.py" "$work/header/pinnquad_flight.hpp"
said "one header" "$(answer one -include "$work/header/pinnquad_flight.hpp" "-I$models" "-I$eigen")"

if command -v arm-none-eabi-g++ >/dev/null; then # as Arduino and PlatformIO call it
  arm-none-eabi-g++ -std=gnu++17 -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -Os -fno-exceptions -fno-rtti -fsyntax-only \
    -include "$work/header/pinnquad_flight.hpp" "-I$models" "-I$eigen" "$root/examples/quickstart.cpp"
  echo "one header: compiled for a Cortex-M4"
else
  echo "one header for a Cortex-M4: not run, arm-none-eabi-g++ is not installed"
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

# A build tree where the program is built, and then its page: a stand-in that says so.
if command -v dpkg-deb >/dev/null && command -v dpkg-shlibdeps >/dev/null && [ -x "$program" ]; then
  tree=$work/with_program
  cmake -S "$root" -B "$tree" -G Ninja "${off[@]}" -DPINNQUAD_BUILD_TOOLS=ON -DPINNQUAD_INSTRUCTION_SETS=x86-64-v3 \
    -DCMAKE_CXX_COMPILER="${CXX:-g++}" >/dev/null
  mkdir -p "$tree/bin" "$tree/libexec" "$tree/share/pinnquad"
  cp -- "$program" "$tree/bin/"
  cp -- "$program" "$tree/libexec/pinnquad-x86-64-v3"
  watch() { # <program>: flies with a page
    rm -f -- "$work/flight.html"
    "$1" fly --samples 20 --out "$work/flight.csv" --watch "$work/flight.html" 2>&1
  }
  if said=$(watch "$tree/bin/pinnquad"); then echo "flown with a page that is not built: $said"; exit 1; fi
  [[ $said == *flight.html:*nodejs* ]] || { echo "without the page: expected a line about nodejs, found '$said'"; exit 1; }
  echo '{"style":"", "body":"the stand-in", "script":""}' >"$tree/share/pinnquad/watch.json"
  (cd "$tree" && cpack >/dev/null)
  dpkg-deb -x "$tree"/pinnquad_*.deb "$work/installed"
  mv -- "$work/installed" "$work/moved"
  if [ "$(uname -m)" = x86_64 ] && [ ! -x "$work/moved/usr/libexec/pinnquad-x86-64-v3" ]; then echo ".deb: no build for AVX2"; exit 1; fi
  for here in "$tree" "$work/moved/usr"; do
    if ! said=$(watch "$here/bin/pinnquad") || ! grep -q "the stand-in" "$work/flight.html"; then echo "$here: no page: $said"; exit 1; fi
  done
  echo "the page of the program: found in the build tree and in the unpacked package"
else
  echo "the page of the program: not run, dpkg-deb, dpkg-shlibdeps or the program is not there"
fi

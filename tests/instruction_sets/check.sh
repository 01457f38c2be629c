#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# check.sh <what> <compiler> <include folder> <Eigen's include folder> <work folder> <flags...>
#   gate   every weak symbol of an object names its instruction set
#   mixed  one program of the gate's baseline, AVX2 and AVX-512 objects, in both link orders, run on a machine without
#          AVX; the gate goes before it in the same work folder
#   leaks  the two above reject leaks.cpp: they can fail
#   names  flags of another vector unit, rounding or fast maths have another name
#   neon   the prediction for aarch64, cross-compiled, under emulation: right numbers, no timing
# Returns 77 where a tool or a compiler flag is missing.
set -u
what=$1 compiler=$2 include=$3 eigen=$4 work=$5
shift 5
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$work"
cd "$work" || exit 1

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "failed: $*"; exit 1; }
declare -A machine=([baseline]=x86-64 [avx2]=x86-64-v3 [avx512]=x86-64-v4)
# What code compiled with these flags lives in (core/instruction_set.hpp).
space_of() {
  printf '#include "pinnquad/core/instruction_set.hpp"\nNAMESPACE PINNQUAD_INSTRUCTION_SET\n' |
    "$compiler" "-I$include" "$@" -x c++ -E -P - | sed -n 's/^NAMESPACE //p'
}

# compile <source> <object> <flags...>
compile() {
  local source=$1 object=$2
  shift 2
  "$compiler" -std=c++17 -DNDEBUG -fno-exceptions -I"$include" -isystem "$eigen" "$@" -c "$here/$source" -o "$object" || fail "$source $*"
}
# for_each_set <source> <flags...>: <source>.<set>.o with PREDICT=predict_<set>
for_each_set() {
  local source=$1 set
  shift
  for set in baseline avx2 avx512; do
    compile "$source" "${source%.cpp}.$set.o" "-march=${machine[$set]}" "-DPREDICT=predict_$set" "$@"
  done
}
# Weak functions and data of an object that do not name the instruction set. Tables and the arrays of an exported model are the
# same numbers in every object. Including Eigen/Core unoptimised brings constructors of its empty placeholders (all, last) along.
foreign_symbols() {
  nm -C --defined-only "$1" | grep -E '^[0-9a-f]+ [WwVvu] ' | grep -v "::$2::" |
    grep -vE ' [Vu] .*(::SmallNumbers>*::[a-z_]+|::model_block_magic|::crc32_half_bytes|::ones<float, [0-9]+>|::extra_column_(names|units)<.*>)$| Eigen::(internal::(all_t|FixedInt<1>)|symbolic::)'
}

if [ "$what" = neon ]; then
  command -v "$compiler" > /dev/null || skip "no $compiler"
  emulator=$(command -v qemu-aarch64 || command -v qemu-aarch64-static) || skip "no qemu-aarch64"
  compile prediction.cpp neon.o -DPREDICT=predict_baseline "$@"
  foreign=$(foreign_symbols neon.o "$(space_of)") && fail "weak symbols without instruction set: $foreign"
  compile main.cpp neon_main.o "$@"
  "$compiler" -static neon.o neon_main.o -o neon || fail link
  "$emulator" ./neon || fail "aarch64"
  exit 0
fi

for level in "${machine[@]}"; do
  echo 'int f();' | "$compiler" -x c++ "-march=$level" -fsyntax-only - 2> /dev/null || skip "$compiler without -march=$level"
done
emulator=$(command -v qemu-x86_64 || command -v qemu-x86_64-static) || emulator=""

case $what in
  names)
    declare -A meaning=()
    for flags in "" -mfma -march=x86-64-v3 -march=x86-64-v4 -ffast-math "-march=x86-64-v3 -ffast-math"; do
      # shellcheck disable=SC2086
      name=$(space_of $flags)
      [ -z "${meaning[$name]-}" ] || fail "one name for two: $name, '$flags' and '${meaning[$name]}'"
      meaning[$name]="$flags "
    done
    for flags in -mavx512f -march=icelake-server; do
      [ "$(space_of $flags)" = "$(space_of -march=x86-64-v4)" ] || fail "two names for one layout and rounding: $flags"
    done
    ;;
  gate)
    rm -f prediction.*.o
    for_each_set prediction.cpp "$@"
    for set in baseline avx2 avx512; do
      foreign=$(foreign_symbols "prediction.$set.o" "$(space_of "-march=${machine[$set]}")") && fail "weak symbols of $set: $foreign"
    done
    ;;
  mixed)
    [ -n "$emulator" ] || skip "no qemu-x86_64"
    compile main.cpp main.o -DWITH_OTHERS "-march=${machine[baseline]}" "$@"
    for order in "baseline avx2 avx512" "avx512 avx2 baseline"; do
      objects=""
      for set in $order; do objects="$objects prediction.$set.o"; done
      # shellcheck disable=SC2086
      "$compiler" $objects main.o -o "mixed" || fail "link $order"
      "$emulator" -cpu Nehalem ./mixed || fail "order $order"
      # the wide calls, where this machine has them: as many numbers to get wrong
      if grep -q avx2 /proc/cpuinfo; then ./mixed avx2 || fail "avx2, order $order"; fi
      if grep -q avx512vl /proc/cpuinfo; then ./mixed avx512 || fail "avx512, order $order"; fi
    done
    ;;
  leaks)
    [ -n "$emulator" ] || skip "no qemu-x86_64"
    for_each_set leaks.cpp "$@"
    own=$(space_of "-march=${machine[avx512]}")
    foreign_symbols leaks.avx512.o "$own" | grep -q "std::array<float, 1ul>::operator\[\]" || fail "the gate saw no array"
    foreign_symbols leaks.avx512.o "$own" | grep -q "std::sqrt(float)" || fail "the gate saw no square root"
    compile leaks_main.cpp leaks_main.o "$@"
    "$compiler" leaks.baseline.o leaks.avx512.o leaks_main.o -o right_order || fail link
    "$emulator" -cpu Nehalem ./right_order || fail "the baseline's own square root does not run"
    "$compiler" leaks.avx512.o leaks.baseline.o leaks_main.o -o wrong_order || fail link
    "$emulator" -cpu Nehalem ./wrong_order
    code=$?
    [ $code -eq 132 ] || fail "a foreign square root ran on a machine without AVX (code $code)"
    ;;
  *) fail "unknown: $what" ;;
esac
exit 0

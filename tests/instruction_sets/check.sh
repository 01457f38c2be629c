#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# check.sh <what> <compiler> <include folder> <Eigen's include folder> <work folder> <flags...>
#   gate   every weak symbol of an object names its instruction set: the linker takes none for that of another object
#   bits   256 and 512 bits of AVX-512, in one program, agree
#   names  flags of another vector unit, rounding or fast maths have another name
# Returns 77 where a compiler flag or AVX-512 is missing.
set -u
what=$1 compiler=$2 include=$3 eigen=$4 work=$5
shift 5
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$work"
cd "$work" || exit 1

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "failed: $*"; exit 1; }
levels="x86-64 x86-64-v3 x86-64-v4"
# What code compiled with these flags lives in (core/instruction_set.hpp).
space_of() {
  printf '#include "pinnquad/core/instruction_set.hpp"\nNAMESPACE PINNQUAD_INSTRUCTION_SET\n' |
    "$compiler" "-I$include" "$@" -x c++ -E -P - | sed -n 's/^NAMESPACE //p'
}
# Weak functions and data of an object that do not name the instruction set. Tables and the arrays of an exported model are the
# same numbers in every object. Including Eigen/Core unoptimised brings constructors of its empty placeholders (all, last) along.
foreign_symbols() {
  nm -C --defined-only "$1" | grep -E '^[0-9a-f]+ [WwVvu] ' | grep -v "::$2::" |
    grep -vE ' [Vu] .*(::SmallNumbers>*::[a-z_]+|::model_block_magic|::crc32_half_bytes|::ones<float, [0-9]+>|::extra_column_(names|units)<.*>)$| Eigen::(internal::(all_t|FixedInt<1>)|symbolic::)'
}

for level in $levels; do
  echo 'int f();' | "$compiler" -x c++ "-march=$level" -fsyntax-only - 2> /dev/null || skip "$compiler without -march=$level"
done
case $what in
  names)
    declare -A meaning=()
    for flags in "" -mfma -march=x86-64-v3 -march=x86-64-v4 "-march=x86-64-v4 -DPINNQUAD_KERNEL_BITS=256" -ffast-math "-march=x86-64-v3 -ffast-math"; do
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
    for level in $levels; do
      "$compiler" -std=c++17 -DNDEBUG -fno-exceptions -I"$include" -isystem "$eigen" "$@" "-march=$level" \
        -c "$here/prediction.cpp" -o prediction.o || fail "prediction.cpp $level"
      space=$(space_of "-march=$level")
      nm -C --defined-only prediction.o | grep -qE "^[0-9a-f]+ [Ww] .*::$space::" || fail "no weak symbol of $level: nothing was looked at"
      foreign=$(foreign_symbols prediction.o "$space") && fail "weak symbols of $level: $foreign"
    done
    ;;
  bits)
    grep -qw avx512vl /proc/cpuinfo || skip "a processor without AVX-512"
    for part in PINNQUAD_KERNEL_BITS=256 PINNQUAD_KERNEL_BITS=512 MAIN; do
      "$compiler" -std=c++17 -DNDEBUG -I"$include" -isystem "$eigen" "$@" -march=x86-64-v4 "-D$part" \
        -c "$here/kernel_bits.cpp" -o "$part.o" || fail "kernel_bits.cpp $part"
    done
    if ! "$compiler" PINNQUAD_KERNEL_BITS=*.o MAIN.o -o kernel_bits || ! ./kernel_bits; then fail "256 and 512 bits"; fi
    ;;
  *) fail "unknown: $what" ;;
esac
exit 0

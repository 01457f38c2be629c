# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# How a script speaks: errors in one line, stages with their time. Sourced, never run.

# die <exit code> <message>: one line on stderr, whatever a user's text in it holds, then the end.
die() {
  local code=$1 message
  shift
  message=$*
  echo "${0##*/}: ${message//[[:cntrl:]]/?}" >&2
  exit "$code"
}

# skip <what was not done> <why>: ends a heavy part that cannot run here; where CI is set that is a failure.
skip() {
  if [ -n "${CI:-}" ]; then die 1 "$2"; fi
  echo "SKIPPED: $1: $2"
  exit 0
}

# absolute <path>: as the caller meant it, in whatever folder the script goes on
absolute() {
  case $1 in
    /*) echo "$1" ;;
    *) echo "$PWD/$1" ;;
  esac
}

# need_value <option> <number of arguments left, the option included>
need_value() {
  if [ "$2" -lt 2 ]; then die 2 "option $1 needs a value (see --help)"; fi
}

# need_natural <option> <value> <least> [<most>]: written as a program takes it, without leading zeros
need_natural() {
  local most=${4:-999999999}
  case $2 in
    '' | *[!0-9]* | 0?*) die 2 "option $1 needs a whole number from $3 to $most, not '$2'" ;;
  esac
  if [ "${#2}" -gt 9 ] || [ "$2" -lt "$3" ] || [ "$2" -gt "$most" ]; then
    die 2 "option $1 needs a whole number from $3 to $most, not '$2'"
  fi
}

# configure <preset> [<folder> <setting>...]: in the root of the repository, in build/<preset> or the folder. From nothing
# sources are compiled several at once; who has begun to edit keeps what was chosen.
configure() {
  local preset=$1 folder=${2:-build/$1} at_once=()
  shift $(($# > 1 ? 2 : 1))
  if [ ! -f "$folder/CMakeCache.txt" ]; then at_once=(-DPINNQUAD_BUILD_AT_ONCE=ON); fi
  cmake --preset "$preset" -B "$folder" ${at_once[@]+"${at_once[@]}"} "$@"
}

# build_program: in build/demo, optimised for this machine, the program alone.
build_program() {
  configure release build/demo -DCMAKE_CXX_FLAGS=-march=native -DPINNQUAD_INSTRUCTION_SETS=
  cmake --build build/demo -j "$(parallel_jobs)" --target pinnquad_program
}

# parallel_jobs: how many compilers at a time. PINNQUAD_JOBS overrides; a heavy translation unit takes up to two gigabytes,
# most take less than one: a gigabyte and a half for each.
parallel_jobs() {
  if [ -n "${PINNQUAD_JOBS:-}" ]; then
    echo "$PINNQUAD_JOBS"
    return
  fi
  local cores in_memory
  cores=$(nproc 2>/dev/null || echo 2)
  in_memory=$(awk '/^MemAvailable:/ { print int($2 / 1572864) }' /proc/meminfo 2>/dev/null || true)
  [ -n "$in_memory" ] || in_memory=$cores
  if [ "$in_memory" -lt 1 ]; then in_memory=1; fi
  if [ "$in_memory" -lt "$cores" ]; then echo "$in_memory"; else echo "$cores"; fi
}

# cpu_seconds: what this script and all that it has waited for have computed so far, user and system; 0 where the
# kernel does not say.
cpu_seconds() {
  local stat ticks
  read -r stat 2>/dev/null </proc/$$/stat || { echo 0; return; }
  ticks=$(getconf CLK_TCK 2>/dev/null || echo 100)
  # after the name, which may hold anything, utime stime cutime cstime are words 12 to 15
  read -ra stat <<<"${stat##*) }"
  echo $(((stat[11] + stat[12] + stat[13] + stat[14]) / ticks))
}

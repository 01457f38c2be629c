#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Does what a document shows: compiles and runs its C++, configures its CMake, runs its shell; what cannot be run says why
# in a hidden comment (extract.awk), and its programs, options, targets and presets must at least exist.
#   check.sh ROOT BUILD PREFIX WORK DOCUMENT
# ROOT: the source tree; BUILD: its build tree with the programs; PREFIX: where it is installed; WORK: a folder to use up;
# DOCUMENT: relative to ROOT, or absolute. Environment: CXX, EIGEN, WERROR (-Werror or nothing). Exit code 1 with document:line: message for each fault.
set -euo pipefail
root=$1 build=$2 prefix=$3 work=$4 document=$5
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
cxx=${CXX:-g++}
eigen=${EIGEN:-/usr/include/eigen3}

case $document in
  /*) path=$document document=${document##*/} ;;
  *) path=$root/$document ;;
esac
rm -rf -- "$work"
mkdir -p "$work/parts"
parts=$work/parts
touch "$parts/blocks" "$parts/spans"

faults=0
fault() { # <line> <message>
  echo "$document:$1: $2"
  faults=$((faults + 1))
}

awk -v out="$parts" -v name="$document" -f "$here/extract.awk" "$path" || faults=1

# A folder that looks like the source tree to its reader, and can be written to. What a reader may have made in the tree
# (demo_out, study) is not linked: a block would write into it.
tree=$work/tree
mkdir -p "$tree/build"
for entry in bench cmake docs examples findings include scripts tests tools CMakeLists.txt CMakePresets.json CHANGELOG.md CONTRIBUTING.md LICENSE README.md; do
  ln -s "$root/$entry" "$tree/"
done
printf '#include "pinnquad/flight.hpp"\nint main() {}\n' >"$tree/main.cpp" # the reader's own program
mkdir "$work/home"
export HOME=$work/home # what is installed there is the block's
for preset in dev demo release; do ln -s "$build" "$tree/build/$preset"; done
export PATH="$build/bin:$build/examples:$PATH"

# What a program says of its options; nothing for what is not ours.
help_of() {
  local cached=$work/help.${1// /.}
  if [ ! -f "$cached" ]; then
    case $1 in
      # shellcheck disable=SC2086 # program and commands
      pinnquad*) $1 --help ;;
      demo | test) "$root/scripts/$1" --help ;;
      run) "$root/bench/run" --help ;;
    esac >"$cached" 2>&1 || true
  fi
  cat "$cached"
}

# check_command <line> <commands>: without running them, whether what they name exists.
check_command() {
  local part
  while IFS= read -r part; do check_simple_command "$1" "$part"; done < <(sed 's/ *\(&&\|||\|[|;]\) */\n/g' <<<"$2")
}
check_simple_command() {
  local line=$1 words word program next
  read -r -a words <<<"$2"
  while [[ ${words[0]:-} =~ ^[A-Za-z_]+=.*$ || ${words[0]:-} =~ ^(sudo|srun|nice|time)$ ]]; do words=("${words[@]:1}"); done
  [ ${#words[@]} -gt 0 ] || return 0
  program=${words[0]}
  # scripts/test without --all does not build it
  if [ "${program##*/}" = pinnquad-study ] && [ ! -x "$build/bin/pinnquad-study" ]; then
    echo "$line: not checked: pinnquad-study is not built here"
    return 0
  fi
  case $program in
    ./scripts/* | scripts/* | bench/* | tests/*)
      compgen -G "$root/${program#./}" >/dev/null || fault "$line" "no such file: $program"
      ;;
    build/*/bin/* | build/*/examples/*) [ -x "$tree/$program" ] || fault "$line" "no such program: $program" ;;
  esac
  case $program in
    pinnquad | */pinnquad | pinnquad-study | */pinnquad-study) # the command, and that of a command
      program=${program##*/}
      for word in "${words[@]:1:2}"; do
        help_of "$program" | grep -q '^Commands:' && [[ $word != -* ]] || break
        help_of "$program" | sed '1,/^Commands:/d' | grep -qE "^  $word( |$)" || { fault "$line" "$program has no command $word"; return 0; }
        program+=" $word"
      done
      ;;
  esac
  for ((i = 1; i < ${#words[@]}; ++i)); do
    word=${words[i]} next=${words[i + 1]:-}
    case $program:$word in
      pinnquad*:--* | *scripts/demo:--* | *scripts/test:--* | *bench/run:--*)
        word=${word%%=*}
        help_of "${program##*/}" | grep -qE -- "(^|[ ,|\[])$word([ ,=|]|\]|$)" ||
          fault "$line" "${program##*/} has no option $word"
        ;;
      cmake:--preset | ctest:--preset)
        grep -q "\"name\": \"$next\"" "$root/CMakePresets.json" || fault "$line" "no such preset: $next"
        ;;
      cmake:--target)
        [ -f "$work/targets" ] || cmake --build "$build" --target help >"$work/targets"
        grep -qE "(^|[ /])$next(:|$)" "$work/targets" || fault "$line" "no such target: $next"
        ;;
      ctest:-L)
        next=${2#*-L } next=${next%% -*} next=${next//\"/}
        grep -rqE --include=CMakeLists.txt --include='*.cmake' "LABELS [^)]*$next" "$root/tests" ||
          fault "$line" "no test has a label $next"
        ;;
    esac
  done
}

check_commands() { # <line of the fence>
  local number=$1 text=
  while IFS= read -r command || [ -n "$command" ]; do
    number=$((number + 1))
    command=${command%%#*}
    if [[ $command == *\\ ]]; then text+=${command%\\}; continue; fi
    check_command "$number" "$text$command"
    text=
  done <"$parts/$1.code"
}

run_shell() { # <line>
  local given=
  [ ! -f "$parts/$1.given" ] || given=$(<"$parts/$1.given")
  if ! (cd "$tree" && bash -euo pipefail -c "$given"$'\n'"$(<"$parts/$1.code")") >"$work/$1.log" 2>&1 </dev/null; then
    fault "$1" "the commands fail:"
    tail -n 20 "$work/$1.log"
  fi
}

# block <line>: the block with what is given around it.
block() {
  local given=()
  [ ! -f "$parts/$1.given" ] || given=(-v "given=$parts/$1.given" -v "given_first=$(<"$parts/$1.given_line")")
  awk -v "document=$document" -v first=$(($1 + 1)) "${given[@]}" -f "$here/program.awk" "$parts/$1.code"
}

# compile <line>: alone, so that it needs no more than the includes that it shows, or that are given; and run.
compile() {
  local program=$work/program_$1 what=(-o "$work/program_$1")
  block "$1" >"$program.cpp"
  grep -q '^int main(' "$program.cpp" || what=(-fsyntax-only)
  # inlined by force nothing runs faster at -O0, and takes up to twice the time to compile
  if ! "$cxx" -std=c++17 -O0 -DPINNQUAD_INLINE_AS_COMPILER_LIKES -Wall -Wextra ${WERROR:+"$WERROR"} -I"$root/include" -I"$root/examples" \
    -I"$root/examples/models" \
    -isystem "$eigen" "$program.cpp" "${what[@]}"; then
    fault "$1" "does not compile"
  elif [ -x "$program" ] && ! (cd "$work" && timeout 300 "$program") >"$program.log" 2>&1 </dev/null; then
    fault "$1" "the program fails:"
    tail -n 20 "$program.log"
  fi
}

configure() { # <line>
  local folder=$work/cmake_$1
  mkdir -p "$folder"
  ln -s "$root" "$folder/pinnquad"
  cp "$tree/main.cpp" "$folder/main.cpp"
  {
    if ! grep -qh "^project(" "$parts/$1".*; then
      printf 'cmake_minimum_required(VERSION 3.22)\nproject(snippet CXX)\n'
    fi
    block "$1" | grep -v '^#line'
  } >"$folder/CMakeLists.txt"
  if ! cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$prefix" \
    -DFETCHCONTENT_SOURCE_DIR_PINNQUAD="$root" >"$work/$1.log" 2>&1; then
    fault "$1" "CMake does not take it:"
    tail -n 20 "$work/$1.log"
  fi
}

while IFS=$'\t' read -r line language action argument; do
  if [ "$action" = from ]; then
    if [ ! -f "$root/$argument" ]; then
      fault "$line" "no such file: $argument"
    elif ! diff <(sed '1,/^[^/]/{/^\/\//d}' "$root/$argument") "$parts/$line.code" >"$work/difference"; then
      fault "$line" "differs from $argument:"
      cat "$work/difference"
    fi
  elif [ "$action" = output ]; then
    if ! (cd "$tree" && bash -euo pipefail -c "$argument") >"$work/output" 2>"$work/$line.log" </dev/null; then
      fault "$line" "the command fails: $argument"
      tail -n 20 "$work/$line.log"
    elif ! [ -s "$work/output" ] || grep -vxF -f <(sed 's/^ *//; s/ *$//' "$parts/$line.code") \
      <(sed 's/^ *//; s/ *$//' "$work/output") >"$work/difference"; then
      fault "$line" "$argument writes something else:"
      cat "$work/difference"
    fi
  elif [[ $language:$action == @(sh|console):skip ]]; then
    check_commands "$line"
  elif [ "$action" = run ]; then
    case $language in
      cpp) compile "$line" ;;
      sh) run_shell "$line" ;;
      cmake) configure "$line" ;;
      python) fault "$line" "Python is run by stages of its own: name it, <!-- not run: ... -->" ;;
    esac
  fi
done <"$parts/blocks"

while IFS=$'\t' read -r line span; do
  check_command "$line" "$span"
done <"$parts/spans"

if [ "$faults" -ne 0 ]; then exit 1; fi
echo "$document: $(wc -l <"$parts/blocks") blocks, of which $(awk -F '\t' '$3 == "skip"' "$parts/blocks" | wc -l) are not run"

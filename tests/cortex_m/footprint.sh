#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# footprint.sh <repository> <working folder> <Eigen> [--check | --write]: the table of docs/footprint.md, measured.
#   (nothing)   prints it
#   --check     compares it with the one in the document, where the compiler is the one named there
#   --write     puts it into the document
set -euo pipefail
root=$1 work=$2/footprint eigen=$3 action=${4:-}
# shellcheck source=machine.sh
source "$root/tests/cortex_m/machine.sh"
need_tools
mkdir -p "$work"
document=$root/docs/footprint.md
compiler="arm-none-eabi-g++ $(arm-none-eabi-g++ -dumpfullversion)"

# Assumed for the estimates: clock in MHz and cycles per instruction
m4_clock=168 m4_cycles=2.7
m7_clock=216 m7_cycles=1.55

thousands() { sed ':again; s/\([0-9]\)\([0-9]\{3\}\)\($\|,\)/\1,\2\3/; t again' <<<"$1"; }
estimate() { awk -v n="$1" -v mhz="$2" -v cycles="$3" 'BEGIN { printf "%.0f", n * cycles / mhz }'; }

table() {
  local layers width behind target optimisation object image name part count stack most
  echo "Measured with $compiler. Each cell of three: -Os / -O2 / -O3."
  echo
  echo "| network | weights, B | workspace, B | code, B | stack, B | static RAM, B" \
    "| M4F, instructions | M7, instructions | M4F, µs* | M7, µs* |"
  echo "|---|---|---|---|---|---|---|---|---|---|"
  for name in 2x16 3x25 3x25-LayerNorm 3x25-RmsNorm 10x25 2x64; do
    IFS=x- read -r layers width behind <<<"$name"
    local -A counts=() slowest=()
    stack=0 most=0
    for target in m4f m7_dp; do
      slowest[$target]=0
      for part in start_up measure_forward; do
        [ -f "$work/$target.$part.o" ] || compile "$target" -O1 "$here/$part.cpp" "$work/$target.$part.o"
      done
      for optimisation in -Os -O2 -O3; do
        object=$work/$target$optimisation.$name.o image=$work/$target$optimisation.$name.elf
        compile "$target" "$optimisation" "$here/sized_network.cpp" "$object" \
          "-DHIDDEN_LAYERS=$layers" "-DHIDDEN_WIDTH=$width" "-DBEHIND=${behind:+$behind<$width>,}Relu"
        link_image "$target" "$image" "$work/$target.start_up.o" "$work/$target.measure_forward.o" "$object"
        run_image "$target" "$image" "$image.txt"
        if [ "$(largest instructions "$image.txt")" != "$(smallest instructions "$image.txt")" ]; then
          echo "$name on $target $optimisation: instructions depend on the data" >&2
          return 1
        fi
        count=$(largest instructions "$image.txt")
        counts[$target]+="${counts[$target]:+ / }$(thousands "$count")"
        [ "$count" -le "${slowest[$target]}" ] || slowest[$target]=$count
        [ "$(largest stack "$image.txt")" -le "$stack" ] || stack=$(largest stack "$image.txt")
        [ "$(code_bytes "$image")" -le "$most" ] || most=$(code_bytes "$image")
      done
    done
    echo "| 16-$layers x $width-4${behind:+, $behind} | $(thousands "$(weight_bytes "$image")") |" \
      "$(awk '$1 == "workspace" { print $3 }' "$image.txt") |" \
      "$(thousands "$most") | $stack | $(ram_bytes "$image") | ${counts[m4f]} | ${counts[m7_dp]} |" \
      "$(estimate "${slowest[m4f]}" $m4_clock $m4_cycles) | $(estimate "${slowest[m7_dp]}" $m7_clock $m7_cycles) |"
  done
  echo
  echo "\\* Estimates until a board is measured: M4F at $m4_clock MHz and $m4_cycles cycles per instruction,"
  echo "M7 at $m7_clock MHz and $m7_cycles, memory without wait states."
}

begin='<!-- table: tests/cortex_m/footprint.sh --write -->' end='<!-- end of table -->'
committed() { sed -n "\\|^$begin\$|,\\|^$end\$|p" "$document" | sed '1d;$d'; }

case $action in
  '') table ;;
  --check)
    if ! committed | grep -qF "Measured with $compiler."; then
      echo "SKIPPED: $(committed | head -1) This machine has $compiler."
      exit 77
    fi
    table >"$work/table.md"
    if ! diff <(committed) "$work/table.md"; then
      echo "docs/footprint.md (<) is not what is measured (>): tests/cortex_m/footprint.sh --write"
      exit 1
    fi
    ;;
  --write)
    table >"$work/table.md"
    awk -v begin="$begin" -v end="$end" -v table="$work/table.md" '
      $0 == end { inside = 0 }
      !inside { print }
      $0 == begin { inside = 1; while ((getline line < table) > 0) print line }' "$document" >"$work/document.md"
    cp "$work/document.md" "$document"
    ;;
  *) echo "no option '$action'" >&2; exit 2 ;;
esac

# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# Builds and runs for a Cortex-M under QEMU, and judges what came out. Sourced; needs $root (the repository) and $work.

packages="gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib qemu-system-arm"
here=$root/tests/cortex_m

# Skips the test (exit code 77), and says so, where a tool is missing.
need_tools() {
  local missing=
  command -v arm-none-eabi-g++ >/dev/null || missing="arm-none-eabi-g++"
  command -v qemu-system-arm >/dev/null || missing="$missing qemu-system-arm"
  if [ -z "$missing" ]; then
    echo '#include <array>' | arm-none-eabi-g++ -x c++ -std=c++17 -E - >/dev/null 2>&1 || missing="libstdc++ for ARM"
    [ -f "$(arm-none-eabi-g++ -print-file-name=nano.specs)" ] || missing="$missing newlib"
  fi
  if [ -n "$missing" ]; then
    echo "SKIPPED: no $missing; on Debian: apt-get install $packages"
    exit 77
  fi
}

# The same where the host's results are not there.
need_prepared() {
  need_tools
  [ -f "$work/prepared" ] || { echo "SKIPPED: the host's results are not there (cortex_m.prepare)"; exit 77; }
}

# The host's multiply-add in hardware, as the target has one.
host_fma() { if [ "$(uname -m)" = x86_64 ]; then echo -mfma; fi; }

# Targets: the processor, its FPU (sp: single precision alone), and QEMU's board that has it.
target_flags() {
  case $1 in
    m4f) echo "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16" ;;
    m7_dp) echo "-mcpu=cortex-m7 -mfpu=fpv5-d16" ;;
    *) echo "no target '$1'" >&2; return 1 ;;
  esac
}
target_board() { if [ "$1" = m4f ]; then echo mps2-an386; else echo mps2-an500; fi }

# As firmware is compiled. Without NDEBUG Eigen's assertions pull in printf and malloc; without -ffp-contract=off the
# compiler chooses which products of the features are rounded, and the host's bits are not the target's.
flight_flags="-std=c++17 -DNDEBUG -ffp-contract=off -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -ffunction-sections -fdata-sections -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow -Werror"

# compile <target> <optimisation> <source> <object> [flag]...
compile() {
  local target=$1 optimisation=$2 source=$3 object=$4 machine
  shift 4
  machine=$(target_flags "$target")
  # shellcheck disable=SC2086
  arm-none-eabi-g++ $machine -mthumb -mfloat-abi=hard $flight_flags "$optimisation" "-I$root/include" \
    -isystem "$eigen" "-I$here" "-I$work" "$@" -c "$source" -o "$object"
}

# link_image <target> <image> <object>...
link_image() {
  local machine image=$2
  machine=$(target_flags "$1")
  shift 2
  # no start-up files: nothing of a C library is started
  # shellcheck disable=SC2086
  arm-none-eabi-g++ $machine -mthumb -mfloat-abi=hard "$@" -T "$here/board.ld" -nostartfiles --specs=nano.specs \
    --specs=nosys.specs -Wl,--gc-sections -o "$image" 2>"$image.link" || { cat "$image.link" >&2; return 1; }
}

# run_image <target> <image> <output>: every instruction takes 1 ns of the machine's clock (-icount shift=0).
run_image() {
  timeout 120 qemu-system-arm -M "$(target_board "$1")" -display none -monitor none -serial none \
    -semihosting-config enable=on,target=native -icount shift=0,sleep=off -kernel "$2" >"$3" 2>&1 || {
    echo "QEMU ended with code $? on $2:"
    tail -5 "$3"
    return 1
  }
}

# What under_test.cpp is compiled with: a model that write_model.cpp wrote, or a shipped one.
model_flags=(-DMODEL=PaperModel "-DMODEL_HEADER=\"paper_model.hpp\"")
structured_flags=(-DMODEL=StructuredModel "-DMODEL_HEADER=\"structured_model.hpp\"")
shipped_flags=(-DTRAINED_ON_A_FLIGHT -DMODEL=StructuredQuadModel "-DMODEL_HEADER=\"$root/examples/models/structured_quadrotor.hpp\"")

# build_target <target> <optimisation> <what: forward or predict> <image> [name flag...]: of the paper's network, or of
# the model of that name and these flags.
build_target() {
  local target=$1 optimisation=$2 what=$3 image=$4 common=$work/$1
  local part object name= flags=("${model_flags[@]}")
  shift 4
  if [ $# -gt 0 ]; then
    name=.$1
    shift
    flags=("$@")
  fi
  for part in start_up measure_"$what"; do
    [ "$common.$part.o" -nt "$here/$part.cpp" ] || compile "$target" -O1 "$here/$part.cpp" "$common.$part.o"
  done
  object=$work/$target$optimisation$name.o
  [ -f "$object" ] || compile "$target" "$optimisation" "$here/under_test.cpp" "$object" "${flags[@]}"
  link_image "$target" "$image" "$common.start_up.o" "$common.measure_$what.o" "$object"
}

# What an image tells of itself.
code_bytes() { # of the library and what is under test; what the measurement adds has other names
  arm-none-eabi-nm -S -C "$1" | awk '$3 ~ /^[tTwW]$/ && /pinnquad/ && !/workspace/ { print $2 }' | sum_hexadecimal
}
ram_bytes() { arm-none-eabi-size -A "$1" | awk '$1 == ".data" || $1 == ".bss" { sum += $2 } END { print sum + 0 }'; }
weight_bytes() { # in flash
  arm-none-eabi-nm -S -C "$1" | awk '/::parameters$/ && $1 < "20000000" { print $2 }' | sum_hexadecimal
}
sum_hexadecimal() {
  local sum=0 value
  while read -r value; do sum=$((sum + 16#$value)); done
  echo "$sum"
}
# largest <kind> <output>: the largest number of lines "<kind> <name> <number>"
largest() { awk -v kind="$1" '$1 == kind && $3 > most { most = $3 } END { print most + 0 }' "$2"; }
smallest() { awk -v kind="$1" '$1 == kind && (least == "" || $3 < least) { least = $3 } END { print least + 0 }' "$2"; }

# reject <offence> <detail>
rejected=0
reject() {
  echo "rejected: $1: $2"
  rejected=$((rejected + 1))
}
at_most() { if [ "$2" -gt "$3" ]; then reject "$1" "$2, at most $3"; fi; }

doubles="__aeabi_d[a-z0-9]*|__aeabi_cd[a-z]*|__aeabi_[a-z]*2d|__[a-z]*df[a-z0-9]*"
forbidden="malloc|calloc|realloc|free|_malloc_r|_free_r|_sbrk|_sbrk_r|abort|raise|[a-z]*printf|_[a-z]*printf_r"
forbidden="$forbidden|__cxa_[a-z_]*|_Unwind_[A-Za-z_]*"
forbidden="$forbidden|__gxx_personality_v0|__assert[a-z_]*|_Zn[wa][a-z].*|_Zd[la]P.*|_ZTV.*|_ZTI.*|_ZGV.*"
forbidden="$forbidden|fmaf?|fmaxf?|__emutls.*|$doubles"

# judge_symbols <image>: nothing of the heap, of doubles in software, of exceptions, of assertions, of a software fma
judge_symbols() {
  local symbol
  while read -r symbol; do
    reject "symbol" "$symbol"
  done < <(arm-none-eabi-nm "$1" | awk 'NF >= 2 { print $NF }' | grep -xE "$forbidden" || true)
  if [ -n "$(arm-none-eabi-size -A "$1" | awk '$1 == ".init_array" && $2 > 0')" ]; then
    reject "initialised at run time" "$(arm-none-eabi-size -A "$1" | grep '^\.init_array')"
  fi
}

# judge_forward <image> <output> <the host's output>: the limits of one forward pass of the paper's network
judge_forward() {
  local image=$1 output=$2 expected=$3
  judge_symbols "$image"
  if [ "$(awk '$1 == "counter" { print $2 }' "$output")" != 1001 ]; then reject "counter" "counts wrongly"; fi
  if ! cmp -s <(grep '^bits' "$output") <(grep '^bits' "$expected"); then
    reject "bits" "$(diff <(grep '^bits' "$output") <(grep '^bits' "$expected") | sed -n 2p) is not what the host has"
  fi
  if [ "$(largest instructions "$output")" != "$(smallest instructions "$output")" ]; then
    reject "instructions depend on the data" "$(smallest instructions "$output") to $(largest instructions "$output")"
  fi
  if [ "$(smallest instructions "$output")" -lt 9190 ]; then reject "instructions" "fewer than loads of two weights and products"; fi
  at_most "instructions" "$(largest instructions "$output")" 13500
  at_most "stack" "$(largest stack "$output")" 330
  at_most "code" "$(code_bytes "$image")" 1850
  at_most "static RAM" "$(ram_bytes "$image")" 0
  if [ "$(weight_bytes "$image")" != 25516 ]; then reject "flash" "not the weights: $(weight_bytes "$image") B"; fi
}

# ulps <kind> <output> <other output>: the largest distance of two floats in the lines of a kind, from column to column
ulps() {
  local kind=$1 from=$4 to=$5 most=0 a b i distance
  while read -r -a line; do
    local half=$((${#line[@]} / 2))
    for ((i = from; i <= to; ++i)); do
      a=$((16#${line[i]})) b=$((16#${line[half + i]}))
      if [ $((a >> 31)) -eq 1 ]; then a=$((-(a & 0x7fffffff))); fi
      if [ $((b >> 31)) -eq 1 ]; then b=$((-(b & 0x7fffffff))); fi
      distance=$((a > b ? a - b : b - a))
      if [ "$distance" -gt "$most" ]; then most=$distance; fi
    done
  done < <(paste -d' ' <(grep "^$kind " "$2" | cut -d' ' -f2-) <(grep "^$kind " "$3" | cut -d' ' -f2-))
  echo "$most"
}

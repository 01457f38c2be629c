#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: newlib 3.3.0 and libstdc++ 12.2 for Cortex-M (Debian 12's libnewlib-arm-none-eabi 3.3.0-1.3+deb12u1), in qemu 7.2.
# One would guess: strtof() gives the float nearest to the text, as glibc's does and as std::from_chars of the same toolchain.
# What happens: it is strtod() rounded to float: two roundings. Text just beyond the middle between two floats, by less than
#   half a unit of a double, goes to the even one.
# Seen: 1.0000000596046447753906250001: strtof 3f800000, from_chars 3f800001 (right).
# Why it matters: who reads gains, weights or golden vectors from text on board, and on the ground, compares bits: the two
#   differ where the text has more digits than a float needs. Nine digits (%.9g) are safe.
# pinnquad: headers hold literals that the compiler rounds, blocks hold bytes; nothing that flies reads numbers from text.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in gcc-arm-none-eabi=15:12.2.rel1-1 libnewlib-arm-none-eabi=3.3.0-1.3+deb12u1 libstdc++-arm-none-eabi-newlib=15:12.2.rel1-1+23; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install ${want}"; exit 2; }
done
command -v qemu-system-arm >/dev/null || { echo "not run: install qemu-system-arm"; exit 2; }
cd "$dir"
cat >observe.cpp <<'CPP'
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#ifdef __arm__
extern "C" void _start();
__attribute__((section(".vectors"), used)) const void* const vectors[2] = {(void*)0x20400000, (void*)_start};
#endif
static unsigned long bits(float value) {
  std::uint32_t word;
  std::memcpy(&word, &value, sizeof word);
  return word;
}
int main() {
  const char* text = "1.0000000596046447753906250001";
  float value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  std::printf("strtof %lx from_chars %lx\n", bits(std::strtof(text, nullptr)), bits(value));
}
CPP
arm-none-eabi-g++ -w -std=c++17 -O1 -mthumb -mcpu=cortex-m3 --specs=rdimon.specs -Wl,--section-start=.vectors=0 observe.cpp -o observe.elf
board=$(timeout 60 qemu-system-arm -M mps2-an385 -display none -monitor none -serial none -semihosting -kernel observe.elf 2>&1)
g++ -w -std=c++17 -O1 observe.cpp -o observe
ground=$(./observe)
printf 'Cortex-M: %s\nhere:     %s\n' "$board" "$ground"
if [ "$board" != "strtof 3f800000 from_chars 3f800001" ] || [ "$ground" != "strtof 3f800001 from_chars 3f800001" ]; then
  echo "changed: strtof() of newlib rounds otherwise"
  exit 1
fi

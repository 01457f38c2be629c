#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: newlib 3.3.0 with arm-none-eabi-g++ 12.2 (Debian 12's libnewlib-arm-none-eabi 3.3.0-1.3+deb12u1), in qemu 7.2.
# One would guess: the full C library (no nano.specs) has C99's formats: %zu, %td, %a. Where one is missing the compiler,
#   which checks formats, warns.
# What happens: Debian builds newlib without them. %zu prints 'zu' and takes no argument: each later number of the line is the
#   one before it. -Wall -Wextra -Wformat=2 says nothing. In sscanf %hhu fails, and %f reads 0x1.8p3 as 0, where strtod reads 12.
# Seen: printf("rows %zu voltage %d current %d", 512, 16, 3) -> rows zu voltage 512 current 16.
# Why it matters: a telemetry line or a log on an SD card has plausible numbers in the wrong fields.
# pinnquad: %zu stands in examples for the ground alone.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
for want in gcc-arm-none-eabi=15:12.2.rel1-1 libnewlib-arm-none-eabi=3.3.0-1.3+deb12u1; do
  [ "$(dpkg-query -W -f '${Version}' "${want%%=*}" 2>/dev/null)" = "${want#*=}" ] || { echo "not run: install ${want}"; exit 2; }
done
command -v qemu-system-arm >/dev/null || { echo "not run: install qemu-system-arm"; exit 2; }
cd "$dir"
cat >start.c <<'C'
extern void _start(void);
__attribute__((section(".vectors"), used)) const void* const vectors[2] = {(void*)0x20400000, (void*)_start};
C
cat >observe.c <<'C'
#include <stdio.h>
#include <stdlib.h>
int main(void) {
  size_t rows = 512;
  unsigned char flags = 0;
  float gain = -1;
  printf("rows %zu voltage %d current %d\n", rows, 16, 3);
  int read = sscanf("9", "%hhu", &flags);
  printf("hhu read %d, value %d\n", read, flags);
  read = sscanf("0x1.8p3", "%f", &gain);
  printf("hexadecimal read %d, value %g, strtod %g\n", read, (double)gain, strtod("0x1.8p3", NULL));
  return 0;
}
C
arm-none-eabi-gcc -O1 -Wall -Wextra -Wformat=2 -mthumb -mcpu=cortex-m3 -c observe.c 2>warnings
arm-none-eabi-gcc -w -mthumb -mcpu=cortex-m3 --specs=rdimon.specs -Wl,--section-start=.vectors=0 observe.o start.c -o observe.elf
seen=$(timeout 60 qemu-system-arm -M mps2-an385 -display none -monitor none -serial none -semihosting -kernel observe.elf 2>&1)
printf '%s\n%s\n' "$seen" "warnings of the compiler: $(wc -l <warnings)"
expected='rows zu voltage 512 current 16
hhu read 0, value 0
hexadecimal read 1, value 0, strtod 12'
if [ "$seen" != "$expected" ] || [ -s warnings ]; then
  echo "changed: newlib's formats, or what the compiler says of them"
  exit 1
fi

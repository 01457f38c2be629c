#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: newlib 3.3.0 with arm-none-eabi-g++ 12.2 (Debian 12's libnewlib-arm-none-eabi 3.3.0-1.3+deb12u1), in qemu 7.2.
# One would guess: fma(x, y, z) rounds once, as ISO C demands; without an instruction for it it is slow, but exact.
# What happens: where the processor has no double precision unit (Cortex-M3, M4) newlib's fma() is x * y + z, rounded twice.
#   On a Cortex-M7 with a double unit it is exact, and so is fmaf() of these numbers on all three.
# Seen: (1 + 2^-30)^2 - (1 + 2^-29): M3 and M4 0, M7 8.67e-19 (2^-60, right).
# Why it matters: compensated sums and products of long flights take the rounding error from fma(): on the flight controller
#   the compensation is 0, and the same source gives other bits on board and on the ground.
# pinnquad: no header calls fma.
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
static void reset(void) {
  *(volatile unsigned*)0xE000ED88 |= 0xFu << 20; /* the floating point unit, where there is one */
  __asm volatile("dsb\nisb");
  _start();
}
__attribute__((section(".vectors"), used)) const void* const vectors[2] = {(void*)0x20400000, (void*)reset};
C
cat >observe.c <<'C'
#include <math.h>
#include <stdio.h>
volatile double x = 1 + 0x1p-30, z = -(1 + 0x1p-29);
volatile float xf = 1 + 0x1p-12f, zf = -(1 + 0x1p-11f);
int main(void) {
  printf("fma %g fmaf %g\n", fma(x, x, z), (double)fmaf(xf, xf, zf));
  return 0;
}
C
on() { # <board> <flags>: prints what the program prints there
  local board=$1
  shift
  arm-none-eabi-gcc -w -O2 -mthumb "$@" --specs=rdimon.specs -Wl,--section-start=.vectors=0 observe.c start.c -lm -o observe.elf
  timeout 60 qemu-system-arm -M "$board" -display none -monitor none -serial none -semihosting -kernel observe.elf 2>&1
}
m3=$(on mps2-an385 -mcpu=cortex-m3)
m4=$(on mps2-an386 -mcpu=cortex-m4 -mfloat-abi=hard -mfpu=fpv4-sp-d16)
m7=$(on mps2-an500 -mcpu=cortex-m7 -mfloat-abi=hard -mfpu=fpv5-d16)
printf 'M3: %s\nM4: %s\nM7: %s\n' "$m3" "$m4" "$m7"
rounded="fma 0 fmaf 5.96046e-08" exact="fma 8.67362e-19 fmaf 5.96046e-08"
if [ "$m3" != "$rounded" ] || [ "$m4" != "$rounded" ] || [ "$m7" != "$exact" ]; then
  echo "changed: fma() of newlib rounds otherwise"
  exit 1
fi

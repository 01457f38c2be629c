#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: mawk 1.3.4 of 2020-01-20, the awk of Debian 12 (mawk 1.3.4.20200120-3.1).
# One would guess: awk prints whole numbers whole, and %d up to 2^53, as gawk and the standard do.
# What happens: above 2^31 a whole number that was computed is printed with six digits, as fractions are, and %d of it is
#   2147483647. A field that is only copied keeps all digits, and so does %.0f.
# Seen: 1700000000000000 and 4000 more, plus 0: both 1.7e+15; by %d both 2147483647; by %.0f both right. Up to 2147483647 all
#   are right.
# Why it matters: stamps since 1970 in ms or us, moved by an offset: all rows of a flight get one time. Stamps since boot are
#   right for 24 days in ms, and for 35 minutes in us.
# pinnquad: a time that does not advance is refused, with its line and column.
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
package=mawk=1.3.4.20200120-3.1
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
moved() { printf '%s\n' "$1" "$(($1 + 4000))" | packages/usr/bin/mawk "$2" | xargs; }
first=1700000000000000
printed=$(moved $first '{ print $1 + 0 }')
whole=$(moved $first '{ printf "%d\n", $1 + 0 }')
fixed=$(moved $first '{ printf "%.0f\n", $1 + 0 }')
boot=$(moved 2147479647 '{ print $1 + 0 }')
printf 'print %s; %%d %s; %%.0f %s; since boot %s\n' "$printed" "$whole" "$fixed" "$boot"
if [ "$printed|$whole|$fixed|$boot" != \
  "1.7e+15 1.7e+15|2147483647 2147483647|1700000000000000 1700000000004000|2147479647 2147483647" ]; then
  echo "changed: whole numbers of mawk"
  exit 1
fi

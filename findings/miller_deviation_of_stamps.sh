#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Package: Miller 6.6.0 (Debian 12's miller 6.6.0-2+b3).
# One would guess: stats1's var and stats2's linreg-ols, corr and r2 of a log do not depend on where its clock began.
# What happens: they come of sums of squares and of products, whose digits are used up by the begin: of seconds since 1970 the
#   spread and the slope that come out are not even near, of microseconds the spread is 0. Nothing is reported.
# Seen: 500 rows at 250 Hz beside a column that grows by 2 a second, exactly. var of the stamps 1050.68, of the same in
#   microseconds 0 (right: 0.334, 3.34e11); slope 0.00062 (right: 2), corr 0.018 (right: 1). Less the first stamp all are right.
# Why it matters: that is how a drift of a sensor, or of a clock against GPS, is looked for in a log: none is found.
# pinnquad: moments are taken about the mean (include/pinnquad/evaluation/impl/summary.hpp).
set -euo pipefail
dir=$(mktemp -d)
trap 'rm -rf -- "$dir"' EXIT
cd "$dir"
package=miller=6.6.0-2+b3
apt-get download "$package" >log 2>&1 || { echo "not run: apt-get does not download $package"; exit 2; }
dpkg-deb -x ./*.deb packages
for first in 1700000000 0; do
  awk -v first="$first" 'BEGIN {
    print "t,us,y"
    for (i = 0; i < 500; ++i) printf "%.3f,%.0f,%.3f\n", first + 0.004 * i, 1e6 * first + 4000 * i, 1 + 0.008 * i
  }' >log.csv
  { packages/usr/bin/mlr --icsv --onidx --ofmt %.5g stats1 -a var -f t,us log.csv
    packages/usr/bin/mlr --icsv --onidx --ofmt %.5g stats2 -a linreg-ols,corr -f t,y \
      'then' cut -o -f t_y_ols_m,t_y_corr log.csv
  } | xargs >"from_$first"
done
read -r variance in_us slope alike <from_1700000000
printf 'variance %s and, in us, %s; slope %s, correlation %s; ' "$variance" "$in_us" "$slope" "$alike"
printf 'less the first stamp: %s\n' "$(cat from_0)"
if [ "$(cat from_1700000000)" != "1050.7 0 0.00062088 0.01783" ] || [ "$(cat from_0)" != "0.334 3.34e+11 2 1" ]; then
  echo "changed: Miller's moments of stamps"
  exit 1
fi

# SPDX-License-Identifier: MIT
# The largest difference of two tables in any column but t, rows in the same order; "rows differ" for other numbers of rows.
#   awk -f difference.awk a.csv b.csv
BEGIN { FS = "," }
FNR == 1 { next }
NR == FNR { row[FNR] = $0; rows = FNR; next }
{
  split(row[FNR], other, ",")
  if (($1 - other[1]) ^ 2 > 1e-14) { print "times differ at row " FNR; failed = 1; exit }
  for (i = 2; i <= NF; ++i) {
    d = $i - other[i]
    if (d < 0) d = -d
    if (d > most) most = d
  }
  last = FNR
}
END {
  if (failed) exit
  if (last != rows) print "rows differ: " rows - 1 " and " last - 1
  else printf "%.3g\n", most
}

# SPDX-License-Identifier: MIT
# Root mean square difference of a dataset's flight and what a reference says at its times, by lines between the reference's rows;
# `of` names the flight's columns, `with` the reference's, `clock` its clock in `ticks` a second, read `late` seconds before.
#   awk -v of="w_x w_y" -v with="xyz[0] xyz[1]" -v clock=timestamp -v ticks=1e6 -v late=0 -f against.awk reference.csv flight.csv
BEGIN {
  FS = ","
  count = split(of, ours, " ")
  if (split(with, theirs, " ") != count) exit 2
  at = 1
}
FNR == 1 {
  ++file
  for (i = 1; i <= NF; ++i) column[file, $i] = i
  for (k = 1; k <= count; ++k) {
    if (!column[file, file == 1 ? theirs[k] : ours[k]]) { print "no column " (file == 1 ? theirs[k] : ours[k]); exit 2 }
  }
  next
}
file == 1 {
  ++rows
  t[rows] = $column[1, clock] / ticks
  for (k = 1; k <= count; ++k) v[rows, k] = $column[1, theirs[k]]
  next
}
{
  now = $column[2, "t"] - late
  while (at < rows - 1 && t[at + 1] <= now) ++at
  if (now < t[at] - 1e-6 || now > t[at + 1] + 1e-6 || t[at + 1] - t[at] > 0.1) next
  share = (now - t[at]) / (t[at + 1] - t[at])
  for (k = 1; k <= count; ++k) {
    d = $column[2, ours[k]] - (v[at, k] + share * (v[at + 1, k] - v[at, k]))
    sum[k] += d * d
  }
  ++n
}
END {
  printf "%d", n
  for (k = 1; k <= count; ++k) printf " %.5f", n ? sqrt(sum[k] / n) : 9
  print ""
}

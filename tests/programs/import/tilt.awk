# SPDX-License-Identifier: MIT
# Root mean square difference of roll and of pitch, degrees, of a dataset's flight and a log's attitude, by lines between its rows.
#   awk -f tilt.awk vehicle_attitude.csv flight.csv
BEGIN { FS = ","; at = 1 }
FNR == 1 { ++file; for (i = 1; i <= NF; ++i) column[file, $i] = i; next }
file == 1 {
  t[++rows] = $column[1, "timestamp_sample"] / 1e6
  w = $column[1, "q[0]"]; x = $column[1, "q[1]"]; y = $column[1, "q[2]"]; z = $column[1, "q[3]"]
  roll[rows] = atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
  s = 2 * (w * y - z * x)
  pitch[rows] = atan2(s, sqrt(1 - s * s))
  next
}
{
  now = $column[2, "t"]
  while (at < rows - 1 && t[at + 1] <= now) ++at
  share = (now - t[at]) / (t[at + 1] - t[at])
  d = $column[2, "roll"] - (roll[at] + share * (roll[at + 1] - roll[at]))
  of_roll += d * d
  d = $column[2, "pitch"] - (pitch[at] + share * (pitch[at + 1] - pitch[at]))
  of_pitch += d * d
  ++n
}
END { printf "%.3f %.3f\n", 57.3 * sqrt(of_roll / n), 57.3 * sqrt(of_pitch / n) }

# SPDX-License-Identifier: MIT
# Flight logs to a dataset: a flight in closed form in two conventions, bad input, and recorded logs where they are at hand.
source "$(dirname "$0")/common.sh" "$@"
here=$source_dir/tests/programs/import
reference=${PINNQUAD_REFERENCE_DIR:-$source_dir/../shared/reference}

# within <number> <least> <most> <what>
within() { awk -v v="$1" -v a="$2" -v b="$3" 'BEGIN { exit !(v >= a && v <= b) }' || fail "$4: $1 is not within $2 to $3"; }
# below <tolerance> <what> <number>...: each number
below() {
  local tolerance=$1 what=$2 number
  shift 2
  for number in "$@"; do within "$number" 0 "$tolerance" "$what"; done
}
fact() { sed -n "s/^ \"$2\": \([^,]*\),*$/\1/p" "$1/dataset.json"; }
cost() { awk -v step="$2" '$0 ~ "\"rows_after\"" { after = $2 + 0 } $0 ~ "\"rows_before\"" { before = $2 + 0 }
  $0 ~ "\"step\": \"" step "\"" { print before - after }' "$1/dataset.json"; }

# one flight in two conventions
awk -v rows=2000 -v lag=0.04 -v ned=ned.csv -v enu=enu.csv -f "$here/flight.awk"
"$pinnquad" import ned.csv --mapping "$here/ned.toml" --out ned >ned.txt
"$pinnquad" import enu.csv --mapping "$here/enu.toml" --out enu --json >enu.json
! grep warning ned.txt || fail "a clean flight was warned of"
grep -q '^saturated  *[0-9]' ned.txt || fail "no step 'saturated' in the table: $(cat ned.txt)"
within "$(fact ned lag_removed_s)" 0.037 0.043 "the lag of a flight whose motors are 40 ms ahead"
[ "$(fact ned sample_period_s)" = 0.01 ] || fail "the period is $(fact ned sample_period_s)"
below 2e-7 "the same flight in ENU, FLU, degrees, g, mm, us, pulses, another order" \
  "$(awk -f "$here/difference.awk" ned/A1_wave_rep1.csv enu/A1_wave_rep1.csv)"
grep -q '"trajectory": "wave"' ned/dataset.json || fail "the pattern found no trajectory"
head -n 1 ned/A1_wave_rep1.csv | grep -q 'battery_voltage \[V\]' || fail "no battery voltage"
[ "$(head -c 1 enu.json)" = '{' ] && [ "$(tail -n 1 enu.json)" = '}' ] || fail "--json printed something else"
diff <(cat enu.json) enu/dataset.json || fail "--json prints another dataset than it writes"
# what was computed, against the closed form: body velocity, angular acceleration, specific force
"$pinnquad" import ned.csv --mapping "$here/ned.toml" --lag 0.04 --out given >/dev/null
awk -F, -v OFMT=%.17g 'NR == 1 { print "t,p_dot,q_dot,r_dot,u1,u2,u3,u4"; next }
  { for (i = 5; i <= 7; ++i) w[NR, i] = $i; line[NR] = $0; t[NR] = $1; u[NR] = $17 "," $18 "," $19 "," $20 }
  END { for (n = 3; n < NR; ++n) {
    printf "%.17g", t[n]
    for (i = 5; i <= 7; ++i) printf ",%.17g", (w[n + 1, i] - w[n - 1, i]) / 0.02
    print "," u[n] } }' ned.csv >truth.csv
read -r n x y z <<<"$(awk -v of="wdot_x wdot_y wdot_z" -v with="p_dot q_dot r_dot" -v clock=t -v ticks=1 -v late=0 \
  -f "$here/against.awk" truth.csv given/A1_wave_rep1.csv)"
within "$n" 1900 2000 "rows compared"
below 0.02 "angular acceleration" "$x" "$y" "$z"
read -r n a b c d <<<"$(awk -v of="u1 u2 u3 u4" -v with="u1 u2 u3 u4" -v clock=t -v ticks=1 -v late=0.04 \
  -f "$here/against.awk" truth.csv given/A1_wave_rep1.csv)"
below 1e-5 "commands 40 ms before" "$a" "$b" "$c" "$d"
# a dataset is replaced, a folder with anything else is not
"$pinnquad" import ned.csv --mapping "$here/ned.toml" --out ned >again.txt
cmp ned.txt again.txt || fail "the same log gave another dataset"
touch ned/mine.txt
expect_line 2 'holds "mine.txt", which is no part of a dataset' "$pinnquad" import ned.csv --mapping "$here/ned.toml" --out ned
[ -e ned/A1_wave_rep1.csv ] || fail "the dataset was destroyed"

# what looks wrong is warned of, and the right order proposed
awk -F, -v OFS=, '{ a = $17; $17 = $20; $20 = $18; $18 = a; print }' ned.csv >order.csv
sed -i '1s/.*/t,roll,pitch,yaw,p,q,r,fx,fy,fz,vn,ve,vd,x,y,z,u1,u2,u3,u4,bat,label/' order.csv
"$pinnquad" import order.csv --mapping "$here/ned.toml" --lag 0.04 --out order >order.txt
grep -q 'warning: motors' order.txt || fail "another motor order was not noticed: $(cat order.txt)"
sed 's/^order = "xyzw"/order = "wxyz"/' "$here/enu.toml" >wrong_order.toml
expect_line 2 'expected the derivative of .* is in the order x, y, z, w, by how it turns' \
  "$pinnquad" import enu.csv --mapping wrong_order.toml --lag 0.04 --out wrong_order
[ ! -e wrong_order ] || fail "a flight in another order of the quaternion was imported"
sed '0,/^body = "flu"/s//body = "frd"/' "$here/enu.toml" >wrong_body.toml
"$pinnquad" import enu.csv --mapping wrong_body.toml --lag 0.04 --out wrong_body >wrong_body.txt
grep -q 'warning: .*specific force points along +z' wrong_body.txt ||
  fail "another body frame was not noticed: $(cat wrong_body.txt)"
# rows that are no rows are counted
awk -F, -v OFS=, 'NR == 300 { $5 = "nan" } NR == 500 { $2 = "" } NR == 700 { print } { print }' ned.csv |
  awk 'NR == 900 { held = $0; next } { print } NR == 903 { print held }' >rows.csv
"$pinnquad" import rows.csv --mapping "$here/ned.toml" --lag 0.04 --out rows >rows.txt
grep -q 'warning: A1_wave_rep1, the table: 1 rows had the time of another' rows.txt || fail "a time that comes twice was not told: $(cat rows.txt)"
grep -q 'warning: A1_wave_rep1, the table: 1 rows were not in time' rows.txt || fail "a row out of order was not told"
within "$(cost rows 'incomplete rows')" 2 2 "rows without a number"

# a long table is held about once: 100,000 rows of 21 columns are 17 MB
awk -F, -v OFS=, 'NR == 1 { print } NR > 1 { row[NR] = $0; t[NR] = $1 }
  END { for (copy = 0; copy < 50; ++copy) for (i = 2; i <= NR; ++i) { $0 = row[i]; $1 = t[i] + 20 * copy; print } }' ned.csv >long.csv
peak() { # <log>: of an import, kB
  MALLOC_MMAP_THRESHOLD_=131072 python3 - "$pinnquad" import "$1" --mapping "$here/ned.toml" --lag 0.04 --out peak_out <<'EOF'
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
EOF
}
if command -v python3 >/dev/null; then
  within "$(($(peak long.csv) - $(peak ned.csv)))" 0 60000 "kB that 98,000 more rows take"
else
  echo "no python3: the memory of an import was not looked at"
fi
# bad input: one line, exit code 2, nothing left behind
refused() {
  local pattern=$1
  shift
  expect_line 2 "$pattern" "$pinnquad" import "$@" --out bad
  [ -z "$(find . -maxdepth 1 -name 'bad*' -print)" ] || fail "left behind: $(ls -d bad*)"
}
mapping() { sed "$1" "$here/ned.toml" >mapping.toml; }
table() { awk -F, -v OFS=, "$1" ned.csv >table.csv; }
mapping 's/"roll"/"roal"/'
refused 'mapping.toml:14:10: expected a column of the table in ned.csv, found `roal`, which it has not; nearest: roll' ned.csv --mapping mapping.toml
mapping 's/column = "t"/column = "tt"/'
refused 'mapping.toml:7:10: expected a column of the table .*nearest: t' ned.csv --mapping mapping.toml
mapping 's/column = "label"/column = "lable"/'
refused 'mapping.toml:10:10: .*nearest: label' ned.csv --mapping mapping.toml
mapping 's/"u4"//; s/"u3", /"u3"/'
refused 'mapping.toml:29:11: expected 4 columns of the command of each motor' ned.csv --mapping mapping.toml
mapping 's/order = "px4"/order = "px5"/'
refused 'mapping.toml:30:9: expected "px4", "betaflight", "crazyflie"' ned.csv --mapping mapping.toml
mapping 's/order = "px4"/ordr = "px4"/'
refused 'mapping.toml:[0-9]*:[0-9]*: expected `order`' ned.csv --mapping mapping.toml
mapping 's/columns = \["p", "q", "r"\]/&\nunit = "rpm"/'
refused 'mapping.toml:18:8: expected a unit: "rad/s", "deg/s", found "rpm"' ned.csv --mapping mapping.toml
mapping 's/\[velocity\]/[velociti]/'
refused 'mapping.toml:[0-9]*:[0-9]*: expected a key of a mapping, found `velociti`' ned.csv --mapping mapping.toml
mapping 's/world = "ned"/world = "nwu"/'
refused 'mapping.toml:3:9: expected "ned" or "enu", found "nwu"' ned.csv --mapping mapping.toml
mapping 's/world = "ned"/world = /'
refused 'mapping.toml:3:[0-9]*: expected TOML' ned.csv --mapping mapping.toml
mapping 's/"\*_(\*)_\*"/"*_(*_*"/'
refused 'mapping.toml:11:14: expected a pattern' ned.csv --mapping mapping.toml
refused "no mapping named 'px5'; known: arpl, nanobench, px4" ned.csv --mapping px5
refused 'missing.toml: expected a readable file' ned.csv --mapping missing.toml
refused 'expected --mapping' ned.csv
ned="--mapping $here/ned.toml"
refused 'missing.csv: expected a readable file' missing.csv $ned
: >table.csv
refused 'table.csv:1: expected a header' table.csv $ned
table 'NR <= 50'
refused 'table.csv: expected a flight of at least 64 rows, found' table.csv $ned
table 'NR == 400 { $6 = "fast" } { print }'
refused 'table.csv:400:6: expected a number in column q, found "fast"' table.csv $ned
table 'NR == 400 { $6 = "\"0,5\"" } { print }'
refused 'table.csv:400:6: expected numbers with a decimal point' table.csv $ned
table 'NR == 400 { print $1, $2; next } { print }'
refused 'table.csv:400:3: expected 22 cells as in the header' table.csv $ned
table 'NR > 1 { $6 = "" } { print }'
refused 'ned.toml:17:[0-9]*: expected numbers in column' table.csv $ned
table 'NR > 1 { $20 = "" } { print }'
refused 'ned.toml:29:[0-9]*: expected four motors with commands, found no number in column u4' table.csv $ned
table 'NR > 1 { $17 = 1000 + 1000 * $17 } { print }'
refused 'table.csv:2:17: expected motor commands from `least` to `most`' table.csv $ned
table 'NR > 1000 { $1 -= 9 } { print }'
refused 'table.csv:1001:1: expected time that goes on .*found a step back of 8.99' table.csv $ned
awk -F, -v OFS=, 'NR == 77 { $5 = 0.9 } { print }' enu.csv >table.csv
refused 'table.csv:77:[2-5]: expected a unit quaternion in the table, found one of length 1' table.csv --mapping "$here/enu.toml"
table '{ for (i = 5; i <= 7; ++i) if (NR > 1) $i *= 57.3 } { print }'
refused 'table.csv: expected radians per second in columns w_x, w_y, w_z, found degrees per second' table.csv $ned --lag 0.04
# the same flight twice, by whatever name: one would be judged on what it was trained on
cp ned.csv copy.csv
for copy in ned.csv ./ned.csv copy.csv; do
  refused '^import: A1_wave_rep1 and A1_wave_rep1 \(2\) hold the same flight' ned.csv $copy $ned
done
refused '--lag: expected auto, or seconds' ned.csv $ned --lag soon
refused '--rate: expected a number from 1 to 2000' ned.csv $ned --rate 0
printf 'ULog\001\022\065\001 and no more' >cut.ulg
refused 'cut.ulg' cut.ulg --mapping px4
mkdir -p empty_folder
refused 'empty_folder: expected a folder of .ulg files, or one that ulog2csv wrote' empty_folder --mapping px4
echo kept >file
expect_line 2 'cannot write file: it is there already' "$pinnquad" import ned.csv $ned --out file
[ "$(cat file)" = kept ] || fail "a file was overwritten"
"$pinnquad" import --list | grep -q '^nanobench ' || fail "--list names no mapping"

recorded() { [ -e "$reference/$1" ] || { echo "SKIPPED: no $1"; return 1; }; }

if recorded flight_logs/nanobench_subset_50hz.csv; then
  log=$reference/flight_logs/nanobench_subset_50hz.csv
  "$pinnquad" import "$log" --mapping nanobench --out nanobench >nanobench.txt
  cat nanobench.txt
  grep -q '"trajectory": "lissajous"' nanobench/dataset.json || fail "no trajectory lissajous"
  within "$(fact nanobench lag_removed_s)" 0.02 0.045 "lag of NanoBench"
  [ "$(fact nanobench sample_period_s)" = 0.02 ] || fail "NanoBench's period"
  [ "$(ls nanobench/*.csv | wc -l)" -eq 11 ] || fail "11 flights were expected"
  for flight in B10_lissajous_fast_rep1 B5_helix_fast_rep1 B9_trefoil_medium_rep1; do
    grep -e '^flight,' -e "^$flight," "$log" >one.csv
    compare() { awk -v of="$1" -v with="$2" -v clock=t -v ticks=1 -v late=0 -f "$here/against.awk" one.csv "nanobench/$flight.csv"; }
    read -r n numbers <<<"$(compare "v_bx v_by v_bz w_x w_y w_z wdot_x wdot_y wdot_z roll pitch" "vbx vby vbz wx wy wz dwx dwy dwz roll pitch")"
    within "$n" 1000 1700 "rows of $flight compared"
    below 1e-9 "columns of $flight" $numbers
    # the motion's acceleration is specific force + R^T g - w x v; its parts stand in the file
    awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i; print "t,vdot_bx,vdot_by,vdot_bz"; next }
      { wx = $c["wx"]; wy = $c["wy"]; wz = $c["wz"]; vx = $c["vbx"]; vy = $c["vby"]; vz = $c["vbz"]
        r = $c["roll"]; p = $c["pitch"]; g = 9.80665
        printf "%.12g,%.12g,%.12g,%.12g\n", $c["t"], $c["sfx"] - g * sin(p) - (wy * vz - wz * vy), \
          $c["sfy"] + g * sin(r) * cos(p) - (wz * vx - wx * vz), $c["sfz"] + g * cos(r) * cos(p) - (wx * vy - wy * vx) }' one.csv >two.csv
    mv two.csv one_.csv
    read -r n numbers <<<"$(awk -v of="vdot_bx vdot_by vdot_bz" -v with="vdot_bx vdot_by vdot_bz" -v clock=t -v ticks=1 -v late=0 -f "$here/against.awk" one_.csv "nanobench/$flight.csv")"
    below 1e-9 "accelerations of $flight" $numbers
    # their own alignment is by 30 ms, from their faster log: front right, rear left, front left, rear right of FR RR RL FL
    read -r n numbers <<<"$(compare "u1 u2 u3 u4" "ua1 ua3 ua4 ua2")"
    below 0.03 "commands of $flight" $numbers
  done
fi
if recorded flight_logs/arpl_crazyflie.csv; then
  "$pinnquad" import "$reference/flight_logs/arpl_crazyflie.csv" --mapping arpl --out arpl >arpl.txt
  cat arpl.txt
  grep -q '^absent: velocity' arpl.txt && grep -q '^absent: altitude' arpl.txt || fail "arpl has no velocity and no altitude"
  awk -F, 'NR > 1 { for (i = 8; i <= 10; ++i) if ($i != 0) bad = 1 } END { exit bad }' arpl/arpl_cf_log10_5s.csv || fail "a velocity was made up"
fi
if recorded sih/test_circle_csv; then
  sih=$reference/sih
  "$pinnquad" import "$sih/test_circle_csv" --mapping px4 --out circle >circle.txt
  cat circle.txt
  flight=circle/test_circle.csv truth=$sih/test_circle_csv/test_circle_vehicle
  read -r n numbers <<<"$(awk -v of="w_x w_y w_z" -v with="xyz[0] xyz[1] xyz[2]" -v clock=timestamp_sample -v ticks=1e6 -v late=0.006 \
    -f "$here/against.awk" "${truth}_angular_velocity_groundtruth_0.csv" "$flight")"
  below 0.1 "body rates against the simulator's, 6 ms of its filter before" $numbers
  read -r -a numbers <<<"$(awk -f "$here/tilt.awk" "${truth}_attitude_groundtruth_0.csv" "$flight")"
  below 1.5 "roll and pitch, degrees, against the simulator's" "${numbers[@]}"
  read -r n numbers <<<"$(awk -v of="altitude" -v with="z" -v clock=timestamp_sample -v ticks=1e6 -v late=0 \
    -f "$here/against.awk" <(awk -F, -v OFS=, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "z") c = i } NR > 1 { $c = -$c } { print }' \
    "${truth}_local_position_groundtruth_0.csv") "$flight")"
  below 0.6 "altitude against the simulator's" $numbers
  read -r n numbers <<<"$(awk -v of="u1 u2 u3 u4" -v with="control[0] control[1] control[2] control[3]" -v clock=timestamp_sample \
    -v ticks=1e6 -v late="$(fact circle lag_removed_s)" -f "$here/against.awk" "$sih/test_circle_csv/test_circle_actuator_motors_0.csv" "$flight")"
  below 0.03 "commands against those logged, the lag before" $numbers
  # in the air by the simulator, and nearly all of it
  read -r from until <<<"$(awk -F, '$1 == "test_circle" { print $4 / 1e6, $7 / 1e6 }' "$sih/phases.csv")"
  within "$(sed -n 2p "$flight" | cut -d, -f1)" "$(awk -v v="$from" 'BEGIN { print v - 0.1 }')" "$(awk -v v="$from" 'BEGIN { print v + 3 }')" "first row in the air"
  within "$(tail -n 1 "$flight" | cut -d, -f1)" "$(awk -v v="$until" 'BEGIN { print v - 3 }')" "$(awk -v v="$until" 'BEGIN { print v + 0.1 }')" "last row in the air"
  if recorded sih/test_circle.ulg; then
    "$pinnquad" import "$sih/test_circle.ulg" --mapping px4 --out ulog >ulog.txt
    below 1e-6 "ULog and its ulog2csv folder" "$(awk -f "$here/difference.awk" circle/test_circle.csv ulog/test_circle.csv)"
  fi
fi
if recorded ulog2csv/B_px4v117_x500v2_gps; then
  for folder in B_px4v117_x500v2_gps C_px4_2016_sitl_legacy; do
    "$pinnquad" import "$reference/ulog2csv/$folder" --mapping px4 --out "$folder" >"$folder.txt" || fail "$folder"
    cat "$folder.txt"
  done
  grep -q 'vehicle_torque_setpoint' B_px4v117_x500v2_gps.txt || fail "commands at 10 Hz were not rebuilt"
  grep -q 'warning: lag: the lag hardly stands out' B_px4v117_x500v2_gps.txt || fail "a calm flight's lag was not doubted"
  grep -q 'actuator_controls_0' C_px4_2016_sitl_legacy.txt || fail "commands of 2016 were not rebuilt"
  derived=$reference/ulog2csv/B_px4v117_x500v2_gps/derived/motors_reconstructed_50hz.csv
  read -r n numbers <<<"$(awk -v of="u1 u2 u3 u4" -v with="motor1_FR motor2_RL motor3_FL motor4_RR" -v clock=timestamp_sample -v ticks=1e6 \
    -v late="$(fact B_px4v117_x500v2_gps lag_removed_s)" -f "$here/against.awk" "$derived" "$(ls B_px4v117_x500v2_gps/*.csv | head -n 1)")"
  within "$n" 1000 5000 "rows of B compared"
  below 0.02 "rebuilt commands against those of others" $numbers
fi

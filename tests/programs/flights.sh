# SPDX-License-Identifier: MIT
# The paper's flights: bounds by --statistics, stick recordings flown again, recorder errors, pictures, bad input, Ctrl-C.
source "$(dirname "$0")/common.sh" "$@"

# d1 is what fly does without a name; the rows of the three flights
"$pinnquad" fly --seed 2 --samples 500 --out unnamed.csv >/dev/null
"$pinnquad" fly d1 --seed 2 --samples 500 --out named.csv >/dev/null
cmp unnamed.csv named.csv || fail "d1 is not the default flight"
rows() { echo $(($(wc -l <"$1") - 1)); }
for flight in d1:15000 d2:6000 d3:5000; do
  "$pinnquad" fly "${flight%:*}" --out "${flight%:*}.csv" >/dev/null
  [ "$(rows "${flight%:*}.csv")" -eq "${flight#*:}" ] || fail "$flight rows were expected"
done

# bounds over seeds, as a table and as CSV
for flight in d1 d2 d3; do
  "$pinnquad" fly "$flight" --statistics 3 --out table.csv >table.txt
  [ "$(rows table.csv)" -eq 3 ] || fail "table.csv: three seeds were expected"
  grep -qE '^  mean ' table.txt || fail "the table has no means"
  awk -F, -v flight="$flight" 'NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    function value(name) { return $column[name] }
    { bad = value("max_speed_m_s") > 8 || value("min_altitude_m") <= 0 || value("saturated_percent") >= 5 ||
            value("pcc_roll") < 0.95 || value("pcc_pitch") < 0.95 || value("pcc_yaw") < 0.95
      if (flight == "d2") bad = bad || value("min_altitude_m") < 0.1 || value("max_altitude_m") > 2
      else bad = bad || value("max_speed_m_s") <= 7
      if (bad) { print "seed " $1 " of " flight " leaves the bounds: " $0; exit 1 } }' table.csv || fail "bounds"
done

# sticks: written at every tick and flown again, the same bits; the example flies
"$pinnquad" fly d3 --seed 4 --samples 200 --record-sticks sticks.csv --out first.csv >/dev/null
[ "$(rows sticks.csv)" -eq 5000 ] || fail "a stick row per control tick was expected"
"$pinnquad" fly d3 --sticks sticks.csv --out again.csv >/dev/null
cmp first.csv again.csv || fail "the recording flew another flight"
"$pinnquad" fly d1 --sticks "$source_dir/examples/sticks/agile_20s.csv" --out example.csv >/dev/null
[ "$(rows example.csv)" -eq 399 ] || fail "the example's recording lasts 19.95 s"

# recorder errors lower the correlation, and by the same seed in the same way
"$pinnquad" fly d1 --samples 2000 --gyro-noise 0.05 --latency 40 --jitter 5 --out noisy.csv >noisy.txt
"$pinnquad" fly d1 --samples 2000 --gyro-noise 0.05 --latency 40 --jitter 5 --out noisy_again.csv >/dev/null
cmp noisy.csv noisy_again.csv || fail "the same seed gave other noise"
grep -qE 'roll 0\.[0-7]' noisy.txt || fail "noise and latency leave the correlation: $(cat noisy.txt)"

"$pinnquad" fly d2 --samples 400 --ground-effect none --out none.csv >/dev/null
"$pinnquad" fly d2 --samples 400 --ground-effect conyers --out conyers.csv >/dev/null
"$pinnquad" fly d2 --samples 400 --out default.csv >/dev/null
cmp conyers.csv default.csv || fail "d2 flies with Conyers' ground effect"
! cmp -s none.csv default.csv || fail "without ground effect d2 is the same"

"$pinnquad" fly d1 --samples 20 --airframe racer_5_inch --out by_name.csv >/dev/null
"$pinnquad" fly d1 --samples 20 --airframe "$source_dir/examples/airframes/racer_5_inch.toml" --out by_file.csv >by_file.txt
grep -q '^airframe    racer_5_inch: ' by_file.txt || fail "fly does not call the airframe by the name in its file: $(cat by_file.txt)"
cmp by_name.csv by_file.csv || fail "an airframe flies otherwise from its file"

"$pinnquad" fly --list-airframes >airframes.txt
grep -q 'paper_quadrotor .*1\.500 kg.*thrust-to-weight 2\.006' airframes.txt || fail "said: $(cat airframes.txt)"
grep -q 'Table 1' airframes.txt || fail "no source of the values: $(cat airframes.txt)"

if command -v gnuplot >/dev/null; then
  "$pinnquad" fly d2 --samples 1000 --pictures pictures >/dev/null
  "$pinnquad" fly d3 --samples 1000 --pictures pictures >/dev/null
  [ "$(ls pictures | tr '\n' ' ')" = "correlation.svg ground_effect.svg trajectory.svg wind.svg " ] ||
    fail "pictures: $(ls pictures)"
  for picture in pictures/*; do grep -q '</svg>' "$picture" || fail "$picture is not whole"; done
fi
mkdir without_gnuplot
code=0
PATH=/nonexistent "$pinnquad" fly d2 --samples 6000 --pictures without_gnuplot >/dev/null 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code without gnuplot"
grep -q 'gnuplot is missing' stderr.txt || fail "said: $(cat stderr.txt)"
[ -z "$(ls -A without_gnuplot)" ] || fail "left without gnuplot: $(ls -A without_gnuplot)"

# bad input
mkdir out
head -n 3 sticks.csv >bad.csv
echo '9,1,fast,0,0,0,0,0' >>bad.csv
expect_line 2 'bad\.csv:4:3: .*v_east_m_s.*fast' "$pinnquad" fly --sticks bad.csv --out out/f.csv
expect_line 2 'absent\.csv: ' "$pinnquad" fly --sticks absent.csv --out out/f.csv
expect_line 2 "no flight named 'd4'; known: d1, d2, d3" "$pinnquad" fly d4 --out out/f.csv
expect_line 2 "no ground effect named 'some'; known: none" "$pinnquad" fly d2 --ground-effect some --out out/f.csv
expect_line 2 '--out FILE.csv is needed' "$pinnquad" fly d1
expect_line 2 '--statistics' "$pinnquad" fly d1 --statistics 2 --sticks sticks.csv
expect_line 2 '--statistics' "$pinnquad" fly d1 --statistics 2 --pictures out
expect_line 2 '--max-speed' "$pinnquad" fly d1 --max-speed 3 --sticks sticks.csv --out out/f.csv
expect_line 2 '--gyro-noise' "$pinnquad" fly d1 --gyro-noise -1 --out out/f.csv
expect_line 2 '--latency' "$pinnquad" fly d1 --latency much --out out/f.csv
expect_line 2 'absent/s\.csv: No such file or directory' "$pinnquad" fly d1 --record-sticks absent/s.csv --out out/f.csv
expect_line 2 '--pictures needs 20 rows' "$pinnquad" fly d2 --samples 5 --pictures pictures --out out/f.csv
expect_line 2 'absent/pictures' "$pinnquad" fly d1 --pictures absent/pictures --out out/f.csv

# Ctrl-C leaves nothing
interrupted() { # <arguments>: two seconds into minutes of flight
  setsid "$pinnquad" fly "$@" >stdout.txt 2>stderr.txt &
  local pid=$! code=0
  sleep 2
  kill -INT "$pid"
  wait "$pid" || code=$?
  [ "$code" -eq 130 ] || fail "exit code $code instead of 130: $*; said: $(cat stderr.txt)"
  grep -q 'fly: interrupted; nothing was written' stderr.txt || fail "said: $(cat stderr.txt)"
}
interrupted d1 --samples 10000000 --out out/f.csv --record-sticks out/s.csv
interrupted d1 --statistics 10000 --out out/table.csv
[ -z "$(ls -A out)" ] || fail "something was left in the output folder: $(ls -A out)"

# on a terminal each part of the work shows how far it is
if command -v script >/dev/null && command -v gnuplot >/dev/null; then
  mkdir progress
  if ! script -qec true /dev/null >/dev/null 2>&1; then
    echo "skipped: no pseudo-terminal here; what a terminal sees was not looked at" >&2
    exit 77
  fi
  script -qec "'$pinnquad' fly --samples 400 --out progress/f.csv --pictures progress" terminal.txt >/dev/null
  for part in 'flying:' 'writing progress/f.csv:' 'drawing 2 pictures:'; do
    grep -qE "$part +[0-9]+ %, [0-9]+ s left" terminal.txt || fail "a terminal sees no progress of $part $(cat -v terminal.txt)"
  done
fi

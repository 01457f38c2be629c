# SPDX-License-Identifier: MIT
# Ctrl-C in training keeps what is finished: the results are whole, the exit code says that it was interrupted.
source "$(dirname "$0")/common.sh" "$@"

"$pinnquad" fly --seed 1 --samples 2400 --out flight.csv >/dev/null
mkdir out
# More work than any machine does before the first line of progress (5 s), in pieces small enough for any.
setsid "$pinnquad" train --flight flight.csv --out out --seeds 500 --epochs 30 --threads 2 >stdout.txt 2>stderr.txt &
pid=$!
# one percent is ten trainings' worth of epochs on two threads: some are finished then
for ((second = 0; second < 240; ++second)); do
  if grep -qE '[1-9][0-9]* %' stderr.txt; then break; fi
  sleep 1
done
kill -INT "$pid"
code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130; said: $(cat stderr.txt)"
grep -qE 'interrupted; [1-9][0-9]* of 1500 trainings were finished and kept' stderr.txt || fail "said: $(cat stderr.txt)"
kept=$(sed -nE 's/.*interrupted; ([0-9]+) of.*/\1/p' stderr.txt)
[ "$(wc -l <out/results.csv)" -eq $((kept + 2)) ] || fail "results.csv does not hold the $kept finished trainings"
[ -s out/model.hpp ] || fail "nothing was exported although trainings were finished"
[ -z "$(find out -name '*.partial*')" ] || fail "a half-written file was left behind"

# Ctrl-C while gnuplot draws (one that never ends): what is finished is kept, one line, the code of an interrupt
mkdir tools pictures exported
printf '#!/bin/sh\n: >"%s/drawing"\nexec sleep 300\n' "$work" >tools/gnuplot
chmod +x tools/gnuplot
# interrupted_drawing <pattern> <command>...: 130 and that line, beside warnings
interrupted_drawing() {
  local pattern=$1 code=0
  shift
  rm -f drawing
  PATH=$work/tools:$PATH setsid "$@" >stdout.txt 2>stderr.txt &
  pid=$!
  for ((wait = 0; wait < 6000; ++wait)); do
    if [ -e drawing ] || ! kill -0 "$pid" 2>/dev/null; then break; fi
    sleep 0.02
  done
  kill -INT -- "-$pid" || fail "$* was over before it drew: $(cat stderr.txt)"
  wait "$pid" || code=$?
  [ "$code" -eq 130 ] || fail "exit code $code instead of 130: $*; said: $(cat stderr.txt)"
  [ "$(grep -vc '^train: warning: ' stderr.txt)" -eq 1 ] || fail "not one line: $(cat stderr.txt)"
  grep -q "$pattern" stderr.txt || fail "said: $(cat stderr.txt)"
}
interrupted_drawing 'the flight is written, pictures are missing' "$pinnquad" fly --samples 40 --out drawn.csv --pictures pictures
[ "$(wc -l <drawn.csv)" -eq 41 ] || fail "the flight was lost"
interrupted_drawing '3 of 3 trainings were finished and kept' "$pinnquad" train --flight flight.csv --out exported --seeds 1 --epochs 4 \
  --block exported/model.block --allow-poor
for file in results.csv report.json model.hpp replay.txt model.block; do [ -s "exported/$file" ] || fail "$file was lost to a picture"; done
[ -z "$(find pictures exported -name '*.partial*')" ] || fail "a half-written file was left behind"

# evaluate writes nothing that could be half there: it ends at once, however long the flight
awk -F, -v OFS=, 'NR == 1 { print; next } { row[NR] = $0; t[NR] = $1 }
  END { step = t[3] - t[2]; for (copy = 0; copy < 80; ++copy) for (i = 2; i <= NR; ++i) { $0 = row[i]; $1 = step * n++; print } }' \
  flight.csv >long.csv
setsid "$pinnquad" evaluate exported/model.hpp --flight long.csv --json >stdout.txt 2>stderr.txt &
pid=$!
sleep 0.5
for ((again = 0; again < 20; ++again)); do # a signal that comes before the program listens is lost
  kill -INT "$pid" 2>/dev/null || break
  sleep 0.1
done
code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code of an interrupted evaluate; said: $(cat stderr.txt)"
[ ! -s stdout.txt ] || fail "an interrupted evaluate printed figures: $(head -n 3 stdout.txt)"

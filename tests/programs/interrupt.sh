# SPDX-License-Identifier: MIT
# Ctrl-C in training keeps what is finished: the results are whole, the exit code says that it was interrupted.
source "$(dirname "$0")/common.sh" "$@"

"$fly" --seed 1 --samples 2400 --out flight.csv >/dev/null
mkdir out
# far more work than eight seconds hold on any machine, in pieces of which some are done by then on any
setsid "$train" --flight flight.csv --out out --seeds 500 --epochs 100 --threads 2 >stdout.txt 2>stderr.txt &
pid=$!
sleep 8
kill -INT "$pid"
code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130; said: $(cat stderr.txt)"
grep -qE 'interrupted; [1-9][0-9]* of 1000 trainings were finished and kept' stderr.txt || fail "said: $(cat stderr.txt)"
kept=$(sed -nE 's/.*interrupted; ([0-9]+) of.*/\1/p' stderr.txt)
[ "$(wc -l <out/results.csv)" -eq $((kept + 2)) ] || fail "results.csv does not hold the $kept finished trainings"
[ -s out/model.hpp ] || fail "nothing was exported although trainings were finished"
[ -z "$(find out -name '*.partial*')" ] || fail "a half-written file was left behind"

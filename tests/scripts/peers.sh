#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# peers.sh <repository> <compiler> <working folder>: a user's peer is compiled and timed beside ours, has its rows in the
# table, and is refused where it computes something else or where there is none. Returns 77 without Google Benchmark.
set -euo pipefail
root=$1 compiler=$2 work=$3
fail() { echo "failed: $*"; exit 1; }
echo '#include <benchmark/benchmark.h>' | "$compiler" -E -x c++ - >/dev/null 2>&1 || { echo "skipped: no Google Benchmark"; exit 77; }
rm -rf "$work"
mkdir -p "$work/peers" "$work/results"
cp "$root/tests/scripts/peers/plain_eigen.cpp" "$work/peers"
echo 'set_source_files_properties(${peers} PROPERTIES COMPILE_OPTIONS -DSECOND_MOMENT=0.999F)' >"$work/peers/peers.cmake"

build() {
  cmake -S "$root" -B "$work/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG' -DPINNQUAD_BUILD_BENCH=ON -DPINNQUAD_BUILD_TESTS=OFF \
    -DPINNQUAD_BUILD_EXAMPLES=OFF -DPINNQUAD_BUILD_TOOLS=OFF -DPINNQUAD_BENCH_PEERS="$1" >"$work/log" 2>&1 &&
    cmake --build "$work/build" --target bench_peers >>"$work/log" 2>&1
}

build "$work/peers" || { tail -20 "$work/log"; fail "a peer does not build"; }
for program in bench_peers bench_inference; do # the second stands for a whole run: the table asks for it
  "$work/build/bench/bench_peers" --benchmark_min_time=0.001 --benchmark_repetitions=2 --benchmark_report_aggregates_only=true \
    --benchmark_format=json >"$work/results/native.$program.json"
done
table=$("$root/bench/table.py" "$work/results" native)
for row in 'prediction, plain_eigen over ours' 'training epoch, plain_eigen over ours' 'Predict/plain_eigen' \
  'TrainEpoch/plain_eigen' 'TrainEpoch/vanilla'; do
  grep -qE "^\| $row \| [0-9]" <<<"$table" || fail "no row '$row' in: $table"
done
for wrong in network:Predict trainer:TrainEpoch; do
  if said=$(WRONG=${wrong%:*} "$work/build/bench/bench_peers" 2>&1); then fail "${wrong%:*} is timed"; fi
  [[ $said == "${wrong#*:}/plain_eigen computes something else"* ]] || fail "${wrong%:*}: $said"
done
mkdir "$work/none"
if build "$work/none"; then fail "a folder without a peer builds"; fi
if said=$("$root/bench/run" --peers "$work/none" 2>&1); then fail "bench/run takes a folder without a peer"; fi
[[ $said == *"--peers $work/none: expected a folder of *.cpp"* ]] || fail "bench/run --peers: $said"
echo "a peer is timed, and two with a fault are refused"

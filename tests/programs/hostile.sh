# SPDX-License-Identifier: MIT
# shellcheck shell=bash disable=SC2034,SC2054,SC2154
# Hostile invocations of every program. Each has its exit code, at most one line on stderr, leaves no partial file, and what it
# was given is untouched. All are tried; what went wrong is told at the end, per program.
#   hostile.sh <pinnquad> <source> <work> <compiler> <flags>
#   hostile.sh <as above>... <fly_export> <replay.txt> <model.block>     that program alone
source "$(dirname "$0")/common.sh" "${@:1:5}"
fly_export=${6:-}

declare -A tried wrong
timeout=$(command -v timeout)
env=$(command -v env)
settings=() # of the environment: NAME=value
run_it() { "$timeout" --foreground -s KILL "${HOSTILE_PATIENCE:-20}" ${settings[@]+"$env" "${settings[@]}"} "$@"; } # nobody waits for ever
fly() { run_it "$pinnquad" fly "$@"; }
train() { run_it "$pinnquad" train "$@"; }
study() { run_it "$study" "$@"; }
new() { run_it "$pinnquad" new "$@"; }
pinnquad() { run_it "$pinnquad" "$@"; }
fly_export() { run_it "$fly_export" "$@"; }
demo() { run_it "$source_dir/scripts/demo" "$@"; }

# what the programs are given; copies of it are what they get to see
mkdir given run
"$pinnquad" fly --samples 2200 --out given/flight.csv >/dev/null
"$pinnquad" fly --samples 40 --record-sticks given/sticks.csv --out given/short.csv >/dev/null
: >given/empty.csv
head -c 3000 "$pinnquad" >given/binary.csv
printf 'time_s\0,v_north_m_s\n' >given/nul.csv
tr '\n' ' ' <given/sticks.csv >given/one_line.csv
chmod a-w given/*
if [ -n "$fly_export" ]; then cp "$7" given/replay.txt && cp "$8" given/model.block; fi
cp -r given in
intact=$(sha256sum in/*)

problem() { # <what>: of the last command
  echo "WRONG: $1: ${command[*]@Q}; said: $(head -c 300 stderr.txt)" | head -c 600 >&2
  echo >&2
  bad=1
}
# expect <exit code> <files|nothing> <command>...: what may be left in run/
expect() {
  local code=$1 left=$2 actual=0 lines word there
  shift 2
  count
  command=("$@")
  "$@" >stdout.txt 2>stderr.txt || actual=$?
  sed -i '/^train: warning: /d' stderr.txt # of a poor network: one epoch makes no other
  for word in "$@"; do
    case $word in fly | train | study | new | pinnquad | fly_export | demo) program=$word && break ;; esac
  done
  [ "$actual" -eq "$code" ] || problem "exit code $actual instead of $code"
  lines=$(wc -l <stderr.txt)
  if [ "$code" -eq 0 ]; then
    [ "$lines" -eq 0 ] || problem "speaks on stderr"
  elif [ "$lines" -ne 1 ] && [ "$stderr_is_there" = yes ]; then
    problem "$lines lines on stderr"
  fi
  if LC_ALL=C grep -qaP '[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xa8-\xae]' stderr.txt; then problem "steers the terminal"; fi
  there=$(find run ./*.partial-* -type f ! -name hard ! -name flight_hard ! -name large.csv ! -name mine.partial-1 2>/dev/null || true)
  if [ "$left" = nothing ] && [ -n "$there" ]; then problem "left ${there//$'\n'/ }"; fi
  if [[ $there == *.partial-* || $(echo in/*) == *.partial-* ]]; then problem "left a partial file"; fi
  if [ "$(sha256sum in/*)" != "$intact" ]; then
    problem "an input was changed"
    rm -rf in
    cp -r given in
  fi
}
bad=0 program=none
count() { # the last command, after all was looked at
  tried[$program]=$((${tried[$program]:-0} + 1))
  wrong[$program]=$((${wrong[$program]:-0} + bad))
  bad=0
}
stderr_is_there=yes
refused() { expect 2 nothing "$@"; fresh; }
accepted() { expect 0 files "$@"; fresh; }
fresh() { rm -rf run && mkdir run; }

# surroundings
closed_stdin() { "$@" <&-; }
closed_stdout() { "$@" >&-; }
closed_stderr() { "$@" 2>&-; }
all_closed() { "$@" <&- >&- 2>&-; }
full_stdout() { "$@" >/dev/full; }
reader_left() { { "$@"; code_=$?; echo "$code_" >code.txt; } | :; return "$(cat code.txt)"; }
into() { "${@:2}" >"$1"; }
full_disk() { (trap '' XFSZ; ulimit -f "$blocks"; "$@"); }
full_disk_signal() { (ulimit -f "$blocks"; "$@"); }
no_threads() { (ulimit -s 4000000 && ulimit -v 3500000; "$@"); }
one_thread() { (ulimit -s 1500000 && ulimit -v 2800000; "$@"); }
few_files() ( # whatever files the caller left open
  for ((file = 3; file < 250; ++file)); do eval "exec $file<&-"; done
  ulimit -n 4
  "$@"
)
in_surroundings() { # <NAME=value>... -- <command>
  settings=()
  while [ "$1" != -- ]; do settings+=("$1") && shift; done
  shift
  local code=0
  "$@" || code=$?
  settings=()
  return "$code"
}
blocks=1

whole_numbers=('' ' ' -1 +1 1.5 0x10 010 1e3 nan 99999999999999999999999 many '1 2' ٣ $'\xff' $'1\n' '1;2' "$(printf '9%.0s' {1..3000})")
numbers=('' ' ' nan -nan inf -inf 1e999 0x10 1,5 much '0 1' ٣ $'\xff' $'0\n' -1e-9 +0.5 1e-9999x)
each_value() { # <name of the array> <command>...
  local -n values=$1
  local value
  shift
  for value in "${values[@]}"; do refused "$@" "$value"; done
}

unwritable=(. / .. /dev/null /dev/full /dev/stdout /proc/f.csv /dev/null/f.csv run/absent/f.csv in/short.csv/f.csv run/absent/
  run/folder run/fifo run/dangling run/loop '' "run/$(printf 'n%.0s' {1..256})" "$(printf 'run/%.0s' {1..1500})f.csv")
hostile_places() {
  mkdir run/folder
  mkfifo run/fifo
  ln -s nowhere run/dangling
  ln -s loop run/loop
  ln -s ../in/sticks.csv run/link
  ln in/sticks.csv run/hard
  ln -s ../in/flight.csv run/flight_link
  ln in/flight.csv run/flight_hard
}
left_alone() { # as refused, with places in run/
  hostile_places
  expect 2 nothing "$@"
  fresh
}
unreadable=('' . / /dev/null /dev/zero /dev/random /proc/self/mem run/fifo run/folder run/dangling run/loop run/absent in/empty.csv in/binary.csv in/nul.csv
  in/one_line.csv in/short.csv/x "$(printf 'n%.0s' {1..256})" "$(printf 'run/%.0s' {1..1500})f.csv" $'\xff' $'a\nb')
few=(fly --samples 20)
short=(--seeds 1 --epochs 1)
one=(train --flight in/flight.csv "${short[@]}")

hostile_fly() {
  for option in --samples --statistics; do each_value whole_numbers fly --out run/f.csv $option; done
  each_value whole_numbers "${few[@]}" --out run/f.csv --seed
  for option in --gyro-noise --latency --jitter --stick-interval; do each_value numbers "${few[@]}" --out run/f.csv $option; done
  each_value numbers "${few[@]}" --out run/f.csv --max-speed
  for words in '--samples 0' '--samples 10000001' '--statistics 100001' '--latency 1000.001' '--max-speed 0.4' '--seed 1 --seed 2' \
    '--no-such-option' '-x' 'd1 d2' 'D1' '--airframe' '--seed' '--ground-effect ?' '--seed 18446744073709551616' \
    '--seed 18446744073709551615' '--latency 5ms' '--out run/g.csv'; do
    # shellcheck disable=SC2086
    refused "${few[@]}" --out run/f.csv $words
  done
  for text in '' ' ' $'d1\n' $'\xff' $'\xc2\x9b31m' $'\xe2\x80\xae1d' D1 d1,d2 "$(printf 'd%.0s' {1..5000})"; do
    refused "${few[@]}" "$text" --out run/f.csv
    refused "${few[@]}" --airframe "$text" --out run/f.csv
    if [ -n "$text" ]; then refused "${few[@]}" --ground-effect "$text" --out run/f.csv; fi
  done
  accepted "${few[@]}" --seed 9223372036854775807 --latency 0.5 --jitter 1e1 --gyro-noise .01 --out run/f.csv

  for path in "${unwritable[@]}"; do
    left_alone "${few[@]}" --out "$path"
    left_alone "${few[@]}" --record-sticks "$path"
    left_alone fly --statistics 1 --samples 5 --out "$path"
    left_alone "${few[@]}" --out run/x.csv --replay "$path"
  done
  for path in '' /dev/null in/short.csv /proc/pictures run/absent/pictures run/fifo run/dangling run/loop; do
    left_alone "${few[@]}" --pictures "$path"
  done
  sticks=in/sticks.csv
  for path in $sticks ./$sticks "$PWD/$sticks" in/../in//sticks.csv run/link run/hard; do
    left_alone fly --samples 20 --sticks $sticks --out "$path"
    left_alone fly --samples 20 --sticks $sticks --record-sticks "$path"
    left_alone fly --samples 20 --sticks "$path" --out $sticks
    left_alone fly --samples 20 --sticks "$path" --replay $sticks
  done
  for words in '--out run/x --record-sticks run/x' '--out run/x --record-sticks run/./x' '--out run/trajectory.svg --pictures run' \
    '--record-sticks run/wind.svg --pictures run' '--out run/x --pictures run/x' '--out run/x --replay run/../run/x'; do
    # shellcheck disable=SC2086
    refused "${few[@]}" $words
  done
  cp in/sticks.csv run/mine.partial-1
  expect 2 files fly --samples 20 --sticks run/mine.partial-1 --out run/mine
  cmp -s in/sticks.csv run/mine.partial-1 || problem "mine.partial-1 was lost"
  fresh
  for path in "${unreadable[@]}"; do left_alone fly --samples 20 --sticks "$path" --out run/f.csv; done
  truncate -s 9G run/large.csv
  expect 2 nothing fly --samples 20 --sticks run/large.csv --out run/f.csv
  fresh
  names=(-x.csv ' ' 'a b' "it's" '"' '*' '$(touch x)' ';' 'flüg ✈.csv' $'\xff\xfe.csv' $'line\nend' $'\e[31m' '%s%n' '\' "$(printf 'n%.0s' {1..240})")
  for name in "${names[@]}"; do accepted fly --samples 20 "--out=run/$name"; done
  accepted "${few[@]}" --out run/f.csv --record-sticks run/s.csv
  : >run/said.txt
  expect 2 files into run/said.txt "${few[@]}" --out run/said.txt
  [ ! -s run/said.txt ] || problem "an output took the place of standard output"
  fresh

  for surroundings in closed_stdin "in_surroundings LC_ALL=garbage --" "in_surroundings LC_ALL=tr_TR.UTF-8 LANG=xx --" "in_surroundings TERM=x COLUMNS=0 --" \
    "in_surroundings TMPDIR=/nonexistent HOME=/nonexistent --" "in_surroundings HOME= PATH=$PATH --" no_threads one_thread; do
    # shellcheck disable=SC2086
    accepted $surroundings "${few[@]}" --out run/f.csv
    # shellcheck disable=SC2086
    accepted $surroundings fly --statistics 3 --samples 5 --out run/t.csv
  done
  # standard output that nobody can read: the files are whole, the exit code tells
  for surroundings in closed_stdout full_stdout; do
    for words in '--samples 20 --out run/f.csv' '--statistics 2 --samples 5 --out run/f.csv' --help --version --list-airframes; do
      # shellcheck disable=SC2086
      expect 2 files $surroundings fly $words
      [ ! -e run/f.csv ] || head -n 1 run/f.csv | grep -qE '^(t,vdot|seed,rows)' || problem "what is printed is in the file"
      fresh
    done
  done
  expect 2 files reader_left fly --statistics 100 --samples 2 --out run/f.csv
  fresh
  stderr_is_there=no
  accepted closed_stderr "${few[@]}" --out run/f.csv
  expect 2 nothing closed_stderr "${few[@]}" --out run/absent/f.csv
  expect 2 nothing all_closed "${few[@]}" --out run/absent/f.csv
  stderr_is_there=yes
  # a full disk
  for disk in full_disk full_disk_signal; do
    blocks=1
    expect 2 nothing $disk fly --samples 100 --out run/f.csv
    expect 2 nothing $disk fly --statistics 100 --samples 2 --out run/f.csv
    expect 2 nothing $disk fly --samples 40 --record-sticks run/s.csv
    if command -v gnuplot >/dev/null; then
      for blocks in 1 20 40 60; do # each picture is larger than the one before it
        expect 2 files $disk fly d2 --samples 400 --pictures run
        for picture in run/*; do
          [ ! -e "$picture" ] || tail -c 8 "$picture" | grep -q '</svg>' || problem "$picture is cut"
        done
        fresh
      done
    fi
  done
  expect 1 nothing in_surroundings PATH=/nonexistent:/usr/nowhere -- fly --samples 40 --pictures run
  expect 2 nothing few_files "${few[@]}" --out run/f.csv
}

hostile_train() {
  each_value whole_numbers train --flight in/flight.csv --out run/o --epochs 1 --seeds
  each_value whole_numbers train --flight in/flight.csv --out run/o --seeds 1 --epochs
  for option in --seed --threads; do each_value whole_numbers "${one[@]}" --out run/o $option; done
  for words in '--epochs 0' '--epochs 100001' '--seeds 0' '--threads 0' '--threads 1025' '--no-such-option' 'x' '--flight in/short.csv' \
    '--airframe' '--seed 18446744073709551615'; do
    # shellcheck disable=SC2086
    refused train --flight in/flight.csv --out run/o $words
  done
  for text in '' ' ' 3rd $'\xc2\x9b31m' $'\xe2\x80\xaemodel' 'a b' 'a;b' ü $'a\nb' 'a::b' "$(printf '9%.0s' {1..3000})"; do refused "${one[@]}" --out run/o --name "$text"; done
  for path in "${unreadable[@]}" in/sticks.csv; do left_alone train --flight "$path" "${short[@]}" --out run/o; done
  for path in '' in/short.csv in/short.csv/x /dev/null /dev/null/x /proc/x run/fifo run/dangling run/loop "run/$(printf 'n%.0s' {1..256})"; do
    left_alone "${one[@]}" --out "$path"
  done
  for path in "${unwritable[@]}" in/flight.csv ./in/flight.csv "$PWD/in/flight.csv" run/flight_link run/flight_hard run/o/results.csv run/o/model.hpp \
    run/./o/../o/replay.txt run/o; do
    left_alone "${one[@]}" --out run/o --block "$path"
  done
  for name in results.csv report.json ellipses.svg errors.svg prediction.svg model.hpp replay.txt; do
    cp in/flight.csv "run/$name"
    expect 2 files train --flight "run/$name" "${short[@]}" --out run
    cmp -s in/flight.csv "run/$name" || problem "the flight was lost"
    fresh
    ln -s ../in/flight.csv "run/$name"
    expect 2 nothing "${one[@]}" --out run
    fresh
    mkdir "run/$name"
    expect 2 nothing "${one[@]}" --out run
    fresh
  done
  for name in "it's *.csv" '"quoted".csv' 'flüg ✈.csv' $'\xff\xfe.csv' $'line\nend.csv' '\'; do
    cp in/flight.csv "run/$name"
    accepted train --flight "run/$name" "${short[@]}" --out "run/out of $name"
  done
  for surroundings in closed_stdin "in_surroundings LC_ALL=garbage --" "in_surroundings HOME=/nonexistent TMPDIR=/nonexistent --" no_threads one_thread; do
    # shellcheck disable=SC2086
    accepted $surroundings "${one[@]}" --out run/o
  done
  for surroundings in closed_stdout full_stdout reader_left; do
    expect 2 files $surroundings "${one[@]}" --out run/o --block run/o/model.block
    for name in model.hpp model.block replay.txt results.csv; do [ -s "run/o/$name" ] || problem "$name was lost"; done
    if grep -qsF '[3/5]' run/o/*; then problem "what is printed is in a file"; fi
    fresh
  done
  for blocks in 1 8 60 400; do # the last: header and replay fit, not every picture
    for disk in full_disk full_disk_signal; do
      expect 2 files $disk "${one[@]}" --out run/o
      for picture in run/o/*.svg; do [ ! -e "$picture" ] || tail -c 8 "$picture" | grep -q '</svg>' || problem "$picture is cut"; done
      if [ "$blocks" -eq 400 ]; then
        for name in model.hpp replay.txt; do [ -s "run/o/$name" ] || problem "$name was lost to a picture"; done
        [ ! -e run/o/ellipses.svg ] || problem "the pictures fit: this check needs fewer blocks"
      fi
      fresh
    done
  done
  expect 2 nothing few_files "${one[@]}" --out run/o
  fresh
  mkdir run/o
  exec 9<run/o
  flock 9
  expect 2 nothing "${one[@]}" --out run/o
  grep -q 'another program is at work' stderr.txt || problem "does not say why"
  exec 9<&-
  fresh
}

hostile_study() {
  each_value whole_numbers study paper --models 1 --epochs 1 --out run/o --seeds
  each_value whole_numbers study paper --models 1 --seeds 1 --out run/o --epochs
  for option in --flights --flight-seed --patience --threads; do
    each_value whole_numbers study paper --models 1 --shard 2/2 "${short[@]}" --out run/o $option
  done
  for words in '--models 0' '--models 15' '--models 1,' '--models 1-' '--models 010' '--models +1' '--shard 0/1' '--shard 2' '--shard 3/2' '--shard 1/2/3' \
    '--weights worst' '--seeds 0' '--flights 0' '--flights 1001' '--epochs 0' 'x' 'ablation' '--no-such-option'; do
    # shellcheck disable=SC2086
    refused study paper --out run/o $words
  done
  for words in '' 'x' '--seeds 1' 'paper' 'merge' 'merge in' 'ablation' 'ablation --out run/o --variants none' 'merge absent --out run/o' \
    '--out run/o paper' '--out run/o merge absent'; do
    # shellcheck disable=SC2086
    refused study $words
  done
  for words in '' 'absent' 'in/short.csv' 'in x' '--out in'; do
    # shellcheck disable=SC2086
    refused study report $words
  done
  for path in '' in/short.csv in/short.csv/x /dev/null /proc/x run/fifo run/dangling run/loop "run/$(printf 'n%.0s' {1..256})"; do
    left_alone study paper --models 1 "${short[@]}" --out "$path"
    left_alone study report "$path"
    left_alone study merge "$path" --out run/o
  done
  for surroundings in closed_stdout full_stdout; do expect 2 nothing $surroundings study --help; done
}

hostile_new() {
  for path in '' . in in/short.csv in/short.csv/x /dev/null /dev/null/x /proc/x run/fifo run/dangling run/loop "run/$(printf 'n%.0s' {1..256})"; do
    left_alone new "$path"
  done
  for text in '' ' ' 3rd $'\xc2\x9b31m' 'a b' 'a;b' ü $'a\nb' 'a::b' '");int x("' '{{name}}' "$(printf '9%.0s' {1..3000})"; do refused new run/o --name "$text"; done
  for text in '' ' ' $'d1\n' $'\xff' x.toml in/short.csv; do refused new run/o --airframe "$text"; done
  for path in "${unreadable[@]}" in/sticks.csv; do left_alone new run/o --model "$path"; done
  for name in ' ' 'a b' "it's" '"' '*' '$(touch x)' ';' 'flüg ✈' $'\xff\xfe' $'line\nend' $'\e[31m' '%s%n' '\'; do accepted new "run/$name"; done
  mkdir run/o
  mkfifo run/o/fifo
  expect 2 nothing new run/o
  fresh
  for disk in full_disk full_disk_signal; do
    blocks=1
    expect 2 nothing $disk new run/o/deep
    [ ! -e run/o ] || problem "left $(find run/o)"
  done
  for surroundings in closed_stdout full_stdout; do expect 2 files $surroundings new run/o && [ -s run/o/main.cpp ] || problem "nothing was written" && fresh; done
  expect 2 nothing few_files new run/o
}

hostile_demo() { # refused before anything is built
  for option in --seeds --epochs --seed; do each_value whole_numbers demo --out run/o $option; done
  for words in '--seeds 0' '--seeds 501' '--epochs 0' '--epochs 100001' '--seed' '--no-such-option' 'x' '--log in/flight.csv' \
    '--airframe paper_quadrotor' '--log absent --airframe paper_quadrotor' '--log in --airframe paper_quadrotor' '--out'; do
    # shellcheck disable=SC2086
    refused demo $words
  done
  for path in '' in/short.csv in/short.csv/x /dev/null /proc/x run/fifo run/dangling run/loop "run/$(printf 'n%.0s' {1..256})"; do
    left_alone demo --out "$path"
    left_alone demo --out run/o --airframe paper_quadrotor --log "$path/"
  done
}

hostile_export() {
  for path in "${unreadable[@]}" in/sticks.csv in/model.block; do
    left_alone fly_export --replay "$path"
    [ "$path" = in/model.block ] || left_alone fly_export --replay in/replay.txt --block "$path"
  done
  for words in '' '--block in/model.block' '--replay in/replay.txt x' '--replay' '--no-such-option'; do
    # shellcheck disable=SC2086
    refused fly_export $words
  done
  expect 2 nothing closed_stdout fly_export --help
  expect 2 nothing full_stdout fly_export --version
}

if [ -n "$fly_export" ]; then
  hostile_export
else
  hostile_fly
  hostile_train
  hostile_study
  hostile_new
  hostile_demo
fi
count
unset 'tried[none]' 'wrong[none]'
for program in "${!tried[@]}"; do echo "$program: ${tried[$program]} hostile invocations, ${wrong[$program]} went wrong"; done
for program in "${!wrong[@]}"; do [ "${wrong[$program]}" -eq 0 ] || fail "see above"; done

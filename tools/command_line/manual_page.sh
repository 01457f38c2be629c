#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Writes the manual page of pinnquad, or of pinnquad-study, from what the program says of itself: help2man's page of --help
# and --version, with a section for the commands, what they take and when they fail.
#   manual_page.sh PROGRAM PAGE
set -euo pipefail
program=$(realpath -- "$1") page=$2
name=${program##*/}
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

# as_roff <command>...: its --help without what every command has
as_roff() {
  "$program" "$@" --help | awk -v name="$name $*" '
    function roff(text) {
      gsub(/\\/, "\\e", text)
      gsub(/-/, "\\-", text)
      return text ~ /^[.\047]/ ? "\\&" text : text
    }
    function say(text) { print roff(text) }
    BEGIN { print ".SS \"" roff(name) "\""; part = "text" }
    /^(Arguments|Options|Commands):/ { part = $0; next }
    /^$/ { part = "text"; next }
    /^Usage: / { print ".PP"; print ".B " roff(substr($0, 8)); next }
    part == "Commands:" { next }
    part ~ /^(Arguments|Options):/ && /^  [^ ]/ {
      hidden = /^  (-h,--help|--version)  /
      if (hidden) next
      text = substr($0, 3)
      sub(/ +$/, "", text)
      at = match(text, /  +/)
      print ".TP"
      print ".B " roff(at ? substr(text, 1, at - 1) : text)
      if (at) say(substr(text, at + RLENGTH))
      next
    }
    part ~ /^(Arguments|Options):/ && hidden { next }
    part ~ /^(Arguments|Options):/ && /^ +[a-z0-9]+: / { print ".br" }
    /^Examples:/ { print ".PP"; print "Examples:"; print ".nf"; part = "examples"; next }
    part == "examples" && !/^ / { print ".fi"; part = "text"; print ".PP" }
    /^Exit codes:/ { print ".PP" }
    { sub(/^ +/, part == "examples" ? "  " : ""); say($0) }
    END { if (part == "examples") print ".fi" }'
}

# commands <command>...: those below it
commands() { "$program" "$@" --help | sed '1,/^Commands:/d' | awk '/^  [a-z]/ { print $1 } /^[^ ]/ { exit }'; }

{
  echo '[COMMANDS]'
  for command in $(commands); do
    as_roff "$command"
    for part in $(commands "$command"); do as_roff "$command" "$part"; done
  done
  cat <<'TEXT'

[OPTIONS FROM A FILE]
.B \-\-config
.I FILE.toml
takes a table per command and an entry per option, named as on the command line; a flag is true or false, several values are a list:
.PP
.nf
TEXT
  if [ "$name" = pinnquad ]; then
    cat <<'TEXT'
  [fly]
  flight = "d3"
  samples = 5000
  max\-speed = 5.5

  [train]
  flight = ["d1.csv", "d3.csv", "d5.csv"]
  allow\-poor = true
TEXT
  else
    cat <<'TEXT'
  [paper]
  models = "2,4"
  seeds = 3
TEXT
  fi
  cat <<'TEXT'
.fi
.PP
What stands on the command line goes first. A name or a value that the command would refuse is told with line and column.

[FILES]
TEXT
  if [ "$name" = pinnquad ]; then
    cat <<'TEXT'
.TP
.I share/pinnquad/watch.json
beside the program's folder bin: the page that
.B pinnquad fly \-\-watch
and
.B pinnquad train
fill.
.TP
.I share/pinnquad/charts.json
beside it: what draws the charts of a training's page; without it they are tables.
TEXT
  fi
  cat <<TEXT
.TP
.I share/bash-completion/completions/$name
completes commands and options in bash.
.PP
An output appears whole or not at all: it is written as
.IR FILE.partial\\-N ,
then gets its name.

[EXIT STATUS]
.TP
.B 0
good.
.TP
.B 1
It ran, but the answer is no: a flight that ended early, a model that is worse than the mean of the commands, parts that are missing.
.TP
.B 2
Bad input, or a file that can't be read or written: one line on standard error says where and what was expected.
.TP
.B 3
Undecided.
.TP
.B 70
A fault of the program itself: one line on standard error says which; please report it.
.TP
.B 130
Interrupted by Ctrl\\-C; what is finished is kept, as the command says.
TEXT
  if [ "$name" = pinnquad ]; then
    cat <<'TEXT'

[ENVIRONMENT]
.TP
.B PINNQUAD_INSTRUCTION_SET
x86\-64, x86\-64\-v3 or x86\-64\-v4: the build of the program that runs, in place of the best that the processor can run.
TEXT
  fi
} >"$work/include"

# what help2man reads: commands and exit codes stand in sections of their own
printf '#!/bin/sh\n"%s" "$@" | sed "/^Commands:/,/^$/d; /^pinnquad[-a-z]* COMMAND/,\\$d"\n' "$program" >"$work/$name"
chmod +x "$work/$name"
what="from a quadrotor's flight to a network that may fly"
[ "$name" = pinnquad ] || what="the paper's study of pinnquad: its models trained and judged, seed by seed"
version=$("$program" --version | sed -n '1s/.* //p') # without this machine's instruction set
(cd -- "$work" && help2man --no-info --version-string "$version" --section 1 --name "$what" --include include "./$name" >page)
mv -- "$work/page" "$page"

#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# options.sh <repository>: --help of the commands states every exit code; a wrong option is one line and code 2; and a caller's
# CDPATH, which cd prints what it finds by, turns no script away from its repository.
set -euo pipefail
cd -- "$1"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
export CDPATH=$PWD
for script in scripts/test scripts/demo scripts/bare_machine scripts/models; do
  help=$("$script" --help) || fail "$script --help: exit code $?"
  codes=$(sed -n '/^Exit code/,$p' <<<"$help")
  for code in 0 1 2 130; do
    grep -qE "(^|[^0-9])$code " <<<"$codes" || fail "$script --help does not say what exit code $code means"
  done
  code=0
  said=$("$script" --no-such-option 2>&1 >/dev/null) || code=$?
  [ "$code" -eq 2 ] || fail "$script --no-such-option: exit code $code"
  [ "$said" = "${script##*/}: unknown option '--no-such-option' (see --help)" ] || fail "$script said: $said"
done
bench/run --help >/dev/null || fail "bench/run --help: exit code $?"
# those that do their work as soon as they are called
for script in scripts/heavy/* .ci/run; do
  awk '/^unset CDPATH$/ { unset_ = 1 } /(^|[^a-z])cd / && !/^#/ && !unset_ { exit 1 }' "$script" || fail "$script goes where CDPATH says"
done
grep -q 'nothing was exported' <<<"$(scripts/demo --help)" || fail "scripts/demo --help does not say what train's code 1 is"

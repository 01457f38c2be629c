#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# options.sh <repository>: --help of the two commands states every exit code; a wrong option is one line and code 2.
set -euo pipefail
cd -- "$1"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}
for script in scripts/test scripts/demo scripts/bare_machine; do
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

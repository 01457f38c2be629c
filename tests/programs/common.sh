# SPDX-License-Identifier: MIT
# Arguments and checks that the program tests share.
set -euo pipefail
pinnquad=$1
study=${1%/*}/pinnquad-study # is beside it
source_dir=$2
work=$3
compiler=$4
compiler_flags=$5
rm -rf "$work"
mkdir -p "$work"
cd "$work"

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# expect_line <exit code> <regular expression> <command>...: that code, one line on stderr that matches, nothing on stdout. Lines
# of progress, which come after 5 s of work, do not count.
expect_line() {
  local code=$1 pattern=$2 actual=0
  shift 2
  "$@" >stdout.txt 2>stderr.txt || actual=$?
  [ "$actual" -eq "$code" ] || fail "exit code $actual instead of $code: $*; said: $(cat stderr.txt)"
  sed -i -E '/^[^:]+: [ 0-9]{3} %(, [0-9]+ s left)?$/d' stderr.txt
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "not one line on stderr: $*; said: $(cat stderr.txt)"
  grep -qE -- "$pattern" stderr.txt || fail "stderr does not match '$pattern': $(cat stderr.txt)"
}

# where a compiler finds Eigen
eigen=$(pkg-config --variable=includedir eigen3 2>/dev/null || true)/eigen3
[ -d "$eigen/Eigen" ] || eigen=/usr/include/eigen3

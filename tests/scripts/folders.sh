#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# folders.sh <repository> <working folder>: a relative folder is the caller's, called from elsewhere too; what was there before is
# neither taken nor removed; one demo at a time works in build/demo. What the scripts call is stood in for.
set -euo pipefail
root=$1 work=$2
rm -rf -- "$work"
mkdir -p "$work/tools" "$work/repository/docs" "$work/repository/bench" "$work/other"
cp -r "$root/scripts" "$work/repository"
cp "$root/bench/run" "$work/repository/bench"
cd "$work/other"

fail() {
  echo "FAILED: $*; said: $(cat "$work/said.txt")" >&2
  exit 1
}
# tool <name>: its text on stdin
tool() {
  { echo "#!$(command -v bash)"; cat; } >"$work/tools/$1"
  chmod +x "$work/tools/$1"
}
tool id <<<'echo 0'
tool unshare </dev/null
tool chroot </dev/null
tool dpkg-query <<<'echo -n installed'
tool apt-get <<<'echo Debian http://nowhere bookworm'
tool apt-config </dev/null
tool git </dev/null
tool debootstrap <<<'exit 1'
tool cmake <<<'exit 1'
for name in g++ ninja python3; do tool "$name" </dev/null; done
export PATH=$work/tools:$PATH TMPDIR=$work
unset CI

# call <exit code> <script> <argument>...: from other/
call() {
  local expected=$1 script=$2 code=0
  shift 2
  "../repository/$script" "$@" >"$work/said.txt" 2>&1 </dev/null || code=$?
  [ "$code" -eq "$expected" ] || fail "exit code $code instead of $expected: $script $*"
}

echo kept >../repository/docs/start.md
echo kept >docs.log
call 0 scripts/bare_machine --dir docs # debootstrap fails: skipped
grep -q 'SKIPPED.*debootstrap failed' ../said.txt || fail "it did not come to debootstrap"
[ -s ../repository/docs/start.md ] || fail "bare_machine --dir docs removed the repository's docs"
[ ! -e docs ] || fail "bare_machine left its folder behind"
[ "$(cat docs.log)" = kept ] || fail "bare_machine wrote over docs.log"
mkdir mine
ln -s nowhere dangling
for taken in mine mine/ dangling ../repository/docs docs.log/x ''; do
  call 2 scripts/bare_machine --dir "$taken"
  [ "$(wc -l <../said.txt)" -eq 1 ] || fail "not one line"
done
call 2 scripts/bare_machine --suite ../mine
[ "$(wc -l <../said.txt)" -eq 1 ] || fail "not one line"
# a fault outside fails no continuous integration, and is said
CI=1 call 0 scripts/heavy/newest_compilers
grep -q 'SKIPPED.*debootstrap failed' ../said.txt || fail "newest_compilers does not say that it tried nothing"
[ -d mine ] && [ -L dangling ] && [ -s ../repository/docs/start.md ] || fail "a folder that was there before is gone"

call 1 bench/run --out figures # cmake fails
if [ ! -d figures ] || [ -e ../repository/figures ]; then fail "bench/run --out figures wrote elsewhere"; fi

CXX=false call 1 scripts/demo --out demo_out
mkdir -p ../repository/build/demo
exec 9>../repository/build/demo/lock
flock 9
call 2 scripts/demo --out demo_out
grep -q '^demo: another demo is at work in .*/build/demo$' ../said.txt || fail "does not say why"
[ "$(wc -l <../said.txt)" -eq 1 ] || fail "not one line"
exec 9>&-

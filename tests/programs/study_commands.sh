# SPDX-License-Identifier: MIT
# The command line of pinnquad-study, and its end by a hangup.
source "$(dirname "$0")/common.sh" "$@"

number() { sed -n "s/^#define PINNQUAD_VERSION_$1 \([0-9]*\)$/\1/p" "$source_dir/include/pinnquad/version.hpp"; }
[ "$("$study" --version)" = "pinnquad-study $(number MAJOR).$(number MINOR).$(number PATCH)" ] || fail "$("$study" --version)"
for command in "" paper ablation beyond merge report; do
  # shellcheck disable=SC2086 # several words, or none
  "$study" $command --help >help.txt || fail "pinnquad-study $command --help: exit code $?"
  grep -qE '^Exit codes: 0' help.txt || fail "pinnquad-study $command --help does not name its exit codes"
done
if command -v help2man >/dev/null; then
  bash "$source_dir/tools/command_line/manual_page.sh" "$study" pinnquad-study.1
  for section in NAME OPTIONS EXAMPLES 'EXIT STATUS'; do
    grep -qE "^\.SH \"?$section\"?$" pinnquad-study.1 || fail "the manual page has no section $section"
  done
  for command in paper ablation beyond merge report; do
    grep -qF ".SS \"pinnquad\\-study $command\"" pinnquad-study.1 || fail "the manual page has no $command"
  done
  ! grep -nE '^(Usage|Commands|Arguments|Options):|^Subcommands' pinnquad-study.1 || fail "pieces of --help in the manual page"
fi
# shellcheck source=../../tools/command_line/completion.bash
source "$source_dir/tools/command_line/completion.bash"
COMP_WORDS=("$study" paper --mo) COMP_CWORD=2
_pinnquad
[ "${COMPREPLY[*]}" = --models ] || fail "paper --mo is completed to: ${COMPREPLY[*]}"

expect_line 2 '^pinnquad-study: expected a command: paper, ablation, beyond, merge, report' "$study"
expect_line 2 "^pinnquad-study: no command named 'news'; known: paper, ablation, beyond, merge, report$" "$study" news
expect_line 2 '^paper: The following argument was not expected: ablation' "$study" paper --out o ablation
expect_line 2 '^report: dir is required' "$study" report
for value in nan 0 -1 0/1 2/1 1/0x10 1/-1 1/1e400; do
  for kind in paper ablation beyond; do
    expect_line 2 "^$kind: --shard .*expected i/n" timeout 20 "$study" "$kind" --out o --shard "$value"
  done
done
expect_line 2 "^paper: --models: expected TEXT, found ''" timeout 20 "$study" paper --models '' --out o
printf '[paper]\nmodels = "2,15"\n' >options.toml
expect_line 2 '^paper: .*no model 15 in Table 2' "$study" paper --config options.toml --out o
[ ! -e o ] || fail "a study was begun"

# the terminal that closes is no other: a first signal keeps what is finished; under nohup it is none
hung_up() { # <command>...: hung up once it has said how far it is
  : >stderr.txt  # what the command before said is not this one's
  setsid "$@" >stdout.txt 2>stderr.txt &
  pid=$!
  for ((wait = 0; wait < 2400; ++wait)); do
    if grep -q ' %' stderr.txt || ! kill -0 "$pid" 2>/dev/null; then break; fi
    sleep 0.1
  done
  kill -HUP "$pid"
  code=0
}
hung_up "$study" paper --models 2 --flights 1 --seeds 500 --epochs 30 --threads 2 --out hung
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130 after a hangup; said: $(cat stderr.txt)"
grep -qE 'interrupted; [0-9]+ of 500 trainings are in hung/rows.csv' stderr.txt || fail "said: $(cat stderr.txt)"
[ -z "$(find hung -name '*.partial*')" ] || fail "a half-written file was left behind"
hung_up nohup "$study" paper --models 2 --flights 1 --seeds 500 --epochs 30 --threads 2 --out hung_nohup
sleep 0.5
kill -0 "$pid" 2>/dev/null || fail "a hangup ended what runs under nohup: $(cat stderr.txt)"
kill -INT "$pid"
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code instead of 130; said: $(cat stderr.txt)"

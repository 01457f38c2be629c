# SPDX-License-Identifier: MIT
# The command line itself: commands and their help, --version, options from a file by --config.
source "$(dirname "$0")/common.sh" "$@"

number() { sed -n "s/^#define PINNQUAD_VERSION_$1 \([0-9]*\)$/\1/p" "$source_dir/include/pinnquad/version.hpp"; }
version="pinnquad $(number MAJOR).$(number MINOR).$(number PATCH)"
# a command is a header of that name in a room of tools/; those of report/ and study/ are pinnquad-study's
mapfile -t top < <(find "$source_dir/tools"/*/ -name '*_command.hpp' | grep -vE '/tools/+(report|study)/+[^/]*$' | sed 's|.*/||; s|_command.hpp$||' | sort)
[ ${#top[@]} -ge 9 ] || fail "tools/ has the headers of ${#top[@]} commands"
commands=("" "${top[@]}" "airframe list" "airframe check" "airframe convert")
for command in "${commands[@]}"; do
  # shellcheck disable=SC2086 # several words
  "$pinnquad" $command --help >help.txt 2>stderr.txt || fail "pinnquad $command --help: exit code $?"
  [ ! -s stderr.txt ] || fail "pinnquad $command --help speaks on stderr"
  grep -qE '^Exit codes: 0' help.txt || fail "pinnquad $command --help does not name its exit codes"
  tr '\n' ' ' <help.txt | grep -qE '[^0-9]2 bad input' || fail "pinnquad $command --help does not say what 2 is"
  ! grep -nE '^([^ ]| {20}).{80}' help.txt || fail "pinnquad $command --help is wider than a terminal"
  # shellcheck disable=SC2086
  [ "$("$pinnquad" $command --version)" = "$version" ] || fail "pinnquad $command --version"
done
for command in "${top[@]}"; do
  "$pinnquad" --help | grep -qE "^  $command  " || fail "pinnquad --help does not name $command"
done

for command in "" fly evaluate certify replay block import airframe "airframe list" "airframe check" "airframe convert" new; do
  # shellcheck disable=SC2086
  "$pinnquad" $command --help | grep -A1 '^Examples:$' | grep -qE "^  (pinnquad|cmake) " || fail "pinnquad $command --help has no example"
done
"$pinnquad" train --help >help.txt # whole: grep -q closes a pipe at the first match
grep -qE '^  --flight FILE\.csv \.\.\.( |$)' help.txt || fail "train --help says of --flight: $(grep -e --flight help.txt)"

# completion, as bash asks for it
complete_words() { # <what the last word may become> <word>...
  local expected=$1
  shift
  COMP_WORDS=("$pinnquad" "$@") COMP_CWORD=$#
  COMPREPLY=()
  _pinnquad
  [ "${COMPREPLY[*]}" = "$expected" ] || fail "$* is completed to: ${COMPREPLY[*]}"
}
# shellcheck source=../../tools/command_line/completion.bash
source "$source_dir/tools/command_line/completion.bash"
complete_words 'fly' f
complete_words 'new' n
complete_words '--airframe' new x --air
complete_words 'convert' airframe con
complete_words '--samples' fly d1 --sam
complete_words '--config' train --seeds 3 --conf
complete_words '' fly d1 --out 'fi'

# the manual page: its sections, every command, every option of a command once
if command -v help2man >/dev/null; then
  bash "$source_dir/tools/command_line/manual_page.sh" "$pinnquad" pinnquad.1
  for section in NAME SYNOPSIS DESCRIPTION OPTIONS EXAMPLES COMMANDS 'OPTIONS FROM A FILE' FILES 'EXIT STATUS'; do
    grep -qE "^\.SH \"?$section\"?$" pinnquad.1 || fail "the manual page has no section $section"
  done
  for command in "${commands[@]:1}"; do
    sed -n "/^\.SS \"pinnquad $command\"$/,/^\.S[HS]/p" pinnquad.1 | sed 's/\\-/-/g' >part.txt
    [ -s part.txt ] || fail "the manual page has no $command"
    # shellcheck disable=SC2086
    "$pinnquad" $command --help | grep -oE '^  --[a-z-]+' | grep -vx -e '  --version' >options.txt || true
    while read -r option; do
      [ "$(grep -cE "^\.B ${option#  }( |$)" part.txt)" -eq 1 ] || fail "the manual page says of $command $option: $(cat part.txt)"
    done <options.txt
    grep -q '^Exit codes: 0' part.txt || fail "the manual page does not say when $command fails"
  done
  ! grep -nE '^(Usage|Commands|Arguments|Options):|^Subcommands' pinnquad.1 || fail "pieces of --help in the manual page"
  if command -v man >/dev/null; then
    LC_ALL=C MANWIDTH=80 man --warnings -l pinnquad.1 2>warnings.txt >page.txt || fail "man does not show the page: $(cat warnings.txt)"
    [ ! -s warnings.txt ] || fail "the manual page: $(cat warnings.txt)"
  fi
fi

expect_line 2 '^pinnquad: expected a command: fly, import, train, evaluate, certify' "$pinnquad"
expect_line 2 "^pinnquad: no command named 'land'; known: fly, import, train, evaluate, certify" "$pinnquad" land --seed 1
expect_line 2 '^pinnquad: expected a command before --seed: fly, ' "$pinnquad" --seed 1
expect_line 2 "^pinnquad: no command named 'study'; known: fly, .*; the paper's study is the program pinnquad-study" "$pinnquad" study paper
expect_line 2 '^fly: The following argument was not expected: train' "$pinnquad" fly d1 train --out f.csv
expect_line 2 '^fly: The following argument was not expected: --epochs' "$pinnquad" fly d1 --out f.csv --epochs
expect_line 2 '^airframe: The following argument was not expected: check' "$pinnquad" airframe list check
expect_line 2 '^train: --flight, --dataset or --log is required' "$pinnquad" train --seeds 1

# options from a file: the same flight; the command line goes first; it may stand before the command or behind
cat >options.toml <<'EOF'
[fly]
flight = "d3"
seed = 4
samples = 50
max-speed = 5.5

[train]
flight = ["a.csv", "b.csv"]
allow-poor = true
EOF
"$pinnquad" fly d3 --seed 4 --samples 50 --max-speed 5.5 --out words.csv >/dev/null
"$pinnquad" fly --config options.toml --out behind.csv >/dev/null
"$pinnquad" --config options.toml fly --out before.csv >/dev/null
cmp words.csv behind.csv || fail "options from a file fly another flight"
cmp words.csv before.csv || fail "--config before the command flies another flight"
"$pinnquad" fly d3 --seed 5 --samples 50 --max-speed 5.5 --out words.csv >/dev/null
"$pinnquad" fly --seed 5 --config options.toml --out both.csv >/dev/null
cmp words.csv both.csv || fail "the file goes before the command line"
expect_line 2 '^train: a\.csv: expected a readable file, found none' "$pinnquad" train --config options.toml --out o

wrong() { # <pattern> <line>...: of a file for fly
  local pattern=$1
  shift
  printf '%s\n' "$@" >wrong.toml
  expect_line 2 "wrong\.toml$pattern" "$pinnquad" fly --config wrong.toml --samples 20 --out w.csv
  [ ! -e w.csv ] || fail "flew in spite of $*"
}
wrong ':2:8: --seed: expected a whole number' '[fly]' 'seed = -1'
wrong ':2:13: --max-speed: expected a number from 0.5 to 8' '[fly]' 'max-speed = 20'
wrong ':2:1: expected an option of fly, found `sed`' '[fly]' 'sed = 1'
wrong ':2:1: expected an option of fly, found `help`' '[fly]' 'help = true'
wrong ':1:2: expected a command of pinnquad, found `land`' '[land]' 'seed = 1'
wrong ':2:8: expected a value of --seed, found a truth value' '[fly]' 'seed = true'
wrong ':2:18: expected true or false, found 1' '[fly]' 'list-airframes = 1'
wrong ':2:9: expected a text, a number or a truth value, found an array of 0' '[fly]' 'seed = [[]]'
wrong ':2:6: expected TOML' '[fly]' 'seed 3'
wrong ':2:10: --epochs: expected a whole number' '[train]' 'epochs = 0'
expect_line 2 '^fly: none\.toml: expected a readable file, found none' "$pinnquad" fly --config none.toml --out w.csv

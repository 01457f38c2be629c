# SPDX-License-Identifier: MIT
# Hostile values for every number and every text that a command takes, by what its --help says: one line that names the option,
# exit code 2, no work begun.
source "$(dirname "$0")/common.sh" "$@"

# commands_of [command]...: that command and those below it
commands_of() {
  "$pinnquad" "$@" --help >help.txt
  local below
  below=$(sed -n '/^Commands:$/,/^$/s/^  \([a-z]\+\)  .*/\1/p' help.txt)
  if [ $# -gt 0 ]; then echo "$*"; fi
  for command in $below; do commands_of "$@" "$command"; done
}
commands_of >commands.txt
[ "$(wc -l <commands.txt)" -ge 5 ] || fail "few commands: $(cat commands.txt)"

mkdir here
cd here
tried=0
refused() { # <option> <value> <command>...: refused for that option, before anything is begun
  local option=$1 value=$2
  shift 2
  expect_line 2 "^$1: $option\b" timeout 20 "$pinnquad" "$@" "$option" "$value"
  rm stdout.txt stderr.txt
  [ -z "$(ls -A)" ] || fail "$* $option '$value' left $(ls -A)"
  tried=$((tried + 1))
}
while read -r -a command; do
  "$pinnquad" "${command[@]}" --help >../help.txt
  ! grep -E '^  --[a-z-]+ (FLOAT|INT|UINT|NUMBER)' ../help.txt || fail "${command[*]}: a number without its range"
  while read -r option kind; do
    refused "$option" '' "${command[@]}"
    number=${kind%%=*}
    case $number in
      *[0-9]..[0-9]*)
        values=(nan -nan inf -1 1e400 0x10 ' ' '1 2' 1,5 "1${number#*..}0")
        [[ $number == 0* ]] || values+=(0)
        ;;
      N) values=(nan inf -1 1e400 0x10 1.5 18446744073709551616) ;;
      i/n) values=(nan 0 -1 0/1 2/1 1/0x10 1/-1 1/1e400) ;;
      auto\|SECONDS) values=(nan inf 1e400 0x10 -2 ' ') ;;
      *) values=() ;;
    esac
    for value in ${values[@]+"${values[@]}"}; do
      if [ "$number" = i/n ] || [ "$number" = 'auto|SECONDS' ]; then continue; fi
      refused "$option" "$value" "${command[@]}"
    done
  done < <(sed -nE 's/^  (--[a-z-]+) ([^ ]+)( .*|$)/\1 \2/p' ../help.txt)
done <../commands.txt
cd ..
echo "$tried values refused"
[ "$tried" -ge 100 ] || fail "few options were found"

[ "${pinnquad##*/}" = pinnquad ] || exit 0 # of pinnquad-study the rest is that of study_commands.sh

# those that are read when the command runs
for value in nan inf 1e400 0x10 -2 ' '; do
  expect_line 2 '^import: --lag: expected auto, or seconds' timeout 20 "$pinnquad" import x.csv --mapping px4 --out o --lag "$value"
done

# as entries of a file
for entry in 'seconds = nan' 'seconds = "nan"' 'seconds = inf' 'seconds = 0' 'seed = -1' 'seed = ""' 'seed = 1e400'; do
  printf '[certify]\n%s\n' "$entry" >wrong.toml
  expect_line 2 '^certify: wrong\.toml:2:[0-9]+: ' timeout 20 "$pinnquad" certify model.hpp --config wrong.toml
done
# a NUL would cut the path that it stands in
printf '[fly]\nout = "o.csv\\u0000.txt"\n' >wrong.toml
expect_line 2 '^fly: wrong\.toml:2:7: expected a text without NUL, found ' "$pinnquad" fly --samples 20 --config wrong.toml
[ ! -e o.csv ] || fail "a path was cut at a NUL"

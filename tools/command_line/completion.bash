# SPDX-License-Identifier: MIT
#
# Completion of the commands and options of pinnquad and pinnquad-study for bash, from what the program says of itself.
# Other words are files. Installed as share/bash-completion/completions/pinnquad and pinnquad-study; in a build tree:
#   source tools/command_line/completion.bash
_pinnquad() {
  local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]} help commands word
  local -a chosen=()
  help=$("$program" --help 2>/dev/null) || return 0
  commands=$(sed '1,/^Commands:/d' <<<"$help" | awk '/^  [a-z]/ { print $1 } /^[^ ]/ { exit }')
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    grep -qxF -- "$word" <<<"$commands" || continue
    chosen+=("$word")
    help=$("$program" "${chosen[@]}" --help 2>/dev/null) || return 0
    commands=$(sed '1,/^Commands:/d' <<<"$help" | awk '/^  [a-z]/ { print $1 } /^[^ ]/ { exit }')
  done
  if [[ $current == -* ]]; then
    commands=$(grep -oE '^  (-[a-z],)?--[a-z-]+' <<<"$help" | grep -oE -- '--[a-z-]+')
    [ ${#chosen[@]} -eq 0 ] || commands+=$'\n--config'
  fi
  mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
}
complete -o default -F _pinnquad pinnquad pinnquad-study

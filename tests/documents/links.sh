#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Whether what documents point to is there: relative links with their anchors, pictures, files of the tree named in code
# font, and in the sources each 'docs/paper.md, deviation n'.
#   links.sh ROOT [DOCUMENT ...]      default: all of the tree's documents, and the sources
# Exit code 1 with document:line: message for each fault.
set -euo pipefail
root=$1
shift
cd -- "$root"
sources=no
if [ $# -eq 0 ]; then
  sources=yes
  mapfile -t documents < <(find . -name build -prune -o -name node_modules -prune -o -path './.*' -prune -o \
    -name '*.md' -print | sed 's,^\./,,' | sort)
  [ ${#documents[@]} -gt 0 ] || { echo "no documents in $root"; exit 1; }
  set -- "${documents[@]}"
fi

faults=0
fault() { # <where> <message>
  echo "$1: $2"
  faults=$((faults + 1))
}

# Lines outside of fences and hidden comments, as line<tab>text.
prose() { awk '/^```/ { fence = !fence } /^<!--/ { hidden = 1 } !fence && !hidden { print NR "\t" $0 } /-->[ \t]*$/ { hidden = 0 }' "$1"; }

# The anchors that a page's headings get: lower case, without punctuation, spaces as hyphens, -1, -2 for the same again.
anchors() {
  prose "$1" | sed -n 's/^[0-9]*\t#\{1,6\} *//p' | sed 's/\[\([^]]*\)\]([^)]*)/\1/g' | tr '[:upper:]' '[:lower:]' |
    sed "s/[^[:alnum:] _-]//g; s/ /-/g" | awk '{ print $0 (seen[$0]++ ? "-" seen[$0] - 1 : "") }'
}

# Files that a document names by their path in the tree, in include/pinnquad, or beside itself.
exists() { # <folder of the document> <path>
  local place
  for place in "" include/ include/pinnquad/ examples/ "$1/" "$1/src/"; do
    if compgen -G "$place$2" >/dev/null; then return 0; fi
  done
  return 1
}

for document; do
  folder=$(dirname -- "$document")
  while IFS=$'\t' read -r line target; do
    case $target in http://* | https://* | mailto:*) continue ;; esac
    page=${target%%#*}
    place=$document
    if [ -n "$page" ]; then
      place=$folder/$page
      if [ ! -e "$place" ]; then
        fault "$document:$line" "the link points to nothing: $target"
        continue
      fi
    fi
    if [[ $target == *#* ]] && ! anchors "$place" | grep -qxF -- "${target#*#}"; then
      fault "$document:$line" "no heading for this anchor: $target"
    fi
  done < <(prose "$document" | sed 's/`[^`]*`//g' |
    awk -F '\t' '{ rest = $2; while (match(rest, /\]\([^)]*\)/)) { print $1 "\t" substr(rest, RSTART + 2, RLENGTH - 3); rest = substr(rest, RSTART + RLENGTH) } }')

  # with a folder in front, and an ending that only sources have
  while IFS=$'\t' read -r line path; do
    exists "$folder" "$path" || fault "$document:$line" "no such file: $path"
  done < <(prose "$document" |
    awk -F '\t' '{ rest = $2; while (match(rest, /`[A-Za-z0-9_.*\/-]+\/[A-Za-z0-9_.*-]+\.(hpp|cpp|h|c|S|sh|py|cmake|md)`/)) { print $1 "\t" substr(rest, RSTART + 1, RLENGTH - 2); rest = substr(rest, RSTART + RLENGTH) } }' |
    grep -vP '\t(my_model|demo_out)/' || true)
done

if [ "$sources" = yes ]; then
  while IFS=: read -r file line number; do
    grep -qE "^\| $number \|" docs/paper.md || fault "$file:$line" "docs/paper.md has no deviation $number"
  done < <(grep -rnoE 'paper\.md\)?,? deviations? [0-9]+(( and|,) [0-9]+)*' README.md docs include examples tools tests --include='*.md' --include='*.hpp' \
    --include='*.cpp' --include='*.sh' --include='*.py' |
    awk -F: '{ n = split($3, words, /[^0-9]+/); for (i = 1; i <= n; ++i) if (words[i] != "") print $1 ":" $2 ":" words[i] }')
  # a file that only its writers have
  while IFS= read -r where; do
    fault "$where" "cites NOTES, which are not in the tree: docs/paper.md, deviation n"
  done < <(grep -rnw 'NOTES' README.md docs include examples tools tests bench scripts --exclude-dir=documents | cut -d: -f1,2)
fi

if [ "$faults" -ne 0 ]; then exit 1; fi
echo "$# documents: all links, anchors and files are there"

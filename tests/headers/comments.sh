#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Lines and comments of our sources: at most 120 columns; no comment opens with What, Who, Which or Whose: it names its
# subject. Exit code 1 with file:line: message for each that does not. Left out: exported headers, patterns of CASE lines.
#   comments.sh ROOT
set -euo pipefail
export LC_ALL=C.UTF-8
cd -- "$1"
folders=()
for folder in include tools tests examples bench; do [ ! -d "$folder" ] || folders+=("$folder"); done
[ ${#folders[@]} -gt 0 ] || { echo "no sources below $1"; exit 1; }
mapfile -t sources < <(find "${folders[@]}" -type f \( -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.c' \) \
  ! -path '*/models/*' ! -name small_model.hpp ! -name structured_trust.hpp | sort)
faults=$({
  grep -nHE '^.{121,}' "${sources[@]}" | grep -v '// CASE ' | sed -E 's/^([^:]+:[0-9]+):.*/\1: more than 120 columns/'
  grep -nHE '^ *(//|/\*)[/!]?<? *(What|Who|Which|Whose) ' "${sources[@]}" |
    sed -E 's/^([^:]+:[0-9]+):.*/\1: the comment opens with a question word; name its subject/'
} || true)
if [ -n "$faults" ]; then
  echo "$faults"
  exit 1
fi
echo "${#sources[@]} sources: lines and comments as they should be"

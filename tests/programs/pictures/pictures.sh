# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# The charts of flights and judgements: the same bytes each time; check.py looks at them.
#   pictures.sh <pictures_driver> <source folder> <work folder>
source "$(dirname "$0")/../common.sh" "$1" "$2" "$3" - -
mkdir first again
"$1" first || fail "nothing was drawn"
"$1" again
diff -r first again || fail "a chart is not the same twice"
python3 "$(dirname "$0")/check.py" first "$2"

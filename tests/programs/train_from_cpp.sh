# SPDX-License-Identifier: MIT
# The calls of examples/train.cpp write the bytes that `pinnquad train` writes.
source "$(dirname "$0")/common.sh" "$@"
train=$6

"$pinnquad" fly --seed 3 --samples 9000 --out flight.csv >/dev/null
"$pinnquad" train --flight flight.csv --out a --name MyModel --loss vanilla --seeds 1 --epochs 20 --block a/model.block >a.txt
"$train" b flight.csv >b.txt
for file in model.hpp model.block trust.hpp; do
  cmp "a/$file" "b/$file" || fail "$file is another one"
done
grep -q '^test rows: R^2 0[.]9' b.txt || fail "said: $(cat b.txt)"

# too few validation rows: limits of an earlier export do not stay
head -n 3001 flight.csv >short.csv
"$train" b short.csv >b.txt
grep -q '^no trust.hpp: ' b.txt || fail "said: $(cat b.txt)"
[ ! -e b/trust.hpp ] || fail "the limits of another model stayed"

# all or nothing
cp b/model.hpp before.hpp
rm b/model.block && mkdir b/model.block
expect_line 1 'it is a folder' "$train" b flight.csv
cmp b/model.hpp before.hpp || fail "a header was written without its block"
[ ! -e b/trust.hpp ] || fail "limits of trust were written without their block"
[ -z "$(find b -name '*.partial*')" ] || fail "partial files stayed"

# SPDX-License-Identifier: MIT
# An airframe that no library knows: from its file to a flight, a training, and a header that flies without file or trainer.
source "$(dirname "$0")/common.sh" "$@"

sed 's/^name = .*/name = "my \\"own\\" quad"/; s/^mass_kg = .*/mass_kg = 1.31/' \
  "$source_dir/examples/airframes/paper_quadrotor.toml" >mine.toml
"$pinnquad" fly --airframe mine.toml --seed 3 --samples 2500 --out flight.csv >/dev/null
"$pinnquad" train --flight flight.csv --airframe mine.toml --out a --seeds 1 --epochs 2 --threads 1 --allow-poor \
  --block a/model.block >a.txt
grep -q 'using Vehicle = TrainedQuadModelAirframe;' a/model.hpp || fail "the header names another airframe"
grep -q 'vehicle_name = "my \\"own\\" quad";' a/model.hpp || fail "the header does not name the file's airframe"
grep -q '"airframe": "my \\"own\\" quad"' a/report.json || fail "report.json names another airframe"

eigen=$(pkg-config --variable=includedir eigen3 2>/dev/null || true)/eigen3
[ -d "$eigen/Eigen" ] || eigen=/usr/include/eigen3
# shellcheck disable=SC2086 # flags are several words
"$compiler" $compiler_flags -std=c++17 -O1 -DPINNQUAD_INLINE_AS_COMPILER_LIKES -Ia -I"$source_dir/include" \
  -isystem "$eigen" "$source_dir/tests/programs/own_airframe/replay.cpp" -o replay || fail "the header does not compile"
./replay a/replay.txt a/model.block || fail "the export does not answer as its trainer"

# the weights of the same training for the library's airframe are those of another vehicle
"$pinnquad" train --flight flight.csv --airframe paper_quadrotor --out b --seeds 1 --epochs 2 --threads 1 --allow-poor \
  --block b/model.block >/dev/null
! ./replay a/replay.txt b/model.block >refused.txt || fail "another vehicle's block flies"
grep -q "block: block_incompatible" refused.txt || fail "another vehicle's block opens: $(cat refused.txt)"

sed 's/^mass_kg = .*/mass_kg = -1/' mine.toml >broken.toml
expect_line 2 "broken.toml:[0-9]+:[0-9]+: expected a value above 0" "$pinnquad" train --flight flight.csv --airframe broken.toml --out c
expect_line 2 "none.toml: expected a readable file, found none" "$pinnquad" train --flight flight.csv --airframe none.toml --out c

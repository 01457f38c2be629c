# SPDX-License-Identifier: MIT
# A project that `new` writes, as its user has it: configured against the installed package that the PATH leads to, edited, built,
# run; what it exports is judged by the program, which has none of its types.
source "$(dirname "$0")/common.sh" "$@"

cmake --install "$(dirname "$pinnquad")/.." --prefix "$work/prefix" >/dev/null || fail "the build tree does not install"
PATH=$work/prefix/bin:$PATH
sed 's/^name = .*/name = "mine"/' "$source_dir/examples/airframes/racer_5_inch.toml" >mine.toml
pinnquad fly --airframe mine.toml --seed 3 --samples 3000 --out flight.csv >/dev/null
pinnquad new a/b/my_training --airframe mine.toml --name MyModel >said.txt
project=a/b/my_training
[ "$(ls -A $project)" = "$(printf '%s\n' CMakeLists.txt main.cpp model.hpp)" ] || fail "wrote: $(ls -A $project)"
! grep -rn '{{\|}};$' --include=CMakeLists.txt --include=main.cpp $project || fail "a place of the template is empty"
grep -q "cmake -G Ninja -S $project -B $project/build" said.txt || fail "does not say how to build: $(cat said.txt)"

sed -i 's/Hidden<10, 25>/Hidden<2, 16>/; s/, Relu>;/, Tanh>;/; s/epochs = 300/epochs = 60/
  s/^using MyLoss = .*/using MyLoss = Mse;/; s/^using MyOptimizer = .*/using MyOptimizer = Scheduled<AdamW, CosineDecay>;/' $project/model.hpp
cmake -S $project -B build -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$compiler_flags" >configure.txt ||
  fail "does not configure: $(cat configure.txt)"
grep -q "^pinnquad_DIR:PATH=$work/prefix/share/cmake/pinnquad$" build/CMakeCache.txt || fail "found another pinnquad"
cmake --build build >build.txt || { cat build.txt; fail "the project does not compile"; }

expect_line 2 '^train: expected FLIGHT.csv OUT.hpp' build/train flight.csv
expect_line 2 '^train: none.csv: expected a readable file, found none' build/train none.csv out.hpp
sed '9s/^[^,]*,[^,]*/0,fast/' flight.csv >broken.csv
expect_line 2 '^train: broken.csv:9:2: expected a finite number' build/train broken.csv out.hpp
expect_line 2 '^train: cannot write none/out.hpp: ' build/train flight.csv none/out.hpp
[ ! -e out.hpp ] || fail "a header of no flight"
build/train flight.csv out.hpp >trained.txt
grep -q '^struct MyModel {' out.hpp || fail "another struct is exported"
grep -q 'using Network = .*Dense<16>, pinnquad::Tanh, pinnquad::Dense<16>, pinnquad::Tanh, pinnquad::Dense<4>>' out.hpp ||
  fail "another network is exported: $(grep 'using Network' out.hpp)"
grep -q 'training_data = "flight.csv"' out.hpp || fail "the header does not name its flight"

# the program agrees with what the project says of its model
pinnquad block out.hpp --out out.block >/dev/null
pinnquad evaluate out.block --airframe mine.toml --flight flight.csv --rows test --json >judged.json || true
said=$(sed -n 's/^test rows: R^2 \([0-9.]*\),.*/\1/p' trained.txt) judged=$(sed -n 's/^  "r2": \(.*\),$/\1/p' judged.json)
awk -v said="$said" -v judged="$judged" 'BEGIN { d = said - judged; exit !(said > 0 && d < 1e-4 && d > -1e-4) }' ||
  fail "the project says R^2 $said, evaluate $judged"

# a project that begins with what was exported
pinnquad new again --model out.hpp >/dev/null
grep -qF 'using MyNetwork = Mlp<float, InputSize<16>, Hidden<2, 16>, OutputSize<4>, Tanh>;' again/model.hpp || fail "another network"
grep -qF '"MyModel"' again/main.cpp || fail "the name of the header is lost"
sed 's/MyModelAirframe/OwnAirframe/g' again/model.hpp >renamed.hpp
for line in 'a.mass_kg = ' 'a.rotors\[3\] = ' 'MyAirframe my_airframe'; do
  [ "$(grep "$line" renamed.hpp)" = "$(grep "$line" $project/model.hpp)" ] || fail "another airframe: $line"
done
pinnquad new crazyflie --model "$source_dir/examples/models/crazyflie_2_1.hpp" --name Tiny >/dev/null
grep -qF 'using MyAirframe = Crazyflie;' crazyflie/model.hpp || fail "the header's airframe is lost"
grep -qF '"Tiny"' crazyflie/main.cpp || fail "--name does not go before the header's"

# refused: one line, and no folder, no file
nothing_new() { # <pattern> <argument>...
  local pattern=$1
  shift
  expect_line 2 "$pattern" pinnquad new "$@"
  [ ! -e x ] || fail "left a folder: $(find x)"
}
nothing_new '^new: folder is required'
nothing_new '^new: --name 3rd: a C\+\+ identifier was expected' x/y --name 3rd
nothing_new "no airframe named 'zeppelin'; known: " x --airframe zeppelin
nothing_new 'none.toml: expected a readable file, found none' x --airframe none.toml
nothing_new 'flight.csv: expected a header that pinnquad train exported' x --model flight.csv
sed 's/using Features = .*/using Features = my::Features;/' out.hpp >foreign.hpp
nothing_new 'foreign.hpp:[0-9]+: expected a type of the library, found `my::Features`' x --model foreign.hpp
sed 's/^struct MyModelAirframe {/struct Other {/' out.hpp >foreign.hpp
nothing_new 'foreign.hpp:[0-9]+: expected an airframe of the library or of the header, found `MyModelAirframe`' x --model foreign.hpp
nothing_new 'structured_quadrotor.hpp:[0-9]+: expected a network, as pinnquad train --recipe paper exports it, found `AxisAligned<' x \
  --model "$source_dir/examples/models/structured_quadrotor.hpp"
nothing_new '^new: cannot write .*my_training: it is not empty' $project
nothing_new '^new: cannot write flight.csv/x: ' flight.csv/x
nothing_new '^new: cannot write flight.csv: ' flight.csv
mkdir empty
pinnquad new empty >/dev/null || fail "an empty folder is refused"
(mkdir here && cd here && pinnquad new . >/dev/null && [ -s main.cpp ]) || fail "the empty working folder is refused"
if [ "$(id -u)" -ne 0 ]; then
  mkdir closed && chmod a-w closed
  expect_line 2 '^new: cannot write closed/x' pinnquad new closed/x
fi

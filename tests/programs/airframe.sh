# SPDX-License-Identifier: MIT
# Airframes listed, checked and converted: a converted one flies the same flight, bit for bit, from its file and from its struct.
source "$(dirname "$0")/common.sh" "$@"

"$pinnquad" airframe list >list.txt
"$pinnquad" fly --list-airframes >flown.txt
cmp list.txt flown.txt || fail "fly lists other airframes"
mapfile -t names < <(awk 'NR % 2 == 1 { print $1 }' list.txt)
[ ${#names[@]} -ge 5 ] || fail "five airframes and more were expected: ${names[*]}"
for name in "${names[@]}"; do
  "$pinnquad" airframe convert "$name" --out "$name.toml"
  "$pinnquad" airframe check "$name.toml" | sed 1d >from_file.txt
  "$pinnquad" airframe check "$name" | sed 1d >by_name.txt
  cmp from_file.txt by_name.txt || fail "$name is another airframe from its file"
  "$pinnquad" fly --airframe "$name" --samples 30 --out by_name.csv >/dev/null
  "$pinnquad" fly --airframe "$name.toml" --samples 30 --out by_file.csv >/dev/null
  cmp by_name.csv by_file.csv || fail "$name flies another flight from its file"
  "$pinnquad" airframe convert "$name.toml" --out again.toml
  cmp "$name.toml" again.toml || fail "$name is changed by being converted again"
done
"$pinnquad" airframe check racer_5_inch >racer.txt
grep -q '^racer_5_inch: 0.752 kg' racer.txt || fail "said: $(cat racer.txt)"
[ "$(wc -l <racer.txt)" -eq 5 ] || fail "a line and one per rotor were expected: $(cat racer.txt)"

# what a file may say and a plain quadrotor does not
cat >>tilted.toml <<'EOF'
name = "a \"tilted\" \\ one"
mass_kg = 1.0
inertia_kg_m2 = [0.01, 0.012, 0.02]
inertia_products_kg_m2 = [1e-04, 0.0, -2e-04]
thrust_coefficient = 0.1
power_coefficient = 0.05
propeller_diameter_m = 0.25
max_rotor_speed_rev_s = 150.0
rotor_time_constant_s = 0.05
EOF
for corner in '0.1 0.1 counter' '-0.1 -0.1 counter' '0.1 -0.1 ' '-0.1 0.1 '; do
  read -r x y spin <<<"$corner"
  printf '[[rotor]]\nx_m = %s\ny_m = %s\nspin = "%sclockwise"\nz_m = 0.02\naxis = [0.0, 0.6, -0.8]\nthrust_scale = 1.1\nthrust_curve = 0.3\nrise_time_constant_s = 0.04\nfall_time_constant_s = 0.06\n' \
    "$x" "$y" "${spin:+${spin}_}" >>tilted.toml
done
"$pinnquad" airframe convert tilted.toml --out once.toml
"$pinnquad" airframe convert once.toml --out twice.toml
cmp once.toml twice.toml || fail "a tilted airframe is changed by being converted again"
for key in 'inertia_products_kg_m2 = \[1e-04, 0.0, -2e-04\]' 'axis = \[0.0, 0.6, -0.8\]' 'thrust_scale = 1.1' 'thrust_curve = 0.3' 'z_m = 0.02' \
  'rise_time_constant_s = 0.04' 'fall_time_constant_s = 0.06' 'name = "a \\"tilted\\" \\\\ one"'; do
  grep -q "^$key\$" once.toml || fail "lost: $key; wrote: $(cat once.toml)"
done

# a struct, compiled
"$pinnquad" airframe convert tilted.toml --out tilted.hpp --name Tilted
printf '#include "tilted.hpp"\nstatic_assert(pinnquad::is_airframe<Tilted>);\nstatic_assert(Tilted::value<double>().rotors[2].thrust_scale == 1.1);\n' >tilted.cpp
"$compiler" -std=c++17 -fsyntax-only -I"$source_dir/include" -I. -isystem "$eigen" tilted.cpp || fail "the struct does not compile"

# bad input: one line, nothing written
cp twice.toml before.toml
expect_line 2 "no airframe named 'zeppelin'; known: " "$pinnquad" airframe check zeppelin
expect_line 2 'none.toml: expected a readable file, found none' "$pinnquad" airframe check none.toml
expect_line 2 "'3rd' is not a C\+\+ identifier" "$pinnquad" airframe convert tilted.toml --out third.hpp --name 3rd
expect_line 2 'ends in .toml or .hpp was expected' "$pinnquad" airframe convert tilted.toml --out tilted.txt
expect_line 2 'are the same file; it would be overwritten' "$pinnquad" airframe convert twice.toml --out ./twice.toml
cmp before.toml twice.toml || fail "the input was overwritten"
expect_line 2 'cannot write absent/a.toml' "$pinnquad" airframe convert tilted.toml --out absent/a.toml
expect_line 2 'expected a command: list, check, convert' "$pinnquad" airframe
sed 's/^mass_kg = .*/mass_kg = -1/' tilted.toml >broken.toml
expect_line 2 'broken.toml:2:11: expected a value above 0' "$pinnquad" airframe check broken.toml
[ ! -e third.hpp ] && [ ! -e tilted.txt ] && [ -z "$(find . -name '*.partial*')" ] || fail "something was left behind"

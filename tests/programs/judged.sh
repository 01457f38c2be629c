# SPDX-License-Identifier: MIT
# What train takes for a flight, what it thinks worth exporting, and that what it exports compiles and flies.
source "$(dirname "$0")/common.sh" "$@"

"$pinnquad" fly --seed 3 --samples 3000 --out good.csv >/dev/null
refused() { # <pattern> [option]...: train refuses bad.csv before training and leaves no trace
  local pattern=$1
  shift
  mkdir -p out
  expect_line 2 "$pattern" "$pinnquad" train --flight bad.csv --out out --epochs 1 --seeds 1 "$@"
  [ -z "$(ls -A out)" ] || fail "something was left in the output folder: $(ls -A out)"
}
edit() { # <awk program>: bad.csv from good.csv
  awk -F, -v OFS=, "$1" good.csv >bad.csv
}
commands() { # <awk expression of u>: bad.csv with every command replaced
  edit "NR > 1 { for (i = 18; i <= 21; i++) { u = \$i; \$i = $1 } } { print }"
}

# numbers that no flight has
edit 'NR == 500 { $3 = "1e39" } { print }'
refused '^train: bad\.csv:500:3: expected -1000 to 1000 m/s\^2 in column vdot_by, found 1e\+39$'
edit 'NR == 501 { $18 = "1e30" } { print }'
refused '^train: bad\.csv:501:18: expected a command of 0 to 1 in column u1, found 1e\+30$'
edit 'NR == 502 { $9 = "150" } { print }'
refused '^train: bad\.csv:502:9: expected a value like its neighbours in column v_by, found 150'

# commands and angles in other units
commands '1000 + 1000 * u'
refused '^train: bad\.csv:2:18: .*u1.*1000 to 2000 us\? Then write \(u - 1000\) / 1000'
commands '100 * u'
refused '^train: bad\.csv:2:18: .*percent\? Then write u / 100'
commands '-u'
refused '^train: bad\.csv:2:18: .*negated\? Then write -u'
edit 'NR > 1 { for (i = 14; i <= 16; i++) $i *= 57.29577951 } { print }'
refused '^train: bad\.csv:2:14: expected radians in column roll, found degrees'
edit 'NR > 1 { for (i = 11; i <= 13; i++) $i *= 57.29577951 } { print }'
refused '^train: bad\.csv:2:11: expected radians per second .*found degrees per second'

# a command that stands still: found before the training
edit 'NR > 1 { $19 = 0.5 } { print }'
refused '^train: bad\.csv:2:19: expected commands that change in column u2, found 0\.5 in all 1800 training rows$'
edit 'NR > 2500 { $20 = 0.25 } { print }'
"$pinnquad" train --flight bad.csv --out varies --epochs 1 --seeds 1 --allow-poor >/dev/null 2>&1 ||
  fail "a command that stands still in some of the test rows was refused"
edit 'NR > 2401 { $20 = 0.25 } { print }'
refused '^train: bad\.csv:2402:20: expected commands that change in column u3, found 0\.25 in all 600 test rows$'

# found before there is a folder
for program in 'NR > 1 { $19 = 0.5 } { print }' 'NR > 1 { $1 *= 1000 } { print }'; do
  edit "$program"
  expect_line 2 '^train: bad\.csv:' "$pinnquad" train --flight bad.csv --out made --epochs 1 --seeds 1
  [ ! -e made ] || fail "a refused training made a folder"
done
expect_line 2 '^train: cannot write absent/m.block' "$pinnquad" train --flight good.csv --out made --epochs 1 --seeds 1 --block absent/m.block
[ ! -e made ] || fail "a refused training left its folder"

# names that no struct may have
cp good.csv bad.csv
for name in class NULL _Model my__model errno 3rd 'a b'; do refused '--name' --name "$name"; done

# worse than the mean: results and report, no header, exit code 1 and one line; with --allow-poor a header that says so.
# Commands that have nothing to do with the motion: in the test rows another mean than in the training rows.
awk -F, -v OFS=, 'NR > 1 { for (i = 18; i <= 21; i++) $i = (NR < 2400 ? 0.2 : 0.8) + 0.1 * sin(NR * i) } { print }' \
  good.csv >noise.csv
mkdir poor
code=0
"$pinnquad" train --flight noise.csv --out poor --epochs 2 --seeds 1 --block poor/model.block >poor.txt 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code for a model worse than the mean"
[ "$(wc -l <stderr.txt)" -eq 1 ] || fail "not one line: $(cat stderr.txt)"
grep -q '^train: not exported: .*worse than the mean of the commands (R^2 -' stderr.txt || fail "said: $(cat stderr.txt)"
for file in results.csv report.json; do [ -s "poor/$file" ] || fail "$file is missing"; done
for file in model.hpp model.block replay.txt; do [ ! -e "poor/$file" ] || fail "$file of a refused model was written"; done
grep -q '"worse_than_mean": true' poor/report.json || fail "report.json does not say it"
grep -q '"exported": false' poor/report.json || fail "report.json does not say that nothing was exported"
"$pinnquad" train --flight noise.csv --out poor --epochs 2 --seeds 1 --allow-poor --block poor/model.block >poor.txt 2>stderr.txt
grep -q 'NOT FOR FLIGHT' poor.txt || fail "stdout does not warn: $(cat poor.txt)"
head -n 3 poor/model.hpp | grep -q '^// NOT FOR FLIGHT' || fail "the header's head does not warn"
grep -q 'bool worse_than_mean = true;' poor/model.hpp || fail "the header does not mark the model"
grep -q '"exported": true' poor/report.json || fail "report.json does not say that it was exported"
# one that is refused where another was exported: what there is old is named
cp -r poor stale
expect_line 1 'of an earlier training: stale/model.hpp, stale/replay.txt, stale/model.block$' \
  "$pinnquad" train --flight noise.csv --out stale --epochs 2 --seeds 1 --block stale/model.block
for file in model.hpp replay.txt model.block; do cmp "poor/$file" "stale/$file" || fail "$file was changed by a refused training"; done

# no better than linear regression: a warning, and the fact in header and report. The commands are a linear map.
awk -F, -v OFS=, 'NR > 1 { for (i = 18; i <= 21; i++) $i = 0.5 + 0.01 * $(i - 16) + 0.01 * $(i - 8) } { print }' \
  good.csv >linear.csv
"$pinnquad" train --flight linear.csv --recipe paper --out linear --epochs 3 --seeds 1 >/dev/null 2>stderr.txt
grep -q "^train: warning: .*does not beat linear regression on the paper's features" stderr.txt || fail "said: $(cat stderr.txt)"
grep -q 'bool beats_linear_regression = false;' linear/model.hpp || fail "the header does not say it"
grep -q 'linear_regression_r_squared = 1.0;\|linear_regression_r_squared = 0.99999' linear/model.hpp ||
  fail "linear regression does not find a linear map: $(grep r_squared linear/model.hpp)"
grep -q '"beats_linear_regression": false' linear/report.json || fail "report.json does not say it"

# slopes pinned to the airframe's on a noisy flight: the model is worse than the mean, and no network that is refuted takes its place
"$pinnquad" fly --seed 3 --samples 2400 --gyro-noise 0.1 --out noisy.csv >/dev/null
code=0
"$pinnquad" train --flight noisy.csv --slopes pinned --out pinned --epochs 20 --seeds 2 >/dev/null 2>stderr.txt || code=$?
[ "$code" -eq 1 ] || fail "exit code $code for pinned slopes on a noisy flight; said: $(cat stderr.txt)"
[ ! -e pinned/model.hpp ] || fail "a model was exported: $(cat stderr.txt)"
grep -q '^train: not exported: on the test rows the best structured model is worse .*; --slopes learned, ' stderr.txt || fail "said: $(cat stderr.txt)"
"$pinnquad" train --flight noisy.csv --out learned --epochs 20 --seeds 2 >/dev/null 2>stderr.txt
grep -q 'where the angular acceleration is not noisy, train --slopes pinned' stderr.txt || fail "recommends pinned slopes: $(cat stderr.txt)"
"$pinnquad" certify learned/model.hpp >/dev/null || fail "a refuted model was exported of a noisy flight"

# the same of a structured model, whose slopes are those of no vehicle: proven, and a warning each
"$pinnquad" train --flight linear.csv --out sloped --epochs 3 --seeds 1 --allow-poor >/dev/null 2>stderr.txt
for axis in roll yaw; do
  grep -q "^train: warning: the $axis slope is not the airframe's: .* rotor lag or latency .* --slopes pinned " stderr.txt || fail "does not doubt the $axis slope: $(cat stderr.txt)"
done
"$pinnquad" certify sloped/model.hpp >/dev/null || fail "slopes of no vehicle are not proven"

# A flight at yaw 0 and one constant climb rate, from a file whose name is no text: trained, exported, compiled and flown.
name=$'yaw\xff* "0";\n\\\n#error?\?.csv'
awk -F, -v OFS=, 'NR > 1 { $16 = 0; $13 = 0; $7 = 0; $10 = -0.5 } { print }' good.csv >"$name"
"$pinnquad" train --flight "$name" --out still_structured --epochs 4 --seeds 1 --allow-poor >/dev/null 2>stderr.txt
grep -q '^train: warning: wdot_z, v_bz, w_z, sin_yaw, cos_yaw, w_yz, w_zx, vv_bz: ' stderr.txt || fail "said: $(cat stderr.txt)"
"$pinnquad" certify still_structured/model.hpp >/dev/null || fail "the structured model of a still flight is not proven"
"$pinnquad" train --flight "$name" --recipe paper --out still --epochs 4 --seeds 1 --allow-poor --block still/model.block >/dev/null 2>stderr.txt
grep -q '^train: warning: wdot_z, v_bz, w_z, sin_yaw, cos_yaw: ' stderr.txt || fail "said: $(cat stderr.txt)"
iconv -f UTF-8 -t UTF-8 still/report.json >/dev/null || fail "report.json is no text"
grep -qF '"flight": "yaw?* \"0\";?\\?#error??.csv"' still/report.json || fail "report.json does not name the flight"
cat >still.cpp <<'EOF'
#include <cstdio>
#include "pinnquad/pinnquad.hpp"
#include "still/model.hpp"
template <class Inverse>
int refusals(const Inverse& inverse) {
  int refused = pinnquad::self_test(inverse) == pinnquad::Status::ok ? 0 : 1;
  for (const auto& golden : TrainedQuadModel::golden_features) {
    for (const float moved : {0.0f, 0.03f, -0.03f}) {  // on the training rows, and near them
      TrainedQuadModel::Inputs in;
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        in.linear_acceleration_m_s2[i] = golden[k];
        in.angular_acceleration_rad_s2[i] = golden[3 + k];
        in.velocity_m_s[i] = golden[6 + k];
        in.body_rates_rad_s[i] = golden[9 + k];
      }
      in.angular_acceleration_rad_s2[2] += 10 * moved;
      in.velocity_m_s[2] += moved;
      in.body_rates_rad_s[2] += moved;
      in.attitude = pinnquad::from_euler(pinnquad::EulerAngles<float>{golden[12], golden[13], moved});
      pinnquad::Commands<float> u{};
      if (inverse.predict(in, u) != pinnquad::Status::ok) ++refused;
      for (const float v : u) refused += v > -1.0f && v < 2.0f ? 0 : 1;
    }
  }
  return refused;
}
int main() {
  alignas(pinnquad::model_block_alignment) static unsigned char bytes[100000];
  std::FILE* file = std::fopen("still/model.block", "rb");
  const std::size_t size = std::fread(bytes, 1, sizeof bytes, file);
  pinnquad::ModelView<TrainedQuadModel> view;
  if (pinnquad::ModelView<TrainedQuadModel>::open(bytes, size, view) != pinnquad::Status::ok) return 1;
  const pinnquad::InverseDynamics<pinnquad::ModelView<TrainedQuadModel>> of_block(view);
  const int refused = refusals(pinnquad::InverseDynamics<TrainedQuadModel>()) + refusals(of_block);
  std::printf("%d refused\n", refused);
  return refused == 0 ? 0 : 1;
}
EOF
"$compiler" -std=c++17 -O1 -trigraphs -Wall -Wextra -Werror -I"$source_dir/include" -I. -isystem "$eigen" still.cpp \
  -o flies ||
  fail "the header of a still flight does not compile"
./flies || fail "the model of a still flight refuses rows like those it was trained on"

// SPDX-License-Identifier: MIT
#include "pinnquad/features/extra_columns.hpp"

#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <string>

#include "pinnquad/features/chosen_features.hpp"
#include "pinnquad/features/windowed.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "support/random_states.hpp"

using namespace pinnquad;
using pinnquad::test::RandomStates;

namespace {

struct SecondRotor {
  static constexpr const char* name = "n2";
  static constexpr const char* unit = "rev/s";
};
struct PackCurrent {
  static constexpr const char* name = "pack_current";
  static constexpr const char* unit = "A";
};
using Measured = WithColumns<PaperFeaturesWithAltitude, BatteryVoltage, SecondRotor, PackCurrent>;
using MeasuredInputs = Measured::Inputs<float>;

MeasuredInputs sound_inputs(std::uint64_t seed) {
  RandomStates random(seed);
  MeasuredInputs inputs;
  static_cast<MotionInputs<float>&>(inputs) = motion_inputs(random.state<float>(), random.motion<float>());
  inputs.altitude_m = 3;
  inputs.column<BatteryVoltage>() = 15.5F;
  inputs.column<SecondRotor>() = 101;
  inputs.column<PackCurrent>() = 22;
  return inputs;
}

}  // namespace

TEST_CASE("columns stand behind the features of the set that they extend, with their names and units") {
  CHECK(is_feature_set<Measured>);
  CHECK(Measured::size == 20);
  CHECK(Measured::angular_acceleration == PaperFeatures::angular_acceleration);
  const MeasuredInputs inputs = sound_inputs(1);
  std::array<float, 20> x{};
  std::array<float, 17> inner{};
  Measured::extract(inputs, x.data());
  PaperFeaturesWithAltitude::extract<float>(inputs, inner.data());
  for (std::size_t i = 0; i < 17; ++i) {
    CHECK(x[i] == inner[i]);
    CHECK(std::string(Measured::names[i]) == PaperFeaturesWithAltitude::names[i]);
    CHECK(std::string(Measured::units[i]) == PaperFeaturesWithAltitude::units[i]);
  }
  const std::array<std::string, 3> names = {"battery_voltage", "n2", "pack_current"}, units = {"V", "rev/s", "A"};
  const std::array<float, 3> values = {15.5F, 101, 22};
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(x[17 + i] == values[i]);
    CHECK(Measured::names[17 + i] == names[i]);
    CHECK(Measured::units[17 + i] == units[i]);
    CHECK(extra_column_names<Measured>[i] == names[i]);
    CHECK(extra_column_units<Measured>[i] == units[i]);
  }
  CHECK(extra_column_names<PaperFeatures>.size() == 0);
  CHECK(extra_column_names<Measured>.size() == 3);
}

TEST_CASE("a set of columns around another one has the columns of both") {
  using Both = WithColumns<WithColumns<PaperFeatures, BatteryVoltage>, PackCurrent>;
  CHECK(is_feature_set<Both>);
  CHECK(Both::size == 18);
  CHECK(std::string(extra_column_names<Both>[0]) == "battery_voltage");
  CHECK(std::string(extra_column_names<Both>[1]) == "pack_current");
}

TEST_CASE("whatever is made of a set with columns asks for what its inputs hold, and has it where it says") {
  // Measured: 17 features, then the three columns
  using Some = Chosen<Measured, 19, 2, 17, 18>;
  using Alone = Joined<Measured>;
  CHECK(extra_column_names<Some> == extra_column_names<Measured>);
  CHECK(extra_column_units<Some> == extra_column_units<Measured>);
  CHECK(extra_column_names<Alone> == extra_column_names<Measured>);
  CHECK(extra_column_names<Windowed<Some, 2, PeriodMicroseconds<20000>>> == extra_column_names<Measured>);
  const std::array<float, 3> values = {15.5F, 101, 22};
  MeasuredInputs inputs = sound_inputs(3);
  inputs.columns = {};
  CHECK(set_columns(inputs, values.data()) == values.data() + extra_column_names<Some>.size());
  std::array<float, 20> whole{};
  std::array<float, 4> x{};
  Measured::extract(inputs, whole.data());
  Some::extract(inputs, x.data());
  CHECK(x == std::array<float, 4>{22, whole[2], 15.5F, 101});
  for (int i = 0; i < Some::size; ++i) CHECK(detail::is_column<Some>(i) == (i != 1));
  for (int i = 0; i < Alone::size; ++i) CHECK(detail::is_column<Alone>(i) == (i > 16));
}

TEST_CASE("a column that is not finite is refused, and so is one that was never set; motion and attitude as ever") {
  const MeasuredInputs good = sound_inputs(2);
  CHECK(Measured::check(good) == Status::ok);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (std::size_t i = 0; i < 3; ++i) {
      MeasuredInputs inputs = good;
      inputs.columns[i] = bad;
      CHECK(Measured::check(inputs) == Status::not_finite);
    }
    MeasuredInputs inputs = good;
    inputs.altitude_m = bad;
    CHECK(Measured::check(inputs) == Status::not_finite);
  }
  MeasuredInputs turned = good;
  turned.attitude.w += 2;
  CHECK(Measured::check(turned) == Status::not_unit_quaternion);
  MeasuredInputs unset;
  static_cast<MotionInputsWithAltitude<float>&>(unset) = good;
  CHECK(Measured::check(unset) == Status::not_finite);
  // and its feature is not finite: what a guard without FiniteInputs goes by
  std::array<float, 20> x{};
  Measured::extract(unset, x.data());
  CHECK_FALSE(is_finite(x[17]));
}

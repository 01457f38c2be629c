// SPDX-License-Identifier: MIT
#include "pinnquad/inference/inverse_dynamics.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/guarded_inputs.hpp"
#include "support/plain_network.hpp"
#include "support/small_model.hpp"

using pinnquad::Commands;
using pinnquad::InverseDynamics;
using pinnquad::MotionInputs;
using pinnquad::PaperFeatures;
using pinnquad::RotorSpeedOutputs;
using pinnquad::Status;
using pinnquad::test::AsHeader;
using pinnquad::test::infinity;
using pinnquad::test::inputs_of;
using pinnquad::test::marked;
using pinnquad::test::not_a_number;
using pinnquad::test::RandomStates;
using pinnquad::test::same_bits;
using pinnquad::test::SmallModel;
using pinnquad::test::SmallNumbers;
using pinnquad::test::Unchecked;

namespace {

/// The commands are near 0.5; two layers of float sums and the scalers: some ten ulp of it.
constexpr double float_tolerance = 2e-6;

template <class Model>
void check_refused(const typename InverseDynamics<Model>::Inputs& inputs, Status expected) {
  Commands<float> commands = marked();
  CHECK(InverseDynamics<Model>{}.predict(inputs, commands) == expected);
  CHECK(same_bits(commands, marked()));
}

template <std::size_t Size>
constexpr std::array<float, Size> with_nan(std::array<float, Size> parameters, std::size_t index) {
  parameters[index] = not_a_number;
  return parameters;
}

struct FirstWeight : SmallModel {
  static constexpr auto parameters = with_nan(SmallModel::parameters, 0);
};
struct LastBias : SmallModel {
  static constexpr auto parameters = with_nan(SmallModel::parameters, 171);
};
struct InfiniteSpread : Unchecked<SmallModel> {
  static constexpr pinnquad::Scaler<float, 4> output{SmallModel::output.mean, {1.0F, infinity, 1.0F, 1.0F}};
};
struct SpeedNumbers : SmallNumbers {
  using Outputs = RotorSpeedOutputs;
  static constexpr pinnquad::Scaler<float, 4> output{{100.0F, 100.0F, 100.0F, 0.0F}, {10.0F, 10.0F, 10.0F, 10.0F}};
};
using NanInFirstWeight = Unchecked<FirstWeight>;
using NanInLastBias = Unchecked<LastBias>;
using SpeedModel = AsHeader<SpeedNumbers>;

}  // namespace

TEST_CASE("a model has no state: predict() needs nothing but the type") {
  CHECK(std::is_empty_v<InverseDynamics<SmallModel>>);
  CHECK(noexcept(std::declval<const InverseDynamics<SmallModel>&>().predict(std::declval<const MotionInputs<float>&>(),
                                                                            std::declval<Commands<float>&>())));
  CHECK(pinnquad::is_model<SmallModel>);
  CHECK_FALSE(pinnquad::is_model<PaperFeatures>);
}

TEST_CASE("predict() agrees with plain loops in double") {
  RandomStates random(171);
  const InverseDynamics<SmallModel> inverse;
  for (int i = 0; i < 500; ++i) {
    const auto inputs = inputs_of(random, 1);
    Commands<float> commands = marked(), by_features = marked();
    REQUIRE(inverse.predict(inputs, commands) == Status::ok);
    float x[16] = {};
    PaperFeatures::extract(inputs, x);
    const auto expected = plain::commands(SmallModel{}, x);
    for (std::size_t k = 0; k < 4; ++k)
      CHECK(std::fabs(static_cast<double>(commands[k]) - expected[k]) <= float_tolerance);
    REQUIRE(inverse.predict_features(x, by_features) == Status::ok);
    CHECK(same_bits(commands, by_features));
    // again: the same bits
    Commands<float> again{};
    REQUIRE(inverse.predict(inputs, again) == Status::ok);
    CHECK(same_bits(commands, again));
  }
}

TEST_CASE("the golden vectors of the independent script are reproduced") {
  for (std::size_t i = 0; i < SmallModel::golden_features.size(); ++i) {
    Commands<float> commands{};
    REQUIRE(InverseDynamics<SmallModel>{}.predict_features(SmallModel::golden_features[i].data(), commands) ==
            Status::ok);
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(std::fabs(static_cast<double>(commands[k] - SmallModel::golden_commands[i][k])) <= float_tolerance);
    }
  }
}

TEST_CASE("a network with rotor speeds as outputs gives commands all the same") {
  RandomStates random(172);
  const auto inputs = inputs_of(random, 1);
  Commands<float> plain{}, by_speed{};
  REQUIRE(InverseDynamics<SmallModel>{}.predict(inputs, plain) == Status::ok);
  REQUIRE(InverseDynamics<SpeedModel>{}.predict(inputs, by_speed) == Status::ok);
  const double n_max_rev_s = 8500.0 / 60.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double z = (static_cast<double>(plain[k]) - static_cast<double>(SmallModel::output.mean[k])) /
                     static_cast<double>(SmallModel::output.standard_deviation[k]);
    const double speed_rev_s = 10.0 * z + (k < 3 ? 100.0 : 0.0);
    const double expected = std::copysign(speed_rev_s * speed_rev_s / (n_max_rev_s * n_max_rev_s), speed_rev_s);
    CHECK(std::fabs(static_cast<double>(by_speed[k]) - expected) <= 10 * float_tolerance);  // z was divided by 0.1
  }
}

TEST_CASE("bad inputs: a Status, and not a bit of the commands changed") {
  RandomStates random(173);
  const auto good = inputs_of(random, 1);
  for (const float bad : {not_a_number, infinity, -infinity}) {
    auto inputs = good;
    inputs.linear_acceleration_m_s2[2] = bad;
    check_refused<SmallModel>(inputs, Status::not_finite);
    inputs = good;
    inputs.attitude.y = bad;
    check_refused<SmallModel>(inputs, Status::not_finite);
  }
  auto inputs = good;
  inputs.attitude = {0.5F, 0.5F, 0.5F, 0.6F};
  check_refused<SmallModel>(inputs, Status::not_unit_quaternion);
  inputs = good;
  inputs.velocity_m_s[0] = 50.0F;
  check_refused<SmallModel>(inputs, Status::outside_envelope);
  inputs = good;
  inputs.velocity_m_s[0] = std::numeric_limits<float>::max();
  check_refused<SmallModel>(inputs, Status::outside_envelope);
}

TEST_CASE("the envelope holds for each of the features, on both sides, its borders included") {
  const InverseDynamics<SmallModel> inverse;
  for (std::size_t i = 0; i < 16; ++i) {
    CAPTURE(i);
    auto x = SmallModel::golden_features[0];
    CHECK(inverse.inside_envelope(x.data()));
    x[i] = SmallModel::envelope_upper[i];
    CHECK(inverse.inside_envelope(x.data()));
    x[i] = std::nextafter(SmallModel::envelope_upper[i], 1e9F);
    CHECK_FALSE(inverse.inside_envelope(x.data()));
    x[i] = SmallModel::envelope_lower[i];
    CHECK(inverse.inside_envelope(x.data()));
    x[i] = std::nextafter(SmallModel::envelope_lower[i], -1e9F);
    CHECK_FALSE(inverse.inside_envelope(x.data()));
    x[i] = not_a_number;
    CHECK_FALSE(inverse.inside_envelope(x.data()));
    Commands<float> commands = marked();
    CHECK(inverse.predict_features(x.data(), commands) == Status::outside_envelope);
    CHECK(same_bits(commands, marked()));
  }
}

TEST_CASE("broken weights: output_not_finite, commands untouched") {
  RandomStates random(174);
  // the first weight reaches the outputs only through a hidden neuron; NaN opens the ReLU
  check_refused<NanInFirstWeight>(inputs_of(random, 1), Status::output_not_finite);
  check_refused<NanInLastBias>(inputs_of(random, 1), Status::output_not_finite);
  check_refused<InfiniteSpread>(inputs_of(random, 1), Status::output_not_finite);
}

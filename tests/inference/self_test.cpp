// SPDX-License-Identifier: MIT
#include "pinnquad/inference/self_test.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "support/plain_network.hpp"
#include "support/small_model_variants.hpp"

using pinnquad::InverseDynamics;
using pinnquad::Status;
using pinnquad::test::DoubleModel;
using pinnquad::test::SmallInstance;
using pinnquad::test::SmallModel;

namespace {

/// The second layer's weights written column by column, as a wrong exporter would.
SmallInstance transposed() {
  SmallInstance model;
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      model.parameters[136 + column * 4 + row] = SmallModel::parameters[136 + row * 8 + column];
    }
  }
  return model;
}

Status tested(const SmallInstance& model) { return pinnquad::self_test(InverseDynamics<SmallInstance>(model)); }

/// How far the model's golden commands are missed at most; NaN for NaN.
double largest_miss(const SmallInstance& model) {
  double largest = 0;
  for (std::size_t vector = 0; vector < SmallModel::golden_features.size(); ++vector) {
    const auto commands = plain::commands(model, SmallModel::golden_features[vector].data());
    for (std::size_t i = 0; i < 4; ++i) {
      const double miss = std::fabs(commands[i] - static_cast<double>(SmallModel::golden_commands[vector][i]));
      if (!(miss <= largest)) largest = miss;
      if (!std::isfinite(miss)) return miss;
    }
  }
  return largest;
}

float with_bit_flipped(float value, int bit) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  bits ^= std::uint32_t(1) << bit;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

struct TightCommands {
  static constexpr double lower = 0.49;
  static constexpr double upper = 0.5;
};

}  // namespace

TEST_CASE("whatever the guard: golden commands out of its limits, or a fallback, change nothing") {
  using Tight = pinnquad::Extend<pinnquad::TrainingGuard, pinnquad::RefuseCommands<TightCommands>>;
  const InverseDynamics<SmallModel, Tight> tight;
  pinnquad::Commands<float> commands{};
  CHECK(tight.predict_features(SmallModel::golden_features[0].data(), commands) == Status::outside_limits);
  CHECK(pinnquad::self_test(tight) == Status::ok);
}

TEST_CASE("a sound model comes ten times closer than the tolerance; one that misses a vector fails") {
  CHECK(largest_miss({}) < pinnquad::golden_tolerance / 10);
  CHECK(tested({}) == Status::ok);
  CHECK(pinnquad::self_test(InverseDynamics<SmallModel>{}) == Status::ok);
  CHECK(tested(transposed()) == Status::self_test_failed);
  SmallInstance model;
  model.golden_commands.back().back() += 2e-5F;  // twice the tolerance
  CHECK(tested(model) == Status::self_test_failed);
  for (const std::size_t weight : {std::size_t{0}, std::size_t{170}}) {
    model = {};
    model.parameters[weight] = std::numeric_limits<float>::quiet_NaN();
    CHECK(tested(model) == Status::self_test_failed);
  }
  model = {};
  model.envelope_upper[6] = -8.0F;  // the golden vectors lie outside
  CHECK(tested(model) == Status::self_test_failed);
  model = {};
  model.envelope_upper[4] = std::numeric_limits<float>::infinity();  // no golden vector brings it to light
  CHECK(tested(model) == Status::self_test_failed);
  CHECK(pinnquad::self_test(InverseDynamics<DoubleModel>{}) == Status::ok);
}

TEST_CASE("a model without golden vectors fails: nothing was tried") {
  struct Untried : SmallInstance {
    std::array<std::array<float, 16>, 0> golden_features{};
    std::array<std::array<float, 4>, 0> golden_commands{};
  };
  CHECK(pinnquad::self_test(InverseDynamics<Untried>(Untried{})) == Status::self_test_failed);
}

TEST_CASE(
    "each bit of each weight: found exactly where plain loops say that it moves a golden command beyond the "
    "tolerance") {
  int found = 0, found_high = 0, high = 0, disagreed = 0, missed_high = 0;
  constexpr double undecided = 2e-6;  // float sums against double ones
  for (std::size_t weight = 0; weight < SmallModel::parameters.size(); ++weight) {
    for (int bit = 0; bit < 32; ++bit) {
      SmallInstance model;
      model.parameters[weight] = with_bit_flipped(model.parameters[weight], bit);
      const bool failed = pinnquad::self_test(InverseDynamics<SmallInstance>(model)) == Status::self_test_failed;
      const double miss = largest_miss(model);
      const bool should = !(miss <= pinnquad::golden_tolerance);
      if (failed != should && !(std::fabs(miss - pinnquad::golden_tolerance) <= undecided)) ++disagreed;
      if (failed) ++found;
      if (bit >= 23) {  // sign and exponent
        ++high;
        ++(failed ? found_high : missed_high);
      }
    }
  }
  MESSAGE("found ", found, " of ", (32 * SmallModel::parameters.size()), " wrong bits; of sign and exponent bits ",
          found_high, " of ", high);
  CHECK(disagreed == 0);
  CHECK(missed_high * 20 <= high);
  CHECK(found < int(32 * SmallModel::parameters.size()));  // the last bits are rounding: a checksum's business
}

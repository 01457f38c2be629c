// SPDX-License-Identifier: MIT
#include "pinnquad/inference/self_test.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/small_model.hpp"

using pinnquad::InverseDynamics;
using pinnquad::Status;
using pinnquad::test::SmallModel;

namespace {

constexpr std::size_t parameter_count = SmallModel::parameters.size();

template <class Array>
constexpr Array moved(Array values, std::size_t index, float by) {
  values[index] += by;
  return values;
}

template <class Array>
constexpr Array replaced(Array values, std::size_t index, float by) {
  values[index] = by;
  return values;
}

/// The second layer's weights written column by column.
constexpr auto transposed(std::array<float, parameter_count> parameters) {
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      parameters[136 + column * 4 + row] = SmallModel::parameters[136 + row * 8 + column];
    }
  }
  return parameters;
}

template <class Vectors>
constexpr Vectors last_entry_moved(Vectors vectors, float by) {
  auto& last = vectors[vectors.size() - 1];
  last[last.size() - 1] += by;
  return vectors;
}

/// The small model with one parameter moved.
template <std::size_t Index>
struct Moved : SmallModel {
  static constexpr auto parameters = moved(SmallModel::parameters, Index, 0.05F);
};

/// The layout that a wrong exporter would write.
struct Transposed : SmallModel {
  static constexpr auto parameters = transposed(SmallModel::parameters);
};

struct NotANumber : SmallModel {
  static constexpr auto parameters = replaced(SmallModel::parameters, 170, std::numeric_limits<float>::quiet_NaN());
};

/// Twice the tolerance off, in the last entry of the last vector.
struct WrongGoldenCommand : SmallModel {
  static constexpr auto golden_commands = last_entry_moved(SmallModel::golden_commands, 2e-5F);
};

struct GoldenOutsideEnvelope : SmallModel {
  static constexpr auto golden_features = last_entry_moved(SmallModel::golden_features, 3.0F);
};

template <class Model>
Status tested() {
  return pinnquad::self_test(InverseDynamics<Model>{});
}

}  // namespace

TEST_CASE("a sound model passes") { CHECK(tested<SmallModel>() == Status::ok); }

TEST_CASE("one wrong weight, anywhere, fails") {
  CHECK(tested<Moved<0>>() == Status::self_test_failed);    // first weight
  CHECK(tested<Moved<77>>() == Status::self_test_failed);   // somewhere in the first layer
  CHECK(tested<Moved<131>>() == Status::self_test_failed);  // a bias of it
  CHECK(tested<Moved<150>>() == Status::self_test_failed);  // a weight of the last layer
  CHECK(tested<Moved<171>>() == Status::self_test_failed);  // the last bias
}

TEST_CASE("a wrong layout, a NaN, a wrong or impossible golden vector fail") {
  CHECK(tested<Transposed>() == Status::self_test_failed);
  CHECK(tested<NotANumber>() == Status::self_test_failed);
  CHECK(tested<WrongGoldenCommand>() == Status::self_test_failed);
  CHECK(tested<GoldenOutsideEnvelope>() == Status::self_test_failed);
}

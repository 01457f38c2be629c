// SPDX-License-Identifier: MIT
#include "pinnquad/inference/command_jacobian.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <memory>

#include "../examples/models/demo_quadrotor.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/inference/loaded_model.hpp"
#include "support/block_bytes.hpp"

using namespace pinnquad;

namespace {

using Inverse = InverseDynamics<DemoQuadModel>;
constexpr int size = DemoQuadModel::Features::size;

/// The demo's model with speeds of rotors as outputs: the same numbers, another schema.
struct SpeedModel : DemoQuadModel {
  using Outputs = RotorSpeedOutputs;
  static constexpr auto output_names = RotorSpeedOutputs::names;
  static constexpr const char* output_unit = RotorSpeedOutputs::unit;
};

/// Float rounding of the network over the step, and the step's own error, both far below this share of the largest entry.
constexpr double tolerance = 0.02;

template <class Model>
void check_against_differences(const Model& model = {}) {
  const InverseDynamics<Model> inverse(model);
  for (const auto& golden : DemoQuadModel::golden_features) {
    float commands[4], plain[4], jacobian[4 * size];
    REQUIRE(predict_with_jacobian(inverse, golden.data(), commands, jacobian) == Status::ok);
    REQUIRE(inverse.predict_features(golden.data(), plain) == Status::ok);
    for (int i = 0; i < 4; ++i) CHECK(commands[i] == plain[i]);  // the kernel of prediction, to the bit
    double largest = 0;
    for (const float j : jacobian) largest = std::max(largest, std::abs(static_cast<double>(j)));
    REQUIRE(largest > 0);
    int wrong = 0;
    for (int k = 0; k < size; ++k) {
      const float step = 1e-3f * DemoQuadModel::input.spread[static_cast<std::size_t>(k)];
      auto above = golden, below = golden;
      above[static_cast<std::size_t>(k)] += step;
      below[static_cast<std::size_t>(k)] -= step;
      float up[4], down[4];
      if (inverse.predict_features(above.data(), up) != Status::ok) continue;
      if (inverse.predict_features(below.data(), down) != Status::ok) continue;
      for (int i = 0; i < 4; ++i) {
        const double distance =
            static_cast<double>(above[static_cast<std::size_t>(k)] - below[static_cast<std::size_t>(k)]);
        const double slope = static_cast<double>(up[i] - down[i]) / distance;
        wrong += std::abs(slope - static_cast<double>(jacobian[i * size + k])) > tolerance * largest ? 1 : 0;
      }
    }
    CHECK(wrong <= 2);  // a kink of a ReLU within the step
  }
}

/// The demo's model as a block, as a view of it and loaded from it.
struct DemoBlock {
  DemoBlock() {
    REQUIRE(ModelView<DemoQuadModel>::open(bytes.data(), bytes.size(), view) == Status::ok);
    REQUIRE(loaded->load(view) == Status::ok);
  }
  test::BlockBytes bytes{model_block<DemoQuadModel>()};
  ModelView<DemoQuadModel> view;
  std::unique_ptr<LoadedModel<DemoQuadModel>> loaded = std::make_unique<LoadedModel<DemoQuadModel>>();
};

struct Narrow {
  static constexpr double lower = 0.45, upper = 0.8;
};

}  // namespace

TEST_CASE("commands as predicted, derivatives as differences give them, in physical units") {
  SUBCASE("commands") { check_against_differences<DemoQuadModel>(); }
  SUBCASE("rotor speeds") { check_against_differences<SpeedModel>(); }
  const DemoBlock block;
  SUBCASE("a view of a block") { check_against_differences(block.view); }
  SUBCASE("a loaded model") { check_against_differences(*block.loaded); }
}

TEST_CASE("the derivative of what is refused is refused") {
  const Inverse inverse;
  auto x = DemoQuadModel::golden_features[0];
  float commands[4] = {-7, -7, -7, -7}, jacobian[4 * size];
  for (float& v : jacobian) v = -7;
  x[2] = 1e4f;
  CHECK(predict_with_jacobian(inverse, x.data(), commands, jacobian) == Status::outside_envelope);
  x[2] = std::nanf("");
  CHECK(predict_with_jacobian(inverse, x.data(), commands, jacobian) == Status::outside_envelope);
  for (const float v : commands) CHECK(v == -7);
  for (const float v : jacobian) CHECK(v == -7);
}

namespace {

template <class Model>
void check_batch(const Model& model = {}) {
  const InverseDynamics<Model, Extend<TrainingGuard, ClipCommands<Narrow>>> inverse(model);
  constexpr int samples = 83;
  std::array<float, size * samples> x{};
  for (int s = 0; s < samples; ++s) {
    const auto& golden =
        DemoQuadModel::golden_features[static_cast<std::size_t>(s) % DemoQuadModel::golden_features.size()];
    for (int k = 0; k < size; ++k) {
      const float stretch = 0.7f + 0.05f * static_cast<float>(s % 31);
      x[static_cast<std::size_t>(k * samples + s)] = golden[static_cast<std::size_t>(k)] * stretch;
    }
  }
  x[5 * samples + 40] = std::nanf("");
  std::array<float, 4 * samples> commands{};
  commands.fill(-7);
  std::array<Status, samples> statuses{};
  predict_batch(inverse, x.data(), commands.data(), statuses.data(), samples);
  int written = 0, refused = 0, limited = 0;
  for (int s = 0; s < samples; ++s) {
    float alone[size], expected[4] = {-7, -7, -7, -7};
    for (int k = 0; k < size; ++k) alone[k] = x[static_cast<std::size_t>(k * samples + s)];
    const Status status = inverse.predict_features(alone, expected);
    CHECK(statuses[static_cast<std::size_t>(s)] == status);
    for (int i = 0; i < 4; ++i) {
      CHECK(std::abs(commands[static_cast<std::size_t>(i * samples + s)] - expected[i]) <= float(golden_tolerance));
    }
    written += status == Status::ok ? 1 : 0;
    refused += has_output(status) ? 0 : 1;
    limited += status == Status::limited ? 1 : 0;
  }
  CHECK(written > 10);
  CHECK(refused > 3);
  CHECK(limited > 0);
  CHECK(statuses[40] == Status::outside_envelope);
}

}  // namespace

TEST_CASE("a batch gives each sample what it gets alone") {
  SUBCASE("a header") { check_batch<DemoQuadModel>(); }
  const DemoBlock block;
  SUBCASE("a view of a block") { check_batch(block.view); }
  SUBCASE("a loaded model") { check_batch(*block.loaded); }
}

TEST_CASE("a view of no block and a model that was not loaded decline: batches and derivatives too") {
  const auto check = [](const auto& model) {
    const InverseDynamics<std::decay_t<decltype(model)>> inverse(model);
    const auto& x = DemoQuadModel::golden_features[0];
    float commands[4] = {-7, -7, -7, -7}, jacobian[4 * size] = {-7};
    Status status = Status::ok;
    predict_batch(inverse, x.data(), commands, &status, 1);
    CHECK(status == Status::outside_envelope);
    CHECK(predict_with_jacobian(inverse, x.data(), commands, jacobian) == Status::outside_envelope);
    for (const float v : commands) CHECK(v == -7);
    CHECK(jacobian[0] == -7);
  };
  check(ModelView<DemoQuadModel>{});
  check(*std::make_unique<LoadedModel<DemoQuadModel>>());
}

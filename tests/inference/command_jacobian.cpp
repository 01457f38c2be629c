// SPDX-License-Identifier: MIT
#include "pinnquad/inference/command_jacobian.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "../examples/models/demo_quadrotor.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/analytic_inverse.hpp"
#include "pinnquad/inference/batched_inverse.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/outputs/wrench_outputs.hpp"
#include "support/block_bytes.hpp"
#include "support/jacobian_differences.hpp"
#include "support/small_model_variants.hpp"

using namespace pinnquad;

namespace {

using Inverse = InverseDynamics<DemoQuadModel>;
constexpr int size = DemoQuadModel::Features::size;

/// The demo's model with other outputs: the same numbers, another schema.
template <class Schema>
struct OtherNumbers : DemoQuadModel {
  using Outputs = Schema;
};
template <class Schema>
using Other = test::AsHeader<OtherNumbers<Schema>>;
using SpeedModel = Other<RotorSpeedOutputs>;
using WrenchModel = Other<WrenchOutputs>;
using ResidualModel = Other<ResidualOutputs<LinearizedBase>>;

/// Float rounding through eleven layers, of a column's largest entry.
constexpr double float_tolerance = 1e-5;
/// The error of the differences' step.
constexpr double double_tolerance = 2.8e-9;

/// `Header` has the numbers of `model`.
template <class Header, class Model>
void check_against_differences(const Model& model, double tolerance = float_tolerance) {
  using Scalar = typename Header::Scalar;
  const InverseDynamics<Model> inverse(model);
  double worst = 0;
  for (const auto& golden : Header::golden_features) {
    Scalar commands[4], plain[4], jacobian[4 * Header::Features::size];
    REQUIRE(predict_with_jacobian(inverse, golden.data(), commands, jacobian) == Status::ok);
    REQUIRE(inverse.predict_features(golden.data(), plain) == Status::ok);
    for (int i = 0; i < 4; ++i) CHECK(commands[i] == plain[i]);  // the kernel of prediction, to the bit
    const auto expected = test::jacobian_by_differences<Header>(golden.data());
    for (std::size_t k = 0; k < Header::Features::size; ++k) REQUIRE(expected[k] != 0);
    worst = std::fmax(worst, test::worst_column(jacobian, expected));
  }
  CHECK(worst <= tolerance);
}

/// The demo's model as a block, as a view of it and as one whose weights are packed.
struct DemoBlock {
  using View = ModelView<DemoQuadModel>;
  DemoBlock() {
    REQUIRE(View::open(bytes.data(), bytes.size(), view) == Status::ok);
    REQUIRE(View::open(bytes.data(), bytes.size(), packed_view, *packed) == Status::ok);
  }
  test::BlockBytes bytes{model_block<DemoQuadModel>()};
  View view, packed_view;
  std::unique_ptr<View::Packed> packed = std::make_unique<View::Packed>();
};

struct Narrow {
  static constexpr double lower = 0.45, upper = 0.8;
};

}  // namespace

TEST_CASE("commands as predicted, derivatives as differences give them, in physical units, column by column") {
  SUBCASE("commands") { check_against_differences<DemoQuadModel>(DemoQuadModel{}); }
  SUBCASE("rotor speeds") { check_against_differences<SpeedModel>(SpeedModel{}); }
  SUBCASE("a wrench") { check_against_differences<WrenchModel>(WrenchModel{}); }
  SUBCASE("a residual on the linearised inverse") { check_against_differences<ResidualModel>(ResidualModel{}); }
  const DemoBlock block;
  SUBCASE("a view of a block") { check_against_differences<DemoQuadModel>(block.view); }
  SUBCASE("a packed view") { check_against_differences<DemoQuadModel>(block.packed_view); }
  SUBCASE("an instance") { check_against_differences<test::SmallModel>(test::SmallInstance{}); }
  SUBCASE("in double") { check_against_differences<test::DoubleModel>(test::DoubleModel{}, double_tolerance); }
}

namespace {

struct Tight {
  static constexpr double lower = 0.5, upper = 0.55;
};
using Counts = std::array<int, static_cast<std::size_t>(status_count)>;

/// Under a guard: Status and commands as predict_features() gives them, to the bit; the Jacobian as if the guard left
/// the commands alone. How often each Status came.
template <class GuardType>
Counts check_guard(const GuardType& guard = GuardType{}) {
  const InverseDynamics<DemoQuadModel, GuardType> guarded(guard);
  const Inverse free;
  Counts counts{};
  for (const auto& golden : DemoQuadModel::golden_features) {
    for (const float stretch : {1.0f, 40.0f, std::nanf("")}) {
      auto x = golden;
      for (float& v : x) v *= stretch;
      float commands[4], plain[4], jacobian[4 * size], untouched[4 * size];
      std::fill_n(untouched, 4 * size, -7.0f);
      for (float* const marked : {commands, plain}) std::fill_n(marked, 4, -7.0f);
      std::fill_n(jacobian, 4 * size, -7.0f);
      const Status status = predict_with_jacobian(guarded, x.data(), commands, jacobian);
      ++counts[static_cast<std::size_t>(status)];
      CHECK(status == guarded.predict_features(x.data(), plain));
      CHECK(std::equal(commands, commands + 4, plain));
      float free_commands[4], expected[4 * size];
      std::fill_n(expected, 4 * size, -7.0f);
      if (has_output(status)) {
        REQUIRE(predict_with_jacobian(free, x.data(), free_commands, expected) == Status::ok);
      }
      CHECK(std::equal(jacobian, jacobian + 4 * size, expected));
      CHECK(has_output(status) == !std::equal(jacobian, jacobian + 4 * size, untouched));
    }
  }
  return counts;
}

int of(const Counts& counts, Status status) { return counts[static_cast<std::size_t>(status)]; }

}  // namespace

TEST_CASE("under every guard: its Status, its commands, and the derivatives of the network's own") {
  using Analytic = AnalyticInverse<Quadrotor<double>>;
  constexpr auto golden = static_cast<int>(DemoQuadModel::golden_features.size());
  const auto check = [&](const Counts& counts, Status least, bool some_ok) {
    CHECK(of(counts, least) > 0);
    CHECK((of(counts, Status::ok) > 0) == some_ok);
    CHECK(of(counts, Status::outside_envelope) == 2 * golden);
    CHECK(of(counts, Status::ok) + of(counts, least) == (least == Status::ok ? 2 : 1) * golden);
  };
  check(check_guard<TrainingGuard>(), Status::ok, true);
  check(check_guard<Guard<TrainingEnvelope>>(), Status::ok, true);
  check(check_guard<Extend<TrainingGuard, ClipCommands<>>>(), Status::ok, true);
  check(check_guard<Extend<TrainingGuard, ClipCommands<Tight>>>(), Status::limited, false);
  check(check_guard<Extend<TrainingGuard, RefuseCommands<Tight>>>(), Status::outside_limits, false);
  check(check_guard<Extend<TrainingGuard, RefuseCommands<>, ClipCommands<Tight>>>(), Status::limited, false);
  const Analytic analytic{Quadrotor<double>(airframe_value<PaperQuadrotor, double>(), Site<double>{})};
  using FallingBack = Extend<TrainingGuard, ClipCommands<Tight>, Fallback<Analytic>>;
  check(check_guard(FallingBack(analytic)), Status::limited, false);  // the fallback is not asked
}

TEST_CASE("numbers that are none: refused, and nothing is written") {
  test::SmallInstance broken;
  float commands[4] = {-7, -7, -7, -7}, jacobian[4 * size], plain[4];
  std::fill_n(jacobian, 4 * size, -7.0f);
  auto x = test::SmallModel::golden_features[0];
  SUBCASE("a weight is NaN") {
    broken.parameters[20] = std::nanf("");
    const InverseDynamics<test::SmallInstance> inverse(broken);
    CHECK(predict_with_jacobian(inverse, x.data(), commands, jacobian) == Status::output_not_finite);
  }
  SUBCASE("the commands are sound, a derivative overflows") {
    broken.input.standard_deviation[3] = 2e-38f;
    broken.output.standard_deviation.fill(1e3f);
    x[3] = broken.input.mean[3];
    const InverseDynamics<test::SmallInstance> inverse(broken);
    CHECK(inverse.predict_features(x.data(), plain) == Status::ok);
    CHECK(predict_with_jacobian(inverse, x.data(), commands, jacobian) == Status::output_not_finite);
  }
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
  CHECK(written + limited > 10);
  CHECK(refused > 3);
  CHECK(limited > 0);
  CHECK(statuses[40] == Status::outside_envelope);
}

}  // namespace

TEST_CASE("a batch gives each sample what it gets alone") {
  SUBCASE("a header") { check_batch<DemoQuadModel>(); }
  SUBCASE("a wrench") { check_batch<WrenchModel>(); }
  SUBCASE("a residual on the linearised inverse") { check_batch<ResidualModel>(); }
  const DemoBlock block;
  SUBCASE("a view of a block") { check_batch(block.view); }
  SUBCASE("a packed view") { check_batch(block.packed_view); }
}

TEST_CASE("a view of no block declines: batches and derivatives too") {
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
}

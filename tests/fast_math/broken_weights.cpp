// SPDX-License-Identifier: MIT
// Every number of a model made NaN or infinite in turn: no self test passes, no block opens, and a NaN weight reaches
// the commands. A verdict with such a number lets no model fly. Compiled by check.sh with and without -ffast-math, so
// nothing here may ask a floating-point number whether it is NaN.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>

#include "../../examples/models/demo_quadrotor.hpp"
#include "../support/block_bytes.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/evaluation/errors.hpp"
#include "pinnquad/exported/model_view.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace {

using namespace pinnquad;
using Model = DemoQuadModel;

float from_bits(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
constexpr std::uint32_t not_a_number = 0x7fc00000u, infinity = 0x7f800000u, negative = 0x80000000u;

/// The demo model as a header has it, but with numbers that a test may change; the portable kernel.
struct Instance {
  static constexpr ModelKind kind = ModelKind::instance;
  using Scalar = Model::Scalar;
  using Network = Model::Network;
  using Features = Model::Features;
  using Outputs = Model::Outputs;
  using Vehicle = Model::Vehicle;
  static constexpr auto golden_features = Model::golden_features;
  static constexpr auto golden_commands = Model::golden_commands;

  Network::Parameters parameters = Model::parameters;
  Scaler<float, 16> input = Model::input;
  Scaler<float, 4> output = Model::output;
  std::array<float, 16> envelope_lower = Model::envelope_lower;
  std::array<float, 16> envelope_upper = Model::envelope_upper;

  void forward(const float* x, float* y) const noexcept { Network::forward(parameters.data(), x, y); }
};

/// Constants with one of them broken, for the check of a header that the compiler makes.
template <std::size_t Weight, bool Infinite>
struct BrokenHeader : Model {
  static constexpr auto parameters = [] {
    auto numbers = Model::parameters;
    numbers[Weight] = Infinite ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    return numbers;
  }();
};

int failures = 0;

void expect(bool right, const char* what, std::size_t index) {
  if (right) return;
  if (++failures <= 10) std::printf("%s: number %zu\n", what, index);
}

template <class AnyModel>
bool refused(const AnyModel& model) {
  return self_test(InverseDynamics<AnyModel>(model)) != Status::ok;
}

template <class AnyModel>
Status answer(const AnyModel& model) {
  Commands<float> commands{};
  return InverseDynamics<AnyModel>(model).predict_features(Model::golden_features[0].data(), commands);
}

template <std::size_t Weight, bool Infinite>
void try_header() {
  constexpr detail::StatedNumber fault = detail::fault_of_header<BrokenHeader<Weight, Infinite>>();
  expect(fault == detail::StatedNumber::weight, "weight of a header", Weight);
}

void try_instance() {
  const auto model = std::make_unique<Instance>();
  expect(!refused(*model), "sound instance", 0);
  const auto try_each = [&](float* first, std::size_t count, const char* what, bool weights) {
    for (std::size_t i = 0; i < count; ++i) {
      const float sound = first[i];
      for (const std::uint32_t bits : {not_a_number, not_a_number | negative, infinity, infinity | negative}) {
        const float bad = from_bits(bits);
        std::memcpy(first + i, &bad, sizeof bad);
        expect(refused(*model), what, i);
        if (weights && (bits & ~negative) == not_a_number) {
          expect(answer(*model) == Status::output_not_finite, "NaN swallowed by the portable kernel", i);
        }
      }
      first[i] = sound;
    }
  };
  try_each(model->parameters.data(), model->parameters.size(), "self test of an instance, weight", true);
  try_each(model->input.mean.data(), 16, "self test, input mean", false);
  try_each(model->input.standard_deviation.data(), 16, "self test, input spread", false);
  try_each(model->output.mean.data(), 4, "self test, output mean", false);
  try_each(model->output.standard_deviation.data(), 4, "self test, output spread", false);
  try_each(model->envelope_lower.data(), 16, "self test, envelope", false);
  try_each(model->envelope_upper.data(), 16, "self test, envelope", false);
}

void try_block() {
  using Layout = ModelBlockLayout<Model>;
  test::BlockBytes block(model_block<Model>());
  ModelView<Model> view;
  ModelView<Model> packed_view;
  const auto packed = std::make_unique<ModelView<Model>::Packed>();
  const auto open = [&](ModelView<Model>& opened) {
    return ModelView<Model>::open(block.data(), block.size(), opened);
  };
  if (open(view) != Status::ok ||
      ModelView<Model>::open(block.data(), block.size(), packed_view, *packed) != Status::ok) {
    expect(false, "sound block", 0);
    return;
  }
  expect(!refused(view) && !refused(packed_view), "sound block", 0);
  const std::size_t golden = Model::golden_features.size();
  const std::size_t first_weight = Layout::parameters(golden);
  const std::size_t count = first_weight + Layout::parameter_count;
  // the CRC over what stands before a number, so that sealing a block costs half of it
  std::uint32_t before = crc32(block.data(), block.scalars());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = block.scalars() + i * sizeof(float);
    const float sound = block.scalar<float>(i);
    // NaN for every number, and an infinity of either sign for every other one
    for (const std::uint32_t bits : {not_a_number, infinity | (i % 2 == 0 ? negative : 0u)}) {
      block.set_scalar(i, from_bits(bits));
      block.set_u32(block.size() - 4, crc32(block.data() + at, block.size() - 4 - at, before));
      ModelView<Model> opened;
      expect(open(opened) == Status::block_corrupt && opened.parameters() == nullptr, "open", i);
      if (i < first_weight) continue;  // scalers and envelope are copied when a view is opened
      expect(refused(view), "self test of a view, weight", i - first_weight);
      if constexpr (has_vector_unit<float>) packed->assign(packed_view.parameters());
      expect(refused(packed_view), "self test of a packed view, weight", i - first_weight);
      if (bits == not_a_number) {
        expect(answer(packed_view) == Status::output_not_finite, "NaN swallowed by the vector unit's kernel",
               i - first_weight);
      }
    }
    block.set_scalar(i, sound);
    before = crc32(block.data() + at, sizeof(float), before);
  }
}

/// The judgement of a model whose error is no number.
void try_verdict() {
  volatile std::uint64_t stored = 0x7ff8000000000000u;
  const std::uint64_t bits = stored;
  double bad = 0;
  std::memcpy(&bad, &bits, sizeof bad);
  expect(!Verdict{0.5, 0.25, 0.5}.worse_than_mean(), "sound verdict", 0);
  expect((Verdict{bad, 0.25, 0.5}.worse_than_mean()), "verdict, NaN as mean", 0);
  expect(!(Verdict{0.5, 0.25, bad}.has_poor_motor()), "verdict, NaN as worst motor", 0);
  expect(!(Verdict{bad, bad, bad}.beats_linear_regression()), "verdict beside linear regression", 0);
  expect((Verdict{0.5, bad, 0.5}.beats_linear_regression()), "verdict without linear regression", 0);
}

}  // namespace

int main() {
  try_verdict();
  expect(self_test(InverseDynamics<Model>{}) == Status::ok, "sound header", 0);
  constexpr std::size_t last = Model::parameters.size() - 1;
  try_header<0, false>();
  try_header<400, true>();
  try_header<last / 2, false>();
  try_header<last - 5, true>();
  try_header<last, false>();
  try_instance();
  try_block();
  if (failures > 0) std::printf("%d broken numbers were not noticed\n", failures);
  return failures == 0 ? 0 : 1;
}

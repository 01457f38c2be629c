// SPDX-License-Identifier: MIT
// The small model in double, with an empty envelope, and as an instance whose numbers are members instead of constants.
#pragma once

#include "small_model.hpp"

namespace pinnquad::test {

namespace small_numbers {
/// Float constants as doubles that no float is.
template <std::size_t Size>
constexpr std::array<double, Size> widened(const std::array<float, Size>& from) {
  std::array<double, Size> to{};
  for (std::size_t i = 0; i < Size; ++i) to[i] = static_cast<double>(from[i]) * 1.0000000001;
  return to;
}
template <int Size>
constexpr Scaler<double, Size> widened(const Scaler<float, Size>& from) {
  return {widened(from.mean), widened(from.standard_deviation)};
}
template <std::size_t Rows, std::size_t Columns>
constexpr std::array<std::array<double, Columns>, Rows> widened(
    const std::array<std::array<float, Columns>, Rows>& from) {
  std::array<std::array<double, Columns>, Rows> to{};
  for (std::size_t i = 0; i < Rows; ++i) to[i] = widened(from[i]);
  return to;
}
}  // namespace small_numbers

struct DoubleNumbers : SmallNumbers {
  using Scalar = double;
  using Network = SmallNumbers::Network::Rebind<double>;
  static constexpr auto parameters = small_numbers::widened(SmallNumbers::parameters);
  static constexpr auto input = small_numbers::widened(SmallNumbers::input);
  static constexpr auto output = small_numbers::widened(SmallNumbers::output);
  static constexpr auto envelope_lower = small_numbers::widened(SmallNumbers::envelope_lower);
  static constexpr auto envelope_upper = small_numbers::widened(SmallNumbers::envelope_upper);
  static constexpr auto golden_features = small_numbers::widened(SmallNumbers::golden_features);
  static constexpr auto golden_commands = small_numbers::widened(SmallNumbers::golden_commands);
};
using DoubleModel = AsHeader<DoubleNumbers>;

/// Its envelope is empty: it declines always.
struct NowhereTrained : Unchecked<SmallNumbers> {
  static constexpr std::array<float, 16> envelope_lower = pinnquad::detail::ones<float, 16>;
  static constexpr std::array<float, 16> envelope_upper{};
};

/// Members read at run time: weights and all else can be changed, and a fault put in.
struct SmallInstance {
  static constexpr ModelKind kind = ModelKind::instance;
  using Scalar = float;
  using Network = SmallModel::Network;
  using Features = SmallModel::Features;
  using Outputs = SmallModel::Outputs;
  using Vehicle = SmallModel::Vehicle;

  std::array<float, 172> parameters = SmallModel::parameters;
  Scaler<float, 16> input = SmallModel::input;
  Scaler<float, 4> output = SmallModel::output;
  std::array<float, 16> envelope_lower = SmallModel::envelope_lower;
  std::array<float, 16> envelope_upper = SmallModel::envelope_upper;
  std::array<std::array<float, 16>, 6> golden_features = SmallModel::golden_features;
  std::array<std::array<float, 4>, 6> golden_commands = SmallModel::golden_commands;

  void forward(const float* x, float* y) const noexcept { Network::forward(parameters.data(), x, y); }
};

}  // namespace pinnquad::test

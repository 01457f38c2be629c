// SPDX-License-Identifier: MIT
// The small model in double, with an empty envelope, and as an instance whose numbers are members instead of constants.
#pragma once

#include "support/small_model.hpp"

namespace pinnquad::test {

namespace detail {
template <std::size_t Size>
constexpr std::array<double, Size> widened(const std::array<float, Size>& values) {
  std::array<double, Size> result{};
  for (std::size_t i = 0; i < Size; ++i) result[i] = static_cast<double>(values[i]);
  return result;
}
template <std::size_t Rows, std::size_t Size>
constexpr std::array<std::array<double, Size>, Rows> widened(const std::array<std::array<float, Size>, Rows>& rows) {
  std::array<std::array<double, Size>, Rows> result{};
  for (std::size_t i = 0; i < Rows; ++i) result[i] = widened(rows[i]);
  return result;
}
}  // namespace detail

struct SmallDoubleModel {
  using Scalar = double;
  using Network = SmallModel::Network::Rebind<double>;
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  using Vehicle = PaperQuadrotor;
  static constexpr int format_version = SmallModel::format_version;
  static constexpr auto parameters = detail::widened(SmallModel::parameters);
  static constexpr Scaler<double, 16> input{detail::widened(SmallModel::input.mean),
                                            detail::widened(SmallModel::input.standard_deviation)};
  static constexpr Scaler<double, 4> output{detail::widened(SmallModel::output.mean),
                                            detail::widened(SmallModel::output.standard_deviation)};
  static constexpr auto envelope_lower = detail::widened(SmallModel::envelope_lower);
  static constexpr auto envelope_upper = detail::widened(SmallModel::envelope_upper);
  static constexpr auto golden_features = detail::widened(SmallModel::golden_features);
  static constexpr auto golden_commands = detail::widened(SmallModel::golden_commands);
};

/// Its envelope is empty: it declines always.
struct NowhereTrained : SmallModel {
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
  static constexpr int format_version = SmallModel::format_version;

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

// SPDX-License-Identifier: MIT
// The small model as a header of format 2: it says what it was trained for.
#pragma once

#include <cstdint>

#include "small_model.hpp"

namespace pinnquad::test {

struct DescribedModel : SmallModel {
  static constexpr int format_version = 2;
  static constexpr std::uint64_t training_data_hash = 0x0123456789abcdefu;
  static constexpr int training_rows = 6000;
  static constexpr const char* frame = "body FRD, world NED";
  static constexpr std::array<const char*, 16> feature_names = {
      "vdot_bx", "vdot_by", "vdot_bz", "wdot_x", "wdot_y", "wdot_z", "v_bx",    "v_by",
      "v_bz",    "w_x",     "w_y",     "w_z",    "roll",   "pitch",  "sin_yaw", "cos_yaw"};
  static constexpr std::array<const char*, 16> feature_units = {
      "m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2", "m/s", "m/s",
      "m/s",   "rad/s", "rad/s", "rad/s",   "rad",     "rad",     "1",   "1"};
  static constexpr std::array<const char*, 4> output_names = {"u1", "u2", "u3", "u4"};
  static constexpr const char* output_unit = "1";
  static constexpr const char* vehicle_name = "paper_quadrotor";
  static constexpr std::array<std::array<int, 3>, 4> motor_torque_signs = {
      {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}}};
};

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

/// The small model in double.
struct DoubleModel : DescribedModel {
  using Scalar = double;
  using Network = DescribedModel::Network::Rebind<double>;
  static constexpr auto parameters = widened(DescribedModel::parameters);
  static constexpr auto input = widened(DescribedModel::input);
  static constexpr auto output = widened(DescribedModel::output);
  static constexpr auto envelope_lower = widened(DescribedModel::envelope_lower);
  static constexpr auto envelope_upper = widened(DescribedModel::envelope_upper);
  static constexpr auto golden_features = widened(DescribedModel::golden_features);
  static constexpr auto golden_commands = widened(DescribedModel::golden_commands);
};

}  // namespace pinnquad::test

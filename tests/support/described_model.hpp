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

}  // namespace pinnquad::test

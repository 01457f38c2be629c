// SPDX-License-Identifier: MIT
// The small model as a header that was trained on rows of a clock, word by word as its writer says it.
#pragma once

#include <cstdint>

#include "small_model.hpp"

namespace pinnquad::test {

struct RecordedNumbers : SmallNumbers {
  static constexpr int format_version = model_format_version;
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
  static constexpr std::array<const char*, 4> output_units = {"1", "1", "1", "1"};
  static constexpr const char* vehicle_name = "paper_quadrotor";
  static constexpr std::array<std::array<int, 3>, 4> motor_torque_signs = {
      {{-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, -1}}};
  static constexpr std::array<const char*, 7> records = {"answer",  "commands",   "clock", "window",
                                                         "columns", "allocation", "base"};
  static constexpr const char* answer =
      "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>, pinnquad::Relu, pinnquad::Dense<4>>";
  static constexpr CommandMeaning command_meaning = CommandMeaning::thrust;
  static constexpr double command_lower = 0.0;
  static constexpr double command_upper = 1.0;
  static constexpr double sample_period_s = 0.004;
  static constexpr double lag_removed_s = 0.0125;
  static constexpr int window_taps = 1;
  static constexpr bool causal = true;
  static constexpr std::array<const char*, 0> column_names{};
  static constexpr std::array<const char*, 0> column_units{};
  static constexpr std::array<std::array<double, 4>, 4> allocation = {
      {{7.3786012, 7.3786012, 7.3786012, 7.3786012},
       {-1.8000245, 1.8000245, 1.8000245, -1.8000245},
       {1.8000245, -1.8000245, 1.8000245, -1.8000245},
       {0.09809941, 0.09809941, -0.09809941, -0.09809941}}};
  static constexpr const char* base = "";
};

using RecordedModel = Hashed<RecordedNumbers>;

}  // namespace pinnquad::test

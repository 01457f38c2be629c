// SPDX-License-Identifier: MIT
// The small model as a header of format 3: it says in which terms it was trained.
#pragma once

#include "described_model.hpp"

namespace pinnquad::test {

struct RecordedModel : DescribedModel {
  static constexpr int format_version = 3;
  static constexpr std::array<const char*, 7> records = {"answer",  "commands",   "clock", "window",
                                                         "columns", "allocation", "base"};
  static constexpr const char* answer =
      "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<8>, pinnquad::Relu, pinnquad::Dense<4>>";
  static constexpr std::array<const char*, 4> output_units = {"1", "1", "1", "1"};
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

}  // namespace pinnquad::test

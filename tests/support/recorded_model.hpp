// SPDX-License-Identifier: MIT
// The small model as a header that was trained on rows of a clock, word by word as its writer says it.
#pragma once

#include <cstdint>

#include "small_model.hpp"

namespace pinnquad::test {

struct RecordedNumbers : SmallNumbers {
  static constexpr int format_version = header_format_version;
  static constexpr std::uint64_t training_data_hash = 0x0123456789abcdefu;
  static constexpr int training_rows = 6000;
  static constexpr CommandMeaning command_meaning = CommandMeaning::thrust;
  static constexpr double command_lower = 0.0;
  static constexpr double command_upper = 1.0;
  static constexpr double sample_period_s = 0.004;
  static constexpr double lag_removed_s = 0.0125;
  static constexpr std::array<std::array<double, 4>, 4> allocation = {
      {{7.3786012, 7.3786012, 7.3786012, 7.3786012},
       {-1.8000245, 1.8000245, 1.8000245, -1.8000245},
       {1.8000245, -1.8000245, 1.8000245, -1.8000245},
       {0.09809941, 0.09809941, -0.09809941, -0.09809941}}};
};

using RecordedModel = Hashed<RecordedNumbers>;

}  // namespace pinnquad::test

// SPDX-License-Identifier: MIT
// A part of a study's trainings, for job arrays.
#pragma once

#include <stdexcept>
#include <string>

#include "command_line/options.hpp"

namespace study {

/// A whole number of at most 9 digits, no zero before it. False if the text is none.
inline bool parse_natural(const std::string& text, int& value) {
  constexpr int most = 999999999;
  return programs::parse_decimal(text, 0, most, value);
}

/// Part `index` of `count`, from 1: "2/8".
struct Shard {
  int index = 1;
  int count = 1;
};

/// Throws std::invalid_argument, one line.
inline Shard parse_shard(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || !parse_natural(text.substr(0, slash), shard.index) ||
      !parse_natural(text.substr(slash + 1), shard.count) || shard.index < 1 || shard.index > shard.count) {
    throw std::invalid_argument("--shard " + text + ": expected i/n with i from 1 to n, such as 2/8");
  }
  return shard;
}

}  // namespace study

// SPDX-License-Identifier: MIT
// Numbers in a sentence.
#pragma once

#include <cstdio>
#include <string>

namespace programs {

/// printf's, as a text.
template <class... Values>
std::string in_words(const char* format, Values... values) {
  std::string text(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), ' ');
  std::snprintf(text.data(), text.size() + 1, format, values...);
  return text;
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// Reads the text of a predictor (model/description.hpp) piece by piece. std::string_view::substr() may throw: it does
// not fly.
#pragma once

#include <string_view>

#include "pinnquad/core/instruction_set.hpp"

namespace pinnquad::detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Reads a description from left to right; spaces don't count.
class DescriptionReader {
 public:
  constexpr explicit DescriptionReader(std::string_view text) noexcept : rest_(text) {}

  constexpr bool at_end() noexcept {
    skip_spaces();
    return rest_.empty();
  }
  /// Takes the text where it is next.
  constexpr bool take(std::string_view text) noexcept {
    skip_spaces();
    if (rest_.size() < text.size() || std::string_view(rest_.data(), text.size()) != text) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  /// Takes a name, where it ends there: Gelu is no GeluTanh.
  constexpr bool take_name(std::string_view name) noexcept {
    const DescriptionReader before = *this;
    if (!take(name)) return false;
    const char next = rest_.empty() ? ' ' : rest_.front();
    if ((next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') || (next >= '0' && next <= '9')) *this = before;
    return rest_.size() != before.rest_.size();
  }
  /// A number from 0 to `most`, or -1.
  constexpr int number(int most) noexcept {
    skip_spaces();
    int value = -1;
    while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      value = 10 * (value < 0 ? 0 : value) + (rest_.front() - '0');
      if (value > most) return -1;
      rest_.remove_prefix(1);
    }
    return value;
  }

 private:
  constexpr void skip_spaces() noexcept {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad::detail

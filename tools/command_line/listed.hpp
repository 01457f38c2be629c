// SPDX-License-Identifier: MIT
// Things named one after the other, as messages and tables say them.
#pragma once

#include <string>

namespace programs {

/// "a, b, c": what `text_of` says of each item.
template <class Items, class TextOf>
std::string listed(const Items& items, const TextOf& text_of) {
  std::string text;
  for (const auto& item : items) {
    if (!text.empty()) text += ", ";
    text += text_of(item);
  }
  return text;
}

/// Of texts.
template <class Texts>
std::string listed(const Texts& texts) {
  return listed(texts, [](const std::string& text) { return text; });
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// Things named one after the other, as messages and tables say them.
#pragma once

#include <string>

namespace programs {

/// "a, b" and then "c": "a, b, c".
inline void add_to_list(std::string& list, const std::string& item) {
  if (!list.empty()) list += ", ";
  list += item;
}

/// "a, b, c": what `text_of` says of each item.
template <class Items, class TextOf>
std::string listed(const Items& items, const TextOf& text_of) {
  std::string text;
  for (const auto& item : items) add_to_list(text, text_of(item));
  return text;
}

/// Of texts.
template <class Texts>
std::string listed(const Texts& texts) {
  return listed(texts, [](const std::string& text) { return text; });
}

}  // namespace programs

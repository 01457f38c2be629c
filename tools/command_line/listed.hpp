// SPDX-License-Identifier: MIT
// Things named one after the other, as messages and tables say them.
#pragma once

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

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

/// Picks the named items of `all`, in its order; all where `names` is empty. `name_of` says an item's name, `option`
/// and `what` stand in the error: "--variants: no variant 'x'; known: a, b". Throws std::invalid_argument.
template <class Item, class NameOf>
std::vector<Item> chosen_by_name(const std::vector<Item>& all, const std::vector<std::string>& names,
                                 const NameOf& name_of, const std::string& option, const std::string& what) {
  for (const std::string& name : names) {
    if (std::any_of(all.begin(), all.end(), [&](const Item& item) { return name_of(item) == name; })) continue;
    throw std::invalid_argument(option + ": no " + what + " '" + name + "'; known: " + listed(all, name_of));
  }
  if (names.empty()) return all;
  std::vector<Item> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen),
               [&](const Item& item) { return std::find(names.begin(), names.end(), name_of(item)) != names.end(); });
  return chosen;
}

}  // namespace programs

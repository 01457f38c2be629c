// SPDX-License-Identifier: MIT
// A table of a TOML file, key by key: what is missing, unknown, or of another kind or range is said with line and
// column.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "logs/nearest_names.hpp"
#include "logs/toml_file.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {

/// Range of a number of the file.
struct NumberRange {
  double least;
  double most;
  const char* words;
};
/// Nothing that a program is told about has a number beyond it.
inline constexpr double largest_number = 1e9;
inline constexpr NumberRange above_zero = {std::numeric_limits<double>::denorm_min(), largest_number,
                                           "a value above 0, at most 1e9"};
inline constexpr NumberRange from_zero = {0, largest_number, "a value of 0 or more, at most 1e9"};
inline constexpr NumberRange of_either_sign = {-largest_number, largest_number, "a value from -1e9 to 1e9"};
inline constexpr NumberRange zero_to_one = {0, 1, "a value from 0 to 1"};

/// A table of a file: asks for its keys one by one, and in the end for those that nobody asked for. `what` are its
/// keys: "a key of an airframe".
class TomlTable {
 public:
  TomlTable(const std::string& path, const toml::table& table, const char* what)
      : path_(path), table_(table), what_(what) {}

  double number(const char* key, const NumberRange& range) { return as_number(required(key, "a number"), range); }
  double number(const char* key, const NumberRange& range, double otherwise) {
    const toml::node* node = optional(key);
    return node ? as_number(*node, range) : otherwise;
  }
  std::array<double, 3> triple(const char* key, const NumberRange& range) {
    return as_triple(required(key, three_numbers), range);
  }
  std::array<double, 3> triple(const char* key, const NumberRange& range, const std::array<double, 3>& otherwise) {
    const toml::node* node = optional(key);
    return node ? as_triple(*node, range) : otherwise;
  }
  std::string text(const char* key, const std::string& expected) { return as_text(required(key, expected), expected); }
  std::string text(const char* key, const std::string& expected, const std::string& otherwise) {
    const toml::node* node = optional(key);
    return node ? as_text(*node, expected) : otherwise;
  }
  /// A text that is neither empty nor of several lines.
  std::string line(const char* key) {
    constexpr const char* one_line = "a text on one line";
    const toml::node& node = required(key, one_line);
    const std::string text = as_text(node, one_line);
    if (text.empty() || text != printable(text)) refuse(node, one_line, described(node));
    return text;
  }
  bool truth(const char* key, bool otherwise) {
    const toml::node* node = optional(key);
    if (!node) return otherwise;
    if (!node->is_boolean()) refuse(*node, "true or false", described(*node));
    return node->as_boolean()->get();
  }
  /// The value of one of the words, which stand in the order of the values. `otherwise` where the key is not there.
  template <class Value>
  Value choice(const char* key, const std::vector<const char*>& words, Value otherwise) {
    const toml::node* node = optional(key);
    if (!node) return otherwise;
    std::string expected;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (node->is_string() && node->as_string()->get() == words[i]) return static_cast<Value>(i);
      expected += (i == 0 ? "\"" : i + 1 == words.size() ? " or \"" : ", \"") + std::string(words[i]) + "\"";
    }
    refuse(*node, expected, described(*node));
  }
  const toml::node& required(const char* key, const std::string& expected) {
    const toml::node* node = optional(key);
    if (!node) refuse(table_, "`" + std::string(key) + "`, " + expected, "no such key");
    return *node;
  }
  void require_no_more() const {
    for (const auto& [key, node] : table_) {
      if (known_.count(std::string(key.str())) == 0) {
        refuse(
            key.source(), what_,
            "`" + printable(key.str()) + "`; " + nearest_names(std::string(key.str()), {known_.begin(), known_.end()}));
      }
    }
  }
  /// Null where the key is not there.
  const toml::node* optional(const char* key) {
    known_.insert(key);
    return table_.get(key);
  }
  std::string as_text(const toml::node& node, const std::string& expected) const {
    if (!node.is_string()) refuse(node, expected, described(node));
    return text_of_toml(path_, *node.as_string());
  }
  double as_number(const toml::node& node, const NumberRange& range) const {
    if (!node.is_number()) refuse(node, "a number", described(node));
    const double value = toml_number(node);
    if (!(value >= range.least && value <= range.most)) refuse(node, range.words, described(node));
    return value;
  }
  [[noreturn]] void refuse(const toml::node& node, const std::string& expected, const std::string& found) const {
    refuse(node.source(), expected, found);
  }

 private:
  static constexpr const char* three_numbers = "an array of three numbers";

  std::array<double, 3> as_triple(const toml::node& node, const NumberRange& range) const {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) refuse(node, three_numbers, described(node));
    return {as_number((*array)[0], range), as_number((*array)[1], range), as_number((*array)[2], range)};
  }
  [[noreturn]] void refuse(const toml::source_region& where, const std::string& expected,
                           const std::string& found) const {
    refuse_toml(path_, where, expected, found);
  }

  const std::string& path_;
  const toml::table& table_;
  const char* what_;
  std::set<std::string> known_;
};

}  // namespace pinnquad::logs

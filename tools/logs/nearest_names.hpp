// SPDX-License-Identifier: MIT
// A name that is none, and those that it may have meant.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {

/// Insertions, deletions and replacements that make `b` of `a` (Levenshtein); case counts for nothing.
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// "nearest: a, b, c" of those known, at most three, each once; "it has none" of none.
inline std::string nearest_names(const std::string& name, std::vector<std::string> known) {
  if (known.empty()) return "it has none";
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    const auto distance = [&](const std::string& other) {  // a part of a name is near
      return other.find(name) != std::string::npos ? 0 : edit_distance(name, other);
    };
    return distance(a) < distance(b);
  });
  std::string text = "nearest: ";
  for (std::size_t i = 0; i < std::min<std::size_t>(3, known.size()); ++i) {
    text += (i > 0 ? ", " : "") + printable(known[i]);
  }
  return text;
}

}  // namespace pinnquad::logs

// SPDX-License-Identifier: MIT
// A trajectory's name out of a flight's name: "*_(*)_*" makes lissajous of B10_lissajous_fast_rep1.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace programs {

/// A pattern has one pair of brackets, and at most this many stars: each may stand for any letters, as few as will do.
inline constexpr std::size_t most_stars = 6;

inline bool is_name_pattern(std::string_view pattern) {
  const std::size_t open = pattern.find('('), close = pattern.find(')');
  return open != pattern.npos && close != pattern.npos && open < close && pattern.find('(', open + 1) == pattern.npos &&
         pattern.find(')', close + 1) == pattern.npos &&
         static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '*')) <= most_stars;
}

namespace detail {

/// True where the whole name fits; `begin` and `end` are what the brackets hold.
inline bool fits(std::string_view pattern, std::string_view name, std::size_t at, std::size_t& begin,
                 std::size_t& end) {
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] == '(') {
      begin = at;
    } else if (pattern[i] == ')') {
      end = at;
    } else if (pattern[i] == '*') {
      for (std::size_t next = at; next <= name.size(); ++next) {
        if (fits(pattern.substr(i + 1), name, next, begin, end)) return true;
      }
      return false;
    } else if (at >= name.size() || name[at++] != pattern[i]) {
      return false;
    }
  }
  return at == name.size();
}

}  // namespace detail

/// The part of a name within the brackets of the pattern; the name itself where it does not fit, or is longer than any
/// name.
inline std::string part_of_name(std::string_view pattern, const std::string& name) {
  constexpr std::size_t longest = 120;
  std::size_t begin = 0, end = 0;
  if (name.size() > longest || !is_name_pattern(pattern) || !detail::fits(pattern, name, 0, begin, end)) return name;
  return end > begin ? name.substr(begin, end - begin) : name;
}

}  // namespace programs

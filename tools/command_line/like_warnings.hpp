// SPDX-License-Identifier: MIT
// Warnings of one kind as one line: how many, and where the first ones are.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace programs {

/// Warnings that differ in numbers, in an axis or in the name before ": " (after "import: ") alone become one line: the
/// first, how many are like it, and what the next three begin with. `all`: how to see each, such as "--json has all".
inline std::vector<std::string> collapsed(const std::vector<std::string>& warnings, const std::string& all) {
  constexpr std::size_t most_named = 3;
  const auto start_of = [](const std::string& text) { return std::size_t(text.rfind("import: ", 0) == 0 ? 8 : 0); };
  const auto begin_of = [&](const std::string& text) {
    return text.substr(start_of(text), text.find(": ", start_of(text)) - start_of(text));
  };
  const auto kind_of = [&](const std::string& text) {
    const std::string_view digits = "0123456789";
    const std::size_t from = text.find(": ", start_of(text));
    std::string kind;
    for (std::size_t at = from == text.npos ? 0 : from; at < text.size(); ++at) {
      const bool exponent = text[at] == 'e' && at > 0 && digits.find(text[at - 1]) != digits.npos;
      if (!exponent && std::string_view("+-.0123456789").find(text[at]) == digits.npos) kind += text[at];
    }
    for (const std::string_view axis : {"roll", "pitch", "yaw", "thrust"}) {
      for (std::size_t at = 0; (at = kind.find(axis)) != kind.npos;) kind.erase(at, axis.size());
    }
    return kind;
  };
  std::vector<std::string> kinds, lines, named;
  std::vector<std::size_t> counts;
  for (const std::string& warning : warnings) {
    const std::string kind = kind_of(warning);
    std::size_t at = 0;
    while (at < kinds.size() && kinds[at] != kind) ++at;
    if (at == kinds.size()) {
      kinds.push_back(kind);
      lines.push_back(warning);
      named.emplace_back();
      counts.push_back(0);
    } else if (++counts[at] <= most_named) {
      named[at] += (named[at].empty() ? "" : ", ") + begin_of(warning);
    }
  }
  for (std::size_t at = 0; at < lines.size(); ++at) {
    if (counts[at] == 0) continue;
    lines[at] += " (and " + std::to_string(counts[at]) + " more like it: " + named[at] +
                 (counts[at] > most_named ? ", ..." : "") + "; " + all + ")";
  }
  return lines;
}

}  // namespace programs

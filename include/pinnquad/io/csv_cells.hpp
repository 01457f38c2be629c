// SPDX-License-Identifier: MIT
// A record of comma-separated text and its cells, as RFC 4180 has them: a cell in quotation marks may hold commas, line ends
// and, doubled, quotation marks. Blanks around a cell do not count.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace pinnquad {

/// A cell as a message shows it: quoted, cut, and on one line whatever bytes it holds.
inline std::string quoted_cell(std::string_view cell) {
  constexpr std::size_t most_shown = 40;
  if (cell.empty()) return "an empty cell";
  std::string shown = "\"";
  for (const char c : cell.substr(0, most_shown)) shown += c >= ' ' && c <= '~' ? c : '?';
  return shown + (cell.size() > most_shown ? "...\"" : "\"");
}

namespace detail {

inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Follows a record character by character and tells whether it stands inside quotation marks. They open a cell only at
/// its beginning: in `5" propeller` there is none.
class QuotationState {
 public:
  void follow(std::string_view text) noexcept {
    for (const char c : text) {
      if (place_ == Place::quoted) {
        if (c == '"') place_ = Place::closed;
      } else if (c == '"' && place_ == Place::closed) {
        place_ = Place::quoted;  // doubled: a mark of the text
      } else if (c == ',') {
        place_ = Place::begin;
      } else if (c == '"' && place_ == Place::begin) {
        place_ = Place::quoted;
      } else if (!(place_ == Place::begin && (c == ' ' || c == '\t'))) {
        place_ = Place::plain;
      }
    }
  }
  bool inside() const noexcept { return place_ == Place::quoted; }

 private:
  enum class Place { begin, plain, quoted, closed };
  Place place_ = Place::begin;
};

/// The cells of a record in which there are quotation marks; `unquoted` holds the text of those that are quoted.
/// A cell that goes on behind its closing mark is taken as it stands, marks and all.
inline void split_quoted_fields(std::string_view record, std::vector<std::string_view>& fields, std::string& unquoted) {
  fields.clear();
  unquoted.clear();
  unquoted.reserve(record.size());  // what is appended never moves
  for (;;) {
    std::string_view rest = record;
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    std::size_t comma = record.find(',');
    bool whole = false;
    if (!rest.empty() && rest[0] == '"') {
      const std::size_t begin = unquoted.size();
      std::size_t i = 1;
      for (; i < rest.size(); ++i) {
        if (rest[i] == '"') {
          if (i + 1 >= rest.size() || rest[i + 1] != '"') break;
          ++i;
        }
        unquoted += rest[i];
      }
      const std::size_t behind = rest.find_first_not_of(" \t", i + 1);
      const std::size_t offset = record.size() - rest.size();
      whole = i < rest.size() && (behind == std::string_view::npos || rest[behind] == ',');
      comma = behind == std::string_view::npos ? behind : record.find(',', offset + behind);
      if (whole) fields.push_back(std::string_view(unquoted).substr(begin));
    }
    if (!whole) fields.push_back(trimmed(record.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    record.remove_prefix(comma + 1);
  }
}

}  // namespace detail

/// The cells of a line without quotation marks.
inline void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(detail::trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

namespace detail {

/// Text as a cell that reads back as the same text: in quotation marks where it needs them.
inline std::string csv_cell(std::string_view text) {
  if (trimmed(text) == text && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? std::string(2, c) : std::string(1, c);
  return cell + '"';
}

}  // namespace detail
}  // namespace pinnquad

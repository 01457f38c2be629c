// SPDX-License-Identifier: MIT
#include "logs/list_cells.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/csv_head.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {
namespace {

constexpr std::size_t most_numbers = 64, most_depth = 4;

/// The numbers of a list and the place of each: "[1][0]". False if the text is no list of numbers.
bool read_list(std::string_view text, std::vector<double>& numbers, std::vector<std::string>* places) {
  constexpr std::string_view between = ", \t\n\r";
  std::vector<std::size_t> counts;
  numbers.clear();
  const auto count_one = [&counts] {
    if (!counts.empty()) ++counts.back();
  };
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '[') {
      if (counts.size() == most_depth || (counts.empty() && i > 0)) return false;
      counts.push_back(0);
      ++i;
    } else if (text[i] == ']') {
      if (counts.empty()) return false;
      counts.pop_back();
      count_one();
      ++i;
      if (counts.empty()) return text.find_first_not_of(between, i) == std::string_view::npos && !numbers.empty();
    } else if (between.find(text[i]) != std::string_view::npos) {
      ++i;
    } else {
      const std::size_t end = text.find_first_of(", \t\n\r[]", i);
      double value = 0;
      if (counts.empty() || end == std::string_view::npos || numbers.size() == most_numbers) return false;
      if (!cell_number(text.substr(i, end - i), value)) return false;
      numbers.push_back(value);
      if (places != nullptr) {
        std::string place;
        for (const std::size_t count : counts) place += '[' + std::to_string(count) + ']';
        places->push_back(std::move(place));
      }
      count_one();
      i = end;
    }
  }
  return false;
}

}  // namespace

void expand_lists(LogTopic& topic) {
  std::vector<LogText> texts;
  for (LogText& text : topic.texts) {
    std::vector<double> numbers;
    std::vector<std::string> places;
    if (text.values.empty() || !read_list(text.values[0], numbers, &places)) {
      texts.push_back(std::move(text));
      continue;
    }
    std::vector<std::vector<double>> values(numbers.size());
    for (std::size_t row = 0; row < text.values.size(); ++row) {
      if (!read_list(text.values[row], numbers, nullptr) || numbers.size() != values.size()) {
        throw InputError(topic.file, static_cast<std::size_t>(topic.place[row]), 0,
                         "a list of " + std::to_string(values.size()) + " numbers in column " + text.name,
                         quoted_cell(text.values[row]));
      }
      for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(numbers[i]);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      // a list of one number is that number
      topic.columns.push_back({values.size() == 1 ? text.name : text.name + places[i], std::move(values[i])});
    }
  }
  topic.texts = std::move(texts);
}

}  // namespace pinnquad::logs

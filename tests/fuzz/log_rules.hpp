// SPDX-License-Identifier: MIT
// Rules that every log keeps, whatever reader made it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "fuzz/fuzzing.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad_test {

/// Topics have rows, each with a place in the file of `size` bytes, columns as long as the clock, and few warnings.
inline void expect_sound(const pinnquad::logs::FlightLog& log, std::size_t size) {
  for (const pinnquad::logs::LogTopic& topic : log.topics) {
    const std::size_t rows = topic.size();
    expect(rows > 0, "a topic has a row");
    expect(topic.place.size() == rows, "every row has a place");
    expect(std::is_sorted(topic.place.begin(), topic.place.end()), "rows stand in the file's order");
    expect(topic.place.back() < size, "places are in the file");
    for (const auto& column : topic.columns) expect(column.values.size() == rows, "columns are as long as the clock");
    for (const auto& text : topic.texts) expect(text.values.size() == rows, "texts are as long as the clock");
  }
  for (const std::string& warning : log.warnings) expect_one_line(warning);
  expect(log.warnings.size() <= 22, "warnings are few");
}

}  // namespace pinnquad_test

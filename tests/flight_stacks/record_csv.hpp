// SPDX-License-Identifier: MIT
// Records of a core (pinnquad/control/autopilot/core_record.hpp) as CSV, as PX4's ulog2csv would write the messages:
// FOLDER/NAME_TOPIC_0.csv. The shortest digits that read back to the same number.
#pragma once

#include <charconv>
#include <fstream>
#include <string>
#include <type_traits>

#include "pinnquad/control/autopilot/core_record.hpp"

namespace pinnquad::autopilot::test {

template <class Number>
void add_cell(std::string& line, Number number) {
  char text[40];
  const std::to_chars_result end = std::to_chars(text, text + sizeof text, number);
  line += line.empty() ? "" : ",";
  line.append(text, end.ptr);
}

template <class Record>
std::string csv_head() {
  std::string line;
  const Record record{};
  Record::each_number(record, [&line](const char* name, const char*, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string before = line.empty() ? "" : ",";
    if constexpr (std::is_pointer_v<Value>) {
      for (std::size_t i = 0; i < sizeof value / sizeof value[0]; ++i) {
        line += before + name + "[" + std::to_string(i) + "]";
      }
    } else {
      line += before + name;
    }
  });
  return line + "\n";
}

template <class Record>
std::string csv_row(const Record& record) {
  std::string line;
  Record::each_number(record, [&line](const char*, const char*, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_pointer_v<Value>) {
      for (const auto number : value) add_cell(line, number);
    } else if constexpr (sizeof(Value) == 1) {
      add_cell(line, static_cast<int>(value));
    } else {
      add_cell(line, value);
    }
  });
  return line + "\n";
}

template <class Record>
std::ofstream record_file(const std::string& folder, const std::string& name) {
  std::ofstream file(folder + "/" + name + "_" + Record::topic + "_0.csv");
  file << csv_head<Record>();
  return file;
}

}  // namespace pinnquad::autopilot::test

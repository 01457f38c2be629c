// SPDX-License-Identifier: MIT
// A log as its file has it: topics, each with columns over a clock of its own. What its columns mean in a flight's
// terms is said by a mapping, not here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pinnquad::logs {

/// NaN where the log has no number; infinite where it says so.
struct LogColumn {
  std::string name;  ///< "q[0]", "battery_voltage"
  std::vector<double> values;
  std::string unit{};  ///< that a row below the names says, "deg/s"; empty where none does
};

/// A column of labels: of what cannot be read as numbers throughout. Bytes as they stand in the log.
struct LogText {
  std::string name;  ///< "flight"
  std::vector<std::string> values;
  /// The first row whose cell is no number, or no list as long as the first row's: which to name where numbers are
  /// expected.
  std::size_t first_text = 0;
};

/// Rows of one kind of message, in the file's order, which need not be that of time.
struct LogTopic {
  std::string name;  ///< "vehicle_attitude"; empty in a log that is one table
  int instance = 0;
  std::vector<double> time_s;      ///< NaN throughout where nobody said which column is the clock
  std::vector<LogColumn> columns;  ///< all that hold numbers, the clock's too, in its own unit
  std::vector<LogText> texts;
  std::string file;                  ///< where its rows stand: for what is said of them
  std::vector<std::uint64_t> place;  ///< of each row in `file`: its line from 1, or its first byte
  bool places_are_lines = true;

  /// Without columns, of a file whose places are bytes.
  static LogTopic of_bytes(std::string name, int instance, std::string file) {
    return {std::move(name), instance, {}, {}, {}, std::move(file), {}, false};
  }

  std::size_t size() const noexcept { return time_s.size(); }
  /// Null if there is none of that name.
  const LogColumn* column(std::string_view wanted) const noexcept {
    for (const LogColumn& column : columns) {
      if (column.name == wanted) return &column;
    }
    return nullptr;
  }
  const LogText* text(std::string_view wanted) const noexcept {
    for (const LogText& text : texts) {
      if (text.name == wanted) return &text;
    }
    return nullptr;
  }
};

struct FlightLog {
  std::string source;  ///< file or folder, as it was given
  std::vector<LogTopic> topics;
  std::map<std::string, double> parameters;  ///< as they stood when the log began; "acc_1G", "motorOutput[0]"
  std::size_t dropouts = 0;                  ///< how often the logger lost what it should have written
  std::vector<std::string> warnings;         ///< what of the file could not be read, a line each, with file and place

  /// As it stood when the log began; `otherwise` where the log has none of that name.
  double parameter(const std::string& name, double otherwise) const {
    const auto found = parameters.find(name);
    return found == parameters.end() ? otherwise : found->second;
  }
  /// Null if there is none.
  const LogTopic* topic(std::string_view name, int instance = 0) const noexcept {
    for (const LogTopic& topic : topics) {
      if (topic.name == name && topic.instance == instance) return &topic;
    }
    return nullptr;
  }
};

}  // namespace pinnquad::logs

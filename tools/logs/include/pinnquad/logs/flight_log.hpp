// SPDX-License-Identifier: MIT
// A log as its file has it: topics, each with columns over a clock of its own. What its columns mean in a flight's
// terms is said by a mapping, not here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
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
  std::size_t first_text = 0;  ///< the first row whose cell is no number: which to name where numbers are expected
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

/// A message of the vehicle in flight.
struct LogMessage {
  double time_s = 0;
  int level = 6;  ///< as syslog: 0 emergency to 7 debug
  std::string text;
};

/// A time in which the logger lost what it should have written.
struct LogDropout {
  double after_s = 0;  ///< time of the last row before it
  double duration_s = 0;
};

/// A parameter that was set while the log was running.
struct LogParameterChange {
  double after_s = 0;  ///< time of the last row before it
  std::string name;
  double value = 0;
};

struct FlightLog {
  std::string source;  ///< file or folder, as it was given
  double start_s = 0;  ///< when the logger began, as it says itself; 0 where it does not. Rows before it are old news
  std::vector<LogTopic> topics;
  std::map<std::string, double> parameters;  ///< as they stood when the log began; "acc_1G", "motorOutput[0]"
  std::map<std::string, std::string> facts;  ///< "sys_name", "ver_hw" ...
  std::vector<LogMessage> messages;
  std::vector<LogDropout> dropouts;
  std::vector<LogParameterChange> parameter_changes;
  std::vector<std::string> warnings;  ///< what of the file could not be read, a line each, with file and place

  /// Null if there is none.
  const LogTopic* topic(std::string_view name, int instance = 0) const noexcept {
    for (const LogTopic& topic : topics) {
      if (topic.name == name && topic.instance == instance) return &topic;
    }
    return nullptr;
  }
};

}  // namespace pinnquad::logs

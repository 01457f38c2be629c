// SPDX-License-Identifier: MIT
// The records of a flight stack's core (pinnquad/control/autopilot/core_record.hpp), from a log's columns: numbers
// checked against what each may be.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_line/in_words.hpp"
#include "model/replayed_row.hpp"
#include "pinnquad/control/autopilot/core_record.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/flight_log.hpp"

namespace programs {

namespace logs = pinnquad::logs;

namespace detail {

[[noreturn]] inline void refuse_core_number(const logs::LogTopic& topic, std::size_t row, const std::string& expected,
                                            double found) {
  const bool has_line = topic.places_are_lines && row < topic.place.size();
  throw pinnquad::InputError(
      topic.file, has_line ? static_cast<std::size_t>(topic.place[row]) : 0, 0, expected,
      in_words("%.9g", found) + (has_line ? "" : " in message " + std::to_string(row + 1) + " of " + topic.name));
}

/// A column's number as a field has it: whole where the field is, within its range. NaN and infinity are numbers of a
/// float.
template <class Number>
Number core_number(const logs::LogTopic& topic, const logs::LogColumn& column, std::size_t row) {
  const double value = column.values[row];
  double least = static_cast<double>(std::numeric_limits<Number>::lowest());
  double most = static_cast<double>(std::numeric_limits<Number>::max());
  if constexpr (std::is_floating_point_v<Number>) {
    if (std::isfinite(value) && !(value >= least && value <= most)) {
      refuse_core_number(topic, row, "a 32-bit number in column " + column.name, value);
    }
  } else {
    most = std::min(most, 9007199254740992.0);  // 2^53: beyond it a double skips whole numbers
    if (!(value >= least && value <= most) || std::floor(value) < value) {
      refuse_core_number(topic, row, in_words("a whole number from %.0f to %.0f in column ", least, most) + column.name,
                         value);
    }
  }
  return static_cast<Number>(value);
}

/// Throws InputError where there is none.
inline const logs::LogColumn& core_column(const logs::LogTopic& topic, const std::string& name) {
  if (const logs::LogColumn* column = topic.column(name)) return *column;
  throw pinnquad::InputError(topic.file, topic.places_are_lines ? 1 : 0, 0,
                             "a column " + name + " of numbers, as a core logs it",
                             topic.text(name) != nullptr ? "text in it" : "none of that name");
}

}  // namespace detail

/// Calls `visit(name, unit, number)` for each number of a record, those of an array by names as "attitude[0]".
template <class Record, class Visit>
void each_core_number(Record& record, const Visit& visit) {
  Record::each_number(record, [&visit](const std::string& name, const char* unit, auto& value) {
    if constexpr (std::is_array_v<std::remove_reference_t<decltype(value)>>) {
      for (std::size_t i = 0; i < std::size(value); ++i) visit(name + "[" + std::to_string(i) + "]", unit, value[i]);
    } else {
      visit(name, unit, value);
    }
  });
}

/// Gives a topic a record's columns `names`, as a record is made, where it lacks them.
template <class Names>
void add_core_columns(logs::LogTopic& topic, const Names& names) {
  pinnquad::autopilot::CoreRecord layout{};
  each_core_number(layout, [&](const std::string& name, const char*, auto value) {
    const bool meant = std::find(names.begin(), names.end(), name) != names.end();
    if (!meant || topic.column(name) != nullptr || topic.text(name) != nullptr) return;
    topic.columns.push_back({name, std::vector<double>(topic.size(), static_cast<double>(value))});
  });
}

/// Throws InputError for ticks of a core before, whose bias this one does not have.
inline void refuse_earlier_core(const logs::LogTopic& topic) {
  const std::string removed = pinnquad::autopilot::CoreRecord::removed;
  if (topic.column(removed + "[0]") == nullptr) return;
  throw pinnquad::InputError(topic.file, topic.places_are_lines ? 1 : 0, 0,
                             "ticks of a core whose bias is one of commands, bias_sums",
                             removed + ": a core before flew, and the pinnquad that it was built of replays it");
}

/// A Crazyflie's events (examples/crazyflie_app/src/core_log.h) say times in ms, under names of their own, and leave
/// out what it does not know: that is as a record is made, or 0 of its settings. Columns are added to the topic.
template <class Record>
void complete_core_topic(logs::LogTopic& topic) {
  constexpr bool of_settings = std::is_same_v<Record, pinnquad::autopilot::CoreSettings>;
  Record layout{};
  each_core_number(layout, [&topic](const std::string& name, const char*, auto value) {
    if (topic.column(name) != nullptr) return;
    const bool is_time = name.size() > 3 && name.rfind("_us") == name.size() - 3;
    const logs::LogColumn* in_ms = topic.column((is_time ? name.substr(0, name.size() - 3) : name) + "_ms");
    logs::LogColumn column{name, std::vector<double>(topic.size(), of_settings ? 0 : static_cast<double>(value))};
    for (std::size_t row = 0; in_ms != nullptr && row < column.values.size(); ++row) {
      column.values[row] = 1000 * in_ms->values[row];
    }
    topic.columns.push_back(std::move(column));
  });
}

/// The rows of a topic as records of a core. Throws InputError, one line: a column that is missing or holds text, a
/// number that its field can't be.
template <class Record>
std::vector<Record> core_records(const logs::LogTopic& topic) {
  std::vector<const logs::LogColumn*> columns;
  Record layout{};
  each_core_number(layout, [&](const std::string& name, const char*, auto) {
    columns.push_back(&detail::core_column(topic, name));
  });
  std::vector<Record> records(topic.size());
  for (std::size_t row = 0; row < records.size(); ++row) {
    auto column = columns.begin();
    each_core_number(records[row], [&](const std::string&, const char*, auto& number) {
      number = detail::core_number<std::decay_t<decltype(number)>>(topic, **column++, row);
    });
  }
  return records;
}

}  // namespace programs

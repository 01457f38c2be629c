// SPDX-License-Identifier: MIT
// A log as its file has it, whatever the file is: ULog, a folder that ulog2csv wrote, a Crazyflie's uSD card's,
// Betaflight's or INAV's blackbox, ArduPilot's DataFlash, a CSV table.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "pinnquad/logs/flight_log.hpp"

namespace pinnquad::logs {

/// The wanted part of a log: a reader leaves out the rest, which is most of it.
struct LogSelection {
  std::vector<std::string> topics;  ///< by name, each with all its instances; every topic if empty
  /// By topic, those of a ULog file whose numbers are wanted: others have a name and no values. All of a topic that is
  /// not named here.
  std::map<std::string, std::set<std::string>> columns;
  std::string prefix;                      ///< which log of a folder of several: what its files' names begin with
  std::size_t flight = 0;                  ///< which flight of a blackbox log of several
  std::string clock_column;                ///< of a CSV table; none if empty: its time_s is NaN
  double clock_ticks_per_s = 1;            ///< 1e6 where that column is in microseconds
  std::vector<std::string> label_columns;  ///< of a CSV table: kept as text even where every cell is a number
  std::function<void(double)>
      on_progress;  ///< is told the share that has been read, 0..1; may be empty; what it throws ends the reading

  void report(double share) const {
    if (on_progress) on_progress(share);
  }
  /// The same of a reader that has come to byte `at` of `size`: once a MiB.
  void report(std::uint64_t at, std::uint64_t size, std::uint64_t& next) const {
    if (at < next) return;
    next = at + (std::uint64_t{1} << 20);
    report(static_cast<double>(at) / static_cast<double>(size));
  }
  bool wants(std::string_view topic) const {
    return topics.empty() || std::find(topics.begin(), topics.end(), topic) != topics.end();
  }
  bool wants(const std::string& topic, const std::string& column) const {
    const auto named = columns.find(topic);
    return named == columns.end() || named->second.count(column) > 0;
  }
};

enum class LogKind { ulog, ulog2csv_folder, usd, blackbox, dataflash, csv };

/// By its first bytes, or by being a folder. Throws InputError for what is none of them.
LogKind kind_of_log(const std::string& path);

/// Throws InputError, one line, for what cannot be read at all; what is lost of the rest is in `warnings`.
FlightLog read_log(const std::string& path, const LogSelection& selection = {});

/// The rows of a CSV table. LF and CRLF, a byte order mark, blanks around cells, empty lines at the end, quotation
/// marks as in RFC 4180, semicolons (with decimal commas) or tabs between the cells: accepted. So are, above the names,
/// comments and rows of a key and a value (Blackbox Explorer's), and a row of units below them. An empty cell and `nan`
/// are NaN, `inf` is infinite; a column with a cell that is no number is text. Throws InputError, one line: no header,
/// names that come twice, a row of other length, decimal commas between commas, a clock that is missing or no number.
LogTopic read_csv_topic(const std::string& path, const LogSelection& selection = {});

namespace ulog2csv {
/// The clock of the tables of PX4's ulog2csv.
inline constexpr const char* clock_column = "timestamp";
inline constexpr double ticks_per_s = 1e6;
}  // namespace ulog2csv

}  // namespace pinnquad::logs

// SPDX-License-Identifier: MIT
// The wanted part of a log: a reader leaves out the rest, which is most of it.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace programs {

struct LogSelection {
  std::vector<std::string> topics;          ///< by name, each with all its instances; every topic if empty
  std::string prefix;                       ///< which log of a folder of several: what its files' names begin with
  std::string clock_column;                 ///< of a CSV table; none if empty: its time_s is NaN
  double clock_ticks_per_s = 1;             ///< 1e6 where that column is in microseconds
  std::vector<std::string> label_columns;   ///< of a CSV table: kept as text even where every cell is a number
  std::function<void(double)> on_progress;  ///< is told the share that has been read, 0..1; may be empty

  void report(double share) const {
    if (on_progress) on_progress(share);
  }
  bool wants(std::string_view topic) const {
    return topics.empty() || std::find(topics.begin(), topics.end(), topic) != topics.end();
  }
};

}  // namespace programs

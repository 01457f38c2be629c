// SPDX-License-Identifier: MIT
// Flights as CSV files, read with a progress line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "command_line/progress_line.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

/// pinnquad::logs::read_flights with a progress line.
inline pinnquad::Dataset read_flights(const std::vector<std::string>& paths, std::size_t minimum_rows,
                                      const std::vector<pinnquad::ColumnName>& extra = {}) {
  JobLine progress;
  return pinnquad::logs::read_flights(
      paths, minimum_rows, extra, [&progress](const std::string& job, double share) { progress.update(job, share); });
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// Flights of any source, read with a progress line.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "command_line/progress_line.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

/// Flights of any source, of CSV files with the extra columns asked for, `minimum_rows` or more. Throws as
/// pinnquad::logs::read_source.
inline pinnquad::Dataset read_flights(const std::vector<std::string>& paths, const std::string& mapping,
                                      std::size_t minimum_rows, const std::vector<pinnquad::ColumnName>& extra = {}) {
  namespace logs = pinnquad::logs;
  JobLine progress;
  logs::LogSettings settings;
  settings.mapping = mapping;
  settings.on_progress = [&progress](const std::string& job, double share) { progress.update(job, share); };
  if (logs::kind_of_sources(paths, mapping) != logs::SourceKind::flights) {
    return logs::read_source(paths, settings).flights;
  }
  return logs::read_flights(paths, minimum_rows, extra, settings.on_progress);
}

}  // namespace programs

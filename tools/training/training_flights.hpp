// SPDX-License-Identifier: MIT
// The flights that `train` is given: read, checked, and told of in what it prints and in report.json.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "command_line/progress_line.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/logs/read_dataset.hpp"

namespace programs {

/// pinnquad::logs::read_flights with a progress line.
inline pinnquad::Dataset read_flights(const std::vector<std::string>& paths, std::size_t minimum_rows,
                                      const std::vector<pinnquad::ColumnName>& extra = {}) {
  JobLine progress;
  return pinnquad::logs::read_flights(
      paths, minimum_rows, extra, [&progress](const std::string& job, double share) { progress.update(job, share); });
}

/// Throws InputError where a command stands still in a flight's part of a block.
inline void require_varied_commands(const std::vector<std::string>& paths, const pinnquad::Dataset& dataset,
                                    const pinnquad::RowSet& block, const std::string& block_name) {
  for (const pinnquad::FlightRows& piece : block.pieces()) {
    std::size_t index = 0;
    while (&dataset[index] != piece.flight) ++index;
    pinnquad::require_varied_commands(paths[index], *piece.flight, piece.rows, block_name);
  }
}

/// "a.csv", or "a.csv, b.csv, c.csv".
inline std::string flight_names(const pinnquad::RowSet& rows) {
  return listed(rows.pieces(), [](const pinnquad::FlightRows& piece) { return piece.flight->name; });
}

inline void print_split(const pinnquad::Dataset& dataset, const pinnquad::RowSplit& split) {
  const bool one = dataset.size() == 1;
  std::printf("      %zu rows: %zu train, %zu validate, %zu test, in %s\n", dataset.rows(), split.train.size(),
              split.validation.size(), split.test.size(), one ? "contiguous blocks" : "whole flights");
  if (one) return;
  std::printf("      train: %s\n      validate: %s\n      test: %s\n", flight_names(split.train).c_str(),
              flight_names(split.validation).c_str(), flight_names(split.test).c_str());
}

/// The flights in report.json: of one its name, of several which block each went to.
inline nlohmann::json described(const pinnquad::Dataset& dataset, const pinnquad::RowSplit& split) {
  nlohmann::json result = {{"flight", flight_names(dataset)},
                           {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(dataset))},
                           {"rows", dataset.rows()}};
  if (dataset.size() == 1) return result;
  result["flights"] = nlohmann::json::array();
  const auto list = [&](const pinnquad::RowSet& block, const char* name) {
    for (const pinnquad::FlightRows& piece : block.pieces()) {
      result["flights"].push_back({{"flight", piece.flight->name},
                                   {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(*piece.flight))},
                                   {"rows", piece.rows.size()},
                                   {"block", name}});
    }
  };
  list(split.train, "train");
  list(split.validation, "validation");
  list(split.test, "test");
  return result;
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// The flights that `train` is given: read, checked, and told of in what it prints and in report.json.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/listed.hpp"
#include "command_line/progress_line.hpp"
#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "pinnquad/data/split.hpp"

namespace programs {

/// Flights, each named by its file, with the extra columns asked for. Throws InputError, and std::invalid_argument for
/// too few rows in all and for a flight that comes twice: it would be tested on what it was trained on.
inline pinnquad::Dataset read_flights(const std::vector<std::string>& paths, std::size_t minimum_rows,
                                      const std::vector<pinnquad::ColumnName>& extra = {}) {
  const bool one = paths.size() == 1;
  pinnquad::Dataset dataset;
  std::vector<std::uint64_t> hashes;
  const auto bytes_of = [](const std::string& path) {  // of what is no file, or a pipe: none
    std::error_code ignored;
    const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
    return ignored ? 0.0 : static_cast<double>(bytes);
  };
  double all_bytes = 0, bytes_read = 0;
  for (const std::string& path : paths) all_bytes += bytes_of(path);
  ProgressLine progress("reading " + std::to_string(paths.size()) + (one ? " flight" : " flights"));
  for (const std::string& path : paths) {
    progress.update(all_bytes > 0 ? bytes_read / all_bytes : 0);
    bytes_read += bytes_of(path);
    pinnquad::Flight flight =
        pinnquad::read_flight_csv(path, one ? minimum_rows : pinnquad::minimum_flight_rows, extra);
    pinnquad::require_plausible(path, flight);
    const std::uint64_t hash = pinnquad::content_hash(flight);
    const auto same = std::find(hashes.begin(), hashes.end(), hash);
    if (same != hashes.end()) {
      const std::string& other = paths[static_cast<std::size_t>(same - hashes.begin())];
      throw std::invalid_argument("--flight " + pinnquad::printable(other) + " and " + pinnquad::printable(path) +
                                  " hold the same flight: it would be judged on rows that it was trained on");
    }
    hashes.push_back(hash);
    const std::string file = pinnquad::printable(std::filesystem::path(path).filename().string());
    flight.name = file;
    const auto taken = [&](const pinnquad::Flight& other) { return other.name == flight.name; };
    for (int copy = 2; std::any_of(dataset.flights().begin(), dataset.flights().end(), taken); ++copy) {
      flight.name = file + " (" + std::to_string(copy) + ")";
    }
    dataset.add(std::move(flight));
  }
  if (dataset.rows() < minimum_rows) {
    throw std::invalid_argument("--flight: expected at least " + std::to_string(minimum_rows) + " rows in " +
                                std::to_string(dataset.size()) + " flights, found " + std::to_string(dataset.rows()));
  }
  return dataset;
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

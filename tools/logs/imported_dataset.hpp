// SPDX-License-Identifier: MIT
// The product of `import`: flights on one clock, and the steps that led there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"

namespace programs {

/// One thing that was done to the rows, and what it cost.
struct ImportStep {
  std::string name;  ///< "saturated"
  std::size_t rows_before = 0;
  std::size_t rows_after = 0;
  std::string told;  ///< how, in a few words: "a command below 0.005 or above 0.995"
};

/// Flights as a training takes them. Row k holds the commands that cause the motion of row k. Where velocity is absent,
/// the linear acceleration is specific force + R^T g: what it is with v = 0.
struct ImportedDataset {
  pinnquad::Dataset flights;
  std::vector<std::string> sources;  ///< the log of each flight
  std::vector<std::string> absent;   ///< quantities that the logs lack, filled with 0: "velocity", "altitude"
  double sample_period_s = 0;
  double lag_removed_s = 0;  ///< by how much later than told the commands stand in the rows
  std::string airframe;
  std::string mapping;
  std::vector<ImportStep> steps;
  std::vector<std::string> notes;     ///< how what the logs lack was computed
  std::vector<std::string> warnings;  ///< what looks wrong

  bool lacks(const std::string& quantity) const {
    for (const std::string& missing : absent) {
      if (missing == quantity) return true;
    }
    return false;
  }
};

/// Throws std::invalid_argument, one line, where two flights hold the same rows.
inline void require_different_flights(const pinnquad::Dataset& dataset) {
  std::map<std::uint64_t, std::string> names;
  for (const pinnquad::Flight& flight : dataset.flights()) {
    const auto [first, fresh] = names.try_emplace(pinnquad::content_hash(flight), flight.name);
    if (fresh) continue;
    throw std::invalid_argument("the flights " + pinnquad::printable(first->second) + " and " +
                                pinnquad::printable(flight.name) +
                                " are the same: one would be judged on what it was trained on");
  }
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// rows.csv of a study: its columns, and what names a flight in them. report_rows.py reads them.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "training/judgement.hpp"

namespace programs {

/// One recorded flight: what kind it is of (D1, D2, D3), and the seed it was flown from.
struct StudyFlight {
  std::string name;
  std::uint64_t seed = 0;

  friend bool operator==(const StudyFlight& a, const StudyFlight& b) { return a.name == b.name && a.seed == b.seed; }
  friend bool operator<(const StudyFlight& a, const StudyFlight& b) {
    return std::tie(a.name, a.seed) < std::tie(b.name, b.seed);
  }
};

/// Columns of rows.csv: which training, what it reached, what it took.
inline std::vector<std::string> study_columns() {
  std::vector<std::string> columns = {"model", "flight", "flight_seed", "seed", "epochs", "weights"};
  for (const Figure& figure : figures()) columns.push_back(figure.name);
  columns.insert(columns.end(), {"validation_mae", "training_s"});
  return columns;
}

}  // namespace programs

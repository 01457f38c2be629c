// SPDX-License-Identifier: MIT
// Rows of the independent simulator (PINNQUAD_REFERENCE_DIR/airlib, see its README), and the statistics that are
// printed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/plain_dynamics.hpp"

namespace pinnquad::test {

/// The compile definition, overridden by the environment variable of the same name.
inline std::string reference_folder() {
  if (const char* folder = std::getenv("PINNQUAD_REFERENCE_DIR")) return folder;
#ifdef PINNQUAD_REFERENCE_DIR
  return PINNQUAD_REFERENCE_DIR;
#else
  return "reference";
#endif
}

/// A CSV file by column name. Throws if a file, a column or a number is missing: a test must not pass on nothing.
class ReferenceTable {
 public:
  explicit ReferenceTable(const std::string& name, const std::string& folder = reference_folder() + "/airlib/") {
    const std::string path = folder + name;
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " can't be opened");
    std::string line, cell;
    std::getline(file, line);
    std::istringstream header(line);
    while (std::getline(header, cell, ',')) {
      const std::size_t column = columns_.size();
      columns_[cell] = column;
    }
    while (std::getline(file, line)) {
      std::istringstream cells(line);
      std::vector<double> row;
      while (std::getline(cells, cell, ',')) row.push_back(std::strtod(cell.c_str(), nullptr));
      if (row.size() != columns_.size()) throw std::runtime_error(path + " has a row of another length");
      rows_.push_back(row);
    }
  }

  std::size_t size() const { return rows_.size(); }
  double at(std::size_t row, const std::string& column) const { return rows_.at(row).at(columns_.at(column)); }

  std::array<double, 3> vector(std::size_t row, const std::string& prefix) const {
    return {at(row, prefix + "x"), at(row, prefix + "y"), at(row, prefix + "z")};
  }

 private:
  std::map<std::string, std::size_t> columns_;
  std::vector<std::vector<double>> rows_;
};

/// Every twentieth row of the random states of each ground effect model, as they are there: they ship with the tests.
inline ReferenceTable shipped_rows(const std::string& name) {
  return ReferenceTable(name, PINNQUAD_TESTS_DIR "/reference/rows/");
}

/// Differences of one quantity over a file; prints what the documentation quotes.
class Statistics {
 public:
  void add(double difference) { values_.push_back(difference); }
  std::size_t count() const { return values_.size(); }
  /// NaN counts as worst.
  double worst() const {
    double result = 0.0;
    for (const double v : values_) result = v <= result ? result : v;
    return result;
  }
  double median() const {
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    return sorted.empty() ? 0.0 : sorted[sorted.size() / 2];
  }
  void print(const char* file, const char* quantity) const {
    std::printf("%-24s %-24s rows %5zu  worst %9.2e  median %9.2e\n", file, quantity, count(), worst(), median());
  }

 private:
  std::vector<double> values_;
};

}  // namespace pinnquad::test

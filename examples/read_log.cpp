// SPDX-License-Identifier: MIT
// A vehicle's log as a dataset: ULog, ulog2csv, a Crazyflie's log, a CSV table. Links pinnquad::logs.
//   read_log flight.ulg px4
#include <cstdio>
#include <exception>

#include "pinnquad/logs/read_dataset.hpp"

int main(int, char** argument) try {
  pinnquad::logs::LogSettings settings;
  settings.mapping = argument[2];  // what the columns mean: a ready mapping, or a TOML file of your own
  const pinnquad::logs::ImportedDataset read = pinnquad::logs::read_dataset({argument[1]}, settings);
  for (const pinnquad::Flight& flight : read.flights.flights()) {
    std::printf("%s: %zu rows, every %g s\n", flight.name.c_str(), flight.size(), read.sample_period_s);
  }
  for (const std::string& warning : read.warnings) std::printf("warning: %s\n", warning.c_str());
} catch (const std::exception& error) {  // one line: file, line, column
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}

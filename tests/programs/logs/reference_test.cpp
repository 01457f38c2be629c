// SPDX-License-Identifier: MIT
// Real ULog files and folders against what pyulog made of them, value by value. Own main: where they are absent, 77
// says "skipped" to CTest.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/logs/read_log.hpp"

using pinnquad::logs::FlightLog;
using pinnquad::logs::LogTopic;
using pinnquad::logs::read_log;

namespace {

std::string reference_folder() {
  const char* const folder = std::getenv("PINNQUAD_REFERENCE_DIR");
  return folder != nullptr ? folder : PINNQUAD_REFERENCE_DIR;
}

/// A table of plain cells, by means of the C library alone.
struct Cells {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  explicit Cells(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " can't be opened");
    std::string line;
    std::getline(file, line);
    header = split(line);
    while (std::getline(file, line)) rows.push_back(split(line));
  }
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::string cell;
    std::istringstream text(line);
    while (std::getline(text, cell, ',')) cells.push_back(cell);
    return cells;
  }
};

bool same_bits(double a, double b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }

/// Every cell of a table; returns how many are compared. A value of a ULog file that is a float has the table's
/// decimals, and so the bits of the nearest float; all else has those of the nearest double.
std::size_t compare(const LogTopic& topic, const std::string& path, bool floats) {
  const Cells cells(path);
  INFO(path);
  REQUIRE(topic.size() == cells.rows.size());
  CHECK(topic.columns.size() == cells.header.size());
  CHECK(topic.texts.empty());
  std::size_t compared = 0, different = 0;
  for (std::size_t column = 0; column < cells.header.size(); ++column) {
    INFO(cells.header[column]);
    REQUIRE(topic.column(cells.header[column]) != nullptr);
    const std::vector<double>& values = topic.column(cells.header[column])->values;
    for (std::size_t row = 0; row < cells.rows.size(); ++row) {
      const std::string& cell = cells.rows[row].at(column);
      const bool whole = cell.find_first_not_of("-0123456789") == std::string::npos;
      const double exact = std::strtod(cell.c_str(), nullptr);
      const double rounded = static_cast<double>(std::strtof(cell.c_str(), nullptr));
      const bool same = same_bits(values[row], exact) || (floats && !whole && same_bits(values[row], rounded));
      if (!same && different++ < 3) MESSAGE(cell << " differs from " << values[row]);
      ++compared;
      if (cells.header[column] == "timestamp") different += same_bits(topic.time_s[row], exact / 1e6) ? 0 : 1;
    }
  }
  CHECK(different == 0);
  return compared;
}

/// Every table of a folder against the topic of its name.
std::size_t compare_folder(const FlightLog& log, const std::string& folder, const std::string& prefix, bool floats) {
  std::size_t files = 0, compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".csv" || name.find(prefix) != 0) continue;
    const std::size_t underscore = name.rfind('_');
    const std::string topic = name.substr(prefix.size(), underscore - prefix.size());
    INFO(name);
    REQUIRE(log.topic(topic, std::atoi(name.c_str() + underscore + 1)) != nullptr);
    compared += compare(*log.topic(topic, std::atoi(name.c_str() + underscore + 1)), entry.path().string(), floats);
    ++files;
  }
  CHECK(files == log.topics.size());
  return compared;
}

}  // namespace

TEST_CASE("the ULog file of a circle has pyulog's values, all of them") {
  const std::string folder = reference_folder() + "/sih";
  const FlightLog log = read_log(folder + "/test_circle.ulg");
  CHECK(log.warnings.empty());
  CHECK(log.dropouts == 0);
  const std::size_t compared = compare_folder(log, folder + "/test_circle_csv", "test_circle_", true);
  MESSAGE("values compared: " << compared);
  CHECK(compared > 1500000);
}

TEST_CASE("its parameters, likewise") {
  const std::string folder = reference_folder() + "/sih";
  const FlightLog log = read_log(folder + "/test_circle.ulg");
  std::ifstream parameters(folder + "/test_circle_parameters.csv");
  std::string line;
  std::size_t count = 0;
  while (std::getline(parameters, line)) {
    const std::size_t comma = line.find(',');
    INFO(line);
    REQUIRE(log.parameters.count(line.substr(0, comma)) == 1);
    CHECK(same_bits(log.parameters.at(line.substr(0, comma)), std::strtod(line.c_str() + comma + 1, nullptr)));
    ++count;
  }
  CHECK(count == log.parameters.size());
  CHECK(count == 884);
}

TEST_CASE("folders of ulog2csv of three generations, value by value") {
  std::size_t compared = 0;
  const std::string folder = reference_folder();
  for (const std::string name : {"B_px4v117_x500v2_gps", "C_px4_2016_sitl_legacy"}) {
    const FlightLog log = read_log(folder + "/ulog2csv/" + name);
    CHECK(log.warnings.empty());
    compared += compare_folder(log, folder + "/ulog2csv/" + name, name + "_", false);
  }
  const FlightLog circle = read_log(folder + "/sih/test_circle_csv");
  compared += compare_folder(circle, folder + "/sih/test_circle_csv", "test_circle_", false);
  MESSAGE("values compared: " << compared);
  CHECK(compared > 1500000);
}

TEST_CASE("tables of real flights: rows, labels, absent cells") {
  const std::string folder = reference_folder() + "/flight_logs/";
  pinnquad::logs::LogSelection selection;
  selection.clock_column = "t";
  for (const std::string name : {"nanobench_subset_50hz.csv", "arpl_crazyflie.csv"}) {
    const Cells cells(folder + name);
    const FlightLog log = read_log(folder + name, selection);
    const LogTopic& topic = log.topics.at(0);
    REQUIRE(topic.size() == cells.rows.size());
    REQUIRE(topic.texts.size() == 1);
    std::size_t different = 0;
    for (std::size_t row = 0; row < topic.size(); ++row) {
      different += topic.text("flight")->values[row] == cells.rows[row][0] ? 0 : 1;
      different += same_bits(topic.time_s[row], std::strtod(cells.rows[row][1].c_str(), nullptr)) ? 0 : 1;
      for (std::size_t column = 1; column < cells.header.size(); ++column) {
        const std::string& cell = cells.rows[row].at(column);
        const double value = cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr);
        different += same_bits(topic.column(cells.header[column])->values[row], value) ? 0 : 1;
      }
    }
    CHECK(different == 0);
  }
}

/// A hundred rows between take-off and landing: v_bz moves, the others hardly do.
TEST_CASE("a calm flight at PX4's default rates is imported, and says what it leaves unchecked") {
  const std::string log = reference_folder() + "/cases/hover_false_vdot/hover_false_vdot.ulg";
  if (!std::filesystem::exists(log)) {
    MESSAGE("skipped: " << log << " does not exist");
    return;
  }
  pinnquad::logs::LogSettings settings;
  settings.mapping = "px4";
  const auto dataset = pinnquad::logs::read_dataset({log}, settings);
  CHECK(dataset.flights.size() == 1);
  bool told = false;
  for (const std::string& note : dataset.notes)
    told = told || note.find("not checked: too little motion") != std::string::npos;
  CHECK(told);
}

int main(int argc, char** argv) {
  const std::string first = reference_folder() + "/sih/test_circle.ulg";
  if (!std::filesystem::exists(first)) {
    std::printf("skipped: no logs to compare with, %s does not exist\n", first.c_str());
    return 77;
  }
  doctest::Context context(argc, argv);
  return context.run();
}

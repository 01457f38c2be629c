// SPDX-License-Identifier: MIT
// Flights of any source, told apart by content.
#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/logs/dataset_folder.hpp"
#include "programs/logs/synthetic_ulog.hpp"
#include "support/temporary_folder.hpp"

using pinnquad::Flight;
using namespace pinnquad::logs;
using pinnquad_test::TemporaryFolder;

namespace {

std::string refusal(const std::vector<std::string>& paths, const LogSettings& settings = {}) {
  try {
    read_source(paths, settings);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    return what;
  }
  return "accepted";
}

std::string written(const TemporaryFolder& folder, const std::string& name, std::uint64_t seed) {
  pinnquad::test::SyntheticVehicle vehicle;
  vehicle.duration_s = 5;
  vehicle.seed = seed;
  Flight flight = pinnquad::test::synthetic_flight(vehicle);
  flight.add_column({{"battery_voltage", "V"}, std::vector<double>(flight.size(), 12)});
  if (seed == 1) flight.add_column({{"payload", "kg"}, std::vector<double>(flight.size(), 1)});
  pinnquad::write_flight_csv(folder.path(name), flight);
  return folder.path(name);
}

}  // namespace

TEST_CASE("a log of PX4 becomes the flight that was logged") {
  const TemporaryFolder folder;
  const std::string log = folder.write("flight.ulg", pinnquad_test::synthetic_ulog());
  CHECK(kind_of_source(log) == SourceKind::logs);
  CHECK(read_source({log}).taken == std::vector<std::string>{"mapping px4 taken: a ULog file with PX4's topics"});
  CHECK(refusal({folder.write("other.csv", "a,b\n1,2\n")}).find("found columns that none of these names") !=
        std::string::npos);
  LogSettings settings;
  settings.mapping = "px4";
  double done = 0;
  settings.on_progress = [&done](const std::string&, double share) { done = std::max(done, share); };
  const ImportedDataset read = read_source({log}, settings);
  REQUIRE(read.flights.size() == 1);
  CHECK(read.flights[0].name == "flight");
  CHECK(read.sources == std::vector<std::string>{log});
  CHECK(read.mapping == "px4");
  CHECK(read.sample_period_s == doctest::Approx(0.01));
  CHECK(read.lag_removed_s == doctest::Approx(0.05).epsilon(0.3));
  CHECK(read.absent == std::vector<std::string>{"velocity", "altitude"});
  CHECK(read.warnings.empty());
  CHECK(read.flights[0].size() > 5000);
  CHECK(done > 0);
  const Flight truth = pinnquad::test::synthetic_flight();
  for (const pinnquad::Sample& sample : read.flights[0]) {
    const pinnquad::Sample& same = truth[static_cast<std::size_t>(std::lround((sample.time_s - 1) / 0.01))];
    REQUIRE((sample.body_rates_rad_s - same.body_rates_rad_s).norm() < 1e-5);
    REQUIRE(std::abs(sample.roll_rad - same.roll_rad) < 1e-5);
    REQUIRE((sample.linear_acceleration_m_s2 - same.linear_acceleration_m_s2).norm() < 1e-4);
  }

  settings.on_progress = [](const std::string&, double) { throw std::string("stop"); };
  CHECK_THROWS_AS(read_source({log}, settings), std::string);
  settings.mapping = "no_such";
  CHECK(refusal({log}, settings) == "no mapping named 'no_such'; known: " + pinnquad::logs::mapping_names() +
                                        ", or a file whose name ends in .toml");
}

TEST_CASE("flights and a folder of them are read without a mapping") {
  const TemporaryFolder folder;
  const std::string a = written(folder, "a.csv", 1), b = written(folder, "b.csv", 2);
  CHECK(kind_of_source(a) == SourceKind::flights);
  const ImportedDataset flights = read_source({a, b});
  REQUIRE(flights.flights.size() == 2);
  CHECK(flights.flights[1].name == "b.csv");
  CHECK(flights.sources == std::vector<std::string>{a, b});
  REQUIRE(flights.flights[1].columns().size() == 1);
  CHECK(flights.flights[1].columns()[0].name == "battery_voltage");
  CHECK(flights.sample_period_s == doctest::Approx(0.01));

  const std::string dataset = folder.path("dataset");
  pinnquad::logs::write_dataset_folder(dataset, flights);
  CHECK(kind_of_source(dataset) == SourceKind::dataset);
  const ImportedDataset again = read_source({dataset});
  CHECK(content_hash(again.flights) == content_hash(flights.flights));
  CHECK(again.sources == flights.sources);

  CHECK(refusal({a, a}) ==
        a + " and " + a + " hold the same flight: it would be judged on rows that it was trained on");
  CHECK(refusal({a, dataset}).find("expected flights, one dataset, or logs, found " + a) == 0);
  CHECK(refusal({dataset, dataset}).find("expected flights, one dataset, or logs") == 0);
  CHECK(refusal({}).find("expected FLIGHTS") == 0);
  CHECK(refusal({folder.path("absent")}).find("expected a readable file") != std::string::npos);
  CHECK(refusal({folder.write("other.csv", "x,y\n1,2\n")}).find("other.csv: expected a flight") != std::string::npos);
  std::string text;
  std::getline(std::ifstream(a), text, '\0');
  const std::string less = folder.write("less.csv", text.replace(text.find("u4"), 2, "v4"));
  CHECK(refusal({less}).find("less.csv:1: expected a column named u4") != std::string::npos);
}

TEST_CASE("what on_flights throws ends the reading before flights are compared") {
  const TemporaryFolder folder;
  const std::string log = folder.write("log.ulg", pinnquad_test::synthetic_ulog());
  std::vector<std::string> jobs, names;
  LogSettings settings;
  settings.on_progress = [&](const std::string& job, double) { jobs.push_back(job); };
  CHECK(refusal({log}, settings) == "accepted");
  CHECK(std::count(jobs.begin(), jobs.end(), "comparing the flights") > 0);
  jobs.clear();
  settings.on_flights = [&](const ImportedDataset& dataset) {
    for (const Flight& flight : dataset.flights.flights()) names.push_back(flight.name);
    throw std::invalid_argument("no such flight");
  };
  CHECK(refusal({log}, settings) == "no such flight");
  CHECK(names == std::vector<std::string>{"log"});
  CHECK(std::count(jobs.begin(), jobs.end(), "comparing the flights") == 0);
}

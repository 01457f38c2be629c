// SPDX-License-Identifier: MIT
// Rows of the study: what trains knows nothing of what judges, and each row of a series is the one that it names.
#include <doctest/doctest.h>

#include <cstddef>
#include <random>

#include "pinnquad/core/random.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "study/campaign.hpp"
#include "support/temporary_folder.hpp"

using pinnquad::Flight;

namespace {

/// Rows that are all different, of the size of a flight's.
Flight random_flight(std::size_t rows, unsigned seed) {
  std::mt19937_64 engine(seed);
  Flight flight;
  for (std::size_t row = 0; row < rows; ++row) {
    pinnquad::Sample::Values values{};
    for (double& value : values) value = pinnquad::uniform(engine, 0.1, 0.9);
    values[0] = 0.05 * static_cast<double>(row);
    flight.push_back(pinnquad::to_sample(values));
  }
  return flight;
}

/// The flight with other numbers in its rows from `begin` to `end`.
Flight replaced(const Flight& flight, std::size_t begin, std::size_t end) {
  Flight other = flight;
  const Flight noise = random_flight(flight.size(), 99);
  for (std::size_t row = begin; row < end; ++row) {
    const double time_s = flight[row].time_s;
    other[row] = noise[row];
    other[row].time_s = time_s;
  }
  return other;
}

template <class DataSet>
void check_no_leak() {
  const Flight flight = random_flight(400, 5);
  const study::Material<DataSet> material(flight);
  const auto& split = material.split;
  CHECK(split.train.begin == 0);
  CHECK(split.validation.begin == split.train.end);
  CHECK(split.test.begin == split.validation.end);
  CHECK(static_cast<std::size_t>(material.data.size()) == split.train.size());
  const auto same = [&](const Flight& changed) {
    const study::Material<DataSet> other(changed);
    return other.context.input.mean == material.context.input.mean &&
           other.context.input.standard_deviation == material.context.input.standard_deviation &&
           other.context.output.mean == material.context.output.mean &&
           other.context.output.standard_deviation == material.context.output.standard_deviation &&
           other.data.features == material.data.features && other.data.outputs == material.data.outputs;
  };
  CHECK(same(replaced(flight, split.validation.begin, split.test.end)));
  CHECK_FALSE(same(replaced(flight, split.train.end - 1, split.train.end)));
}

}  // namespace

TEST_CASE("what trains in the study depends on no row of validation and test, and on the last of training") {
  check_no_leak<study::D1>();
  check_no_leak<study::D1Test40>();
  check_no_leak<study::D1Test80>();
}

TEST_CASE("a row of a series holds time, acceleration and commands of the row that it names, and its prediction") {
  const Flight flight = random_flight(30, 6);
  study::Outcome outcome;
  outcome.test_rows = {17, 30};
  for (std::size_t row = 17; row < 30; ++row) {
    const double u = static_cast<double>(row) / 64;
    outcome.predictions.push_back({u, u + 0.1, u + 0.2, u + 0.3});
  }
  const pinnquad_test::TemporaryFolder folder;
  const std::string path = folder.write("series.csv", "");
  study::write_series(path, flight, outcome);
  const auto rows = pinnquad::read_csv(
      path, {"time_s", "wdot_x", "wdot_y", "wdot_z", "u1", "u2", "u3", "u4", "p1", "p2", "p3", "p4"});
  REQUIRE(rows.size() == 13);
  for (std::size_t i = 0; i < 13; ++i) {
    const pinnquad::Sample& sample = flight[17 + i];
    const auto& row = rows[i];
    CHECK(row[0] == sample.time_s);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(row[1 + k] == sample.angular_acceleration_rad_s2[static_cast<Eigen::Index>(k)]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(row[4 + k] == sample.commands[k]);
      CHECK(row[8 + k] == outcome.predictions[i][k]);
    }
  }
}

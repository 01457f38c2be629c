// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <pinnquad/data/dataset.hpp>
#include <set>
#include <string>
#include <utility>

#include "recorded_flight.hpp"

using pinnquad::content_hash;
using pinnquad::Flight;
using pinnquad_test::random_flight;

namespace {

std::uint64_t fnv1a(const std::string& bytes) {
  pinnquad::detail::Fnv1a fnv;
  for (const char byte : bytes) fnv.absorb(static_cast<unsigned char>(byte));
  return fnv.hash;
}

}  // namespace

TEST_CASE("the bytes that are hashed are fixed: row count, then IEEE 754 bits, least significant byte first") {
  CHECK(content_hash(Flight{}) == fnv1a(std::string(8, '\0')));

  pinnquad::Sample sample;
  sample.time_s = 1.0;        // 0x3ff0000000000000
  sample.commands[3] = -2.5;  // 0xc004000000000000
  std::string bytes = std::string("\x01", 1) + std::string(7, '\0');
  bytes += std::string(6, '\0') + "\xf0\x3f" + std::string(19 * 8, '\0') + std::string(6, '\0') + "\x04\xc0";
  CHECK(content_hash({sample}) == fnv1a(bytes));
}

TEST_CASE("the last bit of any value changes the hash, and so do order and number of rows") {
  const Flight flight = pinnquad_test::random_flight(3, 7);
  std::set<std::uint64_t> hashes{content_hash(flight)};
  std::size_t variants = 1;
  for (std::size_t row = 0; row < flight.size(); ++row) {
    for (std::size_t field = 0; field < pinnquad::sample_value_count; ++field) {
      auto values = pinnquad::to_values(flight[row]);
      values[field] = std::nextafter(values[field], std::numeric_limits<double>::infinity());
      Flight changed = flight;
      changed[row] = pinnquad::to_sample(values);
      hashes.insert(content_hash(changed));
      ++variants;
    }
  }
  Flight swapped = flight;
  std::swap(swapped[0], swapped[1]);
  hashes.insert(content_hash(swapped));
  hashes.insert(content_hash({flight[0], flight[1]}));
  CHECK(hashes.size() == variants + 2);
  CHECK(content_hash(flight) == content_hash(Flight(flight)));
}

TEST_CASE("signed zeros differ, NaNs do not") {
  pinnquad::Sample sample;
  const auto with_yaw = [&sample](double yaw) {
    sample.yaw_rad = yaw;
    return content_hash({sample});
  };
  CHECK(with_yaw(0.0) != with_yaw(-0.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(with_yaw(nan) == with_yaw(-nan));
  CHECK(with_yaw(nan) != with_yaw(std::numeric_limits<double>::infinity()));
}

TEST_CASE("extra columns: one number per row, names of their own, and they are content") {
  Flight flight = random_flight(4, 11);
  const std::uint64_t bare = content_hash(flight);
  flight.add_column({{"battery_voltage", "V"}, {16, 15.9, 15.8, 15.7}});
  REQUIRE(flight.column("battery_voltage") != nullptr);
  CHECK(flight.column("battery_voltage")->values[2] == 15.8);
  CHECK(flight.column("n1") == nullptr);
  CHECK(content_hash(flight) != bare);
  Flight other = random_flight(4, 11);
  other.add_column({{"battery_voltage", "mV"}, {16, 15.9, 15.8, 15.7}});
  CHECK(content_hash(other) != content_hash(flight));

  CHECK_THROWS_AS(flight.add_column({{"battery_voltage", "V"}, {1, 2, 3, 4}}), std::invalid_argument);
  CHECK_THROWS_AS(flight.add_column({{"n1", "rev/s"}, {1, 2, 3}}), std::invalid_argument);
  CHECK_THROWS_AS(flight.add_column({{"", "V"}, {1, 2, 3, 4}}), std::invalid_argument);
  CHECK_THROWS_AS(flight.add_column({{"altitude", "m"}, {1, 2, 3, 4}}), std::invalid_argument);
  CHECK_THROWS_AS(flight.push_back(flight[3]), std::invalid_argument);
  CHECK(flight.size() == 4);
  const double volts = 15.6;
  flight.push_back(flight[3], &volts, 1);
  CHECK(flight.size() == 5);
  CHECK(flight.column("battery_voltage")->values.back() == 15.6);
}

TEST_CASE("the rows that are kept are those of a flight made of them alone") {
  Flight flight = random_flight(9, 3);
  flight.add_column({{"battery", "V"}, {0, 1, 2, 3, 4, 5, 6, 7, 8}});
  for (const unsigned wanted : {0u, 0x1ffu, 0x155u, 0x0feu, 0x101u}) {
    Flight expected;
    expected.add_column({{"battery", "V"}, {}});
    for (std::size_t row = 0; row < flight.size(); ++row) {
      const double extra = static_cast<double>(row);
      if ((wanted >> row & 1u) != 0) expected.push_back(flight[row], &extra, 1);
    }
    Flight kept = flight;
    kept.keep_rows([wanted](std::size_t row) { return (wanted >> row & 1u) != 0; });
    CHECK(kept.size() == expected.size());
    CHECK(content_hash(kept) == content_hash(expected));
  }
}

TEST_CASE("a dataset: one flight is that flight; of several, names and clocks are looked at") {
  const Flight flight = random_flight(30, 12);
  CHECK(content_hash(pinnquad::Dataset(flight)) == content_hash(flight));
  pinnquad::Dataset dataset;
  const auto named = [](const char* name, unsigned seed) {
    Flight made = random_flight(10, seed);
    made.name = name;
    return made;
  };
  dataset.add(named("a", 1));
  dataset.add(named("b", 2));
  CHECK(dataset.rows() == 20);
  CHECK_THROWS_WITH_AS(dataset.add(named("a", 3)),
                       "dataset: expected a name of its own for each flight, found 'a' twice", std::invalid_argument);
  Flight backwards = named("c", 4);
  backwards[6].time_s = backwards[5].time_s;
  CHECK_THROWS_WITH_AS(dataset.add(backwards), "dataset: time does not increase at row 7 of flight 'c'",
                       std::invalid_argument);
  Flight weightless = named("c", 4);
  weightless.weight = 0;
  CHECK_THROWS_AS(dataset.add(weightless), std::invalid_argument);
  CHECK(dataset.size() == 2);

  pinnquad::Dataset swapped;
  swapped.add(named("b", 2));
  swapped.add(named("a", 1));
  CHECK(content_hash(swapped) != content_hash(dataset));
}

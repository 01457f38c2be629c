// SPDX-License-Identifier: MIT
// Features of recorded flights: columns by name, windows within their rows, and the same features as in flight.
#include "pinnquad/data/flight_features.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/random.hpp"

using namespace pinnquad;

namespace {

using Period = PeriodMicroseconds<50000>;
struct ThirdRotor {
  static constexpr const char* name = "n3";
  static constexpr const char* unit = "rev/s";
};
using Voltage = WithColumns<PaperFeatures, BatteryVoltage, ThirdRotor>;
using Past = Windowed<Voltage, 3, Period>;
using About = Windowed<PaperFeaturesWithAltitude, 3, Period, Centred>;

/// A flight of smooth motion with columns; `jitter_s` is the most by which a row's time is off the multiple of 0.05 s.
Flight flown(std::size_t rows, double jitter_s, std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  Flight flight;
  flight.name = "flown";
  std::vector<double> volts, speeds;
  for (std::size_t i = 0; i < rows; ++i) {
    Sample s;
    s.time_s = 0.05 * double(i) + uniform(engine, -jitter_s, jitter_s);
    const auto wave = [&](double rate, double phase) { return std::sin(rate * s.time_s + phase); };
    for (int k = 0; k < 3; ++k) {
      s.linear_acceleration_m_s2[k] = 4 * wave(3, k);
      s.angular_acceleration_rad_s2[k] = 15 * wave(5, 2 + k);
      s.velocity_m_s[k] = 3 * wave(1, 4 + k);
      s.body_rates_rad_s[k] = 2 * wave(2, 1 + k);
    }
    s.roll_rad = 0.4 * wave(2.5, 0);
    s.pitch_rad = 0.3 * wave(1.5, 1);
    s.yaw_rad = 3 * wave(0.4, 2);
    s.altitude_m = 5 + wave(0.5, 0);
    flight.push_back(s);
    volts.push_back(16 - 0.05 * s.time_s);
    speeds.push_back(100 + 10 * wave(4, 1));
  }
  flight.add_column({{"battery_voltage", "V"}, volts});
  flight.add_column({{"n3", "rev/s"}, speeds});
  return flight;
}

/// Features of all rows that have some, with the row.
template <class Features>
std::vector<std::pair<std::size_t, std::array<float, std::size_t(Features::size)>>> features(const RowSet& rows) {
  std::vector<std::pair<std::size_t, std::array<float, std::size_t(Features::size)>>> result;
  each_features<Features, float>(rows,
                                 [&](const Flight&, std::size_t row, const auto& x) { result.emplace_back(row, x); });
  return result;
}

/// The flight's rows as a loop takes them in.
template <class Features>
void replay(const Flight& flight, InputHistory<Features, float>& history,
            std::vector<std::pair<std::size_t, std::array<float, std::size_t(Features::size)>>>& answered) {
  const FlightInputs<typename InputHistory<Features, float>::Present> present({&flight, {0, flight.size()}});
  for (std::size_t row = 0; row < flight.size(); ++row) {
    typename InputHistory<Features, float>::Present inputs;
    REQUIRE(present.read(row, inputs));
    if (history.take(inputs, flight[row].time_s) != Status::ok) continue;
    std::array<float, std::size_t(Features::size)> x{};
    Features::extract(history.inputs(), x.data());
    answered.emplace_back(row, x);
  }
}

}  // namespace

TEST_CASE("columns are read by name; a flight that lacks one, or has it in another unit, is refused") {
  const Flight flight = flown(5, 0);
  const auto x = features<Voltage>(RowSet(flight, {0, 5}));
  REQUIRE(x.size() == 5);
  CHECK(x[4].second[16] == float(16 - 0.05 * flight[4].time_s));
  CHECK(x[2].second[17] == float(flight.column("n3")->values[2]));
  const auto wanted = wanted_columns<Past>();
  REQUIRE(wanted.size() == 2);
  CHECK(wanted[1].name == "n3");
  CHECK(wanted[1].unit == "rev/s");

  Flight bare;
  bare.name = "bare";
  for (const Sample& sample : flight) bare.push_back(sample);
  CHECK(features<PaperFeatures>(RowSet(bare, {0, 5})).size() == 5);
  CHECK_THROWS_WITH_AS(features<Voltage>(RowSet(bare, {0, 5})),
                       "flight 'bare': expected a column battery_voltage in V, found none of that name",
                       std::invalid_argument);
  bare.add_column({{"battery_voltage", "mV"}, std::vector<double>(5, 16000)});
  CHECK_THROWS_WITH_AS(features<Voltage>(RowSet(bare, {0, 5})),
                       "flight 'bare': expected a column battery_voltage in V, found it in mV", std::invalid_argument);
}

TEST_CASE("jittered time stamps: training sees the features that the loop will see, to the bit") {
  for (const double jitter_s : {0.0, 0.002, 0.01}) {
    CAPTURE(jitter_s);
    const Flight flight = flown(400, jitter_s);
    const auto trained = features<Past>(RowSet(flight, {0, flight.size()}));
    InputHistory<Past, float> history;
    decltype(features<Past>({})) answered;
    replay<Past>(flight, history, answered);
    CHECK(trained.size() > 390);
    CHECK(trained == answered);
  }
}

TEST_CASE("a gap in a recording is a gap in flight, and time that steps back as well") {
  const Flight whole = flown(60, 0.003);
  Flight gap;
  for (std::size_t i = 0; i < 60; ++i) {
    if (i == 20 || i == 21) continue;
    Sample sample = whole[i];
    if (i >= 40) sample.time_s -= 30;  // a log whose clock was set; no dataset takes it, the features do not mind
    gap.push_back(sample);
  }
  gap.add_column({{"battery_voltage", "V"}, std::vector<double>(58, 15)});
  gap.add_column({{"n3", "rev/s"}, std::vector<double>(58, 90)});
  const auto trained = features<Past>(RowSet(gap, {0, 58}));
  InputHistory<Past, float> history;
  decltype(features<Past>({})) answered;
  replay<Past>(gap, history, answered);
  CHECK(trained == answered);
  CHECK(trained.size() < 55);
  for (const auto& row : trained) {
    for (const std::size_t first_after : {std::size_t{20}, std::size_t{38}}) {
      CHECK((row.first < first_after || row.first >= first_after + 2));
    }
  }
}

TEST_CASE("no window crosses a border of a flight or of a split") {
  const Flight a = flown(50, 0, 1), b = flown(50, 0, 2);
  RowSet rows;
  rows.add(a, {0, 30});
  rows.add(b, {10, 40});
  rows.add(a, {30, 50});  // neighbours in time of the first piece: a border all the same
  const auto past = features<Past>(rows);
  CHECK(past.size() == 28 + 28 + 18);
  CHECK(past[0].first == 2);
  CHECK(past[28].first == 12);
  CHECK(past[56].first == 32);
  const auto about = features<About>(rows);
  CHECK(about.size() == 28 + 28 + 18);
  CHECK(about[0].first == 1);
  CHECK(about[27].first == 28);
  CHECK(about[28].first == 11);
  // whatever stands beyond the border changes nothing
  Flight changed = a;
  for (std::size_t i = 30; i < 50; ++i) changed[i].velocity_m_s[0] = 1e3;
  CHECK(features<About>(RowSet(changed, {0, 30})) == features<About>(RowSet(a, {0, 30})));
  CHECK(features<Past>(RowSet(changed, {0, 30})) == features<Past>(RowSet(a, {0, 30})));
}

TEST_CASE("a centred window is about its row") {
  const Flight flight = flown(30, 0);
  const auto about = features<About>(RowSet(flight, {0, 30}));
  const auto single = features<PaperFeaturesWithAltitude>(RowSet(flight, {0, 30}));
  REQUIRE(about.size() == 28);
  for (const auto& [row, x] : about) {
    for (std::size_t i = 0; i < 17; ++i) {
      CHECK(x[i] == single[row].second[i]);
      CHECK(x[17 + i] == single[row - 1].second[i]);
      CHECK(x[34 + i] == single[row + 1].second[i]);
    }
  }
}

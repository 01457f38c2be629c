// SPDX-License-Identifier: MIT
// No flight of the independent simulator and no real log is taken for nonsense.
#include <doctest/doctest.h>

#include <fstream>
#include <string>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/data/plausibility.hpp"
#include "reference/reference_rows.hpp"

namespace {

using pinnquad::Flight;
using pinnquad::Vector3;

/// The fault of a flight, in words; empty for none.
std::string complaint(const Flight& flight) {
  const auto found = pinnquad::find_implausible(flight);
  if (!found) return "";
  return "row " + std::to_string(found->row) + ": expected " + found->expected + ", found " + found->found;
}

}  // namespace

TEST_CASE("the independent simulator's flights are flights") {
  for (const char* name : {"D1", "D1_m1.0", "D2_m1.0", "D3_m1.0"}) {
    CAPTURE(name);
    const Flight flight =
        pinnquad::read_flight_csv(pinnquad::test::reference_folder() + "/airlib/flights/" + name + ".csv");
    CHECK(flight.size() > 4000);
    CHECK(complaint(flight) == "");
    Flight wrong = flight;
    for (auto& sample : wrong) sample.angular_acceleration_rad_s2 *= -1;
    CHECK(complaint(wrong).find("in column wdot_x, found that of w_x negated") != std::string::npos);
    wrong = flight;
    for (auto& sample : wrong) sample.linear_acceleration_m_s2 *= -1;
    CHECK(complaint(wrong).find("in column vdot_bx, found that of v_bx negated") != std::string::npos);
  }
}

namespace {
std::string real_logs() { return pinnquad::test::reference_folder() + "/flight_logs/nanobench_subset_50hz.csv"; }
}  // namespace

/// Crazyflie, 50 Hz, eleven flights one after the other; the file's body acceleration is R^T a_world (its README).
TEST_CASE("real logs are flights, one by one and end to end; in degrees they are none" *
          doctest::skip(!std::ifstream(real_logs()))) {
  const std::string path = real_logs();
  const auto rows =
      pinnquad::read_csv(path, {"t",  "abx", "aby",  "abz",   "dwx", "dwy", "dwz", "vbx", "vby", "vbz", "wx",
                                "wy", "wz",  "roll", "pitch", "yaw", "pz",  "u1",  "u2",  "u3",  "u4"});
  std::vector<Flight> flights(1);
  Flight joined;
  double offset_s = 0;
  for (const auto& row : rows) {
    pinnquad::Sample::Values values;
    std::copy(row.begin(), row.end(), values.begin());
    pinnquad::Sample sample = pinnquad::to_sample(values);
    sample.linear_acceleration_m_s2 -= pinnquad::cross(sample.body_rates_rad_s, sample.velocity_m_s);
    sample.altitude_m = -sample.altitude_m;
    if (!flights.back().empty() && !(sample.time_s > flights.back().back().time_s)) {
      offset_s += flights.back().back().time_s + 1;
      flights.emplace_back();
    }
    flights.back().push_back(sample);
    sample.time_s += offset_s;
    joined.push_back(sample);
  }
  CHECK(flights.size() >= 5);
  CHECK(joined.size() > 15000);
  for (const Flight& flight : flights) CHECK(complaint(flight) == "");
  CHECK(complaint(joined) == "");

  for (const Flight& flight : flights) {
    Flight wrong = flight;
    for (auto& sample : wrong) {
      sample.angular_acceleration_rad_s2 = pinnquad::swap_flu_frd(sample.angular_acceleration_rad_s2);
    }
    CHECK(complaint(wrong).find("in column wdot_y, found that of w_y negated") != std::string::npos);
  }
  Flight wrong = joined;
  for (auto& sample : wrong) sample.body_rates_rad_s *= 57.29577951;
  CHECK(complaint(wrong).find("expected radians per second") != std::string::npos);
  wrong = joined;
  for (auto& sample : wrong) {
    sample.roll_rad *= 57.29577951;
    sample.pitch_rad *= 57.29577951;
    sample.yaw_rad *= 57.29577951;
  }
  CHECK(complaint(wrong).find("expected radians in column roll") != std::string::npos);
}

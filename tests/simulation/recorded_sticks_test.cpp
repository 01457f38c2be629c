// SPDX-License-Identifier: MIT
// Stick recordings: written and read bit for bit, flown again as they were flown, refused in one line where they are
// wrong.
#include "pinnquad/simulation/recorded_sticks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace pinnquad;
using pinnquad_test::TemporaryFolder;

pinnquad::detail::StickRow row_of(double time_s, double north_m_s) {
  pinnquad::detail::StickRow row;
  row.time_s = time_s;
  row.set_point.velocity_m_s[0] = north_m_s;
  row.set_point.yaw_rate_rad_s = 2 * north_m_s;
  row.set_point.stick_rad_s[2] = -north_m_s;
  return row;
}

}  // namespace

static_assert(is_pilot<RecordedSticks>);

TEST_CASE("linear between rows, the first before them, a hover after them") {
  RecordedSticks pilot({row_of(1, 2), row_of(2, 4), row_of(4, 0)});
  const State<double> anywhere;
  CHECK(pilot(anywhere, 0).velocity_m_s[0] == 2);
  CHECK(pilot(anywhere, 1).velocity_m_s[0] == 2);
  CHECK(pilot(anywhere, 1.25).velocity_m_s[0] == 2.5);
  CHECK(pilot(anywhere, 1.5).yaw_rate_rad_s == 6);
  CHECK(pilot(anywhere, 2).velocity_m_s[0] == 4);
  CHECK(pilot(anywhere, 3.5).stick_rad_s[2] == -1);
  CHECK(pilot(anywhere, 4).velocity_m_s[0] == 0);
  CHECK(pilot(anywhere, 4.1).velocity_m_s.norm() == 0);
  RecordedSticks ends_moving({row_of(1, 2), row_of(2, 4)});
  CHECK(ends_moving(anywhere, 2).velocity_m_s[0] == 4);
  CHECK(ends_moving(anywhere, 2.1).velocity_m_s.norm() == 0);
  CHECK(pilot.duration_s() == 4);
  RecordedSticks negative_zero({row_of(0, -0.0), row_of(1, 3)});  // -0 + 3 * 0 would be 0
  CHECK(std::signbit(negative_zero(anywhere, 0).velocity_m_s[0]));
  CHECK(RecordedSticks({})(anywhere, 1).velocity_m_s.norm() == 0);
}

TEST_CASE("a recording of every 20 ms flies nearly the same") {
  const auto vehicle = flight_vehicle<AgileFlight>(airframe_value<PaperQuadrotor, double>());
  FlightPlan plan = AgileFlight::plan();
  plan.samples = 400;
  StickRecording written;
  const Flight first =
      fly(vehicle, written_down(AgileFlight::pilot(vehicle, std::mt19937_64(6)), written, 0.02), plan).flight;
  CHECK(written.size() == 1000);
  const Flight again = fly(vehicle, RecordedSticks(written), plan).flight;
  constexpr double velocity_m_s = 0.15;  // of up to 8: stick frames between the rows are lost
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    CHECK((first[i].velocity_m_s - again[i].velocity_m_s).norm() < velocity_m_s);
  }
}

TEST_CASE("a wrong recording is refused with file, line and column") {
  const TemporaryFolder folder;
  const std::string path = folder.path("bad.csv");
  const std::string header =
      "time_s,v_north_m_s,v_east_m_s,v_down_m_s,yaw_rate_rad_s,stick_roll_rad_s,stick_pitch_rad_s,stick_yaw_rad_s\n";
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_sticks_csv(path);
    } catch (const InputError& error) {
      const std::string what = error.what();
      REQUIRE(what.compare(0, path.size(), path) == 0);
      return what.substr(path.size());
    }
    return "accepted";
  };
  CHECK(refusal(header + "0,1,2,3,4,5,6,7\n0.1,1,2,3,4,5,6,7\n") == "accepted");
  CHECK(refusal(header + "0,1,2,3,4,5,6,7\n0.1,1,fast,3,4,5,6,7\n") ==
        ":3:3: expected a finite number in column v_east_m_s, found \"fast\"");
  CHECK(refusal(header + "0.1,1,2,3,4,5,6,7\n0.1,1,2,3,4,5,6,7\n") ==
        ":3:1: expected a time above 0.1 in column time_s, found 0.1");
  CHECK(refusal(header + "-1,1,2,3,4,5,6,7\n0.1,1,2,3,4,5,6,7\n") ==
        ":2:1: expected a time of 0 or more in column time_s, found -1");
  CHECK(refusal(header + "0,1,2,3,4,5,6,7\n") == ":2: expected at least 2 rows of data, found 1");
  CHECK(refusal("time_s,v_north_m_s\n0,1\n1,1\n") ==
        ":1: expected a column named v_east_m_s, found none of that name among 2 columns");
}

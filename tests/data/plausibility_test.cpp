// SPDX-License-Identifier: MIT
// No flight is refused; every mistake that a log can hold is named with its line and column.
#include "pinnquad/data/plausibility.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "pinnquad/data/csv.hpp"
#include "pinnquad/dynamics/airframes/crazyflie.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/simulation/flights.hpp"
#include "pinnquad/simulation/recorder.hpp"
#include "support/temporary_folder.hpp"

namespace {

using namespace pinnquad;

std::optional<detail::Implausible> acceleration_mistake(const Flight& flight) {
  return detail::find_acceleration_mistake(flight, detail::attitudes_of(flight));
}

template <class PaperFlight, class Vehicle>
Flight flown(std::uint64_t seed, std::size_t rows) {
  FlightPlan plan = PaperFlight::plan();
  plan.samples = rows;
  const auto vehicle = flight_vehicle<PaperFlight>(airframe_value<Vehicle, double>());
  return fly(vehicle, PaperFlight::pilot(vehicle, std::mt19937_64(seed)), plan).flight;
}

const Flight& some_flight() {
  static const Flight flight = flown<AgileFlight, PaperQuadrotor>(3, 1500);
  return flight;
}

/// A flight with every row changed.
Flight changed(const std::function<void(Sample&)>& change) {
  Flight flight = some_flight();
  for (Sample& sample : flight) change(sample);
  return flight;
}

/// A flight with one number changed.
Flight with_cell(std::size_t row, std::size_t field, double value) {
  Flight flight = some_flight();
  Sample::Values values = to_values(flight[row]);
  values[field] = value;
  flight[row] = to_sample(values);
  return flight;
}

/// The complaint of require_plausible(); the file's columns are in the order of the library.
std::string refusal(const Flight& flight) {
  try {
    require_plausible("no/such/flight.csv", flight);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

constexpr double degrees = 57.295779513082320877;

}  // namespace

TEST_CASE_TEMPLATE("the paper's flights pass, whatever flies", Vehicle, PaperQuadrotor, Crazyflie) {
  for (const std::uint64_t seed : {1u, 2u}) {
    CHECK(refusal(flown<AgileFlight, Vehicle>(seed, 1500)) == "");
    CHECK(refusal(flown<NearGroundFlight, Vehicle>(seed, 1500)) == "");
    CHECK(refusal(flown<WindyFlight, Vehicle>(seed, 1500)) == "");
  }
}

TEST_CASE("a flight that hardly moves passes, and one with a column that stands still but for a manoeuvre") {
  std::mt19937_64 engine(7);
  CHECK(refusal(changed([&](Sample& s) {
          const Sample flown = s;
          s = Sample{};
          s.time_s = flown.time_s;
          s.commands = flown.commands;
          s.body_rates_rad_s = Vector3<double>(1e-3, 1e-3, 1e-3) * standard_normal(engine);
        })) == "");
  Flight flight = changed([](Sample& s) { s.velocity_m_s[1] = 0; });
  for (std::size_t row = 400; row < 404; ++row) flight[row].velocity_m_s[1] = 12;
  CHECK(refusal(flight) == "");
}

TEST_CASE("an angle may wrap round or be counted on") {
  CHECK(refusal(changed([](Sample& s) { s.yaw_rad += 40 * 3.14159265358979; })) == "");
  CHECK(refusal(changed([](Sample& s) { s.yaw_rad = std::remainder(s.yaw_rad + 2, 2 * 3.14159265358979); })) == "");
  Flight flight = changed([](Sample& s) { s.yaw_rad = 3.1415; });
  flight[700].yaw_rad = -3.1415;
  CHECK(refusal(flight) == "");
}

TEST_CASE("a number that no flight has is named with line and column") {
  CHECK(refusal(with_cell(498, 2, 1e39)) ==
        "no/such/flight.csv:500:3: expected -1000 to 1000 m/s^2 in column vdot_by, found 1e+39");
  CHECK(refusal(with_cell(0, 4, -1e30)) ==
        "no/such/flight.csv:2:5: expected -1e+05 to 1e+05 rad/s^2 in column wdot_x, found -1e+30");
  CHECK(refusal(with_cell(9, 16, 1e5)).find(":11:17: expected -1000 to 20000 m in column altitude") !=
        std::string::npos);
  for (std::size_t field = 1; field < sample_value_count; ++field) {
    CAPTURE(field);
    const std::string place = ":302:" + std::to_string(field + 1) + ": ";
    for (const double wrong :
         {1e30, -1e39, std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
      CHECK(refusal(with_cell(300, field, wrong)).find(place) != std::string::npos);
    }
  }
}

TEST_CASE("a cell like none of its neighbours is named, in a column that stands still too") {
  CHECK(refusal(with_cell(498, 8, 150))
            .find(":500:9: expected a value like its neighbours in column v_by, found 150, ") != std::string::npos);
  Flight still = changed([](Sample& s) { s.velocity_m_s[1] = 0; });
  still[800].velocity_m_s[1] = 30;
  CHECK(
      refusal(still) ==
      "no/such/flight.csv:802:9: expected a value like its neighbours in column v_by, found 30, 300 robust deviations "
      "from "
      "the median 0");
}

TEST_CASE("a wild cell beside a gap is not judged: its neighbour was dropped") {
  Flight flight = with_cell(498, 8, 150);
  CHECK(refusal(flight) != "");
  std::size_t row = 0;
  flight.keep_rows([&row](std::size_t) { return row++ != 499; });
  CHECK(refusal(flight) == "");
}

TEST_CASE("commands: what they are instead, and how to convert them") {
  const auto said = [](double factor, double offset) {
    return refusal(changed([&](Sample& s) {
      for (double& u : s.commands) u = offset + factor * u;
    }));
  };
  const std::string expected = "no/such/flight.csv:2:18: expected a command of 0 to 1 in column u1, found ";
  const auto mistake = [&](const std::string& message) {
    CHECK(message.substr(0, expected.size()) == expected);
    const std::size_t bracket = message.find('(');
    return bracket == std::string::npos ? std::string() : message.substr(bracket);
  };
  CHECK(said(1, 0) == "");
  CHECK(mistake(said(1000, 1000)) == "(pulse widths of 1000 to 2000 us? Then write (u - 1000) / 1000)");
  CHECK(mistake(said(100, 0)) == "(percent? Then write u / 100)");
  CHECK(mistake(said(-1, 0)) == "(negated? Then write -u)");
  CHECK(mistake(said(65535, 0)) == "(counts of 16 bits? Then write u / 65535)");
  CHECK(mistake(said(1e6, 0)) == "");
  // rounding to float is no mistake, and a single wrong cell is not taken for a unit
  CHECK(refusal(with_cell(5, 18, 1.0 + 1e-7)) == "");
  CHECK(refusal(with_cell(5, 18, 1500)) ==
        "no/such/flight.csv:7:19: expected a command of 0 to 1 in column u2, found 1500");
}

TEST_CASE("degrees are found by the motion, whichever column has them") {
  CHECK(refusal(changed([](Sample& s) { s.body_rates_rad_s *= degrees; })).find(":2:11: expected radians per second") !=
        std::string::npos);
  const auto in_degrees = [](bool roll, bool pitch, bool yaw, double rates) {
    return refusal(changed([=](Sample& s) {
      if (roll) s.roll_rad *= degrees;
      if (pitch) s.pitch_rad *= degrees;
      if (yaw) s.yaw_rad *= degrees;
      s.body_rates_rad_s *= rates;
    }));
  };
  CHECK(in_degrees(true, true, true, 1).find(":2:14: expected radians in column roll, found degrees") !=
        std::string::npos);
  CHECK(in_degrees(false, true, false, 1).find(":2:15: expected radians in column pitch") != std::string::npos);
  CHECK(in_degrees(false, false, true, 1).find(":2:16: expected radians in column yaw") != std::string::npos);
  CHECK(in_degrees(true, true, true, degrees).find(":2:14: expected radians in column roll") != std::string::npos);
}

TEST_CASE("a clock of another unit is told from the steps, and so are body rates that have stopped") {
  CHECK(refusal(changed([](Sample& s) {
          s.time_s *= 1000;
        })).find(":3:1: expected rows at most 4 s apart in column t") != std::string::npos);
  // the attitude turns slowly about yaw; of a gyro that stands still 57.3 times the rate is no unit
  const auto turning = [](double rate, double jitter) {
    Flight flight = some_flight();
    double sign = 1;
    for (Sample& s : flight) {
      s.roll_rad = s.pitch_rad = 0;
      s.yaw_rad = 0.01 * s.time_s;
      s.body_rates_rad_s = Vector3<double>(0, 0, rate + sign * jitter);
      sign = -sign;
    }
    return refusal(flight);
  };
  CHECK(turning(0.01, 0) == "");
  CHECK(turning(0.01 * degrees, 1e-6).find(":2:11: expected radians per second") != std::string::npos);
  CHECK(turning(0.01 * degrees, 0).find(":2:11: expected body rates that change") != std::string::npos);
}

TEST_CASE("angles of less than a degree are found too: the range has no say") {
  // a slow sway of 0.01 rad, at 20 Hz
  const auto sway = [](double angle_factor, double rate_factor) {
    Flight flight = some_flight();
    for (Sample& s : flight) {
      const double phase = s.time_s;
      s.roll_rad = angle_factor * 0.01 * std::sin(phase);
      s.pitch_rad = s.yaw_rad = 0;
      s.body_rates_rad_s = Vector3<double>(rate_factor * 0.01 * std::cos(phase), 0, 0);
    }
    return refusal(flight);
  };
  CHECK(sway(1, 1) == "");
  CHECK(sway(degrees, 1).find(":2:14: expected radians in column roll, found degrees") != std::string::npos);
  CHECK(sway(1, degrees).find(":2:11: expected radians per second") != std::string::npos);
}

TEST_CASE("the motion is looked at over a fifth of a second: a sway that comes back in two fifths is seen") {
  Flight flight = some_flight();
  constexpr double step_s = 1.0 / 64,
                   per_s = 3.141592653589793 / (13 * step_s);  // 13 rows are the first 0.2 s and more
  double time_s = 0;
  for (Sample& s : flight) {
    s.time_s = time_s;
    const double phase = per_s * std::min(time_s, 390 * step_s);  // whole periods: no step of a part of one
    s.roll_rad = degrees * 0.01 * std::cos(phase);
    s.pitch_rad = s.yaw_rad = 0;
    s.body_rates_rad_s = Vector3<double>(-0.01 * per_s * std::sin(phase), 0, 0);
    time_s += step_s;
  }
  CHECK(refusal(flight).find(":2:14: expected radians in column roll, found degrees") != std::string::npos);
}

namespace {

/// A flight with every row's accelerations changed by a matrix each.
Flight with_accelerations(const Flight& flown, const Matrix<double, 3, 3>& angular,
                          const Matrix<double, 3, 3>& linear) {
  Flight flight = flown;
  for (Sample& s : flight) {
    s.angular_acceleration_rad_s2 = angular * s.angular_acceleration_rad_s2;
    s.linear_acceleration_m_s2 = linear * s.linear_acceleration_m_s2;
  }
  return flight;
}

/// Rows of 50 ms whose rates and velocities are sums of sines, their accelerations by differentiation on paper.
Flight closed_form_flight(std::size_t rows) {
  Flight flight(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    Sample& s = flight[row];
    const double t = s.time_s = 0.05 * static_cast<double>(row);
    for (int axis = 0; axis < 3; ++axis) {
      const double slow = 1.1 + axis, fast = 4.3 - 0.7 * axis;
      s.body_rates_rad_s[axis] = 0.3 * std::sin(slow * t) + 0.1 * std::sin(fast * t);
      s.angular_acceleration_rad_s2[axis] = 0.3 * slow * std::cos(slow * t) + 0.1 * fast * std::cos(fast * t);
      s.velocity_m_s[axis] = 2 * std::sin((0.4 + 0.3 * axis) * t);
      s.linear_acceleration_m_s2[axis] = 2 * (0.4 + 0.3 * axis) * std::cos((0.4 + 0.3 * axis) * t);
    }
    s.commands = {0.5, 0.5, 0.5, 0.5};
  }
  return flight;
}

/// Every turn of the axes with every choice of signs: 48 matrices, the unit matrix first.
std::vector<Matrix<double, 3, 3>> signed_permutations() {
  std::vector<Matrix<double, 3, 3>> all;
  std::array<Eigen::Index, 3> order = {0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Matrix<double, 3, 3> turned = Matrix<double, 3, 3>::Zero();
      for (Eigen::Index row = 0; row < 3; ++row) {
        turned(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1u) != 0 ? -1 : 1;
      }
      all.push_back(turned);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

const Matrix<double, 3, 3> unchanged = Matrix<double, 3, 3>::Identity();

}  // namespace

TEST_CASE("accelerations that are negated or of another axis are refused, whichever; those of the motion pass") {
  for (const Flight& flight : {closed_form_flight(400), some_flight()}) {
    for (const Matrix<double, 3, 3>& turned : signed_permutations()) {
      const bool same = turned == unchanged;
      CAPTURE(turned);
      CHECK(acceleration_mistake(with_accelerations(flight, turned, unchanged)).has_value() != same);
      CHECK(acceleration_mistake(with_accelerations(flight, unchanged, turned)).has_value() != same);
    }
  }
}

TEST_CASE("a wrong acceleration is named with what its column holds") {
  const auto said = [](const Matrix<double, 3, 3>& angular, const Matrix<double, 3, 3>& linear) {
    return refusal(with_accelerations(some_flight(), angular, linear));
  };
  Matrix<double, 3, 3> swapped = Matrix<double, 3, 3>::Zero();
  swapped(0, 1) = swapped(1, 0) = swapped(2, 2) = 1;
  const Matrix<double, 3, 3> flu = Vector3<double>(1, -1, -1).asDiagonal();
  CHECK(said(-unchanged, unchanged) ==
        "no/such/flight.csv:2:5: expected the derivative of w_x in column wdot_x, found that of w_x negated, by how "
        "rates and velocity change from row to row");
  CHECK(said(swapped, unchanged).find("column wdot_x, found that of w_y,") != std::string::npos);
  CHECK(said(unchanged, swapped).find("column vdot_bx, found that of v_by,") != std::string::npos);
  CHECK(said(unchanged, flu)
            .find(":2:3: expected the derivative of v_by in column vdot_by, found that of v_by negated") !=
        std::string::npos);
  CHECK(said(degrees * unchanged, unchanged).find("column wdot_x, found about 5") != std::string::npos);
}

TEST_CASE("what an accelerometer reads, and the world's acceleration in any axes, are no derivative of v in the body") {
  const auto said = [](const std::function<Vector3<double>(const Sample&, const Quaternion<double>&)>& logged) {
    return refusal(changed([&](Sample& s) {
      const auto q = from_euler(EulerAngles<double>{s.roll_rad, s.pitch_rad, s.yaw_rad});
      s.linear_acceleration_m_s2 = logged(s, q);
    }));
  };
  const auto world_in_body = [](const Sample& s) -> Vector3<double> {
    return s.linear_acceleration_m_s2 + cross(s.body_rates_rad_s, s.velocity_m_s);
  };
  CHECK(said([&](const Sample& s, const auto&) { return world_in_body(s); }).find("(subtract w x v)") !=
        std::string::npos);
  CHECK(said([&](const Sample& s, const auto& q) {
          return body_to_world(q, world_in_body(s));
        }).find("in axes north, east, down") != std::string::npos);
  CHECK(said([&](const Sample& s, const auto& q) -> Vector3<double> {
          return world_in_body(s) - world_to_body(q, Vector3<double>(0, 0, standard_gravity_m_s2<double>));
        }).find("what an accelerometer reads") != std::string::npos);
}

TEST_CASE("gyro noise that drowns the motion decides nothing; where some is left, a negated column is found") {
  FlightPlan plan = AgileFlight::plan();
  plan.samples = 3000;
  const auto vehicle = flight_vehicle<AgileFlight>(airframe_value<PaperQuadrotor, double>());
  for (const double noise_rad_s : {0.05, 0.3}) {
    RecorderErrors errors = noisy_gyro_errors();
    errors.gyro_noise_rad_s = noise_rad_s;
    const NoisyRecorder<std::mt19937_64> recorder(std::mt19937_64(5), errors);
    const Flight flight = fly(vehicle, AgileFlight::pilot(vehicle, std::mt19937_64(2)), plan, recorder).flight;
    CHECK(!acceleration_mistake(flight));
    CHECK(acceleration_mistake(with_accelerations(flight, -unchanged, unchanged)).has_value() == (noise_rad_s < 0.1));
  }
}

TEST_CASE("line and column are those of the file, whatever its columns' order") {
  const pinnquad_test::TemporaryFolder folder;
  std::string text = "\xef\xbb\xbfnote,u4,";
  for (std::size_t i = 0; i + 1 < sample_value_count; ++i) text += std::string(sample_field_names[i]) + ",";
  text += "more\r\n";
  for (int row = 0; row < 12; ++row) {
    text += "a," + std::string(row == 7 ? "1.5" : "0.5") + "," + std::to_string(row);
    for (int i = 1; i < 17; ++i) text += ",0";
    text += ",0.5,0.5,0.5,b\r\n";
  }
  const std::string path = folder.write("flight.csv", text);
  CHECK_THROWS_WITH(require_plausible(path, read_flight_csv(path)),
                    (path + ":9:2: expected a command of 0 to 1 in column u4, found 1.5").c_str());
}

TEST_CASE("a command that stands still in a block is found before anything is trained") {
  const auto said = [](const Flight& flight, const IndexRange& block) -> std::string {
    try {
      require_varied_commands("no/such/flight.csv", flight, block, "test");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  Flight flight = some_flight();
  CHECK(said(flight, {0, 900}) == "");
  for (std::size_t row = 900; row < flight.size(); ++row) flight[row].commands[1] = 0.5 + 1e-9 * double(row % 2);
  CHECK(said(flight, {0, 901}) == "");
  CHECK(said(flight, {900, 1500}) ==
        "no/such/flight.csv:902:19: expected commands that change in column u2, found 0.5 in all 600 test rows");
}

// SPDX-License-Identifier: MIT
// Each check finds the fault that is planted, says which it is, and is silent where there is none.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "logs/attitude_convention.hpp"
#include "logs/command_lag.hpp"
#include "logs/log_checks.hpp"
#include "logs/motor_order_check.hpp"
#include "logs/specific_force.hpp"
#include "pinnquad/data/motion_checks.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "programs/logs/synthetic_flight.hpp"

using pinnquad::Flight;
using pinnquad::Sample;
using pinnquad::test::synthetic_flight;

namespace {

const Flight& good_flight() {
  static const Flight flight = synthetic_flight();
  return flight;
}
template <class Change>
Flight changed(const Flight& flight, Change&& change) {
  Flight result = flight;
  for (Sample& sample : result) change(sample);
  return result;
}
bool says(const std::optional<std::string>& finding, const std::string& words) {
  return finding.has_value() && finding->find(words) != std::string::npos;
}

}  // namespace

TEST_CASE("rates in another frame are named, the body's are not") {
  const auto with = [](auto&& change) -> std::optional<std::string> {
    const auto found = pinnquad::find_turning_mistake(changed(good_flight(), change));
    if (!found) return std::nullopt;
    return found->expected + ", found " + found->found;
  };
  CHECK_FALSE(with([](Sample&) {}).has_value());
  CHECK(says(with([](Sample& s) {
               s.body_rates_rad_s = pinnquad::body_to_world(pinnquad::logs::attitude(s), s.body_rates_rad_s);
             }),
             "rates in the world's axes (turn"));
  CHECK(says(with([](Sample& s) { s.body_rates_rad_s = pinnquad::swap_flu_frd(s.body_rates_rad_s); }),
             "x forward, y left, z up"));
  CHECK(says(with([](Sample& s) {
               s.body_rates_rad_s =
                   pinnquad::swap_enu_ned(pinnquad::body_to_world(pinnquad::logs::attitude(s), s.body_rates_rad_s));
             }),
             "east, north, up"));
  CHECK(says(with([](Sample& s) { s.body_rates_rad_s = -s.body_rates_rad_s; }), "turns against"));
  CHECK(says(with([](Sample& s) { s.roll_rad *= -1; }), "w_x or roll is negated"));
  CHECK(says(with([](Sample& s) { std::swap(s.roll_rad, s.pitch_rad); }), "are exchanged"));
  const auto still = with([](Sample& s) {
    s.roll_rad = s.pitch_rad = s.yaw_rad = 0;
    s.body_rates_rad_s.setZero();
  });
  CHECK_FALSE(still.has_value());
  CHECK_FALSE(pinnquad::find_turning_mistake(Flight()).has_value());
}

TEST_CASE("an attitude or a velocity that is late is told with its time, a few rows are not") {
  const auto late = [](std::size_t rows, auto&& copy) {
    Flight flight = good_flight();
    for (std::size_t row = flight.size(); row-- > rows;) copy(flight[row], good_flight()[row - rows]);
    flight.keep_rows([rows](std::size_t row) { return row >= rows; });
    return flight;
  };
  const auto attitude = [](Sample& to, const Sample& from) {
    to.roll_rad = from.roll_rad;
    to.pitch_rad = from.pitch_rad;
    to.yaw_rad = from.yaw_rad;
  };
  const auto found = pinnquad::find_turning_mistake(late(20, attitude));
  REQUIRE(found.has_value());
  CHECK(found->found.find("roll, pitch and yaw 200 ms late") == 0);
  CHECK_FALSE(pinnquad::find_turning_mistake(late(5, attitude)).has_value());
}

TEST_CASE("every convention of an attitude that was read as another is named") {
  const std::vector<std::string> words = {"x, y, z, w", "world into the body", "(ENU)", "(FLU)"};
  const std::vector<std::string> other_words = {"w, x, y, z", "body into the world", "(NED)", "(FRD)"};
  const auto of = [](unsigned bits) {
    return pinnquad::logs::AttitudeConvention{(bits & 1u) != 0, (bits & 2u) != 0, (bits & 4u) != 0, (bits & 8u) != 0};
  };
  for (unsigned log = 0; log < 16; ++log) {
    for (unsigned read = 0; read < 16; ++read) {
      CAPTURE(log);
      CAPTURE(read);
      std::array<std::vector<double>, 4> q;
      std::array<std::vector<double>, 3> rates, force;
      for (const Sample& sample : good_flight()) {
        const auto one = pinnquad::logs::read_attitude(
            pinnquad::logs::written_attitude(pinnquad::logs::attitude(sample), of(log)), of(read));
        const std::array<double, 4> parts = {one.w, one.x, one.y, one.z};
        for (std::size_t i = 0; i < 4; ++i) q[i].push_back(parts[i]);
        const auto f = pinnquad::logs::specific_force_m_s2(sample);
        for (std::size_t i = 0; i < 3; ++i) {
          rates[i].push_back(sample.body_rates_rad_s[static_cast<Eigen::Index>(i)]);
          force[i].push_back(f[static_cast<Eigen::Index>(i)]);
        }
      }
      q[2][700] = std::nan("");
      const auto found =
          pinnquad::logs::check_attitude(0.01, of(read), {&q[0], &q[1], &q[2], &q[3]},
                                         {&rates[0], &rates[1], &rates[2]}, {&force[0], &force[1], &force[2]});
      CHECK(found.has_value() == (log != read));
      for (unsigned bit = 0; bit < 4 && found; ++bit) {
        const bool differs = ((log ^ read) >> bit & 1u) != 0;
        CHECK(says(found, (log >> bit & 1u) != 0 ? words[bit] : other_words[bit]) == differs);
        CHECK_FALSE(says(found, (log >> bit & 1u) != 0 ? other_words[bit] : words[bit]));
      }
    }
  }
}

TEST_CASE("a specific force that points down through the rotors is told") {
  std::vector<double> z;
  for (const Sample& sample : good_flight()) z.push_back(pinnquad::logs::specific_force_m_s2(sample)[2]);
  CHECK_FALSE(pinnquad::logs::check_thrust_direction(z).has_value());
  for (double& v : z) v = -v;
  z.front() = std::nan("");
  CHECK(says(pinnquad::logs::check_thrust_direction(z), "(FLU)"));
  CHECK_FALSE(pinnquad::logs::check_thrust_direction({}).has_value());
}

TEST_CASE("each of the 24 orders of motors is found and its convention named; the right one is left alone") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const Flight aligned = pinnquad::logs::remove_lag(good_flight(), 0.01, 0.05);
  std::array<std::size_t, 4> order = {0, 1, 2, 3};
  do {
    CAPTURE(order[0]);
    CAPTURE(order[1]);
    CAPTURE(order[2]);
    const Flight logged = changed(aligned, [&](Sample& sample) {
      const auto commands = sample.commands;
      for (std::size_t i = 0; i < 4; ++i) sample.commands[order[i]] = commands[i];
    });
    const auto check = pinnquad::logs::check_motor_order({logged}, airframe);
    CHECK_FALSE(check.ambiguous);
    CHECK(check.permutation == order);
    CHECK(check.finding.has_value() == (order != std::array<std::size_t, 4>{0, 1, 2, 3}));
    // Betaflight's 1 rear right, 2 front right, 3 rear left, 4 front left; ours front right, rear left, front left,
    // rear right
    CHECK((check.convention == "betaflight") == (order == std::array<std::size_t, 4>{1, 2, 3, 0}));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("propellers that turn the other way are told, and a flight that says nothing is ambiguous") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const Flight aligned = pinnquad::logs::remove_lag(good_flight(), 0.01, 0.05);
  const auto spin = pinnquad::logs::check_motor_order({changed(aligned,
                                                               [](Sample& s) {
                                                                 s.angular_acceleration_rad_s2[2] *= -1;
                                                                 s.body_rates_rad_s[2] *= -1;
                                                               })},
                                                      airframe);
  CHECK(spin.yaw_reversed);
  CHECK(says(spin.finding, "propellers turn the other way"));
  const auto hover = pinnquad::logs::check_motor_order({changed(aligned,
                                                                [](Sample& s) {
                                                                  s.commands = {0.5, 0.5, 0.5, 0.5};
                                                                })},
                                                       airframe);
  CHECK(hover.ambiguous);
  CHECK_FALSE(hover.finding.has_value());
  CHECK(pinnquad::logs::check_motor_order({}, airframe).ambiguous);
}

TEST_CASE("a signal that stands still is found where it does; noise, steps and few rows are not") {
  std::vector<double> time_s, values;
  for (int row = 0; row < 1000; ++row) {
    time_s.push_back(0.01 * row);
    values.push_back(std::sin(0.1 * row));
  }
  CHECK_FALSE(pinnquad::logs::check_frozen("p", time_s, values).has_value());
  for (std::size_t row = 400; row < 420; ++row) values[row] = values[400];
  CHECK_FALSE(pinnquad::logs::check_frozen("p", time_s, values).has_value());  // 0.19 s
  for (std::size_t row = 400; row < 500; ++row) values[row] = values[400];
  CHECK(
      says(pinnquad::logs::check_frozen("p", time_s, values), "p stands still for 0.99 s in 1 stretch, first at 4 s"));
  values.assign(values.size(), 2.5);
  CHECK(says(pinnquad::logs::check_frozen("p", time_s, values), "never changes"));
  values.assign(values.size(), std::nan(""));
  CHECK_FALSE(pinnquad::logs::check_frozen("p", time_s, values).has_value());
}

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
bool says(const std::optional<std::string>& finding, const std::string& words) {
  return finding.has_value() && finding->find(words) != std::string::npos;
}

}  // namespace

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

TEST_CASE("each of the 24 orders of motors is found and its convention named; the right one is left alone") {
  const auto airframe = pinnquad::PaperQuadrotor::value<double>();
  const Flight aligned = pinnquad::logs::remove_lag(good_flight(), 0.01, 0.05);
  std::array<std::size_t, 4> order = {0, 1, 2, 3};
  do {
    CAPTURE(order[0]);
    CAPTURE(order[1]);
    CAPTURE(order[2]);
    Flight logged = aligned;
    for (Sample& sample : logged) {
      const auto commands = sample.commands;
      for (std::size_t i = 0; i < 4; ++i) sample.commands[order[i]] = commands[i];
    }
    const auto check = pinnquad::logs::check_motor_order({logged}, airframe);
    CHECK_FALSE(check.ambiguous);
    CHECK(check.permutation == order);
    CHECK(check.finding.has_value() == (order != std::array<std::size_t, 4>{0, 1, 2, 3}));
    // Betaflight's 1 rear right, 2 front right, 3 rear left, 4 front left; ours front right, rear left, front left,
    // rear right
    CHECK((check.convention == "betaflight") == (order == std::array<std::size_t, 4>{1, 2, 3, 0}));
  } while (std::next_permutation(order.begin(), order.end()));
}

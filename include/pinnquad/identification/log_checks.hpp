// SPDX-License-Identifier: MIT
// Interface only, for now: checks of motion, commands and topics. Each moves to a header of its own.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/data/split.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/identification/common_clock.hpp"
#include "pinnquad/identification/finding.hpp"

namespace pinnquad {

// rate_frame.hpp: body rates that are the world's
std::optional<Finding> check_rate_frame(const std::vector<Flight>& segments);
// rate_units.hpp: degrees (data/degrees.hpp)
std::optional<Finding> check_degrees(const std::vector<Flight>& segments);
// motor_order_check.hpp
struct MotorOrderCheck {
  std::optional<Finding> finding;            ///< none where the order as it stands fits
  std::array<std::size_t, 4> permutation{};  ///< right u_i = logged u_permutation[i]; identity where none is proposed
  bool ambiguous = false;                    ///< several permutations fit alike (yaw is weak), or nothing is excited
};
MotorOrderCheck check_motor_order(const std::vector<Flight>& lag_aligned, const Airframe<double>& airframe);
// attitude_convention.hpp: on raw attitude and measured specific force, by row of one clock
std::optional<Finding> check_attitude(const std::vector<Flight>& segments);
// frozen_signal.hpp
std::vector<IndexRange> frozen_rows(const std::vector<double>& time_s, const std::vector<double>& values,
                                    double longest_s);
// clock_checks.hpp
std::vector<Finding> check_clock(const std::string& topic, const ClockReport& report);
std::optional<Finding> check_log_rate(const std::string& topic, double period_s);
// row_checks.hpp: true for a row to drop
std::vector<bool> saturated_rows(const Flight& flight, double lowest = 0.0, double highest = 1.0);
std::vector<bool> grounded_rows(const Flight& flight);
std::vector<bool> outlier_rows(const Flight& flight);

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// A motor as a first-order lag behind a pure delay: time constant and delay that explain the motion best.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "logs/command_lag.hpp"

namespace programs {

struct MotorLag {
  double time_constant_s = 0;
  double delay_s = 0;                  ///< transport, and the delay of filters in what was measured
  double explained = 0;                ///< mean R^2 of the motions that CommandLag found
  double explained_by_pure_delay = 0;  ///< the same with no time constant, at its own best delay
  bool found = false;                  ///< otherwise nothing but CommandLag's lag is known
  std::string warning;                 ///< empty for none

  /// The lag of slow commands.
  double equivalent_delay_s() const noexcept { return time_constant_s + delay_s; }
};

/// Time constants of 0 to 0.16 s and delays of the search, in the band of `pure` and over the motions that it found:
/// first on a grid, then between its neighbours. Segments and clock as for estimate_command_lag(), whose answer `pure`
/// is. Limits: of a calm flight the two are hardly told apart, and the gyro's noise, which comes back as commands,
/// makes both look longer: a warning says so. A logged command holds until the next: half a period of it counts as
/// delay.
inline MotorLag fit_motor_lag(const std::vector<pinnquad::Flight>& segments, double period_s, const CommandLag& pure,
                              const LagSearch& search = {}) {
  constexpr double clear = 0.95;
  MotorLag best;
  if (!pure.found) {
    best.warning = pure.warning;
    return best;
  }
  const detail::LagGrid grid(search, period_s);
  std::vector<detail::LagSeries> whole = detail::lag_series(segments);
  if (pure.low_pass_Hz > 0) whole = detail::low_passed(std::move(whole), period_s, pure.low_pass_Hz);
  double most = -1;
  detail::Explained explained_at_best{};
  const auto attempt = [&](double time_constant_s) {
    std::vector<detail::LagSeries> lagged = whole;
    for (detail::LagSeries& one : lagged) {
      for (auto& series : one.commands) detail::apply_first_order_lag(series, period_s, time_constant_s);
    }
    std::size_t rows = 0;
    const auto explained = detail::explained_by_lag(lagged, grid.first, grid.last, grid.stride, rows);
    std::vector<double> curve;
    for (const detail::Explained& at : explained) {
      double sum = 0;
      for (std::size_t m = 0; m < detail::lag_motions; ++m) sum += pure.motions[m].found ? detail::say(at[m]) : 0;
      curve.push_back(sum);
    }
    const double peak = detail::peak_at(curve);
    const auto top = static_cast<std::size_t>(std::lround(peak));
    double mean = 0, count = 0;
    for (std::size_t m = 0; m < detail::lag_motions; ++m) {
      if (!pure.motions[m].found) continue;
      mean += explained[top][m];
      count += 1;
    }
    if (!(time_constant_s > 0)) best.explained_by_pure_delay = mean / count;
    if (!(curve[top] > most)) return;
    most = curve[top];
    best.time_constant_s = time_constant_s;
    best.delay_s = grid.lag_s(peak);
    best.explained = mean / count;
    explained_at_best = explained[top];
  };
  const std::vector<double> coarse = {0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.13, 0.16};
  for (const double time_constant_s : coarse) attempt(time_constant_s);
  for (double step_s = best.time_constant_s > 0.06 ? 0.008 : 0.005; step_s > 0.001; step_s /= 2) {
    const double centre = best.time_constant_s;
    if (centre > step_s) attempt(centre - step_s);
    attempt(centre + step_s);
  }
  best.found = true;
  double clearest = 0;
  for (std::size_t m = 0; m < detail::lag_motions; ++m) {
    if (pure.motions[m].found) clearest = std::max(clearest, explained_at_best[m]);
  }
  if (best.time_constant_s > coarse.back()) {
    best.warning =
        "the motors seem slower than " + detail::milliseconds(coarse.back()) + ": no time constant is certain";
  } else if (best.delay_s < -0.5 * grid.step_s()) {
    best.warning = "a time constant of " + detail::milliseconds(best.time_constant_s) +
                   " leaves a delay below zero: the flight is too calm to tell the two apart";
  } else if (clearest < clear) {
    best.warning = "the commands explain " + std::to_string(std::lround(100 * clearest)) +
                   " % of the clearest motion: time constant and delay are rough, the lag alone is better known";
  }
  return best;
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// Ranges that hold the numbers of every quadrotor, from a nano of 30 g to a carrier of 30 kg, with a margin. A number
// outside of them is no vehicle's: commands were filtered, clipped or stamped late on their way into the log, a unit is
// mistaken, or the flights do not tell the number and the fit ran away.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pinnquad/core/body.hpp"
#include "pinnquad/dynamics/airframe.hpp"
#include "pinnquad/regression/identification.hpp"

namespace pinnquad {

/// True where the interval is no wider than this share of the value: then the number stands on the flights.
bool is_told(const Estimate& estimate, double share) noexcept;

namespace detail {
/// Ends of a range, both within it.
struct PlausibleRange {
  double least, most;
  constexpr bool holds(double value) const noexcept { return value >= least && value <= most; }
};
}  // namespace detail

namespace plausible {
/// Grows with the propeller: 5 ms (the paper's simulator), 33 ms (5 inches), 60 ms (a Crazyflie's brushed motors), some
/// 0.1 s of 28 inches.
inline constexpr detail::PlausibleRange rotor_lag_s{0, 0.2};
/// Before the lag: 5 ms (a gyro's filter of 40 Hz) to 0.1 s (a radio link). Below 0 by half of a coarse row, or by
/// commands that are stamped a tick late.
inline constexpr detail::PlausibleRange delay_s{-0.06, 0.15};
/// Greatest angular acceleration from rest, rad/s^2: two rotors at command 1. 20 of a carrier, 1000 of a small racer.
inline constexpr std::array<detail::PlausibleRange, 3> turn_rad_s2{{{15, 3000}, {15, 3000}, {1, 500}}};
/// Moment of inertia over mass and the square of the arm: 0.15 to 0.65 of the airframes here, 1 if all mass sat in the
/// motors. The arm may be an assumed one, a fifth of the true or five times as long.
inline constexpr detail::PlausibleRange inertia_over_arms{0.01, 5};
/// Effectiveness of roll over that of pitch, either way: moments and arms of both are alike within this factor. Told,
/// not refused.
inline constexpr double roll_over_pitch = 3;
}  // namespace plausible

/// A number of an identification that lies outside of its range.
struct ImplausibleNumber {
  const char* key;    ///< "rotor_lag_s", as the numbers of an identification are called; "inertia_x" about an axis
  const char* words;  ///< "rotor lag"
  const char* unit;
  double value;
  detail::PlausibleRange range;
};

namespace detail {

/// That an airframe would take: told to half of it, above 0.
inline bool is_taken(const Estimate& estimate) noexcept { return is_told(estimate, 0.5) && estimate.value > 0; }

}  // namespace detail

/// The rotor lags: one, or of growing and falling thrust.
std::optional<ImplausibleNumber> implausible_lag(const Identification& found);

/// The effectiveness about an axis: of one rotor, and two turn the vehicle one way.
std::optional<ImplausibleNumber> implausible_effectiveness(const Identification& found, std::size_t axis);

/// The first number that no quadrotor has, with the arms of `like`. The delay, of which no airframe is made, counts
/// where its whole interval lies outside: the law that was fitted is then not the vehicle's. None: all are
/// plausible, or not told.
std::optional<ImplausibleNumber> implausible_number(const Identification& found, const Airframe<double>& like);

/// Effectiveness of roll over that of pitch, where both are told and further apart than a quadrotor's; none else.
std::optional<double> unlike_axes(const Identification& found);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/plausible_vehicle.hpp"
#endif

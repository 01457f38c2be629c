// SPDX-License-Identifier: MIT
// The vehicle that flew, from its flights alone: thrust per mass, torque per inertia, drag, damping, the rotors' lag
// and delay, each with a 95 % interval. With s_i the thrust fractions behind lag and delay, sigma_i the signs of the
// allocation, body FRD:
//   w_a'  = B_a sum sigma_i s_i + C_a sum s_i - D_a w_a + G_a w_b w_c + F_a v_c   about each axis, b and c the next,
//           v_c the velocity across it: along y for roll and yaw, along x for pitch
//   f_z   = - A sum s_i (1 + E (V - V_mean) / V_mean) - d_z v_z - q_z |v_z| v_z   specific force
//   f_x,y = - d v - q |v| v + constant
// The series are smoothed (smoothed_flights.hpp). Instruments are the same series a window and more earlier: a gyro's
// noise goes through the controller into the commands of the same window, and makes least squares wrong by half in calm
// flights; it cannot go into the past. Lag and delay are found by Gauss and Newton with all three axes in one
// regression, each weighted by its residual. Intervals: block_regression.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/regression/block_regression.hpp"

namespace pinnquad {

/// Smoothing of an identification, and numbers that it takes as known.
struct IdentificationSettings {
  /// How much of a vehicle is asked: each less costs less, and leaves the rest of Identification as it was.
  enum class Scope {
    all,
    without_rise_and_fall,  ///< no time constants of growing and falling thrust apart
    thrust_curve            ///< that alone, where it is to be found
  };

  double window_s = 0.16;         ///< of the smoothing: motion up to some 6 Hz counts
  double thrust_curve = 0;        ///< of thrust_fraction()
  bool fit_thrust_curve = false;  ///< finds it where flights tell it (told_curve()), in place of taking that one
  Scope scope = Scope::all;
};

/// An interval is infinite where the flights do not tell.
struct Identification {
  Estimate thrust_m_s2;                          ///< A: specific force of one rotor at command 1
  Estimate thrust_slope_m_s2;                    ///< A beside a constant: another one where commands have another zero
  Estimate thrust_curve;                         ///< k of thrust_fraction(), where it was to be found: all motions
  std::array<Estimate, 4> curve_by;              ///< k by roll, pitch, yaw and the force along z
  Estimate battery;                              ///< E: relative change of the thrust over that of the voltage
  std::array<Estimate, 3> effectiveness_rad_s2;  ///< B: angular acceleration of one rotor at command 1
  std::array<Estimate, 3> imbalance;             ///< C / B: of all rotors together, over that of one; of roll and pitch
                                                 ///< the offset of the centre of gravity over the arm
  std::array<Estimate, 3> damping_1_s;           ///< D
  std::array<Estimate, 3> gyroscopic;            ///< G: (J_y - J_z) / J_x and so on
  std::array<Estimate, 3> by_velocity_rad_s_m;   ///< F: what the air turns, rad/s^2 per m/s
  std::array<Estimate, 3> linear_drag_1_s;       ///< d, beside q
  std::array<Estimate, 3> quadratic_drag_1_m;    ///< q, beside d
  std::array<Estimate, 3> drag_1_m;              ///< q of a vehicle without d
  Estimate lag_s;                                ///< time constant of the rotors
  Estimate delay_s;     ///< before it, filters of the sensors included; may be negative by half a row
  Estimate response_s;  ///< both together
  Estimate rise_s, fall_s, fall_after_rise_s;  ///< time constants of growing and falling thrust, and their difference
  bool delay_held = false;                     ///< lag and delay are not told apart: the delay is that of a grid
  double mean_voltage_V = 0;
  double duration_s = 0;  ///< of flight that was used
  std::size_t blocks = 0;
  /// Standard deviations of what should have moved: signed command sums, sum of all commands, velocity.
  std::array<double, 3> signed_sum_deviation{};
  double collective_deviation = 0;
  std::array<double, 3> speed_deviation_m_s{};
};

/// Widest interval of a thrust curve, to either side, that tells it.
inline constexpr double narrow_curve = 0.2;

/// A thrust curve that flights tell, at most 1; none where its interval is wide, or begins near 0: straight.
inline std::optional<double> told_curve(const Estimate& curve) noexcept {
  constexpr double bent = 0.05;
  if (!(curve.half_width <= narrow_curve && curve.low() > bent)) return std::nullopt;
  return curve.value < 1 ? curve.value : 1;
}

/// The vehicle of flights, rows of one period with the commands as they were given: in what a log's import shifted, the
/// shift is missing from `delay_s`. `signs`: axis_signs().
Identification identify(const RowSet& rows, const std::array<std::array<double, rotor_count>, 3>& signs,
                        const IdentificationSettings& settings = {});

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/identification.hpp"
#endif

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
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/rotation_fit.hpp"
#include "pinnquad/regression/smoothed_flights.hpp"

namespace pinnquad {

/// Smoothing of an identification, and numbers that it takes as known.
struct IdentificationSettings {
  double window_s = 0.16;         ///< of the smoothing: motion up to some 6 Hz counts
  double thrust_curve = 0;        ///< of thrust_fraction()
  bool fit_thrust_curve = false;  ///< finds it, in place of taking that one
};

/// An interval is infinite where the flights do not tell.
struct Identification {
  Estimate thrust_m_s2;                          ///< A: specific force of one rotor at command 1
  Estimate thrust_slope_m_s2;                    ///< A beside a constant: another one where commands have another zero
  Estimate thrust_curve;                         ///< k of thrust_fraction(), where it was to be found
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

namespace detail {

/// The regressions of one identification.
class Identifier {
 public:
  Identifier(const RowSet& rows, const InstrumentedFlights::Signs& signs, const IdentificationSettings& settings)
      : rows_(rows, signs, settings.window_s), settings_(settings) {}

  Identification run() {
    constexpr std::size_t fewest_instants = 100;
    Identification result;
    result.duration_s = rows_.duration_s();
    result.blocks = rows_.blocks();
    if (rows_.instants().size() < fewest_instants) return result;
    double curve = settings_.thrust_curve;
    find_rotation(curve, result);
    if (settings_.fit_thrust_curve) {
      curve = find_curve(result);
      find_rotation(curve, result);
    }
    find_forces(curve, result);
    measure_excitation(result);
    return result;
  }

 private:
  using Series = InstrumentedFlights::Series;
  using Fractions = InstrumentedFlights::Fractions;

  void find_rotation(double curve, Identification& result) {
    constexpr std::size_t of_axis = RotationFit::of_axis, first = RotationFit::of_response;
    const RotationFit fit(rows_, curve);
    const RotorResponse nearest = fit.nearest();
    // between coarse rows a command may have been anything: what a cubic misses grows with the square of the period
    const auto resolved = [this](Estimate estimate) {
      const double period_s = rows_.flights().period_s();
      estimate.half_width = std::hypot(estimate.half_width, period_s * period_s / (12 * response_.rise_s));
      return estimate;
    };
    // one that steps to and fro has not converged: its last step leads away
    const auto stands = [](double solved_s, double at_s) {
      constexpr double far = 0.1, far_s = 0.005;
      return std::abs(solved_s - at_s) <= far * at_s + far_s;
    };
    // a fit that fails runs into a bound, turns the vehicle about, or does not converge
    const auto holds = [this, &stands](const BlockSolution& found) {
      constexpr double edge = 0.99;
      return response_.rise_s < edge * RotationFit::longest_s &&
             std::abs(response_.delay_s) < edge * RotationFit::longest_delay_s && found.values()[0] > 0 &&
             found.values()[of_axis] > 0 && stands(found.values()[first], response_.rise_s);
    };
    response_ = nearest;
    BlockSolution solution = fit.converge(response_, RotationFit::lag_and_delay());
    result.lag_s = resolved(solution.estimate(first));
    result.delay_held = !holds(solution) || !(result.lag_s.half_width < result.lag_s.value);
    if (!result.delay_held) {
      result.delay_s = resolved(solution.estimate(first + 1));
      result.response_s =
          solution.estimate_of([](const std::vector<double>& values) { return values[first] + values[first + 1]; });
    } else {
      response_ = nearest;
      solution = fit.converge(response_, RotationFit::lag());
      const bool lag_holds = holds(solution);
      if (!lag_holds) {
        response_ = nearest;
        solution = fit.converge(response_, {});
      }
      result.lag_s = {response_.rise_s};
      if (lag_holds) result.lag_s = resolved({response_.rise_s, solution.estimate(first).half_width});
      result.delay_s = {response_.delay_s};
      result.response_s = {response_.rise_s + response_.delay_s, result.lag_s.half_width};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t from = axis * of_axis;
      result.effectiveness_rad_s2[axis] = solution.estimate(from);
      if (solution.told(from) && solution.told(from + 1)) {
        result.imbalance[axis] =
            solution.estimate_of([from](const std::vector<double>& values) { return values[from + 1] / values[from]; });
      }
      result.damping_1_s[axis] = solution.estimate(from + 2);
      result.gyroscopic[axis] = solution.estimate(from + 3);
      result.by_velocity_rad_s_m[axis] = solution.estimate(from + 4);
    }
    if (result.delay_held) return;
    RotorResponse each = response_;
    const BlockSolution two = fit.converge(each, RotationFit::rise_fall_and_delay());
    if (!two.told(first) || !two.told(first + 1)) return;
    if (!stands(two.values()[first], each.rise_s) || !stands(two.values()[first + 1], each.fall_s)) return;
    result.rise_s = resolved(two.estimate(first));
    result.fall_s = resolved(two.estimate(first + 1));
    result.fall_after_rise_s =
        two.estimate_of([](const std::vector<double>& values) { return values[first + 1] - values[first]; });
  }

  /// k of f_z = -A ((1 - k) sum s_linear + k sum s_square) - drag.
  double find_curve(Identification& result) const {
    const Fractions linear = rows_.flights().thrust_fractions(0, response_),
                    square = rows_.flights().thrust_fractions(1, response_);
    const BlockSolution solution = force_regression(2, 4, [&](std::size_t i, double* x) {
      x[0] = -InstrumentedFlights::sum(linear, i);
      x[1] = -InstrumentedFlights::sum(square, i);
      x[2] = -rows_.flights().velocity()[2][i];
      x[3] = -rows_.flights().squared_velocity()[2][i];
    });
    if (!solution.told(1)) return settings_.thrust_curve;
    result.thrust_curve =
        solution.estimate_of([](const std::vector<double>& values) { return values[1] / (values[0] + values[1]); });
    return std::clamp(result.thrust_curve.value, 0.0, 1.0);
  }

  /// Along z by the velocity where there is one: an accelerometer's offset of 0.1 m/s^2 would be 1 % of the thrust.
  const Series& force(std::size_t axis) const {
    const bool by_velocity = axis == 2 && !rows_.flights().kinematic_force()[axis].empty();
    return by_velocity ? rows_.flights().kinematic_force()[axis] : rows_.flights().specific_force()[axis];
  }

  /// The specific force along an axis by `fill(instant, regressors)`; instruments: the regressors and the force of past
  /// instants, and 1.
  template <class Fill>
  BlockSolution force_regression(std::size_t axis, std::size_t unknowns, const Fill& fill) const {
    const std::size_t instruments = InstrumentedFlights::shifts * (unknowns + 1) + 1;
    BlockRegression regression(unknowns, instruments, rows_.blocks());
    std::vector<double> x(unknowns), z(instruments);
    for (std::size_t place = 0; place < rows_.instants().size(); ++place) {
      const std::size_t i = rows_.instants()[place];
      for (std::size_t k = 0; k < InstrumentedFlights::shifts; ++k) {
        const std::size_t before = rows_.before(i, k);
        fill(before, &z[k * (unknowns + 1)]);
        z[k * (unknowns + 1) + unknowns] = force(axis)[before];
      }
      z.back() = 1;
      fill(i, x.data());
      regression.add(rows_.block(place), x.data(), force(axis)[i], z.data());
    }
    return regression.solve();
  }

  void find_forces(double curve, Identification& result) const {
    const Series& voltage = rows_.flights().voltage();
    for (const std::size_t i : rows_.instants()) result.mean_voltage_V += voltage.empty() ? 0 : voltage[i];
    result.mean_voltage_V /= static_cast<double>(rows_.instants().size());
    const double mean_V = result.mean_voltage_V;
    const bool has_voltage = !voltage.empty() && mean_V > 0;
    const Fractions s = rows_.flights().thrust_fractions(curve, response_);
    const auto by_thrust = [&](std::size_t i, double* x) {
      x[0] = -InstrumentedFlights::sum(s, i);
      if (has_voltage) x[1] = x[0] * (voltage[i] / mean_V - 1);
      return std::size_t(has_voltage ? 2 : 1);
    };
    const std::size_t of_thrust = has_voltage ? 2 : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Series& v = rows_.flights().velocity()[axis];
      const Series& square = rows_.flights().squared_velocity()[axis];
      const auto before_drag = [&](std::size_t i, double* x) -> std::size_t {
        if (axis == 2) return by_thrust(i, x);
        x[0] = 1;
        return 1;
      };
      const std::size_t first = axis == 2 ? of_thrust : 1;
      const BlockSolution both = force_regression(axis, first + 2, [&](std::size_t i, double* x) {
        const std::size_t from = before_drag(i, x);
        x[from] = -v[i];
        x[from + 1] = -square[i];
      });
      const BlockSolution alone = force_regression(axis, first + 1, [&](std::size_t i, double* x) {
        const std::size_t from = before_drag(i, x);
        x[from] = -square[i];
      });
      result.linear_drag_1_s[axis] = both.estimate(first);
      result.quadratic_drag_1_m[axis] = both.estimate(first + 1);
      result.drag_1_m[axis] = alone.estimate(first);
      if (axis < 2) continue;
      result.thrust_m_s2 = both.estimate(0);
      result.thrust_slope_m_s2 = force_regression(axis, first + 2, [&](std::size_t i, double* x) {
                                   const std::size_t from = before_drag(i, x);
                                   x[from] = 1;
                                   x[from + 1] = -v[i];
                                 }).estimate(0);
      if (has_voltage && both.told(0) && both.told(1)) {
        result.battery = both.estimate_of([](const std::vector<double>& values) { return values[1] / values[0]; });
      }
    }
  }

  void measure_excitation(Identification& result) const {
    const Fractions s = rows_.flights().thrust_fractions(0, {});
    const auto deviation = [this](const auto& value_of) {
      double mean = 0, squares = 0;
      for (const std::size_t i : rows_.instants()) mean += value_of(i) / static_cast<double>(rows_.instants().size());
      for (const std::size_t i : rows_.instants()) squares += (value_of(i) - mean) * (value_of(i) - mean);
      return std::sqrt(squares / static_cast<double>(rows_.instants().size()));
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.signed_sum_deviation[axis] = deviation([&](std::size_t i) { return rows_.signed_sum(s, axis, i); });
      result.speed_deviation_m_s[axis] = deviation([&](std::size_t i) { return rows_.flights().velocity()[axis][i]; });
    }
    result.collective_deviation = deviation([&](std::size_t i) { return InstrumentedFlights::sum(s, i); });
  }

  InstrumentedFlights rows_;
  IdentificationSettings settings_;
  RotorResponse response_;
};

}  // namespace detail

/// The vehicle of flights, rows of one period with the commands as they were given: in what a log's import shifted, the
/// shift is missing from `delay_s`. `signs`: axis_signs().
inline Identification identify(const RowSet& rows, const std::array<std::array<double, rotor_count>, 3>& signs,
                               const IdentificationSettings& settings = {}) {
  return detail::Identifier(rows, signs, settings).run();
}

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// What flights say of the vehicle that flew them: thrust per mass, torque per inertia, drag, damping, and the rotors' lag
// and delay, each with a 95 % interval. With s_i the thrust fractions behind lag and delay, sigma_i the signs of the
// allocation, body FRD:
//   w_a'  = B_a sum sigma_i s_i + C_a sum s_i - D_a w_a + G_a (w x w)_a          about each axis
//   f_z   = - A sum s_i (1 + E (V - V_mean) / V_mean) - d_z v_z - q_z |v_z| v_z   specific force
//   f_x,y = - d v - q |v| v + constant
// The series are smoothed (smoothed_flights.hpp). Instruments are the same series a window and more earlier: a gyro's
// noise goes through the controller into the commands of the same window, and makes least squares wrong by half in calm
// flights; it cannot go into the past. Lag and delay are found by Gauss and Newton with all three axes in one regression,
// each weighted by its residual. Intervals: block_regression.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/dynamics/allocation.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/smoothed_flights.hpp"

namespace pinnquad {

struct IdentificationSettings {
  double window_s = 0.16;         ///< of the smoothing: motion up to some 6 Hz counts
  double thrust_curve = 0;        ///< of thrust_fraction()
  bool fit_thrust_curve = false;  ///< finds it, in place of taking that one
};

/// An interval is infinite where the flights do not tell.
struct Identification {
  Estimate thrust_m_s2;                          ///< A: specific force of one rotor at command 1
  Estimate thrust_curve;                         ///< k of thrust_fraction(), where it was to be found
  Estimate battery;                              ///< E: relative change of the thrust over that of the voltage
  std::array<Estimate, 3> effectiveness_rad_s2;  ///< B: angular acceleration of one rotor at command 1
  std::array<Estimate, 3> imbalance;             ///< C / B: of all rotors together, over that of one; of roll and pitch
                                                 ///< the offset of the centre of gravity over the arm
  std::array<Estimate, 3> damping_1_s;           ///< D
  std::array<Estimate, 3> gyroscopic;            ///< G: (J_y - J_z) / J_x and so on
  std::array<Estimate, 3> linear_drag_1_s;       ///< d, beside q
  std::array<Estimate, 3> quadratic_drag_1_m;    ///< q, beside d
  std::array<Estimate, 3> drag_1_m;              ///< q of a vehicle without d
  Estimate lag_s;                                ///< time constant of the rotors
  Estimate delay_s;     ///< before it, filters of the sensors included; may be negative by half a row
  Estimate response_s;  ///< both together
  Estimate rise_s, fall_s, fall_after_rise_s;  ///< time constants of growing and falling thrust, and their difference
  bool delay_held = false;                     ///< lag and delay are not told apart: the delay is held at 0
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
  Identifier(const RowSet& rows, const std::array<std::array<double, rotor_count>, 3>& signs,
             const IdentificationSettings& settings)
      : flights_(rows, settings.window_s), signs_(signs), settings_(settings) {
    const std::size_t size = flights_.size();
    if (size == 0) return;
    const double step_s = flights_.step_s();
    first_shift_ = static_cast<std::size_t>(std::ceil(flights_.window_s() / step_s)) + 1;
    const std::size_t reach = first_shift_ + shifts - 1;
    for (std::size_t i = reach; i < size; ++i) {
      if (flights_.stretch(i - reach) == flights_.stretch(i)) used_.push_back(i);
    }
    const double blocks = std::clamp(static_cast<double>(used_.size()) * step_s / block_s, 3.0, most_blocks);
    blocks_ = static_cast<std::size_t>(blocks);
  }

  Identification run() {
    Identification result;
    result.duration_s = static_cast<double>(used_.size()) * flights_.step_s();
    result.blocks = blocks_;
    if (used_.size() < fewest_instants) return result;
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
  using Series = SmoothedFlights::Series;
  using Fractions = std::array<Series, rotor_count>;
  static constexpr std::size_t shifts = 4;  // instruments: this many past instants
  static constexpr double block_s = 3;      // long against rotors, controllers and gusts near hover
  static constexpr double most_blocks = 50;
  static constexpr std::size_t fewest_instants = 100;
  static constexpr std::size_t of_axis = 4;  // unknowns B, C, D, G
  static constexpr std::size_t axis_instruments = 6 * shifts + 1;

  std::size_t block_of(std::size_t place) const { return place * blocks_ / used_.size(); }

  static double sum(const Fractions& fractions, const std::array<double, rotor_count>& signs, std::size_t i) {
    double total = 0;
    for (std::size_t k = 0; k < rotor_count; ++k) total += signs[k] * fractions[k][i];
    return total;
  }
  static double sum(const Fractions& fractions, std::size_t i) { return sum(fractions, {1, 1, 1, 1}, i); }

  /// Slope of the fractions by a part of the response.
  template <class Moved>
  Fractions slope(double curve, const RotorResponse& at, double step, const Moved& moved) const {
    const auto ahead = moved(at, step), behind = moved(at, -step);
    Fractions result = flights_.thrust_fractions(curve, ahead);
    const Fractions less = flights_.thrust_fractions(curve, behind);
    for (std::size_t k = 0; k < rotor_count; ++k) {
      for (std::size_t i = 0; i < result[k].size(); ++i) result[k][i] = (result[k][i] - less[k][i]) / (2 * step);
    }
    return result;
  }

  /// How the response may be moved: one lag, or one for rising and one for falling thrust; the delay.
  enum class Response { lag, lag_and_delay, rise_fall_and_delay };

  /// One step of Gauss and Newton for the three axes at `response`; the unknowns of the response come last.
  BlockSolution rotation_step(double curve, const RotorResponse& response, Response kind,
                              const std::array<double, 3>& effectiveness, std::array<double, 3>& weights) const {
    const Fractions s = flights_.thrust_fractions(curve, response);
    std::vector<Fractions> slopes;
    constexpr double delay_step_s = 0.001;
    const double lag_step_s = 0.02 * response.rise_s;
    if (kind == Response::rise_fall_and_delay) {
      slopes.push_back(slope(curve, response, lag_step_s, [](RotorResponse r, double step) {
        r.rise_s += step;
        return r;
      }));
      slopes.push_back(slope(curve, response, lag_step_s, [](RotorResponse r, double step) {
        r.fall_s += step;
        return r;
      }));
    } else {
      slopes.push_back(slope(curve, response, lag_step_s, [](RotorResponse r, double step) {
        r.rise_s += step;
        r.fall_s += step;
        return r;
      }));
    }
    if (kind != Response::lag) {
      slopes.push_back(slope(curve, response, delay_step_s, [](RotorResponse r, double step) {
        r.delay_s += step;
        return r;
      }));
    }
    const std::vector<double> at = kind == Response::lag ? std::vector<double>{response.rise_s}
                                   : kind == Response::lag_and_delay
                                       ? std::vector<double>{response.rise_s, response.delay_s}
                                       : std::vector<double>{response.rise_s, response.fall_s, response.delay_s};
    BlockRegression regression(3 * of_axis + slopes.size(), 3 * axis_instruments, blocks_);
    std::vector<double> x(3 * of_axis + slopes.size()), z(3 * axis_instruments);
    for (std::size_t place = 0; place < used_.size(); ++place) {
      const std::size_t i = used_[place];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double weight = weights[axis];
        std::fill(x.begin(), x.end(), 0.0);
        std::fill(z.begin(), z.end(), 0.0);
        fill_axis(s, axis, i, &x[axis * of_axis]);
        double y = flights_.angular_acceleration()[axis][i];
        for (std::size_t k = 0; k < slopes.size(); ++k) {
          const double by = effectiveness[axis] * sum(slopes[k], signs_[axis], i);
          x[3 * of_axis + k] = by;
          y += by * at[k];
        }
        fill_instruments(s, axis, i, &z[axis * axis_instruments]);
        for (double& value : x) value *= weight;
        for (double& value : z) value *= weight;
        regression.add(block_of(place), x.data(), weight * y, z.data());
      }
    }
    BlockSolution solution = regression.solve();
    for (std::size_t axis = 0; axis < 3; ++axis) weights[axis] = 1 / axis_deviation(s, axis, solution);
    return solution;
  }

  void fill_axis(const Fractions& s, std::size_t axis, std::size_t i, double* x) const {
    x[0] = sum(s, signs_[axis], i);
    x[1] = sum(s, i);
    x[2] = -flights_.rates()[axis][i];
    x[3] = flights_.rate_products()[axis][i];
  }

  void fill_instruments(const Fractions& s, std::size_t axis, std::size_t i, double* z) const {
    constexpr std::array<std::size_t, 3> moved_by = {1, 0, 2};  // roll moves the vehicle along y
    for (std::size_t k = 0; k < shifts; ++k) {
      const std::size_t before = i - first_shift_ - k;
      *z++ = sum(s, signs_[axis], before);
      *z++ = sum(s, before);
      *z++ = flights_.rates()[axis][before];
      *z++ = flights_.rate_products()[axis][before];
      *z++ = flights_.angular_acceleration()[axis][before];
      *z++ = flights_.velocity()[moved_by[axis]][before];
    }
    *z = 1;
  }

  /// Root mean square of what the unknowns of an axis leave.
  double axis_deviation(const Fractions& s, std::size_t axis, const BlockSolution& solution) const {
    double squares = 0;
    std::array<double, of_axis> x{};
    for (const std::size_t i : used_) {
      fill_axis(s, axis, i, x.data());
      double left = flights_.angular_acceleration()[axis][i];
      for (std::size_t k = 0; k < of_axis; ++k) left -= x[k] * solution.values()[axis * of_axis + k];
      squares += left * left;
    }
    constexpr double least = 1e-6;  // rad/s^2: exact rows of a law leave nothing
    return std::max(least, std::sqrt(squares / static_cast<double>(used_.size())));
  }

  /// Gauss and Newton from `response`, which becomes the solution's.
  BlockSolution converge(double curve, RotorResponse& response, Response kind) const {
    constexpr int most_steps = 30;
    constexpr double close_s = 1e-6, shortest_s = 5e-4, longest_s = 0.4, longest_delay_s = 0.2;
    std::array<double, 3> effectiveness{}, weights = {1, 1, 1};
    BlockSolution solution;
    for (int step = 0; step < most_steps; ++step) {
      solution = rotation_step(curve, response, kind, effectiveness, weights);
      for (std::size_t axis = 0; axis < 3; ++axis) effectiveness[axis] = solution.values()[axis * of_axis];
      if (step == 0) continue;  // without an effectiveness there was no slope
      const auto towards = [&](double now, std::size_t unknown, double least, double most) {
        if (!solution.told(3 * of_axis + unknown)) return now;
        const double reach = 0.5 * std::abs(now) + 0.005;
        const double next = std::clamp(solution.values()[3 * of_axis + unknown], now - reach, now + reach);
        return std::clamp(next, least, most);
      };
      const RotorResponse before = response;
      response.rise_s = towards(before.rise_s, 0, shortest_s, longest_s);
      response.fall_s =
          kind == Response::rise_fall_and_delay ? towards(before.fall_s, 1, shortest_s, longest_s) : response.rise_s;
      if (kind == Response::lag_and_delay)
        response.delay_s = towards(before.delay_s, 1, -longest_delay_s, longest_delay_s);
      if (kind == Response::rise_fall_and_delay)
        response.delay_s = towards(before.delay_s, 2, -longest_delay_s, longest_delay_s);
      const double moved =
          std::max({std::abs(response.rise_s - before.rise_s), std::abs(response.fall_s - before.fall_s),
                    std::abs(response.delay_s - before.delay_s)});
      if (step > 2 && moved < close_s) break;
    }
    return solution;
  }

  void find_rotation(double curve, Identification& result) {
    constexpr double usual_lag_s = 0.03;
    constexpr std::size_t first = 3 * of_axis;
    response_ = {usual_lag_s, usual_lag_s, 0};
    BlockSolution solution = converge(curve, response_, Response::lag_and_delay);
    result.lag_s = solution.told(first) ? solution.estimate(first) : Estimate{};
    result.delay_held = !(result.lag_s.half_width < std::abs(result.lag_s.value)) || result.lag_s.value <= 0;
    if (!result.delay_held) {
      result.delay_s = solution.estimate(first + 1);
      result.response_s =
          solution.estimate_of([](const std::vector<double>& values) { return values[first] + values[first + 1]; });
    } else {
      response_ = {usual_lag_s, usual_lag_s, 0};
      solution = converge(curve, response_, Response::lag);
      if (solution.told(first)) result.lag_s.half_width = solution.estimate(first).half_width;
      result.lag_s.value = response_.rise_s;  // within bounds
      result.response_s = result.lag_s;
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
    }
    if (result.delay_held) return;
    RotorResponse each = response_;
    const BlockSolution two = converge(curve, each, Response::rise_fall_and_delay);
    if (!two.told(first) || !two.told(first + 1)) return;
    result.rise_s = two.estimate(first);
    result.fall_s = two.estimate(first + 1);
    result.fall_after_rise_s =
        two.estimate_of([](const std::vector<double>& values) { return values[first + 1] - values[first]; });
  }

  /// k of f_z = -A ((1 - k) sum s_linear + k sum s_square) - drag.
  double find_curve(Identification& result) const {
    const Fractions linear = flights_.thrust_fractions(0, response_), square = flights_.thrust_fractions(1, response_);
    const BlockSolution solution = force_regression(2, 4, [&](std::size_t i, double* x) {
      x[0] = -sum(linear, i);
      x[1] = -sum(square, i);
      x[2] = -flights_.velocity()[2][i];
      x[3] = -flights_.squared_velocity()[2][i];
    });
    if (!solution.told(1)) return settings_.thrust_curve;
    result.thrust_curve =
        solution.estimate_of([](const std::vector<double>& values) { return values[1] / (values[0] + values[1]); });
    return std::clamp(result.thrust_curve.value, 0.0, 1.0);
  }

  /// Along z by the velocity where there is one: an accelerometer's offset of 0.1 m/s^2 would be 1 % of the thrust.
  const Series& force(std::size_t axis) const {
    const bool by_velocity = axis == 2 && !flights_.kinematic_force()[axis].empty();
    return by_velocity ? flights_.kinematic_force()[axis] : flights_.specific_force()[axis];
  }

  /// The specific force along an axis by `fill(instant, regressors)`; instruments: the regressors and the force of past
  /// instants, and 1.
  template <class Fill>
  BlockSolution force_regression(std::size_t axis, std::size_t unknowns, const Fill& fill) const {
    const std::size_t instruments = shifts * (unknowns + 1) + 1;
    BlockRegression regression(unknowns, instruments, blocks_);
    std::vector<double> x(unknowns), z(instruments);
    for (std::size_t place = 0; place < used_.size(); ++place) {
      const std::size_t i = used_[place];
      for (std::size_t k = 0; k < shifts; ++k) {
        const std::size_t before = i - first_shift_ - k;
        fill(before, &z[k * (unknowns + 1)]);
        z[k * (unknowns + 1) + unknowns] = force(axis)[before];
      }
      z.back() = 1;
      fill(i, x.data());
      regression.add(block_of(place), x.data(), force(axis)[i], z.data());
    }
    return regression.solve();
  }

  void find_forces(double curve, Identification& result) const {
    const Series& voltage = flights_.voltage();
    for (const std::size_t i : used_) result.mean_voltage_V += voltage.empty() ? 0 : voltage[i];
    result.mean_voltage_V /= static_cast<double>(used_.size());
    const double mean_V = result.mean_voltage_V;
    const bool has_voltage = !voltage.empty() && mean_V > 0;
    const Fractions s = flights_.thrust_fractions(curve, response_);
    const auto by_thrust = [&](std::size_t i, double* x) {
      x[0] = -sum(s, i);
      if (has_voltage) x[1] = x[0] * (voltage[i] / mean_V - 1);
      return std::size_t(has_voltage ? 2 : 1);
    };
    const std::size_t of_thrust = has_voltage ? 2 : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Series& v = flights_.velocity()[axis];
      const Series& square = flights_.squared_velocity()[axis];
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
      if (has_voltage && both.told(0) && both.told(1)) {
        result.battery = both.estimate_of([](const std::vector<double>& values) { return values[1] / values[0]; });
      }
    }
  }

  void measure_excitation(Identification& result) const {
    const Fractions s = flights_.thrust_fractions(0, {});
    const auto deviation = [this](const auto& value_of) {
      double mean = 0, squares = 0;
      for (const std::size_t i : used_) mean += value_of(i) / static_cast<double>(used_.size());
      for (const std::size_t i : used_) squares += (value_of(i) - mean) * (value_of(i) - mean);
      return std::sqrt(squares / static_cast<double>(used_.size()));
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result.signed_sum_deviation[axis] = deviation([&](std::size_t i) { return sum(s, signs_[axis], i); });
      result.speed_deviation_m_s[axis] = deviation([&](std::size_t i) { return flights_.velocity()[axis][i]; });
    }
    result.collective_deviation = deviation([&](std::size_t i) { return sum(s, i); });
  }

  SmoothedFlights flights_;
  std::array<std::array<double, rotor_count>, 3> signs_;
  IdentificationSettings settings_;
  std::size_t first_shift_ = 0, blocks_ = 0;
  std::vector<std::size_t> used_;
  RotorResponse response_;
};

}  // namespace detail

/// The vehicle of flights, rows of one period with the commands as they were given: in what a log's import shifted, the
/// shift is missing from `delay_s`. `signs`: allocation_signs() of roll, pitch and yaw.
inline Identification identify(const RowSet& rows, const std::array<std::array<double, rotor_count>, 3>& signs,
                               const IdentificationSettings& settings = {}) {
  return detail::Identifier(rows, signs, settings).run();
}

}  // namespace pinnquad

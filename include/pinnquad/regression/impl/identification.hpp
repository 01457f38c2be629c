// SPDX-License-Identifier: MIT
// Bodies of identification.hpp.
#pragma once

#include "pinnquad/regression/identification.hpp"
#include "pinnquad/regression/impl/rotation_fit.hpp"

namespace pinnquad {

namespace detail {

/// The mean of those that are told, each by its interval; the force without a velocity, which drag bends too, counts
/// only where no turning tells the curve. Where they are further apart than their intervals say, the interval grows.
PINNQUAD_BODY Estimate agreed_curve(const std::array<Estimate, 4>& by, bool has_velocity) {
  constexpr double loosest = 0.5;
  double counts = 0, sum = 0, apart = 0;
  const auto takes = [&](std::size_t i) {
    return by[i].half_width <= loosest && (i < 3 || has_velocity || !(counts > 0));
  };
  for (std::size_t i = 0; i < by.size(); ++i) {
    if (!takes(i)) continue;
    const double count = 1 / (by[i].half_width * by[i].half_width + 1e-6);
    counts += count;
    sum += count * by[i].value;
  }
  if (!(counts > 0)) return {};
  for (std::size_t i = 0; i < by.size(); ++i) {
    if (!takes(i)) continue;
    const double off = std::abs(by[i].value - sum / counts) - by[i].half_width;
    apart = std::max(apart, off);
  }
  return {sum / counts, std::hypot(1 / std::sqrt(counts), apart)};
}

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
      result.curve_by = curves();
      result.thrust_curve = agreed_curve(result.curve_by, !rows_.flights().kinematic_force()[2].empty());
      if (settings_.scope == IdentificationSettings::Scope::thrust_curve) return result;
      if (const auto told = told_curve(result.thrust_curve)) {
        curve = *told;
        find_rotation(curve, result);
      }
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
    if (result.delay_held || settings_.scope != IdentificationSettings::Scope::all) return;
    RotorResponse each = response_;
    const BlockSolution two = fit.converge(each, RotationFit::rise_fall_and_delay());
    if (!two.told(first) || !two.told(first + 1)) return;
    if (!stands(two.values()[first], each.rise_s) || !stands(two.values()[first + 1], each.fall_s)) return;
    result.rise_s = resolved(two.estimate(first));
    result.fall_s = resolved(two.estimate(first + 1));
    result.fall_after_rise_s =
        two.estimate_of([](const std::vector<double>& values) { return values[first + 1] - values[first]; });
  }

  /// k by each motion: w_a' = B_a ((1 - k) sum sigma_i s_linear + k sum sigma_i s_square) + ..., and
  /// f_z = -A ((1 - k) sum s_linear + k sum s_square) - drag.
  std::array<Estimate, 4> curves() const {
    const SmoothedFlights& flights = rows_.flights();
    const Fractions linear = flights.thrust_fractions(0, response_), square = flights.thrust_fractions(1, response_);
    const auto curve_of = [](const BlockSolution& solution) {
      if (!solution.told(0) || !solution.told(1)) return Estimate{};
      return solution.estimate_of([](const std::vector<double>& v) { return v[1] / (v[0] + v[1]); });
    };
    std::array<Estimate, 4> found;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      found[axis] = curve_of(regression_of(flights.angular_acceleration()[axis], 6, [&](std::size_t i, double* x) {
        x[0] = rows_.signed_sum(linear, axis, i);
        x[1] = rows_.signed_sum(square, axis, i);
        x[2] = InstrumentedFlights::sum(linear, i);
        x[3] = flights.rates()[axis][i];
        x[4] = flights.rate_products()[axis][i];
        x[5] = flights.velocity()[axis == 1 ? 0 : 1][i];
      }));
    }
    found[3] = curve_of(regression_of(force(2), 4, [&](std::size_t i, double* x) {
      x[0] = -InstrumentedFlights::sum(linear, i);
      x[1] = -InstrumentedFlights::sum(square, i);
      x[2] = -flights.velocity()[2][i];
      x[3] = -flights.squared_velocity()[2][i];
    }));
    return found;
  }

  /// Along z by the velocity where there is one: an accelerometer's offset of 0.1 m/s^2 would be 1 % of the thrust.
  const Series& force(std::size_t axis) const {
    const bool by_velocity = axis == 2 && !rows_.flights().kinematic_force()[axis].empty();
    return by_velocity ? rows_.flights().kinematic_force()[axis] : rows_.flights().specific_force()[axis];
  }

  /// A series by `fill(instant, regressors)`; instruments: the regressors and the series of past instants, and 1.
  template <class Fill>
  BlockSolution regression_of(const Series& y, std::size_t unknowns, const Fill& fill) const {
    const std::size_t instruments = InstrumentedFlights::shifts * (unknowns + 1) + 1;
    BlockRegression regression(unknowns, instruments, rows_.blocks());
    std::vector<double> x(unknowns), z(instruments);
    for (std::size_t place = 0; place < rows_.instants().size(); ++place) {
      const std::size_t i = rows_.instants()[place];
      for (std::size_t k = 0; k < InstrumentedFlights::shifts; ++k) {
        const std::size_t before = rows_.before(i, k);
        fill(before, &z[k * (unknowns + 1)]);
        z[k * (unknowns + 1) + unknowns] = y[before];
      }
      z.back() = 1;
      fill(i, x.data());
      regression.add(rows_.block(place), x.data(), y[i], z.data());
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
      const BlockSolution both = regression_of(force(axis), first + 2, [&](std::size_t i, double* x) {
        const std::size_t from = before_drag(i, x);
        x[from] = -v[i];
        x[from + 1] = -square[i];
      });
      const BlockSolution alone = regression_of(force(axis), first + 1, [&](std::size_t i, double* x) {
        const std::size_t from = before_drag(i, x);
        x[from] = -square[i];
      });
      result.linear_drag_1_s[axis] = both.estimate(first);
      result.quadratic_drag_1_m[axis] = both.estimate(first + 1);
      result.drag_1_m[axis] = alone.estimate(first);
      if (axis < 2) continue;
      result.thrust_m_s2 = both.estimate(0);
      result.thrust_slope_m_s2 = regression_of(force(axis), first + 2, [&](std::size_t i, double* x) {
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

PINNQUAD_BODY Identification identify(const RowSet& rows, const std::array<std::array<double, rotor_count>, 3>& signs,
                                      const IdentificationSettings& settings) {
  return detail::Identifier(rows, signs, settings).run();
}

}  // namespace pinnquad

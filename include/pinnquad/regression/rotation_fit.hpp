// SPDX-License-Identifier: MIT
// How a vehicle turns by its commands: effectiveness, damping, imbalance and gyroscopic term of each axis, and the
// response of the rotors that all three share, by Gauss and Newton. The law: identification.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "pinnquad/core/types.hpp"
#include "pinnquad/regression/block_regression.hpp"
#include "pinnquad/regression/smoothed_flights.hpp"

namespace pinnquad::detail {

/// Instants of flights that have instruments, in blocks of time. Instruments of an instant are of a window earlier and
/// more, `shifts` instants of them.
class InstrumentedFlights {
 public:
  using Series = SmoothedFlights::Series;
  using Fractions = std::array<Series, rotor_count>;
  using Signs = std::array<std::array<double, rotor_count>, 3>;
  static constexpr std::size_t shifts = 4;

  InstrumentedFlights(const RowSet& rows, const Signs& signs, double window_s)
      : flights_(rows, window_s), signs_(signs) {
    constexpr double block_s = 3;  // long against rotors, controllers and gusts
    constexpr double fewest_blocks = 3, most_blocks = 50;
    if (flights_.size() == 0) return;
    const double step_s = flights_.step_s();
    first_shift_ = static_cast<std::size_t>(std::ceil(flights_.window_s() / step_s)) + 1;
    const std::size_t reach = first_shift_ + shifts - 1;
    for (std::size_t i = reach; i < flights_.size(); ++i) {
      if (flights_.stretch(i - reach) == flights_.stretch(i)) instants_.push_back(i);
    }
    blocks_ = static_cast<std::size_t>(std::clamp(duration_s() / block_s, fewest_blocks, most_blocks));
  }

  const SmoothedFlights& flights() const noexcept { return flights_; }
  const std::vector<std::size_t>& instants() const noexcept { return instants_; }
  std::size_t blocks() const noexcept { return blocks_; }
  double duration_s() const noexcept { return static_cast<double>(instants_.size()) * flights_.step_s(); }
  /// The block of `instants()[place]`.
  std::size_t block(std::size_t place) const { return place * blocks_ / instants_.size(); }
  /// The instant of an instrument.
  std::size_t before(std::size_t instant, std::size_t shift) const { return instant - first_shift_ - shift; }

  /// Of all rotors, and signed about an axis.
  static double sum(const Fractions& s, std::size_t i) { return s[0][i] + s[1][i] + s[2][i] + s[3][i]; }
  double signed_sum(const Fractions& s, std::size_t axis, std::size_t i) const {
    double total = 0;
    for (std::size_t k = 0; k < rotor_count; ++k) total += signs_[axis][k] * s[k][i];
    return total;
  }

 private:
  SmoothedFlights flights_;
  Signs signs_;
  std::size_t first_shift_ = 0, blocks_ = 0;
  std::vector<std::size_t> instants_;
};

/// Unknowns: B, C, D, G, F of roll, of pitch, of yaw; then the free parts of the rotors' response.
class RotationFit {
 public:
  using Fractions = InstrumentedFlights::Fractions;
  static constexpr std::size_t of_axis = 5;
  static constexpr std::size_t of_response = 3 * of_axis;  ///< the first unknown of the response

  /// Numbers of the response that move together; each part is an unknown.
  using Part = std::vector<double RotorResponse::*>;
  static std::vector<Part> lag() { return {{&RotorResponse::rise_s, &RotorResponse::fall_s}}; }
  static std::vector<Part> lag_and_delay() {
    return {{&RotorResponse::rise_s, &RotorResponse::fall_s}, {&RotorResponse::delay_s}};
  }
  static std::vector<Part> rise_fall_and_delay() {
    return {{&RotorResponse::rise_s}, {&RotorResponse::fall_s}, {&RotorResponse::delay_s}};
  }

  static constexpr double shortest_s = 5e-4, longest_s = 0.4, longest_delay_s = 0.3;  ///< a response is within

  RotationFit(const InstrumentedFlights& rows, double curve) : rows_(rows), curve_(curve) {}

  /// Of a grid the response under which least squares leave least of roll, pitch and yaw: where to begin. The noise
  /// that comes back through the controller is in it.
  RotorResponse nearest() const {
    constexpr std::array<double, 4> lags_s = {0.005, 0.03, 0.06, 0.1};
    constexpr double first_delay_s = -0.1, step_s = 0.02;
    constexpr int delays = 16;
    RotorResponse best{lags_s[1], lags_s[1], 0};
    double least = std::numeric_limits<double>::infinity();
    for (const double lag_s : lags_s) {
      for (int k = 0; k < delays; ++k) {
        const RotorResponse at{lag_s, lag_s, first_delay_s + step_s * k};
        const Fractions s = rows_.flights().thrust_fractions(curve_, at);
        double left = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          BlockRegression regression(of_axis, 0, 1);
          std::array<double, of_axis> x{};
          for (const std::size_t i : rows_.instants()) {
            fill_axis(s, axis, i, x.data());
            regression.add(0, x.data(), rows_.flights().angular_acceleration()[axis][i]);
          }
          left += std::log(deviation(s, axis, regression.solve(false), 0));
        }
        if (!(left < least)) continue;
        least = left;
        best = at;
      }
    }
    return best;
  }

  /// Gauss and Newton from `response`, which becomes the solution's. No parts: the response stays.
  BlockSolution converge(RotorResponse& response, const std::vector<Part>& parts) const {
    constexpr int most_steps = 30, least_steps = 4;
    constexpr double close_s = 1e-6;
    std::array<double, 3> effectiveness{}, weights = {1, 1, 1};
    for (int step = 0; step < most_steps; ++step) {
      const Fractions s = rows_.flights().thrust_fractions(curve_, response);
      const BlockSolution found = linearized(s, response, parts, effectiveness, weights).solve(false);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        effectiveness[axis] = found.values()[axis * of_axis];
        weights[axis] = 1 / deviation(s, axis, found, axis * of_axis);
      }
      if (step == 0) continue;  // without an effectiveness there was no slope
      double moved = 0;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        if (!found.told(of_response + k)) continue;
        const double now = response.*parts[k].front(), reach = 0.5 * std::abs(now) + 0.005;
        const double next =
            within_bounds(std::clamp(found.values()[of_response + k], now - reach, now + reach), parts[k]);
        for (double RotorResponse::*const number : parts[k]) response.*number = next;
        moved = std::max(moved, std::abs(next - now));
      }
      if (step >= least_steps && moved < close_s) break;
    }
    const Fractions s = rows_.flights().thrust_fractions(curve_, response);
    return linearized(s, response, parts, effectiveness, weights).solve();
  }

 private:
  static constexpr std::size_t shifts = InstrumentedFlights::shifts;
  static constexpr std::size_t instruments = 6 * shifts + 1;       // of an axis
  static constexpr std::array<std::size_t, 3> across = {1, 0, 1};  // the velocity that turns the vehicle about an axis

  static double within_bounds(double value_s, const Part& part) {
    if (part.front() == &RotorResponse::delay_s) return std::clamp(value_s, -longest_delay_s, longest_delay_s);
    return std::clamp(value_s, shortest_s, longest_s);
  }

  /// Slope of the fractions by a part of the response.
  Fractions slope(const RotorResponse& at, const Part& part) const {
    constexpr double delay_step_s = 0.001, lag_step = 0.02;
    const double step_s = part.front() == &RotorResponse::delay_s ? delay_step_s : lag_step * at.*part.front();
    RotorResponse ahead = at, behind = at;
    for (double RotorResponse::*const number : part) {
      ahead.*number += step_s;
      behind.*number -= step_s;
    }
    Fractions result = rows_.flights().thrust_fractions(curve_, ahead);
    const Fractions less = rows_.flights().thrust_fractions(curve_, behind);
    for (std::size_t k = 0; k < rotor_count; ++k) {
      for (std::size_t i = 0; i < result[k].size(); ++i) result[k][i] = (result[k][i] - less[k][i]) / (2 * step_s);
    }
    return result;
  }

  /// The three axes, linear about `response`, each row by its axis' weight; `s`: fractions under it.
  BlockRegression linearized(const Fractions& s, const RotorResponse& response, const std::vector<Part>& parts,
                             const std::array<double, 3>& effectiveness, const std::array<double, 3>& weights) const {
    std::vector<Fractions> slopes;
    slopes.reserve(parts.size());
    for (const Part& part : parts) slopes.push_back(slope(response, part));
    BlockRegression regression(of_response + parts.size(), 3 * instruments, rows_.blocks());
    std::vector<double> x(of_response + parts.size()), z(3 * instruments);
    for (std::size_t place = 0; place < rows_.instants().size(); ++place) {
      const std::size_t i = rows_.instants()[place];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill(x.begin(), x.end(), 0.0);
        std::fill(z.begin(), z.end(), 0.0);
        fill_axis(s, axis, i, &x[axis * of_axis]);
        fill_instruments(s, axis, i, &z[axis * instruments]);
        double y = rows_.flights().angular_acceleration()[axis][i];
        for (std::size_t k = 0; k < parts.size(); ++k) {
          x[of_response + k] = effectiveness[axis] * rows_.signed_sum(slopes[k], axis, i);
          y += x[of_response + k] * response.*parts[k].front();
        }
        for (double& value : x) value *= weights[axis];
        for (double& value : z) value *= weights[axis];
        regression.add(rows_.block(place), x.data(), weights[axis] * y, z.data());
      }
    }
    return regression;
  }

  void fill_axis(const Fractions& s, std::size_t axis, std::size_t i, double* x) const {
    x[0] = rows_.signed_sum(s, axis, i);
    x[1] = InstrumentedFlights::sum(s, i);
    x[2] = -rows_.flights().rates()[axis][i];
    x[3] = rows_.flights().rate_products()[axis][i];
    x[4] = rows_.flights().velocity()[across[axis]][i];
  }

  void fill_instruments(const Fractions& s, std::size_t axis, std::size_t i, double* z) const {
    const SmoothedFlights& flights = rows_.flights();
    for (std::size_t k = 0; k < shifts; ++k) {
      const std::size_t before = rows_.before(i, k);
      *z++ = rows_.signed_sum(s, axis, before);
      *z++ = InstrumentedFlights::sum(s, before);
      *z++ = flights.rates()[axis][before];
      *z++ = flights.rate_products()[axis][before];
      *z++ = flights.angular_acceleration()[axis][before];
      *z++ = flights.velocity()[across[axis]][before];
    }
    *z = 1;
  }

  /// Root mean square of what the unknowns of an axis, from the `first` on, leave, rad/s^2.
  double deviation(const Fractions& s, std::size_t axis, const BlockSolution& solution, std::size_t first) const {
    constexpr double least = 1e-6;  // exact rows of a law leave nothing
    double squares = 0;
    std::array<double, of_axis> x{};
    for (const std::size_t i : rows_.instants()) {
      fill_axis(s, axis, i, x.data());
      double left = rows_.flights().angular_acceleration()[axis][i];
      for (std::size_t k = 0; k < of_axis; ++k) left -= x[k] * solution.values()[first + k];
      squares += left * left;
    }
    return std::max(least, std::sqrt(squares / static_cast<double>(rows_.instants().size())));
  }

  const InstrumentedFlights& rows_;
  double curve_;
};

}  // namespace pinnquad::detail

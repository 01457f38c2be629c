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

#include "pinnquad/core/body.hpp"
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

  InstrumentedFlights(const RowSet& rows, const Signs& signs, double window_s);

  const SmoothedFlights& flights() const noexcept { return flights_; }
  const std::vector<std::size_t>& instants() const noexcept { return instants_; }
  std::size_t blocks() const noexcept { return blocks_; }
  double duration_s() const noexcept { return static_cast<double>(instants_.size()) * flights_.step_s(); }
  /// The block of `instants()[place]`.
  std::size_t block(std::size_t place) const { return place * blocks_ / instants_.size(); }
  /// The instant of an instrument.
  std::size_t before(std::size_t instant, std::size_t shift) const { return instant - first_shift_ - shift; }

  /// Sum over all rotors, and signed about an axis.
  static double sum(const Fractions& s, std::size_t i) { return s[0][i] + s[1][i] + s[2][i] + s[3][i]; }
  double signed_sum(const Fractions& s, std::size_t axis, std::size_t i) const;

 private:
  SmoothedFlights flights_;
  Signs signs_;
  std::size_t first_shift_ = 0, blocks_ = 0;
  std::vector<std::size_t> instants_;
};

/// Unknowns: B, C, D, G, F of roll, of pitch, of yaw; then the free parts of the rotors' response.
class RotationFit {
 public:
  using Series = InstrumentedFlights::Series;
  using Fractions = InstrumentedFlights::Fractions;
  static constexpr std::size_t of_axis = 5;
  static constexpr std::size_t of_response = 3 * of_axis;  ///< the first unknown of the response

  /// Numbers of the response that move together; each part is an unknown.
  using Part = std::vector<double RotorResponse::*>;
  static std::vector<Part> lag() { return {{&RotorResponse::rise_s, &RotorResponse::fall_s}}; }
  static std::vector<Part> lag_and_delay();
  static std::vector<Part> rise_fall_and_delay();

  static constexpr double shortest_s = 5e-4, longest_s = 0.4, longest_delay_s = 0.3;  ///< a response is within

  RotationFit(const InstrumentedFlights& rows, double curve);

  /// The response of a grid under which least squares leave least of roll, pitch and yaw: where to begin. The noise
  /// that comes back through the controller is in it.
  RotorResponse nearest() const;

  /// Gauss and Newton from `response`, which becomes the solution's. No parts: the response stays.
  BlockSolution converge(RotorResponse& response, const std::vector<Part>& parts) const;

 private:
  static constexpr std::size_t shifts = InstrumentedFlights::shifts;
  static constexpr std::size_t instruments = 6 * shifts + 1;       // of an axis
  static constexpr std::array<std::size_t, 3> across = {1, 0, 1};  // the velocity that turns the vehicle about an axis

  static double within_bounds(double value_s, const Part& part);

  using Wanted = SmoothedFlights::Wanted;

  /// Slope of the fractions by a part of the response; `wanted`: under its delay.
  Fractions slope(const RotorResponse& at, const Part& part, const Wanted& wanted) const;

  /// Sums of the fractions at each instant: signed about each axis, and of all rotors.
  struct Turning {
    std::array<Series, 3> about;
    Series sum;
  };
  Turning turning_of(const Fractions& s) const;

  /// The three axes, linear about `response`, each row by its axis' weight; `turning`: under it.
  BlockRegression linearized(const Turning& turning, const Wanted& wanted, const RotorResponse& response,
                             const std::vector<Part>& parts, const std::array<double, 3>& effectiveness,
                             const std::array<double, 3>& weights) const;

  void fill_axis(const Turning& turning, std::size_t axis, std::size_t i, double* x) const;

  /// Root mean square of what is left of an axis, rad/s^2, of this sum of squares.
  double root_mean_square(double squares) const;

  /// Sums of products of the unknowns of an axis, and of what they make.
  using Products = Eigen::Matrix<double, static_cast<int>(of_axis) + 1, static_cast<int>(of_axis) + 1>;
  Products products_of(const Turning& turning, std::size_t axis) const;

  /// The same of what least squares leave; `any`: products_of() an axis under any response.
  double left_by_least_squares(const Turning& turning, std::size_t axis, const Products& any) const;

  /// The same of what the unknowns of an axis, from the `first` on, leave.
  double deviation(const Turning& turning, std::size_t axis, const BlockSolution& solution, std::size_t first) const;

  const InstrumentedFlights& rows_;
  double curve_;
  /// Motion about an axis at an instant; no response is in it.
  struct AxisMotion {
    double rate, rate_product, across, acceleration;
  };
  std::array<std::vector<AxisMotion>, 3> motion_;
};

}  // namespace pinnquad::detail

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/rotation_fit.hpp"
#endif

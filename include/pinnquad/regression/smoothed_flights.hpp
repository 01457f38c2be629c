// SPDX-License-Identifier: MIT
// Flights as smoothed series at instants, for regressions of motion on commands. A series is its mean over the time
// from each row to the next, of a cubic through four rows; a derivative is the difference of the two rows over that
// time, so that no noisy column is differentiated and the law between the two holds as it stands, however coarse the
// rows are. All are weighted alike over a window around the instant, by 1 + cos(2 pi t / window): noise of higher
// frequencies is left out, and with it most of what a gyro's noise does to the commands through the controller.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/lanes.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/dynamics/actuator.hpp"
#include "pinnquad/features/motion_parts.hpp"

namespace pinnquad::detail {

/// From command to thrust: u(t - delay) makes the thrust fraction that is wanted, which the rotor follows with a
/// first-order lag.
struct RotorResponse {
  double rise_s = 0, fall_s = 0;  ///< time constants
  double delay_s = 0;             ///< may be negative: the commands' clock is late
};

/// Intervals between rows in half a window: four at least.
std::size_t half_window(double window_s, double period_s);

/// Weights of the intervals in a window of so many on each side, sum 1.
std::vector<double> window_weights(std::size_t half);

/// Rows i - 1 to i + 2, the ends repeated.
template <class Value>
std::array<Value, 4> rows_around(const std::vector<Value>& u, std::size_t i) noexcept {
  const std::size_t last = u.size() - 1;
  return {u[i > 0 ? i - 1 : 0], u[i], u[std::min(i + 1, last)], u[std::min(i + 2, last)]};
}

/// Means from each row to the next, of a cubic through four rows.
std::vector<double> means_between_rows(const std::vector<double>& u);

/// Series at instants; all of one length.
class SmoothedFlights {
 public:
  using Series = std::vector<double>;
  using Triple = std::array<Series, 3>;
  static constexpr double settling_s = 0.3;  ///< at the begin of each stretch: the rotors' first state is not known

  /// `window_s`: at least eight rows. Stretches without a gap of fewer rows than settling and window are left out.
  /// Rows of one period, see sample_period_s(); no instants without one.
  SmoothedFlights(const RowSet& rows, double window_s);

  std::size_t size() const noexcept { return stretch_.size(); }
  double period_s() const noexcept { return period_s_; }
  double window_s() const noexcept { return 2 * static_cast<double>(half_) * period_s_; }
  double step_s() const noexcept { return static_cast<double>(stride_) * period_s_; }
  /// Seconds of flight that the instants stand for.
  double duration_s() const noexcept { return static_cast<double>(size()) * step_s(); }

  /// The stretch without a gap in which an instant lies.
  std::size_t stretch(std::size_t instant) const { return stretch_[instant]; }

  const Triple& rates() const noexcept { return rates_; }                       ///< rad/s
  const Triple& angular_acceleration() const noexcept { return derivatives_; }  ///< of the rates, rad/s^2
  const Triple& rate_products() const noexcept { return products_; }            ///< w_y w_z, w_z w_x, w_x w_y
  const Triple& specific_force() const noexcept { return forces_; }             ///< m/s^2
  /// The same by the derivative of the velocity and by gravity: no accelerometer, and none of its offset, is in it.
  /// Empty where no row has a velocity.
  const Triple& kinematic_force() const noexcept { return kinematic_forces_; }
  const Triple& velocity() const noexcept { return velocities_; }       ///< body, m/s
  const Triple& squared_velocity() const noexcept { return squares_; }  ///< |v_i| v_i
  /// The column `battery_voltage`; empty unless all flights have it.
  const Series& voltage() const noexcept { return voltage_; }

  /// Thrust fractions that commands of this curve (thrust_fraction()) ask for, of all rotors at once: at the begin of
  /// each stretch, then in the middle of each of the rotors' steps.
  class Wanted;
  Wanted wanted(double curve, double delay_s) const;
  /// The smoothed fractions of rotors that follow; the delay is in `wanted`.
  std::array<Series, rotor_count> followed(const Wanted& wanted, const RotorResponse& response) const;
  std::array<Series, rotor_count> thrust_fractions(double curve, const RotorResponse& response) const;

 private:
  /// A number of each rotor, and of none in the lanes that are left.
  using AllRotors = Lanes<double, std::max(static_cast<int>(rotor_count), native_lanes<double>)>;

  /// Steps of the rotors from row to row.
  std::size_t steps_per_row() const noexcept;

  struct Stretch {
    std::vector<AllRotors> commands;
    std::size_t first = 0;  ///< row of the first instant
    std::size_t instants = 0;
  };

  /// At a row with its fraction, on a cubic through four rows (Catmull and Rom).
  static AllRotors at_row(const std::vector<AllRotors>& u, double row) noexcept;
  Series differences(const Series& u) const;

  /// Calls take(weighted sum) of each instant.
  template <class Value, class Take>
  void smooth(const std::vector<Value>& intervals, std::size_t instants, std::size_t first, const Take& take) const {
    for (std::size_t i = 0; i < instants; ++i) {
      const Value* const from = &intervals[first + i * stride_ - half_];
      Value sum(0);
      for (std::size_t k = 0; k < weights_.size(); ++k) sum += Value(weights_[k]) * from[k];
      take(sum);
    }
  }

  void take(const FlightRows& piece);

  void take_stretch(const Flight& flight, const IndexRange& rows);

  double period_s_ = 0;
  std::size_t half_ = 0, stride_ = 1;
  Series weights_;
  std::vector<Stretch> stretches_;
  std::vector<std::size_t> stretch_;
  Triple rates_, derivatives_, products_, forces_, kinematic_forces_, velocities_, squares_;
  Series voltage_;
  bool has_voltage_ = true;
};

class SmoothedFlights::Wanted {
  friend class SmoothedFlights;
  std::vector<std::vector<AllRotors>> stretches_;
};

}  // namespace pinnquad::detail

#ifndef PINNQUAD_COMPILED
#include "pinnquad/regression/impl/smoothed_flights.hpp"
#endif

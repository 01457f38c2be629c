// SPDX-License-Identifier: MIT
// Recorded flights: rows in time order with extra columns, many flights as one dataset, and the hash of their content.
// Exported headers hold the hash: it says on which data a model was trained. CSV files and the hash take the names and
// the order of a row's 21 numbers from here.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/core/types.hpp"
#include "pinnquad/io/file_error.hpp"

namespace pinnquad {

inline constexpr std::size_t sample_value_count = 21;

/// One row of a recorded flight: the motion at one instant and the commands that cause it.
/// Frames: body is FRD, the world NED; attitude is Euler ZYX, body to world. docs/train.md has the same as columns of a
/// CSV.
struct Sample {
  using Values = std::array<double, sample_value_count>;  ///< its numbers in the order of `sample_field_names`

  double time_s = 0;  ///< strictly increasing from row to row; any start
  /// Derivative of the body-frame velocity, FRD: v_dot_B = R^T a_world - omega x v_B (Eq. (1)).
  Vector3<double> linear_acceleration_m_s2 = Vector3<double>::Zero();
  Vector3<double> angular_acceleration_rad_s2 = Vector3<double>::Zero();  ///< body, FRD
  Vector3<double> velocity_m_s = Vector3<double>::Zero();                 ///< relative to the ground, in body FRD
  Vector3<double> body_rates_rad_s = Vector3<double>::Zero();             ///< p, q, r
  double roll_rad = 0;
  double pitch_rad = 0;
  double yaw_rad = 0;
  double altitude_m = 0;  ///< of the vehicle's centre above the ground below it, positive up
  /// u_i, 0..1, as given to the motor at this instant, before its lag: (n_i / n_max)^2, which is thrust over the
  /// greatest thrust, unless the airframe's rotors have a curve (dynamics/actuator.hpp).
  /// Front right, rear left, front left, rear right: the order of Eq. (2).
  Commands<double> commands{};
};

/// Column names of a recorded flight, in the order of `to_values`.
inline constexpr std::array<std::string_view, sample_value_count> sample_field_names = {
    // clang-format off
    "t",
    "vdot_bx", "vdot_by", "vdot_bz",
    "wdot_x", "wdot_y", "wdot_z",
    "v_bx", "v_by", "v_bz",
    "w_x", "w_y", "w_z",
    "roll", "pitch", "yaw",
    "altitude",
    "u1", "u2", "u3", "u4"};
// clang-format on

/// The sample as 21 numbers, ordered as `sample_field_names`.
Sample::Values to_values(const Sample& sample);

/// The inverse of `to_values`.
Sample to_sample(const Sample::Values& values);

/// A measurement besides the numbers of a Sample: battery voltage, rotor speed, anything with a name and a unit.
struct ColumnName {
  std::string name;  ///< "battery_voltage"
  std::string unit;  ///< "V"
};

/// Its values, one per row.
struct ExtraColumn : ColumnName {
  std::vector<double> values;
};

/// Rows of one flight on one clock, time strictly increasing (CSV files and Dataset insist on it), and its extra
/// columns.
class Flight {
 public:
  std::string name;        ///< by which a dataset, a message or a report means this flight
  std::string trajectory;  ///< a split by trajectory parts no flights of one trajectory. May be empty
  double weight = 1;       ///< how often its rows are seen in training, relative to those of other flights

  Flight() = default;
  explicit Flight(std::size_t rows) : samples_(rows) {}
  Flight(std::initializer_list<Sample> rows) : samples_(rows) {}

  std::size_t size() const noexcept { return samples_.size(); }
  bool empty() const noexcept { return samples_.empty(); }
  std::size_t capacity() const noexcept { return samples_.capacity(); }
  Sample& operator[](std::size_t row) { return samples_[row]; }
  const Sample& operator[](std::size_t row) const { return samples_[row]; }
  const Sample& front() const { return samples_.front(); }
  const Sample& back() const { return samples_.back(); }
  auto begin() noexcept { return samples_.begin(); }
  auto end() noexcept { return samples_.end(); }
  auto begin() const noexcept { return samples_.begin(); }
  auto end() const noexcept { return samples_.end(); }

  void reserve(std::size_t rows);
  /// Throws std::invalid_argument, and adds nothing, unless there is one number for each extra column.
  void push_back(const Sample& sample, const double* extra = nullptr, std::size_t extra_count = 0);

  /// Leaves the rows, in their order, of which `wanted(row)` is true; asked once of each, first to last.
  template <class Wanted>
  void keep_rows(const Wanted& wanted) {
    std::size_t kept = 0;
    for (std::size_t row = 0; row < size(); ++row) {
      if (!wanted(row)) continue;
      samples_[kept] = samples_[row];
      for (ExtraColumn& column : columns_) column.values[kept] = column.values[row];
      ++kept;
    }
    samples_.resize(kept);
    for (ExtraColumn& column : columns_) column.values.resize(kept);
  }

  const std::vector<ExtraColumn>& columns() const noexcept { return columns_; }
  /// Null if there is none of that name.
  const ExtraColumn* column(std::string_view wanted) const noexcept;
  /// Throws std::invalid_argument for a column without a name, of a name that is taken, or of another length than the
  /// flight.
  void add_column(ExtraColumn column);

 private:
  std::vector<Sample> samples_;
  std::vector<ExtraColumn> columns_;
};

/// Flights, each on a clock of its own: nothing is ever interpolated or windowed across a border between two.
/// A flight stays where it is in memory when others are added, so that a RowSet of it keeps its rows.
class Dataset {
 public:
  Dataset() = default;
  /// A flight alone is a dataset.
  explicit Dataset(Flight flight) { add(std::move(flight)); }

  /// Throws std::invalid_argument, one line, and adds nothing: a name that another flight has, time that does not
  /// increase from row to row, a weight that is no positive number.
  void add(Flight flight);

  const std::deque<Flight>& flights() const noexcept { return flights_; }
  std::size_t size() const noexcept { return flights_.size(); }
  const Flight& operator[](std::size_t flight) const { return flights_[flight]; }
  /// Rows of all flights.
  std::size_t rows() const noexcept { return rows_; }

 private:
  std::deque<Flight> flights_;
  std::size_t rows_ = 0;
};

/// "a.csv, b.csv, c.csv".
std::string flight_names(const Dataset& dataset);

namespace detail {

void absorb_number(Fnv1a& fnv, double value);

}  // namespace detail

/// Provenance of a flight: 64-bit FNV-1a over the number of rows and the IEEE 754 bits of every value, each as eight
/// bytes, least significant first, rows in order, values in the order of `sample_field_names`; then extra column by
/// extra column, its name, its unit and its values. Name, trajectory and weight are no content.
/// The same on every compiler and byte order. All NaNs count as one; 0 and -0 differ. No protection against forgery.
std::uint64_t content_hash(const Flight& flight);

/// Provenance of a dataset: of one flight that flight's, of several the FNV-1a of their number and of each one's, in
/// order.
std::uint64_t content_hash(const Dataset& dataset);

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/data/impl/dataset.hpp"
#endif

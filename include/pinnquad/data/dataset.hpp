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
inline Sample::Values to_values(const Sample& sample) {
  const auto& v_dot = sample.linear_acceleration_m_s2;
  const auto& omega_dot = sample.angular_acceleration_rad_s2;
  const auto& v = sample.velocity_m_s;
  const auto& omega = sample.body_rates_rad_s;
  const auto& u = sample.commands;
  // clang-format off
  return {sample.time_s,
          v_dot[0], v_dot[1], v_dot[2],
          omega_dot[0], omega_dot[1], omega_dot[2],
          v[0], v[1], v[2],
          omega[0], omega[1], omega[2],
          sample.roll_rad, sample.pitch_rad, sample.yaw_rad,
          sample.altitude_m,
          u[0], u[1], u[2], u[3]};
  // clang-format on
}

/// The inverse of `to_values`.
inline Sample to_sample(const Sample::Values& values) {
  const auto vector_at = [&values](std::size_t first) {
    return Vector3<double>(values[first], values[first + 1], values[first + 2]);
  };
  Sample sample;
  sample.time_s = values[0];
  sample.linear_acceleration_m_s2 = vector_at(1);
  sample.angular_acceleration_rad_s2 = vector_at(4);
  sample.velocity_m_s = vector_at(7);
  sample.body_rates_rad_s = vector_at(10);
  sample.roll_rad = values[13];
  sample.pitch_rad = values[14];
  sample.yaw_rad = values[15];
  sample.altitude_m = values[16];
  sample.commands = {values[17], values[18], values[19], values[20]};
  return sample;
}

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

  void reserve(std::size_t rows) {
    samples_.reserve(rows);
    for (ExtraColumn& column : columns_) column.values.reserve(rows);
  }
  /// Throws std::invalid_argument, and adds nothing, unless there is one number for each extra column.
  void push_back(const Sample& sample, const double* extra = nullptr, std::size_t extra_count = 0) {
    if (extra_count != columns_.size()) {
      throw std::invalid_argument("flight: expected " + std::to_string(columns_.size()) +
                                  " numbers of extra columns with a row, found " + std::to_string(extra_count));
    }
    samples_.push_back(sample);
    for (std::size_t i = 0; i < extra_count; ++i) columns_[i].values.push_back(extra[i]);
  }

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
  const ExtraColumn* column(std::string_view wanted) const noexcept {
    for (const ExtraColumn& column : columns_) {
      if (column.name == wanted) return &column;
    }
    return nullptr;
  }
  /// Throws std::invalid_argument for a column without a name, of a name that is taken, or of another length than the
  /// flight.
  void add_column(ExtraColumn column) {
    if (column.name.empty()) throw std::invalid_argument("flight: an extra column needs a name");
    for (const std::string_view taken : sample_field_names) {
      if (column.name == taken)
        throw std::invalid_argument("flight: " + printable(column.name) + " is a column of every flight");
    }
    if (this->column(column.name) != nullptr) {
      throw std::invalid_argument("flight: it has a column " + printable(column.name) + " already");
    }
    if (column.values.size() != size()) {
      throw std::invalid_argument("flight: expected " + std::to_string(size()) + " values of column " +
                                  printable(column.name) + ", found " + std::to_string(column.values.size()));
    }
    columns_.push_back(std::move(column));
  }

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
  void add(Flight flight) {
    for (const Flight& other : flights_) {
      if (other.name == flight.name) {
        throw std::invalid_argument("dataset: expected a name of its own for each flight, found '" + flight.name +
                                    "' twice");
      }
    }
    for (std::size_t row = 1; row < flight.size(); ++row) {
      if (flight[row].time_s > flight[row - 1].time_s) continue;
      throw std::invalid_argument("dataset: time does not increase at row " + std::to_string(row + 1) + " of flight '" +
                                  flight.name + "'");
    }
    if (!(flight.weight > 0 && flight.weight <= std::numeric_limits<double>::max())) {
      throw std::invalid_argument("dataset: expected a positive weight of flight '" + flight.name + "', found " +
                                  std::to_string(flight.weight));
    }
    rows_ += flight.size();
    flights_.push_back(std::move(flight));
  }

  const std::deque<Flight>& flights() const noexcept { return flights_; }
  std::size_t size() const noexcept { return flights_.size(); }
  const Flight& operator[](std::size_t flight) const { return flights_[flight]; }
  /// Of all flights.
  std::size_t rows() const noexcept { return rows_; }

 private:
  std::deque<Flight> flights_;
  std::size_t rows_ = 0;
};

/// "a.csv, b.csv, c.csv".
inline std::string flight_names(const Dataset& dataset) {
  std::string names;
  for (const Flight& flight : dataset.flights()) names += (names.empty() ? "" : ", ") + flight.name;
  return names;
}

namespace detail {

inline void absorb_number(Fnv1a& fnv, double value) {
  static_assert(sizeof(double) == sizeof(std::uint64_t) && std::numeric_limits<double>::is_iec559,
                "content_hash: double must be IEEE 754 binary64");
  constexpr std::uint64_t canonical_nan = 0x7ff8000000000000u;
  std::uint64_t bits = canonical_nan;
  if (!std::isnan(value)) std::memcpy(&bits, &value, sizeof bits);
  fnv.absorb_word(bits);
}

}  // namespace detail

/// Provenance of a flight: 64-bit FNV-1a over the number of rows and the IEEE 754 bits of every value, each as eight
/// bytes, least significant first, rows in order, values in the order of `sample_field_names`; then extra column by
/// extra column, its name, its unit and its values. Name, trajectory and weight are no content.
/// The same on every compiler and byte order. All NaNs count as one; 0 and -0 differ. No protection against forgery.
inline std::uint64_t content_hash(const Flight& flight) {
  detail::Fnv1a fnv;
  fnv.absorb_word(flight.size());
  for (const Sample& sample : flight) {
    for (const double value : to_values(sample)) detail::absorb_number(fnv, value);
  }
  for (const ExtraColumn& column : flight.columns()) {
    fnv.absorb_text(column.name);
    fnv.absorb_text(column.unit);
    for (const double value : column.values) detail::absorb_number(fnv, value);
  }
  return fnv.hash;
}

/// Provenance of a dataset: of one flight that flight's, of several the FNV-1a of their number and of each one's, in
/// order.
inline std::uint64_t content_hash(const Dataset& dataset) {
  if (dataset.size() == 1) return content_hash(dataset[0]);
  detail::Fnv1a fnv;
  fnv.absorb_word(dataset.size());
  for (const Flight& flight : dataset.flights()) fnv.absorb_word(content_hash(flight));
  return fnv.hash;
}

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// Bodies of dataset.hpp.
#pragma once

#include "pinnquad/data/dataset.hpp"

namespace pinnquad {

PINNQUAD_BODY Sample::Values to_values(const Sample& sample) {
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

PINNQUAD_BODY Sample to_sample(const Sample::Values& values) {
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

PINNQUAD_BODY std::string flight_names(const Dataset& dataset) {
  std::string names;
  for (const Flight& flight : dataset.flights()) names += (names.empty() ? "" : ", ") + flight.name;
  return names;
}

namespace detail {

PINNQUAD_BODY void absorb_number(Fnv1a& fnv, double value) {
  static_assert(sizeof(double) == sizeof(std::uint64_t) && std::numeric_limits<double>::is_iec559,
                "content_hash: double must be IEEE 754 binary64");
  constexpr std::uint64_t canonical_nan = 0x7ff8000000000000u;
  std::uint64_t bits = canonical_nan;
  if (!std::isnan(value)) std::memcpy(&bits, &value, sizeof bits);
  fnv.absorb_word(bits);
}

}  // namespace detail

PINNQUAD_BODY std::uint64_t content_hash(const Flight& flight) {
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

PINNQUAD_BODY std::uint64_t content_hash(const Dataset& dataset) {
  if (dataset.size() == 1) return content_hash(dataset[0]);
  detail::Fnv1a fnv;
  fnv.absorb_word(dataset.size());
  for (const Flight& flight : dataset.flights()) fnv.absorb_word(content_hash(flight));
  return fnv.hash;
}

PINNQUAD_BODY void Flight::reserve(std::size_t rows) {
  samples_.reserve(rows);
  for (ExtraColumn& column : columns_) column.values.reserve(rows);
}

PINNQUAD_BODY void Flight::push_back(const Sample& sample, const double* extra, std::size_t extra_count) {
  if (extra_count != columns_.size()) {
    throw std::invalid_argument("flight: expected " + std::to_string(columns_.size()) +
                                " numbers of extra columns with a row, found " + std::to_string(extra_count));
  }
  samples_.push_back(sample);
  for (std::size_t i = 0; i < extra_count; ++i) columns_[i].values.push_back(extra[i]);
}

PINNQUAD_BODY const ExtraColumn* Flight::column(std::string_view wanted) const noexcept {
  for (const ExtraColumn& column : columns_) {
    if (column.name == wanted) return &column;
  }
  return nullptr;
}

PINNQUAD_BODY void Flight::add_column(ExtraColumn column) {
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

PINNQUAD_BODY void Dataset::add(Flight flight) {
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

}  // namespace pinnquad

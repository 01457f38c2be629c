// SPDX-License-Identifier: MIT
// Bodies of ground_features.hpp.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "pinnquad/training/ground_features.hpp"

namespace pinnquad {

PINNQUAD_BODY bool GroundFeatures::is_column(std::size_t feature) const {
  const std::string_view name = detail::name_at_tap(names[feature]);
  return std::any_of(columns.begin(), columns.end(), [&](const ColumnName& column) { return column.name == name; });
}

PINNQUAD_BODY std::vector<int> GroundFeatures::thrusts() const {
  std::vector<int> places;
  for (const bool now : {true, false}) {
    for (std::size_t i = 0; i < size(); ++i) {
      if (detail::is_thrust(names[i]) && detail::is_of_present(names[i]) == now) places.push_back(static_cast<int>(i));
    }
  }
  return places;
}

namespace detail {

/// Names and the texts that they are read from, which stay where they are.
struct HeldFeatures {
  std::string texts;
  RunTimeFeatures features;
};

template <class Scalar>
GroundFeatures::EachRow rows_by_name(const std::shared_ptr<const HeldFeatures>& held) {
  return [held](const RowSet& rows, const GroundFeatures::Visit& visit) {
    const RunTimeFeatures& features = held->features;
    std::vector<RunTimeFeatures::Inputs<Scalar>> taps(static_cast<std::size_t>(features.window().taps));
    std::vector<Scalar> x(static_cast<std::size_t>(features.size()));
    std::vector<double> shown(x.size());
    for (const FlightRows& piece : rows.pieces()) {
      const RunTimeFlightInputs<Scalar> recorded(features, piece);
      for (std::size_t row = piece.rows.begin; row < piece.rows.end; ++row) {
        if (!recorded.read(row, taps.data())) continue;
        features.extract(static_cast<const RunTimeFeatures::Inputs<Scalar>*>(taps.data()), x.data());
        shown.assign(x.begin(), x.end());
        visit(*piece.flight, row, shown.data());
      }
    }
  };
}

}  // namespace detail

PINNQUAD_BODY GroundFeatures named_features(const std::string& type, const std::vector<std::string>& names,
                                            const std::vector<std::string>& units,
                                            const RunTimeFeatures::Window& window) {
  const auto held = std::make_shared<detail::HeldFeatures>();
  for (std::size_t i = 0; i < names.size() && i < units.size(); ++i) {
    for (const std::string* text : {&names[i], &units[i]}) held->texts.append(*text).push_back('\0');
  }
  RunTimeFeatures& features = held->features;
  if (names.size() != units.size() || !features.read(held->texts, static_cast<int>(names.size()), window)) {
    throw std::invalid_argument("named_features: " + type + " is no set of features of the library and columns");
  }
  GroundFeatures value{type, names, units, {}, window, {}, {}, {}};
  for (int i = 0; i < features.column_count(); ++i) {
    const auto [name, unit] = features.column(i);
    value.columns.push_back({std::string(name), std::string(unit)});
  }
  for (int tap = 0; tap < window.taps; ++tap) {
    const int place = features.angular_acceleration(tap);
    if (place >= 0) value.accelerations.push_back(place);
  }
  value.each_row = detail::rows_by_name<float>(held);
  value.each_exact_row = detail::rows_by_name<double>(held);
  return value;
}

}  // namespace pinnquad

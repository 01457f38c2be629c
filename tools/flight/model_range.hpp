// SPDX-License-Identifier: MIT
// The motions that a model answers, by its envelope: what a trajectory for it must stay within.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/features/features.hpp"

namespace programs {

struct ModelRange {
  struct Feature {
    std::string name, unit;
    double lower = 0, upper = 0;
    bool is_column = false;  ///< at whatever value, the model answers
  };
  using Motion = pinnquad::MotionInputsWithAltitude<double>;

  std::vector<Feature> features;
  /// X of a motion that has lasted as long as the window; none: it answers any.
  std::function<std::vector<double>(const Motion&)> of;

  /// The columns that it asks for, in their order.
  std::vector<Feature> columns() const {
    std::vector<Feature> asked;
    for (const Feature& feature : features) {
      if (feature.is_column && feature.name.back() != ']') asked.push_back(feature);  // of the present
    }
    return asked;
  }
  /// Altitudes in its envelope, if it is shown the altitude.
  std::optional<std::pair<double, double>> altitude_m() const {
    const Feature* const altitude = find("altitude");
    if (altitude == nullptr) return {};
    return std::pair(altitude->lower, altitude->upper);
  }
  /// Along a body axis the largest either way; none of a component that it is not shown.
  std::optional<double> speed_m_s(std::size_t axis) const {
    constexpr std::array<const char*, 3> velocity = {"v_bx", "v_by", "v_bz"};
    const Feature* const speed = find(velocity[axis]);
    if (speed == nullptr) return {};
    return std::min(speed->upper, -speed->lower);
  }
  /// The altitude alone: of a model that is asked outside of its envelope too.
  ModelRange of_altitude() const {
    ModelRange range;
    if (const Feature* const altitude = find("altitude")) range.features.push_back(*altitude);
    return range;
  }
  /// True where it answers a motion half as great again, counted from hover: a feedback asks for more than is planned.
  bool holds(const Motion& motion) const {
    constexpr double factor = 1.5;
    if (!of) return true;
    Motion hover;
    hover.altitude_m = motion.altitude_m;
    const std::vector<double> resting = of(hover), x = of(motion);
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (features[i].is_column) continue;
      const double asked = resting[i] + factor * (x[i] - resting[i]);
      if (!(asked >= features[i].lower && asked <= features[i].upper)) return false;
    }
    return true;
  }

 private:
  const Feature* find(const char* name) const {
    for (const Feature& feature : features) {
      if (feature.name == name) return &feature;
    }
    return nullptr;
  }
};

}  // namespace programs

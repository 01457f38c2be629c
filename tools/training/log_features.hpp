// SPDX-License-Identifier: MIT
// Feature sets of models of logged flights, by what the logs have measured and by how far a model looks.
#pragma once

#include <string>

#include "pinnquad/features/extra_columns.hpp"
#include "pinnquad/training/ground_features.hpp"
#include "training/model_kind.hpp"

namespace programs {

/// Nine instants, 20 ms apart: of planned motions 80 ms to both sides, else the last 160 ms. The present instant alone
/// for TimeReach::present.
pinnquad::RunTimeFeatures::Window log_window(TimeReach reach);

/// In all flights, in volts.
bool has_battery(const FitTask& fit);

/// Names and units of a feature set of the library, and how a header names it.
struct FeatureNames {
  std::string type;
  std::vector<std::string> names, units;
};
template <class Features>
FeatureNames feature_names() {
  return {pinnquad::type_name<Features>(),
          {Features::names.begin(), Features::names.end()},
          {Features::units.begin(), Features::units.end()}};
}

/// `present`, and the battery's voltage where the flights have it; then `other` at the other taps of the window.
pinnquad::GroundFeatures log_features(const FitTask& fit, TimeReach reach, FeatureNames present,
                                      const FeatureNames& other);

/// The features that physics asks for, as far as the logs have them. Of a window specific force and angular
/// acceleration alone, for they are what the rotors' lag and the differentiation smear.
pinnquad::GroundFeatures physics_features(const FitTask& fit, TimeReach reach);

/// The features that an asked motion can have, as far as the logs have them.
pinnquad::GroundFeatures inverse_features(const FitTask& fit, TimeReach reach, bool with_altitude);

/// A window is interpolated between rows, but not over gaps.
std::string needs_window(const FitTask& fit);

/// Calls `use(FeaturesTag)` with the paper's features, which the logs have to have but for the battery: for networks,
/// whose types know their features.
template <class Features>
struct FeaturesTag {
  using type = Features;
};
template <class Use>
auto with_paper_features(const FitTask& fit, const Use& use) {
  using namespace pinnquad;
  return has_battery(fit) ? use(FeaturesTag<WithColumns<PaperFeatures, BatteryVoltage>>{})
                          : use(FeaturesTag<PaperFeatures>{});
}

}  // namespace programs

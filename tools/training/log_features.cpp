// SPDX-License-Identifier: MIT
#include "training/log_features.hpp"

#include "pinnquad/features/motion_parts.hpp"

namespace programs {

pinnquad::RunTimeFeatures::Window log_window(TimeReach reach) {
  if (reach == TimeReach::present) return {};
  return {9, reach == TimeReach::causal, pinnquad::PeriodMicroseconds<20000>::seconds};
}

bool has_battery(const FitTask& fit) {
  for (const pinnquad::RowSet* rows : {&fit.training, &fit.validation}) {
    for (const pinnquad::FlightRows& piece : rows->pieces()) {
      const pinnquad::ExtraColumn* column = piece.flight->column(pinnquad::BatteryVoltage::name);
      if (column == nullptr || column->unit != pinnquad::BatteryVoltage::unit) return false;
    }
  }
  return true;
}

pinnquad::GroundFeatures log_features(const FitTask& fit, TimeReach reach, FeatureNames present,
                                      const FeatureNames& other) {
  using pinnquad::BatteryVoltage;
  if (has_battery(fit)) {
    present.type = "pinnquad::WithColumns<" + present.type + ", pinnquad::BatteryVoltage>";
    present.names.emplace_back(BatteryVoltage::name);
    present.units.emplace_back(BatteryVoltage::unit);
  }
  const pinnquad::RunTimeFeatures::Window window = log_window(reach);
  for (int tap = 0; tap + 1 < window.taps; ++tap) {
    const int offset = window.offset(tap);
    const std::string at = std::string("[") + (offset > 0 ? "+" : "") + std::to_string(offset) + "]";
    for (const std::string& name : other.names) present.names.push_back(name + at);
    present.units.insert(present.units.end(), other.units.begin(), other.units.end());
  }
  if (window.taps > 1) {
    present.type = "pinnquad::PartlyWindowed<" + present.type + ", " + other.type + ", " + std::to_string(window.taps) +
                   ", " + pinnquad::type_name<pinnquad::PeriodMicroseconds<20000>>() +
                   ", pinnquad::" + (window.causal ? "Causal" : "Centred") + ">";
  }
  return pinnquad::named_features(present.type, present.names, present.units, window);
}

pinnquad::GroundFeatures physics_features(const FitTask& fit, TimeReach reach) {
  using namespace pinnquad;
  return log_features(
      fit, reach,
      fit.lacks("velocity") ? feature_names<PhysicsFeaturesWithoutVelocity>() : feature_names<PhysicsFeatures>(),
      feature_names<AccelerationFeatures>());
}

pinnquad::GroundFeatures inverse_features(const FitTask& fit, TimeReach reach, bool with_altitude) {
  using namespace pinnquad;
  return log_features(fit, reach,
                      fit.lacks("velocity") ? feature_names<InverseFeaturesWithoutVelocity>()
                      : with_altitude       ? feature_names<InverseFeaturesWithAltitude>()
                                            : feature_names<InverseFeatures>(),
                      feature_names<InverseAccelerations>());
}

std::string needs_window(const FitTask& fit) {
  const pinnquad::RunTimeFeatures::Window window = log_window(TimeReach::causal);
  if (fit.sample_period_s <= window.largest_gap_s) return "";
  const auto milliseconds = [](double seconds) { return std::to_string(static_cast<int>(seconds * 1e3 + 0.5)); };
  return "needs a row every " + milliseconds(window.period_s) + " ms for its window, the logs have one every " +
         milliseconds(fit.sample_period_s);
}

}  // namespace programs

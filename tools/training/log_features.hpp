// SPDX-License-Identifier: MIT
// Feature sets of models of logged flights, by what the logs have measured and by how far a model looks.
#pragma once

#include <string>

#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/features/windowed.hpp"
#include "training/model_kind.hpp"

namespace programs {

/// Nine instants, 20 ms apart: of planned motions 80 ms to both sides, else the last 160 ms. Specific force and angular
/// acceleration alone, for they are what the rotors' lag and the differentiation smear.
template <class Present, class Part, class Sight>
using LogWindow = pinnquad::PartlyWindowed<Present, Part, 9, pinnquad::PeriodMicroseconds<20000>, Sight>;

template <TimeReach Reach, class Present, class Part = pinnquad::AccelerationFeatures>
using LogFeatures = std::conditional_t<
    Reach == TimeReach::present, Present,
    LogWindow<Present, Part, std::conditional_t<Reach == TimeReach::causal, pinnquad::Causal, pinnquad::Centred>>>;

template <class Features>
struct FeaturesTag {
  using type = Features;
};

/// In all flights, in volts.
inline bool has_battery(const FitTask& fit) {
  for (const pinnquad::RowSet* rows : {&fit.training, &fit.validation}) {
    for (const pinnquad::FlightRows& piece : rows->pieces()) {
      const pinnquad::ExtraColumn* column = piece.flight->column(pinnquad::BatteryVoltage::name);
      if (column == nullptr || column->unit != pinnquad::BatteryVoltage::unit) return false;
    }
  }
  return true;
}

/// Calls `use(FeaturesTag...)` with these sets, and the battery's voltage in each where the flights have it.
template <class... Sets, class Use>
auto with_battery(const FitTask& fit, const Use& use) {
  using pinnquad::WithColumns, pinnquad::BatteryVoltage;
  return has_battery(fit) ? use(FeaturesTag<WithColumns<Sets, BatteryVoltage>>{}...) : use(FeaturesTag<Sets>{}...);
}

/// Calls `use(FeaturesTag)` with what physics asks for, as far as the logs have it.
template <TimeReach Reach, class Use>
auto with_physics_features(const FitTask& fit, const Use& use) {
  using namespace pinnquad;
  const auto reaching = [&use](auto tag) {
    return use(FeaturesTag<LogFeatures<Reach, typename decltype(tag)::type>>{});
  };
  return fit.lacks("velocity") ? with_battery<PhysicsFeaturesWithoutVelocity>(fit, reaching)
                               : with_battery<PhysicsFeatures>(fit, reaching);
}

/// The same with the paper's features, which the logs have to have but for the battery.
template <class Use>
auto with_paper_features(const FitTask& fit, const Use& use) {
  return with_battery<pinnquad::PaperFeatures>(fit, use);
}

/// A window is interpolated between rows, but not over gaps.
inline std::string needs_window(const FitTask& fit) {
  using Window = LogFeatures<TimeReach::causal, pinnquad::PhysicsFeatures>::Window;
  if (fit.sample_period_s <= Window::largest_gap_s) return "";
  const auto milliseconds = [](double seconds) { return std::to_string(static_cast<int>(seconds * 1e3 + 0.5)); };
  return "needs a row every " + milliseconds(Window::period_s) + " ms for its window, the logs have one every " +
         milliseconds(fit.sample_period_s);
}

}  // namespace programs

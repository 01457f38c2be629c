// SPDX-License-Identifier: MIT
// The structured kinds, for the features that the flights have: velocity and battery where they were measured, the
// altitude where the validation rows gain by it.
#include <type_traits>

#include "training/log_features.hpp"
#include "training/log_kinds.hpp"
#include "training/structured_kind.hpp"

namespace programs {

namespace {

/// Of what an asked motion can have, as far as the flights have it.
template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_structured_kind(const FitTask& task) {
  using namespace pinnquad;
  const auto fit = [&task](auto lower, auto higher) {
    using Lower = LogFeatures<Reach, typename decltype(lower)::type, InverseAccelerations>;
    using Higher = LogFeatures<Reach, typename decltype(higher)::type, InverseAccelerations>;
    StructuredSets sets{structured_export<Lower>(task.given_airframe())};
    if constexpr (!std::is_same_v<Lower, Higher>) sets.higher = structured_export<Higher>(task.given_airframe());
    return fit_structured_on(task, sets);
  };
  if (!task.lacks("velocity")) return with_battery<InverseFeatures, InverseFeaturesWithAltitude>(task, fit);
  using Without = InverseFeaturesWithoutVelocity;
  return with_battery<Without, Without>(task, fit);
}

template <TimeReach Reach>
ModelKind structured(const char* key, const char* title, std::string (*not_applicable)(const FitTask&)) {
  return {key,
          title,
          Reach,
          true,
          not_applicable,
          fit_structured_kind<Reach>,
          fits_validation,
          pinnquad::structured_in_words};
}

}  // namespace

ModelKind log_structured() { return structured<TimeReach::present>("structured", "structured", always_applicable); }
ModelKind log_structured_causal() {
  return structured<TimeReach::causal>("structured_causal", "structured, the last 160 ms", needs_window);
}
ModelKind log_structured_centred() {
  return structured<TimeReach::centred>("structured_centred", "structured, 80 ms to both sides", needs_window);
}

}  // namespace programs

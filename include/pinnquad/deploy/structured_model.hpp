// SPDX-License-Identifier: MIT
// The structured model, whole: fitted (training/structured), judged and exported as a value, compiled once for all
// feature sets.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/core/finite.hpp"
#include "pinnquad/deploy/fitted_model.hpp"
#include "pinnquad/training/structured/fit_structured.hpp"

namespace pinnquad {

/// The fits of all seeds that were finished, in the order of the seeds. A model has its residual where that helps.
struct StructuredFits {
  /// A structured model of one seed: judged, exported and asked as any other.
  struct Fit : detail::SeedFit {
    GroundModel<float> model;
  };

  FitWork::Altitude altitude;
  std::vector<Fit> models;
  FitContext context;  ///< of the models

  /// The model with the least error on the validation rows. Throws std::logic_error where no model was finished.
  const Fit& best() const {
    const auto less = [](const Fit& a, const Fit& b) {
      return is_finite(a.validation_error) && !(b.validation_error <= a.validation_error);  // NaN is the worst
    };
    if (models.empty()) throw std::logic_error("structured fit: no model was finished");
    return *std::min_element(models.begin(), models.end(), less);
  }
};

/// Fits a structured model from each seed. The first seed tries both feature sets where the altitude is chosen
/// by_validation. Throws std::invalid_argument for rows that are too few.
StructuredFits fit_structured(const StructuredBases& bases, const StructuredSettings& settings = {},
                              const FitWork& work = FitWork());

/// Fits on feature sets that are types. `WithAltitude`: Features and the altitude, which the validation rows choose or
/// not; Features again where that was not measured.
template <class Features = InverseFeatures, class WithAltitude = InverseFeaturesWithAltitude>
StructuredFits fit_structured(const RowSplit& split, const GivenAirframe& airframe,
                              const StructuredSettings& settings = {}, const FitWork& work = FitWork()) {
  std::optional<StructuredSet> higher;
  if constexpr (!std::is_same_v<Features, WithAltitude>) higher = structured_set<WithAltitude>(airframe);
  return fit_structured(StructuredBases(structured_set<Features>(airframe), std::move(higher), split), settings, work);
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/structured_model.hpp"
#endif

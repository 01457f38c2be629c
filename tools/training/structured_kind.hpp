// SPDX-License-Identifier: MIT
// The structured model of the library (training/structured/fit_structured.hpp) as a kind.
#pragma once

#include <memory>
#include <optional>

#include "pinnquad/deploy/structured_model.hpp"
#include "training/model_kind.hpp"

namespace programs {

/// Feature sets that a structured model is fitted to.
struct StructuredSets {
  pinnquad::StructuredExport lower;                    ///< without the altitude
  std::optional<pinnquad::StructuredExport> higher{};  ///< none where the flights have no altitude to choose
};

std::shared_ptr<const TrainedNetwork> fit_structured_on(const FitTask& task, const StructuredSets& sets);

inline bool fits_validation(const FitSettings& settings) { return settings.fit_validation; }

}  // namespace programs

// SPDX-License-Identifier: MIT
// Chooses the trained model to export; says in words why, or why none is.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "pinnquad/evaluation/errors.hpp"
#include "training/judgement.hpp"
#include "training/losses.hpp"

namespace programs {

inline std::string four_digits(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4f", value);
  return text;
}

/// The model chosen for the export, a result of the kind `loss`.
struct Chosen {
  LossName loss;
  std::optional<std::size_t> best;  ///< of the results; none: nothing is there to be exported
  pinnquad::Verdict verdict{};      ///< where there is one

  /// "best structured model".
  std::string name() const { return "best " + with_kind(loss); }
  /// Why it is no better than none.
  std::string poor() const {
    return "on the test rows the " + name() + " is worse than the mean of the commands (R^2 " +
           four_digits(verdict.test_r_squared) + ", worst motor " + four_digits(verdict.worst_motor_r_squared) + ")";
  }
};

/// Why nothing of a kind is there to be exported.
inline std::string reason_of_none(const LossName& loss, const std::vector<Result>& results) {
  const bool none = over_seeds(results, loss.title, figures().front()).empty();
  return "no " + with_kind(loss) + (none ? " was finished" : " predicts finite commands on the validation rows");
}

/// The best model, by the validation rows, of the kind that is exported. `regression_r_squared`: see Verdict.
inline Chosen chosen_export(const std::vector<LossName>& losses, const std::vector<Result>& results,
                            double regression_r_squared) {
  const LossName kind = exported_kind(losses);
  Chosen chosen{kind, best_of(results, kind.title)};
  if (chosen.best) chosen.verdict = pinnquad::verdict_on(results[*chosen.best].test.errors, regression_r_squared);
  return chosen;
}

}  // namespace programs

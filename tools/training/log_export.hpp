// SPDX-License-Identifier: MIT
// Chooses the judged model to export, and writes its files.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/listed.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "training/log_figures.hpp"
#include "training/log_verdict.hpp"

namespace programs {

/// Values of `--export` besides a model's key.
inline constexpr const char* export_causal = "causal";
inline constexpr const char* export_centred = "centred";

namespace detail {

/// Over the fits that were not fitted to the validation rows.
inline double mean_validation_error(const JudgedKind& kind) {
  std::vector<double> errors;
  for (const JudgedFit& fit : kind.fits) {
    if (std::isfinite(fit.validation_error)) errors.push_back(fit.validation_error);
  }
  return pinnquad::summarize(errors).mean;
}

}  // namespace detail

/// The kinds that may be exported, indices of judged.kinds, best first; none if nothing fits the choice. After a
/// rotation by their held-out error: every flight was held out once, and the export is fitted anew. Else by their error
/// on the validation flights: the flights held out have no say.
/// Throws std::invalid_argument for the key of a kind that was not judged.
inline std::vector<std::size_t> kinds_to_export(const LogJudgement& judged, const std::string& choice, bool rotated) {
  for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
    if (choice != judged.kinds[k].kind.key) continue;
    if (judged.kinds[k].applicable()) return {k};
    throw std::invalid_argument("--export " + choice + ": not applicable: " + judged.kinds[k].not_applicable);
  }
  std::vector<std::size_t> order = ranking(judged, choice == export_centred);
  if (rotated) return order;
  const auto error_of = [&judged](std::size_t k) { return detail::mean_validation_error(judged.kinds[k]); };
  order.erase(std::remove_if(order.begin(), order.end(), [&](std::size_t k) { return !std::isfinite(error_of(k)); }),
              order.end());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return error_of(a) < error_of(b); });
  return order;
}

/// Of the fits of a kind the one with the least error on the validation flights, of one that was fitted to them the
/// first; none if no such error is finite.
inline const FinishedFit* best_fit(const std::vector<FinishedFit>& fits, std::size_t kind, bool takes_validation) {
  const FinishedFit* best = nullptr;
  for (const FinishedFit& fit : fits) {
    if (fit.kind != kind) continue;
    if (takes_validation) return &fit;
    if (!std::isfinite(fit.validation_error)) continue;
    if (best == nullptr || fit.validation_error < best->validation_error) best = &fit;
  }
  return best;
}

/// How the kind did on the flights held out, mean over partings and seeds.
inline pinnquad::Verdict exported_verdict(const LogJudgement& judged, std::size_t k) {
  const JudgedKind& kind = judged.kinds[k];
  pinnquad::Verdict verdict;
  verdict.test_r_squared = detail::r2_of(kind);
  const JudgedKind* linear = judged.find("linear");
  verdict.linear_regression_r_squared =
      linear != nullptr && linear->applicable() ? detail::r2_of(*linear) : pinnquad::not_a_number;
  double worst = pinnquad::not_a_number;
  for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
    const double r2 = pinnquad::summarize(over_seeds(kind, log_figures[0], motor)).mean;
    if (!(worst <= r2)) worst = r2;
  }
  verdict.worst_motor_r_squared = worst;
  return verdict;
}

/// The header's provenance; a model that the validation rows do not stop was fitted to them too.
inline pinnquad::Provenance provenance_of(const Fold& fold, const pinnquad::Dataset& dataset, double lag_removed_s,
                                          const LogModelKind& kind, std::uint64_t seed, int epochs,
                                          const pinnquad::Verdict& verdict) {
  std::string flights;
  const auto add = [&flights](const std::vector<std::string>& names) {
    for (const std::string& name : names) add_to_list(flights, name);
  };
  add(fold.train);
  std::size_t rows = fold.split.train.size();
  if (kind.takes_validation) {
    if (!fold.part_validates) add(fold.validation);
    rows += fold.split.validation.size();
  }
  pinnquad::Provenance from{flights, pinnquad::content_hash(dataset), rows, seed, epochs, kind.title, verdict};
  from.sample_period_s = pinnquad::sample_period_s(fold.split.train);
  from.lag_removed_s = lag_removed_s;
  return from;
}

}  // namespace programs

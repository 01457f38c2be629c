// SPDX-License-Identifier: MIT
// Chooses the judged model to export, and says where it comes from.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/listed.hpp"
#include "pinnquad/data/row_set.hpp"
#include "pinnquad/deploy/weight_file.hpp"
#include "pinnquad/evaluation/judgement.hpp"
#include "training/kind_figures.hpp"
#include "training/kind_verdict.hpp"

namespace programs {

/// Values of `--export` besides a model's key.
inline constexpr const char* export_causal = "causal";
inline constexpr const char* export_centred = "centred";

/// The error that chooses between kinds, mean over the judges. After a rotation the judges are the partings whose
/// flights were held out: every flight was once, and the export is fitted anew. Else they are none of the rows held
/// out, which have no say.
inline double choosing_error(const FitPlan& plan, const JudgedKind& kind) {
  std::vector<double> errors;
  for (const JudgedFit& fit : kind.fits) {
    const bool rotated = plan.folds.size() > 1;
    if (rotated && plan.folds[fit.fold].chooses) errors.push_back(mean_over_motors(fit.errors.root_mean_square));
    if (!rotated) errors.insert(errors.end(), fit.chosen_by.begin(), fit.chosen_by.end());
  }
  return pinnquad::summarize(errors).mean;
}

/// The kinds that may be exported, indices of judged.kinds, best first; none if nothing fits the choice. Errors within
/// half a percent of the least decide nothing: of these the best structured model goes first, whose slopes are the
/// vehicle's. One whose signs are not proven is exported by its name alone. Throws std::invalid_argument for the key of
/// a kind that was not judged.
inline std::vector<std::size_t> kinds_to_export(const FitPlan& plan, const JudgedKinds& judged,
                                                const std::string& choice) {
  for (std::size_t k = 0; k < judged.kinds.size(); ++k) {
    if (choice != judged.kinds[k].kind.key) continue;
    if (judged.kinds[k].applicable()) return {k};  // what was asked for by name
    throw std::invalid_argument("--export " + choice + ": not applicable: " + judged.kinds[k].not_applicable);
  }
  const auto error_of = [&](std::size_t k) { return choosing_error(plan, judged.kinds[k]); };
  std::vector<std::size_t> order;
  for (const std::size_t k : ranking(judged, choice == export_centred)) {
    const JudgedKind& kind = judged.kinds[k];
    if (kind.kind.exportable && kind.proven() && std::isfinite(error_of(k))) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return error_of(a) < error_of(b); });
  const auto tied = std::find_if(order.begin(), order.end(), [&](std::size_t k) {
    return std::string_view(judged.kinds[k].kind.key).substr(0, 10) == "structured" &&
           error_of(k) <= 1.005 * error_of(order.front());
  });
  if (tied != order.end()) std::rotate(order.begin(), tied, tied + 1);
  return order;
}

/// Of the fits of a kind the one with the least error on the validation rows, of one that was fitted to them the
/// first; none if no such error is finite.
inline const FinishedFit* best_fit(const std::vector<FinishedFit>& fits, std::size_t kind, bool takes_validation) {
  const FinishedFit* best = nullptr;
  for (const FinishedFit& fit : fits) {
    if (fit.kind != kind) continue;
    if (takes_validation) return &fit;
    if (!std::isfinite(fit.validation_mae)) continue;
    if (best == nullptr || fit.validation_mae < best->validation_mae) best = &fit;
  }
  return best;
}

/// How the exported model did on the rows held out: by the fit of `seed`, or as mean over partings and seeds where the
/// export is fitted anew.
inline pinnquad::Verdict exported_verdict(const FitPlan& plan, const JudgedKinds& judged, std::size_t k,
                                          std::optional<std::uint64_t> seed) {
  const JudgedKind& kind = judged.kinds[k];
  MotorFigures r2{};
  for (const JudgedFit& fit : kind.fits) {
    if (seed && fit.seed != *seed) continue;
    const double share = 1.0 / static_cast<double>(seed ? kind.folds() : kind.fits.size());
    for (std::size_t motor = 0; motor < r2.size(); ++motor) r2[motor] += share * fit.errors.r2[motor];
  }
  const JudgedKind* linear = judged.find("linear");
  double by_regression = pinnquad::not_a_number;
  if (linear != nullptr && linear->applicable()) {
    by_regression = detail::r2_of(*linear);
  } else if (std::find(plan.absent.begin(), plan.absent.end(), "velocity") == plan.absent.end()) {
    by_regression = 0;
    for (const Fold& fold : plan.folds) {
      by_regression += pinnquad::linear_regression_errors<pinnquad::PaperFeatures>(fold.split.train, fold.split.test)
                           .mean.r_squared /
                       static_cast<double>(plan.folds.size());
    }
  }
  double worst = r2[0];
  for (const double of_motor : r2) {
    if (!(worst <= of_motor)) worst = of_motor;
  }
  return {mean_over_motors(r2), by_regression, worst};
}

/// The header's provenance; a model that the validation rows do not stop was fitted to them too.
inline pinnquad::Provenance provenance_of(const Fold& fold, const pinnquad::Dataset& dataset, double lag_removed_s,
                                          const ModelKind& kind, const FitSettings& settings, std::uint64_t seed,
                                          int epochs, const pinnquad::Verdict& verdict) {
  std::string flights;
  const auto add = [&flights](const std::vector<std::string>& names) {
    for (const std::string& name : names) add_to_list(flights, name);
  };
  add(fold.train);
  std::size_t rows = fold.split.train.size();
  if (kind.takes_validation(settings)) {
    if (!fold.part_validates) add(fold.validation);
    rows += fold.split.validation.size();
  }
  const char* words = kind.words != nullptr ? kind.words : kind.title;
  pinnquad::Provenance from{flights, pinnquad::content_hash(dataset), rows, seed, epochs, words, verdict};
  from.sample_period_s = pinnquad::sample_period_s(fold.split.train);
  from.lag_removed_s = std::max(lag_removed_s, 0.0);  // below 0 it is none of the rotors
  return from;
}

/// The same with facts of the model itself. `biases`: time constants of its bias; `airframe_known`: the airframe of the
/// header is the vehicle's.
inline pinnquad::Provenance provenance_of(const TrainedNetwork& model, pinnquad::Provenance from,
                                          const std::optional<pinnquad::SignedSums<double>>& biases,
                                          bool airframe_known) {
  if (const std::optional<pinnquad::BlockModel::ProvenSigns> signs = model.block()->proven_signs()) {
    from.proven_slopes = signs->held_slope;
  } else {
    from.signs_unproven = true;
  }
  from.slopes = model.slopes();
  from.bias_time_constants_s = biases;
  from.airframe_known = airframe_known;
  return from;
}

}  // namespace programs

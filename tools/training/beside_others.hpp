// SPDX-License-Identifier: MIT
// The exported model beside the others of the same run, by their errors on the rows held out; the evidence of a run for
// the verdict on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "training/export_choice.hpp"
#include "training/kind_figures.hpp"
#include "training/log_kinds.hpp"
#include "training/model_verdict.hpp"

namespace programs {

/// Root mean square errors of the commands held out, mean over motors, partings and seeds.
struct BesideOthers {
  double own = pinnquad::not_a_number;
  std::optional<std::size_t> best;  ///< of judged.kinds: of all others that may be exported the one that errs least
  double best_other = pinnquad::not_a_number;
  double last_commands = pinnquad::not_a_number, mean_commands = pinnquad::not_a_number;

  /// So much less is told: a tenth.
  bool beaten() const { return best_other < 0.9 * own; }
};

namespace detail {

inline double held_out_rmse(const JudgedKind& kind) {
  return pinnquad::summarize(over_seeds(kind, error_figures[3])).mean;
}

/// The same for a kind that may not be among those compared.
inline double held_out_rmse(const FitPlan& plan, const JudgedKinds& judged, const ModelKind& kind) {
  const JudgedKind* known = judged.find(kind.key);
  if (known != nullptr && known->applicable()) return held_out_rmse(*known);
  double sum = 0;
  for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
    const pinnquad::RowSet& rows = plan.folds[fold].split.test;
    const Predictions made = kind.fit(plan.task(plan.folds[fold], plan.first_seed))->predictions(rows);
    std::vector<bool> counts = judged.counts[fold];
    for (std::size_t row = 0; row < counts.size(); ++row) counts[row] = counts[row] && answered(made[row]);
    sum += mean_over_motors(flight_errors(rows, made, counts).root_mean_square);
  }
  return sum / static_cast<double>(plan.folds.size());
}

}  // namespace detail

/// `unfit`: kinds that were found not fit to fly, which are not among the others.
inline BesideOthers beside_others(const FitPlan& plan, const JudgedKinds& judged, std::size_t exported,
                                  const std::vector<std::size_t>& unfit = {}) {
  const ModelKind last = log_last_commands(), mean = log_constant();
  const JudgedKind& kind = judged.kinds[exported];
  BesideOthers beside;
  beside.own = detail::held_out_rmse(kind);
  for (const std::size_t k : ranking(judged, kind.kind.reach == TimeReach::centred)) {
    const double error = detail::held_out_rmse(judged.kinds[k]);
    const ModelKind& other = judged.kinds[k].kind;
    if (k == exported || !other.exportable || other.key == std::string(mean.key)) continue;
    if (std::find(unfit.begin(), unfit.end(), k) != unfit.end() || beside.best_other <= error) continue;
    beside.best = k;
    beside.best_other = error;
  }
  beside.last_commands = detail::held_out_rmse(plan, judged, last);
  beside.mean_commands = detail::held_out_rmse(plan, judged, mean);
  return beside;
}

/// "Held out, rms error: ridge 33.6e-3; structured, the best of the others, 31.6e-3; ..."
inline std::string in_words(const BesideOthers& beside, const JudgedKinds& judged, std::size_t exported) {
  std::string words = "rms error of the commands held out: " + std::string(judged.kinds[exported].kind.title) + " " +
                      thousandths(beside.own, 1);
  if (beside.best) {
    words += "; best of the others, " + std::string(judged.kinds[*beside.best].kind.title) + ", " +
             thousandths(beside.best_other, 1);
  }
  return words + "; the commands of 100 ms ago " + thousandths(beside.last_commands, 1) +
         "; the mean of the commands " + thousandths(beside.mean_commands, 1);
}

inline nlohmann::json beside_json(const BesideOthers& beside, const JudgedKinds& judged) {
  return {{"exported", beside.own},
          {"best_other", beside.best_other},
          {"best_other_model", beside.best ? nlohmann::json(judged.kinds[*beside.best].kind.key) : nlohmann::json()},
          {"last_commands", beside.last_commands},
          {"mean_commands", beside.mean_commands}};
}

/// A line each where the export is beaten by a tenth, and where the commands of 100 ms ago err less: what to do.
inline std::vector<std::string> beaten_in_words(const BesideOthers& beside, const JudgedKinds& judged,
                                                std::size_t exported) {
  std::vector<std::string> lines;
  const std::string own = std::string(judged.kinds[exported].kind.title) + ", which is exported,";
  const auto errors = [&](double less) {
    return " (rms " + thousandths(less, 1) + " against " + thousandths(beside.own, 1) + ")";
  };
  if (beside.beaten()) {
    const JudgedKind& best = judged.kinds[*beside.best];
    const std::string key = best.kind.key;
    lines.push_back(own + " is beaten by " + best.kind.title + " on the rows held out" + errors(beside.best_other) +
                    (best.proven() ? "; flights that cover what is held out would let it be chosen"
                                   : ", of whose signs nothing is proven") +
                    "; --export " + key + " exports it");
  }
  if (beside.last_commands < beside.own) {
    lines.push_back(own + " is worse on the rows held out than the commands of 100 ms ago" +
                    errors(beside.last_commands) +
                    ": fly flights that cover what is held out, or let it learn a bias in flight (docs/adaptive.md)");
  }
  return lines;
}

/// Evidence for the verdict on an exported model, but for its path and the flight to record. `flown`: by
/// flight_evidence(); `known`: the vehicle.
inline ModelEvidence evidence_of(const TrainedNetwork& model, const JudgedKinds& judged, std::size_t exported,
                                 const pinnquad::Verdict& verdict, const nlohmann::json& flown,
                                 const BesideOthers& others, bool known) {
  ModelEvidence evidence{judged.kinds[exported].kind.title, verdict, flown};
  if (others.beaten() && judged.kinds[*others.best].proven() && !any_smoothed(model.slopes())) {
    evidence.beaten = beaten_in_words(others, judged, exported).front();
  }
  const std::optional<pinnquad::BlockModel::ProvenSigns> signs = model.block()->proven_signs();
  if (!signs) evidence.signs = Signs::unknown;
  evidence.known = known;
  evidence.last_commands_err_less = others.last_commands < others.own;
  if (signs && known) evidence.slopes = odd_slopes(*signs, model.block()->airframe());
  return evidence;
}

/// The verdict of a header's first lines.
inline std::string fitness_in_words(const FlightVerdict& verdict) {
  return verdict.words() + ". Next: " + verdict.next() +
         (verdict.reasons().empty() ? "" : ". Evidence: " + verdict.evidence());
}

}  // namespace programs

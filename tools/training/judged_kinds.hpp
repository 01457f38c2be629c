// SPDX-License-Identifier: MIT
// Fits as evidence: every kind on the same rows of the same held-out flights, seed by seed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "training/fits.hpp"
#include "training/flight_errors.hpp"

namespace programs {

/// One fit on the rows of its parting that count.
struct JudgedFit {
  std::size_t fold = 0;
  std::uint64_t seed = 0;
  FlightErrors errors;
  std::vector<double> by_flight;  ///< error_by_flight() of the parting's held-out flights
  Judgement judged;
  /// With a bias of the past (evaluation/past_bias.hpp), whose time constants other rows chose.
  FlightErrors adaptive;
  pinnquad::SignedSums<double> bias_time_constants_s{};
  double validation_mae = pinnquad::not_a_number;
  std::vector<double> chosen_by;  ///< FinishedFit::chosen_by
  double fit_s = 0;
  bool proven = false;
};

struct JudgedKind {
  ModelKind kind;
  std::string not_applicable;        ///< why there is nothing to judge; empty if there is
  std::vector<std::uint64_t> seeds;  ///< those with a fit on every parting
  std::vector<JudgedFit> fits;       ///< of these seeds: by seed, then parting
  pinnquad::BiasTrial biases{};      ///< on all rows that did not train and choose time constants
  /// Those for what is exported; none where there were no such rows.
  std::optional<pinnquad::SignedSums<double>> bias_time_constants_s{};

  bool applicable() const { return not_applicable.empty(); }
  std::size_t folds() const { return seeds.empty() ? 0 : fits.size() / seeds.size(); }
  /// Of every fit it is proven that the commands turn the vehicle the way that is asked.
  bool proven() const {
    return std::all_of(fits.begin(), fits.end(), [](const JudgedFit& fit) { return fit.proven; });
  }
  const JudgedFit& at(std::size_t seed, std::size_t fold) const { return fits[seed * folds() + fold]; }
};

struct JudgedKinds {
  std::vector<JudgedKind> kinds;          ///< in the order of the plan
  std::vector<std::vector<bool>> counts;  ///< per parting: the held-out rows that all kinds answer
  std::vector<std::string> flights;       ///< held out, parting by parting; in a rotation each once
  std::vector<std::size_t> rows;          ///< per parting: how many count

  const JudgedKind* find(const std::string& key) const {
    for (const JudgedKind& kind : kinds) {
      if (kind.kind.key == key) return &kind;
    }
    return nullptr;
  }
};

/// Per seed the mean over the partings of a figure of the errors.
template <class Of>
std::vector<double> per_seed(const JudgedKind& kind, const Of& of) {
  std::vector<double> values;
  for (std::size_t seed = 0; seed < kind.seeds.size(); ++seed) {
    double sum = 0;
    for (std::size_t fold = 0; fold < kind.folds(); ++fold) sum += of(kind.at(seed, fold));
    values.push_back(sum / static_cast<double>(kind.folds()));
  }
  return values;
}

/// Per held-out flight the mean over the seeds of its error.
inline std::vector<double> error_of_flights(const JudgedKind& kind) {
  std::vector<double> values;
  for (std::size_t fold = 0; fold < kind.folds(); ++fold) {
    for (std::size_t flight = 0; flight < kind.at(0, fold).by_flight.size(); ++flight) {
      double sum = 0;
      for (std::size_t seed = 0; seed < kind.seeds.size(); ++seed) sum += kind.at(seed, fold).by_flight[flight];
      values.push_back(sum / static_cast<double>(kind.seeds.size()));
    }
  }
  return values;
}

namespace detail {

/// Of the rows of a fit's parting, the share that it answers with finite commands.
inline double answered_share(const FinishedFit& fit) {
  const auto count = std::count_if(fit.held_out.begin(), fit.held_out.end(), answered);
  return static_cast<double>(count) / static_cast<double>(fit.held_out.size());
}

inline Judgement judgement_of(const FitPlan& plan, const pinnquad::RowSet& rows, const FinishedFit& fit,
                              const std::vector<bool>& counts) {
  const PredictedRows counted = rows_that_count(rows, fit.held_out, counts);
  Judgement judged =
      judge(pinnquad::GivenAirframe{plan.airframe.name, plan.airframe.value}, counted.rows, counted.predictions);
  judged.derivatives = fit.derivatives;
  return judged;
}

}  // namespace detail

namespace detail {

/// Errors with a bias of the past. Its time constants are those of other rows: of a rotation the ones held out in the
/// other partings; of one parting the validation rows that did not fit the model.
inline void judge_biases(const FitPlan& plan, const Fits& fits, JudgedKinds& result) {
  std::map<const FinishedFit*, pinnquad::BiasTrial> held_out;
  const bool rotated = plan.folds.size() > 1;
  for (const FinishedFit& fit : fits.finished) {
    if (!rotated || !result.kinds[fit.kind].applicable()) continue;
    held_out[&fit] = pinnquad::try_biases(plan.folds[fit.fold].split.test, fit.held_out, plan.airframe.value,
                                          past_of(plan.past, fit.looks_ahead_s));
  }
  // of the fits of a kind, but for one parting
  const auto tried = [&](std::size_t kind, std::size_t without) {
    pinnquad::BiasTrial all;
    for (const FinishedFit& fit : fits.finished) {
      if (fit.kind != kind) continue;
      if (!rotated) all += fit.biases;
      if (rotated && fit.fold != without) all += held_out[&fit];
    }
    return all;
  };
  for (std::size_t k = 0; k < result.kinds.size(); ++k) {
    JudgedKind& kind = result.kinds[k];
    if (!kind.applicable()) continue;
    const pinnquad::BiasTrial all = tried(k, plan.folds.size());
    kind.biases = all;
    if (all.rows > 0) kind.bias_time_constants_s = all.best_s();
    for (JudgedFit& judged : kind.fits) {
      judged.bias_time_constants_s = tried(k, judged.fold).best_s();
      for (const FinishedFit& fit : fits.finished) {
        if (fit.kind != k || fit.fold != judged.fold || fit.seed != judged.seed) continue;
        const pinnquad::RowSet& rows = plan.folds[fit.fold].split.test;
        judged.adaptive = flight_errors(
            rows,
            pinnquad::with_past_bias(rows, fit.held_out, plan.airframe.value,
                                     pinnquad::detail::bias_settings_of<double>(judged.bias_time_constants_s),
                                     past_of(plan.past, fit.looks_ahead_s).delay_s),
            result.counts[fit.fold]);
      }
    }
  }
}

}  // namespace detail

/// Rows that a kind leaves without an answer (a window that is not complete) count for no kind. A kind that leaves more
/// than half of a parting's rows without one is not judged.
inline JudgedKinds judge_fits(const FitPlan& plan, const Fits& fits) {
  constexpr double least_answered = 0.5;
  JudgedKinds result;
  std::vector<std::map<std::uint64_t, std::vector<const FinishedFit*>>> by_seed(plan.kinds.size());
  for (std::size_t kind = 0; kind < plan.kinds.size(); ++kind) {
    result.kinds.push_back({plan.kinds[kind], "", {}, {}});
    std::string& reason = result.kinds.back().not_applicable;
    for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
      if (reason.empty()) reason = fits.not_applicable[kind][fold];
    }
  }
  for (const FinishedFit& fit : fits.finished) {
    by_seed[fit.kind][fit.seed].push_back(&fit);
    const double share = detail::answered_share(fit);
    std::string& reason = result.kinds[fit.kind].not_applicable;
    if (share < least_answered && reason.empty()) {
      reason = "answers " + std::to_string(std::lround(100 * share)) + " %" + " of the rows of " +
               plan.folds[fit.fold].name + " alone";
    }
  }
  for (const Fold& fold : plan.folds) {
    result.counts.emplace_back(fold.split.test.size(), true);
    for (const pinnquad::FlightRows& piece : fold.split.test.pieces()) result.flights.push_back(piece.flight->name);
  }
  for (const FinishedFit& fit : fits.finished) {
    if (!result.kinds[fit.kind].applicable()) continue;
    for (std::size_t row = 0; row < fit.held_out.size(); ++row) {
      if (!detail::answered(fit.held_out[row])) result.counts[fit.fold][row] = false;
    }
  }
  for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
    result.rows.push_back(
        static_cast<std::size_t>(std::count(result.counts[fold].begin(), result.counts[fold].end(), true)));
    if (result.rows.back() == 0) {
      throw std::invalid_argument("--hold-out " + plan.folds[fold].name +
                                  ": no row of it is answered by all models; name fewer with --models");
    }
  }
  for (std::size_t k = 0; k < plan.kinds.size(); ++k) {
    JudgedKind& kind = result.kinds[k];
    if (!kind.applicable()) continue;
    for (auto& [seed, of_seed] : by_seed[k]) {
      if (of_seed.size() != plan.folds.size()) continue;
      std::sort(of_seed.begin(), of_seed.end(),
                [](const FinishedFit* a, const FinishedFit* b) { return a->fold < b->fold; });
      kind.seeds.push_back(seed);
      for (const FinishedFit* fit : of_seed) {
        const pinnquad::RowSet& rows = plan.folds[fit->fold].split.test;
        const std::vector<bool>& counts = result.counts[fit->fold];
        kind.fits.push_back({fit->fold,
                             seed,
                             flight_errors(rows, fit->held_out, counts),
                             error_by_flight(rows, fit->held_out, counts),
                             detail::judgement_of(plan, rows, *fit, counts),
                             {},
                             {},
                             fit->validation_mae,
                             fit->chosen_by,
                             fit->fit_s,
                             fit->proven});
      }
    }
    if (kind.seeds.empty()) kind.not_applicable = "not finished: interrupted before every parting had a fit";
  }
  detail::judge_biases(plan, fits, result);
  return result;
}

}  // namespace programs

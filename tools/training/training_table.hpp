// SPDX-License-Identifier: MIT
// The table of models on standard output: those that fly on measured motion, then those that look ahead, then those
// that can't be judged, each with its verdict.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "training/certificate_words.hpp"
#include "training/kind_figures.hpp"
#include "training/kind_verdict.hpp"

namespace programs {
namespace detail {

/// The same rows with a bias of the past.
inline void print_adaptive(const JudgedKind& kind) {
  if (!kind.bias_time_constants_s) return;
  const ErrorFigure &r2 = error_figures[0], &absolute = error_figures[4];
  std::printf("      adaptive: R^2 %s, mean absolute error %s (without the bias of the past %s) 1e-3; %s\n",
              mean_and_deviation(over_seeds_adaptive(kind, r2), 1, 3).c_str(),
              mean_and_deviation(over_seeds_adaptive(kind, absolute), 1e3, 2).c_str(),
              mean_and_deviation(over_seeds(kind, absolute), 1e3, 2).c_str(),
              time_constants_in_words(*kind.bias_time_constants_s).c_str());
}

inline void print_kind(const JudgedKinds& judged, const std::vector<KindVerdict>& verdicts, std::size_t k) {
  const JudgedKind& kind = judged.kinds[k];
  std::printf("  %-44s %-8s", kind.kind.title, word_of(kind.kind.reach));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::vector<double> values = over_seeds(kind, error_figures[i]);
    const bool known = std::isfinite(pinnquad::summarize(values).mean);  // not where a flight ends within its first 4 s
    const bool error = i == 3;
    std::printf("  %15s", known ? mean_and_deviation(values, error ? 1e3 : 1, error ? 2 : 3).c_str() : "-");
  }
  double wrong = 0;
  for (const double share :
       axis_means(kind, [](const Judgement&j, std::size_t axis) { return j.derivatives.wrong_share[axis]; })) {
    wrong = std::max(wrong, share);
  }
  if (sees_acceleration(kind)) {
    std::printf("  %7.2f\n", 100 * wrong);
  } else {
    std::printf("  %7s\n", "-");
  }
  print_adaptive(kind);
  std::printf("      %s\n", verdicts[k].sentence.c_str());
}

}  // namespace detail

inline void print_models(const FitPlan& plan, const JudgedKinds& judged, const std::vector<KindVerdict>& verdicts) {
  std::size_t rows = 0;
  for (const std::size_t of_fold : judged.rows) rows += of_fold;
  std::printf("  held out: %zu rows of %zu flight%s%s; mean +- deviation over the seeds\n", rows, judged.flights.size(),
              judged.flights.size() == 1 ? "" : "s", plan.folds.size() > 1 ? ", in turn" : "");
  std::printf("  %-44s %-8s  %15s  %15s  %15s  %15s  %7s\n", "", "sees", "R^2", "flight's bias", "bias of the",
              "RMSE, 1e-3", "wrong");
  std::printf("  %-44s %-8s  %15s  %15s  %15s  %15s  %7s\n", "", "", "", "removed", "first 4 s rem.", "", "slope %");
  for (const bool centred : {false, true}) {
    const std::vector<std::size_t> order = ranking(judged, centred);
    if (order.empty()) continue;
    std::printf("  %s\n", centred ? "looking ahead: for planned trajectories only" : "for flight on measured motion");
    for (const std::size_t k : order) detail::print_kind(judged, verdicts, k);
  }
  for (const JudgedKind& kind : judged.kinds) {
    if (!kind.applicable()) std::printf("  %-44s not applicable: %s\n", kind.kind.title, kind.not_applicable.c_str());
  }
}

inline void print_folds(const std::vector<Fold>& folds) {
  const auto names_of = [](const std::vector<std::string>& names) {
    return listed(names, [](const std::string& name) { return pinnquad::printable(name); });
  };
  for (const Fold& fold : folds) {
    std::printf("      held out: %s%s (%zu rows)\n", fold.by_time ? "the end of " : "", names_of(fold.held_out).c_str(),
                fold.split.test.size());
    std::printf("        validate: %s%s (%zu rows)\n",
                fold.by_time          ? "what is before it of "
                : fold.part_validates ? "the last fifth of "
                                      : "",
                names_of(fold.validation).c_str(), fold.split.validation.size());
    std::printf("        train: %s%s (%zu rows)\n", fold.by_time ? "the begin of " : "", names_of(fold.train).c_str(),
                fold.split.train.size());
  }
}

/// Of one fit, by kind, on one core.
inline void print_training_time(const JudgedKinds& judged) {
  std::string kinds;
  for (const JudgedKind& kind : judged.kinds) {
    if (!kind.applicable() || !kind.kind.seeded) continue;
    const double mean = pinnquad::summarize(per_seed(kind, [](const JudgedFit& fit) { return fit.fit_s; })).mean;
    add_to_list(kinds, in_words("%s %.2f s", kind.kind.title, mean));
  }
  if (!kinds.empty()) std::printf("  training took, per model and core: %s\n", kinds.c_str());
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// Tables of models on standard output, the best on top: a line a model, and in detail with the tests beside simpler
// models.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "command_line/in_columns.hpp"
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
  print_line("with a bias of the past: R^2 " + mean_and_deviation(over_seeds_adaptive(kind, r2), 1, 3) +
                 ", mean absolute error " + mean_and_deviation(over_seeds_adaptive(kind, absolute), 1e3, 2) +
                 " (without it " + mean_and_deviation(over_seeds(kind, absolute), 1e3, 2) + ") 1e-3; " +
                 time_constants_in_words(*kind.bias_time_constants_s),
             4);
}

/// The largest share of rows, of the three axes, where more angular acceleration asked is less torque commanded, %.
inline std::string wrong_slopes(const JudgedKind& kind) {
  if (!sees_acceleration(kind)) return "-";
  double wrong = 0;
  for (const double share :
       axis_means(kind, [](const Judgement&j, std::size_t axis) { return j.derivatives.wrong_share[axis]; })) {
    wrong = std::max(wrong, share);
  }
  return decimals(100 * wrong, 2);
}

/// One figure of a kind; "-" where a flight is too short for it.
inline std::string figure_text(const JudgedKind& kind, std::size_t i) {
  const std::vector<double> values = over_seeds(kind, error_figures[i]);
  const bool error = i >= 3;
  return std::isfinite(pinnquad::summarize(values).mean) ? mean_and_deviation(values, error ? 1e3 : 1, error ? 2 : 3)
                                                         : "-";
}

}  // namespace detail

/// `mark(k)`: a word beside a model.
template <class Mark>
void print_kinds(const JudgedKinds& judged, const Mark& mark) {
  const auto line = [](const char* title, const std::string& r2, const std::string& error, const std::string& wrong,
                       const std::string& more) {
    std::printf("  %-42s %15s %15s %13s  %s\n", title, r2.c_str(), error.c_str(), wrong.c_str(), more.c_str());
  };
  line("model", "R^2", "error, 1e-3", "wrong slope %", "");
  for (const bool centred : {false, true}) {
    const std::vector<std::size_t> order = ranking(judged, centred);
    if (centred && !order.empty()) std::printf("  need planned motion:\n");
    for (const std::size_t k : order) {
      const JudgedKind& kind = judged.kinds[k];
      line(kind.kind.title, detail::figure_text(kind, 0), detail::figure_text(kind, 3), detail::wrong_slopes(kind),
           mark(k));
    }
  }
  std::map<std::string, std::string> not_applicable;  // titles by the reason
  for (const JudgedKind& kind : judged.kinds) {
    if (kind.applicable()) continue;
    std::string& titles = not_applicable[kind.not_applicable];
    titles += (titles.empty() ? "" : "; ") + std::string(kind.kind.title);
  }
  for (const auto& [reason, titles] : not_applicable) print_line("not applicable: " + titles + ": " + reason, 2);
}

/// "3000 rows of 1 flight, mean +- deviation over 5 seeds".
inline std::string rows_in_words(const FitPlan& plan, const JudgedKinds& judged) {
  std::size_t rows = 0;
  for (const std::size_t of_fold : judged.rows) rows += of_fold;
  return std::to_string(rows) + " rows of " + std::to_string(judged.flights.size()) + " flight" +
         (judged.flights.size() == 1 ? "" : "s") + (plan.folds.size() > 1 ? ", in turn" : "") +
         "; mean +- deviation over the seeds";
}

/// Each model's tests beside the simpler ones, and its figures with biases removed.
inline void print_details(const JudgedKinds& judged, const std::vector<KindVerdict>& verdicts) {
  for (const bool centred : {false, true}) {
    for (const std::size_t k : ranking(judged, centred)) {
      const JudgedKind& kind = judged.kinds[k];
      print_line(std::string(kind.kind.title) + ", sees " + word_of(kind.kind.reach) + ": " + verdicts[k].sentence, 2);
      print_line("R^2 " + detail::figure_text(kind, 0) + "; with each flight's bias removed " +
                     detail::figure_text(kind, 1) + "; with that of its first 4 s removed " +
                     detail::figure_text(kind, 2),
                 4);
      detail::print_adaptive(kind);
    }
  }
}

inline void print_folds(const std::vector<Fold>& folds) {
  const auto names_of = [](const std::vector<std::string>& names) {
    return listed(names, [](const std::string& name) { return pinnquad::printable(name); });
  };
  const auto line = [&](const char* use, const std::vector<std::string>& names, std::size_t rows) {
    print_line(use + names_of(names) + " (" + std::to_string(rows) + " rows)", 6);
  };
  for (const Fold& fold : folds) {
    line(fold.by_time ? "held out: the end of " : "held out: ", fold.held_out, fold.split.test.size());
    line(fold.by_time          ? "  validate: what is before it of "
         : fold.part_validates ? "  validate: the last fifth of "
                               : "  validate: ",
         fold.validation, fold.split.validation.size());
    line(fold.by_time ? "  train: the begin of " : "  train: ", fold.train, fold.split.train.size());
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
  if (!kinds.empty()) print_line("training took, per model and core: " + kinds, 2);
}

}  // namespace programs

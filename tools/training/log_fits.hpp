// SPDX-License-Identifier: MIT
// Fits every kind of model to every parting of a dataset, from every seed, over the cores; Ctrl-C keeps what is
// finished.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/loss/context.hpp"
#include "training/hold_out.hpp"
#include "training/log_errors.hpp"
#include "training/log_model.hpp"
#include "training/log_slopes.hpp"

namespace programs {

struct LogPlan {
  const NamedAirframe& airframe;
  std::vector<LogModelKind> kinds;
  std::vector<Fold> folds;
  std::vector<std::string> absent;
  double sample_period_s = 0;
  std::uint64_t first_seed = 1;
  int seeds = 5;
  int epochs = 0;
  unsigned threads = 1;

  LogFit fit_of(const Fold& fold, std::uint64_t seed) const {
    return {airframe, fold.split.train, fold.split.validation, absent, sample_period_s, seed, epochs};
  }
};

/// One kind on one parting from one seed, and what it answers on the rows held out.
struct FinishedFit {
  std::size_t kind = 0, fold = 0;  ///< of the plan
  std::uint64_t seed = 0;
  Predictions held_out;
  /// Root mean square over all motors of the validation rows that it answers, if it was not fitted to them; else NaN.
  double validation_error = pinnquad::not_a_number;
  double fit_s = 0;
  LogSlopes slopes;
  std::shared_ptr<const TrainedNetwork> model;  ///< null: taken from a file of an earlier run
};

struct LogFits {
  std::vector<FinishedFit> finished;  ///< by seed, parting, kind
  /// [kind][parting]: why it has no fit there; empty if it can have one.
  std::vector<std::vector<std::string>> not_applicable;
  std::size_t wanted = 0;
};

namespace detail {

inline bool answered(const std::array<double, pinnquad::rotor_count>& commands) {
  return std::all_of(commands.begin(), commands.end(), [](double u) { return std::isfinite(u); });
}

inline double validation_error(const pinnquad::RowSet& rows, const Predictions& predictions) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!answered(predictions[row])) continue;
    for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
      const double error = predictions[row][motor] - rows[row].commands[motor];
      squares += error * error;
    }
    count += pinnquad::rotor_count;
  }
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : pinnquad::not_a_number;
}

inline Predictions predictions_of(const LogModelKind& kind, const TrainedNetwork& model, const pinnquad::RowSet& rows) {
  Predictions predictions = model.predictions(rows);
  if (predictions.size() != rows.size()) {
    throw std::logic_error(std::string(kind.key) + ": " + std::to_string(predictions.size()) + " predictions of " +
                           std::to_string(rows.size()) + " rows");
  }
  return predictions;
}

}  // namespace detail

inline std::array<std::array<double, pinnquad::rotor_count>, 3> axis_signs(const NamedAirframe& given) {
  const pinnquad::GivenAirframe airframe{given.name, given.value};
  return {airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()};
}

/// Fits one kind and asks it what the rows held out need. Where validation chooses between kinds (one parting, whose
/// flights held out have no say), one that takes the validation rows for fitting is fitted without them too, from the
/// first seed. Throws what the kind's fit() throws.
inline void fit_one(const LogPlan& plan, FinishedFit& job) {
  const LogModelKind& kind = plan.kinds[job.kind];
  const Fold& fold = plan.folds[job.fold];
  const auto error_of = [&](const TrainedNetwork& model) {
    return detail::validation_error(fold.split.validation, detail::predictions_of(kind, model, fold.split.validation));
  };
  const auto start = std::chrono::steady_clock::now();
  const LogFit fit = plan.fit_of(fold, job.seed);
  job.model = kind.fit(fit);
  job.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!kind.takes_validation) {
    job.validation_error = error_of(*job.model);
  } else if (plan.folds.size() == 1 && job.seed == plan.first_seed && !fold.split.test.empty()) {
    const pinnquad::RowSet none;
    const auto without =
        kind.fit({plan.airframe, fold.split.train, none, plan.absent, plan.sample_period_s, job.seed, plan.epochs});
    job.validation_error = error_of(*without);
  }
  if (fold.split.test.empty()) return;  // to be exported
  job.held_out = detail::predictions_of(kind, *job.model, fold.split.test);
  job.slopes = log_slopes(*job.model, fold.split.test, axis_signs(plan.airframe));
}

/// All of a plan. `known(job)` fills a fit that an earlier run has finished, true if it did; `keep(job)` is told of
/// each that this one finishes, from the thread that did it.
template <class Known, class Keep>
LogFits fit_all(const LogPlan& plan, const Known& known, const Keep& keep) {
  LogFits fits;
  fits.not_applicable.assign(plan.kinds.size(), std::vector<std::string>(plan.folds.size()));
  for (std::size_t kind = 0; kind < plan.kinds.size(); ++kind) {
    for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
      fits.not_applicable[kind][fold] = plan.kinds[kind].not_applicable(plan.fit_of(plan.folds[fold], plan.first_seed));
    }
  }
  std::vector<FinishedFit> jobs;
  for (int i = 0; i < plan.seeds; ++i) {  // a seed whole before the next: what an interruption leaves can be compared
    for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
      for (std::size_t kind = 0; kind < plan.kinds.size(); ++kind) {
        if (!fits.not_applicable[kind][fold].empty() || (i > 0 && !plan.kinds[kind].seeded)) continue;
        FinishedFit job;
        job.kind = kind;
        job.fold = fold;
        job.seed = plan.first_seed + static_cast<std::uint64_t>(i);
        jobs.push_back(std::move(job));
      }
    }
  }
  fits.wanted = jobs.size();
  std::vector<char> done(jobs.size(), 0);
  std::vector<std::string> refused(jobs.size());
  std::atomic<std::size_t> finished{0};
  run_parallel(
      "fitting " + std::to_string(jobs.size()) + " models", jobs.size(), plan.threads,
      [&] { return static_cast<double>(finished.load()) / static_cast<double>(jobs.size()); },
      [&](std::size_t i) {
        stop_if_interrupted();
        if (known(jobs[i])) {
          done[i] = 1;
        } else {
          try {
            fit_one(plan, jobs[i]);
            keep(jobs[i]);
            done[i] = 1;
          } catch (const std::invalid_argument& without_answer) {
            refused[i] = without_answer.what();
          }
        }
        finished.fetch_add(1);
      });
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!refused[i].empty()) fits.not_applicable[jobs[i].kind][jobs[i].fold] = refused[i];
    if (done[i] != 0) fits.finished.push_back(std::move(jobs[i]));
  }
  return fits;
}

}  // namespace programs

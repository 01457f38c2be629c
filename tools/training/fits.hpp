// SPDX-License-Identifier: MIT
// Fits every kind of model to every parting of a dataset, from every seed, over the cores; Ctrl-C keeps what is
// finished.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/evaluation/past_bias.hpp"
#include "pinnquad/loss/context.hpp"
#include "training/hold_out.hpp"
#include "training/model_kind.hpp"
#include "training/trained_network.hpp"

namespace programs {

struct FitPlan {
  const NamedAirframe& airframe;
  std::vector<ModelKind> kinds;
  std::vector<Fold> folds;
  std::vector<std::string> absent;
  double sample_period_s = 0;
  std::uint64_t first_seed = 1;
  int seeds = 5;
  int epochs = 0;
  unsigned threads = 1;
  FitSettings settings{};
  pinnquad::BiasTrial::Past past{};  ///< how a bias is made of rows
  bool shows_progress = true;        ///< on stderr

  FitTask task(const Fold& fold, std::uint64_t seed) const {
    return {airframe, fold.split.train, fold.split.validation, absent, sample_period_s, seed, epochs, settings};
  }
};

/// One kind on one parting from one seed, and what it answers on the rows held out.
struct FinishedFit {
  std::size_t kind = 0, fold = 0;  ///< of the plan
  std::uint64_t seed = 0;
  /// Mean absolute error of the commands on the validation rows that it answers; if it was fitted to them on those of
  /// all judges, NaN without.
  double validation_mae = pinnquad::not_a_number;
  double fit_s = 0;
  pinnquad::BiasTrial biases;     ///< on validation rows that it was not fitted to; none where there are none
  double looks_ahead_s = 0;       ///< TrainedNetwork::looks_ahead_s()
  DerivativeFigures derivatives;  ///< over the rows held out
  AltitudeChoice altitude;
  bool proven = false;  ///< TrainedNetwork::is_proven()
  Predictions held_out;
  std::vector<double>
      chosen_by;      ///< root mean square errors that choose between kinds: Fold::judges, or of a slow kind
                      ///< that on the validation rows
  GuardCounts guard;  ///< of the rows held out
  std::shared_ptr<const TrainedNetwork> model;  ///< null: taken from a file of an earlier run
};

/// An earlier run's fits, or none: FitStore (training/fit_store.hpp).
class KnownFits {
 public:
  virtual ~KnownFits() = default;
  /// Fills a fit that an earlier run has finished. False: there is none.
  virtual bool load(FinishedFit& /*job*/) const { return false; }
  /// Is told of each that this run finishes, from the thread that did it.
  virtual void keep(const FinishedFit& /*job*/) const {}
};

struct Fits {
  std::vector<FinishedFit> finished;  ///< by seed, parting, kind
  /// [kind][parting]: why it has no fit there; empty if it can have one.
  std::vector<std::vector<std::string>> not_applicable;
  std::size_t wanted = 0;
  std::size_t known = 0;  ///< of the finished ones: from an earlier run
};

namespace detail {

inline bool answered(const std::array<double, pinnquad::rotor_count>& commands) {
  return std::all_of(commands.begin(), commands.end(), [](double u) { return std::isfinite(u); });
}

/// Errors of the commands, over the rows that are answered.
struct ErrorSums {
  double absolute = 0, squares = 0, count = 0;
  void add(const pinnquad::RowSet& rows, const Predictions& predictions) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (!answered(predictions[row])) continue;
      for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
        const double error = predictions[row][motor] - rows[row].commands[motor];
        absolute += std::abs(error);
        squares += error * error;
        ++count;
      }
    }
  }
  double mean_absolute() const { return count > 0 ? absolute / count : pinnquad::not_a_number; }
  double root_mean_square() const { return count > 0 ? std::sqrt(squares / count) : pinnquad::not_a_number; }
};

/// A row that reads ahead is known so much later.
inline pinnquad::BiasTrial::Past past_of(pinnquad::BiasTrial::Past past, double looks_ahead_s) {
  past.delay_s += looks_ahead_s;
  return past;
}

inline void require_all(const ModelKind& kind, const Predictions& predictions, const pinnquad::RowSet& rows) {
  if (predictions.size() == rows.size()) return;
  throw std::logic_error(std::string(kind.key) + ": " + std::to_string(predictions.size()) + " predictions of " +
                         std::to_string(rows.size()) + " rows");
}

/// Says that a fit has ended, whatever ended it.
struct Ended {
  std::atomic<double>& share;
  ~Ended() { share.store(1); }
};

}  // namespace detail

/// Fits one kind and asks it what the rows held out need. Where other rows choose between kinds (one parting, whose
/// rows held out have no say), a quick one is fitted once more for each judge, without its rows, from the first seed;
/// networks take minutes: the validation rows that stop them judge them. Throws what the kind's fit() throws.
inline void fit_one(const FitPlan& plan, FinishedFit& job, const FitTask& task) {
  const ModelKind& kind = plan.kinds[job.kind];
  const Fold& fold = plan.folds[job.fold];
  detail::ErrorSums unseen;
  const auto ask = [&](const TrainedNetwork& model, const pinnquad::RowSet& rows, bool sets_biases) {
    const Predictions predictions = model.predictions(rows);
    detail::require_all(kind, predictions, rows);
    detail::ErrorSums of_rows;
    of_rows.add(rows, predictions);
    if (!sets_biases) return of_rows.root_mean_square();
    unseen.add(rows, predictions);
    job.biases +=
        pinnquad::try_biases(rows, predictions, plan.airframe.value, detail::past_of(plan.past, model.looks_ahead_s()));
    return of_rows.root_mean_square();
  };
  const auto start = std::chrono::steady_clock::now();
  job.model = kind.fit(task);
  job.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  job.looks_ahead_s = job.model->looks_ahead_s();
  job.altitude = job.model->altitude();
  job.proven = job.model->is_proven();
  const bool saw_validation = kind.takes_validation(plan.settings);
  if (!saw_validation) {
    const double error = ask(*job.model, fold.split.validation, true);
    if (!kind.quick) job.chosen_by = {error};
  }
  if ((kind.quick || saw_validation) && job.seed == plan.first_seed) {
    FitSettings settings = task.settings;
    settings.without_residual = settings.fit_validation = true;
    if (job.altitude.applies) settings.altitude = job.altitude.taken;
    const pinnquad::RowSet none;
    for (const Judge& judge : fold.judges) {
      FitTask without{task.airframe,        judge.others, none,        task.absent,
                      task.sample_period_s, task.seed,    task.epochs, settings};
      without.shared = task.shared;
      job.chosen_by.push_back(ask(*kind.fit(without), judge.rows, saw_validation));
    }
  }
  job.validation_mae = unseen.mean_absolute();
  if (fold.split.test.empty()) return;  // to be exported
  Answers answers = job.model->answers(fold.split.test);
  detail::require_all(kind, answers.predictions, fold.split.test);
  job.held_out = std::move(answers.predictions);
  job.derivatives = answers.derivatives;
  job.guard = std::move(answers.guard);
}

/// A fit that is known from an earlier run, once more: the same rows, seed and altitude give the same model.
inline void fit_again(const FitPlan& plan, FinishedFit& job) {
  FitTask task = plan.task(plan.folds[job.fold], job.seed);
  if (job.altitude.applies && job.seed != plan.first_seed) task.settings.altitude = job.altitude.taken;
  fit_one(plan, job, task);
}

/// All of a plan. Where the first seed's fit chooses whether a kind is shown the altitude, the other seeds' follow it:
/// a kind's are begun when that fit has ended.
inline Fits fit_all(const FitPlan& plan, const KnownFits& earlier = KnownFits{}) {
  Fits fits;
  fits.not_applicable.assign(plan.kinds.size(), std::vector<std::string>(plan.folds.size()));
  for (std::size_t kind = 0; kind < plan.kinds.size(); ++kind) {
    for (std::size_t fold = 0; fold < plan.folds.size(); ++fold) {
      fits.not_applicable[kind][fold] = plan.kinds[kind].not_applicable(plan.task(plan.folds[fold], plan.first_seed));
    }
  }
  std::vector<FinishedFit> jobs;
  for (int i = 0; i < plan.seeds; ++i) {
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
  std::vector<std::atomic<double>> shares(jobs.size());  // 1: it has ended
  // a parting whole before the next, which shares nothing with it; in it a seed whole before the next, the longest fits
  // first: no core is idle for long at the end
  std::vector<std::size_t> order(jobs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](const FinishedFit& job) {
    const bool seeded = plan.kinds[job.kind].seeded;
    return std::make_tuple(job.fold, job.seed, !seeded, plan.kinds.size() - job.kind);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place(jobs[a]) < place(jobs[b]); });
  std::vector<std::shared_ptr<SharedByFits>> shared(plan.folds.size());
  std::vector<std::atomic<std::size_t>> left(plan.folds.size());  // fits of a parting that have not ended
  for (auto& one : shared) one = std::make_shared<SharedByFits>();
  for (const FinishedFit& job : jobs) ++left[job.fold];
  std::atomic<std::size_t> known{0};
  const auto fit = [&](std::size_t i) {
    const auto first = static_cast<std::size_t>(
        std::find_if(jobs.begin(), jobs.end(),
                     [&](const FinishedFit& job) { return job.kind == jobs[i].kind && job.fold == jobs[i].fold; }) -
        jobs.begin());
    while (first != i && shares[first].load() < 1) {
      stop_if_interrupted();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    stop_if_interrupted();
    if (earlier.load(jobs[i])) {
      done[i] = 1;
      known.fetch_add(1);
      return;
    }
    FitTask task = plan.task(plan.folds[jobs[i].fold], jobs[i].seed);
    task.shared = shared[jobs[i].fold];
    // of a kind that is fitted several times the longest fit counts: no progress runs backwards
    task.share_done = [&shares, i](double share) { shares[i].store(std::clamp(share, shares[i].load(), 0.99)); };
    if (first != i && jobs[first].altitude.applies) task.settings.altitude = jobs[first].altitude.taken;
    try {
      fit_one(plan, jobs[i], task);
      earlier.keep(jobs[i]);
      done[i] = 1;
    } catch (const std::invalid_argument& without_answer) {
      refused[i] = without_answer.what();
    }
  };
  // a closed form takes a fiftieth of a network's time
  const auto cost = [&plan](const FinishedFit& job) { return plan.kinds[job.kind].seeded ? 1.0 : 0.02; };
  double whole = 0;
  for (const FinishedFit& job : jobs) whole += cost(job);
  const auto share_done = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < jobs.size(); ++i) sum += cost(jobs[i]) * shares[i].load();
    return sum / whole;
  };
  const std::string job = plan.shows_progress ? "fitting " + std::to_string(jobs.size()) + " models" : "";
  run_parallel(job, jobs.size(), plan.threads, share_done, [&](std::size_t next) {
    const std::size_t i = order[next];
    const detail::Ended ended{shares[i]};
    fit(i);
    if (--left[jobs[i].fold] == 0) shared[jobs[i].fold].reset();
  });
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!refused[i].empty()) fits.not_applicable[jobs[i].kind][jobs[i].fold] = refused[i];
    if (done[i] != 0) fits.finished.push_back(std::move(jobs[i]));
  }
  fits.known = known.load();
  return fits;
}

}  // namespace programs

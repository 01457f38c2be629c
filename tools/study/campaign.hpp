// SPDX-License-Identifier: MIT
// Runs a study's trainings over the cores into a folder, and goes on where an earlier run was stopped or killed.
#pragma once

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "command_line/console.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/folders.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "command_line/progress_line.hpp"
#include "study/configuration.hpp"
#include "study/rows.hpp"

namespace study {

/// Of the commands that train, for their help.
inline constexpr const char* exit_codes =
    "Exit codes: 0 all trainings are there, whatever the verdicts; 2 bad input or a file "
    "that can't be read or written; 130 interrupted: the same command goes on.";

/// One training to run.
struct Job {
  const Contender* contender = nullptr;
  Assignment assignment;

  RowId id() const { return {contender->id, contender->flight, assignment.flight_seed, assignment.seed}; }
};

/// All trainings of a plan in the order of its rows.
inline std::vector<Job> all_jobs(const Plan& plan) {
  std::vector<Job> jobs;
  for (const Contender& contender : plan.contenders) {
    for (const std::uint64_t flight_seed : flight_seeds(plan, contender)) {
      if (!contender.trained) {
        jobs.push_back({&contender, {flight_seed}});
        continue;
      }
      for (int i = 0; i < plan.seeds; ++i) {
        jobs.push_back(
            {&contender,
             {flight_seed, first_seed + static_cast<std::uint64_t>(i), plan.epochs, plan.best_weights, plan.patience}});
      }
    }
  }
  return jobs;
}

/// All flights of a plan, flown now.
inline Flights fly_all(const Plan& plan) {
  Flights flights;
  for (const Contender& contender : plan.contenders) {
    for (const std::uint64_t seed : flight_seeds(plan, contender)) {
      for (const programs::StudyFlight& id : flights_of(contender, seed)) flights[id];
    }
  }
  programs::ProgressLine progress("flying " + std::to_string(flights.size()) + " flights");
  double done = 0;
  for (auto& [id, flight] : flights) {
    progress.update(done++ / static_cast<double>(flights.size()));
    flight = plan.fly(id);
  }
  return flights;
}

/// The folder of a study, held by one program.
class StudyFolder {
 public:
  /// Makes the folder if it is not there. Throws OutputError: not writable, or another program is at work in it.
  explicit StudyFolder(const std::string& path) : path_(path), lock_(path) {
    programs::make_folders(path + "/series");
    remove_partial_files();
  }

  std::string rows() const { return path_ + "/rows.csv"; }
  std::string configuration() const { return path_ + "/study.json"; }
  std::string series(const std::string& model) const { return path_ + "/series/model" + model + ".csv"; }
  const std::string& path() const { return path_; }

 private:
  /// Files that a killed run was writing; a report that is being written holds its own.
  void remove_partial_files() const {
    std::error_code error;
    for (const std::string& folder : {path_, path_ + "/series"}) {
      for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (name.find(".csv.partial-") == std::string::npos && name.find(".json.partial-") == std::string::npos)
          continue;
        pinnquad::AtomicFile::remove_abandoned(entry.path().string());
      }
    }
  }

  std::string path_;
  programs::FolderLock lock_;
};

/// Predictions of a model on its test rows, beside the commands flown.
inline void write_series(const std::string& path, const pinnquad::Flight& flight, const Outcome& outcome) {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < outcome.predictions.size(); ++i) {
    const pinnquad::Sample& sample = flight[outcome.test_rows.begin + i];
    std::vector<double> row = {sample.time_s};
    for (int axis = 0; axis < 3; ++axis) row.push_back(sample.angular_acceleration_rad_s2[axis]);
    for (const double u : sample.commands) row.push_back(u);
    for (const double u : outcome.predictions[i]) row.push_back(u);
    rows.push_back(std::move(row));
  }
  pinnquad::write_csv(path, {"time_s", "wdot_x", "wdot_y", "wdot_z", "u1", "u2", "u3", "u4", "p1", "p2", "p3", "p4"},
                      rows);
}

/// A study in its folder.
class Campaign {
 public:
  Campaign(const Plan& plan, const std::string& out, unsigned threads)
      : plan_(plan), folder_(out), threads_(threads), jobs_(all_jobs(plan)) {}

  /// Throws InputError, OutputError, std::invalid_argument, programs::Interrupted; finished rows are kept.
  void run() {
    Workshop workshop(programs::keeping(kept(), [this] { return fly_all(plan_); }));
    open(workshop.flights());
    const std::size_t found = stored_.rows.size();
    train(workshop);
    settle();
    const std::size_t finished = stored_.rows.size();
    if (finished < jobs_.size()) throw programs::Interrupted{kept()};
    std::printf("%zu of %zu trainings are in %s, %zu of them from before; %.1f s on %u threads\n", finished,
                jobs_.size(), folder_.rows().c_str(), found, progress_s_, threads_);
  }

  const StoredRows& rows() const { return stored_; }

 private:
  std::string kept() const {
    return std::to_string(stored_.rows.size()) + " of " + std::to_string(jobs_.size()) + " trainings are in " +
           folder_.rows() + "; the same command goes on";
  }

  /// Compares the folder with this plan, takes its rows over, and leaves rows.csv ready for more.
  void open(const Flights& flights) {
    configuration_ = configuration(plan_, flights);
    const std::string path = folder_.configuration();
    std::error_code error;
    double earlier_s = 0;
    std::string started = programs::utc_now();
    if (std::filesystem::exists(path, error)) {
      const nlohmann::json there = read_configuration(path);
      const std::string differs = difference(there, configuration_);
      if (!differs.empty()) {
        throw std::invalid_argument(path + ": of another study: " + differs + "; give another --out");
      }
      earlier_s = there.value("wall_s", 0.0);
      started = there.value("started", started);
    } else if (std::filesystem::exists(folder_.rows(), error)) {
      throw pinnquad::InputError(path, 0, 0, "the settings of the rows beside it", "none");
    }
    earlier_s_ = earlier_s;
    configuration_["started"] = started;
    stored_ = read_rows(folder_.rows(), plan_.format.header);
    std::map<RowId, int> own;
    for (const Job& job : jobs_) own[job.id()] = job.assignment.epochs;
    require_own_rows(folder_.rows(), stored_, own, plan_.best_weights);
    if (stored_.broken > 0) {
      programs::complain("pinnquad-study", folder_.rows() + ": " + std::to_string(stored_.broken) +
                                               (stored_.broken == 1 ? " row is" : " rows are") +
                                               " not whole; run again");
    }
    note_run();
    write_rows(folder_.rows(), lines(), plan_.format.header);
  }

  /// Lines of the rows that there are, in the order of the plan.
  std::vector<std::string> lines() const {
    std::vector<std::string> result;
    for (const Job& job : jobs_) {
      const auto row = stored_.rows.find(job.id());
      if (row != stored_.rows.end()) result.push_back(row->second);
    }
    return result;
  }

  void note_run() {
    configuration_["cpu"] = programs::cpu_name();
    configuration_["threads"] = threads_;
    configuration_["wall_s"] = earlier_s_ + progress_s_;
    configuration_["trainings"] = jobs_.size();
    configuration_["trainings_finished"] = stored_.rows.size();
    const bool whole = stored_.rows.size() >= jobs_.size();
    configuration_["finished"] = whole ? nlohmann::json(programs::utc_now()) : nlohmann::json();
    write_configuration(folder_.configuration(), configuration_);
  }

  /// Trains what is missing; a row is appended when its training is finished.
  void train(Workshop& workshop) {
    std::vector<Job> missing;
    for (const Job& job : jobs_) {
      if (stored_.rows.count(job.id()) == 0) missing.push_back(job);
    }
    double all_rows = 0;
    for (const Job& job : missing) {
      all_rows += static_cast<double>(job.assignment.epochs) * static_cast<double>(job.contender->training_rows);
    }
    RowAppender appender(folder_.rows());
    std::mutex mutex;
    bool failed = false;
    const auto finish = [&](const Job& job, const Outcome& outcome) {
      const std::string row = plan_.format.text(job.id(), job.assignment.epochs, outcome);
      if (is_shown(job)) {
        write_series(folder_.series(job.contender->id),
                     workshop.flights().at({job.contender->flight, job.assignment.flight_seed}), outcome);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      if (failed) return;
      appender.append(row);
      stored_.rows[job.id()] = row;
    };
    progress_s_ = programs::run_parallel(
        "training " + std::to_string(missing.size()) + " networks", missing.size(), threads_,
        [&] { return all_rows > 0 ? static_cast<double>(workshop.rows_done()) / all_rows : 1; },
        [&](std::size_t i) {
          try {
            Outcome outcome;
            missing[i].contender->run(workshop, missing[i].assignment, outcome);
            finish(missing[i], outcome);
          } catch (const programs::Interrupted&) {
            throw;
          } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            failed = true;
            workshop.stop();
            throw;
          }
        });
  }

  /// Its predictions are kept: the first seed of each model on the main flight.
  bool is_shown(const Job& job) const {
    return !job.contender->flights && job.assignment.flight_seed == plan_.flight_seed &&
           (!job.contender->trained || job.assignment.seed == first_seed);
  }

  /// Rows in the order of the plan, and the facts of this run.
  void settle() {
    write_rows(folder_.rows(), lines(), plan_.format.header);
    note_run();
  }

  const Plan& plan_;
  StudyFolder folder_;
  unsigned threads_;
  std::vector<Job> jobs_;
  nlohmann::json configuration_;
  StoredRows stored_;
  double earlier_s_ = 0;
  double progress_s_ = 0;
};

}  // namespace study

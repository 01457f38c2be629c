// SPDX-License-Identifier: MIT
// report.json of a training: its settings, every result, the figures of each kind of model, what became of the best
// network, and all warnings.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/version.hpp"
#include "training/certificate_words.hpp"
#include "training/judge_all.hpp"
#include "training/judgement.hpp"
#include "training/model_figures.hpp"
#include "training/recipe.hpp"
#include "training/training_flights.hpp"

namespace programs {

/// report.json: settings, every result, and what became of the best network (null if none was finished); `more` are
/// further entries. A figure that is not finite is null.
inline void write_report(const std::string& path, nlohmann::json settings, const std::vector<Result>& results,
                         nlohmann::json verdict, const nlohmann::json& more = nlohmann::json::object()) {
  nlohmann::json rows = nlohmann::json::array();
  for (const Result& result : results) {
    nlohmann::json row = {{"model", result.model}, {"seed", result.seed}};
    for (const Figure& figure : figures()) row[figure.name] = figure.of(result.test, figure.index);
    row["validation_mae"] = result.validation_error;
    row["training_s"] = result.training_s;
    rows.push_back(std::move(row));
  }
  nlohmann::json report = {
      {"settings", std::move(settings)}, {"results", std::move(rows)}, {"verdict", std::move(verdict)}};
  report.update(more);
  pinnquad::AtomicFile file(path);
  file.stream() << report.dump(2, ' ', false,
                               nlohmann::json::error_handler_t::replace)  // a file's name need not be UTF-8
                << "\n";
  file.commit();
}

/// The report so far. A training that fails later leaves what was written last.
class TrainingReport {
 public:
  TrainingReport(std::string path, const Recipe& recipe, const TrainingPlan& plan, const pinnquad::Dataset& dataset)
      : path_(std::move(path)), losses_(plan.losses), settings_(recipe.settings) {
    settings_.update({{"version", PINNQUAD_VERSION},
                      {"recipe", recipe.name},
                      {"airframe", plan.airframe.airframe_name()},
                      {"epochs", plan.epochs},
                      {"first_seed", plan.first_seed},
                      {"seeds", plan.seeds}});
    for (const LossName& loss : losses_) settings_["losses"][loss.key] = loss.words;
    settings_.update(described(dataset, plan.split));
    more_["warnings"] = nlohmann::json::array();
    more_["certificate"] = more_["altitude"] = nullptr;
    if (is_structured(losses_.back())) settings_["structured"]["slopes"] = plan.pinned_slopes ? "pinned" : "learned";
  }

  /// A warning: no reason to stop; printed on stderr too.
  void warn(const std::string& text) {
    std::fprintf(stderr, "train: warning: %s\n", text.c_str());
    more_["warnings"].push_back(text);
  }

  void judged(const std::vector<Result>& results, std::size_t finished) {
    settings_["finished"] = finished;
    results_ = results;
    more_["models"][linear_name] = figures_over_seeds(results, linear_name);
    for (const LossName& loss : losses_) more_["models"][loss.key] = figures_over_seeds(results, loss.title);
  }
  /// Of the structured models.
  void altitude(const nlohmann::json& choice) { more_["altitude"] = choice; }
  void best(const Result& result, const pinnquad::Verdict& verdict, bool may_be_exported) {
    verdict_ = {{"model", result.model},
                {"seed", result.seed},
                {"r2", verdict.test_r_squared},
                {"worst_motor_r2", verdict.worst_motor_r_squared},
                {"linear_regression_r2", verdict.linear_regression_r_squared},
                {"worse_than_mean", verdict.worse_than_mean()},
                {"beats_linear_regression", verdict.beats_linear_regression()},
                {"exported", may_be_exported}};
  }
  /// Of what was exported.
  void certified(const pinnquad::Certificate& certificate, const pinnquad::AxisSlopes& airframe,
                 double airframe_thrust_slope) {
    const pinnquad::AxisSlopes slopes = held_slopes(certificate);
    nlohmann::json entry = {{"proven", certificate.proven()}, {"command_bound", certificate.command_bound}};
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
      entry["slope"][axis_names[axis]] = slopes[axis];
      entry["airframe_slope"][axis_names[axis]] = airframe[axis];
    }
    entry["thrust_slope"] = certificate.held_thrust_slope;
    entry["airframe_thrust_slope"] = airframe_thrust_slope;
    more_["certificate"] = entry;
  }

  void write_not_exported(const std::string& reason) { write(false, reason, nullptr, nullptr); }
  /// `block`: empty where none was asked for.
  void write_exported(const std::string& header, const std::string& block) {
    write(true, nullptr, header, block.empty() ? nlohmann::json() : nlohmann::json(block));
  }

 private:
  void write(bool exported, const nlohmann::json& reason, const nlohmann::json& header, const nlohmann::json& block) {
    more_["exported"] = exported;
    more_["not_exported_because"] = reason;
    more_["header"] = header;
    more_["block"] = block;
    write_report(path_, settings_, results_, verdict_, more_);
  }

  std::string path_;
  std::vector<LossName> losses_;
  nlohmann::json settings_, verdict_, more_;
  std::vector<Result> results_;
};

}  // namespace programs

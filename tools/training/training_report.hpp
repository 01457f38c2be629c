// SPDX-License-Identifier: MIT
// report.json of a training, and results.csv: what was held out, every model of the table with its figures and its
// verdict, what was exported, all warnings.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "command_line/build_facts.hpp"
#include "command_line/console.hpp"
#include "command_line/like_warnings.hpp"
#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/csv_table.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/version.hpp"
#include "training/beside_others.hpp"
#include "training/certificate_words.hpp"
#include "training/held_out_dynamics.hpp"
#include "training/kind_figures.hpp"
#include "training/kind_verdict.hpp"

namespace programs {
namespace detail {

/// Figures of a kind: over all partings, and by parting.
inline nlohmann::json figures_of(const FitPlan& plan, const JudgedKind& kind) {
  nlohmann::json result, motors;
  for (const ModelFigure& figure : model_figures) {
    if (!figure.has_axes) result[figure.name] = described(over_seeds(kind, figure, 0));
    for (std::size_t axis = 0; figure.has_axes && axis < axis_names.size(); ++axis) {
      result[figure.name][axis_names[axis]] = described(over_seeds(kind, figure, axis));
    }
  }
  result["sees_acceleration"] = sees_acceleration(kind);
  for (const ErrorFigure& figure : error_figures) {
    if (!result.contains(figure.name)) result[figure.name] = described(over_seeds(kind, figure));
    for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
      motors["u" + std::to_string(motor + 1)][figure.name] = described(over_seeds(kind, figure, motor));
    }
  }
  for (const std::size_t i : adaptive_figures) {
    result["adaptive"][error_figures[i].name] = described(over_seeds_adaptive(kind, error_figures[i]));
  }
  result["adaptive"]["bias_time_constants_s"] =
      kind.bias_time_constants_s ? nlohmann::json(*kind.bias_time_constants_s) : nlohmann::json();
  if (kind.biases.rows > 0) {
    result["adaptive"]["tried_s"] = pinnquad::bias_time_constants_tried_s;
    for (std::size_t k = 0; k < sum_names.size(); ++k) {
      nlohmann::json& residual = result["adaptive"]["mean_absolute_residual"][sum_names[k]];
      for (const auto& of_candidate : kind.biases.absolute) residual.push_back(of_candidate[k] / kind.biases.rows);
    }
  }
  result["per_motor"] = std::move(motors);
  result["by_fold"] = nlohmann::json::object();
  for (std::size_t fold = 0; fold < kind.folds(); ++fold) {
    nlohmann::json& of_fold = result["by_fold"][pinnquad::printable(plan.folds[fold].name)];
    const auto over_seeds_here = [&](FlightErrors JudgedFit::*errors, const ErrorFigure& figure) {
      std::vector<double> values;
      for (std::size_t seed = 0; seed < kind.seeds.size(); ++seed) {
        values.push_back(mean_over_motors((kind.at(seed, fold).*errors).*figure.of));
      }
      return described(values);
    };
    for (const ErrorFigure& figure : error_figures) {
      of_fold[figure.name] = over_seeds_here(&JudgedFit::errors, figure);
    }
    for (const std::size_t i : adaptive_figures) {
      of_fold["adaptive"][error_figures[i].name] = over_seeds_here(&JudgedFit::adaptive, error_figures[i]);
    }
    of_fold["adaptive"]["bias_time_constants_s"] = kind.at(0, fold).bias_time_constants_s;
  }
  return result;
}

/// Every judged fit with all its figures: a row of results.csv.
inline nlohmann::json results_json(const FitPlan& plan, const JudgedKinds& judged) {
  nlohmann::json rows = nlohmann::json::array();
  for (const JudgedKind& kind : judged.kinds) {
    for (const JudgedFit& fit : kind.fits) {
      nlohmann::json row = {{"model", kind.kind.key},
                            {"seed", kind.kind.seeded ? fit.seed : 0},
                            {"held_out", pinnquad::printable(plan.folds[fit.fold].name)},
                            {"validation_mae", fit.validation_mae},
                            {"training_s", fit.fit_s}};
      for (const Figure& figure : figures()) row[figure.name] = figure.of(fit.judged);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

inline nlohmann::json compared(const pinnquad::PairedComparison& c) {
  return {{"pairs", c.pairs}, {"lower", c.wins}, {"relative_difference", c.relative_difference}, {"p", c.p_value}};
}

inline nlohmann::json verdict_json(const JudgedKinds& judged, const KindVerdict& verdict) {
  nlohmann::json against = nlohmann::json::array();
  for (const AgainstSimpler& other : verdict.against) {
    against.push_back({{"model", judged.kinds[other.simpler].kind.key},
                       {"standing", word_of(other.standing)},
                       {"over_flights", compared(other.flights)},
                       {"over_seeds", other.seeds ? compared(*other.seeds) : nlohmann::json()}});
  }
  return {{"standing", word_of(verdict.standing)},
          {"success", verdict.standing == Standing::success},
          {"sentence", verdict.sentence},
          {"against", std::move(against)}};
}

inline nlohmann::json printable_names(const std::vector<std::string>& names) {
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& name : names) list.push_back(pinnquad::printable(name));
  return list;
}

}  // namespace detail

/// Writes results.csv, a row per judged fit.
inline void write_results(const std::string& path, const FitPlan& plan, const JudgedKinds& judged) {
  std::vector<std::string> cells = {"model", "seed"};
  for (const Figure& figure : figures()) cells.push_back(figure.name);
  cells.insert(cells.end(), {"validation_mae", "held_out", "training_s"});
  std::string text = pinnquad::csv_line(cells);
  for (const JudgedKind& kind : judged.kinds) {
    for (const JudgedFit& fit : kind.fits) {
      cells = {kind.kind.key, std::to_string(kind.kind.seeded ? fit.seed : 0)};
      for (const Figure& figure : figures()) cells.push_back(pinnquad::number_text(figure.of(fit.judged)));
      cells.insert(cells.end(), {pinnquad::number_text(fit.validation_mae),
                                 pinnquad::printable(plan.folds[fit.fold].name), pinnquad::number_text(fit.fit_s)});
      text += pinnquad::csv_line(cells);
    }
  }
  pinnquad::AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

/// Of report.json: raised where an entry changes its meaning or goes (docs/report.md).
inline constexpr int report_format = 2;

/// Builds report.json; a training that fails later leaves what was written last.
class TrainingReport {
 public:
  /// `trainings`: facts of what is trained, beside the other settings.
  TrainingReport(std::string path, const FitPlan& plan, const pinnquad::logs::ImportedDataset& dataset,
                 const nlohmann::json& trainings = nlohmann::json::object(), bool verbose = false)
      : path_(std::move(path)), verbose_(verbose) {
    nlohmann::json flights = nlohmann::json::array(), folds = nlohmann::json::array(), kinds = nlohmann::json::array();
    for (const pinnquad::Flight& flight : dataset.flights.flights()) {
      flights.push_back({{"flight", pinnquad::printable(flight.name)},
                         {"trajectory", pinnquad::printable(flight.trajectory)},
                         {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(flight))},
                         {"rows", flight.size()}});
    }
    for (const ModelKind& kind : plan.kinds) kinds.push_back(kind.key);
    std::vector<std::string> held_out;
    for (const Fold& fold : plan.folds) {
      held_out.insert(held_out.end(), fold.held_out.begin(), fold.held_out.end());
      folds.push_back({{"fold", pinnquad::printable(fold.name)},
                       {"held_out", detail::printable_names(fold.held_out)},
                       {"validation", detail::printable_names(fold.validation)},
                       {"train", detail::printable_names(fold.train)},
                       {"by_time", fold.by_time},
                       {"chosen_by", fold.chosen_by},
                       {"chooses", fold.chooses},
                       {"rows",
                        {{"train", fold.split.train.size()},
                         {"validation", fold.split.validation.size()},
                         {"held_out", fold.split.test.size()}}}});
    }
    json_ = {{"format", report_format},
             {"settings",
              {{"version", PINNQUAD_VERSION},
               {"instruction_set", instruction_set()},
               {"models", std::move(kinds)},
               {"airframe", plan.airframe.name},
               {"first_seed", plan.first_seed},
               {"seeds", plan.seeds},
               {"epochs", plan.epochs > 0 ? nlohmann::json(plan.epochs) : nlohmann::json("what suits each kind")},
               {"sample_period_s", dataset.sample_period_s},
               {"lag_removed_s", dataset.lag_removed_s},
               {"bias", {{"delay_s", plan.past.delay_s}, {"least_time_constant_s", plan.past.least_time_constant_s}}},
               {"absent", dataset.absent},
               {"mapping", pinnquad::printable(dataset.mapping)},
               {"flight", pinnquad::printable(pinnquad::flight_names(dataset.flights))},
               {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(dataset.flights))},
               {"rows", dataset.flights.rows()},
               {"flights", std::move(flights)}}},
             {"held_out", detail::printable_names(held_out)},
             {"folds", std::move(folds)},
             {"models", nlohmann::json::object()},
             {"results", nlohmann::json::array()},
             {"exported", false},
             {"not_exported_because", "the training was not finished"},
             {"warnings", nlohmann::json::array()}};
    for (const char* later :
         {"verdict", "exported_model", "exported_reach", "exported_seed", "header", "block", "trust", "certificate",
          "vehicle", "bias_time_constants_s", "altitude", "closed_loop", "guard", "response", "noise_ceiling"}) {
      json_[later] = nullptr;
    }
    json_["settings"].update(trainings);
    warn(dataset.warnings, "import: ");
  }

  /// Warnings: no reason to stop; printed on stderr too, those of one kind as one line.
  void warn(const std::vector<std::string>& texts, const std::string& from = "") {
    for (const std::string& text : verbose_ ? texts : collapsed(texts, "--verbose prints all")) {
      complain("train", "warning: " + from + text);
    }
    for (const std::string& text : texts) json_["warnings"].push_back(pinnquad::printable(from + text));
  }
  void warn(const std::string& text) { warn(std::vector<std::string>{text}); }

  void judged(const FitPlan& plan, const JudgedKinds& judgement, const std::vector<KindVerdict>& verdicts) {
    json_["rows_judged"] = judgement.rows;
    json_["results"] = detail::results_json(plan, judgement);
    for (std::size_t k = 0; k < judgement.kinds.size(); ++k) {
      const JudgedKind& kind = judgement.kinds[k];
      nlohmann::json model = {{"title", kind.kind.title},
                              {"reach", word_of(kind.kind.reach)},
                              {"seeded", kind.kind.seeded},
                              {"applicable", kind.applicable()},
                              {"not_applicable_because", nullptr}};
      if (kind.applicable()) {
        model.update(detail::figures_of(plan, kind));
        model["verdict"] = detail::verdict_json(judgement, verdicts[k]);
        nlohmann::json flights = nlohmann::json::object();
        const std::vector<double> errors = error_of_flights(kind);
        for (std::size_t i = 0; i < errors.size(); ++i) {
          flights[pinnquad::printable(judgement.flights[i])] = {{"rmse", errors[i]}};
        }
        model["by_flight"] = std::move(flights);
        model["choosing_rmse"] = choosing_error(plan, kind);
        model["validation_mae"] = described(per_seed(kind, [](const JudgedFit& fit) { return fit.validation_mae; }));
        model["training_s"] = described(per_seed(kind, [](const JudgedFit& fit) { return fit.fit_s; }));
      } else {
        model["not_applicable_because"] = pinnquad::printable(kind.not_applicable);
      }
      json_["models"][kind.kind.key] = std::move(model);
    }
    for (const bool centred : {false, true}) {
      nlohmann::json order = nlohmann::json::array();
      for (const std::size_t k : ranking(judgement, centred)) order.push_back(judgement.kinds[k].kind.key);
      json_["ranking"][centred ? "centred" : "causal"] = std::move(order);
    }
  }

  /// Of the kind that has such a choice. `asked`: of the options.
  void altitude(const AltitudeChoice& choice, std::optional<bool> asked, const std::string& why) {
    json_["altitude"] = {{"asked", !asked   ? "auto"
                                   : *asked ? "yes"
                                            : "no"},
                         {"validation_mae", choice.error_with},
                         {"validation_mae_without", choice.error_without},
                         {"taken", choice.taken},
                         {"why", why}};
  }

  /// The verdict of the rows held out on the model that was chosen.
  void verdict(const ModelKind& kind, std::optional<std::uint64_t> seed, const pinnquad::Verdict& verdict,
               bool may_be_exported) {
    json_["verdict"] = {{"model", kind.key},
                        {"seed", seed ? nlohmann::json(*seed) : nlohmann::json()},
                        {"r2", verdict.test_r_squared},
                        {"worst_motor_r2", verdict.worst_motor_r_squared},
                        {"linear_regression_r2", verdict.linear_regression_r_squared},
                        {"worse_than_mean", verdict.worse_than_mean()},
                        {"beats_linear_regression", verdict.beats_linear_regression()},
                        {"exported", may_be_exported}};
  }

  /// The words that an export's header begins with.
  void export_verdict(const FlightVerdict& found, const std::string& beside, nlohmann::json errors) {
    json_["verdict"].update(verdict_json(found));
    json_["verdict"].update({{"fit_to_fly", found.may_fly() != MayFly::no},
                             {"beside_in_words", beside},
                             {"held_out_rmse", std::move(errors)}});
  }

  /// Of what was exported.
  void certified(const pinnquad::BlockModel::ProvenSigns& signs, const pinnquad::Airframe<double>& airframe,
                 const pinnquad::SlopesOfSums& known) {
    const std::optional<pinnquad::Certificate>& structure = signs.structure;
    json_["certificate"] = {{"proven", true},
                            {"slope", by_axis(signs.held_slope)},
                            {"airframe_slope", by_axis(pinnquad::hover_slopes(airframe))},
                            {"in_words", bound_in_words(structure)}};
    for (std::size_t k = 0; k < known.size(); ++k) {
      const pinnquad::MeasuredSlope& slope = known[k];
      json_["certificate"]["known"][k == 0 ? "thrust" : axis_names[k - 1]] =
          !slope.known ? nlohmann::json()
                       : nlohmann::json{{"standard_error", slope.standard_error},
                                        {"interval_95", {slope.lower, slope.upper}},
                                        {"by", slope.smoothed() ? "smoothed rows" : "least squares"},
                                        {"least_squares", slope.least_squares},
                                        {"window_s", slope.window_s}};
    }
    if (!structure) return;
    json_["certificate"]["command_bound"] = structure->command_bound;
    json_["certificate"]["thrust_slope"] = structure->held_thrust_slope;
    json_["certificate"]["airframe_thrust_slope"] = pinnquad::hover_thrust_slope(airframe);
  }
  /// Of the bias that what was exported learns in flight, and the certificate with it.
  void bias(const pinnquad::SignedSums<double>& time_constants_s, const pinnquad::Airframe<double>& airframe) {
    json_["bias_time_constants_s"] = time_constants_s;
    if (!json_["certificate"].is_object()) return;
    json_["certificate"]["bias_widens_command_bound"] = pinnquad::largest_bias(airframe);
    json_["certificate"]["bias_in_words"] = bias_in_words(airframe);
  }
  /// Limits of trust: their file, or why there is none.
  void trusted(const std::string& file, const std::string& why_not) {
    json_["trust"] = {{"file", file.empty() ? nlohmann::json() : nlohmann::json(pinnquad::printable(file))},
                      {"why_not", why_not.empty() ? nlohmann::json() : nlohmann::json(why_not)}};
  }

  void interrupted_after(std::size_t finished, std::size_t wanted) {
    json_["fits"] = {{"finished", finished}, {"wanted", wanted}};
  }
  void write_not_exported(const std::string& reason) {
    json_["exported"] = false;
    json_["not_exported_because"] = pinnquad::printable(reason);
    write();
  }
  void write_exported(const ModelKind& kind, std::uint64_t seed, const std::string& header, const std::string& block) {
    json_["exported"] = true;
    json_["not_exported_because"] = nullptr;
    json_["exported_model"] = kind.key;
    json_["exported_reach"] = word_of(kind.reach);
    json_["exported_seed"] = seed;
    json_["header"] = pinnquad::printable(header);
    json_["block"] = pinnquad::printable(block);
    write();
  }
  /// See vehicle_json().
  void vehicle(nlohmann::json told) { json_["vehicle"] = std::move(told); }
  /// How a model does on the flights held out, as a control engineer looks at it.
  void held_out(const HeldOutDynamics& dynamics, const JudgedKinds& judged) {
    const std::string model = judged.kinds[dynamics.kind].kind.key;
    json_["guard"] = guard_json(dynamics.guard, model);
    json_["response"] = response_json(dynamics, model);
    json_["noise_ceiling"] = ceiling_json(dynamics, judged);
  }
  void flown(nlohmann::json closed_loop) { json_["closed_loop"] = std::move(closed_loop); }

  const nlohmann::json& json() const { return json_; }

  void write() const {
    pinnquad::AtomicFile file(path_);
    file.stream() << json_.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    file.commit();
  }

 private:
  std::string path_;
  bool verbose_ = false;  ///< prints all warnings
  nlohmann::json json_;
};

}  // namespace programs

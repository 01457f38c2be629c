// SPDX-License-Identifier: MIT
// report.json of a training on logs: what was held out, every model of the table with its figures and its verdict, what
// was exported, all warnings.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "pinnquad/data/dataset.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/io/file_error.hpp"
#include "pinnquad/logs/read_dataset.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"
#include "pinnquad/version.hpp"
#include "training/log_figures.hpp"
#include "training/log_verdict.hpp"

namespace programs {
namespace detail {

inline nlohmann::json by_axis(const std::array<double, 3>& values) {
  nlohmann::json result;
  for (std::size_t axis = 0; axis < 3; ++axis) result[axis_names[axis]] = values[axis];
  return result;
}

/// Figures of a kind: over all partings, and by parting.
inline nlohmann::json figures_of(const LogPlan& plan, const JudgedKind& kind) {
  nlohmann::json result, motors;
  for (const LogFigure& figure : log_figures) {
    result[figure.name] = described(over_seeds(kind, figure));
    for (std::size_t motor = 0; motor < pinnquad::rotor_count; ++motor) {
      motors["u" + std::to_string(motor + 1)][figure.name] = described(over_seeds(kind, figure, motor));
    }
  }
  result["per_motor"] = std::move(motors);
  result["by_fold"] = nlohmann::json::object();
  for (std::size_t fold = 0; fold < kind.folds(); ++fold) {
    nlohmann::json& of_fold = result["by_fold"][pinnquad::printable(plan.folds[fold].name)];
    for (const LogFigure& figure : log_figures) {
      std::vector<double> values;
      for (std::size_t seed = 0; seed < kind.seeds.size(); ++seed) {
        values.push_back(mean_over_motors(kind.at(seed, fold).errors.*figure.of));
      }
      of_fold[figure.name] = described(values);
    }
  }
  return result;
}

inline nlohmann::json slopes_json(const JudgedKind& kind, const std::array<double, 3>& nominal) {
  const KindSlopes slopes = slopes_of(kind);
  if (!slopes.applicable) return {{"not_applicable_because", "it does not look at the angular acceleration"}};
  std::array<double, 3> ratio{};
  for (std::size_t axis = 0; axis < 3; ++axis) ratio[axis] = slopes.least[axis] / nominal[axis];
  return {{"wrong_derivative_share", by_axis(slopes.wrong_share)},
          {"least_derivative", by_axis(slopes.least)},
          {"median_derivative", by_axis(slopes.median)},
          {"least_derivative_over_nominal", by_axis(ratio)}};
}

inline nlohmann::json pair_signs_json(const JudgedKind& kind) {
  const PairSigns pairs = pair_signs_of(kind);
  return {{"pair_violations", by_axis(pairs.all)},
          {"pair_violations_flown", by_axis(pairs.of_flown)},
          {"large_step_violations", by_axis(pairs.large)},
          {"large_step_violations_flown", by_axis(pairs.large_of_flown)}};
}

inline nlohmann::json compared(const pinnquad::PairedComparison& c) {
  return {{"pairs", c.pairs}, {"lower", c.wins}, {"relative_difference", c.relative_difference}, {"p", c.p_value}};
}

inline nlohmann::json verdict_json(const LogJudgement& judged, const LogVerdict& verdict) {
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

/// Builds report.json; a training that fails later leaves what was written last.
class LogReport {
 public:
  LogReport(std::string path, const LogPlan& plan, const pinnquad::logs::ImportedDataset& dataset)
      : path_(std::move(path)) {
    nlohmann::json flights = nlohmann::json::array(), folds = nlohmann::json::array();
    for (const pinnquad::Flight& flight : dataset.flights.flights()) {
      flights.push_back({{"flight", pinnquad::printable(flight.name)},
                         {"trajectory", pinnquad::printable(flight.trajectory)},
                         {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(flight))},
                         {"rows", flight.size()}});
    }
    std::vector<std::string> held_out;
    for (const Fold& fold : plan.folds) {
      held_out.insert(held_out.end(), fold.held_out.begin(), fold.held_out.end());
      folds.push_back({{"fold", pinnquad::printable(fold.name)},
                       {"held_out", detail::printable_names(fold.held_out)},
                       {"validation", detail::printable_names(fold.validation)},
                       {"train", detail::printable_names(fold.train)},
                       {"rows",
                        {{"train", fold.split.train.size()},
                         {"validation", fold.split.validation.size()},
                         {"held_out", fold.split.test.size()}}}});
    }
    json_ = {{"settings",
              {{"version", PINNQUAD_VERSION},
               {"airframe", plan.airframe.name},
               {"first_seed", plan.first_seed},
               {"seeds", plan.seeds},
               {"epochs", plan.epochs > 0 ? nlohmann::json(plan.epochs) : nlohmann::json("what suits each kind")},
               {"sample_period_s", dataset.sample_period_s},
               {"lag_removed_s", dataset.lag_removed_s},
               {"absent", dataset.absent},
               {"mapping", pinnquad::printable(dataset.mapping)},
               {"flight_hash", pinnquad::hexadecimal(pinnquad::content_hash(dataset.flights))},
               {"rows", dataset.flights.rows()},
               {"flights", std::move(flights)}}},
             {"held_out", detail::printable_names(held_out)},
             {"folds", std::move(folds)},
             {"models", nlohmann::json::object()},
             {"exported", false},
             {"not_exported_because", "the training was not finished"},
             {"exported_model", nullptr},
             {"header", nullptr},
             {"block", nullptr},
             {"warnings", nlohmann::json::array()}};
    for (const std::string& warning : dataset.warnings) {
      json_["warnings"].push_back("import: " + pinnquad::printable(warning));
    }
  }

  /// A warning: no reason to stop; printed on stderr too.
  void warn(const std::string& text) {
    std::fprintf(stderr, "train: warning: %s\n", pinnquad::printable(text).c_str());
    json_["warnings"].push_back(pinnquad::printable(text));
  }

  void judged(const LogPlan& plan, const LogJudgement& judgement, const std::vector<LogVerdict>& verdicts) {
    const std::array<double, 3> nominal = pinnquad::hover_slopes(plan.airframe.value);
    json_["rows_judged"] = judgement.rows;
    for (std::size_t k = 0; k < judgement.kinds.size(); ++k) {
      const JudgedKind& kind = judgement.kinds[k];
      nlohmann::json model = {{"title", kind.kind.title},
                              {"reach", word_of(kind.kind.reach)},
                              {"seeded", kind.kind.seeded},
                              {"applicable", kind.applicable()},
                              {"not_applicable_because", nullptr}};
      if (kind.applicable()) {
        model.update(detail::figures_of(plan, kind));
        model["slopes"] = detail::slopes_json(kind, nominal);
        model["pairs"] = detail::pair_signs_json(kind);
        model["verdict"] = detail::verdict_json(judgement, verdicts[k]);
        nlohmann::json flights = nlohmann::json::object();
        const std::vector<double> errors = error_of_flights(kind);
        for (std::size_t i = 0; i < errors.size(); ++i) {
          flights[pinnquad::printable(judgement.flights[i])] = {{"rmse", errors[i]}};
        }
        model["by_flight"] = std::move(flights);
        model["validation_rmse"] = described(per_seed(kind, [](const JudgedFit& fit) { return fit.validation_error; }));
        model["fit_s"] = described(per_seed(kind, [](const JudgedFit& fit) { return fit.fit_s; }));
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

  void interrupted_after(std::size_t finished, std::size_t wanted) {
    json_["fits"] = {{"finished", finished}, {"wanted", wanted}};
  }
  void write_not_exported(const std::string& reason) {
    json_["exported"] = false;
    json_["not_exported_because"] = pinnquad::printable(reason);
    write();
  }
  /// `block`: empty where none was asked for.
  void write_exported(const LogModelKind& kind, std::uint64_t seed, const std::string& header,
                      const std::string& block) {
    json_["exported"] = true;
    json_["not_exported_because"] = nullptr;
    json_["exported_model"] = kind.key;
    json_["exported_reach"] = word_of(kind.reach);
    json_["exported_seed"] = seed;
    json_["header"] = pinnquad::printable(header);
    json_["block"] = block.empty() ? nlohmann::json() : nlohmann::json(pinnquad::printable(block));
    write();
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
  nlohmann::json json_;
};

}  // namespace programs

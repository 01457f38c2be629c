// SPDX-License-Identifier: MIT
// The models of `pinnquad train` on flights in memory: fitted, judged, and exported where Python asks for it. The same
// flights, seeds and epochs give the bytes that the command writes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "command_line/in_words.hpp"
#include "pinnquad/control/flown_motion.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "python/interruptible.hpp"
#include "python/json.hpp"
#include "training/beside_others.hpp"
#include "training/export_choice.hpp"
#include "training/given_vehicle.hpp"
#include "training/held_out_dynamics.hpp"
#include "training/kind_figures.hpp"
#include "training/log_kinds.hpp"
#include "training/train_input.hpp"

namespace python {

namespace {

using pinnquad::logs::ImportedDataset;
using programs::JudgedKind;

struct TrainChoices {
  std::vector<std::string> models, hold_out;
  int seeds = 5, epochs = 0;
  std::uint64_t seed = 1;
  std::optional<bool> altitude;
  bool pinned_slopes = false;
  std::optional<double> lag_s;
  unsigned threads = 0;
};

/// One training, from flights to a judged model that can be exported.
class Training {
 public:
  Training(ImportedDataset dataset, NamedAirframe airframe, const TrainChoices& choices)
      : dataset_(std::move(dataset)),
        airframe_(std::move(airframe)),
        selection_(programs::selection_of({programs::log_structured()}, choices.models, true, choices.epochs)),
        plan_(plan_of(choices)) {
    fits_ = programs::fit_all(plan_);
    programs::stop_if_interrupted();
    judged_ = programs::judge_fits(plan_, fits_);
    // exported() may ask for the best proven kind (causal): of those that Python trains, the structured one
    const std::string key = selection_.has("structured") ? "structured" : selection_.exported();
    while (chosen_ < plan_.kinds.size() && key != plan_.kinds[chosen_].key) ++chosen_;
    if (chosen_ == plan_.kinds.size() || !judged().applicable()) {
      throw std::invalid_argument("no model to export: " + (chosen_ == plan_.kinds.size()
                                                                ? std::string("none of `models` may be exported")
                                                                : judged().not_applicable));
    }
    fit_ = programs::best_fit(fits_.finished, chosen_, kind().takes_validation(plan_.settings));
    if (fit_ == nullptr) throw std::invalid_argument("no fit has a finite error on the validation rows");
    verdict_ = programs::exported_verdict(plan_, judged_, chosen_, fit_->seed);
    verdict_.answered_share = programs::guard_of_seed(fits_, chosen_, fit_->seed).answered_share();
    model_ = std::make_shared<pinnquad::BlockModel>("trained",
                                                    fit_->model->block_with(plan_.folds.front().split, provenance()));
  }

  std::shared_ptr<pinnquad::BlockModel> model() const { return model_; }
  const programs::ModelKind& kind() const { return plan_.kinds[chosen_]; }
  std::uint64_t seed() const { return fit_->seed; }
  const pinnquad::Verdict& verdict() const { return verdict_; }

  /// Figures of each kind on the rows held out, as `models` of report.json has them.
  nlohmann::json figures() const {
    nlohmann::json all = nlohmann::json::object();
    for (const JudgedKind& of : judged_.kinds) {
      nlohmann::json& figures = all[of.kind.key] = {{"title", of.kind.title}, {"applicable", of.applicable()}};
      if (!of.applicable()) {
        figures["not_applicable_because"] = of.not_applicable;
        continue;
      }
      for (const programs::ErrorFigure& figure : programs::error_figures) {
        figures[figure.name] = programs::described(programs::over_seeds(of, figure));
      }
      for (const programs::ModelFigure& figure : programs::model_figures) {
        for (std::size_t axis = 0; figure.has_axes && axis < programs::axis_names.size(); ++axis) {
          figures[figure.name][programs::axis_names[axis]] =
              programs::described(programs::over_seeds(of, figure, axis));
        }
      }
    }
    return all;
  }

  /// model.hpp, model.block and, where there are limits, trust.hpp. Throws std::invalid_argument for a model that is
  /// worse than the mean of the commands, unless `allow_poor`.
  pinnquad::Exported save(const std::string& folder, const std::string& name, bool allow_poor) const {
    pinnquad::require_identifier("name", name);
    if (verdict_.worse_than_mean() && !allow_poor) {
      throw std::invalid_argument(std::string(kind().title) +
                                  " is worse than the mean of the commands on the rows held out: allow_poor=True "
                                  "exports it, marked");
    }
    std::filesystem::create_directories(folder);
    const pinnquad::Exported::Files files{folder + "/model.hpp", folder + "/model.block",
                                          fit_->model->has_trust() ? folder + "/trust.hpp" : ""};
    pinnquad::Provenance from = provenance();
    from.fitness = programs::fitness_in_words(flight_verdict());
    from.beside = programs::in_words(others(), judged_, chosen_);
    pinnquad::Exported written = fit_->model->export_to(files, name, plan_.folds.front().split, from);
    std::error_code ignored;
    if (files.trust.empty()) std::filesystem::remove(folder + "/trust.hpp", ignored);  // another model's
    return written;
  }

  /// As the program's training finds it of an airframe that was given; flown and compared when it is first asked for.
  const programs::FlightVerdict& flight_verdict() const {
    if (!found_) {
      programs::FlownTraces unseen;
      const nlohmann::json flown =
          programs::fly_given(*fit_->model->block(), plan_.folds.front().split.train, airframe_.value, unseen);
      found_ = programs::model_verdict(
          programs::evidence_of(*fit_->model, judged_, chosen_, verdict_, flown, others(), true));
    }
    return *found_;
  }

 private:
  const JudgedKind& judged() const { return judged_.kinds[chosen_]; }

  const programs::BesideOthers& others() const {
    if (!others_) others_ = programs::beside_others(plan_, judged_, chosen_);
    return *others_;
  }

  pinnquad::Provenance provenance() const {
    return programs::provenance_of(
        *fit_->model,
        programs::provenance_of(plan_.folds.front(), dataset_.flights, dataset_.lag_removed_s, kind(), plan_.settings,
                                fit_->seed, plan_.epochs, verdict_),
        judged().bias_time_constants_s, true);
  }

  bool is_imported() const { return !dataset_.mapping.empty(); }

  programs::FitPlan plan_of(const TrainChoices& choices) {
    programs::TrainOptions options;  // what the checks of the command ask
    for (const pinnquad::Flight& flight : dataset_.flights.flights()) options.flights.push_back(flight.name);
    options.altitude = choices.altitude;
    options.pinned_slopes = choices.pinned_slopes;
    programs::require_structured(options, selection_);
    if (is_imported()) {
      if (choices.lag_s) throw std::invalid_argument("lag_s: a dataset was imported with one");
    } else {
      const pinnquad::RowSet all = pinnquad::all_rows(dataset_.flights.flights());
      if (all.size() < programs::fewest_flight_rows) {
        throw std::invalid_argument("expected " + std::to_string(programs::fewest_flight_rows) +
                                    " rows or more to train on, found " + std::to_string(all.size()));
      }
      dataset_.sample_period_s = pinnquad::sample_period_s(all);
      programs::remove_latency(dataset_, airframe_.value, choices.lag_s);
    }
    std::vector<programs::Fold> folds;
    if (choices.hold_out.empty()) {
      folds.push_back(programs::fold_in_order(dataset_.flights));
    } else {
      folds = programs::folds_of(dataset_.flights, {choices.hold_out, {}, {}, dataset_.unlike});
    }
    programs::require_sound(options, dataset_, folds);
    bool known_by_name = false;
    programs::with_airframe(airframe_.name, [&](auto tag) {
      using Vehicle = typename decltype(tag)::type;
      known_by_name = pinnquad::logs::same_numbers(pinnquad::airframe_value<Vehicle, double>(), airframe_.value);
    });
    return {airframe_,
            selection_.kinds,
            std::move(folds),
            dataset_.absent,
            dataset_.sample_period_s,
            choices.seed,
            choices.seeds,
            is_imported() ? choices.epochs : selection_.epochs,
            choices.threads > 0 ? choices.threads : std::max(1u, std::thread::hardware_concurrency()),
            {known_by_name, choices.altitude, choices.pinned_slopes, is_imported()},
            programs::past_rows_of(dataset_, airframe_.value, is_imported()),
            false};
  }

  ImportedDataset dataset_;  ///< its rows are what plan and fits look at: a Training never moves
  NamedAirframe airframe_;
  programs::Selection selection_;
  programs::FitPlan plan_;
  programs::Fits fits_;
  programs::JudgedKinds judged_;
  std::size_t chosen_ = 0;
  const programs::FinishedFit* fit_ = nullptr;
  pinnquad::Verdict verdict_;
  std::shared_ptr<pinnquad::BlockModel> model_;
  mutable std::optional<programs::BesideOthers> others_;
  mutable std::optional<programs::FlightVerdict> found_;
};

std::unique_ptr<Training> train(const py::object& flights, const py::object& airframe, const TrainChoices& choices) {
  ImportedDataset dataset;
  if (py::isinstance<ImportedDataset>(flights)) {
    dataset = flights.cast<const ImportedDataset&>();
  } else {
    dataset.flights = *dataset_of(flights);
  }
  std::unique_ptr<Training> training;
  const NamedAirframe chosen = airframe_of(airframe);
  run_interruptible([&] { training = std::make_unique<Training>(std::move(dataset), chosen, choices); });
  return training;
}

}  // namespace

void bind_training(py::module_& module) {
  py::class_<Training> training(module, "Training",
                                "Models that were fitted and judged, and the one that is exported.");
  training.def_property_readonly("model", &Training::model, "The exported kind's best fit.")
      .def_property_readonly(
          "kind", [](const Training& self) { return self.kind().key; }, "Its key: 'structured' ...")
      .def_property_readonly("seed", &Training::seed, "Its seed.")
      .def_property_readonly(
          "r2", [](const Training& self) { return self.verdict().test_r_squared; },
          "Coefficient of determination of the commands on the rows held out.")
      .def_property_readonly(
          "linear_regression_r2", [](const Training& self) { return self.verdict().linear_regression_r_squared; },
          "The same of linear regression on the paper's features.")
      .def_property_readonly(
          "figures", [](const Training& self) { return to_python(self.figures()); },
          "Of every kind, as `models` of report.json (docs/report.md).")
      .def(
          "save",
          [](const Training& self, const std::filesystem::path& folder, const std::string& name, bool allow_poor) {
            self.save(folder.string(), name, allow_poor);
            std::vector<std::string> files = {folder / "model.hpp", folder / "model.block"};
            if (std::filesystem::exists(folder / "trust.hpp")) files.push_back(folder / "trust.hpp");
            return files;
          },
          py::arg("folder"), py::arg("name") = "TrainedQuadModel", py::kw_only(), py::arg("allow_poor") = false,
          "Writes model.hpp (struct `name`), model.block and, where there are limits, trust.hpp: all or none.\n"
          "The paths. ValueError for a model that is worse than the mean of the commands.")
      .def_property_readonly("_flight_verdict",
                             [](const Training& self) { return to_python(verdict_json(self.flight_verdict())); })
      .def("_words", [](const Training& self) {
        return programs::in_words("<pinnquad.Training: %s of seed %llu, R^2 %.4f>", self.kind().key,
                                  static_cast<unsigned long long>(self.seed()), self.verdict().test_r_squared);
      });
  refuse_new(training);
  module.def(
      "train",
      [](const py::object& flights, const py::object& airframe, const std::vector<std::string>& models, int seeds,
         const std::optional<int>& epochs, std::uint64_t seed, const std::vector<std::string>& hold_out,
         const std::optional<bool>& altitude, const std::string& slopes, const std::optional<double>& lag_s,
         const std::optional<int>& threads) {
        if (slopes != "learned" && slopes != "pinned") {
          refuse_name("slopes", slopes, std::array<const char*, 2>{"learned", "pinned"});
        }
        if (seeds < 1 || seeds > static_cast<int>(pinnquad::most_pairs)) {
          throw py::value_error("seeds must be 1 to " + std::to_string(pinnquad::most_pairs));
        }
        if (epochs && (*epochs < 1 || *epochs > 100000)) {
          throw py::value_error("epochs must be 1 to 100000, or None for what suits");
        }
        if (threads && (*threads < 1 || *threads > 1024)) {
          throw py::value_error("threads must be 1 to 1024, or None for all cores");
        }
        if (lag_s) checked("lag_s", std::abs(*lag_s), 0);
        return train(flights, airframe,
                     {models, hold_out, seeds, epochs.value_or(0), seed, altitude, slopes == "pinned", lag_s,
                      static_cast<unsigned>(threads.value_or(0))});
      },
      py::arg("flights"), py::arg("airframe") = pinnquad::PaperQuadrotor::name, py::kw_only(),
      py::arg("models") = programs::flight_models, py::arg("seeds").noconvert() = 5,
      py::arg("epochs").noconvert() = py::none(), py::arg("seed").noconvert() = 1,
      py::arg("hold_out") = std::vector<std::string>{}, py::arg("altitude") = py::none(), py::arg("slopes") = "learned",
      py::arg("lag_s") = py::none(), py::arg("threads").noconvert() = py::none(),
      "As `pinnquad train FLIGHTS`, on flights in memory, and with its bytes.\n\n"
      "flights    a Dataset, a Flight or a list of them; one: its last fifth is held out, of three or more the last\n"
      "airframe   what flew: an Airframe, a name, or a TOML file\n"
      "models     what is compared: 'structured' (proven, and exported where it is named), 'formula', and the "
      "networks\n"
      "           'paper_vanilla' ...: paper, best or small before vanilla, physics_informed, constant_weight or "
      "pearson\n"
      "seeds, epochs, seed, threads   fits per kind; None: the epochs that suit; the first seed; None: all cores\n"
      "hold_out   names of flights or trajectories that judge, in place of the last\n"
      "altitude   is the structured model shown it? None: where the validation rows gain by it\n"
      "slopes     'learned', or 'pinned' to the airframe's in hover\n"
      "lag_s      from command to motion, s, to be removed; None: estimated, and of an imported dataset none\n\n"
      "Other threads run meanwhile; Ctrl-C ends it, and nothing is kept.");
}

}  // namespace python

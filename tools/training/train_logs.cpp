// SPDX-License-Identifier: MIT
// Trains on flights of a real vehicle and says honestly what came of it.
//   pinnquad train --dataset DIR --hold-out-each trajectory --seeds 5 --out OUT
//   pinnquad train --log DIR --mapping px4 --hold-out flight7 --out OUT
#include "training/train_logs.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "airframe/choice.hpp"
#include "command_line/console.hpp"
#include "command_line/file_roles.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/interrupt.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "training/log_export.hpp"
#include "training/log_fit_store.hpp"
#include "training/log_flight.hpp"
#include "training/log_input.hpp"
#include "training/log_page.hpp"
#include "training/log_report.hpp"
#include "training/log_table.hpp"
#include "training/log_watch.hpp"

namespace {

using namespace pinnquad;
using programs::LogTrainingOptions;

/// The files of --out.
constexpr std::array<const char*, 5> log_output_names = {"report.json", "report.html", "model.hpp", "model.block",
                                                         "replay.txt"};

void require_separate_files(const LogTrainingOptions& options) {
  programs::FileRoles roles;
  for (const std::string& path : options.logs) roles.reads("--log", path);
  roles.reads("--dataset", options.dataset);
  if (programs::is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  roles.writes("--out", options.out);
  for (const char* name : log_output_names) roles.writes("--out", options.out + "/" + name);
}

std::string decimals(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// Fits, judges, exports: one run of the command.
class LogTraining {
 public:
  LogTraining(const LogTrainingOptions& options, const pinnquad::logs::ImportedDataset& dataset,
              const programs::NamedAirframe& airframe, std::vector<programs::Fold> folds)
      : options_(options),
        dataset_(dataset),
        plan_{airframe,
              programs::chosen_kinds(options.models),
              std::move(folds),
              dataset.absent,
              dataset.sample_period_s,
              options.seed,
              options.seeds,
              options.epochs,
              options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency())},
        report_(options.out + "/report.json", plan_, dataset) {}

  int run() {
    warn_of_the_setting();
    std::printf("[2/5] fit %zu kinds of models, %d seeds\n", plan_.kinds.size(), plan_.seeds);
    std::fflush(stdout);
    const programs::LogFitStore store(options_.out + "/fits", plan_);
    int code = 0;
    try {
      fit(store);
      code = judge_and_export();
    } catch (const programs::Interrupted&) {
      report_.write_not_exported("interrupted");
      throw programs::Interrupted{kept()};
    }
    std::printf("[5/5] report\n");
    std::fflush(stdout);
    programs::keeping(kept(), [&] { write_page(); });
    store.clear();
    return code;
  }

 private:
  void fit(const programs::LogFitStore& store) {
    fits_ = programs::fit_all(
        plan_,
        [&](programs::FinishedFit& job) {
          const bool found = store.load(job);
          if (found) ++known_;
          return found;
        },
        [&](const programs::FinishedFit& job) { store.keep(job); });
    if (known_ > 0) {
      std::printf("      %zu of %zu fits were finished by an earlier run\n", known_.load(), fits_.wanted);
    }
    report_.interrupted_after(fits_.finished.size(), fits_.wanted);
    if (fits_.finished.size() < fits_.wanted) programs::stop_if_interrupted();
  }

  int judge_and_export() {
    std::printf("[3/5] judge\n");
    judged_ = programs::judge_fits(plan_, fits_);
    verdicts_ = programs::verdicts_on(judged_);
    programs::print_log_table(plan_, judged_, verdicts_);
    std::fflush(stdout);
    report_.judged(plan_, judged_, verdicts_);
    return export_best();
  }

  bool rotated() const { return !options_.hold_out_each.empty(); }

  void warn_of_the_setting() {
    if (options_.airframe.empty()) {
      report_.warn("no --airframe: the linearized model and the nominal slopes are those of " + plan_.airframe.name +
                   ", which is not what flew");
    }
    for (const programs::Fold& fold : plan_.folds) {
      if (fold.part_validates) {
        report_.warn("holding out " + fold.name +
                     " leaves one trajectory: its last fifth validates, no flight of its own");
      }
    }
    if (judges() < programs::fewest_pairs) {
      report_.warn("paired tests over " + std::to_string(judges()) + " held-out flights can't decide: fewer than " +
                   std::to_string(programs::fewest_pairs) + "; --hold-out-each judges by more");
    }
  }

  std::size_t judges() const {
    std::size_t flights = 0;
    for (const programs::Fold& fold : plan_.folds) flights += fold.held_out.size();
    return flights;
  }

  std::string kept() const {
    return std::to_string(fits_.finished.size()) + " of " + std::to_string(fits_.wanted) +
           " fits are finished and kept in " + options_.out + "/fits: the same command goes on from there";
  }

  int refuse(const std::string& reason, int code) {
    report_.write_not_exported(reason);
    told_ = "Nothing was exported: " + reason + ".";
    std::string earlier;
    for (const std::string& path :
         {options_.out + "/model.hpp", options_.out + "/replay.txt", options_.out + "/model.block"}) {
      std::error_code ignored;
      if (!path.empty() && std::filesystem::exists(path, ignored))
        earlier += (earlier.empty() ? "; of an earlier training: " : ", ") + path;
    }
    programs::complain("train", "not exported: " + reason + earlier);
    return code;
  }

  struct Exported {
    std::shared_ptr<const programs::TrainedNetwork> model;
    std::uint64_t seed = 0;
    const programs::Fold* fold = nullptr;
    nlohmann::json flown;  ///< what came of the closed loop
  };

  int export_best() {
    const std::vector<std::size_t> order = programs::kinds_to_export(judged_, options_.export_choice, rotated());
    if (order.empty()) return refuse("no model of the kind asked for was judged", programs::exit_failed);
    chosen_ = order.front();
    if (programs::exported_verdict(judged_, *chosen_).worse_than_mean() && !options_.allow_poor) {
      const programs::JudgedKind& kind = judged_.kinds[*chosen_];
      return refuse(std::string(kind.kind.title) +
                        ", the best, is worse on the held-out flights than the mean of their commands (R^2 " +
                        decimals(programs::exported_verdict(judged_, *chosen_).test_r_squared, 4) +
                        "); --allow-poor exports it, marked",
                    programs::exit_failed);
    }
    report_.write_not_exported("the export was not finished");
    std::optional<Exported> made;
    for (const std::size_t k : order) {
      if (k != order.front() && programs::exported_verdict(judged_, k).worse_than_mean()) continue;
      Exported next = exported(k);
      next.flown = fly(next, judged_.kinds[k].kind);
      const bool lost = programs::lost_vehicle(next.flown);
      if (lost) {
        report_.warn(std::string(judged_.kinds[k].kind.title) + " loses the vehicle in the closed loop (" +
                     decimals(next.flown["model"]["largest_error_m"], 1) + " m off): not fit to fly" +
                     (k != order.back() ? "; the next best is tried" : ""));
      }
      if (!lost || !made) {
        made = std::move(next);
        chosen_ = k;
      }
      if (!lost) break;
    }
    if (order.size() > 1 && programs::lost_vehicle(made->flown)) {
      report_.warn(
          "every model loses the vehicle in the closed loop: what is exported is the best by its figures alone");
    }
    write_with_warnings(*made);
    return 0;
  }

  void write_with_warnings(const Exported& made) {
    const programs::JudgedKind& kind = judged_.kinds[*chosen_];
    const Verdict verdict = programs::exported_verdict(judged_, *chosen_);
    const programs::LogVerdict& beside_simpler = verdicts_[*chosen_];
    if (beside_simpler.standing != programs::Standing::success &&
        beside_simpler.standing != programs::Standing::reference) {
      report_.warn(std::string("what is exported, ") + kind.kind.title + ": " + beside_simpler.sentence);
    }
    if (verdict.has_poor_motor()) {
      report_.warn("one motor's commands are predicted worse than by their mean (R^2 " +
                   decimals(verdict.worst_motor_r_squared, 4) + " on the held-out flights)");
    }
    if (kind.kind.reach == programs::TimeReach::centred) {
      report_.warn(std::string(kind.kind.title) + " looks ahead: it takes planned trajectories, not measured motion");
    }
    std::printf("[4/5] export %s\n", kind.kind.title);
    std::fflush(stdout);
    write(made, kind.kind, verdict);
  }

  /// The model to write: after a rotation fitted to all flights, else that of the best seed.
  Exported exported(std::size_t kind) {
    if (rotated()) {
      all_ = programs::fold_of_all(dataset_.flights);
      programs::LogPlan once = plan_;
      once.kinds = {plan_.kinds[kind]};
      once.folds = {*all_};
      if (once.kinds.front().takes_validation) once.seeds = 1;
      all_fits_ = programs::fit_all(
          once, [](programs::FinishedFit&) { return false; }, [](const programs::FinishedFit&) {});
      if (all_fits_.finished.size() < all_fits_.wanted) programs::stop_if_interrupted();
      const programs::FinishedFit* best =
          programs::best_fit(all_fits_.finished, 0, once.kinds.front().takes_validation);
      if (best == nullptr)
        throw std::invalid_argument("the fit to all flights has no finite error on " + all_->validation.front());
      return Exported{best->model, best->seed, &*all_, {}};
    }
    const programs::FinishedFit* best = programs::best_fit(fits_.finished, kind, plan_.kinds[kind].takes_validation);
    if (best == nullptr) throw std::invalid_argument("no fit has a finite error on the validation rows");
    programs::FinishedFit again = *best;
    if (!again.model) programs::fit_one(plan_, again);  // known from an earlier run: the same once more
    return Exported{again.model, again.seed, &plan_.folds[again.fold], {}};
  }

  void write(const Exported& made, const programs::LogModelKind& kind, const Verdict& verdict) {
    const Provenance from = programs::provenance_of(*made.fold, dataset_.flights, dataset_.lag_removed_s, kind,
                                                    made.seed, options_.epochs, verdict);
    const std::string header = options_.out + "/model.hpp", block = options_.out + "/model.block";
    const std::size_t block_bytes =
        made.model->export_to({header, block, {}}, options_.model_name, made.fold->split, from).block_bytes;
    made.model->write_replay(options_.out + "/replay.txt",
                             made.fold->split.test.empty() ? made.fold->split.validation : made.fold->split.test);
    std::printf("  %s: struct %s, %s%s%s\n", header.c_str(), options_.model_name.c_str(), kind.title,
                kind.seeded ? (" of seed " + std::to_string(made.seed)).c_str() : "",
                verdict.worse_than_mean() ? "; NOT FOR FLIGHT, and its header says so" : "");
    std::printf("  %s: the same weights as a block of %zu bytes\n", block.c_str(), block_bytes);
    tell_flight(made.flown);
    report_.write_exported(kind, made.seed, header, block);
    told_ = "Exported as " + header + ", struct " + options_.model_name + ", " +
            (rotated() ? "fitted anew to all flights, validated on " + made.fold->validation.front() +
                             ": the figures are of the fits of the rotation"
                       : "the very model that was judged") +
            (verdict.worse_than_mean() ? ". NOT FOR FLIGHT: worse than the mean of the commands." : ".");
  }

  /// The model in a closed loop on the vehicle that the logs show; what looks ahead is not flown on measured motion.
  nlohmann::json fly(const Exported& made, const programs::LogModelKind& kind) const {
    if (kind.reach == programs::TimeReach::centred) return {};
    return programs::fly_logged(made.model, kind.reach, made.fold->split.train, plan_.airframe,
                                programs::axis_signs(plan_.airframe), !dataset_.lacks("velocity"));
  }

  void tell_flight(const nlohmann::json& flown) {
    if (flown.is_null()) return;
    report_.flown(flown);
    if (flown.contains("why_not")) {
      report_.warn("the model was not flown: " + flown["why_not"].get<std::string>());
      return;
    }
    const auto centimetres = [&](const char* who) { return decimals(100 * flown[who]["rmse_m"].get<double>(), 1); };
    std::printf(
        "  flown on the vehicle that the logs show, figure-eight of %.1f s: %s cm off; by the analytic inverse %s, "
        "without feed-forward %s\n",
        flown["period_s"].get<double>(), centimetres("model").c_str(), centimetres("formula").c_str(),
        centimetres("hover_trim").c_str());
    const std::string status = flown["model"]["status"];
    if (status != to_string(Status::ok)) {
      report_.warn("in the closed loop the model ended the flight after " + decimals(flown["model"]["flown_s"], 1) +
                   " s: " + status);
    } else if (flown["model"]["rmse_m"] > flown["hover_trim"]["rmse_m"]) {
      report_.warn("in the closed loop the model tracks worse than no feed-forward (" + centimetres("model") +
                   " cm against " + centimetres("hover_trim") + " cm)");
    }
  }

  /// The page, and one to watch each held-out flight in 3D where that is built.
  void write_page() {
    programs::LogPageInput input{plan_, dataset_, fits_, judged_, verdicts_, report_.json(), chosen_, told_, {}};
    if (programs::WatchPage::available()) {
      programs::ProgressLine progress("flights to watch");
      for (const std::string& name : judged_.flights) {
        progress.update(static_cast<double>(input.watched.size()) / static_cast<double>(judged_.flights.size()));
        const std::string file = "watch-" + std::to_string(input.watched.size() + 1) + ".html";
        for (const Flight& flight : dataset_.flights.flights()) {
          if (flight.name == name)
            programs::write_watched_log(options_.out + "/" + file, flight, dataset_, plan_.airframe.value);
        }
        input.watched[name] = file;
      }
    }
    AtomicFile file(options_.out + "/report.html");
    file.stream() << programs::log_page(input);
    file.commit();
    std::printf("  %s/report.html\n", options_.out.c_str());
  }

  const LogTrainingOptions& options_;
  const pinnquad::logs::ImportedDataset& dataset_;
  programs::LogPlan plan_;
  programs::LogReport report_;
  std::atomic<std::size_t> known_{0};
  programs::LogFits fits_, all_fits_;
  std::optional<programs::Fold> all_;
  programs::LogJudgement judged_;
  std::vector<programs::LogVerdict> verdicts_;
  std::optional<std::size_t> chosen_;
  std::string told_;  ///< what became of the export
};

}  // namespace

int programs::train_on_logs(const LogTrainingOptions& options) {
  if (!is_identifier(options.model_name)) {
    throw std::invalid_argument("--name " + options.model_name +
                                ": a C++ identifier was expected, no keyword and no name that C++ reserves");
  }
  require_separate_files(options);
  require_known_export(options.export_choice, chosen_kinds(options.models));
  std::optional<NamedAirframe> given;
  if (!options.airframe.empty()) given = chosen_airframe(options.airframe);
  const NamedAirframe airframe = given ? *given : chosen_airframe(PaperQuadrotor::name);
  std::printf("[1/5] read\n");
  std::fflush(stdout);
  const pinnquad::logs::ImportedDataset dataset = dataset_of(options);
  const std::string folder = options.logs.empty() ? options.dataset : options.out + "/dataset";
  std::vector<Fold> folds = folds_of(dataset.flights, hold_out_of(options, dataset));
  require_sound(folder, dataset, folds);
  const FolderLock lock(options.out);
  if (!options.logs.empty()) write_dataset_folder(folder, dataset);
  for (const char* name : log_output_names) AtomicFile probe(options.out + "/" + name);
  std::printf("      %zu rows of %zu flights\n", dataset.flights.rows(), dataset.flights.size());
  print_folds(folds);
  return LogTraining(options, dataset, airframe, std::move(folds)).run();
}

// SPDX-License-Identifier: MIT
// Trains on flights, and says honestly what came of it.
#include "training/train_run.hpp"

#include <algorithm>
#include <array>
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
#include "command_line/flight_verdict.hpp"
#include "command_line/folder_lock.hpp"
#include "command_line/interrupt.hpp"
#include "command_line/listed.hpp"
#include "logs/command_curve.hpp"
#include "logs/vehicle_check.hpp"
#include "pinnquad/deploy/cpp_text.hpp"
#include "pinnquad/deploy/opening_comment.hpp"
#include "training/beside_others.hpp"
#include "training/closed_loop.hpp"
#include "training/export_choice.hpp"
#include "training/fit_store.hpp"
#include "training/flown_vehicle.hpp"
#include "training/given_vehicle.hpp"
#include "training/inputs_code.hpp"
#include "training/train_input.hpp"
#include "training/training_page.hpp"
#include "training/training_report.hpp"
#include "training/training_table.hpp"
#include "training/watched_flight.hpp"

namespace {

using namespace pinnquad;
using programs::decimals;
using programs::thousandths;
using programs::TrainOptions;

/// Of an export; the others of --out are written whatever comes of it.
constexpr std::array<const char*, 4> export_names = {"model.hpp", "model.block", "trust.hpp", "replay.txt"};
constexpr std::array<const char*, 3> output_names = {"results.csv", "report.json", "report.html"};

template <class Use>
void each_output(const TrainOptions& options, const Use& use) {
  for (const char* name : output_names) use(options.out + "/" + name);
  for (const char* name : export_names) use(options.out + "/" + name);
}

/// No output takes the place of an input or of another output.
void require_separate_files(const TrainOptions& options) {
  programs::FileRoles roles;
  for (const std::string& path : options.flights) roles.reads("FLIGHTS", path);
  for (const std::string& path : options.logs) roles.reads("FLIGHTS", path);
  if (!options.dataset.empty()) roles.reads("FLIGHTS", options.dataset);
  if (programs::is_airframe_file(options.airframe)) roles.reads("--airframe", options.airframe);
  roles.writes("--out", options.out);
  each_output(options, [&roles](const std::string& path) { roles.writes("--out", path); });
}

void announce(const std::string& step) {
  programs::print_line(step, 0);
  std::fflush(stdout);
}

/// Of an airframe that is neither given nor identified a warning tells more.
void print_vehicle(const programs::FlownVehicle& vehicle) {
  if (!vehicle.is_known()) return;
  const programs::IdentifiedVehicle& asked = *vehicle.asked;
  programs::print_message(
      "vehicle " + (vehicle.identified() ? "identified: " + programs::identified_in_words(asked.found)
                                         : "not identified: " + printable(asked.why_not)),
      6);
}

/// Fits, judges, exports: one run of the command.
class Training {
 public:
  Training(const TrainOptions& options, const programs::Selection& selection,
           const pinnquad::logs::ImportedDataset& dataset, const programs::FlownVehicle& vehicle,
           std::vector<programs::Fold> folds)
      : options_(options),
        selection_(selection),
        dataset_(dataset),
        vehicle_(vehicle),
        plan_{vehicle.airframe,
              selection.kinds,
              std::move(folds),
              dataset.absent,
              dataset.sample_period_s,
              options.seed,
              options.seeds,
              selection.epochs,
              options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency()),
              {vehicle.given && !programs::is_airframe_file(options.airframe), options.altitude, options.pinned_slopes,
               options.flights.empty()},
              programs::past_rows_of(dataset, vehicle.airframe.value, options.flights.empty())},
        report_(options.out + "/report.json", plan_, dataset, facts_of_trainings(), options.verbose) {
    report_.vehicle(programs::vehicle_json(vehicle));
  }

  int run() {
    warn_of_the_setting();
    announce("[2/5] fit " + std::to_string(plan_.kinds.size()) + " kinds of models, " + std::to_string(plan_.seeds) +
             " seeds");
    tell_networks();
    const programs::FitStore store(options_.out + "/fits", plan_);
    int code = 0;
    try {
      fit(store);
      code = judge_and_export();
    } catch (const programs::Interrupted&) {
      report_.write_not_exported("interrupted");
      throw programs::Interrupted{kept()};
    }
    announce("[5/5] report");
    programs::keeping(kept(), [&] {
      look_at_held_out();
      write_page();
    });
    store.clear();
    print_summary();
    return code;
  }

 private:
  nlohmann::json facts_of_trainings() const {
    nlohmann::json facts = {{"networks", nlohmann::json::object()}};
    for (const programs::Recipe& recipe : selection_.recipes) {
      nlohmann::json& network = facts["networks"][recipe.name] = recipe.settings;
      for (const programs::ModelKind& kind : recipe.kinds) {
        if (selection_.has(kind.key)) network["losses"][kind.key] = kind.words;
      }
    }
    if (selection_.has("structured")) facts["structured"] = programs::structured_settings(options_.pinned_slopes);
    return facts;
  }

  bool tells_structured() const {
    return selection_.has("structured") && (!options_.flights.empty() || !selection_.recipes.empty());
  }

  void tell_networks() const {
    const std::string epochs = plan_.epochs > 0 ? std::to_string(plan_.epochs) + " epochs" : "epochs as suit each kind";
    for (const programs::Recipe& recipe : selection_.recipes) {
      detail("network " + recipe.network + "; " + recipe.settings.at("optimizer").get<std::string>() + ", batch " +
             std::to_string(recipe.settings.at("batch").get<int>()) + ", " + epochs);
    }
    if (!tells_structured()) return;
    detail("structured: " + programs::structured_settings(options_.pinned_slopes).at("words").get<std::string>());
  }

  /// A line that --verbose alone prints.
  void detail(const std::string& text, std::size_t indent = 2) const {
    if (!options_.verbose) return;
    programs::print_line(text, indent);
    std::fflush(stdout);
  }

  void fit(const programs::FitStore& store) {
    fits_ = programs::fit_all(plan_, store);
    if (fits_.known > 0) {
      std::printf("      %zu of %zu fits were finished by an earlier run\n", fits_.known, fits_.wanted);
    }
    report_.interrupted_after(fits_.finished.size(), fits_.wanted);
    if (fits_.finished.size() < fits_.wanted) programs::stop_if_interrupted();
  }

  int judge_and_export() {
    announce("[3/5] judge");
    judged_ = programs::judge_fits(plan_, fits_);
    verdicts_ = programs::verdicts_on(judged_);
    if (options_.verbose) {
      programs::print_details(judged_, verdicts_);
      programs::print_training_time(judged_);
    }
    tell_altitude();
    std::fflush(stdout);
    report_.judged(plan_, judged_, verdicts_);
    programs::write_results(options_.out + "/results.csv", plan_, judged_);
    return export_best();
  }

  /// Of the first seed's fit on the first parting.
  void tell_altitude() {
    for (const programs::FinishedFit& fit : fits_.finished) {
      if (!fit.altitude.applies) continue;
      const programs::AltitudeChoice& choice = fit.altitude;
      const std::string why = !is_finite(choice.error_with)
                                  ? std::string("as --altitude asks")
                                  : "error on the validation rows with it " + thousandths(choice.error_with, 2) +
                                        ", without it " + thousandths(choice.error_without, 2) +
                                        (choice.taken ? "" : "; it must lower the error by a fifth");
      detail(std::string("altitude ") + (choice.taken ? "used" : "not used") + " by the structured model: " + why);
      report_.altitude(choice, options_.altitude, why);
      return;
    }
  }

  bool rotated() const { return !options_.hold_out_each.empty(); }

  void warn_of_the_setting() {
    if (!vehicle_.is_known()) {
      report_.warn("no --airframe, and the flights do not identify their vehicle: " + vehicle_.asked->why_not +
                   "; in the airframe of the header, " + plan_.airframe.name + ", these are not the vehicle's: " +
                   programs::listed(vehicle_.unknown) + "; --airframe FILE.toml says what flew");
    }
    const std::string unlike = vehicle_.asked ? programs::unlike_axes_in_words(vehicle_.asked->found) : "";
    if (!unlike.empty()) report_.warn(unlike);
    for (const std::string& doubt : vehicle_.doubts) report_.warn("the flights contradict --airframe: " + doubt);
    for (const programs::Fold& fold : plan_.folds) {
      if (is_default_choice()) tell_judges(fold);
      if (fold.part_validates && !(is_default_choice() && !fold.judges.empty())) {
        report_.warn("holding out " + fold.name +
                     " leaves one trajectory: its last fifth validates, no flight of its own");
      }
    }
    const std::vector<ColumnName> unused = programs::unused_columns(dataset_.flights);
    if (!unused.empty()) {
      report_.warn(programs::listed(unused, [](const ColumnName& column) { return printable(column.name); }) +
                   ": no kind of model takes this column; from C++ one of yours does (docs/log_training.md, 'Columns "
                   "of your own')");
    }
    if (judges() < programs::fewest_pairs && options_.flights.empty()) {
      report_.warn("paired tests over " + std::to_string(judges()) + " held-out flights can't decide: fewer than " +
                   std::to_string(programs::fewest_pairs) + "; --hold-out-each judges by more");
    }
    const std::string still = programs::listed(
        programs::still_features(plan_.task(plan_.folds.front(), 1), !selection_.recipes.empty(), tells_structured()));
    if (!still.empty()) {
      report_.warn(still +
                   ": nothing changes in the training rows; the model will not know what it does, and answers only "
                   "near the value flown");
    }
  }

  /// A parting of a rotation has none.
  void tell_judges(const programs::Fold& fold) {
    constexpr double shortest_s = 30;
    if (fold.judges.empty()) return;
    detail("choose what is exported: " + fold.chosen_by, 6);
    double rows = 0;
    for (const programs::Judge& judge : fold.judges) rows += static_cast<double>(judge.rows.size());
    const double duration_s = rows * plan_.sample_period_s;
    std::string caution = fold.caution;
    if (duration_s < shortest_s) {
      caution += (caution.empty() ? "" : "; ") + decimals(duration_s, 0) + " s of flight are few, " +
                 decimals(shortest_s, 0) + " s or more are better";
    }
    if (!caution.empty()) report_.warn("what is exported is chosen by " + fold.chosen_by + ": " + caution);
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

  int refuse(const std::string& reason, const std::string& advice = {}) {
    report_.write_not_exported(reason);
    told_ = "Nothing was exported: " + reason + ".";
    found_.emplace();
    found_->refuse("nothing was exported: " + reason, livelier());
    std::string earlier;
    for (const char* name : export_names) {
      const std::string path = options_.out + "/" + name;
      std::error_code ignored;
      if (std::filesystem::exists(path, ignored))
        earlier += (earlier.empty() ? "; of an earlier training: " : ", ") + path;
    }
    programs::complain("train", "not exported: " + reason + advice + earlier);
    return programs::exit_failed;
  }

  /// Advice where a kind is worse than the mean.
  std::string advice(const programs::ModelKind& kind) const {
    if (selection_.recipes.empty()) return "; --allow-poor exports it, marked";
    if (kind.key != std::string("structured")) return "; more epochs or a better flight, or --allow-poor";
    return std::string("; ") + (options_.pinned_slopes ? "--slopes learned, " : "") +
           "a better flight, --allow-poor, or --models paper_physics_informed, of which nothing is proven";
  }

  /// The flight that the identification lacks most, else one that most models lack.
  std::string livelier() const {
    const std::string flight = missing_flight();
    return flight.empty() ? programs::livelier_flight : "record: " + flight;
  }
  std::string missing_flight() const {
    if (!vehicle_.asked || vehicle_.is_known()) return {};
    for (const programs::IdentifiedNumber& number : programs::identified_numbers(vehicle_.asked->found)) {
      if (!programs::is_told(number)) return number.flight;
    }
    return {};
  }

  /// The verdict, what to do next, a line a model, and the files.
  void print_summary() {
    std::printf("\n");
    if (found_) programs::print_verdict(*found_);
    programs::print_entry("models",
                          "on rows that they were not trained on: " + programs::rows_in_words(plan_, judged_));
    programs::print_kinds(judged_, [&](std::size_t k) { return made_ && chosen_ == k ? "exported" : ""; });
    for (const std::string& line : summary_) std::fputs(line.c_str(), stdout);
    programs::print_entry("page", options_.out + "/report.html" + (options_.verbose ? "" : "; more here: --verbose"));
  }

  struct Exported {
    std::shared_ptr<const programs::TrainedNetwork> model;
    std::uint64_t seed = 0;
    const programs::Fold* fold = nullptr;
    nlohmann::json flown{};          ///< what came of the closed loop
    programs::FlownTraces traces{};  ///< and where it flew
  };

  std::string export_choice() const {
    if (!options_.export_choice.empty()) return options_.export_choice;
    return selection_.exported();
  }

  /// Of proven models the best.
  bool is_default_choice() const {
    return export_choice() == programs::export_causal || export_choice() == programs::export_centred;
  }

  /// The verdict on a kind that may be exported: on the very fit, unless it is fitted anew.
  Verdict verdict_of(std::size_t kind) const {
    std::optional<std::uint64_t> seed;
    if (!rotated()) {
      const programs::FinishedFit* best =
          programs::best_fit(fits_.finished, kind, plan_.kinds[kind].takes_validation(plan_.settings));
      if (best == nullptr) return {not_a_number, not_a_number, not_a_number};
      seed = best->seed;
    }
    Verdict verdict = programs::exported_verdict(plan_, judged_, kind, seed);
    verdict.answered_share = programs::guard_of_seed(fits_, kind, seed_shown(kind)).answered_share();
    return verdict;
  }

  int export_best() {
    const std::vector<std::size_t> order = programs::kinds_to_export(plan_, judged_, export_choice());
    if (order.empty()) {
      return refuse(
          "no model of the kind asked for was judged of which it is proven that it turns the way it is told to",
          "; --export NAME exports one of which it is not");
    }
    chosen_ = order.front();
    const programs::ModelKind& first = judged_.kinds[*chosen_].kind;
    const Verdict verdict = verdict_of(*chosen_);
    report_.verdict(first, {}, verdict, !verdict.worse_than_mean() || options_.allow_poor);
    if (verdict.worse_than_mean() && !options_.allow_poor) {
      return refuse(std::string(first.title) + ", the best, is worse than the mean of the commands on the rows held " +
                        "out (R^2 " + decimals(verdict.test_r_squared, 4) + ")",
                    advice(first));
    }
    report_.write_not_exported("the export was not finished");
    std::optional<Exported> made;
    std::vector<std::string> warnings;
    for (const std::size_t k : order) {
      if (k != order.front() && verdict_of(k).worse_than_mean()) continue;
      Exported next = exported(k);
      if (is_default_choice() && !next.model->is_proven()) {
        warnings.push_back(std::string(judged_.kinds[k].kind.title) +
                           ": fitted to all flights, is not proven to turn the way it is told to: it stays out");
        continue;
      }
      next.flown = fly(next, judged_.kinds[k].kind, next.traces);
      const std::string unfit = programs::unfit_to_fly(next.flown);
      if (!unfit.empty()) unfit_.push_back(k);
      if (!unfit.empty() && k != order.back()) {
        warnings.push_back(std::string(judged_.kinds[k].kind.title) + " " + unfit +
                           ": not fit to fly; the next best is tried");
      }
      if (unfit.empty() || !made) {
        made = std::move(next);
        chosen_ = k;
      }
      if (unfit.empty()) break;
    }
    report_.warn(warnings);
    if (!made) return refuse("of no model that was fitted to all flights are the signs proven");
    if (order.size() > 1 && !programs::unfit_to_fly(made->flown).empty()) {
      report_.warn("no model is fit to fly in the closed loop: what is exported is the best by its figures alone");
    }
    write_with_warnings(*made);
    return 0;
  }

  void write_with_warnings(const Exported& made) {
    const programs::JudgedKind& kind = judged_.kinds[*chosen_];
    const Verdict verdict = verdict_of(*chosen_);
    const std::string title = kind.kind.title;
    report_.verdict(kind.kind, rotated() ? std::optional<std::uint64_t>{} : made.seed, verdict, true);
    const bool smoothed = programs::any_smoothed(made.model->slopes());
    if (smoothed) {
      report_.warn(
          "noise of gyro or accelerometer bends the slopes of least squares: those of " + title +
          " are by smoothed rows, and it was judged by rows without that noise, as their neighbours tell them; "
          "on the noisy rows, by which all others were judged, bent slopes err less");
    } else if (kind.kind.key != std::string("linear") && !verdict.worse_than_mean() &&
               verdict.test_r_squared <= verdict.linear_regression_r_squared) {
      report_.warn(title + " does not beat linear regression on the paper's features (R^2 " +
                   decimals(verdict.test_r_squared, 4) + " against " +
                   decimals(verdict.linear_regression_r_squared, 4) + "): a linear map of them would fly as well");
    }
    announce("[4/5] export " + title);
    write(made, kind.kind, verdict);
  }

  /// The model to write: after a rotation fitted to all flights, else that of the best seed.
  Exported exported(std::size_t kind) {
    if (rotated()) {
      all_ = programs::fold_of_all(dataset_.flights, programs::hold_out_choice(options_, dataset_));
      programs::FitPlan once = plan_;
      once.kinds = {plan_.kinds[kind]};
      once.folds = {*all_};
      if (once.kinds.front().takes_validation(plan_.settings)) once.seeds = 1;
      all_fits_ = programs::fit_all(once);
      if (all_fits_.finished.size() < all_fits_.wanted) programs::stop_if_interrupted();
      const programs::FinishedFit* best =
          programs::best_fit(all_fits_.finished, 0, once.kinds.front().takes_validation(plan_.settings));
      if (best == nullptr)
        throw std::invalid_argument("the fit to all flights has no finite error on " + all_->validation.front());
      return Exported{best->model, best->seed, &*all_};
    }
    const programs::FinishedFit* best =
        programs::best_fit(fits_.finished, kind, plan_.kinds[kind].takes_validation(plan_.settings));
    if (best == nullptr) throw std::invalid_argument("no fit has a finite error on the validation rows");
    programs::FinishedFit again = *best;
    if (!again.model) programs::fit_again(plan_, again);
    return Exported{again.model, again.seed, &plan_.folds[again.fold]};
  }

  void write(const Exported& made, const programs::ModelKind& kind, const Verdict& verdict) {
    const std::optional<SignedSums<double>>& bias = judged_.kinds[*chosen_].bias_time_constants_s;
    const programs::BesideOthers others = programs::beside_others(plan_, judged_, *chosen_, unfit_);
    const std::string beside = programs::in_words(others, judged_, *chosen_);
    const std::vector<std::string> beaten = programs::beaten_in_words(others, judged_, *chosen_);
    programs::ModelEvidence evidence =
        programs::evidence_of(*made.model, judged_, *chosen_, verdict, made.flown, others, vehicle_.is_known());
    evidence.flight = missing_flight();
    const programs::FlightVerdict of_header = programs::model_verdict(evidence);  // without a path of this machine
    evidence.block = options_.out + "/model.block";
    found_ = programs::model_verdict(evidence);
    traces_ = made.traces;
    inputs_ = programs::inputs_code(*made.model->block(), options_.model_name);
    made_ = true;
    report_.export_verdict(*found_, beside, programs::beside_json(others, judged_));
    detail(beside);
    for (const std::string& line : beaten) {
      if (found_->words().find(line) == std::string::npos) report_.warn(line);
    }
    const bool unfit = found_->may_fly() == programs::MayFly::no;
    if (unfit) report_.warn(found_->words());
    Provenance from =
        programs::provenance_of(*made.model,
                                programs::provenance_of(*made.fold, dataset_.flights, dataset_.lag_removed_s, kind,
                                                        plan_.settings, made.seed, plan_.epochs, verdict),
                                bias, vehicle_.is_known());
    from.fitness = programs::fitness_in_words(of_header);
    from.beside = beside;
    const std::string header = options_.out + "/model.hpp", block = options_.out + "/model.block";
    const std::string trust = options_.out + "/trust.hpp";
    const pinnquad::Exported written = made.model->export_to({header, block, made.model->has_trust() ? trust : ""},
                                                             options_.model_name, made.fold->split, from);
    const bool trusted = made.model->has_trust() && written.no_trust_because.empty();
    std::error_code ignored;
    if (!trusted) std::filesystem::remove(trust, ignored);  // of an earlier training
    programs::write_replay(options_.out + "/replay.txt", *made.model->block(),
                           made.fold->split.test.empty() ? made.fold->split.validation : made.fold->split.test);
    add_file("files", header + ": struct " + options_.model_name + ", " + kind.title +
                          (kind.seeded ? " of seed " + std::to_string(made.seed) : "") +
                          (unfit ? "; its first lines say: do not fly" : ""));
    if (trusted) {
      add_file("", trust + ": struct " + options_.model_name +
                       "Trust, limits of distance and command residual: beyond them don't trust it");
    } else if (!written.no_trust_because.empty()) {
      add_file("", "no trust.hpp: " + written.no_trust_because);
    }
    add_file("", block + ": the same weights as a block of " + std::to_string(written.block_bytes) + " bytes");
    report_.trusted(trusted ? trust : "", written.no_trust_because);
    tell_certificate(*made.model->block(), made.model->slopes());
    if (bias) {
      detail("learnt in flight: a bias of its signed sums (AdaptiveInverse, docs/adaptive.md); time constants " +
             programs::time_constants_in_words(*bias));
      report_.bias(*bias, plan_.airframe.value);
    }
    tell_flight(made.flown);
    report_.write_exported(kind, made.seed, header, block);
    told_ = "Exported as " + header + ", struct " + options_.model_name + ", " +
            (rotated() ? "fitted anew to all flights, validated on " + made.fold->validation.front() +
                             ": the figures are of the fits of the rotation"
                       : "the very model that was judged") +
            ". " + beside + ".";
  }

  /// Proof of an export's signs, as `certify` finds it in the header.
  void tell_certificate(const BlockModel& model, const SlopesOfSums& known) {
    const std::optional<BlockModel::ProvenSigns> signs = model.proven_signs();
    if (!signs) {
      detail("nothing is proven of its signs: `pinnquad certify " + options_.out +
             "/model.hpp` looks for a counterexample");
      return;
    }
    const Airframe<double>& airframe = plan_.airframe.value;
    const std::optional<Certificate>& structure = signs->structure;
    const AxisSlopes &slopes = signs->held_slope, own = hover_slopes(airframe);
    const double own_thrust = hover_thrust_slope(airframe);
    report_.certified(*signs, airframe, known);
    const bool known_vehicle = vehicle_.is_known();
    std::string least, ratios;
    if (known_vehicle) {
      least = ", " + programs::least_share_in_words(slopes, own);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ratios += (axis == 0 ? ": " : ", ") + decimals(slopes[axis] / own[axis], 2);
      }
      ratios += " of the airframe's own in hover";
    }
    summary_.push_back(
        programs::entry("proven", "more angular acceleration asked is more torque commanded, at every input" + least));
    detail(programs::in_words("slopes roll %.6f, pitch %.6f, yaw %.6f s^2/rad", slopes[0], slopes[1], slopes[2]) +
           ratios);
    if (structure) {
      detail(programs::in_words("thrust slope %.6f s^2/m: %.2f of the airframe's own in hover",
                                structure->held_thrust_slope, structure->held_thrust_slope / own_thrust));
    }
    detail(programs::bound_in_words(structure));
    const std::string intervals =
        known_vehicle ? known_slopes_in_words(known, own_thrust, own) : known_slopes_in_words(known, 1, {1, 1, 1}, 4);
    if (!intervals.empty()) {
      detail(std::string("95 % intervals of the training rows, ") +
             (known_vehicle ? "over the airframe's own" : "s^2/rad and s^2/m") + ": " + intervals);
    }
    if (!known_vehicle) return;
    const std::string doubt = programs::slopes_doubt(programs::odd_slopes(*signs, airframe));
    if (!doubt.empty()) report_.warn(doubt);
  }

  void add_file(const std::string& name, const std::string& text) { summary_.push_back(programs::entry(name, text)); }

  /// The model in a closed loop on the vehicle of the logs, of recorded flights on their airframe; what looks ahead is
  /// not flown on measured motion.
  nlohmann::json fly(const Exported& made, const programs::ModelKind& kind, programs::FlownTraces& traces) const {
    if (kind.reach == programs::TimeReach::centred) return {};
    if (!vehicle_.asked)
      return programs::fly_given(*made.model->block(), made.fold->split.train, plan_.airframe.value, traces);
    return programs::fly_logged(*made.model->block(), made.fold->split.train, *vehicle_.asked,
                                !dataset_.lacks("velocity"), traces);
  }

  void tell_flight(const nlohmann::json& flown) {
    if (flown.is_null()) return;
    report_.flown(flown);
    if (!flown.contains("model")) return;
    const auto centimetres = [&](const char* who) { return decimals(100 * flown[who]["rmse_m"].get<double>(), 1); };
    summary_.push_back(programs::entry(
        "flown", "a figure-eight of " + decimals(flown["period_s"].get<double>(), 1) + " s, on the vehicle that " +
                     (vehicle_.asked ? "was identified" : "was given") + ": " + centimetres("model") +
                     " cm off; the analytic inverse " + centimetres("formula") +
                     "; without jerk and snap of the path " + centimetres("without_jerk")));
    const std::string compared = programs::comparison_in_words(flown["against_formula"]);
    if (!compared.empty()) {
      detail("its sums of commands beside the formula's there, slope (rms difference): " + compared);
    }
  }

  /// The seed whose fits stand for a kind: of what is exported as it was judged its own.
  std::uint64_t seed_shown(std::size_t kind) const {
    const programs::FinishedFit* best =
        rotated() ? nullptr
                  : programs::best_fit(fits_.finished, kind, plan_.kinds[kind].takes_validation(plan_.settings));
    return best != nullptr ? best->seed : judged_.kinds[kind].seeds.front();
  }

  /// Of what was chosen, else of the best that was judged.
  void look_at_held_out() {
    std::optional<std::size_t> kind = chosen_;
    for (const bool centred : {false, true}) {
      const std::vector<std::size_t> order = programs::ranking(judged_, centred);
      if (!kind && !order.empty()) kind = order.front();
    }
    if (!kind) return;
    dynamics_ = programs::held_out_dynamics(plan_, fits_, judged_, *kind, seed_shown(*kind));
    report_.held_out(*dynamics_, judged_);
    report_.write();
    tell_held_out();
  }

  void tell_held_out() const {
    const programs::HeldOutDynamics& held_out = *dynamics_;
    detail(std::string("on the rows held out the guard of ") + judged_.kinds[held_out.kind].kind.title + " answers " +
           decimals(100 * held_out.guard.answered_share(), 1) + " %");
    if (!held_out.has_spectra()) return;
    std::string words =
        "best R^2 possible with this sensor noise: " + decimals(programs::mean_over_motors(held_out.ceiling.r2), 3) +
        (held_out.ceiling.white ? "" : " (the noise is not white)") + "; flown after predicted commands:";
    for (std::size_t sum = 0; sum < programs::sum_names.size(); ++sum) {
      const programs::FollowedRange& followed = held_out.followed[sum];
      words += std::string(sum > 0 ? "," : "") + " " + programs::sum_names[sum];
      words += followed.to_hz > 0 ? programs::in_words(" to %.1f Hz, gain %.2f, %.0f ms", followed.to_hz, followed.gain,
                                                       1e3 * followed.delay_s)
                                  : " not at all";
    }
    detail(words);
  }

  /// The page, and one to watch each held-out flight in 3D where that is built.
  void write_page() {
    programs::TrainingPage input{plan_,          dataset_, fits_, judged_, verdicts_,
                                 report_.json(), chosen_,  told_, {},      dynamics_ ? &*dynamics_ : nullptr};
    input.found = found_ ? &*found_ : nullptr;
    input.traces = &traces_;
    input.inputs = inputs_;
    if (programs::WatchPage::available()) {
      programs::ProgressLine progress("flights to watch");
      for (const std::string& name : judged_.flights) {
        progress.update(static_cast<double>(input.watched.size()) / static_cast<double>(judged_.flights.size()));
        const std::string file = "watch-" + std::to_string(input.watched.size() + 1) + ".html";
        for (const Flight& flight : dataset_.flights.flights()) {
          if (flight.name == name)
            programs::write_watched_flight(options_.out + "/" + file, flight, dataset_, plan_.airframe.value);
        }
        input.watched[name] = file;
      }
    }
    AtomicFile file(options_.out + "/report.html");
    file.stream() << programs::training_page(input);
    file.commit();
  }

  const TrainOptions& options_;
  const programs::Selection& selection_;
  const pinnquad::logs::ImportedDataset& dataset_;
  const programs::FlownVehicle& vehicle_;
  programs::FitPlan plan_;
  programs::TrainingReport report_;
  programs::Fits fits_, all_fits_;
  std::optional<programs::Fold> all_;
  programs::JudgedKinds judged_;
  std::vector<programs::KindVerdict> verdicts_;
  std::optional<std::size_t> chosen_;
  std::vector<std::size_t> unfit_;                     ///< kinds that were found not fit to fly
  std::optional<programs::HeldOutDynamics> dynamics_;  ///< of it, or of the best that was judged
  std::string told_;                                   ///< what became of the export
  std::optional<programs::FlightVerdict> found_;       ///< on the export
  bool made_ = false;                                  ///< something was exported
  programs::FlownTraces traces_;                       ///< of it in the closed loop
  std::string inputs_;                                 ///< C++ that fills its Inputs
  std::vector<std::string> summary_;                   ///< entries after the table of models
};

}  // namespace

int programs::train(const TrainOptions& options) {
  require_identifier("--name", options.model_name);
  const Selection selection = selection_of(log_model_kinds(), options.models, !options.flights.empty(), options.epochs);
  require_structured(options, selection);
  if (!options.export_choice.empty()) require_known_export(options.export_choice, selection.kinds);
  std::optional<NamedAirframe> given;
  if (!options.airframe.empty()) given = chosen_airframe(options.airframe);
  FlownVehicle vehicle;
  vehicle.airframe = given ? *given : chosen_airframe(PaperQuadrotor::name);
  require_separate_files(options);
  announce("[1/5] read");
  pinnquad::logs::ImportedDataset dataset = dataset_of(options, vehicle.airframe.value);
  std::vector<Fold> folds = folds_asked_for(options, dataset);
  require_sound(options, dataset, folds);
  if (!options.dataset.empty()) {  // of logs it was checked when they were read
    if (!given) logs::set_thrust_curve(vehicle.airframe.value, dataset.curve.k);
    check_vehicle(dataset, vehicle.airframe.value, given.has_value());
    folds = folds_asked_for(options, dataset);  // without the flights that it found unlike
  }
  require_one_vehicle(dataset);
  const FolderLock lock(options.out);
  if (!options.logs.empty()) write_dataset_folder(options.dataset_folder(), dataset);
  // what can't be written is found before the training
  each_output(options, [](const std::string& path) { AtomicFile probe(path); });
  std::printf("      %zu rows of %zu flight%s\n", dataset.flights.rows(), dataset.flights.size(),
              dataset.flights.size() == 1 ? "" : "s");
  if (!options.flights.empty() && !dataset.steps.empty() && !options.lag_s) {
    programs::print_message(dataset.steps.back().told + "; --lag 0 leaves the commands as they are", 6);
  }
  print_folds(folds);
  if (!given && !dataset.curve.told.empty()) programs::print_message(dataset.curve.told, 6);
  if (options.flights.empty()) {
    vehicle = flown_vehicle(given, dataset, places_of(options, dataset), folds);
    print_vehicle(vehicle);
  }
  return Training(options, selection, dataset, vehicle, std::move(folds)).run();
}

// SPDX-License-Identifier: MIT
// The recipe `structured`: the paper's networks, and beside them a model that is monotone by construction
// (model/axis_aligned.hpp): an affine base in closed form, a network of 2 x 32 on what it leaves, dropped where the
// validation rows do not gain. It is shown the altitude where they gain much: near the ground.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <random>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/deploy/trust_writer.hpp"
#include "pinnquad/features/motion_parts.hpp"
#include "pinnquad/io/atomic_file.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/monotone_fit.hpp"
#include "pinnquad/training/trust_limits.hpp"
#include "training/campaign.hpp"

namespace programs {

namespace {

/// One that knows when it is not to be trusted.
template <class Model>
class TrustedNetwork : public NetworkOfModel<Model, ExportedAirframe::by_value> {
 public:
  using NetworkOfModel<Model, ExportedAirframe::by_value>::NetworkOfModel;

  bool write_trust(const std::string& path, const std::string& name, const pinnquad::RowSet& training,
                   const pinnquad::RowSet& validation, std::uint64_t training_data_hash) const override {
    const auto trust = pinnquad::fit_trust(this->model(), training, validation);
    pinnquad::AtomicFile file(path);
    file.stream() << "// To be included after the header of " << name << ". Limits by " << validation.size()
                  << " validation rows: guesses where those are\n// less than 30 minutes of flight "
                     "(docs/trust.md).\n#pragma once\n\n#include <array>\n#include <cstdint>\n";
    pinnquad::write_trust<typename Model::Scalar>(file.stream(), name, trust, training_data_hash);
    file.commit();
    return true;
  }
};

/// An altitude is shown if that lowers the error on the validation rows by more than this share of it: a model that has it must
/// be given it in flight, and a flight far from the ground tells nothing of it.
constexpr double least_altitude_gain = 0.2;

template <class Features>
using Residual = pinnquad::Mlp<float, pinnquad::InputSize<pinnquad::residual_inputs<Features>>, pinnquad::Hidden<2, 32>,
                               pinnquad::OutputSize<4>, pinnquad::Relu>;

/// Of one seed.
struct Fitted {
  std::shared_ptr<const TrainedNetwork> network;
  double validation_error = 0;
  double training_s = 0;
};
/// The models of one feature set: the base is the same of all seeds, the residual is not. Nothing where `goes_on(epoch)` said no.
using Fit = std::function<std::optional<Fitted>(std::uint64_t seed, const std::function<bool(int)>& goes_on)>;

template <class Features>
Fit fit_with(const TrainingPlan& plan) {
  using Context = pinnquad::Context<Features, pinnquad::GivenAirframe, pinnquad::AxisCommandOutputs>;
  const auto context = pinnquad::make_context<Context>(plan.split.train, plan.airframe);
  pinnquad::SlopeRule slopes;
  if (plan.pinned_slopes) slopes.pinned = pinnquad::hover_slopes(plan.airframe.airframe<double>());
  return [&plan, context, map = pinnquad::fit_monotone_base(context, plan.split.train, slopes)](
             std::uint64_t seed, const std::function<bool(int)>& goes_on) -> std::optional<Fitted> {
    const auto start = std::chrono::steady_clock::now();
    std::mt19937_64 engine(seed);
    pinnquad::ResidualTraining how;
    how.epochs = plan.epochs;
    const auto fit = pinnquad::fit_monotone<Residual<Features>>(context, plan.split.train, plan.split.validation, map,
                                                                how, engine, goes_on);
    if (!fit.finished) return {};
    const auto network = [&](const auto& answer) -> std::shared_ptr<const TrainedNetwork> {
      const auto model = pinnquad::make_trained_model(answer, context, plan.split.train);
      return std::make_shared<TrustedNetwork<std::decay_t<decltype(model)>>>(model);
    };
    return Fitted{fit.residual_kept ? network(fit.answer) : network(fit.base),
                  fit.residual_kept ? fit.error : fit.base_error,
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  };
}

/// A feature set and a seed that are trained, and what came of it.
struct Job {
  const Fit* fit;
  std::uint64_t seed;
  std::optional<Fitted> result{};
};

/// Side by side, with progress.
void train(const TrainingPlan& plan, const std::string& what, std::vector<Job>& jobs) {
  std::atomic<long> epochs_done{0};
  const double all_epochs = static_cast<double>(jobs.size()) * plan.epochs;
  run_parallel(
      plan.silent ? "" : "training " + what, jobs.size(), plan.threads,
      [&] { return static_cast<double>(epochs_done.load()) / all_epochs; },
      [&](std::size_t i) {
        jobs[i].result = (*jobs[i].fit)(jobs[i].seed, [&epochs_done](int epoch) {
          if (epoch > 0) epochs_done.fetch_add(1);
          return !interrupted();
        });
        epochs_done.fetch_add(1);
        return jobs[i].result.has_value();
      });
}

/// "10.15e-3"
std::string thousandths(double error) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2fe-3", 1e3 * error);
  return text;
}

/// The feature set of all seeds, and why; where both were tried, with the models of the first seed.
class FeatureChoice {
 public:
  explicit FeatureChoice(const TrainingPlan& plan) {
    bool with = plan.altitude == AltitudeRule::yes;
    std::string why = "as --altitude asks";
    report_ = {{"asked", with                                ? "yes"
                         : plan.altitude == AltitudeRule::no ? "no"
                                                             : "auto"},
               {"validation_mae", nullptr},
               {"validation_mae_without", nullptr},
               {"least_gain", least_altitude_gain}};
    if (plan.altitude != AltitudeRule::by_validation) {
      fit_ = with ? fit_with<pinnquad::InverseFeaturesWithAltitude>(plan) : fit_with<pinnquad::InverseFeatures>(plan);
    } else {
      const Fit higher = fit_with<pinnquad::InverseFeaturesWithAltitude>(plan);
      fit_ = fit_with<pinnquad::InverseFeatures>(plan);
      std::vector<Job> both = {{&fit_, plan.first_seed}, {&higher, plan.first_seed}};
      train(plan, "2 structured models, with the altitude and without", both);
      if (!both[0].result || !both[1].result) return;  // interrupted
      const double error = both[1].result->validation_error, without = both[0].result->validation_error;
      with = error < (1 - least_altitude_gain) * without;
      report_["validation_mae"] = error;
      report_["validation_mae_without"] = without;
      why = "error on the validation rows with it " + thousandths(error) + ", without " + thousandths(without) +
            (with ? "" : "; a fifth less would take it");
      first_ = both[with ? 1 : 0].result;
      if (with) fit_ = higher;
    }
    report_["taken"] = with;
    report_["why"] = why;
    chosen_ = true;
    if (plan.silent) return;
    std::printf("      the structured model is %s the altitude: %s\n", with ? "shown" : "not shown", why.c_str());
    std::fflush(stdout);
  }

  const Fit& fit() const { return fit_; }
  const std::optional<Fitted>& first() const { return first_; }
  const nlohmann::json& report() const { return report_; }
  bool chosen() const { return chosen_; }  ///< false: interrupted before

 private:
  Fit fit_;
  std::optional<Fitted> first_;
  nlohmann::json report_;
  bool chosen_ = false;
};

/// One model per seed.
std::vector<Training> train_structured(const TrainingPlan& plan) {
  const FeatureChoice choice(plan);
  if (!choice.chosen()) return {};
  std::vector<Job> jobs;
  for (int i = choice.first() ? 1 : 0; i < plan.seeds; ++i) {
    jobs.push_back({&choice.fit(), plan.first_seed + static_cast<std::uint64_t>(i)});
  }
  if (!jobs.empty() && !interrupted()) train(plan, std::to_string(jobs.size()) + " structured models", jobs);
  if (choice.first()) jobs.insert(jobs.begin(), {&choice.fit(), plan.first_seed, choice.first()});
  std::vector<Training> done;
  for (const Job& job : jobs) {
    if (!job.result) continue;
    done.push_back({structured, job.seed, job.result->training_s, job.result->network, choice.report()});
  }
  return done;
}

/// Those that are asked for by the paper's recipe, then the structured ones. The latter are trained first: they take a
/// moment, and one of them is exported.
std::vector<Training> train_all_and_structured(const TrainingPlan& plan) {
  TrainingPlan of_paper = plan;
  of_paper.losses.clear();
  for (const LossName& loss : plan.losses) {
    if (!is_structured(loss)) of_paper.losses.push_back(loss);
  }
  std::vector<Training> own, all;
  if (of_paper.losses.size() < plan.losses.size()) own = train_structured(plan);
  if (!of_paper.losses.empty() && !interrupted()) all = paper_recipe().train(of_paper);
  for (Training& training : own) all.push_back(std::move(training));
  return all;
}

/// Of the paper's features and of the model's own, each once. An altitude that stands still is none of those, unless it is asked
/// for: no validation row gains by it.
std::vector<std::string> still_features_of_both(const TrainingPlan& plan) {
  std::vector<std::string> all = pinnquad::still_features<pinnquad::PaperFeatures>(plan.split.train);
  for (const std::string& name : plan.altitude == AltitudeRule::yes
                                     ? pinnquad::still_features<pinnquad::InverseFeaturesWithAltitude>(plan.split.train)
                                     : pinnquad::still_features<pinnquad::InverseFeatures>(plan.split.train)) {
    if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  }
  return all;
}

}  // namespace

Recipe structured_recipe() {
  Recipe recipe = paper_recipe();
  recipe.name = "structured";
  recipe.summary =
      "the paper's networks, and beside them a model that is monotone by construction (ridge and 2 x 32 ReLU), which "
      "is exported";
  recipe.settings["structured"] = {{"base", "ridge, own angular acceleration"},
                                   {"residual", "2 x 32 ReLU, no angular acceleration"},
                                   {"learning_rate", pinnquad::ResidualTraining{}.learning_rate},
                                   {"weight_decay", pinnquad::ResidualTraining{}.weight_decay},
                                   {"least_gain", pinnquad::ResidualTraining{}.least_gain},
                                   {"least_altitude_gain", least_altitude_gain}};
  recipe.train = train_all_and_structured;
  recipe.besides = {structured};
  recipe.besides_in_words =
      std::string(structured.title) + ": affine map of " + std::to_string(pinnquad::InverseFeatures::size) +
      " features, " + std::to_string(pinnquad::MonotoneBase<pinnquad::InverseFeatures>::parameter_count) +
      " numbers, and on what it leaves " + network_in_words<Residual<pinnquad::InverseFeatures>>("2 x 32 ReLU") +
      ", kept where the validation rows gain";
  recipe.still_features = still_features_of_both;
  return recipe;
}

}  // namespace programs

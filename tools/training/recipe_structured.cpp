// SPDX-License-Identifier: MIT
// The recipe `structured`: the paper's networks, and beside them a model that is monotone by construction
// (inference/axis_aligned.hpp): an affine base in closed form, a network of 2 x 32 on what it leaves, dropped where the
// validation rows do not gain.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <random>

#include "command_line/interrupt.hpp"
#include "command_line/parallel.hpp"
#include "pinnquad/data/atomic_file.hpp"
#include "pinnquad/deploy/trust_writer.hpp"
#include "pinnquad/inference/inverse_features.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/training/monotone_fit.hpp"
#include "pinnquad/training/trust_limits.hpp"
#include "training/campaign.hpp"

namespace programs {

namespace {

using StructuredContext =
    pinnquad::Context<pinnquad::InverseFeatures, pinnquad::GivenAirframe, pinnquad::SignedSumOutputs>;
using Residual = pinnquad::Mlp<float, pinnquad::InputSize<pinnquad::residual_inputs<pinnquad::InverseFeatures>>,
                               pinnquad::Hidden<2, 32>, pinnquad::OutputSize<4>, pinnquad::Relu>;

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

template <class Answer>
std::shared_ptr<const TrainedNetwork> structured_network(const Answer& answer, const StructuredContext& context,
                                                         const pinnquad::RowSet& rows) {
  const auto model = pinnquad::make_trained_model(answer, context, rows);
  using Model = std::decay_t<decltype(model)>;
  return std::make_shared<TrustedNetwork<Model>>(model);
}

/// One model per seed: the base is the same, the residual is not.
std::vector<Training> train_structured(const TrainingPlan& plan) {
  const auto context = pinnquad::make_context<StructuredContext>(plan.split.train, plan.airframe);
  const pinnquad::AffineMap map = pinnquad::fit_monotone_base(context, plan.split.train);
  std::vector<Training> jobs;
  for (int i = 0; i < plan.seeds; ++i) {
    jobs.push_back({structured, plan.first_seed + static_cast<std::uint64_t>(i), 0, nullptr});
  }
  std::atomic<long> epochs_done{0};
  const double all_epochs = static_cast<double>(jobs.size()) * plan.epochs;
  run_parallel(
      plan.silent ? "" : "training " + std::to_string(jobs.size()) + " structured models", jobs.size(), plan.threads,
      [&] { return static_cast<double>(epochs_done.load()) / all_epochs; },
      [&](std::size_t i) {
        const auto start = std::chrono::steady_clock::now();
        std::mt19937_64 engine(jobs[i].seed);
        pinnquad::ResidualTraining how;
        how.epochs = plan.epochs;
        const auto fit = pinnquad::fit_monotone<Residual>(context, plan.split.train, plan.split.validation, map, how,
                                                          engine, [&epochs_done](int epoch) {
                                                            if (epoch > 0) epochs_done.fetch_add(1);
                                                            return !interrupted();
                                                          });
        if (!fit.finished) return false;
        epochs_done.fetch_add(1);
        jobs[i].network = fit.residual_kept ? structured_network(fit.answer, context, plan.split.train)
                                            : structured_network(fit.base, context, plan.split.train);
        jobs[i].training_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return true;
      });
  std::vector<Training> done;
  for (const Training& job : jobs) {
    if (job.network) done.push_back(job);
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

/// Of the paper's features and of the model's own, each once.
std::vector<std::string> still_features_of_both(const pinnquad::RowSet& training) {
  std::vector<std::string> all = pinnquad::still_features<pinnquad::PaperFeatures>(training);
  for (const std::string& name : pinnquad::still_features<pinnquad::InverseFeatures>(training)) {
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
      "is "
      "exported";
  recipe.settings["structured"] = {{"base", "ridge, own angular acceleration"},
                                   {"residual", "2 x 32 ReLU, no angular acceleration"},
                                   {"learning_rate", pinnquad::ResidualTraining{}.learning_rate},
                                   {"weight_decay", pinnquad::ResidualTraining{}.weight_decay},
                                   {"least_gain", pinnquad::ResidualTraining{}.least_gain}};
  recipe.train = train_all_and_structured;
  recipe.besides = {structured};
  recipe.besides_in_words = std::string(structured.title) + ": affine map of " +
                            std::to_string(pinnquad::InverseFeatures::size) + " features, " +
                            std::to_string(pinnquad::MonotoneBase<pinnquad::InverseFeatures>::parameter_count) +
                            " numbers, and on what it leaves " + network_in_words<Residual>("2 x 32 ReLU") +
                            ", kept where the validation rows gain";
  recipe.still_features = still_features_of_both;
  return recipe;
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// A ridge and a small network on what it leaves, for the features that a translation unit compiles it with. Whole trajectories
// left out say how long the network is trained and what share of it counts: none, where it has learnt nothing that holds on
// a path that it has not seen. Then both are fitted to all rows that are not held out.
#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/loss/mse.hpp"
#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/schedule/cosine_decay.hpp"
#include "pinnquad/training/adam_w.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/scheduled.hpp"
#include "pinnquad/training/trainer.hpp"
#include "pinnquad/training/weight_average.hpp"
#include "training/log_closed_form.hpp"

namespace programs {

inline constexpr int residual_epochs = 12;

/// Of one feature set.
template <class FeatureSet>
class LogResidual {
  using Context = LogContext<FeatureSet>;
  using Network = pinnquad::Network<float, pinnquad::InputSize<FeatureSet::size>, pinnquad::Clip, pinnquad::Dense<48>,
                                    pinnquad::Silu, pinnquad::Dense<48>, pinnquad::Silu, pinnquad::Dense<4>>;
  using Optimizer = pinnquad::Scheduled<pinnquad::AdamW, pinnquad::CosineDecay>;
  using Trainer = pinnquad::Trainer<Network, pinnquad::Mse, Optimizer, Context, pinnquad::ShuffledBatches, 128>;
  using Data = typename Trainer::Data;

 public:
  explicit LogResidual(const LogFit& fit)
      : fit_(fit),
        rows_(rows_not_held_out(fit)),
        context_(log_context<Context>(fit, rows_)),
        epochs_(fit.epochs > 0 ? fit.epochs : residual_epochs) {}

  /// Null if interrupted.
  std::shared_ptr<const TrainedNetwork> model() const {
    std::vector<pinnquad::RowSet> groups;
    std::vector<pinnquad::RegressionSums> sums;
    for (const pinnquad::RowSet& group : pinnquad::left_out_groups(rows_)) {
      const pinnquad::RegressionSums of_group = pinnquad::regression_sums(context_, group);
      if (!(of_group.rows() > 0)) continue;  // no window is complete there
      groups.push_back(group);
      sums.push_back(of_group);
    }
    std::vector<Agreement> by_epoch(static_cast<std::size_t>(epochs_));
    for (std::size_t out = 0; out < groups.size() && groups.size() > 1; ++out) {
      if (!judge_without(groups, sums, out, by_epoch)) return nullptr;
    }
    std::size_t best = 0;
    for (std::size_t epoch = 1; epoch < by_epoch.size(); ++epoch) {
      if (by_epoch[epoch].gain() > by_epoch[best].gain()) best = epoch;
    }
    const pinnquad::AffineMap ridge = solved_ridge(sums);
    Data data = pinnquad::standardised<float>(context_, rows_);
    pinnquad::take_away(ridge, data);
    Network network{};
    if (by_epoch[best].gain() > 0) {
      const bool done =
          train(data, static_cast<int>(best) + 1, [&network](const Network& averaged, int) { network = averaged; });
      if (!done) return nullptr;
      const auto share = static_cast<float>(by_epoch[best].share());
      for (auto weight = network.parameters.end() - last_layer; weight != network.parameters.end(); ++weight) {
        *weight *= share;
      }
    }
    return log_model_of(pinnquad::sum_of(pinnquad::affine_answer<Context>(ridge), network), context_, rows_);
  }

 private:
  static constexpr std::ptrdiff_t last_layer = 48 * 4 + 4;  ///< parameters of the last layer

  /// What a network says of residuals that it has not seen.
  struct Agreement {
    double product = 0, square = 0;  ///< sums of answer x residual, and of answer^2

    /// The share of the answer that leaves the least squared error: by least squares, of 0 to 1.
    double share() const { return square > 0 ? std::min(1.0, std::max(0.0, product / square)) : 0.0; }
    /// By how much that share lowers the squared error.
    double gain() const { return (2 * product - share() * square) * share(); }
  };

  /// A network from the seed, `epochs` of the schedule's; after each of them `visit(averaged network, epoch)`.
  template <class Visit>
  bool train(const Data& data, int epochs, const Visit& visit) const {
    std::mt19937_64 engine(fit_.seed);
    auto network = pinnquad::initialised<Network>(engine);
    std::fill(network.parameters.end() - last_layer, network.parameters.end(), 0.0F);  // begins as the ridge alone
    Optimizer optimizer;
    optimizer.optimizer.learning_rate = 1e-3;
    optimizer.optimizer.weight_decay = 0.1;
    const auto trainer = std::make_unique<Trainer>(network, pinnquad::Mse{}, optimizer, context_);
    const auto average = std::make_unique<pinnquad::WeightAverage<Network>>();
    for (int epoch = 0; epoch < epochs; ++epoch) {
      if (interrupted()) return false;
      trainer->epoch(data, {epoch, epochs_}, engine, [&](const Trainer& now) { average->add(now.network()); });
      visit(average->network(), epoch);
    }
    return true;
  }

  /// Trains without a group and asks the network of it. False if interrupted.
  bool judge_without(const std::vector<pinnquad::RowSet>& groups, const std::vector<pinnquad::RegressionSums>& sums,
                     std::size_t out, std::vector<Agreement>& by_epoch) const {
    std::vector<pinnquad::RegressionSums> others;
    pinnquad::RowSet left;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (i == out) continue;
      for (const pinnquad::FlightRows& piece : groups[i].pieces()) left.add(*piece.flight, piece.rows);
      others.push_back(sums[i]);
    }
    const pinnquad::AffineMap ridge = solved_ridge(others);
    Data data = pinnquad::standardised<float>(context_, left);
    Data unseen = pinnquad::standardised<float>(context_, groups[out]);
    pinnquad::take_away(ridge, data);
    pinnquad::take_away(ridge, unseen);
    return train(data, epochs_, [&](const Network& averaged, int epoch) {
      Agreement& agreement = by_epoch[static_cast<std::size_t>(epoch)];
      for (int row = 0; row < unseen.size(); ++row) {
        float answer[Network::outputs] = {};
        averaged.forward(unseen.features_of(row), answer);
        for (int k = 0; k < Network::outputs; ++k) {
          const auto said = static_cast<double>(answer[k]);
          agreement.product += said * static_cast<double>(unseen.outputs_of(row)[k]);
          agreement.square += said * said;
        }
      }
    });
  }

  const LogFit& fit_;
  pinnquad::RowSet rows_;
  Context context_;
  int epochs_;
};

template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_log_residual(const LogFit& fit) {
  return with_physics_features<Reach>(fit,
                                      [&](auto tag) { return LogResidual<typename decltype(tag)::type>(fit).model(); });
}

}  // namespace programs

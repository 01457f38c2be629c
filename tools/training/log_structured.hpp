// SPDX-License-Identifier: MIT
// A ridge and a small network on what it leaves, for the features that a translation unit compiles it with; monotone by
// construction (model/axis_aligned.hpp): each signed sum's ridge sees its own angular acceleration alone, the network
// sees none. Whole trajectories left out say how long the network is trained and what share of each output counts:
// none, where it has learnt nothing that holds on each path that it has not seen. Then both are fitted to all rows that
// are not held out.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "command_line/interrupt.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/checkpoint.hpp"
#include "pinnquad/training/initialization.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/structured/residual_fit.hpp"
#include "pinnquad/training/trainer.hpp"
#include "training/log_closed_form.hpp"

namespace programs {

inline constexpr int residual_epochs = 12;

/// Of one feature set.
template <class FeatureSet>
class LogStructured {
  using Context = LogContext<FeatureSet, pinnquad::AxisCommandOutputs>;
  using Network =
      pinnquad::Network<float, pinnquad::InputSize<pinnquad::residual_inputs<FeatureSet>>, pinnquad::Clip,
                        pinnquad::Dense<48>, pinnquad::Silu, pinnquad::Dense<48>, pinnquad::Silu, pinnquad::Dense<4>>;
  using Optimizer = pinnquad::Scheduled<pinnquad::AdamW, pinnquad::CosineDecay>;
  using Shown = decltype(pinnquad::residual_context(std::declval<const Context&>()));
  using Trainer = pinnquad::Trainer<Network, pinnquad::Mse, Optimizer, Shown, pinnquad::ShuffledBatches, 128>;
  using Data = typename Trainer::Data;
  using Answer = pinnquad::MonotonePredictor<FeatureSet, Network>;

 public:
  explicit LogStructured(const FitTask& fit)
      : fit_(fit),
        rows_(rows_not_held_out(fit)),
        context_(log_context<Context>(fit, rows_)),
        epochs_(fit.epochs > 0 ? fit.epochs : residual_epochs) {}

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
      judge_without(groups, sums, out, by_epoch);
    }
    std::size_t best = 0;
    for (std::size_t epoch = 1; epoch < by_epoch.size(); ++epoch) {
      if (by_epoch[epoch].gain() > by_epoch[best].gain()) best = epoch;
    }
    const pinnquad::AffineMap ridge = solved_monotone_ridge(pinnquad::monotone_shape(context_), sums);
    const Data data = what_is_left(ridge, rows_);
    Network network{};
    if (by_epoch[best].gain() > 0) {
      train(data, static_cast<int>(best) + 1, [&network](const Network& averaged, int) { network = averaged; });
      for (int output = 0; output < Network::outputs; ++output) {
        const auto share = static_cast<float>(by_epoch[best].share(output));
        const auto row = network.parameters.end() - last_layer + std::ptrdiff_t{last_width} * output;
        for (auto weight = row; weight != row + last_width; ++weight) *weight *= share;
        *(network.parameters.end() - Network::outputs + output) *= share;
      }
    }
    return log_model_of(answer_of(ridge, network, data), context_, rows_);
  }

 private:
  static constexpr int last_width = 48;
  static constexpr std::ptrdiff_t last_layer = last_width * 4 + 4;  ///< parameters of the last layer

  /// Predictions of residuals by a network that has not seen them, group by group.
  class Agreement {
   public:
    void begin_group() { groups_.emplace_back(); }
    /// Of one output, in its own unit.
    void add(int output, double said, double truth) {
      Sums& of = groups_.back()[static_cast<std::size_t>(output)];
      of.product += said * truth;
      of.square += said * said;
    }
    /// The share of the answer that leaves the least squared error: by least squares, of 0 to 1; 0 where it does not
    /// lower that of each group.
    double share(int output) const {
      Sums all;
      for (const auto& group : groups_) all += group[static_cast<std::size_t>(output)];
      const double share = all.square > 0 ? std::min(1.0, std::max(0.0, all.product / all.square)) : 0.0;
      for (const auto& group : groups_) {
        if (!(group[static_cast<std::size_t>(output)].gain(share) > 0)) return 0;
      }
      return share;
    }
    /// By how much these shares lower the squared error of the signed sums, which is four times that of the commands.
    double gain() const {
      double all = 0;
      for (const auto& group : groups_) {
        for (int output = 0; output < Network::outputs; ++output) {
          all += group[static_cast<std::size_t>(output)].gain(share(output));
        }
      }
      return all;
    }

   private:
    /// Of answer x residual, and of answer^2.
    struct Sums {
      double product = 0, square = 0;
      double gain(double share) const { return (2 * product - share * square) * share; }
      Sums& operator+=(const Sums& other) {
        product += other.product;
        square += other.square;
        return *this;
      }
    };
    std::vector<std::array<Sums, static_cast<std::size_t>(Network::outputs)>> groups_;
  };

  /// The residual that a ridge leaves of rows, as the network is shown it.
  Data what_is_left(const pinnquad::AffineMap& ridge, const pinnquad::RowSet& rows) const {
    auto data = pinnquad::standardised<float>(context_, rows);
    pinnquad::take_away(ridge, data);
    return pinnquad::residual_rows<FeatureSet>(data);
  }

  /// The network bounded to what it says on its rows.
  static Answer answer_of(const pinnquad::AffineMap& ridge, const Network& network, const Data& data) {
    using Bound = pinnquad::MonotoneResidual<FeatureSet, Network>;
    const auto base = pinnquad::monotone_base<Context>(ridge);
    Answer answer;
    auto* const to = std::copy(base.parameters.begin(), base.parameters.end(), answer.parameters.begin());
    pinnquad::detail::take_range(network, data, to + Bound::lower, to + Bound::upper);
    std::copy(network.parameters.begin(), network.parameters.end(), to + Bound::own);
    return answer;
  }

  /// A network from the seed, `epochs` of the schedule's; after each of them `visit(averaged network, epoch)`.
  template <class Visit>
  void train(const Data& data, int epochs, const Visit& visit) const {
    std::mt19937_64 engine(fit_.seed);
    auto network = pinnquad::initialised<Network>(engine);
    std::fill(network.parameters.end() - last_layer, network.parameters.end(), 0.0F);  // begins as the ridge alone
    Optimizer optimizer;
    optimizer.optimizer.learning_rate = 1e-3;
    optimizer.optimizer.weight_decay = 0.1;
    const auto trainer =
        std::make_unique<Trainer>(network, pinnquad::Mse{}, optimizer, pinnquad::residual_context(context_));
    const auto average = std::make_unique<pinnquad::WeightAverage<Network>>();
    for (int epoch = 0; epoch < epochs; ++epoch) {
      stop_if_interrupted();
      trainer->epoch(data, {epoch, epochs_}, engine, [&](const Trainer& now) { average->add(now.network()); });
      visit(average->network(), epoch);
    }
  }

  /// Trains without a group and asks the network of it.
  void judge_without(const std::vector<pinnquad::RowSet>& groups, const std::vector<pinnquad::RegressionSums>& sums,
                     std::size_t out, std::vector<Agreement>& by_epoch) const {
    std::vector<pinnquad::RegressionSums> others;
    pinnquad::RowSet left;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (i == out) continue;
      for (const pinnquad::FlightRows& piece : groups[i].pieces()) left.add(*piece.flight, piece.rows);
      others.push_back(sums[i]);
    }
    const pinnquad::AffineMap ridge = solved_monotone_ridge(pinnquad::monotone_shape(context_), others);
    const Data unseen = what_is_left(ridge, groups[out]);
    train(what_is_left(ridge, left), epochs_, [&](const Network& averaged, int epoch) {
      Agreement& agreement = by_epoch[static_cast<std::size_t>(epoch)];
      agreement.begin_group();
      for (int row = 0; row < unseen.size(); ++row) {
        float answer[Network::outputs] = {};
        averaged.forward(unseen.features_of(row), answer);
        for (int k = 0; k < Network::outputs; ++k) {
          const double unit = context_.output.standard_deviation[static_cast<std::size_t>(k)];
          agreement.add(k, unit * static_cast<double>(answer[k]),
                        unit * static_cast<double>(unseen.outputs_of(row)[k]));
        }
      }
    });
  }

  const FitTask& fit_;
  pinnquad::RowSet rows_;
  Context context_;
  int epochs_;
};

template <TimeReach Reach>
std::shared_ptr<const TrainedNetwork> fit_log_structured(const FitTask& fit) {
  return with_physics_features<Reach>(
      fit, [&](auto tag) { return LogStructured<typename decltype(tag)::type>(fit).model(); });
}

}  // namespace programs

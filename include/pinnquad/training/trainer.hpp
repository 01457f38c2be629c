// SPDX-License-Identifier: MIT
// Trains a network: shuffled mini-batches, forward, loss, backward, optimiser step. Composition by type.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "pinnquad/core/finite.hpp"
#include "pinnquad/core/random.hpp"
#include "pinnquad/loss/loss.hpp"
#include "pinnquad/training/adam.hpp"
#include "pinnquad/training/flush_denormals.hpp"
#include "pinnquad/training/network_gradient.hpp"
#include "pinnquad/training/optimizer.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

/// Batches of a random permutation, drawn anew each epoch. Default.
struct ShuffledBatches {
  template <class Engine>
  void arrange(std::vector<int>& order, Engine& engine) const {
    shuffle(order, engine);
  }
};

/// Owns the network's parameters, the optimiser's moments and the work space of one batch (about 0.25 MB for the
/// paper's network: put it on the heap or a large stack).
template <class NetworkType, class LossType, class OptimizerType, class ContextType, class Order = ShuffledBatches,
          int BatchSize = 64>
class Trainer {
  static_assert(is_network<NetworkType>, "pinnquad: Trainer's first argument is not a Network (nn/network.hpp)");
  static_assert(is_loss<LossType>,
                "pinnquad: Trainer's second argument is not a loss; it needs evaluate(context, batch, weight, "
                "gradient) const (loss/loss.hpp)");
  static_assert(is_optimizer<OptimizerType>,
                "pinnquad: Trainer's third argument is not an optimiser; it needs begin() and update() const noexcept "
                "(training/optimizer.hpp)");
  static_assert(NetworkType::inputs == ContextType::Features::size,
                "pinnquad: the network's input count differs from the feature set's size");
  static_assert(NetworkType::outputs == ContextType::output_count,
                "pinnquad: the network's output count differs from the output schema's size");
  static_assert(BatchSize > 0, "pinnquad: Trainer's batch size must be 1 or more");

 public:
  using Network = NetworkType;
  using Scalar = typename Network::Scalar;
  using Data = TrainingData<Scalar, Network::inputs, Network::outputs>;

  /// Errors on rows that the network is not trained on; batch norm by its running statistics.
  struct ValidationErrors {
    double mean_squared = 0;   ///< over rows and outputs, standardised: the Mse of these rows
    double mean_absolute = 0;  ///< over rows and outputs, in the units of the output schema
  };

  /// Throws std::invalid_argument if a number of the loss, of its schedules, of the optimiser or of the context makes
  /// no sense (schedule/settings.hpp).
  Trainer(const Network& network, const LossType& loss, const OptimizerType& optimizer, const ContextType& context,
          const Order& order = {})
      : loss_(loss), optimizer_(optimizer), context_(context), order_policy_(order) {
    check_settings(loss_);
    check_settings(optimizer_);
    check_settings(context_);
    gradient_.load(network.parameters);
  }

  /// One pass over the data; the last batch may be smaller. Returns the mean loss over the samples; no data: 0, and no
  /// step. Throws std::invalid_argument, before any step, unless 0 <= progress.epoch < progress.epochs and the data
  /// are whole rows.
  template <class Engine>
  double epoch(const Data& data, const Progress& progress, Engine& engine) {
    return epoch(data, progress, engine, [](const Trainer&) {});
  }
  /// The same; `after_batch(*this)` is called after each step. It may project() the network.
  template <class Engine, class Observer>
  double epoch(const Data& data, const Progress& progress, Engine& engine, const Observer& after_batch) {
    if (progress.epoch < 0 || progress.epoch >= progress.epochs) {
      refuse("expected an epoch from 0 to below " + std::to_string(progress.epochs) + ", found " +
             std::to_string(progress.epoch));
    }
    check_data(data);
    context_.progress = progress;
    if (static_cast<int>(order_.size()) != data.size()) {
      order_.resize(static_cast<std::size_t>(data.size()));
      std::iota(order_.begin(), order_.end(), 0);
    }
    order_policy_.arrange(order_, engine);
    if (static_cast<int>(order_.size()) != data.size()) {
      refuse("expected an order of " + std::to_string(data.size()) + " rows as in the data, found " +
             std::to_string(order_.size()));
    }
    double sum = 0;
    for (int first = 0; first < data.size(); first += BatchSize) {
      const int size = data.size() - first < BatchSize ? data.size() - first : BatchSize;
      batch_of_epoch_ = first / BatchSize;
      batches_per_epoch_ = (data.size() + BatchSize - 1) / BatchSize;
      fetch_ahead(data, first + size);
      sum += size * static_cast<double>(batch(data, order_.data() + first, size));
      after_batch(*this);
    }
    batch_of_epoch_ = 0;
    return data.size() > 0 ? sum / data.size() : 0.0;
  }

  /// Loss of these rows and one optimiser step down its gradient. Outside epoch(), a rate policy sees the beginning of
  /// the epoch that was trained last. Throws std::invalid_argument as differentiate() does, and then nothing is
  /// changed.
  Scalar batch(const Data& data, const int* rows, int size) {
    const FlushDenormals flush;
    const Scalar value = differentiate(data, rows, size);
    gradient_.follow_statistics();
    const auto step = begin_step();
    gradient_.each([&](auto& layer, auto) {
      if constexpr (std::decay_t<decltype(layer)>::size > 0) {
        optimizer_.template update<Pack>(step, layer.stored, layer.gradient, layer.first_moment, layer.second_moment,
                                         layer.size);
      }
    });
    return value;
  }

  /// Loss of these rows and its gradient by all parameters (see parameter_gradient()); nothing is changed.
  /// Throws std::invalid_argument unless there are 1 to BatchSize rows, each of them one of the data's and finite.
  Scalar differentiate(const Data& data, const int* rows, int size) {
    check_data(data);
    if (size < 1 || size > BatchSize) {
      refuse("expected 1 to " + std::to_string(BatchSize) + " rows in a batch, found " + std::to_string(size));
    }
    for (int i = 0; i < size; ++i) {
      if (rows[i] < 0 || rows[i] >= data.size()) {
        refuse("expected a row from 0 to below " + std::to_string(data.size()) + ", found " + std::to_string(rows[i]));
      }
    }
    for (int i = 0; i < size; ++i) {  // copied first: rows drawn at random come from far away, many at a time
      std::copy_n(data.features_of(rows[i]), Network::inputs, features_ + i * Network::inputs);
      std::copy_n(data.outputs_of(rows[i]), Network::outputs, targets_ + i * Network::outputs);
    }
    if (!all_finite(features_, size * Network::inputs) || !all_finite(targets_, size * Network::outputs)) {
      refuse_row_of(data, rows, size);
    }
    loss_batch_.resize(size);
    detail::transpose<Pack>(features_, Network::inputs, size, Network::inputs, loss_batch_.features.data(), size);
    detail::transpose<Pack>(targets_, Network::outputs, size, Network::outputs, loss_batch_.target.data(), size);
    gradient_.put(features_, size);
    gradient_.forward(size);
    for (int k = 0; k < Network::outputs; ++k) {
      for (int i = 0; i < size; ++i) loss_batch_.prediction(k, i) = gradient_.output(k, i);
    }
    output_gradient_.setZero(Eigen::NoChange, size);
    const Scalar value = loss_.evaluate(context_, loss_batch_, Scalar(1), output_gradient_);
    for (int k = 0; k < Network::outputs; ++k) {
      for (int i = 0; i < size; ++i) gradient_.output_delta(k, i) = output_gradient_(k, i);
    }
    gradient_.backward(size);
    return value;
  }

  /// Errors of the network as trained so far on other rows, standardised by the same context; nothing is changed. No
  /// data: NaN, which a Checkpoint never takes. Throws std::invalid_argument unless the data are whole rows.
  ValidationErrors validate(const Data& data) {
    double squared = 0, absolute = 0;
    each_prediction(data, [&](int row, int k, double said) {
      const double difference = said - static_cast<double>(data.outputs_of(row)[k]);
      squared += difference * difference;
      absolute += std::abs(difference) * context_.output.standard_deviation[std::size_t(k)];
    });
    const double count = static_cast<double>(data.size()) * Network::outputs;
    return {squared / count, absolute / count};
  }

  /// Calls `visit(row, output, said)` for each row: the answer of the network as trained so far.
  template <class Visit>
  void each_prediction(const Data& data, const Visit& visit) {
    check_data(data);
    const FlushDenormals flush;
    for (int first = 0; first < data.size(); first += BatchSize) {
      const int size = data.size() - first < BatchSize ? data.size() - first : BatchSize;
      gradient_.put(data.features_of(first), size);
      gradient_.predict(size);
      for (int i = 0; i < size; ++i) {
        for (int k = 0; k < Network::outputs; ++k) {
          visit(first + i, k, static_cast<double>(gradient_.output(k, i)));
        }
      }
    }
  }

  /// The network as trained so far, running statistics of batch norm included.
  Network network() const {
    Network result;
    gradient_.store(result.parameters);
    return result;
  }
  /// The parameters as `projection(parameters)` leaves them; the optimiser's moments stay.
  template <class Projection>
  void project(const Projection& projection) {
    typename Network::Parameters parameters{};
    gradient_.store(parameters);
    projection(parameters);
    gradient_.load(parameters);
  }
  /// Gradient of the last differentiated batch, in the layout of Network::parameters.
  typename Network::Parameters parameter_gradient() const {
    typename Network::Parameters result{};
    gradient_.store_gradient(result);
    return result;
  }
  const ContextType& context() const noexcept { return context_; }
  long steps() const noexcept { return steps_; }

 private:
  using Gradient = detail::NetworkGradient<Network, BatchSize>;
  using Pack = typename Gradient::Pack;
  using Batch = detail::LossBatch<Scalar, Network::inputs, Network::outputs, BatchSize>;

  [[noreturn]] static void refuse(const std::string& reason) { throw std::invalid_argument("Trainer: " + reason); }

  static void check_data(const Data& data) {
    const auto rows = static_cast<std::size_t>(data.size());
    if (data.features.size() != rows * Network::inputs || data.outputs.size() != rows * Network::outputs) {
      refuse("expected rows of " + std::to_string(Network::inputs) + " features and " +
             std::to_string(Network::outputs) + " outputs, found " + std::to_string(data.features.size()) + " and " +
             std::to_string(data.outputs.size()) + " numbers");
    }
  }

  /// Asks for the rows of the batch that begins with `first` in the order: drawn at random, they come from far away,
  /// and arrive while the batch before them is worked on.
  void fetch_ahead(const Data& data, int first) const noexcept {
    constexpr int cache_line = 64 / static_cast<int>(sizeof(Scalar));
    for (int i = first; i < data.size() && i < first + BatchSize; ++i) {
      const int row = order_[static_cast<std::size_t>(i)];
      if (row < 0 || row >= data.size()) return;  // refused when its turn comes
      const Scalar* const features = data.features_of(row);
      for (int k = 0; k < Network::inputs; k += cache_line) __builtin_prefetch(features + k);
      __builtin_prefetch(features + Network::inputs - 1);
      __builtin_prefetch(data.outputs_of(row));
    }
  }

  /// One of these rows is not finite.
  [[noreturn]] static void refuse_row_of(const Data& data, const int* rows, int size) {
    const int* const bad = std::find_if(rows, rows + size, [&](int row) {
      return !all_finite(data.features_of(row), Network::inputs) || !all_finite(data.outputs_of(row), Network::outputs);
    });
    refuse("expected finite numbers, found others in row " + std::to_string(*bad));
  }

  auto begin_step() {
    ++steps_;
    const double epochs =
        context_.progress.epochs > 0 ? context_.progress.epochs : 1;  // the context's, outside epoch()
    const double within = static_cast<double>(batch_of_epoch_) / batches_per_epoch_;
    return optimizer_.begin(steps_, (context_.progress.epoch + within) / epochs);
  }

  LossType loss_;
  OptimizerType optimizer_;
  ContextType context_;
  Order order_policy_;
  Gradient gradient_{};
  Batch loss_batch_{};
  alignas(64) Scalar features_[std::size_t(BatchSize * Network::inputs)] = {};  // of a batch, row by row
  alignas(64) Scalar targets_[std::size_t(BatchSize * Network::outputs)] = {};
  typename Batch::Gradient output_gradient_{};
  std::vector<int> order_;
  long steps_ = 0;
  int batch_of_epoch_ = 0;
  int batches_per_epoch_ = 1;
};

}  // namespace pinnquad

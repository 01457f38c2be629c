// SPDX-License-Identifier: MIT
// Which weights of a training are kept: the best so far by an error on validation rows, and when to stop waiting for better.
//   Checkpoint<Network> best;  EarlyStopping stopping{30};
//   for (int epoch = 0; epoch < epochs && !stopping.reached(best, epoch); ++epoch) {
//     trainer.epoch(data, {epoch, epochs}, engine);
//     best.offer(epoch, trainer.validate(validation).mean_absolute, trainer);
//   }
#pragma once

#include <limits>
#include <stdexcept>

namespace pinnquad {

/// The network with the least error of those offered; of equals the earliest. A NaN is never the least.
template <class NetworkType>
class Checkpoint {
 public:
  /// Looks at the error after `epoch` (from 0); `source.network()` is asked for only if it is the best. Returns whether it is.
  template <class Source>
  bool offer(int epoch, double error, const Source& source) {
    if (!(error < error_)) return false;
    error_ = error;
    epoch_ = epoch;
    network_ = source.network();
    return true;
  }

  bool empty() const noexcept { return epoch_ < 0; }
  int epoch() const noexcept { return epoch_; }     ///< -1 before the first
  double error() const noexcept { return error_; }  ///< infinite before the first
  /// Throws std::logic_error if none was taken: before the first offer, or if every error was NaN.
  const NetworkType& network() const {
    if (empty()) throw std::logic_error("Checkpoint: expected a network with an error, found none");
    return network_;
  }

 private:
  NetworkType network_{};
  double error_ = std::numeric_limits<double>::infinity();
  int epoch_ = -1;
};

/// Ends a training whose error has not fallen for `patience` epochs; 0 never ends one.
struct EarlyStopping {
  int patience = 0;

  /// True if `epoch` (from 0) need not be begun.
  template <class NetworkType>
  bool reached(const Checkpoint<NetworkType>& best, int epoch) const noexcept {
    return patience > 0 && epoch - best.epoch() > patience;
  }
};

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// The weights of a training that are kept: the best by an error on validation rows.
//   Checkpoint<Network> best;
//   for (int epoch = 0; epoch < epochs && !best.is_stale(epoch, 30); ++epoch) {
//     trainer.epoch(data, {epoch, epochs}, engine);
//     best.offer(epoch, trainer.validate(validation).mean_absolute, trainer);
//   }
#pragma once

#include <cstddef>
#include <limits>
#include <stdexcept>

namespace pinnquad {

/// The network with the least error of those offered; of equals the earliest. A NaN is never the least.
template <class NetworkType>
class Checkpoint {
 public:
  /// Looks at the error after `epoch` (from 0); `source.network()` is asked for only if it is the best. Returns
  /// whether it is.
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
  /// True if the error has not fallen for `patience` epochs, so that `epoch` (from 0) need not be begun; 0 waits for
  /// ever.
  bool is_stale(int epoch, int patience) const noexcept { return patience > 0 && epoch - epoch_ > patience; }
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

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// A mini-batch as the trainer hands it to a loss.
#pragma once

#include "pinnquad/core/types.hpp"

namespace pinnquad {

/// One mini-batch as a loss sees it: a sample is a column. No heap: `MaxSize` is the capacity.
template <class ScalarType, int InputCount, int OutputCount, int MaxSize>
struct LossBatch {
  using Scalar = ScalarType;
  template <int Rows>
  using Samples =
      Eigen::Matrix<Scalar, Rows, Eigen::Dynamic, int(Eigen::ColMajor) | int(Eigen::DontAlign), Rows, MaxSize>;
  using Gradient = Samples<OutputCount>;
  static constexpr int inputs = InputCount;
  static constexpr int outputs = OutputCount;
  static constexpr int max_size = MaxSize;

  Samples<InputCount> features;     ///< standardised X
  Samples<OutputCount> prediction;  ///< standardised network output
  Samples<OutputCount> target;      ///< standardised Y

  int size() const noexcept { return static_cast<int>(prediction.cols()); }
  void resize(int samples) {
    features.resize(Eigen::NoChange, samples);
    prediction.resize(Eigen::NoChange, samples);
    target.resize(Eigen::NoChange, samples);
  }
};

}  // namespace pinnquad

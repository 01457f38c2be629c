// SPDX-License-Identifier: MIT
// Mean squared error over batch and outputs.
#pragma once

#include "pinnquad/loss/loss.hpp"

namespace pinnquad {

/// L = mean over samples and outputs of (prediction - target)^2, standardised units (PyTorch's meaning).
/// Algorithm 1 divides by N_b only: a lambda of the paper weighs four times as much here (docs/paper.md, deviation 10).
struct Mse {
  template <class Context, class Batch, class Gradient>
  typename Batch::Scalar evaluate(const Context&, const Batch& batch, typename Batch::Scalar weight,
                                  Gradient& gradient) const {
    using Scalar = typename Batch::Scalar;
    const Scalar count = Scalar(batch.prediction.size());
    gradient += (Scalar(2) * weight / count) * (batch.prediction - batch.target);
    return (batch.prediction - batch.target).squaredNorm() / count;
  }
};

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// The contract of a loss on one mini-batch:
//   template <class Context, class Batch, class Gradient> typename Batch::Scalar evaluate(const Context&, const Batch&,
//       typename Batch::Scalar weight, Gradient& gradient) const;
// returns the loss and ADDS weight * d loss / d prediction to `gradient`. Predictions and targets are standardised.
// The trainer gives it the context and the batch: loss/context.hpp.
#pragma once

#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/loss/context.hpp"

namespace pinnquad {

namespace detail {
/// A context and a batch, to see whether a type is a loss; never evaluated.
using ProbeContext = Context<PaperFeatures, PaperQuadrotor>;
using ProbeBatch = LossBatch<double, PaperFeatures::size, rotor_count, 8>;
template <class T>
using LossOf =
    std::enable_if_t<std::is_same_v<decltype(std::declval<const T&>().evaluate(std::declval<const ProbeContext&>(),
                                                                               std::declval<const ProbeBatch&>(), 1.0,
                                                                               std::declval<ProbeBatch::Gradient&>())),
                                    double>>;
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_loss = is_detected<detail::LossOf, T>;

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

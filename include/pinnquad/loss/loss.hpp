// SPDX-License-Identifier: MIT
// The contract of a loss on one mini-batch:
//   template <class Context, class Batch, class Gradient> typename Batch::Scalar evaluate(const Context&, const Batch&,
//       typename Batch::Scalar weight, Gradient& gradient) const;
// returns the loss and ADDS weight * d loss / d prediction to `gradient`. Predictions and targets are standardised.
// The trainer gives it the context and the batch: training/context.hpp.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/data/settings.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/schedule/schedule.hpp"

namespace pinnquad {

namespace detail {
/// The members of a context and of a batch, to see whether a type is a loss; never evaluated.
struct ProbeContext {
  struct Vehicle {
    static constexpr const char* name = "probe";
    template <class Scalar>
    static constexpr Airframe<Scalar> value() {
      return Airframe<Scalar>{};
    }
  };
  using Features = PaperFeatures;
  using Outputs = CommandOutputs;
  static constexpr int output_count = rotor_count;
  Scaler<double, Features::size> input{};
  Scaler<double, output_count> output{};
  std::array<double, 3> signed_sum_spread{};
  Progress progress{};
  template <class Axis>
  static constexpr std::array<double, rotor_count> signs() noexcept {
    return {};
  }
};
struct ProbeBatch {
  using Scalar = double;
  template <int Rows>
  using Samples = Eigen::Matrix<double, Rows, Eigen::Dynamic, int(Eigen::ColMajor) | int(Eigen::DontAlign), Rows, 8>;
  using Gradient = Samples<rotor_count>;
  static constexpr int inputs = PaperFeatures::size;
  static constexpr int outputs = rotor_count;
  static constexpr int max_size = 8;
  Samples<inputs> features;
  Samples<outputs> prediction;
  Samples<outputs> target;
  int size() const noexcept { return 0; }
};
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

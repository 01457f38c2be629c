// SPDX-License-Identifier: MIT
// The contract of a loss on one mini-batch:
//   template <class Context, class Batch, class Gradient> typename Batch::Scalar evaluate(const Context&, const Batch&,
//       typename Batch::Scalar weight, Gradient& gradient) const;
// returns the loss and ADDS weight * d loss / d prediction to `gradient`. Predictions and targets are standardised.
// What it is given is the trainer's: training/context.hpp, training/loss_batch.hpp.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "pinnquad/data/settings.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/schedule/progress.hpp"

namespace pinnquad {

namespace detail {
/// What a loss is asked with to see that it is one: the members of a context and of a batch, never evaluated.
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
template <class T, class = void>
struct IsLoss : std::false_type {};
template <class T>
struct IsLoss<T, std::void_t<decltype(std::declval<const T&>().evaluate(std::declval<const ProbeContext&>(),
                                                                        std::declval<const ProbeBatch&>(), 1.0,
                                                                        std::declval<ProbeBatch::Gradient&>()))>>
    : std::is_same<decltype(std::declval<const T&>().evaluate(std::declval<const ProbeContext&>(),
                                                              std::declval<const ProbeBatch&>(), 1.0,
                                                              std::declval<ProbeBatch::Gradient&>())),
                   double> {};
}  // namespace detail

/// True for a type that fulfils the contract at the head of this file.
template <class T>
inline constexpr bool is_loss = detail::IsLoss<T>::value;

}  // namespace pinnquad

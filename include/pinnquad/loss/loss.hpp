// SPDX-License-Identifier: MIT
// The contract of a loss on one mini-batch:
//   template <class Context, class Batch, class Gradient> typename Batch::Scalar evaluate(const Context&, const Batch&,
//       typename Batch::Scalar weight, Gradient& gradient) const;
// returns the loss and ADDS weight * d loss / d prediction to `gradient`. Predictions and targets are standardised.
#pragma once

#include <array>
#include <type_traits>
#include <utility>

#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/inference/features.hpp"
#include "pinnquad/inference/output_schema.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/schedule/settings.hpp"

namespace pinnquad {

/// Where training stands: for schedules.
struct Progress {
  int epoch = 0;  ///< from 0
  int epochs = 1;
};

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

/// What a loss may know beside the batch: what inputs and outputs mean, and how they were standardised.
template <class FeatureSet, class VehicleType, class Schema = CommandOutputs>
struct Context {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: Context's first argument is not a feature set (inference/features.hpp)");
  static_assert(is_airframe<VehicleType>,
                "pinnquad: Context's second argument is not an airframe (dynamics/airframe.hpp)");
  static_assert(is_output_schema<Schema>,
                "pinnquad: Context's third argument is not an output schema (inference/output_schema.hpp)");
  using Features = FeatureSet;
  using Vehicle = VehicleType;
  using Outputs = Schema;

  static constexpr int output_count = OutputMap<Outputs>::size;

  Scaler<double, Features::size> input{};  ///< physical -> standardised, by the training set
  Scaler<double, output_count> output{};
  std::array<double, 3> signed_sum_spread{1.0, 1.0, 1.0};  ///< spread of the signed command sums, training set
  Progress progress{};

  /// Throws std::invalid_argument unless every mean is finite and every spread a finite number above 0. What a flight with a NaN
  /// leaves here would make every weight NaN.
  constexpr void check() const {
    check_scaler("Context::input", input.mean, input.spread);
    check_scaler("Context::output", output.mean, output.spread);
    check_scaler("Context::signed_sum_spread", std::array<double, 3>{}, signed_sum_spread);
  }

  /// Signs of the commands in the torque about an axis: a row of Eq. (2) for this airframe.
  template <class Axis>
  static constexpr std::array<double, rotor_count> signs() noexcept {
    return allocation_signs(airframe_value<Vehicle, double>(), Axis::axis);
  }

 private:
  template <class Values>
  static constexpr void check_scaler(const char* setting, const Values& mean, const Values& spread) {
    for (std::size_t i = 0; i < spread.size(); ++i) {
      detail::expect_finite(setting, mean[i]);
      if (!(spread[i] > 0.0)) detail::refuse_setting(setting, "a spread above 0", spread[i]);
      detail::expect_finite(setting, spread[i]);
    }
  }
};

namespace detail {
struct ProbeVehicle {
  static constexpr const char* name = "probe";
  template <class Scalar>
  static constexpr Airframe<Scalar> value() {
    return Airframe<Scalar>{};
  }
};
using ProbeContext = Context<PaperFeatures, ProbeVehicle>;
using ProbeBatch = LossBatch<double, PaperFeatures::size, rotor_count, 8>;
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

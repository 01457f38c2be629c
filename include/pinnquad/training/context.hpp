// SPDX-License-Identifier: MIT
// The two things that the trainer gives a loss: the context (features, airframe, outputs, their standardisation, the
// epoch) and the mini-batch.
#pragma once

#include <array>

#include "pinnquad/core/types.hpp"
#include "pinnquad/data/settings.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/schedule/schedule.hpp"
#include "pinnquad/training/context_airframe.hpp"

namespace pinnquad {

template <class FeatureSet, class VehicleType, class Schema = CommandOutputs>
struct Context : ContextAirframe<VehicleType> {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: Context's first argument is not a feature set (features/features.hpp)");
  static_assert(
      is_output_schema<Schema>,
      "pinnquad: Context's third argument is not an output schema; its short form has four names, one per rotor "
      "(outputs/output_schema.hpp)");
  static_assert(base_reads<FeatureSet, Schema>(),
                "pinnquad: the base of Context's outputs reads a feature that the feature set has not, or not there "
                "(outputs/base.hpp)");
  using Features = FeatureSet;
  using Vehicle = VehicleType;
  using Outputs = Schema;

  static constexpr int output_count = OutputMap<Outputs>::size;

  Scaler<double, Features::size> input{};  ///< physical -> standardised, by the training set
  Scaler<double, output_count> output{};
  std::array<double, 3> signed_sum_spread{1.0, 1.0, 1.0};  ///< standard deviations of the signed command sums
  Progress progress{};

  /// Throws std::invalid_argument unless every mean is finite and every standard deviation is finite and above 0. A
  /// NaN here would make every weight NaN.
  constexpr void check() const {
    check_scaler("Context::input", input.mean, input.standard_deviation);
    check_scaler("Context::output", output.mean, output.standard_deviation);
    check_scaler("Context::signed_sum_spread", std::array<double, 3>{}, signed_sum_spread);
  }

 private:
  template <class Values>
  static constexpr void check_scaler(const char* setting, const Values& mean, const Values& deviation) {
    for (std::size_t i = 0; i < deviation.size(); ++i) {
      detail::expect_finite(setting, mean[i]);
      if (!(deviation[i] > 0.0)) detail::refuse_setting(setting, "a standard deviation above 0", deviation[i]);
      detail::expect_finite(setting, deviation[i]);
    }
  }
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

}  // namespace pinnquad

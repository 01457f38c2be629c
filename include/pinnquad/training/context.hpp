// SPDX-License-Identifier: MIT
// What the trainer tells a loss beside the batch: which features, airframe and outputs, how they were standardised, where training
// stands.
#pragma once

#include <array>

#include "pinnquad/data/settings.hpp"
#include "pinnquad/features/features.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/base.hpp"
#include "pinnquad/outputs/output_schema.hpp"
#include "pinnquad/schedule/progress.hpp"
#include "pinnquad/training/context_airframe.hpp"

namespace pinnquad {

template <class FeatureSet, class VehicleType, class Schema = CommandOutputs>
struct Context : ContextAirframe<VehicleType> {
  static_assert(is_feature_set<FeatureSet>,
                "pinnquad: Context's first argument is not a feature set (features/features.hpp)");
  static_assert(is_output_schema<Schema>,
                "pinnquad: Context's third argument is not an output schema (outputs/output_schema.hpp)");
  static_assert(base_reads<FeatureSet, Schema>(),
                "pinnquad: the base of Context's outputs reads a feature that the feature set has not, or not there "
                "(outputs/base.hpp)");
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
    check_scaler("Context::input", input.mean, input.standard_deviation);
    check_scaler("Context::output", output.mean, output.standard_deviation);
    check_scaler("Context::signed_sum_spread", std::array<double, 3>{}, signed_sum_spread);
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

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// A feature set less its angular accelerations: what the residual of a model that is monotone in them is trained on.
#pragma once

#include <array>

#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/outputs/axis_command_outputs.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

namespace detail {
/// The texts of all features that are not in threes.
template <class Threes, std::size_t Size>
constexpr std::array<const char*, static_cast<std::size_t>(Threes::others)> other_texts(
    const std::array<const char*, Size>& all) noexcept {
  std::array<const char*, static_cast<std::size_t>(Threes::others)> kept{};
  Threes::each_other(
      [&](int feature, int n) { kept[static_cast<std::size_t>(n)] = all[static_cast<std::size_t>(feature)]; });
  return kept;
}
}  // namespace detail

template <class FeatureSet>
struct ResidualFeatures {
  using Threes = typename MonotoneBase<FeatureSet>::Threes;
  template <class Scalar>
  using Inputs = typename FeatureSet::template Inputs<Scalar>;

  static constexpr int size = residual_inputs<FeatureSet>;
  static constexpr int angular_acceleration = -1;

  static constexpr auto names = detail::other_texts<Threes>(FeatureSet::names);
  static constexpr auto units = detail::other_texts<Threes>(FeatureSet::units);

  template <class AnyInputs>
  static Status check(const AnyInputs& in) noexcept {
    return FeatureSet::check(in);
  }
  template <class Scalar, class AnyInputs>
  static void extract(const AnyInputs& in, Scalar* x) noexcept {
    Scalar all[FeatureSet::size];
    FeatureSet::extract(in, static_cast<Scalar*>(all));
    Threes::each_other([&](int feature, int n) { x[n] = all[feature]; });
  }
};

/// The context of a residual: that of the whole model, less the angular accelerations. It answers signed sums: a formula
/// that the model's are added to would not find its features here.
template <class ContextType>
using ResidualContext =
    Context<ResidualFeatures<typename ContextType::Features>, typename ContextType::Vehicle, AxisCommandOutputs>;

template <class ContextType>
ResidualContext<ContextType> residual_context(const ContextType& context) {
  ResidualContext<ContextType> residual{static_cast<const ContextAirframe<typename ContextType::Vehicle>&>(context)};
  ResidualContext<ContextType>::Features::Threes::each_other([&](int feature, int n) {
    residual.input.mean[static_cast<std::size_t>(n)] = context.input.mean[static_cast<std::size_t>(feature)];
    residual.input.standard_deviation[static_cast<std::size_t>(n)] =
        context.input.standard_deviation[static_cast<std::size_t>(feature)];
  });
  residual.output = context.output;
  residual.signed_sum_spread = context.signed_sum_spread;
  return residual;
}

/// Rows of the whole model's features, as the residual is shown them.
template <class FeatureSet, class Scalar, int OutputCount>
TrainingData<Scalar, residual_inputs<FeatureSet>, OutputCount> residual_rows(
    const TrainingData<Scalar, FeatureSet::size, OutputCount>& all) {
  TrainingData<Scalar, residual_inputs<FeatureSet>, OutputCount> rows;
  rows.outputs = all.outputs;
  rows.weights = all.weights;
  rows.features.reserve(static_cast<std::size_t>(all.size()) * static_cast<std::size_t>(residual_inputs<FeatureSet>));
  for (int row = 0; row < all.size(); ++row) {
    const Scalar* x = all.features_of(row);
    ResidualFeatures<FeatureSet>::Threes::each_other([&](int feature, int) { rows.features.push_back(x[feature]); });
  }
  return rows;
}

}  // namespace pinnquad

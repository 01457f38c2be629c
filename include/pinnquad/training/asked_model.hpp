// SPDX-License-Identifier: MIT
// A trained model as a value: what exports, golden vectors and limits of trust ask of it. Code that takes one is
// compiled once for all types of models.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/exported/stated_bounds.hpp"
#include "pinnquad/training/ground_features.hpp"
#include "pinnquad/training/trained_model.hpp"

namespace pinnquad {

/// Numbers are doubles that hold the model's own scalar.
struct AskedModel {
  AskedModel() = default;
  /// Made of a TrainedModel, or of a class of one's own with the same members.
  template <class Model, class = typename Model::Features::template Inputs<double>>
  AskedModel(const Model& model);

  std::string airframe_name;
  Airframe<double> airframe{};
  std::vector<std::string> units;  ///< of the features
  std::vector<bool> is_column;     ///< of the features: the export holds it at the envelope's edge, and answers
  std::vector<double> envelope_lower, envelope_upper;
  bool is_double = false;
  /// Calls `visit` for each row that has features, as the model's scalar has them.
  GroundFeatures::EachRow each_row;
  /// The same, worked out in double.
  GroundFeatures::EachRow each_exact_row;
  std::function<Commands<double>(const double* x)> predict;  ///< as TrainedModel::predict()
  /// The standardised outputs of a bounded residual, before they are bounded; empty for a model without one.
  std::function<void(const double* x, double* y)> residual;
  std::vector<double> residual_lower, residual_upper;  ///< standardised

  std::size_t size() const { return envelope_lower.size(); }
};

namespace detail {

template <class FeatureVector>
FeatureVector as_features(const double* x) {
  FeatureVector own{};
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = static_cast<typename FeatureVector::value_type>(x[i]);
  return own;
}

/// Units and columns of a feature set.
template <class Features>
void take_features(AskedModel& asked) {
  asked.units.assign(Features::units.begin(), Features::units.end());
  for (int i = 0; i < Features::size; ++i) asked.is_column.push_back(is_column<Features>(i));
}

/// Statistics of every feature, physical units.
inline std::vector<ColumnStatistics> feature_statistics(const AskedModel& model, const RowSet& rows) {
  return column_statistics({model.units.begin(), model.units.end()}, [&](const RowVisit& visit) {
    model.each_exact_row(rows, [&](const Flight&, std::size_t, const double* x) { visit(x); });
  });
}

/// Without rows: of a model whose Inputs no row has.
template <class Model>
AskedModel asked_without_rows(const Model& model) {
  using FeatureVector = std::decay_t<decltype(model.envelope_lower)>;
  AskedModel asked;
  asked.airframe_name = model.airframe_name();
  asked.airframe = model.template airframe<double>();
  take_features<typename Model::Features>(asked);
  asked.envelope_lower.assign(model.envelope_lower.begin(), model.envelope_lower.end());
  asked.envelope_upper.assign(model.envelope_upper.begin(), model.envelope_upper.end());
  asked.is_double = std::is_same_v<typename Model::Scalar, double>;
  asked.predict = [model](const double* x) { return in_double(model.predict(as_features<FeatureVector>(x))); };
  return asked;
}

}  // namespace detail

template <class Model, class>
AskedModel::AskedModel(const Model& model) : AskedModel(detail::asked_without_rows(model)) {
  each_row = detail::rows_of_features<typename Model::Features, typename Model::Scalar>();
  each_exact_row = detail::rows_of_features<typename Model::Features, double>();
  if constexpr (detail::has_bounded_residual<typename Model::Network>) {
    using Structure = detail::StatedStructure<typename Model::Network>;
    using Scalar = typename Model::Scalar;
    static constexpr std::size_t outputs = Model::Network::outputs;
    const auto* const bounds = model.network.parameters.data() + Structure::at;
    residual_lower.assign(bounds, bounds + outputs);
    residual_upper.assign(bounds + outputs, bounds + 2 * outputs);
    residual = [model](const double* x, double* y) {
      const auto own = detail::as_features<typename Model::FeatureVector>(x);
      typename Model::FeatureVector z{};
      Scalar made[outputs] = {};
      model.input.standardise(own.data(), z.data());
      Structure::Inner::forward(model.network.parameters.data() + Structure::at + 2 * outputs, z.data(),
                                static_cast<Scalar*>(made));
      for (std::size_t k = 0; k < outputs; ++k) y[k] = static_cast<double>(made[k]);
    };
  }
}

}  // namespace pinnquad

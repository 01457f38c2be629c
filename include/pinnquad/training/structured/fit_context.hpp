// SPDX-License-Identifier: MIT
// A context (loss/context.hpp) as a value. A fit that takes one is compiled once for all feature sets.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/training/ground_features.hpp"
#include "pinnquad/training/ground_outputs.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

namespace detail {
/// The places of so many features but the threes from these places on, ascending.
std::vector<int> other_features(int count, const std::vector<int>& threes);

}  // namespace detail

/// The features of a set and the outputs of a schema, and how a training set standardises them.
struct FitContext {
  /// Called for each row that has features: these and the outputs, in physical units.
  using Visit = std::function<void(const Flight& flight, std::size_t row, const double* x, const double* y)>;

  GroundFeatures features;
  GroundOutputs schema;
  std::string airframe_name;
  Airframe<double> airframe;
  std::vector<double> input_mean, input_deviation;
  std::vector<double> output_mean, output_deviation;

  int inputs() const { return static_cast<int>(features.size()); }
  int outputs() const { return static_cast<int>(schema.names.size()); }
  bool is_windowed() const { return features.window.taps > 1; }
  void each_row(const RowSet& rows, const Visit& visit) const;
  /// Calls `visit` as each_row() does, with standardised numbers.
  void each_standardised(const RowSet& rows, const Visit& visit) const;
};

/// The context of a training set. Throws std::invalid_argument where no row has all features.
FitContext fit_context(GroundFeatures features, GroundOutputs schema, const GivenAirframe& airframe,
                       const RowSet& rows);

/// A context of types as a value.
template <class ContextType>
FitContext fit_context(const ContextType& context) {
  FitContext value{ground_features<typename ContextType::Features>(),
                   ground_outputs<typename ContextType::Outputs>(context),
                   context.airframe_name(),
                   context.template airframe<double>(),
                   {},
                   {},
                   {},
                   {}};
  const auto take = [](const auto& from, std::vector<double>& to) { to.assign(from.begin(), from.end()); };
  take(context.input.mean, value.input_mean);
  take(context.input.standard_deviation, value.input_deviation);
  take(context.output.mean, value.output_mean);
  take(context.output.standard_deviation, value.output_deviation);
  return value;
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/fit_context.hpp"
#endif

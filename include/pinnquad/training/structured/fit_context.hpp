// SPDX-License-Identifier: MIT
// A context (loss/context.hpp) as a value. A fit that takes one is compiled once for all feature sets.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/model/certified_numbers.hpp"
#include "pinnquad/training/training_data.hpp"

namespace pinnquad {

namespace detail {
/// The places of so many features but the threes from these places on, ascending.
std::vector<int> other_features(int count, const std::vector<int>& threes);
}  // namespace detail

/// The features of a set and the outputs of a schema: how rows show them, and how a training set standardises them.
struct FitContext {
  /// Called for each row that has features: these and the outputs, in physical units.
  using Visit = std::function<void(const Flight& flight, std::size_t row, const double* x, const double* y)>;

  std::vector<const char*> units;  ///< of the features
  std::vector<double> input_mean, input_deviation;
  std::vector<double> output_mean, output_deviation;
  std::function<void(const RowSet& rows, const Visit& visit)> each_row;
  Airframe<double> airframe;
  std::vector<int> accelerations;   ///< places of each tap's angular acceleration about x, the present first
  std::vector<int> thrusts;         ///< of each tap's specific force along the thrust axis, the present first
  std::vector<double> tap_times_s;  ///< of a window, the present first; empty without a window
  double tap_tolerance_s = 0;
  /// The context of a window's present instant alone, of these rows; empty without a window.
  std::function<FitContext(const RowSet& rows)> present;

  int inputs() const { return static_cast<int>(input_mean.size()); }
  int outputs() const { return static_cast<int>(output_mean.size()); }
  bool is_windowed() const { return !tap_times_s.empty(); }
  /// Calls `visit` as each_row() does, with standardised numbers.
  void each_standardised(const RowSet& rows, const Visit& visit) const {
    std::vector<double> z(input_mean.size() + output_mean.size());
    each_row(rows, [&](const Flight& flight, std::size_t row, const double* x, const double* y) {
      double* const outputs_from = z.data() + input_mean.size();
      for (std::size_t i = 0; i < input_mean.size(); ++i) z[i] = (x[i] - input_mean[i]) / input_deviation[i];
      for (std::size_t k = 0; k < output_mean.size(); ++k) {
        outputs_from[k] = (y[k] - output_mean[k]) / output_deviation[k];
      }
      visit(flight, row, z.data(), outputs_from);
    });
  }
};

/// A context of types as a value.
template <class ContextType>
FitContext fit_context(const ContextType& context) {
  using Features = typename ContextType::Features;
  using Vehicle = typename ContextType::Vehicle;
  using Outputs = typename ContextType::Outputs;
  FitContext value;
  const auto take = [](const auto& from, std::vector<double>& to) { to.assign(from.begin(), from.end()); };
  value.units.assign(Features::units.begin(), Features::units.end());
  take(context.input.mean, value.input_mean);
  take(context.input.standard_deviation, value.input_deviation);
  take(context.output.mean, value.output_mean);
  take(context.output.standard_deviation, value.output_deviation);
  value.airframe = context.template airframe<double>();
  value.each_row = [airframe = static_cast<const detail::ContextAirframe<Vehicle>&>(context)](
                       const RowSet& rows, const FitContext::Visit& visit) {
    const auto setting = airframe.template output_setting<Outputs, double>();
    each_features<Features, double>(rows, [&](const Flight& flight, std::size_t row, const auto& x) {
      const auto y = detail::sample_outputs<ContextType>(x, flight[row], setting);
      visit(flight, row, x.data(), y.data());
    });
  };
  if constexpr (Features::angular_acceleration >= 0) {
    for (int tap = 0; tap < detail::angular_acceleration_taps<Features>(); ++tap) {
      value.accelerations.push_back(angular_acceleration_at<Features>(tap));
    }
  }
  constexpr auto thrusts = detail::thrust_places<Features>();
  value.thrusts.assign(thrusts.place, thrusts.place + thrusts.count);
  if constexpr (is_windowed<Features>) {
    using Window = typename Features::Window;
    for (int tap = 0; tap < Window::taps; ++tap) {
      value.tap_times_s.push_back(tap == 0 ? 0.0 : Window::offset_s(tap - 1));
    }
    value.tap_tolerance_s = Window::tolerance_s;
    value.present = [airframe = static_cast<const detail::ContextAirframe<Vehicle>&>(context)](const RowSet& rows) {
      using Present = Context<typename Features::TapFeatures, Vehicle, Outputs>;
      return fit_context(make_context<Present>(rows, airframe));
    };
  }
  return value;
}

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/structured/impl/fit_context.hpp"
#endif

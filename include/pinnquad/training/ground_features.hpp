// SPDX-License-Identifier: MIT
// A feature set as a value: names, units, and how rows show it. It is made of a type, or of names that are known when a
// program runs. Code that takes one is compiled once for all feature sets.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/exported/run_time_features.hpp"
#include "pinnquad/model/certified_numbers.hpp"
#include "pinnquad/training/described_predictor.hpp"

namespace pinnquad {

/// The features of a model on the ground.
struct GroundFeatures {
  /// Called for each row that has features: these, in physical units.
  using Visit = std::function<void(const Flight& flight, std::size_t row, const double* x)>;
  using EachRow = std::function<void(const RowSet& rows, const Visit& visit)>;

  std::string type;  ///< as a header names it
  std::vector<std::string> names, units;
  std::vector<ColumnName> columns;  ///< that it asks of a flight
  RunTimeFeatures::Window window;
  std::vector<int> accelerations;  ///< places of each tap's angular acceleration about x, the present first
  EachRow each_row;                ///< worked out in float
  EachRow each_exact_row;          ///< in double

  std::size_t size() const { return names.size(); }
  /// True of a feature that is a column, at whatever tap of a window.
  bool is_column(std::size_t feature) const;
  /// Places of each tap's specific force along the thrust axis, those of the present instant first.
  std::vector<int> thrusts() const;
};

namespace detail {

template <class Features, class Scalar>
GroundFeatures::EachRow rows_of_features() {
  return [](const RowSet& rows, const GroundFeatures::Visit& visit) {
    each_features<Features, Scalar>(rows, [&visit](const Flight& flight, std::size_t row, const auto& x) {
      if constexpr (std::is_same_v<Scalar, double>) {
        visit(flight, row, x.data());
      } else {
        const std::vector<double> own(x.begin(), x.end());
        visit(flight, row, own.data());
      }
    });
  };
}

/// Motions of a flight's rows as features by name ask for them. Windows in a row share most of their rows: a row that
/// was read is kept for the next window, so one of these is for one thread. Throws std::invalid_argument for a flight
/// without a column that is asked for.
template <class Scalar>
class RunTimeFlightInputs {
 public:
  using Inputs = RunTimeFeatures::Inputs<Scalar>;

  RunTimeFlightInputs(const RunTimeFeatures& features, const FlightRows& rows)
      : features_(&features), rows_(rows), kept_(features.window().taps > 1 ? 128 : 0) {
    for (int i = 0; i < features.column_count(); ++i) {
      const auto [name, unit] = features.column(i);
      columns_.push_back(&column_values(*rows.flight, std::string(name), std::string(unit)));
    }
  }

  /// `taps`: as many as the window has, the present first. False where the rows do not hold them.
  bool read(std::size_t row, Inputs* taps) const {
    taps[0] = present(row);
    const RunTimeFeatures::Window& window = features_->window();
    const auto read_row = [this](std::size_t i, Inputs& inputs) {
      Kept& kept = kept_[i % kept_.size()];
      if (kept.row != i) kept = {i, present(i)};
      inputs = kept.inputs;
      return true;
    };
    return window.taps == 1 || read_window<Scalar>(window, rows_, row, read_row, taps + 1);
  }

  /// A row alone.
  Inputs present(std::size_t row) const {
    Inputs inputs;
    static_cast<MotionInputsWithAltitude<Scalar>&>(inputs) =
        sample_inputs<MotionInputsWithAltitude<Scalar>>((*rows_.flight)[row]);
    for (std::size_t i = 0; i < columns_.size(); ++i) inputs.columns[i] = static_cast<Scalar>((*columns_[i])[row]);
    return inputs;
  }

 private:
  struct Kept {
    std::size_t row = static_cast<std::size_t>(-1);
    Inputs inputs{};
  };

  const RunTimeFeatures* features_;
  FlightRows rows_;
  std::vector<const std::vector<double>*> columns_;
  mutable std::vector<Kept> kept_;
};

}  // namespace detail

/// The features of a type.
template <class Features>
GroundFeatures ground_features() {
  using Window = detail::WindowOf<Features>;
  GroundFeatures value;
  value.type = type_name<Features>();
  value.names.assign(Features::names.begin(), Features::names.end());
  value.units.assign(Features::units.begin(), Features::units.end());
  value.columns = wanted_columns<Features>();
  value.each_row = detail::rows_of_features<Features, float>();
  value.each_exact_row = detail::rows_of_features<Features, double>();
  if constexpr (Features::angular_acceleration >= 0) {
    for (int tap = 0; tap < detail::angular_acceleration_taps<Features>(); ++tap) {
      value.accelerations.push_back(angular_acceleration_at<Features>(tap));
    }
  }
  if constexpr (is_windowed<Features>) {
    value.window = RunTimeFeatures::Window(Window::taps, Window::causal, Window::period_s);
  }
  return value;
}

/// Features by name: those of the library are worked out from the motion, any other one is a column of the same name.
/// "w_x[-2]" is w_x at another tap of the window, behind the features of the present (exported/run_time_features.hpp).
/// `type`: as a header names this set. Throws std::invalid_argument for names that are no such set.
GroundFeatures named_features(const std::string& type, const std::vector<std::string>& names,
                              const std::vector<std::string>& units, const RunTimeFeatures::Window& window = {});

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/training/impl/ground_features.hpp"
#endif

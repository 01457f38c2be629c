// SPDX-License-Identifier: MIT
// A model over recorded flights, row by row, as InverseDynamics::predict() answers in flight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "flight_stacks/neural_controller.hpp"
#include "model/replay_reason.hpp"
#include "model/run_time_view.hpp"
#include "pinnquad/data/flight_features.hpp"

namespace programs {

/// `flight_stack`: as examples/flight_stacks: absurd commands are refused too, and the formula answers where the network
/// declines. `training`: TrainingGuard alone, as an InverseDynamics that names no guard.
enum class ReplayGuard { flight_stack, training };

/// The guard that flies.
using FlightStackController = flight_stacks::NeuralController<RunTimeShape<pinnquad::PaperFeatures, float>,
                                                              RunTimeView<pinnquad::PaperFeatures, float>>;
using FlightStackGuard = FlightStackController::Guard;
using FallbackFormula = FlightStackController::Formula;

/// The airframe as flight code has it: of the program's own airframes the type's numbers, else each rounded.
inline pinnquad::Airframe<float> flying_airframe(const NamedAirframe& airframe) {
  pinnquad::Airframe<float> result = pinnquad::airframe_in<float>(airframe.value);
  each_airframe([&](auto tag) {
    using Vehicle = typename decltype(tag)::type;
    const bool same =
        airframe.name == Vehicle::name &&
        pinnquad::detail::equal(airframe.value.mass_kg, pinnquad::airframe_value<Vehicle, double>().mass_kg);
    if (same) result = pinnquad::airframe_value<Vehicle, float>();
  });
  return result;
}

namespace detail {

/// "window of 4 instants, 60 ms: ..." is what warming_up says in words.
template <class Features>
std::string warming_up() {
  if constexpr (pinnquad::detail::HasWindow<Features>::value) {
    using Window = typename Features::Window;
    std::string span = in_words("%.0f ms before", -1e3 * Window::earliest_s);
    if (Window::latest_s > 0) span += in_words(" to %.0f ms after", 1e3 * Window::latest_s);
    return "its window is not complete: no rows without a gap from " + span + " this one";
  } else {
    return "its window is not complete";
  }
}

template <class Inverse, class Features>
class FlightReplay {
  using View = typename Inverse::Model;
  using Scalar = typename View::Scalar;
  using Inputs = typename Features::template Inputs<Scalar>;

 public:
  FlightReplay(const View& view, const typename Inverse::Guard& guard) : inverse_(view, guard), reason_(view) {}

  /// `on_row()` is called after each.
  template <class OnRow>
  void run(const pinnquad::Flight& flight, std::size_t index, std::vector<ReplayedRow>& rows,
           const OnRow& on_row) const {
    const pinnquad::FlightInputs<Inputs> recorded({&flight, {0, flight.size()}});
    for (std::size_t row = 0; row < flight.size(); ++row) {
      ReplayedRow result;
      result.flight = index;
      result.row = row + 1;
      result.time_s = flight[row].time_s;
      result.logged = flight[row].commands;
      Inputs inputs;
      if (recorded.read(row, inputs)) {
        predict(inputs, result);
        const std::string columns = bad_columns(flight, row);
        if (result.cause == pinnquad::Status::not_finite && !columns.empty()) result.reason = columns;
      } else {
        result.status = result.cause = pinnquad::Status::warming_up;
        result.reason = warming_up<Features>();
      }
      result.state = state_of(result);
      rows.push_back(std::move(result));
      on_row();
    }
  }

 private:
  void predict(const Inputs& inputs, ReplayedRow& result) const {
    typename View::FeatureVector x{};
    View::Features::extract(inputs, x.data());
    typename Inverse::Report report;
    pinnquad::Commands<Scalar> commands{};
    result.status = inverse_.predict(inputs, commands, report);
    result.cause = report.cause;
    result.reason = reason_(report.cause, report, x);
    if (report.worst_feature >= 0) {
      result.feature = reason_.name(report.worst_feature);
      result.excess = static_cast<double>(report.excess[static_cast<std::size_t>(report.worst_feature)]);
    }
    if (pinnquad::has_output(result.status)) {
      result.answerer = result.status == pinnquad::Status::fell_back ? Answerer::formula : Answerer::model;
      for (std::size_t i = 0; i < commands.size(); ++i) result.commands[i] = static_cast<double>(commands[i]);
    } else if (report.fallback_asked && report.fallback != report.cause) {
      result.reason += std::string("; the formula declines too: ") + pinnquad::to_string(report.fallback);
    }
  }

  /// "columns wdot_x, roll: NaN or infinite" of those that these features ask for.
  static std::string bad_columns(const pinnquad::Flight& flight, std::size_t row) {
    std::string names;
    const auto look = [&names](const std::string& name, double value) {
      const bool is_altitude = name == "altitude";
      const auto asks = [&name](const char* feature) { return name == feature; };
      const bool asked = !is_altitude || std::any_of(Features::names.begin(), Features::names.end(), asks);
      if (asked && !std::isfinite(value)) names += (names.empty() ? "" : ", ") + name;
    };
    const pinnquad::SampleValues values = pinnquad::to_values(flight[row]);
    constexpr std::size_t first_command = pinnquad::sample_value_count - pinnquad::rotor_count;
    for (std::size_t i = 1; i < first_command; ++i) look(std::string(pinnquad::sample_field_names[i]), values[i]);
    for (const char* name : pinnquad::extra_column_names<Features>) {
      if (const pinnquad::ExtraColumn* column = flight.column(name)) look(name, column->values[row]);
    }
    return names.empty() ? "" : "NaN or infinite: " + names;
  }

  static std::string state_of(const ReplayedRow& row) {
    if (row.answerer == Answerer::model) return row.status == pinnquad::Status::limited ? "model, limited" : "model";
    return std::string(row.answerer == Answerer::formula ? "formula (" : "no commands (") +
           pinnquad::to_string(row.cause) + ")";
  }

  Inverse inverse_;
  ReasonOf<Features, View> reason_;
};

}  // namespace detail

/// Calls `function(features, outputs, scalar)`, values of the types that an identity is.
template <class Function>
void with_schema(const Block& block, const Identity& identity, const Function& function) {
  each_schema([&](auto features, auto outputs) {
    using Features = decltype(features);
    using Outputs = decltype(outputs);
    if (detail::shape_hash_of<Features, Outputs>(identity.answer, identity.airframe) != block.shape_hash) return;
    if (block.is_double) {
      function(features, outputs, double{});
    } else {
      function(features, outputs, float{});
    }
  });
}

/// Runs the model over each flight. Throws std::invalid_argument for a flight without a column that the model asks for.
template <class OnRow>
void replay_flights(const Block& block, const Identity& identity, ReplayGuard guard,
                    const std::vector<pinnquad::Flight>& flights, Replayed& replayed, const OnRow& on_row) {
  with_schema(block, identity, [&](auto features, auto outputs, auto scalar) {
    using Features = decltype(features);
    using View = RunTimeView<Features, decltype(scalar)>;
    const View view = View::of(block, identity, outputs);
    const pinnquad::Quadrotor<float, pinnquad::QuadraticDrag> vehicle(flying_airframe(identity.airframe));
    const auto run = [&](const auto& replay) {
      for (std::size_t i = 0; i < flights.size(); ++i) replay.run(flights[i], i, replayed.rows, on_row);
    };
    if (guard == ReplayGuard::training) {
      using Inverse = pinnquad::InverseDynamics<View, pinnquad::TrainingGuard>;
      run(detail::FlightReplay<Inverse, Features>(view, {}));
    } else {
      using Inverse = pinnquad::InverseDynamics<View, FlightStackGuard>;
      run(detail::FlightReplay<Inverse, Features>(view, FlightStackGuard(FallbackFormula(vehicle))));
    }
  });
}

}  // namespace programs

// SPDX-License-Identifier: MIT
// A model over recorded flights, row by row, as InverseDynamics::predict() answers in flight: of one feature set.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "command_line/listed.hpp"
#include "model/flight_model.hpp"
#include "model/flight_stack.hpp"
#include "model/replay_reason.hpp"
#include "model/run_time_view.hpp"
#include "pinnquad/data/flight_features.hpp"

namespace programs {

namespace detail {

/// "window of 4 instants, 60 ms: ..." is what warming_up says in words.
template <class Features>
std::string warming_up() {
  if constexpr (pinnquad::is_windowed<Features>) {
    using Window = typename Features::Window;
    std::string span = in_words("%.0f ms before", -1e3 * Window::earliest_s);
    if (Window::latest_s > 0) span += in_words(" to %.0f ms after", 1e3 * Window::latest_s);
    return "its window is not complete: no rows without a gap from " + span + " this one";
  } else {
    return "its window is not complete";
  }
}

template <class Features>
constexpr bool looks_back() {
  if constexpr (pinnquad::is_windowed<Features>) return Features::Window::causal;
  return false;
}

/// The inputs of a flight's rows, taken one after the other: what looks back has the history that a control loop has,
/// what looks ahead the rows behind.
template <class Features, class Scalar, class = void>
class InputsInFlight {
 public:
  using Inputs = typename Features::template Inputs<Scalar>;
  explicit InputsInFlight(const pinnquad::Flight& flight) : recorded_({&flight, {0, flight.size()}}) {}

  /// False where the rows do not hold what these inputs need.
  bool read(std::size_t row, Inputs& inputs) { return recorded_.read(row, inputs); }

 private:
  pinnquad::FlightInputs<Inputs> recorded_;
};

template <class Features, class Scalar>
class InputsInFlight<Features, Scalar, std::enable_if_t<looks_back<Features>()>> {
  using History = pinnquad::InputHistory<Features, Scalar>;

 public:
  using Inputs = typename Features::template Inputs<Scalar>;
  explicit InputsInFlight(const pinnquad::Flight& flight) : flight_(flight), recorded_({&flight, {0, flight.size()}}) {}

  bool read(std::size_t row, Inputs& inputs) {
    typename History::Present present;
    if (!recorded_.read(row, present)) return false;
    static_cast<void>(history_.take(present, flight_[row].time_s));
    inputs = history_.inputs();  // a row that is refused is one for predict() to refuse
    return true;
  }

 private:
  const pinnquad::Flight& flight_;
  pinnquad::FlightInputs<typename History::Present> recorded_;
  History history_;
};

template <class Inverse, class Features>
class FlightReplay {
  using View = typename Inverse::Model;
  using Scalar = typename View::Scalar;
  using Inputs = typename Features::template Inputs<Scalar>;

 public:
  explicit FlightReplay(const Inverse& inverse) : inverse_(inverse), reason_(inverse.model()) {}

  /// `on_row()` is called after each.
  template <class OnRow>
  void run(const pinnquad::Flight& flight, std::size_t index, std::vector<ReplayedRow>& rows,
           const OnRow& on_row) const {
    InputsInFlight<Features, Scalar> in_flight(flight);
    for (std::size_t row = 0; row < flight.size(); ++row) {
      ReplayedRow result;
      result.flight = index;
      result.row = row + 1;
      result.time_s = flight[row].time_s;
      result.logged = flight[row].commands;
      Inputs inputs;
      if (in_flight.read(row, inputs)) {
        predict(inputs, result);
        const std::string columns = bad_columns(flight, row);
        if (result.cause == pinnquad::Status::not_finite && !columns.empty()) result.reason = columns;
      } else {
        result.status = result.cause = pinnquad::Status::warming_up;
      }
      if (result.cause == pinnquad::Status::warming_up) result.reason = warming_up<Features>();
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
      result.answerer = result.status == pinnquad::Status::fell_back ? Answerer::analytic_inverse : Answerer::model;
      for (std::size_t i = 0; i < commands.size(); ++i) result.commands[i] = static_cast<double>(commands[i]);
    } else if (report.fallback_asked && report.fallback != report.cause) {
      result.reason += std::string("; the analytic inverse declines too: ") + pinnquad::to_string(report.fallback);
    }
  }

  /// "columns wdot_x, roll: NaN or infinite" of those that these features ask for.
  static std::string bad_columns(const pinnquad::Flight& flight, std::size_t row) {
    std::string names;
    const auto look = [&names](const std::string& name, double value) {
      const bool is_altitude = name == "altitude";
      const auto asks = [&name](const char* feature) { return name == feature; };
      const bool asked = !is_altitude || std::any_of(Features::names.begin(), Features::names.end(), asks);
      if (asked && !std::isfinite(value)) add_to_list(names, name);
    };
    const pinnquad::Sample::Values values = pinnquad::to_values(flight[row]);
    constexpr std::size_t first_command = pinnquad::sample_value_count - pinnquad::rotor_count;
    for (std::size_t i = 1; i < first_command; ++i) look(std::string(pinnquad::sample_field_names[i]), values[i]);
    for (const char* name : pinnquad::extra_column_names<Features>) {
      if (const pinnquad::ExtraColumn* column = flight.column(name)) look(name, column->values[row]);
    }
    return names.empty() ? "" : "NaN or infinite: " + names;
  }

  static std::string state_of(const ReplayedRow& row) {
    if (row.answerer == Answerer::model) return row.status == pinnquad::Status::limited ? "model, limited" : "model";
    return std::string(row.answerer == Answerer::analytic_inverse ? "analytic inverse (" : "no commands (") +
           pinnquad::to_string(row.cause) + ")";
  }

  Inverse inverse_;
  ReasonOf<Features, View> reason_;
};

template <class Inverse, class Features>
class FlightModelOf : public FlightModel {
 public:
  FlightModelOf(const typename Inverse::Model& view, const typename Inverse::Guard& guard)
      : inverse_(view, guard), replay_(inverse_) {}

  bool tests_itself() const override { return pinnquad::self_test(inverse_) == pinnquad::Status::ok; }
  void run(const pinnquad::Flight& flight, std::size_t number, std::vector<ReplayedRow>& rows,
           const std::function<void()>& on_row) const override {
    replay_.run(flight, number, rows, on_row);
  }

 private:
  Inverse inverse_;
  FlightReplay<Inverse, Features> replay_;
};

template <class Features, class Outputs, class Scalar>
std::unique_ptr<const FlightModel> flight_model_of(const Block& block, const Identity& identity, ReplayGuard guard) {
  using View = RunTimeView<Features, Scalar>;
  const View view = View::of(block, identity, Outputs{});
  if (guard == ReplayGuard::training) {
    using Inverse = pinnquad::InverseDynamics<View, pinnquad::TrainingGuard>;
    return std::make_unique<FlightModelOf<Inverse, Features>>(view, pinnquad::TrainingGuard());
  }
  using Inverse = pinnquad::InverseDynamics<View, FlightStackGuard>;
  const pinnquad::Quadrotor<float, pinnquad::QuadraticDrag> vehicle(flying_airframe(identity.airframe));
  return std::make_unique<FlightModelOf<Inverse, Features>>(view, FlightStackGuard(FallbackInverse(vehicle)));
}

}  // namespace detail
}  // namespace programs

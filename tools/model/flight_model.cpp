// SPDX-License-Identifier: MIT
// A model over recorded flights, row by row, as InverseDynamics::predict() answers in flight.
#include "model/flight_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command_line/in_words.hpp"
#include "command_line/listed.hpp"
#include "flight/run_time_view.hpp"
#include "model/flight_stack.hpp"
#include "model/replay_reason.hpp"

namespace programs {

namespace detail {

/// The words for warming_up.
inline std::string warming_up(const pinnquad::RunTimeFeatures::Window& window) {
  if (window.taps == 1) return "its window is not complete";
  std::string span = in_words("%.0f ms before", -1e3 * window.earliest_s);
  if (window.latest_s > 0) span += in_words(" to %.0f ms after", 1e3 * window.latest_s);
  return "its window is not complete: no rows without a gap from " + span + " this one";
}

template <class Inverse>
class FlightModelOf : public FlightModel {
  using View = typename Inverse::Model;
  using Scalar = typename View::Scalar;
  using Inputs = programs::FlightInputs<Scalar>;
  using Recorded = pinnquad::detail::RunTimeFlightInputs<Scalar>;

 public:
  FlightModelOf(const pinnquad::RunTimeModel<Scalar>& model, const typename Inverse::Guard& guard)
      : features_(model.features()), inverse_(View(model), guard), reason_(inverse_.model(), features_) {}

  void run(const pinnquad::Flight& flight, std::size_t index, std::vector<ReplayedRow>& rows,
           const std::function<void()>& on_row) const override {
    // what is refused stays out of the windows of others, as out of a loop's InputHistory
    const Recorded all(features_, {&flight, {0, flight.size()}});
    const std::vector<bool> sound = sound_rows(all, flight.size());
    pinnquad::Flight kept = flight;
    kept.keep_rows([&sound](std::size_t row) { return sound[row]; });
    const Recorded recorded(features_, {&kept, {0, kept.size()}});
    std::size_t kept_row = 0;
    Inputs inputs;
    inputs.features = &features_;
    inputs.taps.resize(static_cast<std::size_t>(features_.window().taps));
    for (std::size_t row = 0; row < flight.size(); ++row) {
      ReplayedRow result;
      result.flight = index;
      result.row = row + 1;
      result.time_s = flight[row].time_s;
      result.logged = flight[row].commands;
      inputs.complete = sound[row] && recorded.read(kept_row++, inputs.taps.data());
      if (!sound[row]) inputs.taps.front() = all.present(row);
      static_cast<pinnquad::MotionInputsWithAltitude<Scalar>&>(inputs) = inputs.taps.front();
      if (!features_.asks_for_altitude()) inputs.altitude_m = Scalar(0);
      predict(inputs, result);
      const std::string columns = bad_columns(flight, row);
      if (result.cause == pinnquad::Status::not_finite && !columns.empty()) result.reason = columns;
      if (result.cause == pinnquad::Status::warming_up) result.reason = warming_up(features_.window());
      result.state = state_of(result);
      rows.push_back(std::move(result));
      on_row();
    }
  }

 private:
  std::vector<bool> sound_rows(const Recorded& recorded, std::size_t rows) const {
    std::vector<bool> sound;
    for (std::size_t row = 0; row < rows; ++row) {
      sound.push_back(features_.check_present(recorded.present(row)) == pinnquad::Status::ok);
    }
    return sound;
  }

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
  std::string bad_columns(const pinnquad::Flight& flight, std::size_t row) const {
    std::string names;
    const auto look = [&](const std::string& name, double value) {
      const bool asked = name != "altitude" || features_.asks_for_altitude();
      if (asked && !std::isfinite(value)) add_to_list(names, name);
    };
    const pinnquad::Sample::Values values = pinnquad::to_values(flight[row]);
    constexpr std::size_t first_command = pinnquad::sample_value_count - pinnquad::rotor_count;
    for (std::size_t i = 1; i < first_command; ++i) look(std::string(pinnquad::sample_field_names[i]), values[i]);
    for (int i = 0; i < features_.column_count(); ++i) {
      const std::string name(features_.column(i).name);
      if (const pinnquad::ExtraColumn* column = flight.column(name)) look(name, column->values[row]);
    }
    return names.empty() ? "" : "NaN or infinite: " + names;
  }

  static std::string state_of(const ReplayedRow& row) {
    if (row.answerer == Answerer::model) return row.status == pinnquad::Status::limited ? "model, limited" : "model";
    return std::string(row.answerer == Answerer::analytic_inverse ? "analytic inverse (" : "no commands (") +
           pinnquad::to_string(row.cause) + ")";
  }

  const pinnquad::RunTimeFeatures& features_;
  Inverse inverse_;
  ReasonOf<View> reason_;
};

template <class Scalar>
std::unique_ptr<const FlightModel> flight_model_of(const pinnquad::RunTimeModel<Scalar>& model,
                                                   const pinnquad::Airframe<float>& airframe, ReplayGuard guard) {
  using View = RunTimeView<FlightFeatures<>, Scalar>;
  if (guard == ReplayGuard::training) {
    using Inverse = pinnquad::InverseDynamics<View, pinnquad::TrainingGuard>;
    return std::make_unique<FlightModelOf<Inverse>>(model, pinnquad::TrainingGuard());
  }
  using Inverse = pinnquad::InverseDynamics<View, FlightStackGuard>;
  const pinnquad::Quadrotor<float, pinnquad::QuadraticDrag> vehicle(airframe);
  return std::make_unique<FlightModelOf<Inverse>>(model, FlightStackGuard(FallbackInverse(vehicle)));
}

}  // namespace detail

std::unique_ptr<const FlightModel> flight_model(const pinnquad::BlockModel& model, ReplayGuard guard) {
  return model.with([&](const auto& own) { return detail::flight_model_of(own, flying_airframe(model), guard); });
}

}  // namespace programs

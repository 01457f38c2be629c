// SPDX-License-Identifier: MIT
// A model that is known at run time alone, where flying code wants a compiled one: InverseDynamics<RunTimeView<...>,
// Guard> and the flight stacks' controller run it with the checks, guards and reports that fly. A feature set of these
// has room for any model's; what a model does not use is 0 and inside the envelope.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "pinnquad/deploy/block_model.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace programs {

/// Texts for a feature set that names nothing.
template <std::size_t Size>
constexpr std::array<const char*, Size> no_names() {
  std::array<const char*, Size> names{};
  for (const char*& name : names) name = "";
  return names;
}

/// The motion of every instant that a model asks for; the base is the present one, which a fallback sees.
template <class Scalar>
struct FlightInputs : pinnquad::MotionInputsWithAltitude<Scalar> {
  const pinnquad::RunTimeFeatures* features = nullptr;
  std::vector<pinnquad::RunTimeFeatures::Inputs<Scalar>> taps;  ///< the present first
  bool complete = false;                                        ///< all of them are there
};

/// Features of a flight's rows, `Most` at most: windows, columns, the altitude among them. The angular acceleration,
/// where a model has one, comes first: the guards that fly ask for its place.
template <int Most = pinnquad::RunTimeFeatures::most_features>
struct FlightFeatures {
  template <class Scalar>
  using Inputs = FlightInputs<Scalar>;
  static constexpr int size = 3 + Most;
  static constexpr int angular_acceleration = 0;
  static constexpr auto names = no_names<std::size_t(size)>();
  static constexpr auto units = names;

  template <class Scalar>
  static pinnquad::Status check(const FlightInputs<Scalar>& in) noexcept {
    if (in.complete) return in.features->check(in.taps.data());
    const pinnquad::Status present = in.features->check_present(in.taps.front());
    return present == pinnquad::Status::ok ? pinnquad::Status::warming_up : present;
  }
  template <class Scalar>
  static void extract(const FlightInputs<Scalar>& in, Scalar* x) noexcept {
    for (int i = 0; i < size; ++i) x[i] = Scalar(0);
    if (!in.complete) return;
    Scalar own[Most];
    pinnquad::RunTimeFeatures::Inputs<Scalar> present = in.taps.front();
    static_cast<pinnquad::MotionInputsWithAltitude<Scalar>&>(present) = in;
    in.features->extract_tap(present, 0, static_cast<Scalar*>(own));
    for (int tap = 1; tap < in.features->window().taps; ++tap) {
      in.features->extract_tap(in.taps[std::size_t(tap)], tap, static_cast<Scalar*>(own));
    }
    const int first = in.features->angular_acceleration(0);
    for (int i = 0; i < in.features->size(); ++i) x[place(first, i)] = own[i];
  }
  /// Where a model's feature stands.
  static int place(const pinnquad::RunTimeFeatures& features, int feature) noexcept {
    return place(features.angular_acceleration(0), feature);
  }

 private:
  static int place(int first, int feature) noexcept {
    if (first < 0 || feature < first) return feature + 3;
    return feature < first + 3 ? feature - first : feature;
  }
};

/// Stands for the network in a shape: as many inputs and outputs, nothing else; the view answers.
template <class ScalarType, int InputCount>
struct AnswerShape {
  using Scalar = ScalarType;
  static constexpr int inputs = InputCount, outputs = pinnquad::rotor_count, parameter_count = 0;
  using Parameters = std::array<Scalar, 0>;
  Parameters parameters{};
  static void forward(const Scalar* /*parameters*/, const Scalar* /*x*/, Scalar* /*y*/) noexcept {}
};

/// Its outputs are commands, whatever the model's schema makes them of. The vehicle stands for the model's, which no
/// type has: a CommandOutputs model asks its airframe nothing.
template <class FeatureSet, class ScalarType>
struct RunTimeShape {
  using Scalar = ScalarType;
  using Features = FeatureSet;
  using Outputs = pinnquad::CommandOutputs;
  using Vehicle = pinnquad::PaperQuadrotor;
  using Network = AnswerShape<Scalar, Features::size>;
};

/// As pinnquad::ModelView. Blocks are known beforehand by their address: know() says what is in one.
template <class FeatureSet, class ScalarType>
class RunTimeView {
 public:
  static constexpr pinnquad::ModelKind kind = pinnquad::ModelKind::function;
  using Shape = RunTimeShape<FeatureSet, ScalarType>;
  using Scalar = ScalarType;
  using Features = typename Shape::Features;
  using Outputs = typename Shape::Outputs;
  using Vehicle = typename Shape::Vehicle;
  using Network = typename Shape::Network;
  using FeatureVector = std::array<Scalar, static_cast<std::size_t>(Features::size)>;

  pinnquad::Scaler<Scalar, Features::size> input{};
  pinnquad::Scaler<Scalar, pinnquad::rotor_count> output{};                       ///< leaves commands as they are
  FeatureVector envelope_lower = pinnquad::detail::ones<Scalar, Features::size>;  ///< as made, it is empty
  FeatureVector envelope_upper{};
  std::vector<FeatureVector> golden_features;
  std::vector<std::array<Scalar, pinnquad::rotor_count>> golden_commands;
  pinnquad::detail::ModelFacts facts{};

  RunTimeView() = default;
  /// The model must stay where it is.
  explicit RunTimeView(const pinnquad::RunTimeModel<Scalar>& model)
      : facts(model.records()), model_(&model), work_(model.workspace()) {
    const auto size = static_cast<std::size_t>(model.features().size());
    envelope_lower = {};
    for (std::size_t i = 0; i < size; ++i) {
      const auto at = static_cast<std::size_t>(Features::place(model.features(), static_cast<int>(i)));
      place_[i] = static_cast<std::uint16_t>(at);
      input.mean[at] = model.scales().input_mean[i];
      input.standard_deviation[at] = model.scales().input_deviation[i];
      envelope_lower[at] = model.scales().lower[i];
      envelope_upper[at] = model.scales().upper[i];
      if (!model.features().is_column(static_cast<int>(i))) continue;
      envelope_upper[at] = std::numeric_limits<Scalar>::max() / 4;  // the model moves columns to their range's edge
      envelope_lower[at] = -envelope_upper[at];
    }
    for (int vector = 0; vector < model.golden_count(); ++vector) {
      FeatureVector x{};
      for (std::size_t i = 0; i < size; ++i) x[place_[i]] = model.golden_features(vector)[i];
      golden_features.push_back(x);
      golden_commands.emplace_back();
      std::copy_n(model.golden_commands(vector), pinnquad::rotor_count, golden_commands.back().begin());
    }
  }

  static void know(const void* block, const RunTimeView& view) { known()[block] = view; }
  /// As ModelView::open(), of a block that is known.
  static pinnquad::Status open(const void* block, std::size_t /*length*/, RunTimeView& view) noexcept {
    const auto found = known().find(block);
    if (found == known().end()) return pinnquad::Status::block_incompatible;
    view = found->second;
    return pinnquad::Status::ok;
  }

  void forward(const Scalar* standardised, Scalar* commands) const noexcept {
    if (model_ == nullptr) {
      for (int i = 0; i < pinnquad::rotor_count; ++i) commands[i] = std::numeric_limits<Scalar>::quiet_NaN();
      return;
    }
    FeatureVector x, scaled;
    for (std::size_t i = 0; i < static_cast<std::size_t>(model_->features().size()); ++i) {
      const std::size_t at = place_[i];
      scaled[i] = standardised[at];
      x[i] =
          standardised[at] * input.standard_deviation[at] + input.mean[at];  // X again, to rounding: a schema may ask
    }
    model_->saturate_columns(scaled.data());
    model_->answer(x.data(), scaled.data(), commands, work_.data());
  }

 private:
  static std::map<const void*, RunTimeView>& known() {
    static std::map<const void*, RunTimeView> all;
    return all;
  }

  const pinnquad::RunTimeModel<Scalar>* model_ = nullptr;
  std::array<std::uint16_t, static_cast<std::size_t>(Features::size)> place_{};  ///< of each feature of the model
  mutable std::vector<Scalar> work_;
};

}  // namespace programs

// SPDX-License-Identifier: MIT
// A model that is known at run time alone, where flying code wants a compiled one: InverseDynamics<RunTimeView<...>,
// Guard> and the flight stacks' controller run it with the checks, guards and reports that fly.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "model/run_time_model.hpp"
#include "pinnquad/dynamics/airframes/paper_quadrotor.hpp"
#include "pinnquad/inference/inverse_dynamics.hpp"
#include "pinnquad/inference/self_test.hpp"

namespace programs {

/// A feature set that remembers the last X it made: what a report's feature was.
template <class FeatureSet>
struct Watched : FeatureSet {
  template <class Scalar>
  static inline std::array<Scalar, static_cast<std::size_t>(FeatureSet::size)> last{};

  template <class Inputs, class Scalar>
  static void extract(const Inputs& in, Scalar* x) noexcept {
    FeatureSet::extract(in, x);
    for (std::size_t i = 0; i < last<Scalar>.size(); ++i) last<Scalar>[i] = x[i];
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
  using Features = Watched<FeatureSet>;
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

  RunTimeView() = default;
  template <class OutputSchema>
  static RunTimeView of(const Block& block, const Identity& identity, OutputSchema /*outputs*/) {
    RunTimeView view;
    const auto model = std::make_shared<const RunTimeModel<FeatureSet, OutputSchema, Scalar>>(block, identity);
    view.answer_ = [model](const std::vector<Scalar>& standardised) {
      FeatureVector x{};  // X again, to rounding: a schema may ask for it
      model->input().restore(standardised.data(), x.data());
      return model->answer(x.data(), standardised);
    };
    view.input = model->input();
    const auto take = [](const double* from, auto& to) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<Scalar>(from[i]);
    };
    take(block.envelope_lower.data(), view.envelope_lower);
    take(block.envelope_upper.data(), view.envelope_upper);
    view.golden_features.resize(block.golden_count);
    view.golden_commands.resize(block.golden_count);
    for (std::size_t i = 0; i < block.golden_count; ++i) {
      take(block.golden_features.data() + i * view.envelope_lower.size(), view.golden_features[i]);
      take(block.golden_commands.data() + i * pinnquad::rotor_count, view.golden_commands[i]);
    }
    return view;
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
    const pinnquad::Commands<Scalar> made = answer_(std::vector<Scalar>(standardised, standardised + Features::size));
    for (std::size_t i = 0; i < made.size(); ++i) commands[i] = made[i];
  }

 private:
  static std::map<const void*, RunTimeView>& known() {
    static std::map<const void*, RunTimeView> all;
    return all;
  }

  std::function<pinnquad::Commands<Scalar>(const std::vector<Scalar>&)> answer_ = [](const std::vector<Scalar>&) {
    pinnquad::Commands<Scalar> none;
    for (Scalar& u : none) u = std::numeric_limits<Scalar>::quiet_NaN();
    return none;
  };
};

}  // namespace programs

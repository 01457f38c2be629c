// SPDX-License-Identifier: MIT
// The derivative of the signed command sum about each axis by the angular acceleration about it: above 0 for any
// vehicle that turns the way it is told to. Exact, in double whatever the model's scalar is.
#pragma once

#include <array>
#include <vector>

#include "pinnquad/core/body.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/run_time_certificate.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/nn/kernel/pack.hpp"
#include "pinnquad/outputs/residual_outputs.hpp"

namespace pinnquad {

/// A feature that shows the angular acceleration about an axis, at the present instant or at another tap of a window.
struct AccelerationPlace {
  std::size_t feature = 0, axis = 0;
  bool is_present = true;
};

/// Of a model by its description: a block's, or one that was trained.
class ExactDerivatives {
 public:
  ExactDerivatives() = default;

  template <class Scalar>
  explicit ExactDerivatives(const RunTimeModel<Scalar>& model) : network_(model.network()) {
    take_airframe(model.airframe());
    if (!outputs_.find(model.schema())) {
      const Scalar* affine = model.records().affine;
      const std::vector<double> numbers(affine, affine + rotor_count * (1 + network_.outputs()));
      outputs_.take_affine(numbers.data(), network_.outputs());
    }
    outputs_.prepare(model.airframe());
    take_numbers(model.parameters(), model.scales());
    for (int i = 0; i < model.features().size(); ++i) {
      add_place(i, shown_acceleration(model, i), detail::is_of_present(model.features()[i].name));
    }
  }

  /// Of a trained model (training/trained_model.hpp).
  template <class Model, class = typename Model::Network>
  static ExactDerivatives of_trained(const Model& model) {
    using Outputs = typename Model::Outputs;
    using Features = typename Model::Features;
    ExactDerivatives result;
    const Airframe<double> airframe = model.template airframe<double>();
    result.take_airframe(airframe);
    result.network_.parse(detail::description_text<typename Model::Network>());
    if (!result.outputs_.find(detail::description_text<Outputs>())) {
      const std::vector<double> affine = detail::affine_schema<Outputs>(airframe);
      result.outputs_.take_affine(affine.data(), OutputMap<Outputs>::size);
    }
    result.outputs_.prepare(airframe);
    using Scalar = typename Model::Scalar;
    result.take_numbers(
        model.network.parameters.data(),
        detail::Scales<Scalar>{model.input.mean.data(), model.input.standard_deviation.data(), model.output.mean.data(),
                               model.output.standard_deviation.data(), nullptr, nullptr});
    for (int i = 0; i < Features::size; ++i) {
      result.add_place(i, detail::shown_acceleration_of<Features>(i),
                       detail::is_of_present(Features::names[static_cast<std::size_t>(i)]));
    }
    return result;
  }

  /// The features that show an angular acceleration, as they stand.
  const std::vector<AccelerationPlace>& places() const noexcept { return places_; }

  /// Of features in physical units. `held`: of a window the angular acceleration of all taps is moved; else the present
  /// alone. At the kink of a ReLU it is the derivative from below, as in nn/jacobian.hpp.
  AxisSlopes operator()(const double* features, bool held = true) const;

  /// Signed sums of commands about roll, pitch, yaw.
  std::array<double, 3> signed_sums(const Commands<double>& u) const;

 private:
  void take_airframe(const Airframe<double>& airframe) { signs_ = axis_signs(airframe); }
  template <class Scalar>
  void take_numbers(const Scalar* parameters, const detail::Scales<Scalar>& scales) {
    const int inputs = network_.inputs(), outputs = network_.outputs();
    parameters_.assign(parameters, parameters + network_.parameter_count());
    input_mean_.assign(scales.input_mean, scales.input_mean + inputs);
    input_deviation_.assign(scales.input_deviation, scales.input_deviation + inputs);
    output_mean_.assign(scales.output_mean, scales.output_mean + outputs);
    output_deviation_.assign(scales.output_deviation, scales.output_deviation + outputs);
  }
  void add_place(int feature, ShownAcceleration shown, bool is_present);
  template <class Visit>
  void each_angular_acceleration(bool held, const Visit& visit) const {
    for (const AccelerationPlace& place : places_) {
      if (held || place.is_present) visit(place.axis, place.feature);
    }
  }

  RunTimeNetwork network_;
  RunTimeOutputs<double> outputs_;
  std::vector<double> parameters_, input_mean_, input_deviation_, output_mean_, output_deviation_;
  std::vector<AccelerationPlace> places_;
  std::array<std::array<double, rotor_count>, 3> signs_{};
};

}  // namespace pinnquad

#ifndef PINNQUAD_COMPILED
#include "pinnquad/deploy/impl/exact_derivatives.hpp"
#endif

// SPDX-License-Identifier: MIT
// The derivative of the signed command sum about each axis by the angular acceleration about it: above 0 for any
// vehicle that turns the way it is told to. Exact, in double whatever the model's scalar is.
#pragma once

#include <array>
#include <vector>

#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/exported/run_time_certificate.hpp"
#include "pinnquad/loss/local_monotonicity.hpp"
#include "pinnquad/nn/kernel/pack.hpp"

namespace pinnquad {

/// d(signed command sum) / d(angular acceleration) about roll, pitch and yaw, s^2/rad.
using AxisDerivatives = std::array<double, 3>;

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
  AxisDerivatives operator()(const double* features, bool held = true) const {
    // a value, its derivatives by three angular accelerations, and zeros that fill a pack
    constexpr int numbers = padded<NativePack<double>>(4);
    using Entry = RunTimeNetwork::Values<double, numbers>;
    const int inputs = network_.inputs(), outputs = network_.outputs();
    std::vector<Entry> work(std::size_t(inputs + outputs) + network_.workspace());
    Entry* const x = work.data();
    Entry* const y = x + inputs;
    for (std::size_t i = 0; i < input_mean_.size(); ++i) x[i] = {(features[i] - input_mean_[i]) / input_deviation_[i]};
    each_angular_acceleration(
        held, [&](std::size_t axis, std::size_t feature) { x[feature][axis + 1] = 1 / input_deviation_[feature]; });
    network_.forward<double, numbers>(parameters_.data(), static_cast<const Entry*>(x), y, y + outputs);
    std::vector<double> made(output_mean_.size()), by_outputs(std::size_t(rotor_count) * output_mean_.size());
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = y[k][0] * output_deviation_[k] + output_mean_[k];
    constexpr std::size_t read = RunTimeOutputs<double>::base_features;
    double by_x[rotor_count * read];
    outputs_.slopes(features, made.data(), by_outputs.data(), static_cast<double*>(by_x));
    std::array<Commands<double>, 3> by_acceleration{};
    for (std::size_t rotor = 0; rotor < std::size_t(rotor_count); ++rotor) {
      for (std::size_t k = 0; k < made.size(); ++k) {
        const double slope = by_outputs[rotor * made.size() + k] * output_deviation_[k];
        for (std::size_t axis = 0; axis < 3; ++axis) by_acceleration[axis][rotor] += slope * y[k][axis + 1];
      }
    }
    each_angular_acceleration(held, [&](std::size_t axis, std::size_t feature) {
      for (std::size_t rotor = 0; feature < read && rotor < std::size_t(rotor_count); ++rotor) {
        by_acceleration[axis][rotor] += by_x[rotor * read + feature];
      }
    });
    AxisDerivatives result{};
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] = signed_sum(signs_[axis], by_acceleration[axis]);
    return result;
  }

  /// Signed sums of commands about roll, pitch, yaw.
  std::array<double, 3> signed_sums(const Commands<double>& u) const {
    return {signed_sum(signs_[0], u), signed_sum(signs_[1], u), signed_sum(signs_[2], u)};
  }

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
  void add_place(int feature, ShownAcceleration shown, bool is_present) {
    if (shown == ShownAcceleration::none || shown == ShownAcceleration::unknown) return;
    places_.push_back({static_cast<std::size_t>(feature), static_cast<std::size_t>(shown), is_present});
  }
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

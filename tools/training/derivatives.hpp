// SPDX-License-Identifier: MIT
// Does a model command more torque where more angular acceleration is asked for? The derivative of the signed command
// sum about each axis by the angular acceleration about it, row by row: above 0 for any vehicle that turns the way it
// is told to.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "pinnquad/data/row_set.hpp"
#include "pinnquad/data/sample_inputs.hpp"
#include "pinnquad/deploy/record_writer.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/training/context_airframe.hpp"
#include "training/model_predictions.hpp"
#include "training/run_time_network.hpp"

namespace programs {

/// d(signed command sum) / d(angular acceleration) about roll, pitch and yaw, in 1 / (rad/s^2).
using AxisDerivatives = std::array<double, 3>;

/// Share of rows in which the derivative is negative, per axis; NaN where it is not finite in a row, or there are no
/// rows. `derivatives_of(sample)` gives a row's AxisDerivatives.
template <class DerivativesOf>
std::array<double, 3> wrong_derivative_shares(const pinnquad::RowSet& rows, const DerivativesOf& derivatives_of) {
  std::array<double, 3> wrong{};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const AxisDerivatives derivatives = derivatives_of(rows[row]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(derivatives[axis])) wrong[axis] = std::numeric_limits<double>::quiet_NaN();
      wrong[axis] += derivatives[axis] < 0 ? 1 : 0;
    }
  }
  for (double& share : wrong) share /= static_cast<double>(rows.size());
  return wrong;
}

/// A scaler of numbers of another scalar, or of a list as long as the scaler.
template <class Scaler, class Numbers>
Scaler scaler_of(const Numbers& mean, const Numbers& spread) {
  using Scalar = typename decltype(Scaler::mean)::value_type;
  Scaler result;
  for (std::size_t i = 0; i < result.mean.size(); ++i) {
    result.mean[i] = static_cast<Scalar>(mean[i]);
    result.spread[i] = static_cast<Scalar>(spread[i]);
  }
  return result;
}

/// Of a network between its scalers, exact, worked out in double whatever the network's own scalar is.
template <class Features, class Outputs>
class NetworkDerivatives {
  using Map = pinnquad::OutputMap<Outputs>;
  static_assert(!Map::has_feature_slopes, "an output schema whose commands depend on the features besides");

 public:
  using InputScaler = pinnquad::Scaler<double, Features::size>;
  using OutputScaler = pinnquad::Scaler<double, Map::size>;

  /// Parameters as RunTimeNetwork takes them.
  NetworkDerivatives(NetworkSpec spec, const std::vector<double>& parameters, const InputScaler& input,
                     const OutputScaler& output, const pinnquad::ContextAirframe<pinnquad::GivenAirframe>& airframe)
      : network_(std::move(spec), parameters),
        input_(input),
        output_(output),
        setting_(airframe.output_setting<Outputs, double>()),
        signs_{airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()} {}

  AxisDerivatives operator()(const pinnquad::Sample& sample) const {
    const auto features = pinnquad::sample_features<Features, double>(sample);
    std::array<double, Features::size> standardised{};
    input_.standardise(features.data(), standardised.data());
    std::vector<std::array<double, 4>> x(standardised.size());  // a value, and its derivatives by three features
    for (std::size_t i = 0; i < x.size(); ++i) x[i][0] = standardised[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t feature = static_cast<std::size_t>(Features::angular_acceleration) + axis;
      x[feature][axis + 1] = 1 / input_.spread[feature];
    }
    const std::vector<std::array<double, 4>> y = network_.pushed_forward(std::move(x));
    std::array<double, Map::size> made{}, outputs{};
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = y[k][0];
    output_.restore(made.data(), outputs.data());
    std::array<double, Map::slope_count> slopes{};
    Map::slopes(features.data(), static_cast<const double*>(outputs.data()), setting_, slopes.data());
    AxisDerivatives result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      pinnquad::Commands<double> by_acceleration{};
      for (int rotor = 0; rotor < pinnquad::rotor_count; ++rotor) {
        for (int k = Map::first_output(rotor); k < Map::last_output(rotor); ++k) {
          const auto output = static_cast<std::size_t>(k);
          by_acceleration[static_cast<std::size_t>(rotor)] +=
              slopes[static_cast<std::size_t>(Map::slope_index(rotor, k))] * output_.spread[output] *
              y[output][axis + 1];
        }
      }
      result[axis] = pinnquad::signed_sum(signs_[axis], by_acceleration);
    }
    return result;
  }

 private:
  RunTimeNetwork<double> network_;
  InputScaler input_;
  OutputScaler output_;
  decltype(std::declval<pinnquad::ContextAirframe<pinnquad::GivenAirframe>>()
               .template output_setting<Outputs, double>()) setting_;
  std::array<std::array<double, pinnquad::rotor_count>, 3> signs_;
};

/// Of a trained model (training/trained_model.hpp).
template <class Model>
auto derivatives_of(const Model& model) {
  using Derivatives = NetworkDerivatives<typename Model::Features, typename Model::Outputs>;
  const std::vector<double> parameters(model.network.parameters.begin(), model.network.parameters.end());
  return Derivatives(*parse_network(pinnquad::detail::description_text<typename Model::Network>()), parameters,
                     scaler_of<typename Derivatives::InputScaler>(model.input.mean, model.input.spread),
                     scaler_of<typename Derivatives::OutputScaler>(model.output.mean, model.output.spread),
                     pinnquad::ContextAirframe<pinnquad::GivenAirframe>(std::string(model.airframe_name()),
                                                                        model.template airframe<double>()));
}

/// Of model 1, by a central difference: exact where a rotor's thrust is proportional to its command.
class LinearDerivatives {
 public:
  explicit LinearDerivatives(const pinnquad::ContextAirframe<pinnquad::GivenAirframe>& airframe)
      : airframe_(airframe.airframe<double>()),
        rotors_(airframe_),
        signs_{airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()} {}

  AxisDerivatives operator()(const pinnquad::Sample& sample) const {
    constexpr double step_rad_s2 = 1e-3;
    AxisDerivatives result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto sum_at = [&](double step) {
        pinnquad::Sample moved = sample;
        moved.angular_acceleration_rad_s2[static_cast<int>(axis)] += step;
        return pinnquad::signed_sum(signs_[axis], linear_prediction(airframe_, rotors_, moved));
      };
      result[axis] = (sum_at(step_rad_s2) - sum_at(-step_rad_s2)) / (2 * step_rad_s2);
    }
    return result;
  }

 private:
  pinnquad::Airframe<double> airframe_;
  pinnquad::Rotors<double> rotors_;
  std::array<std::array<double, pinnquad::rotor_count>, 3> signs_;
};

}  // namespace programs

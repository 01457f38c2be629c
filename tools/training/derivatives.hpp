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

#include "pinnquad/data/flight_features.hpp"
#include "pinnquad/deploy/provenance.hpp"
#include "pinnquad/evaluation/block_model.hpp"
#include "pinnquad/loss/context.hpp"
#include "pinnquad/model/predictor.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "training/model_predictions.hpp"
#include "training/run_time_network.hpp"

namespace programs {

using pinnquad::AxisDerivatives;

/// Counts rows in which the derivative is negative, and keeps the least, per axis.
class DerivativeSigns {
 public:
  void add(const AxisDerivatives& derivatives) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double derivative = derivatives[axis];
      if (!std::isfinite(derivative)) wrong_[axis] = least_[axis] = pinnquad::not_a_number;
      wrong_[axis] += derivative < 0 ? 1 : 0;
      if (derivative < least_[axis]) least_[axis] = derivative;
    }
    ++rows_;
  }
  /// NaN where the derivative is not finite in a row, or there are no rows.
  DerivativeFigures figures() const {
    if (rows_ == 0) return {};
    DerivativeFigures result{wrong_, least_};
    for (double& share : result.wrong_share) share /= static_cast<double>(rows_);
    return result;
  }

 private:
  static constexpr double above_all = std::numeric_limits<double>::infinity();
  AxisDerivatives wrong_{}, least_ = {above_all, above_all, above_all};
  std::size_t rows_ = 0;
};

/// Over rows. `derivatives_of(sample)` gives a row's AxisDerivatives.
template <class DerivativesOf>
DerivativeFigures derivative_figures(const pinnquad::RowSet& rows, const DerivativesOf& derivatives_of) {
  DerivativeSigns signs;
  for (std::size_t row = 0; row < rows.size(); ++row) signs.add(derivatives_of(rows[row]));
  return signs.figures();
}

/// A scaler of numbers of another scalar, or of a list as long as the scaler.
template <class Scaler, class Numbers>
Scaler scaler_of(const Numbers& mean, const Numbers& spread) {
  using Scalar = typename decltype(Scaler::mean)::value_type;
  Scaler result;
  for (std::size_t i = 0; i < result.mean.size(); ++i) {
    result.mean[i] = static_cast<Scalar>(mean[i]);
    result.standard_deviation[i] = static_cast<Scalar>(spread[i]);
  }
  return result;
}

/// Of a network, or a sum of some, between its scalers, exact, worked out in double whatever the network's own scalar
/// is. Of features with a window: by an angular acceleration that is another at all taps at once.
template <class FeatureSet, class Outputs>
class NetworkDerivatives {
  using Map = pinnquad::OutputMap<Outputs>;

 public:
  using Features = FeatureSet;
  using FeatureVector = std::array<double, static_cast<std::size_t>(Features::size)>;
  static constexpr int all_taps = pinnquad::detail::WindowOf<Features>::taps;
  using InputScaler = pinnquad::Scaler<double, Features::size>;
  using OutputScaler = pinnquad::Scaler<double, Map::size>;

  NetworkDerivatives(std::vector<RunTimeNetwork<double>> summands, const InputScaler& input, const OutputScaler& output,
                     const pinnquad::GivenAirframe& airframe)
      : summands_(std::move(summands)),
        input_(input),
        output_(output),
        setting_(airframe.output_setting<Outputs, double>()),
        signs_{airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()} {}
  /// Parameters as RunTimeNetwork takes them.
  NetworkDerivatives(NetworkSpec spec, const std::vector<double>& parameters, const InputScaler& input,
                     const OutputScaler& output, const pinnquad::GivenAirframe& airframe)
      : NetworkDerivatives({RunTimeNetwork<double>(std::move(spec), parameters)}, input, output, airframe) {}

  AxisDerivatives operator()(const pinnquad::Sample& sample) const {
    return (*this)(pinnquad::sample_features<Features, double>(sample));
  }
  /// `last_tap`: of a window the taps from the present to this one move, the others stand.
  AxisDerivatives operator()(const FeatureVector& features, int last_tap = all_taps - 1) const {
    FeatureVector standardised{};
    input_.standardise(features.data(), standardised.data());
    std::vector<std::array<double, 4>> x(standardised.size());  // a value, and its derivatives by three features
    for (std::size_t i = 0; i < x.size(); ++i) x[i][0] = standardised[i];
    each_angular_acceleration(last_tap, [&](std::size_t axis, std::size_t feature) {
      x[feature][axis + 1] = 1 / input_.standard_deviation[feature];
    });
    std::vector<std::array<double, 4>> y = summands_.front().pushed_forward(x);
    for (std::size_t part = 1; part < summands_.size(); ++part) {
      const std::vector<std::array<double, 4>> more = summands_[part].pushed_forward(x);
      for (std::size_t k = 0; k < y.size(); ++k) {
        for (std::size_t i = 0; i < y[k].size(); ++i) y[k][i] += more[k][i];
      }
    }
    std::array<double, Map::size> made{}, outputs{};
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = y[k][0];
    output_.restore(made.data(), outputs.data());
    std::array<double, Map::slope_count> slopes{};
    Map::slopes(features.data(), static_cast<const double*>(outputs.data()), setting_, slopes.data());
    std::array<pinnquad::Commands<double>, 3> by_acceleration{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (int rotor = 0; rotor < pinnquad::rotor_count; ++rotor) {
        for (int k = Map::first_output(rotor); k < Map::last_output(rotor); ++k) {
          const auto output = static_cast<std::size_t>(k);
          by_acceleration[axis][static_cast<std::size_t>(rotor)] +=
              slopes[static_cast<std::size_t>(Map::slope_index(rotor, k))] * output_.standard_deviation[output] *
              y[output][axis + 1];
        }
      }
    }
    if constexpr (Map::has_feature_slopes) {
      std::array<double, static_cast<std::size_t>(pinnquad::rotor_count * Features::size)> by_x{};
      Map::template feature_slopes<Features::size>(features.data(), static_cast<const double*>(outputs.data()),
                                                   setting_, by_x.data());
      each_angular_acceleration(last_tap, [&](std::size_t axis, std::size_t feature) {
        for (std::size_t rotor = 0; rotor < by_acceleration[axis].size(); ++rotor) {
          by_acceleration[axis][rotor] += by_x[rotor * features.size() + feature];
        }
      });
    }
    AxisDerivatives result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      result[axis] = pinnquad::signed_sum(signs_[axis], by_acceleration[axis]);
    }
    return result;
  }

 private:
  template <class Visit>
  static void each_angular_acceleration(int last_tap, const Visit& visit) {
    for (int tap = 0; tap <= last_tap; ++tap) {
      const int first = pinnquad::angular_acceleration_at<Features>(tap);
      if (first < 0) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) visit(axis, static_cast<std::size_t>(first) + axis);
    }
  }

  std::vector<RunTimeNetwork<double>> summands_;
  InputScaler input_;
  OutputScaler output_;
  decltype(std::declval<pinnquad::GivenAirframe>().template output_setting<Outputs, double>()) setting_;
  std::array<std::array<double, pinnquad::rotor_count>, 3> signs_;
};

/// Over the rows that have features.
template <class Features, class Outputs>
DerivativeFigures derivative_figures(const pinnquad::RowSet& rows,
                                     const NetworkDerivatives<Features, Outputs>& derivatives) {
  DerivativeSigns signs;
  pinnquad::each_features<Features, double>(
      rows, [&](const pinnquad::Flight&, std::size_t, const auto& x) { signs.add(derivatives(x)); });
  return signs.figures();
}

namespace detail {

/// A network, or each of a sum, with its own of the parameters.
template <class Answer>
struct Summands {
  static void add(std::vector<RunTimeNetwork<double>>& to, const std::vector<double>& parameters) {
    to.emplace_back(*parse_network(pinnquad::detail::description_text<Answer>()), parameters);
  }
};
template <class First, class Second>
struct Summands<pinnquad::Sum<First, Second>> {
  static void add(std::vector<RunTimeNetwork<double>>& to, const std::vector<double>& parameters) {
    const auto border = parameters.begin() + First::parameter_count;
    Summands<First>::add(to, {parameters.begin(), border});
    Summands<Second>::add(to, {border, parameters.end()});
  }
};

}  // namespace detail

/// Of a trained model (training/trained_model.hpp).
template <class Model>
auto derivatives_of(const Model& model) {
  using Derivatives = NetworkDerivatives<typename Model::Features, typename Model::Outputs>;
  const std::vector<double> parameters(model.network.parameters.begin(), model.network.parameters.end());
  std::vector<RunTimeNetwork<double>> summands;
  detail::Summands<typename Model::Network>::add(summands, parameters);
  return Derivatives(std::move(summands),
                     scaler_of<typename Derivatives::InputScaler>(model.input.mean, model.input.standard_deviation),
                     scaler_of<typename Derivatives::OutputScaler>(model.output.mean, model.output.standard_deviation),
                     pinnquad::GivenAirframe(std::string(model.airframe_name()), model.template airframe<double>()));
}

/// Of a formula, by a central difference: exact where a rotor's thrust is proportional to its command.
/// `predict(sample)`: its commands.
template <class Predict>
class FormulaDerivatives {
 public:
  FormulaDerivatives(const pinnquad::GivenAirframe& airframe, Predict predict)
      : predict_(std::move(predict)),
        signs_{airframe.signs<pinnquad::Roll>(), airframe.signs<pinnquad::Pitch>(), airframe.signs<pinnquad::Yaw>()} {}

  AxisDerivatives operator()(const pinnquad::Sample& sample) const {
    constexpr double step_rad_s2 = 1e-3;
    AxisDerivatives result{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto sum_at = [&](double step) {
        pinnquad::Sample moved = sample;
        moved.angular_acceleration_rad_s2[static_cast<int>(axis)] += step;
        return pinnquad::signed_sum(signs_[axis], predict_(moved));
      };
      result[axis] = (sum_at(step_rad_s2) - sum_at(-step_rad_s2)) / (2 * step_rad_s2);
    }
    return result;
  }

 private:
  Predict predict_;
  std::array<std::array<double, pinnquad::rotor_count>, 3> signs_;
};

/// Of model 1.
inline auto linear_derivatives(const pinnquad::GivenAirframe& airframe) {
  const auto told = airframe.airframe<double>();
  return FormulaDerivatives(airframe, [told, rotors = pinnquad::Rotors<double>(told)](const pinnquad::Sample& sample) {
    return linear_prediction(told, rotors, sample);
  });
}

}  // namespace programs

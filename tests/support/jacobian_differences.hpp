// SPDX-License-Identifier: MIT
// A model's commands by its features, as central differences of the same numbers in double: what
// predict_with_jacobian() owes in each column, without the rounding of a float network over the step.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pinnquad/inference/inverse_dynamics.hpp"

namespace pinnquad::test {

/// A header's numbers in double, in an instance.
template <class Header>
struct DoubleInstance {
  static constexpr ModelKind kind = ModelKind::instance;
  using Scalar = double;
  using Network = typename Header::Network::template Rebind<double>;
  using Features = typename Header::Features;
  using Outputs = typename Header::Outputs;
  using Vehicle = typename Header::Vehicle;
  static constexpr auto features = static_cast<std::size_t>(Features::size);

  typename Network::Parameters parameters{};
  Scaler<double, Features::size> input{};
  Scaler<double, Network::outputs> output{};
  std::array<double, features> envelope_lower{}, envelope_upper{};
  std::array<std::array<double, features>, 1> golden_features{};
  std::array<std::array<double, rotor_count>, 1> golden_commands{};

  DoubleInstance() {
    const auto widen = [](const auto& from, auto& to) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<double>(from[i]);
    };
    widen(Header::parameters, parameters);
    widen(Header::input.mean, input.mean);
    widen(Header::input.standard_deviation, input.standard_deviation);
    widen(Header::output.mean, output.mean);
    widen(Header::output.standard_deviation, output.standard_deviation);
  }
  void forward(const double* x, double* y) const noexcept { Network::forward(parameters.data(), x, y); }
};

/// du/dx at features in physical units, rotor_count x features, row-major.
template <class Header>
std::vector<double> jacobian_by_differences(const typename Header::Scalar* x) {
  constexpr auto size = static_cast<std::size_t>(Header::Features::size);
  const InverseDynamics<DoubleInstance<Header>> inverse{DoubleInstance<Header>()};
  std::vector<double> jacobian(rotor_count * size);
  std::array<double, size> moved{};
  for (std::size_t k = 0; k < size; ++k) moved[k] = static_cast<double>(x[k]);
  for (std::size_t k = 0; k < size; ++k) {
    // of a standardised value: truncation is its square, rounding 1e-16 over it
    const double step = 1e-5 * static_cast<double>(Header::input.standard_deviation[k]), at = moved[k];
    double above[rotor_count], below[rotor_count];
    moved[k] = at + step;
    inverse.evaluate(moved.data(), above);
    moved[k] = at - step;
    inverse.evaluate(moved.data(), below);
    moved[k] = at;
    for (std::size_t i = 0; i < rotor_count; ++i) jacobian[i * size + k] = (above[i] - below[i]) / (2 * step);
  }
  return jacobian;
}

/// The largest |a - b| of a column over the largest |b| of that column, of all columns the worst; infinite where a
/// column of b is zero and that of a is not.
template <class Scalar>
double worst_column(const Scalar* a, const std::vector<double>& b) {
  const std::size_t size = b.size() / rotor_count;
  double worst = 0;
  for (std::size_t k = 0; k < size; ++k) {
    double difference = 0, scale = 0;
    for (std::size_t i = 0; i < rotor_count; ++i) {
      const double apart = std::fabs(static_cast<double>(a[i * size + k]) - b[i * size + k]);
      difference = apart <= difference ? difference : apart;  // NaN stays
      scale = std::fmax(scale, std::fabs(b[i * size + k]));
    }
    const double share = difference == 0 ? 0 : difference / scale;
    worst = share <= worst ? worst : share;
  }
  return worst;
}

}  // namespace pinnquad::test

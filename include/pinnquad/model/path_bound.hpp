// SPDX-License-Identifier: MIT
// Bounds of d(output)/d(input) of a network, valid for every input: the products of the weights along each path from
// the input to the output are added up, each activation's slope anywhere from 0 to 1 (docs/certificate.md). For a
// network that is shown the angular acceleration and must not turn the sign of a slope.
#pragma once

#include <cstddef>
#include <limits>

#include "pinnquad/model/axis_aligned.hpp"
#include "pinnquad/nn/elu.hpp"
#include "pinnquad/nn/leaky_relu.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"

namespace pinnquad {

/// True for activations whose slope is from 0 to 1: of Relu 0 or 1, of LeakyRelu 0.01 or 1, of Tanh 1 - y^2, of
/// Softplus 1 / (1 + exp(-v)), of Elu exp(v) or 1.
/// Not Gelu, Silu (-0.13 to 1.13) and Sine (-1 to 1).
template <class Layer>
inline constexpr bool slopes_from_0_to_1 = false;
template <class Scalar, int Size>
inline constexpr bool slopes_from_0_to_1<Relu::Bind<Scalar, Size>> = true;
template <class Scalar, int Size>
inline constexpr bool slopes_from_0_to_1<Tanh::Bind<Scalar, Size>> = true;
template <class Scalar, int Size>
inline constexpr bool slopes_from_0_to_1<Softplus::Bind<Scalar, Size>> = true;
template <class Scalar, int Size>
inline constexpr bool slopes_from_0_to_1<Elu::Bind<Scalar, Size>> = true;
template <class Scalar, int Size>
inline constexpr bool slopes_from_0_to_1<LeakyRelu::Bind<Scalar, Size>> = true;

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Lower and upper bounds of d(output)/d(input). The interval holds 0, the slope of an output that is clipped.
template <int Outputs>
struct PathBound {
  double lower[static_cast<std::size_t>(Outputs)]{};
  double upper[static_cast<std::size_t>(Outputs)]{};
};

/// The intervals of `outputs` weighted sums of `inputs` intervals, weights row by row. Intervals that hold 0 add up
/// numbers of one sign at each end: rounding errs by less than (inputs + 1) 2^-53 of it.
template <class Scalar>
constexpr void weigh_intervals(const Scalar* weights, int inputs, int outputs, const double* lower, const double* upper,
                               double* sum_lower, double* sum_upper) noexcept {
  for (int row = 0; row < outputs; ++row) {
    sum_lower[row] = sum_upper[row] = 0;
    for (int i = 0; i < inputs; ++i) {
      const double weight = static_cast<double>(weights[row * inputs + i]);
      sum_lower[row] += weight * (weight < 0 ? upper[i] : lower[i]);
      sum_upper[row] += weight * (weight < 0 ? lower[i] : upper[i]);
    }
  }
}

template <class Network, class Indices = std::make_index_sequence<std::size_t(Network::layer_count)>>
struct PathLayers;
template <class NetworkType, std::size_t... Index>
struct PathLayers<NetworkType, std::index_sequence<Index...>> {
  template <std::size_t At>
  using Layer = typename NetworkType::template Layer<int(At)>;
  template <class L>
  static constexpr bool is_dense = std::is_same_v<L, DenseLayer<typename NetworkType::Scalar, L::inputs, L::outputs>>;

  /// True where layers are Dense, with an activation of slope 0 to 1 after each but the last.
  static constexpr bool alternates =
      (... && (Index % 2 == 0 ? is_dense<Layer<Index>> : slopes_from_0_to_1<Layer<Index>>)) &&
      sizeof...(Index) % 2 == 1;
  static constexpr int dense_layers = (int(sizeof...(Index)) + 1) / 2;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// From the first layer's outputs to the network's. `widths`: outputs of each of the `layers` dense layers; parameters
/// in the order of a Network. `work`: 4 x `widest` numbers; the intervals of the first layer's outputs, each holding 0,
/// stand there: lower ends from 0 on, upper ends from `widest` on.
template <class Scalar>
constexpr void path_bound_behind_first(const Scalar* parameters, int inputs, const int* widths, int layers,
                                       double* work, int widest, double* lower, double* upper) noexcept {
  double *from_lower = work, *from_upper = work + widest, *to_lower = work + 2 * widest, *to_upper = work + 3 * widest;
  int operations = 4;
  const Scalar* own = parameters + (inputs + 1) * widths[0];
  for (int layer = 1; layer < layers; ++layer) {
    const int in = widths[layer - 1], out = widths[layer];
    detail::weigh_intervals(own, in, out, from_lower, from_upper, to_lower, to_upper);
    own += (in + 1) * out;
    operations += in + 1;
    double* const spare[2] = {from_lower, from_upper};
    from_lower = to_lower;
    from_upper = to_upper;
    to_lower = spare[0];
    to_upper = spare[1];
  }
  const double outward = 1 + operations * std::numeric_limits<double>::epsilon();
  for (int row = 0; row < widths[layers - 1]; ++row) {
    lower[row] = from_lower[row] * outward;
    upper[row] = from_upper[row] * outward;
  }
}

/// Bounds by one input, for widths that are known at run time alone: `lower` and `upper` of each output.
template <class Scalar>
constexpr void path_bound(const Scalar* parameters, int inputs, const int* widths, int layers, int input, double* work,
                          int widest, double* lower, double* upper) noexcept {
  for (int row = 0; row < widths[0]; ++row) {
    const double weight = static_cast<double>(parameters[row * inputs + input]);
    work[row] = weight < 0 ? weight : 0;
    work[widest + row] = weight > 0 ? weight : 0;
  }
  path_bound_behind_first(parameters, inputs, widths, layers, work, widest, lower, upper);
}

/// Bounds along a direction, of which each entry is from least[i] to most[i]: tighter than the sum of the bounds by
/// each input.
template <class Scalar>
constexpr void path_bound_along(const Scalar* parameters, int inputs, const int* widths, int layers,
                                const double* least, const double* most, double* work, int widest, double* lower,
                                double* upper) noexcept {
  detail::weigh_intervals(parameters, inputs, widths[0], least, most, work, work + widest);
  for (int row = 0; row < widths[0]; ++row) {
    double magnitudes = 0;  // of products that may cancel
    for (int i = 0; i < inputs; ++i) {
      const double weight = static_cast<double>(parameters[row * inputs + i]);
      const double far = -least[i] > most[i] ? -least[i] : most[i];
      magnitudes += (weight < 0 ? -weight : weight) * far;
    }
    const double doubt = (inputs + 1) * std::numeric_limits<double>::epsilon() * magnitudes;
    work[row] = work[row] - doubt < 0 ? work[row] - doubt : 0;
    work[widest + row] = work[widest + row] + doubt > 0 ? work[widest + row] + doubt : 0;
  }
  path_bound_behind_first(parameters, inputs, widths, layers, work, widest, lower, upper);
}

/// A network that is shown the angular acceleration: a predictor like `NetworkType`, of which a certificate asks the
/// path bound; fit_path_bounded() keeps its weights small in training. At most 3 dense layers: the bound adds up the
/// worst of all units, and with each layer more it is further above what the network does, until nothing is left of
/// what it is shown. A float network: a product of a few of its weights is no subnormal double.
template <class NetworkType>
struct PathBounded : detail::PredictorBase<PathBounded<NetworkType>, typename NetworkType::Scalar, NetworkType::inputs,
                                           NetworkType::outputs, NetworkType::parameter_count> {
  using Inner = NetworkType;
  using Layers = detail::PathLayers<NetworkType>;
  static_assert(std::is_same_v<typename NetworkType::Scalar, float>, "pinnquad: a PathBounded network is of floats");
  static_assert(Layers::alternates,
                "pinnquad: a PathBounded network has Dense layers with Relu, LeakyRelu, Tanh, Softplus or Elu between "
                "them");
  static_assert(Layers::dense_layers <= 3,
                "pinnquad: a PathBounded network has at most 3 Dense layers: of more the bound "
                "says nothing (docs/certificate.md)");
  using Scalar = typename NetworkType::Scalar;
  using PathBounded::PredictorBase::forward;
  using Packed = PackedNetwork<NetworkType>;
  static constexpr detail::TemplateText<NetworkType> description{"pinnquad::PathBounded"};

  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y) noexcept {
    NetworkType::forward(parameters, x, y);
  }
  static void jacobian(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* by_x) noexcept {
    predictor_jacobian<NetworkType>(parameters, x, y, by_x);
  }
  /// Bounds of all outputs by one input, both standardised.
  static constexpr detail::PathBound<NetworkType::outputs> bound(const Scalar* parameters, int input) noexcept {
    int widths[Layers::dense_layers]{};
    for (int i = 0; i < Layers::dense_layers; ++i) widths[i] = NetworkType::Sizes::outputs[std::size_t(2 * i)];
    constexpr int widest = NetworkType::widest;
    double work[static_cast<std::size_t>(4 * widest)]{};
    detail::PathBound<NetworkType::outputs> found;
    path_bound(parameters, NetworkType::inputs, widths, Layers::dense_layers, input, work, widest, found.lower,
               found.upper);
    return found;
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

/// The affine part and a network that is shown all features. Where its path bound is below the slopes, each axis
/// command rises with the angular acceleration about its axis.
template <class Features, class Residual>
using PathBoundedPredictor = Sum<MonotoneBase<Features, typename Residual::Scalar>, Saturated<PathBounded<Residual>>>;

}  // namespace pinnquad

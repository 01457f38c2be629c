// SPDX-License-Identifier: MIT
// Takes batch norm out of a trained network: a Dense followed by a BatchNorm is a Dense with other weights.
// The folded network is exported and flown; exported headers hold no batch norm.
#pragma once

#include <cmath>

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad {

namespace detail {

template <class Spec>
struct FoldedSpec {
  using type = Spec;
  static constexpr bool takes_batch_norm = false;
};
template <int Out>
struct FoldedSpec<Dense<Out>> {
  using type = Dense<Out>;
  static constexpr bool takes_batch_norm = true;
};
template <int Out>
struct FoldedSpec<DenseWithoutBias<Out>> : FoldedSpec<Dense<Out>> {};

/// Moves layers to the network `Done`, behind the layer `Before`; a BatchNorm is left out.
template <class Done, class Before, class... Left>
struct FoldSpecs {
  using type = Done;
};
template <class Scalar, class InputSize, class... Done, class Before, class Spec, class... Left>
struct FoldSpecs<Network<Scalar, InputSize, Done...>, Before, Spec, Left...>
    : FoldSpecs<Network<Scalar, InputSize, Done..., typename FoldedSpec<Spec>::type>, Spec, Left...> {};
template <class Scalar, class InputSize, class... Done, class Before, class... Left>
struct FoldSpecs<Network<Scalar, InputSize, Done...>, Before, BatchNorm, Left...>
    : FoldSpecs<Network<Scalar, InputSize, Done...>, BatchNorm, Left...> {
  static_assert(FoldedSpec<Before>::takes_batch_norm,
                "pinnquad: a BatchNorm that does not follow a Dense can't be folded into one, so it can't be exported");
};

template <class Predictor>
struct FoldNetwork {
  using type = Predictor;
};
template <class Scalar, class InputSize, class... Specs>
struct FoldNetwork<Network<Scalar, InputSize, Specs...>> : FoldSpecs<Network<Scalar, InputSize>, InputSize, Specs...> {
};

/// The network without its BatchNorms: Dense, DenseWithoutBias and a BatchNorm behind either become one Dense. A
/// network that has none of them, and a predictor that is no network (model/predictor.hpp), is its own folded type.
template <class NetworkType>
using Folded = typename FoldNetwork<NetworkType>::type;

/// Parameters that a layer gets by folding: a bias of 0.
template <class Layer>
inline constexpr int folded_bias = 0;
template <class Scalar, int In, int Out>
inline constexpr int folded_bias<DenseLayer<Scalar, In, Out, false>> = Out;

/// W'_i = s_i W_i, b'_i = s_i (b_i - mean_i) + beta_i with s_i = gamma_i / sqrt(variance_i + 1e-5); computed in double.
template <class Scalar, int Size>
void fold_into_dense(BatchNorm::Bind<Scalar, Size>, const Scalar* norm, Scalar* dense, int inputs) {
  for (int row = 0; row < Size; ++row) {
    const auto value = [&](int part) { return static_cast<double>(norm[part * Size + row]); };
    const double scale = value(0) / std::sqrt(value(3) + batch_norm_epsilon);
    Scalar* weights = dense + row * inputs;
    Scalar& bias = dense[Size * inputs + row];
    for (int column = 0; column < inputs; ++column) {
      weights[column] = static_cast<Scalar>(scale * static_cast<double>(weights[column]));
    }
    bias = static_cast<Scalar>(scale * (static_cast<double>(bias) - value(2)) + value(1));
  }
}
template <class Layer>
inline constexpr bool is_batch_norm = false;
template <class Scalar, int Size>
inline constexpr bool is_batch_norm<BatchNorm::Bind<Scalar, Size>> = true;

}  // namespace detail

/// The same outputs to rounding as `network` with its running statistics, from plain layers. A network without batch
/// norm is returned bit for bit.
template <class NetworkType>
detail::Folded<NetworkType> folded(const NetworkType& network) {
  if constexpr (!is_network<NetworkType>) {
    return network;
  } else {
    using Scalar = typename NetworkType::Scalar;
    detail::Folded<NetworkType> result;
    Scalar* end = result.parameters.data();  // behind the last layer written
    Scalar* last = end;                      // that layer
    unroll<NetworkType::layer_count>([&](auto index) {
      using Layer = typename NetworkType::template Layer<decltype(index)::value>;
      const Scalar* own = network.parameters.data() + NetworkType::Sizes::offset(index);
      if constexpr (detail::is_batch_norm<Layer>) {
        using Before = typename NetworkType::template Layer<decltype(index)::value - 1>;
        detail::fold_into_dense(Layer{}, own, last, Before::inputs);
      } else {
        last = end;
        for (int i = 0; i < Layer::parameter_count; ++i) last[i] = own[i];
        end += Layer::parameter_count + detail::folded_bias<Layer>;
      }
    });
    return result;
  }
}

}  // namespace pinnquad

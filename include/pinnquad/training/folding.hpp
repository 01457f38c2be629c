// SPDX-License-Identifier: MIT
// Takes batch norm out of a trained network: a Dense followed by a BatchNorm is a Dense with other weights.
// The folded network is exported and flown; exported headers hold no batch norm.
#pragma once

#include <cmath>

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/unroll.hpp"

namespace pinnquad {

namespace detail {

/// Moves specs from the second list to the first: a Dense takes the BatchNorm behind it along.
template <class Done, class Left>
struct FoldSpecs;
template <class... Done>
struct FoldSpecs<SpecList<Done...>, SpecList<>> {
  using type = SpecList<Done...>;
};
template <class... Done, class Spec, class... Left>
struct FoldSpecs<SpecList<Done...>, SpecList<Spec, Left...>> : FoldSpecs<SpecList<Done..., Spec>, SpecList<Left...>> {
  static_assert(!std::is_same<Spec, BatchNorm>::value,
                "pinnquad: a BatchNorm that does not follow a Dense can't be folded into one, so it can't be exported");
};
template <class... Done, int Out, class... Left>
struct FoldSpecs<SpecList<Done...>, SpecList<DenseWithoutBias<Out>, Left...>>
    : FoldSpecs<SpecList<Done..., Dense<Out>>, SpecList<Left...>> {};
template <class... Done, int Out, class... Left>
struct FoldSpecs<SpecList<Done...>, SpecList<DenseWithoutBias<Out>, BatchNorm, Left...>>
    : FoldSpecs<SpecList<Done..., Dense<Out>>, SpecList<Left...>> {};
template <class... Done, int Out, class... Left>
struct FoldSpecs<SpecList<Done...>, SpecList<Dense<Out>, BatchNorm, Left...>>
    : FoldSpecs<SpecList<Done..., Dense<Out>>, SpecList<Left...>> {};

template <class Predictor>
struct FoldNetwork {
  using type = Predictor;
};
template <class Scalar, class InputSize, class... Specs>
struct FoldNetwork<Network<Scalar, InputSize, Specs...>> {
  template <class List>
  struct Of;
  template <class... Folded>
  struct Of<SpecList<Folded...>> {
    using type = Network<Scalar, InputSize, Folded...>;
  };
  using type = typename Of<typename FoldSpecs<SpecList<>, SpecList<Specs...>>::type>::type;
};

/// Copies a layer's parameters; a missing bias becomes 0. Returns how many were written.
template <class Layer, class Scalar>
int copy_layer(Layer, const Scalar* from, Scalar* to) {
  for (int i = 0; i < Layer::parameter_count; ++i) to[i] = from[i];
  return Layer::parameter_count;
}
template <class Scalar, int In, int Out>
int copy_layer(DenseLayer<Scalar, In, Out, false>, const Scalar* from, Scalar* to) {
  for (int i = 0; i < Out * In; ++i) to[i] = from[i];
  for (int i = 0; i < Out; ++i) to[Out * In + i] = Scalar(0);
  return Out * In + Out;
}

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
struct IsBatchNorm : std::false_type {};
template <class Scalar, int Size>
struct IsBatchNorm<BatchNorm::Bind<Scalar, Size>> : std::true_type {};

template <class NetworkType>
typename FoldNetwork<NetworkType>::type without_batch_norm(const NetworkType& network) {
  using Scalar = typename NetworkType::Scalar;
  typename FoldNetwork<NetworkType>::type result;
  Scalar* end = result.parameters.data();  // behind the last layer written
  Scalar* last = end;                      // that layer
  unroll<NetworkType::layer_count>([&](auto index) {
    using Layer = typename NetworkType::template Layer<decltype(index)::value>;
    const Scalar* own = network.parameters.data() + NetworkType::Sizes::offset(index);
    if constexpr (IsBatchNorm<Layer>::value) {
      using Before = typename NetworkType::template Layer<decltype(index)::value - 1>;
      fold_into_dense(Layer{}, own, last, Before::inputs);
    } else {
      last = end;
      end += copy_layer(Layer{}, own, last);
    }
  });
  return result;
}

}  // namespace detail

/// The network without its BatchNorms: Dense, DenseWithoutBias and a BatchNorm behind either become one Dense. A
/// network that has none of them, and a predictor that is no network (model/predictor.hpp), is its own folded type.
template <class NetworkType>
using Folded = typename detail::FoldNetwork<NetworkType>::type;

/// The same outputs to rounding as `network` with its running statistics, from plain layers. A network without batch
/// norm is returned bit for bit.
template <class NetworkType>
Folded<NetworkType> folded(const NetworkType& network) {
  if constexpr (!is_network<NetworkType>) {
    return network;
  } else {
    return detail::without_batch_norm(network);
  }
}

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
#include "pinnquad/nn/network.hpp"

#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"

using namespace pinnquad;

template <class... Specs>
float answered() {
  using Net = Network<float, InputSize<4>, Specs...>;
  const Net net{};
  const float x[Net::inputs] = {};
  float y[Net::outputs] = {};
  net.forward(x, y);
  PackedNetwork<Net>(net.parameters).forward(x, y);
  return y[0];
}

/// A whole layer, always so wide or as wide as what comes.
template <int Wide, bool IsNoexcept = true>
struct Passes {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = Wide > 0 ? Wide : In, outputs = inputs, parameter_count = 0;
    static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept(IsNoexcept) {
      for (int i = 0; i < inputs; ++i) y[i] = x[i];
    }
  };
};

template <bool ActivateIsNoexcept, bool SlopeIsNoexcept>
struct Square {
  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept(ActivateIsNoexcept) { return v * v; }
    static Scalar slope(Scalar y) noexcept(SlopeIsNoexcept) { return y; }
  };
};

template <bool FromInputIsNoexcept>
struct SquareByInput {
  template <class Scalar, int In>
  struct Bind : ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept { return v * v; }
    static Scalar slope_from_input(Scalar v) noexcept(FromInputIsNoexcept) { return v + v; }
#ifdef TWO_SLOPES
    static Scalar slope(Scalar y) noexcept { return y; }
#endif
  };
};

// SOUND
const float y = answered<Dense<4>, Relu, Square<true, true>, SquareByInput<true>, Passes<4>, Passes<0>>();

// CASE NOT_A_LAYER: pinnquad: this type is not a layer
struct Nothing {};
const float y = answered<Dense<4>, Nothing>();
// CASE LAYER_WITHOUT_FORWARD: pinnquad: this type is not a layer
struct NoForward {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
  };
};
const float y = answered<NoForward>();
// CASE LAYER_WITHOUT_SCALAR: pinnquad: this type is not a layer
struct NoScalar {
  template <class ScalarType, int In>
  struct Bind {
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
    static void forward(const ScalarType*, const ScalarType*, ScalarType*) noexcept {}
  };
};
const float y = answered<NoScalar>();
// CASE LAYER_OF_OTHER_WIDTH: pinnquad: a layer does not take the outputs of the layer before it
const float y = answered<Dense<5>, Passes<4>>();
// CASE FORWARD_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
const float y = answered<Passes<0, false>>();
// CASE ACTIVATION_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
const float y = answered<Square<false, true>>();
// CASE SLOPE_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
const float y = answered<Square<true, false>>();
// CASE SLOPE_FROM_INPUT_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
const float y = answered<SquareByInput<false>>();
// CASE TWO_SLOPES: pinnquad: an element-wise layer gives slope.y. or slope_from_input.v., not both
const float y = answered<SquareByInput<true>>();
// CASE NO_LAYERS: pinnquad: a network needs at least one layer
const float y = answered<>();

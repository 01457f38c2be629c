// SPDX-License-Identifier: MIT
// CASE NOT_A_LAYER: pinnquad: this type is not a layer
// CASE LAYER_WITHOUT_FORWARD: pinnquad: this type is not a layer
// CASE LAYER_WITHOUT_SCALAR: pinnquad: this type is not a layer
// CASE LAYER_OF_OTHER_WIDTH: pinnquad: a layer does not take the outputs of the layer before it
// CASE FORWARD_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
// CASE ACTIVATION_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
// CASE SLOPE_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
// CASE SLOPE_FROM_INPUT_MAY_THROW: pinnquad: a layer's forward.., activate.. and slope.. must be noexcept
// CASE TWO_SLOPES: pinnquad: an element-wise layer gives slope.y. or slope_from_input.v., not both
// CASE NO_LAYERS: pinnquad: a network needs at least one layer
#include "pinnquad/nn/network.hpp"

#include "pinnquad/nn/packed_network.hpp"
#include "pinnquad/nn/relu.hpp"

namespace {

/// A whole layer, always 4 wide.
struct FourWide {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = 4, outputs = 4, parameter_count = 0;
    static void forward(const Scalar*, const Scalar* x, Scalar* y) noexcept {
      for (int i = 0; i < 4; ++i) y[i] = x[i];
    }
  };
};

struct Nothing {};

struct NoForward {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
  };
};

struct NoScalar {
  template <class ScalarType, int In>
  struct Bind {
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
    static void forward(const ScalarType*, const ScalarType*, ScalarType*) noexcept {}
  };
};

struct ForwardMayThrow {
  template <class ScalarType, int In>
  struct Bind {
    using Scalar = ScalarType;
    static constexpr int inputs = In, outputs = In, parameter_count = 0;
    static void forward(const Scalar*, const Scalar*, Scalar*) {}
  };
};

template <bool ActivateIsNoexcept, bool SlopeIsNoexcept>
struct Square {
  template <class Scalar, int In>
  struct Bind : pinnquad::ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept(ActivateIsNoexcept) { return v * v; }
    static Scalar slope(Scalar y) noexcept(SlopeIsNoexcept) { return y; }
  };
};

template <bool FromInputIsNoexcept>
struct SquareByInput {
  template <class Scalar, int In>
  struct Bind : pinnquad::ElementwiseLayer<Bind<Scalar, In>, Scalar, In> {
    static Scalar activate(Scalar v) noexcept { return v * v; }
    static Scalar slope_from_input(Scalar v) noexcept(FromInputIsNoexcept) { return v + v; }
#ifdef TWO_SLOPES
    static Scalar slope(Scalar y) noexcept { return y; }
#endif
  };
};

#if defined(NOT_A_LAYER)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, pinnquad::Dense<4>, Nothing>;
#elif defined(LAYER_WITHOUT_FORWARD)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, NoForward>;
#elif defined(LAYER_WITHOUT_SCALAR)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, NoScalar>;
#elif defined(LAYER_OF_OTHER_WIDTH)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, pinnquad::Dense<5>, FourWide>;
#elif defined(FORWARD_MAY_THROW)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, ForwardMayThrow>;
#elif defined(ACTIVATION_MAY_THROW)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, Square<false, true>>;
#elif defined(SLOPE_MAY_THROW)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, Square<true, false>>;
#elif defined(SLOPE_FROM_INPUT_MAY_THROW)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, SquareByInput<false>>;
#elif defined(NO_LAYERS)
using Net = pinnquad::Network<float, pinnquad::InputSize<4>>;
#else
using Net = pinnquad::Network<float, pinnquad::InputSize<4>, pinnquad::Dense<4>, pinnquad::Relu, Square<true, true>,
                              SquareByInput<true>, FourWide>;
#endif

}  // namespace

int main() {
  const Net net{};
  const float x[Net::inputs] = {};
  float y[Net::outputs] = {};
  net.forward(x, y);
  pinnquad::PackedNetwork<Net>(net.parameters).forward(x, y);
  return static_cast<int>(y[0]) + static_cast<int>(sizeof(Nothing) + sizeof(NoForward) + sizeof(NoScalar));
}

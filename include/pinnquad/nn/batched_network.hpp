// SPDX-License-Identifier: MIT
// The forward pass over many samples at once, for rollouts (MPPI) and evaluation: one lane per sample, weights
// straight from the row-major parameters. Each sample's sums are taken in the portable kernel's order.
#pragma once

#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/nn/network.hpp"

namespace pinnquad {

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a layer runs over a block of `Lanes` samples, x and y by feature with strides: one sample after the other,
/// unless specialised.
template <class Layer, class Pack, int Lanes>
struct BatchedLayer {
  using Scalar = typename Layer::Scalar;
  static constexpr bool fuses_activation = false;
  static void forward(const Scalar* parameters, const Scalar* x, int x_stride, Scalar* y, int y_stride,
                      Activate<void>) noexcept {
    for (int lane = 0; lane < Lanes; ++lane) {
      Scalar in[static_cast<std::size_t>(Layer::inputs)];
      Scalar out[static_cast<std::size_t>(Layer::outputs)];
      for (int i = 0; i < Layer::inputs; ++i) in[i] = x[i * x_stride + lane];
      Layer::forward(parameters, in, out);
      for (int i = 0; i < Layer::outputs; ++i) y[i * y_stride + lane] = out[i];
    }
  }
};

/// Each row's sum begins with its bias, or with 0.
template <class Scalar, int In, int Out, bool HasBias, class Pack, int Lanes>
struct BatchedLayer<DenseLayer<Scalar, In, Out, HasBias>, Pack, Lanes> {
  static constexpr bool fuses_activation = true;
  template <class Activation>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, int x_stride, Scalar* y,
                                             int y_stride, const Activation& activation) noexcept {
    multiply_lanes<Pack, Lanes / Pack::width, Out, In, 1>(
        parameters, x, x_stride, In,
        [&](int row)
            PINNQUAD_INLINE_LAMBDA { return Pack::broadcast(HasBias ? parameters[In * Out + row] : Scalar(0)); },
        [&](auto, auto, Pack sum) PINNQUAD_INLINE_LAMBDA { return activation(sum); }, y, y_stride);
  }
};

/// A layer and the activation behind it (void: none) over a block. Out of line, so that equal layers share their code.
template <class Layer, class Activation, class Pack, int Lanes>
PINNQUAD_NOINLINE void batched_layer(const typename Layer::Scalar* parameters, const typename Layer::Scalar* x,
                                     int x_stride, typename Layer::Scalar* y, int y_stride) noexcept {
  using Batched = BatchedLayer<Layer, Pack, Lanes>;
  Batched::forward(parameters, x, x_stride, y, y_stride, Activate<Activation>{});
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = network(x) for many samples. Both are by feature: x[i * samples + s] is input i of sample s, y likewise.
/// Parameters as in Network, row-major. With fused multiply-add the bits are those of Network::forward, in any batch.
template <class NetworkType, class PackType = NativePack<typename NetworkType::Scalar>>
struct BatchedNetwork {
  static_assert(is_network<NetworkType>, "pinnquad: BatchedNetwork<N> needs a Network (nn/network.hpp)");
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;

  /// Samples that are worked on at once.
  static constexpr int lanes = 2 * Pack::width;
  /// Stack that a call needs, about.
  static constexpr std::size_t workspace_bytes =
      sizeof(Scalar) * static_cast<std::size_t>(4 * NetworkType::widest * lanes);

  /// Any number of samples, also none.
  static void forward(const Scalar* parameters, const Scalar* x, Scalar* y, int samples) noexcept {
    if (samples >= lanes) {
      int first = 0;
      for (; first + lanes <= samples; first += lanes) block(parameters, x + first, samples, y + first, samples);
      // the rest with some of the block before once more: it gives the same again
      if (first < samples) block(parameters, x + (samples - lanes), samples, y + (samples - lanes), samples);
    } else if (samples > 0) {
      // padding repeats the last sample: a layer of a user's own sees real inputs only
      Scalar in[static_cast<std::size_t>(NetworkType::inputs * lanes)];
      Scalar out[static_cast<std::size_t>(NetworkType::outputs * lanes)];
      for (int i = 0; i < NetworkType::inputs; ++i) {
        for (int s = 0; s < lanes; ++s) in[i * lanes + s] = x[i * samples + (s < samples ? s : samples - 1)];
      }
      block(parameters, in, lanes, out, lanes);
      for (int i = 0; i < NetworkType::outputs; ++i) {
        for (int s = 0; s < samples; ++s) y[i * samples + s] = out[i * lanes + s];
      }
    }
  }

 private:
  struct Kernel {
    template <class Layer, class Elementwise>
    static constexpr bool fuses =
        detail::BatchedLayer<Layer, Pack, lanes>::fuses_activation&& activates_pack<Elementwise, Pack>;
  };
  /// Inputs of a step, and the two buffers: it writes to `target`.
  struct At {
    const Scalar* x;
    int x_stride;
    Scalar* target;
    Scalar* other;
  };
  struct Visitor : detail::StepByStep {
    const Scalar* parameters;
    Scalar* y;
    int y_stride;
    template <class Step>
    PINNQUAD_ALWAYS_INLINE At visit(const At& at) const noexcept {
      Scalar* into = Step::last ? y : at.target;
      const int stride = Step::last ? y_stride : lanes;
      detail::batched_layer<typename Step::Layer, typename Step::Activation, Pack, lanes>(
          parameters + Step::parameters_offset, at.x, at.x_stride, into, stride);
      return {into, stride, at.other, at.target};
    }
  };

  static void block(const Scalar* parameters, const Scalar* x, int x_stride, Scalar* y, int y_stride) noexcept {
    alignas(64) Scalar even[static_cast<std::size_t>(NetworkType::widest * lanes)];
    alignas(64) Scalar odd[static_cast<std::size_t>(NetworkType::widest * lanes)];
    detail::walk_forward<NetworkType, Kernel>(Visitor{{}, parameters, y, y_stride}, At{x, x_stride, even, odd});
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad

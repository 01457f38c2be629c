// SPDX-License-Identifier: MIT
// Value and Jacobian of a network in one pass, for model-predictive and incremental control: forward, keeping each
// layer's outputs, then back from the outputs, all rows of the Jacobian at once. Weights are read where they are,
// row-major.
#pragma once

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/nn/packed_network.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a layer turns the gradients by its outputs into those by its inputs, `Rows` of them, both row-major with
/// `Stride`:
///   static void run<Pack, Rows, Stride>(parameters, x, y, by_output, by_input, finish) noexcept
/// where x and y are the layer's inputs and outputs, and `finish(column, pack)` is applied to each stored pack.
/// Specialise it for a layer of your own that is not element-wise, or give that layer, for one row,
///   static void pull_back(parameters, x, by_output, by_input) noexcept
template <class Layer>
struct PullBack {
  using Scalar = typename Layer::Scalar;
  static_assert(is_elementwise<Layer> || detail::pulls_back<Layer>,
                "pinnquad: this layer has no Jacobian; specialise pinnquad::PullBack (nn/jacobian.hpp)");
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar* x, const Scalar*,
                                         const Scalar* by_output, Scalar* by_input, const Finish& finish) noexcept {
    using Lane = GenericPack<Scalar, 1>;
    for (int row = 0; row < Rows; ++row, by_output += Stride, by_input += Stride) {
      Layer::pull_back(parameters, x, by_output, by_input);
      for (int i = 0; i < Layer::inputs; ++i) finish(i, Lane{{by_input[i]}}).store(by_input + i);
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// by_input = by_output W for row-major W (Out x In), behind which `Behind` more scalars may be read.
template <class Pack, int Rows, int Stride, int In, int Out, int Behind, class Scalar, class Finish>
PINNQUAD_ALWAYS_INLINE void pull_back_product(const Scalar* weight, const Scalar* by_output, Scalar* by_input,
                                              const Finish& finish) noexcept {
  // Packs side by side read past the end of a row and write past the end of `by_input`, which nothing reads.
  // Overlapping stores would be slow to read back.
  constexpr bool past_the_end = padded<Pack>(In) - In <= Behind;
  using Lane = std::conditional_t<past_the_end || (Pack::width <= In), Pack, GenericPack<Scalar, 1>>;
  constexpr int packs = padded<Lane>(In) / Lane::width;
  in_even_tiles<Rows, 6>([&](auto first, auto rows) PINNQUAD_INLINE_LAMBDA {
    unroll<(packs + 1) / 2>([&](auto pair) PINNQUAD_INLINE_LAMBDA {
      constexpr int begin = 2 * decltype(pair)::value;
      constexpr int vectors = begin + 1 < packs ? 2 : 1;
      using Columns = std::conditional_t<past_the_end, Consecutive<Lane, vectors, begin>,
                                         Overlapping<Lane, vectors, begin, (In > Lane::width ? In : Lane::width)>>;
      multiply_tile<Columns, decltype(rows)::value, Stride, 1>(
          by_output + first * Stride, weight, In, Out,
          [](auto, auto) PINNQUAD_INLINE_LAMBDA { return Lane::broadcast(Scalar(0)); },
          [&](auto, auto v, Lane sum) PINNQUAD_INLINE_LAMBDA { return finish(Columns::offset(v), sum); },
          by_input + first * Stride, Stride);
    });
  });
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

/// A dense layer's rule: its weights, transposed.
template <class Scalar, int In, int Out, bool HasBias>
struct PullBack<detail::DenseLayer<Scalar, In, Out, HasBias>> {
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar*, const Scalar*,
                                         const Scalar* by_output, Scalar* by_input, const Finish& finish) noexcept {
    constexpr int behind = HasBias ? Out : 0;
    detail::pull_back_product<Pack, Rows, Stride, In, Out, behind>(parameters, by_output, by_input, finish);
  }
};

/// With the running statistics: a factor per neuron.
template <class Scalar, int Size>
struct PullBack<BatchNorm::Bind<Scalar, Size>> {
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar*, const Scalar*,
                                         const Scalar* by_output, Scalar* by_input, const Finish& finish) noexcept {
    using Lane = GenericPack<Scalar, 1>;
    for (int i = 0; i < Size; ++i) {
      const Scalar factor = parameters[i] / detail::square_root(parameters[3 * Size + i] + Scalar(batch_norm_epsilon));
      for (int row = 0; row < Rows; ++row) {
        finish(i, Lane{{factor * by_output[row * Stride + i]}}).store(by_input + row * Stride + i);
      }
    }
  }
};

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// One layer forward. Out of line, so that equal layers share their code.
template <class Layer>
PINNQUAD_NOINLINE void keep_layer(const typename Layer::Scalar* parameters, const typename Layer::Scalar* x,
                                  typename Layer::Scalar* y) noexcept {
  Layer::forward(parameters, x, y);
}

/// One layer back, and the activation before it (void: none), of which `seen` is what its slope is asked with. Out of
/// line, as above.
template <class Layer, class Activation, class Pack, int Rows, int Stride>
PINNQUAD_NOINLINE void pull_back(const typename Layer::Scalar* parameters, const typename Layer::Scalar* x,
                                 const typename Layer::Scalar* y, const typename Layer::Scalar* seen,
                                 const typename Layer::Scalar* by_output, typename Layer::Scalar* by_input) noexcept {
  if constexpr (std::is_void_v<Activation>) {
    PullBack<Layer>::template run<Pack, Rows, Stride>(
        parameters, x, y, by_output, by_input, [](int, auto gradient) PINNQUAD_INLINE_LAMBDA { return gradient; });
  } else {
    PullBack<Layer>::template run<Pack, Rows, Stride>(
        parameters, x, y, by_output, by_input, [seen](int column, auto gradient) PINNQUAD_INLINE_LAMBDA {
          return scaled_by_slope<Activation>(decltype(gradient)::load(seen + column), gradient);
        });
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = network(x) and J = dy/dx, row-major, outputs x inputs: J[i * inputs + k] = dy_i / dx_k. Exact; at the kink of a
/// ReLU it is the derivative from below, 0. Time bounded, no heap; NaN in x reaches y.
template <class NetworkType, class PackType = NativePack<typename NetworkType::Scalar>>
class JacobianPass {
  static_assert(is_network<NetworkType>, "pinnquad: JacobianPass<N> needs a Network (nn/network.hpp)");

 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;

 private:
  static constexpr int layer_count = NetworkType::layer_count;
  static constexpr int rows = NetworkType::outputs;
  static constexpr int stride = padded<Pack>(NetworkType::widest);
  template <int Index>
  using Layer = typename NetworkType::template Layer<Index>;
  // kept: the inputs, where the first layer's slope is asked with them, then each layer's outputs; a whole pack may be
  // read at the last one
  static constexpr int kept_inputs = is_elementwise<Layer<0>> && slopes_from_input<Layer<0>> ? NetworkType::inputs : 0;
  static constexpr int all_kept = kept_inputs + NetworkType::Sizes::outputs_before(layer_count) + Pack::width;

 public:
  /// Stack that a call needs, about: what is kept and two sets of gradients.
  static constexpr std::size_t workspace_bytes =
      sizeof(Scalar) * static_cast<std::size_t>(all_kept + 2 * rows * stride);

  /// Forward by the portable kernel.
  static void run(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* jacobian) noexcept {
    Scalar kept[static_cast<std::size_t>(all_kept)];
    detail::walk_forward<NetworkType, detail::FusesNothing>(Forward{{}, parameters, kept}, x);
    for (int i = 0; i < rows; ++i) y[i] = outputs_of<layer_count - 1>(kept)[i];
    back(parameters, x, kept, jacobian);
  }

  /// Forward by the vector unit; `packed` holds the same parameters.
  static void run(const PackedNetwork<NetworkType, Pack>& packed, const Scalar* parameters, const Scalar* x, Scalar* y,
                  Scalar* jacobian) noexcept {
    Scalar kept[static_cast<std::size_t>(all_kept)];
    clear_fused(kept);
    packed.forward_keeping(x, y, kept + kept_inputs);
    back(parameters, x, kept, jacobian);
  }

 private:
  template <int Index, class Pointer>
  static PINNQUAD_ALWAYS_INLINE Pointer outputs_of(Pointer kept) noexcept {
    constexpr int offset = kept_inputs + NetworkType::Sizes::outputs_before(Index);
    return kept + offset;
  }
  /// A layer whose activation is fused into it may leave its outputs unwritten; whole packs of the layer before reach
  /// into them.
  static PINNQUAD_ALWAYS_INLINE void clear_fused(Scalar* kept) noexcept {
    unroll<layer_count>([kept](auto index) PINNQUAD_INLINE_LAMBDA {
      constexpr int layer = decltype(index)::value;
      if constexpr (layer > 0 && !is_elementwise<Layer<layer>>) {
        Scalar* const begin = outputs_of<layer>(kept);
        for (int i = 0; i < Pack::width; ++i) begin[i] = Scalar(0);
      }
    });
  }
  template <int Index>
  static PINNQUAD_ALWAYS_INLINE const Scalar* inputs_of(const Scalar* x, const Scalar* kept) noexcept {
    if constexpr (Index > 0) {
      return outputs_of<Index - 1>(kept);
    } else {
      return kept_inputs > 0 ? kept : x;
    }
  }
  /// Argument of an element-wise layer's slope: its input or its output.
  template <int Index>
  static PINNQUAD_ALWAYS_INLINE const Scalar* seen_by(const Scalar* x, const Scalar* kept) noexcept {
    if constexpr (slopes_from_input<Layer<Index>>) {
      return inputs_of<Index>(x, kept);
    } else {
      return outputs_of<Index>(kept);
    }
  }

  struct Forward : detail::StepByStep {
    const Scalar* parameters;
    Scalar* kept;
    template <class Step>
    PINNQUAD_ALWAYS_INLINE const Scalar* visit(const Scalar* x) const noexcept {
      Scalar* const y = outputs_of<Step::index>(kept);
      detail::keep_layer<typename Step::Layer>(parameters + Step::parameters_offset, x, y);
      return y;
    }
  };

  /// The activation before a layer is applied to what the layer stores, if it takes whole packs.
  struct BackKernel {
    template <class StepLayer, class Elementwise>
    static constexpr bool fuses = !is_elementwise<StepLayer> && scales_pack<Elementwise, Pack>;
  };
  /// Gradients by the outputs of a step, and where those by its inputs go.
  struct Gradients {
    Scalar* from;
    Scalar* to;
  };
  struct Back : detail::StepByStep {
    const Scalar* parameters;
    const Scalar* x;
    const Scalar* kept;
    template <class Step>
    PINNQUAD_ALWAYS_INLINE Gradients visit(const Gradients& gradients) const noexcept {
      using StepLayer = typename Step::Layer;
      constexpr int index = Step::index;
      if constexpr (is_elementwise<StepLayer>) {
        static_assert(
            has_slope<StepLayer>,
            "pinnquad: this layer has no Jacobian; an element-wise layer needs slope(y) or slope_from_input(v) "
            "(nn/layer.hpp)");
        const Scalar* const seen = seen_by<index>(x, kept);
        for (int row = 0; row < rows; ++row) {
          for (int i = 0; i < StepLayer::outputs; ++i) {
            Scalar& gradient = gradients.from[row * stride + i];
            gradient = detail::scaled_by_slope<StepLayer>(seen[i], gradient);
          }
        }
        return gradients;
      } else {
        const Scalar* seen = nullptr;
        if constexpr (Step::fused) seen = seen_by<index - 1>(x, kept);
        detail::pull_back<StepLayer, typename Step::Activation, Pack, rows, stride>(
            parameters + Step::parameters_offset, inputs_of<index>(x, kept), outputs_of<index>(kept), seen,
            gradients.from, gradients.to);
        return {gradients.to, gradients.from};
      }
    }
  };

  static PINNQUAD_ALWAYS_INLINE void back(const Scalar* parameters, const Scalar* x, Scalar* kept,
                                          Scalar* jacobian) noexcept {
    for (int i = 0; i < kept_inputs; ++i) kept[i] = x[i];
    alignas(64) Scalar gradients[2][static_cast<std::size_t>(rows * stride)] = {};
    for (int i = 0; i < rows; ++i) gradients[0][i * stride + i] = Scalar(1);
    const Gradients end = detail::walk_back<NetworkType, BackKernel>(Back{{}, parameters, x, kept},
                                                                     Gradients{gradients[0], gradients[1]});
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i < NetworkType::inputs; ++i) {
        jacobian[row * NetworkType::inputs + i] = end.from[row * stride + i];
      }
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad

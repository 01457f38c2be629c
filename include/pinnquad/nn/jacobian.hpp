// SPDX-License-Identifier: MIT
// Value and Jacobian of a network in one pass, for model-predictive and incremental control: forward, keeping what each layer
// gave, then back from the outputs, all rows of the Jacobian at once. Weights are read where they are, row-major.
#pragma once

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/nn/packed_network.hpp"

namespace pinnquad {

inline namespace PINNQUAD_INSTRUCTION_SET {

/// How a layer turns the gradients by its outputs into those by its inputs, `Rows` of them, both row-major with `Stride`:
///   static void run<Pack, Rows, Stride>(parameters, y, by_output, by_input, finish)
/// where `finish(column, pack)` is applied to what is stored. Specialise it for a layer of your own that is not element-wise.
template <class Layer>
struct PullBack {
  static_assert(is_elementwise<Layer>,
                "pinnquad: this layer has no Jacobian; specialise pinnquad::PullBack (nn/jacobian.hpp)");
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// What is left of a gradient when nothing has to be done with it.
struct NoSlope {
  template <class Pack>
  PINNQUAD_ALWAYS_INLINE Pack operator()(int, Pack gradient) const noexcept {
    return gradient;
  }
};

/// by_input = by_output W for row-major W (Out x In), behind which `Behind` more scalars may be read.
template <class Pack, int Rows, int Stride, int In, int Out, int Behind, class Scalar, class Finish>
PINNQUAD_ALWAYS_INLINE void pull_back_product(const Scalar* weight, const Scalar* by_output, Scalar* by_input,
                                              const Finish& finish) noexcept {
  // Packs side by side read past the end of a row, into the next one, and leave nonsense past the end of `by_input`, where
  // nobody looks. Overlapping stores would be slow to read back.
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

template <class Scalar, int In, int Out>
struct PullBack<DenseLayer<Scalar, In, Out>> {
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar*, const Scalar* by_output,
                                         Scalar* by_input, const Finish& finish) noexcept {
    detail::pull_back_product<Pack, Rows, Stride, In, Out, Out>(parameters, by_output, by_input,
                                                                finish);  // the bias is behind
  }
};

template <class Scalar, int In, int Out>
struct PullBack<DenseWithoutBiasLayer<Scalar, In, Out>> {
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar*, const Scalar* by_output,
                                         Scalar* by_input, const Finish& finish) noexcept {
    detail::pull_back_product<Pack, Rows, Stride, In, Out, 0>(parameters, by_output, by_input, finish);
  }
};

/// With the running statistics: a factor per neuron.
template <class Scalar, int Size>
struct PullBack<BatchNormLayer<Scalar, Size>> {
  template <class Pack, int Rows, int Stride, class Finish>
  static PINNQUAD_ALWAYS_INLINE void run(const Scalar* parameters, const Scalar*, const Scalar* by_output,
                                         Scalar* by_input, const Finish& finish) noexcept {
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

/// One layer back, and the activation before it (void: none), whose outputs are `activated`. Out of line, as above.
template <class Layer, class Activation, class Pack, int Rows, int Stride>
PINNQUAD_NOINLINE void pull_back(const typename Layer::Scalar* parameters, const typename Layer::Scalar* y,
                                 const typename Layer::Scalar* activated, const typename Layer::Scalar* by_output,
                                 typename Layer::Scalar* by_input) noexcept {
  if constexpr (std::is_void_v<Activation>) {
    PullBack<Layer>::template run<Pack, Rows, Stride>(parameters, y, by_output, by_input, NoSlope{});
  } else {
    PullBack<Layer>::template run<Pack, Rows, Stride>(
        parameters, y, by_output, by_input, [activated](int column, auto gradient) PINNQUAD_INLINE_LAMBDA {
          using Lane = decltype(gradient);
          return Activation::scaled(Lane::load(activated + column), gradient);
        });
  }
}

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// y = network(x) and J = dy/dx, row-major, outputs x inputs: J[i * inputs + k] = dy_i / dx_k. Exact; at the kink of a ReLU it
/// is the derivative from below, 0. Time bounded, no heap; NaN in x reaches y.
template <class NetworkType, class PackType = NativePack<typename NetworkType::Scalar>>
class JacobianPass {
  static_assert(is_network<NetworkType>, "pinnquad: JacobianPass<N> needs a Network (nn/network.hpp)");

 public:
  using Scalar = typename NetworkType::Scalar;
  using Pack = PackType;

  /// Stack that a call needs, about: all activations and two sets of gradients.
  static constexpr std::size_t workspace_bytes =
      sizeof(Scalar) *
      static_cast<std::size_t>(NetworkType::Sizes::outputs_before(NetworkType::layer_count) + Pack::width +
                               2 * NetworkType::outputs * padded<Pack>(NetworkType::widest));

  /// Forward by the portable kernel.
  static void run(const Scalar* parameters, const Scalar* x, Scalar* y, Scalar* jacobian) noexcept {
    Scalar values[static_cast<std::size_t>(all_values)];
    forward<0>(parameters, x, values);
    for (int i = 0; i < rows; ++i) y[i] = values[offset<layer_count - 1> + i];
    back(parameters, values, jacobian);
  }

  /// Forward by the vector unit; `packed` holds the same parameters.
  static void run(const PackedNetwork<NetworkType, Pack>& packed, const Scalar* parameters, const Scalar* x, Scalar* y,
                  Scalar* jacobian) noexcept {
    Scalar values[static_cast<std::size_t>(all_values)];
    packed.forward_keeping(x, y, values);
    back(parameters, values, jacobian);
  }

 private:
  static PINNQUAD_ALWAYS_INLINE void back(const Scalar* parameters, const Scalar* values, Scalar* jacobian) noexcept {
    alignas(64) Scalar gradients[2][static_cast<std::size_t>(rows * stride)] = {};
    for (int i = 0; i < rows; ++i) gradients[0][i * stride + i] = Scalar(1);
    const Scalar* by_input = back<layer_count - 1>(parameters, values, gradients[0], gradients[1]);
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i < NetworkType::inputs; ++i)
        jacobian[row * NetworkType::inputs + i] = by_input[row * stride + i];
    }
  }

  static constexpr int layer_count = NetworkType::layer_count;
  static constexpr int all_outputs = NetworkType::Sizes::outputs_before(layer_count);
  static constexpr int rows = NetworkType::outputs;
  static constexpr int stride = padded<Pack>(NetworkType::widest);
  static constexpr int all_values = all_outputs + Pack::width;  ///< a whole pack may be read at the last value
  template <int Index>
  using Layer = typename NetworkType::template Layer<Index>;
  /// Of a layer's outputs among the values, and of its parameters.
  template <int Index>
  static constexpr int offset = NetworkType::Sizes::outputs_before(Index);
  template <int Index>
  static constexpr int parameters_offset = NetworkType::Sizes::offset(Index);

  template <int Index>
  static PINNQUAD_ALWAYS_INLINE void forward(const Scalar* parameters, const Scalar* x, Scalar* values) noexcept {
    Scalar* y = values + offset<Index>;
    detail::keep_layer<Layer<Index>>(parameters + parameters_offset<Index>, x, y);
    if constexpr (Index + 1 < layer_count) forward<Index + 1>(parameters, y, values);
  }

  /// From the gradients by this layer's output down to those by the network's input: where they ended up.
  template <int Index>
  static PINNQUAD_ALWAYS_INLINE const Scalar* back(const Scalar* parameters, const Scalar* values, Scalar* from,
                                                   Scalar* to) noexcept {
    if constexpr (Index < 0) {
      return from;
    } else if constexpr (is_elementwise<Layer<Index>>) {
      static_assert(has_slope<Layer<Index>>,
                    "pinnquad: this layer has no Jacobian; an element-wise layer needs slope(y) (nn/layer.hpp)");
      for (int row = 0; row < rows; ++row) {
        for (int i = 0; i < Layer<Index>::outputs; ++i) {
          from[row * stride + i] *= Layer<Index>::slope(values[offset<Index> + i]);
        }
      }
      return back<Index - 1>(parameters, values, from, to);
    } else {
      const Scalar* own = parameters + parameters_offset<Index>;
      const Scalar* y = values + offset<Index>;
      if constexpr (fuses<Index>()) {
        detail::pull_back<Layer<Index>, Layer<Index - 1>, Pack, rows, stride>(own, y, values + offset<Index - 1>, from,
                                                                              to);
        return back<Index - 2>(parameters, values, to, from);
      } else {
        detail::pull_back<Layer<Index>, void, Pack, rows, stride>(own, y, nullptr, from, to);
        return back<Index - 1>(parameters, values, to, from);
      }
    }
  }

  /// The activation before this layer takes whole packs: its slope is applied to what this layer stores.
  template <int Index>
  static constexpr bool fuses() noexcept {
    if constexpr (Index > 0) {
      return is_elementwise<Layer<Index - 1>> && scales_pack<Layer<Index - 1>, Pack>;
    } else {
      return false;
    }
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// Backward passes of layers. The contract of a layer's own: a specialisation `BackwardRule<Layer>` for one sample,
//   static void backward(const Scalar* parameters, const Scalar* x, const Scalar* y, const Scalar* dy, Scalar* dx,
//                        Scalar* parameter_gradient) noexcept;
// dx is set, parameter_gradient is added to. Dense needs none, an element-wise layer has its slope (nn/layer.hpp), and
// one with a pull_back() has the rule below.
// Over a mini-batch activations are [feature][sample], a sample per lane, each row as long as the largest batch in
// whole blocks. A forward pass runs over whole packs: lanes behind the last sample hold copies of it. A backward pass
// may leave anything there, and no sum over samples takes it in.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "pinnquad/core/detected.hpp"
#include "pinnquad/nn/dense.hpp"
#include "pinnquad/nn/kernel/register_layer.hpp"
#include "pinnquad/nn/kernel/tile.hpp"
#include "pinnquad/nn/kernel/transpose.hpp"
#include "pinnquad/nn/layer.hpp"

namespace pinnquad {

namespace detail {
template <class Layer>
using AddGradientOf = decltype(&Layer::add_gradient);
}  // namespace detail

/// A layer that pulls back (nn/layer.hpp) brings, where it has parameters, for one sample
///   static void add_gradient(const Scalar* x, const Scalar* dy, Scalar* parameter_gradient) noexcept;
template <class Layer>
struct BackwardRule {
  using Scalar = typename Layer::Scalar;
  template <class Number, class = std::enable_if_t<std::is_same_v<Number, Scalar> && detail::pulls_back<Layer>>>
  static void backward(const Number* parameters, const Scalar* x, const Scalar*, const Scalar* dy, Scalar* dx,
                       [[maybe_unused]] Scalar* parameter_gradient) noexcept {
    if constexpr (is_detected<detail::AddGradientOf, Layer>) Layer::add_gradient(x, dy, parameter_gradient);
    Layer::pull_back(parameters, x, dy, dx);
  }
};

namespace detail {

template <class Layer>
using BackwardOf = std::bool_constant<noexcept(BackwardRule<Layer>::backward(
    std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
    std::declval<const typename Layer::Scalar*>(), std::declval<const typename Layer::Scalar*>(),
    std::declval<typename Layer::Scalar*>(), std::declval<typename Layer::Scalar*>()))>;

/// The sum of a pack's lanes: those of a block of rows, added as a layer in registers adds them.
template <class Pack>
PINNQUAD_ALWAYS_INLINE typename Pack::Scalar sum_of_lanes(const Pack& v) noexcept {
  if constexpr (keeps_layers_in_registers<Pack>) {
    Pack blocks[Pack::blocks_per_register];
    for (Pack& block : blocks) block = Pack::broadcast(typename Pack::Scalar(0));
    blocks[0] = v;
    return Pack::collect(blocks).sum_of_values().first_value();
  } else {
    alignas(64) typename Pack::Scalar lane[Pack::width];
    v.store(lane);
    typename Pack::Scalar sum = lane[0];
    for (int i = 1; i < Pack::width; ++i) sum += lane[i];
    return sum;
  }
}

/// Packs of samples that run at once.
template <class Pack, int BatchSize>
inline constexpr int packs_in_block = BatchSize > Pack::width ? 2 : 1;
/// Samples in a row of activations: the batch in whole blocks.
template <class Pack, int BatchSize>
inline constexpr int batch_capacity = (BatchSize + Pack::width * packs_in_block<Pack, BatchSize> - 1) /
                                      (Pack::width *
                                       packs_in_block<Pack, BatchSize>)*(Pack::width* packs_in_block<Pack, BatchSize>);

/// The members of every layer over a mini-batch, but for load(), store(), store_gradient(), forward() and backward().
struct BatchTraits {
  static constexpr bool in_place = false;         ///< works in the buffer of a layer before that does not need it
  static constexpr bool needs_output = false;     ///< backward() reads y: it may not be overwritten
  static constexpr bool couples_samples = false;  ///< outputs depend on the other samples of the batch (batch_norm.hpp)
  static constexpr bool fuses_activation = false;  ///< forward() takes the activation behind the layer
  static constexpr bool fuses_slope = false;       ///< backward() takes the slope of the activation before the layer
  static constexpr int size = 0;                   ///< of the arrays that an optimiser sees
};

/// The flat arrays that an optimiser sees.
template <class Scalar, int Size>
struct BatchParameters : BatchTraits {
  static constexpr int size = Size;
  alignas(64) Scalar stored[static_cast<std::size_t>(Size > 0 ? Size : 1)] = {};
  alignas(64) Scalar gradient[static_cast<std::size_t>(Size > 0 ? Size : 1)] = {};
  alignas(64) Scalar first_moment[static_cast<std::size_t>(Size > 0 ? Size : 1)] = {};
  alignas(64) Scalar second_moment[static_cast<std::size_t>(Size > 0 ? Size : 1)] = {};
};

/// Any layer: its BackwardRule sample by sample.
template <class Layer, class Pack, int BatchSize, class = void>
struct BatchLayer : BatchParameters<typename Layer::Scalar, padded<Pack>(Layer::parameter_count)> {
  static_assert(is_detected<BackwardOf, Layer>,
                "pinnquad: this layer cannot be trained; specialise BackwardRule (training/backward.hpp)");
  static_assert(is_noexcept_where_given<BackwardOf, Layer>(),
                "pinnquad: a BackwardRule's backward() must be noexcept (training/backward.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool needs_output = true;
  static constexpr int stride = batch_capacity<Pack, BatchSize>;

  void load(const Scalar* parameters) noexcept { copy(parameters, this->stored); }
  void store(Scalar* parameters) const noexcept { copy(this->stored, parameters); }
  void store_gradient(Scalar* parameters) const noexcept { copy(this->gradient, parameters); }

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    for (int i = 0; i < padded<Pack>(samples); ++i) {
      Scalar in[Layer::inputs], out[Layer::outputs];
      gather(x + i, in);
      Layer::forward(this->stored, in, out);
      scatter(out, y + i);
    }
  }
  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  void backward(const Scalar* x, const Scalar* y, const Scalar* delta, Scalar* previous, int samples) noexcept {
    for (Scalar& g : this->gradient) g = Scalar(0);
    for (int i = 0; i < samples; ++i) {
      Scalar in[Layer::inputs], out[Layer::outputs], dy[Layer::outputs], dx[Layer::inputs];
      gather(x + i, in);
      gather(y + i, out);
      gather(delta + i, dy);
      BackwardRule<Layer>::backward(this->stored, in, out, dy, dx, this->gradient);
      if (previous != nullptr) scatter(dx, previous + i);
    }
  }

 private:
  template <std::size_t Size>
  static void gather(const Scalar* column, Scalar (&values)[Size]) noexcept {
    for (std::size_t i = 0; i < Size; ++i) values[i] = column[static_cast<int>(i) * stride];
  }
  template <std::size_t Size>
  static void scatter(const Scalar (&values)[Size], Scalar* column) noexcept {
    for (std::size_t i = 0; i < Size; ++i) column[static_cast<int>(i) * stride] = values[i];
  }
  static void copy(const Scalar* from, Scalar* to) noexcept {
    for (int i = 0; i < Layer::parameter_count; ++i) to[i] = from[i];
  }
};

/// Dense: dx = W^T dy, dW = dy x^T, db = dy, by register tiles. A row of `stored` is that of an output: its weights,
/// its bias, padding. The gradient is the product of dy with the samples' inputs, transposed, each with a 1 for the
/// bias behind. Where at most one input is left over from wide packs, its column and the bias' are sums over lanes of
/// samples instead: a pack of columns for them would be padding for the most part.
template <class Scalar, int In, int Out, bool HasBias, class Pack, int BatchSize>
struct BatchDense : BatchParameters<Scalar, Out * padded<Pack>(In + (HasBias ? 1 : 0))> {
  static constexpr bool fuses_activation = true;
  static constexpr bool fuses_slope = true;
  static constexpr int row = padded<Pack>(In + (HasBias ? 1 : 0));
  static constexpr int stride = batch_capacity<Pack, BatchSize>;
  static constexpr bool sums_behind = HasBias && Pack::width >= 8 && In >= Pack::width && In % Pack::width <= 1;
  /// Columns of the gradient that are a product of matrices.
  static constexpr int product_columns = sums_behind ? In / Pack::width * Pack::width : row;

  void load(const Scalar* parameters) noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) this->stored[out * row + in] = parameters[out * In + in];
      if constexpr (HasBias) this->stored[out * row + In] = parameters[Out * In + out];
    }
  }
  void store(Scalar* parameters) const noexcept { gather(this->stored, parameters); }
  void store_gradient(Scalar* parameters) const noexcept { gather(this->gradient, parameters); }

  template <class Activation>
  PINNQUAD_NOINLINE void forward(const Scalar* x, Scalar* y, int samples, const Activation& activation) const noexcept {
    const auto start = [&](int out) PINNQUAD_INLINE_LAMBDA {
      return Pack::broadcast(HasBias ? this->stored[out * row + In] : Scalar(0));
    };
    const auto finish = [&](auto, auto, Pack sum) PINNQUAD_INLINE_LAMBDA { return activation(sum); };
    for (int i = 0; i < samples; i += block) {
      multiply_lanes<Pack, vectors, Out, row, 1>(this->stored, x + i, stride, In, start, finish, y + i, stride);
    }
  }
  /// `delta` holds dy; scale(x, dx) goes to `previous` (which may be null for the first layer).
  template <class Scale>
  PINNQUAD_NOINLINE void backward(const Scalar* x, const Scalar* delta, Scalar* previous, int samples,
                                  const Scale& scale) noexcept {
    constexpr int columns = product_columns;
    alignas(64) Scalar by_sample[static_cast<std::size_t>(stride * columns)];
    if constexpr (sums_behind) {
      sum_columns_behind(x, delta, samples);
    } else if constexpr (row > In) {
      constexpr int last = row - Pack::width;
      Scalar behind[Pack::width] = {};
      if (HasBias) behind[In - last] = Scalar(1);
      for (int i = 0; i < samples; ++i) Pack::load(behind).store(by_sample + i * row + last);
    }
    transpose<Pack>(x, stride, columns < In ? columns : In, samples, by_sample, columns);
    multiply_matrices<Pack, Out, stride, columns, row>(delta, by_sample, samples, this->gradient);
    if (previous == nullptr) return;
    for (int i = 0; i < samples; i += block) {
      multiply_lanes<Pack, vectors, In, 1, row>(
          this->stored, delta + i, stride, Out, [](int) PINNQUAD_INLINE_LAMBDA { return Pack::broadcast(Scalar(0)); },
          [&](int in, int v, Pack dx)
              PINNQUAD_INLINE_LAMBDA { return scale(Pack::load(x + in * stride + i + v * Pack::width), dx); },
          previous + i, stride);
    }
  }

 private:
  static constexpr int vectors = packs_in_block<Pack, BatchSize>;
  static constexpr int block = vectors * Pack::width;

  /// The gradient by the weights of the input behind the product's, if there is one, and by the biases.
  void sum_columns_behind(const Scalar* x, const Scalar* delta, int samples) noexcept {
    constexpr bool left_over = product_columns < In;
    const int whole = samples / Pack::width * Pack::width;
    alignas(64) Scalar used[Pack::width] = {};  // of the last pack: 1 for a sample, else 0
    for (int i = 0; i < samples - whole; ++i) used[i] = Scalar(1);
    const Pack counts = Pack::load(used);
    for (int out = 0; out < Out; ++out) {
      Pack weight = Pack::broadcast(Scalar(0)), bias = weight;
      const auto add = [&](int i, const Pack& dy) PINNQUAD_INLINE_LAMBDA {
        if constexpr (left_over) weight = Pack::multiply_add(dy, Pack::load(x + product_columns * stride + i), weight);
        bias = bias + dy;
      };
      const Scalar* const by_output = delta + out * stride;
      for (int i = 0; i < whole; i += Pack::width) add(i, Pack::load(by_output + i));
      if (samples > whole) add(whole, Pack::where_positive(counts, Pack::load(by_output + whole)));
      if constexpr (left_over) this->gradient[out * row + product_columns] = sum_of_lanes(weight);
      this->gradient[out * row + In] = sum_of_lanes(bias);
    }
  }

  static void gather(const Scalar* from, Scalar* parameters) noexcept {
    for (int out = 0; out < Out; ++out) {
      for (int in = 0; in < In; ++in) parameters[out * In + in] = from[out * row + in];
      if constexpr (HasBias) parameters[Out * In + out] = from[out * row + In];
    }
  }
};
template <class Scalar, int In, int Out, bool HasBias, class Pack, int BatchSize>
struct BatchLayer<DenseLayer<Scalar, In, Out, HasBias>, Pack, BatchSize, void>
    : BatchDense<Scalar, In, Out, HasBias, Pack, BatchSize> {};

/// Element-wise, with a slope from the output: forward works on its own buffer or on that of the layer before, dx
/// overwrites dy. With a slope from the input, the input is left as it is, and dx goes to a buffer of its own.
template <class Layer, class Pack, int BatchSize>
struct BatchLayer<Layer, Pack, BatchSize, std::enable_if_t<is_elementwise<Layer>>> : BatchTraits {
  static_assert(has_slope<Layer>,
                "pinnquad: this layer cannot be trained; an element-wise layer needs slope(y) or slope_from_input(v) "
                "(nn/layer.hpp)");
  using Scalar = typename Layer::Scalar;
  static constexpr bool in_place = !slopes_from_input<Layer>;
  static constexpr bool needs_output = in_place;
  static constexpr int stride = batch_capacity<Pack, BatchSize>;

  void load(const Scalar*) noexcept {}
  void store(Scalar*) const noexcept {}
  void store_gradient(Scalar*) const noexcept {}

  void forward(const Scalar* x, Scalar* y, int samples) const noexcept {
    const Activate<Layer> activate;
    constexpr bool packs = activates_pack<Layer, Pack>;
    each<packs ? Pack::width : 1>(samples, [&](int i) PINNQUAD_INLINE_LAMBDA {
      if constexpr (packs) {
        activate(Pack::load(x + i)).store(y + i);
      } else {
        y[i] = activate(x[i]);
      }
    });
  }
  void backward(const Scalar* x, const Scalar* y, const Scalar* delta, Scalar* previous, int samples) noexcept {
    if (previous == nullptr) return;
    const Scalar* seen = in_place ? y : x;
    constexpr bool packs = scales_pack<Layer, Pack>;
    each<packs ? Pack::width : 1>(samples, [&](int i) PINNQUAD_INLINE_LAMBDA {
      if constexpr (packs) {
        scaled_by_slope<Layer>(Pack::load(seen + i), Pack::load(delta + i)).store(previous + i);
      } else {
        previous[i] = scaled_by_slope<Layer>(seen[i], delta[i]);
      }
    });
  }

 private:
  /// body(index) for every feature and every `Step`-th lane of whole packs.
  template <int Step, class Body>
  static PINNQUAD_ALWAYS_INLINE void each(int samples, const Body& body) {
    for (int row = 0; row < Layer::outputs * stride; row += stride) {
      for (int lane = 0; lane < padded<Pack>(samples); lane += Step) body(row + lane);
    }
  }
};

/// dx times the slope of the activation that gave x; of `void`, dx itself.
template <class Layer>
struct ScaleBySlope {
  template <class Pack>
  PINNQUAD_ALWAYS_INLINE Pack operator()(const Pack& x, const Pack& dx) const noexcept {
    if constexpr (std::is_void_v<Layer>) {
      return dx;
    } else {
      return scaled_by_slope<Layer>(x, dx);
    }
  }
};

}  // namespace detail

}  // namespace pinnquad

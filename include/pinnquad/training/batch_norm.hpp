// SPDX-License-Identifier: MIT
// Batch norm over a mini-batch: statistics of the batch in training, running ones for prediction (PyTorch's meaning).
// A neuron's samples stand side by side: sums go lane by lane, and the lanes of many neurons are added at once.
#pragma once

#include <cstddef>

#include "pinnquad/nn/batch_norm.hpp"
#include "pinnquad/training/backward.hpp"

namespace pinnquad {

/// Share of a batch's statistics in the running ones (PyTorch's `momentum`).
inline constexpr double batch_norm_momentum = 0.1;

namespace detail {

/// Forward: xhat = (x - mean) / sqrt(var + 1e-5), y = gamma xhat + beta; mean and var (divisor N) of the N samples.
/// Backward: dbeta = sum dy, dgamma = sum dy xhat, dx = gamma / sqrt(var + 1e-5) (dy - dbeta / N - xhat dgamma / N).
/// Running statistics r <- 0.9 r + 0.1 batch, the variance with divisor N - 1; follow_statistics() moves them.
/// One sample has no variance: it is normalised by the running statistics, which stay as they are, and the gradient is
/// that of the affine map which remains. (PyTorch refuses such a batch.) The optimiser sees gamma and beta only.
template <class Scalar, int Size, class Pack, int BatchSize>
struct BatchLayer<BatchNorm::Bind<Scalar, Size>, Pack, BatchSize, void>
    : BatchParameters<Scalar, 2 * padded<Pack>(Size)> {  // gamma, then beta
  static_assert(BatchSize > 1, "pinnquad: batch norm can't be trained in batches of one sample; they have no variance");
  static constexpr bool couples_samples = true;
  static constexpr bool fuses_activation = true;
  static constexpr int stride = batch_capacity<Pack, BatchSize>;
  static constexpr int neurons = padded<Pack>(Size);

  using BatchParameters<Scalar, 2 * neurons>::stored;
  using BatchParameters<Scalar, 2 * neurons>::gradient;
  alignas(64) Scalar running_mean[static_cast<std::size_t>(neurons)] = {};
  alignas(64) Scalar running_variance[static_cast<std::size_t>(neurons)] = {};
  alignas(64) Scalar mean[static_cast<std::size_t>(neurons)] = {};      // of the last batch
  alignas(64) Scalar variance[static_cast<std::size_t>(neurons)] = {};  // of the last batch, divisor N
  alignas(64) Scalar inverse_deviation[static_cast<std::size_t>(neurons)] = {};  // 1 / sqrt(variance + epsilon)
  int batch_samples = 0;

  void load(const Scalar* parameters) noexcept {
    for (int i = 0; i < Size; ++i) {
      stored[i] = parameters[i];
      stored[neurons + i] = parameters[Size + i];
      running_mean[i] = parameters[2 * Size + i];
      running_variance[i] = parameters[3 * Size + i];
    }
  }
  void store(Scalar* parameters) const noexcept {
    for (int i = 0; i < Size; ++i) {
      parameters[i] = stored[i];
      parameters[Size + i] = stored[neurons + i];
      parameters[2 * Size + i] = running_mean[i];
      parameters[3 * Size + i] = running_variance[i];
    }
  }
  /// That of the running statistics is 0: no loss depends on them.
  void store_gradient(Scalar* parameters) const noexcept {
    for (int i = 0; i < Size; ++i) {
      parameters[i] = gradient[i];
      parameters[Size + i] = gradient[neurons + i];
      parameters[2 * Size + i] = parameters[3 * Size + i] = Scalar(0);
    }
  }
  template <class Activation>
  PINNQUAD_NOINLINE void forward(const Scalar* x, Scalar* y, int samples, const Activation& activation) noexcept {
    batch_samples = samples;
    if (samples > 1) {
      take_statistics(x, samples);
    } else {
      copy_running_statistics();
    }
    normalise(x, y, samples, activation);
  }
  /// By running statistics.
  template <class Activation>
  void predict(const Scalar* x, Scalar* y, int samples, const Activation& activation) noexcept {
    batch_samples = 1;
    copy_running_statistics();
    normalise(x, y, samples, activation);
  }

  void follow_statistics() noexcept {
    if (batch_samples < 2) return;
    const Pack old_share = Pack::broadcast(Scalar(1.0 - batch_norm_momentum));
    const Pack share = Pack::broadcast(Scalar(batch_norm_momentum));
    const Pack unbiased = Pack::broadcast(Scalar(batch_norm_momentum * batch_samples / (batch_samples - 1.0)));
    for (int i = 0; i < neurons; i += Pack::width) {
      Pack::multiply_add(old_share, Pack::load(running_mean + i), share * Pack::load(mean + i)).store(running_mean + i);
      Pack::multiply_add(old_share, Pack::load(running_variance + i), unbiased * Pack::load(variance + i))
          .store(running_variance + i);
    }
  }

  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  PINNQUAD_NOINLINE void backward(const Scalar* x, const Scalar*, const Scalar* delta, Scalar* previous,
                                  int samples) noexcept {
    const Lanes lanes(samples);
    const auto distance = [&](int neuron, int i)
                              PINNQUAD_INLINE_LAMBDA { return Pack::load(x + i) - Pack::broadcast(mean[neuron]); };
    const Scalar* const beta_gradient = gradient + neurons;
    lanes.sums(gradient, [&](int neuron, int i, Pack& gamma_sum, Pack& beta_sum) PINNQUAD_INLINE_LAMBDA {
      const Pack dy = Pack::load(delta + i);
      gamma_sum = Pack::multiply_add(dy, distance(neuron, i), gamma_sum);
      beta_sum = beta_sum + dy;
    });
    for (int i = 0; i < neurons; i += Pack::width) {
      (Pack::load(gradient + i) * Pack::load(inverse_deviation + i)).store(gradient + i);
    }
    if (previous == nullptr) return;

    // dx = factor (dy - a - b (x - mean)); a batch of one was normalised by constants: a = b = 0
    const Scalar share = samples > 1 ? Scalar(1) / Scalar(samples) : Scalar(0);
    lanes.each([&](int neuron, const auto& over_samples) PINNQUAD_INLINE_LAMBDA {
      const Scalar inverse = inverse_deviation[neuron];
      const Scalar scale = stored[neuron] * inverse;
      const Pack factor = Pack::broadcast(scale);
      const Pack shift = Pack::broadcast(-scale * share * beta_gradient[neuron]);
      const Pack slope = Pack::broadcast(-scale * share * gradient[neuron] * inverse);
      over_samples([&](int i) PINNQUAD_INLINE_LAMBDA {
        const Pack direct = Pack::multiply_add(factor, Pack::load(delta + i), shift);
        Pack::multiply_add(slope, distance(neuron, i), direct).store(previous + i);
      });
    });
  }

 private:
  static constexpr int vectors = packs_in_block<Pack, BatchSize>;
  static constexpr int block = vectors * Pack::width;

  /// The samples of a batch in blocks.
  struct Lanes {
    int whole;                            ///< samples in blocks that they fill
    int samples;                          ///< all
    alignas(64) Scalar used[static_cast<std::size_t>(block)] = {};  ///< of the last block: 1 for a sample, else 0

    explicit Lanes(int count) noexcept : whole(count / block * block), samples(count) {
      for (int i = 0; i < samples - whole; ++i) used[i] = Scalar(1);
    }
    /// body(neuron, over_samples), over_samples(of_pack): of_pack(index of the pack in [neuron][sample]).
    template <class Body>
    PINNQUAD_ALWAYS_INLINE void each(const Body& body) const noexcept {
      for (int neuron = 0; neuron < Size; ++neuron) {
        body(neuron, [&](const auto& of_pack) PINNQUAD_INLINE_LAMBDA {
          for (int i = 0; i < samples; i += block) {
            unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA { of_pack(neuron * stride + i + v * Pack::width); });
          }
        });
      }
    }
    /// Two sums over the samples of each neuron, to result[neuron] and behind the neurons; add(neuron, index of the
    /// pack, first, second) adds that pack.
    template <class Add>
    PINNQUAD_ALWAYS_INLINE void sums(Scalar* result, const Add& add) const noexcept {
      const Pack zero = Pack::broadcast(Scalar(0));
      for (int neuron = 0; neuron < Size; ++neuron) {
        Pack first[2] = {zero, zero}, second[2] = {zero, zero};
        int i = neuron * stride;
        for (; i < neuron * stride + whole; i += block) {
          unroll<vectors>([&](auto v)
                              PINNQUAD_INLINE_LAMBDA { add(neuron, i + v * Pack::width, first[v], second[v]); });
        }
        if (samples > whole) {
          unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
            const Pack counts = Pack::load(used + v * Pack::width);
            Pack seen[2] = {zero, zero};
            add(neuron, i + v * Pack::width, seen[0], seen[1]);
            first[v] = first[v] + Pack::where_positive(counts, seen[0]);
            second[v] = second[v] + Pack::where_positive(counts, seen[1]);
          });
        }
        result[neuron] = sum_of_lanes(first[0] + first[1]);
        result[neurons + neuron] = sum_of_lanes(second[0] + second[1]);
      }
    }
  };

  /// By the distances from the batch's first sample: one pass, and nothing is lost where the mean is large.
  void take_statistics(const Scalar* x, int samples) noexcept {
    alignas(64) Scalar sums[static_cast<std::size_t>(2 * neurons)] = {}, origin[static_cast<std::size_t>(neurons)] = {};
    for (int neuron = 0; neuron < Size; ++neuron) origin[neuron] = x[neuron * stride];
    Lanes(samples).sums(sums, [&](int neuron, int i, Pack& sum, Pack& squares) PINNQUAD_INLINE_LAMBDA {
      const Pack distance = Pack::load(x + i) - Pack::broadcast(origin[neuron]);
      sum = sum + distance;
      squares = Pack::multiply_add(distance, distance, squares);
    });
    const Pack share = Pack::broadcast(Scalar(1) / Scalar(samples));
    for (int i = 0; i < neurons; i += Pack::width) {
      const Pack distance = share * Pack::load(sums + i);
      (Pack::load(origin + i) + distance).store(mean + i);
      Pack::positive_part(share * Pack::load(sums + neurons + i) - distance * distance).store(variance + i);
    }
    invert_deviation();
  }
  void copy_running_statistics() noexcept {
    for (int i = 0; i < neurons; ++i) {
      mean[i] = running_mean[i];
      variance[i] = running_variance[i];
    }
    invert_deviation();
  }
  void invert_deviation() noexcept {
    const Pack one = Pack::broadcast(Scalar(1)), epsilon = Pack::broadcast(Scalar(batch_norm_epsilon));
    for (int i = 0; i < neurons; i += Pack::width) {
      (one / Pack::square_root(Pack::load(variance + i) + epsilon)).store(inverse_deviation + i);
    }
  }
  template <class Activation>
  PINNQUAD_ALWAYS_INLINE void normalise(const Scalar* x, Scalar* y, int samples,
                                        const Activation& activation) const noexcept {
    Lanes(samples).each([&](int neuron, const auto& over_samples) PINNQUAD_INLINE_LAMBDA {
      const Pack center = Pack::broadcast(mean[neuron]);
      const Pack factor = Pack::broadcast(stored[neuron] * inverse_deviation[neuron]);
      const Pack shift = Pack::broadcast(stored[neurons + neuron]);
      over_samples([&](int i) PINNQUAD_INLINE_LAMBDA {
        activation(Pack::multiply_add(Pack::load(x + i) - center, factor, shift)).store(y + i);
      });
    });
  }
};

}  // namespace detail

}  // namespace pinnquad

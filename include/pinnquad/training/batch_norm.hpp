// SPDX-License-Identifier: MIT
// Batch norm over a mini-batch: statistics of the batch in training, running ones for prediction (PyTorch's meaning).
// Works on whole rows of [sample][padded width], a pack of neurons at a time.
#pragma once

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
  static constexpr int stride = padded<Pack>(Size);

  using BatchParameters<Scalar, 2 * stride>::stored;
  using BatchParameters<Scalar, 2 * stride>::gradient;
  alignas(64) Scalar running_mean[stride] = {};
  alignas(64) Scalar running_variance[stride] = {};
  alignas(64) Scalar mean[stride] = {};               // of the last batch
  alignas(64) Scalar variance[stride] = {};           // of the last batch, divisor N
  alignas(64) Scalar inverse_deviation[stride] = {};  // 1 / sqrt(variance + epsilon) of the last batch
  int batch_samples = 0;

  void load(const Scalar* parameters) noexcept {
    for (int i = 0; i < Size; ++i) {
      stored[i] = parameters[i];
      stored[stride + i] = parameters[Size + i];
      running_mean[i] = parameters[2 * Size + i];
      running_variance[i] = parameters[3 * Size + i];
    }
  }
  void store(Scalar* parameters) const noexcept {
    for (int i = 0; i < Size; ++i) {
      parameters[i] = stored[i];
      parameters[Size + i] = stored[stride + i];
      parameters[2 * Size + i] = running_mean[i];
      parameters[3 * Size + i] = running_variance[i];
    }
  }
  /// That of the running statistics is 0: no loss depends on them.
  void store_gradient(Scalar* parameters) const noexcept {
    for (int i = 0; i < Size; ++i) {
      parameters[i] = gradient[i];
      parameters[Size + i] = gradient[stride + i];
      parameters[2 * Size + i] = parameters[3 * Size + i] = Scalar(0);
    }
  }
  void forward(const Scalar* x, Scalar* y, int samples) noexcept {
    batch_samples = samples;
    if (samples > 1) {
      take_statistics(x, samples);
    } else {
      copy_running_statistics();
    }
    normalise(x, y, samples);
  }
  /// By running statistics.
  void predict(const Scalar* x, Scalar* y, int samples) noexcept {
    batch_samples = 1;
    copy_running_statistics();
    normalise(x, y, samples);
  }

  void follow_statistics() noexcept {
    if (batch_samples < 2) return;
    const Pack old_share = Pack::broadcast(Scalar(1.0 - batch_norm_momentum));
    const Pack share = Pack::broadcast(Scalar(batch_norm_momentum));
    const Pack unbiased = Pack::broadcast(Scalar(batch_norm_momentum * batch_samples / (batch_samples - 1.0)));
    for (int i = 0; i < stride; i += Pack::width) {
      Pack::multiply_add(old_share, Pack::load(running_mean + i), share * Pack::load(mean + i)).store(running_mean + i);
      Pack::multiply_add(old_share, Pack::load(running_variance + i), unbiased * Pack::load(variance + i))
          .store(running_variance + i);
    }
  }

  /// `delta` holds dy; dx goes to `previous` (which may be null for the first layer).
  void backward(const Scalar* x, const Scalar*, const Scalar* delta, Scalar* previous, int samples) noexcept {
    unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      constexpr int offset = decltype(v)::value * Pack::width;
      const Pack center = Pack::load(mean + offset), inverse = Pack::load(inverse_deviation + offset);
      Pack shift[chains], scale[chains];
      for (int c = 0; c < chains; ++c) shift[c] = scale[c] = Pack::broadcast(Scalar(0));
      const auto add = [&](int i, int c) PINNQUAD_INLINE_LAMBDA {
        const Pack dy = Pack::load(delta + i * stride + offset);
        shift[c] = shift[c] + dy;
        scale[c] = Pack::multiply_add(dy, Pack::load(x + i * stride + offset) - center, scale[c]);
      };
      over_samples(samples, add);
      const Pack beta_gradient = total(shift);
      const Pack gamma_gradient = total(scale) * inverse;
      gamma_gradient.store(gradient + offset);
      beta_gradient.store(gradient + stride + offset);
      if (previous == nullptr) return;

      // dx = factor (dy - a - b (x - mean)); a batch of one was normalised by constants: a = b = 0
      const Pack factor = Pack::load(stored + offset) * inverse;
      const Pack share = Pack::broadcast(samples > 1 ? Scalar(1) / Scalar(samples) : Scalar(0));
      const Pack a = share * beta_gradient;
      const Pack b = share * gamma_gradient * inverse;
      for (int i = 0; i < samples; ++i) {
        const Pack dy = Pack::load(delta + i * stride + offset);
        const Pack distance = Pack::load(x + i * stride + offset) - center;
        (factor * ((dy - a) - b * distance)).store(previous + i * stride + offset);
      }
    });
  }

 private:
  static constexpr int vectors = stride / Pack::width;
  static constexpr int chains = 4;  ///< sums that run side by side and hide each other's latency

  /// body(sample, chain) for all samples.
  template <class Body>
  static PINNQUAD_ALWAYS_INLINE void over_samples(int samples, const Body& body) {
    int i = 0;
    for (; i + chains <= samples; i += chains) {
      unroll<chains>([&](auto c) PINNQUAD_INLINE_LAMBDA { body(i + c, c); });
    }
    for (; i < samples; ++i) body(i, 0);
  }
  static PINNQUAD_ALWAYS_INLINE Pack total(const Pack (&sum)[chains]) { return (sum[0] + sum[1]) + (sum[2] + sum[3]); }

  void take_statistics(const Scalar* x, int samples) noexcept {
    const Pack share = Pack::broadcast(Scalar(1) / Scalar(samples));
    unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      constexpr int offset = decltype(v)::value * Pack::width;
      Pack sum[chains];
      for (Pack& s : sum) s = Pack::broadcast(Scalar(0));
      const auto add = [&](int i, int c)
                           PINNQUAD_INLINE_LAMBDA { sum[c] = sum[c] + Pack::load(x + i * stride + offset); };
      over_samples(samples, add);
      const Pack center = share * total(sum);
      for (Pack& s : sum) s = Pack::broadcast(Scalar(0));
      const auto add_square = [&](int i, int c) PINNQUAD_INLINE_LAMBDA {
        const Pack distance = Pack::load(x + i * stride + offset) - center;
        sum[c] = Pack::multiply_add(distance, distance, sum[c]);
      };
      over_samples(samples, add_square);
      center.store(mean + offset);
      (share * total(sum)).store(variance + offset);
    });
    invert_deviation();
  }
  void copy_running_statistics() noexcept {
    for (int i = 0; i < stride; ++i) {
      mean[i] = running_mean[i];
      variance[i] = running_variance[i];
    }
    invert_deviation();
  }
  void invert_deviation() noexcept {
    const Pack one = Pack::broadcast(Scalar(1)), epsilon = Pack::broadcast(Scalar(batch_norm_epsilon));
    for (int i = 0; i < stride; i += Pack::width) {
      (one / Pack::square_root(Pack::load(variance + i) + epsilon)).store(inverse_deviation + i);
    }
  }
  void normalise(const Scalar* x, Scalar* y, int samples) const noexcept {
    unroll<vectors>([&](auto v) PINNQUAD_INLINE_LAMBDA {
      constexpr int offset = decltype(v)::value * Pack::width;
      const Pack center = Pack::load(mean + offset);
      const Pack factor = Pack::load(stored + offset) * Pack::load(inverse_deviation + offset);
      const Pack shift = Pack::load(stored + stride + offset);
      for (int i = 0; i < samples; ++i) {
        const Pack distance = Pack::load(x + i * stride + offset) - center;
        Pack::multiply_add(distance, factor, shift).store(y + i * stride + offset);
      }
    });
  }
};

}  // namespace detail

}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// A chain of affine maps and activations as layers of the library: dense ones and its activations alone. Batch norm,
// scales and shifts, and the affine maps that make another activation of one of the library's, are folded into the
// dense layers, in double.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "convert/foreign_network.hpp"

namespace programs {

/// A layer: dense where it has outputs, else an activation.
struct FoldedLayer {
  ForeignDense dense;
  ForeignActivation activation = ForeignActivation::relu;
};

/// The layer of the library by which an activation is worked out: its own, or the one that Folder makes it of.
inline std::string layer_text(ForeignActivation activation) {
  constexpr std::array<const char*, foreign_activations.size()> names = {
      "Relu", "Tanh", "Tanh", "Gelu", "Silu", "Softplus", "Sine", "Clip", "Elu", "LeakyRelu", "Clip", "Clip"};
  return "pinnquad::" + std::string(names[static_cast<std::size_t>(activation)]);
}

/// Takes the steps of a chain one after the other.
class Folder {
 public:
  explicit Folder(std::size_t inputs) : width_(inputs) { clear(); }

  void add(const ForeignStep& step) {
    if (step.dense.outputs() > 0) {
      add_dense(step.dense);
    } else if (!step.scale.empty()) {
      add_affine(step.scale, step.shift);
    } else if (step.activation == ForeignActivation::sigmoid) {  // (1 + tanh(v / 2)) / 2
      add_uniform(0.5, 0);
      add_activation(ForeignActivation::tanh);
      add_uniform(0.5, 0.5);
    } else if (step.activation == ForeignActivation::clip) {
      add_clip(step.lower, step.upper);
    } else if (step.has_own_alpha()) {
      add_halves(step);
    } else {
      add_activation(step.activation);
    }
  }
  /// The layers, after the last step.
  std::vector<FoldedLayer> layers() && {
    flush();
    if (layers_.empty()) add_diagonal();
    return std::move(layers_);
  }

 private:
  /// Not yet in a layer: y = scale x + shift, behind a dense map where there is one.
  void clear() {
    dense_ = {};
    scale_.assign(width_, 1);
    shift_.assign(width_, 0);
    is_identity_ = true;
  }
  void add_affine(const Numbers& scale, const Numbers& shift) {
    for (std::size_t i = 0; i < width_; ++i) {
      scale_[i] *= scale[i];
      shift_[i] = shift_[i] * scale[i] + shift[i];
    }
    is_identity_ = false;
  }
  void add_uniform(double scale, double shift) {
    if (!(std::abs(scale - 1) > 0) && !(std::abs(shift) > 0)) return;
    add_affine(Numbers(width_, scale), Numbers(width_, shift));
  }
  /// By the library's Clip where there are two bounds, by ReLU where there is one.
  void add_clip(double lower, double upper) {
    if (std::isinf(lower) && std::isinf(upper)) return;
    if (std::isinf(lower) || std::isinf(upper)) {
      const double bound = std::isinf(lower) ? upper : lower, sign = std::isinf(lower) ? -1 : 1;
      add_uniform(sign, -sign * bound);
      add_activation(ForeignActivation::relu);
      add_uniform(sign, bound);
      return;
    }
    const double middle = (lower + upper) / 2, scale = (upper - lower) / 2 / clip_bound;
    add_uniform(1 / scale, -middle / scale);
    add_activation(ForeignActivation::clip);
    add_uniform(scale, middle);
  }
  /// relu(v) and relu(-v) beside each other: leaky_relu(v) = relu(v) - alpha relu(-v), and the library's ELU of
  /// relu(v) and -relu(-v) is relu(v) and exp(min(v, 0)) - 1.
  void add_halves(const ForeignStep& step) {
    const std::size_t count = width_;
    const bool is_elu = step.activation == ForeignActivation::elu;
    ForeignDense parted{count, Numbers(2 * count * count, 0), Numbers(2 * count, 0)};
    ForeignDense joined{2 * count, Numbers(2 * count * count, 0), Numbers(count, 0)};
    Numbers signs(2 * count, 1);
    for (std::size_t i = 0; i < count; ++i) {
      parted.weights[i * count + i] = 1;
      parted.weights[(count + i) * count + i] = -1;
      signs[count + i] = -1;
      joined.weights[i * 2 * count + i] = 1;
      joined.weights[i * 2 * count + count + i] = is_elu ? step.alpha : -step.alpha;
    }
    add_dense(parted);
    add_activation(ForeignActivation::relu);
    if (is_elu) {
      add_affine(signs, Numbers(2 * count, 0));
      add_activation(ForeignActivation::elu);
    }
    add_dense(joined);
  }
  void add_dense(const ForeignDense& next) {
    // two affine maps are one where that has no more weights
    const bool joins = next.outputs() * dense_.inputs <= width_ * (dense_.inputs + next.outputs());
    if (dense_.outputs() > 0 && !joins) flush();
    ForeignDense folded;
    folded.inputs = dense_.outputs() > 0 ? dense_.inputs : width_;
    folded.weights.assign(next.outputs() * folded.inputs, 0);
    folded.bias = next.bias;
    for (std::size_t row = 0; row < next.outputs(); ++row) {
      double* const sums = folded.weights.data() + row * folded.inputs;
      for (std::size_t k = 0; k < width_; ++k) {
        const double weight = next.weights[row * width_ + k], scaled = weight * scale_[k];
        folded.bias[row] += weight * shift_[k];
        if (dense_.outputs() == 0) {
          sums[k] = scaled;
          continue;
        }
        folded.bias[row] += scaled * dense_.bias[k];
        for (std::size_t column = 0; column < folded.inputs; ++column) {
          sums[column] += scaled * dense_.weights[k * dense_.inputs + column];
        }
      }
    }
    width_ = folded.outputs();
    clear();
    dense_ = std::move(folded);
  }
  void add_activation(ForeignActivation activation) {
    flush();
    FoldedLayer layer;
    layer.activation = activation;
    layers_.push_back(std::move(layer));
  }
  void flush() {
    if (dense_.outputs() > 0) {
      for (std::size_t row = 0; row < dense_.outputs(); ++row) {
        for (std::size_t column = 0; column < dense_.inputs; ++column) {
          dense_.weights[row * dense_.inputs + column] *= scale_[row];
        }
        dense_.bias[row] = dense_.bias[row] * scale_[row] + shift_[row];
      }
      FoldedLayer layer;
      layer.dense = std::move(dense_);
      layers_.push_back(std::move(layer));
      clear();
    } else if (!is_identity_) {
      add_diagonal();
    }
  }
  /// An affine map between two activations, or of a network that is nothing else.
  void add_diagonal() {
    FoldedLayer layer;
    layer.dense.inputs = width_;
    layer.dense.weights.assign(width_ * width_, 0);
    for (std::size_t i = 0; i < width_; ++i) layer.dense.weights[i * width_ + i] = scale_[i];
    layer.dense.bias = shift_;
    layers_.push_back(std::move(layer));
    clear();
  }

  std::size_t width_;
  ForeignDense dense_;
  Numbers scale_, shift_;
  bool is_identity_ = true;
  std::vector<FoldedLayer> layers_;
};

}  // namespace programs

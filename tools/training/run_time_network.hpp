// SPDX-License-Identifier: MIT
// A network that is known at run time alone: layers from the text of a description (inference/description.hpp), the
// sums in the order of the portable kernel; and its derivatives. For judging on the ground; what flies is compiled.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pinnquad/nn/clip.hpp"
#include "pinnquad/nn/gelu.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/relu.hpp"
#include "pinnquad/nn/silu.hpp"
#include "pinnquad/nn/sine.hpp"
#include "pinnquad/nn/softplus.hpp"
#include "pinnquad/nn/tanh.hpp"

namespace programs {

/// An element-wise layer by its description.
template <class Scalar>
struct Activation {
  const char* description;
  Scalar (*activate)(Scalar);
  Scalar (*slope)(Scalar v);  ///< d activate / d v
};

namespace detail {

template <class Spec, class Scalar>
Activation<Scalar> activation_of() {
  using Layer = typename Spec::template Bind<Scalar, 1>;
  return {Spec::description, [](Scalar v) { return Layer::activate(v); },
          [](Scalar v) {
            return pinnquad::detail::scaled_by_slope<Layer>(pinnquad::slopes_from_input<Layer> ? v : Layer::activate(v),
                                                            Scalar(1));
          }};
}

}  // namespace detail

template <class Scalar>
const std::vector<Activation<Scalar>>& activations() {
  using namespace pinnquad;
  static const std::vector<Activation<Scalar>> all = {
      detail::activation_of<Relu, Scalar>(),     detail::activation_of<Tanh, Scalar>(),
      detail::activation_of<Gelu, Scalar>(),     detail::activation_of<Silu, Scalar>(),
      detail::activation_of<Softplus, Scalar>(), detail::activation_of<Sine, Scalar>(),
      detail::activation_of<Clip, Scalar>()};
  return all;
}

/// A layer of a description: dense with `size` outputs, or the activation of that index.
struct LayerSpec {
  int size = 0;  ///< 0: an activation
  bool has_bias = true;
  std::size_t activation = 0;
};

/// "pinnquad::Network<float, pinnquad::Inputs<16>, pinnquad::Dense<25>, pinnquad::Relu, ...>" taken apart.
struct NetworkSpec {
  std::string scalar;
  int inputs = 0;
  std::vector<LayerSpec> layers;

  int outputs() const {
    int size = inputs;
    for (const LayerSpec& layer : layers) size = layer.size > 0 ? layer.size : size;
    return size;
  }
  long long parameter_count() const {
    long long count = 0, size = inputs;
    for (const LayerSpec& layer : layers) {
      if (layer.size == 0) continue;
      count += size * layer.size + (layer.has_bias ? layer.size : 0);
      size = layer.size;
    }
    return count;
  }
};

namespace detail {

/// The number in "name<number>"; 0 where the text is something else.
inline int sized(std::string_view text, std::string_view name) {
  if (text.size() < name.size() + 3 || text.substr(0, name.size()) != name || text[name.size()] != '<' ||
      text.back() != '>') {
    return 0;
  }
  const std::string_view digits = text.substr(name.size() + 1, text.size() - name.size() - 2);
  int size = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), size);
  constexpr int widest = 1 << 16;
  return read.ec == std::errc() && read.ptr == digits.data() + digits.size() && size > 0 && size <= widest ? size : 0;
}

}  // namespace detail

/// A description of dense and element-wise layers; nothing for any other text. Spaces don't count.
inline std::optional<NetworkSpec> parse_network(const std::string& description) {
  std::string text;
  for (const char c : description) {
    if (c != ' ') text += c;
  }
  const std::string_view head = "pinnquad::Network<";
  if (text.size() < head.size() || text.compare(0, head.size(), head) != 0 || text.back() != '>') return {};
  const std::string_view inside = std::string_view(text).substr(head.size(), text.size() - head.size() - 1);
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= inside.size();) {
    const std::size_t end = std::min(inside.find(',', begin), inside.size());
    parts.push_back(inside.substr(begin, end - begin));
    begin = end + 1;
  }
  if (parts.size() < 3 || (parts[0] != "float" && parts[0] != "double")) return {};
  NetworkSpec spec;
  spec.scalar = parts[0];
  spec.inputs = detail::sized(parts[1], "pinnquad::Inputs");
  if (spec.inputs == 0) return {};
  for (std::size_t i = 2; i < parts.size(); ++i) {
    LayerSpec layer;
    layer.size = detail::sized(parts[i], "pinnquad::Dense");
    if (layer.size == 0) {
      layer.size = detail::sized(parts[i], "pinnquad::DenseWithoutBias");
      layer.has_bias = layer.size == 0;
    }
    if (layer.size == 0) {
      const auto& known = activations<double>();
      while (layer.activation < known.size() && parts[i] != known[layer.activation].description) ++layer.activation;
      if (layer.activation == known.size()) return {};
    }
    spec.layers.push_back(layer);
  }
  return spec;
}

/// y = network(x). Parameters lie as in a block: per dense layer weights row by row, then biases.
template <class Scalar>
class RunTimeNetwork {
 public:
  /// As many parameters as the spec counts.
  RunTimeNetwork(NetworkSpec spec, const std::vector<double>& parameters) : spec_(std::move(spec)) {
    for (const double parameter : parameters) parameters_.push_back(static_cast<Scalar>(parameter));
  }

  std::vector<Scalar> forward(const std::vector<Scalar>& x) const {
    std::vector<std::array<Scalar, 1>> values(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) values[i][0] = x[i];
    values = pushed_forward(std::move(values));
    std::vector<Scalar> y(values.size());
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = values[i][0];
    return y;
  }

  /// The same with derivatives, exact, of the value that stands first in each entry: those of x in, those of y out. At
  /// the kink of a ReLU it is the derivative from below, 0, as in nn/jacobian.hpp.
  template <std::size_t Count>
  std::vector<std::array<Scalar, Count>> pushed_forward(std::vector<std::array<Scalar, Count>> x) const {
    const Scalar* own = parameters_.data();
    for (const LayerSpec& layer : spec_.layers) {
      if (layer.size == 0) {
        const Activation<Scalar>& activation = activations<Scalar>()[layer.activation];
        for (std::array<Scalar, Count>& entry : x) {
          if constexpr (Count > 1) {
            const Scalar slope = activation.slope(entry[0]);
            for (std::size_t k = 1; k < Count; ++k) entry[k] *= slope;
          }
          entry[0] = activation.activate(entry[0]);
        }
        continue;
      }
      const auto rows = static_cast<std::size_t>(layer.size);
      const Scalar* bias = own + rows * x.size();
      std::vector<std::array<Scalar, Count>> y(rows);
      for (std::size_t row = 0; row < rows; ++row) {
        std::array<Scalar, Count> sum{};
        if (layer.has_bias) sum[0] = bias[row];
        for (std::size_t column = 0; column < x.size(); ++column) {
          const Scalar weight = own[row * x.size() + column];
          for (std::size_t k = 0; k < Count; ++k) sum[k] = pinnquad::multiply_add(weight, x[column][k], sum[k]);
        }
        y[row] = sum;
      }
      own = bias + (layer.has_bias ? rows : 0);
      x = std::move(y);
    }
    return x;
  }

 private:
  NetworkSpec spec_;
  std::vector<Scalar> parameters_;
};

}  // namespace programs

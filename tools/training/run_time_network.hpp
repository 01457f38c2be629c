// SPDX-License-Identifier: MIT
// A network that is known at run time alone: layers from the text of a description (model/description.hpp), the
// sums in the order of the portable kernel; and its derivatives. For judging on the ground; what flies is compiled.
// The parts of a monotone model (model/axis_aligned.hpp) are networks too: with weights that are 0 where a part is
// not shown a feature, and bounds of the outputs.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "pinnquad/nn/activations.hpp"
#include "pinnquad/nn/kernel/portable.hpp"

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

template <class Scalar, class... Specs>
std::vector<Activation<Scalar>> activations_of(const std::tuple<Specs...>&) {
  return {activation_of<Specs, Scalar>()...};
}

}  // namespace detail

/// Those of the library.
template <class Scalar>
const std::vector<Activation<Scalar>>& activations() {
  static const std::vector<Activation<Scalar>> all = detail::activations_of<Scalar>(pinnquad::Activations{});
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
  std::vector<int> threes;    ///< where features in threes begin that it is not shown, or one per axis
  bool axis_aligned = false;  ///< of each three an output sees its own: pinnquad::AxisAligned
  bool bounded = false;       ///< lower and upper bounds of the outputs are its first parameters: pinnquad::Saturated
  bool path_bounded = false;  ///< it says that its path bound is to be asked: pinnquad::PathBounded

  /// Features that all of it is shown.
  int shown() const { return inputs - 3 * static_cast<int>(threes.size()); }

  int outputs() const {
    int size = inputs;
    for (const LayerSpec& layer : layers) size = layer.size > 0 ? layer.size : size;
    return size;
  }
  long long parameter_count() const {
    long long count = bounded ? 2LL * outputs() : 0, size = shown();
    if (axis_aligned) count += 3 * static_cast<long long>(threes.size());
    for (const LayerSpec& layer : layers) {
      if (layer.size == 0) continue;
      count += size * layer.size + (layer.has_bias ? layer.size : 0);
      size = layer.size;
    }
    return count;
  }
};

namespace detail {

inline constexpr int widest_layer = 1 << 16;

/// A number from `least`; -1 where the text is something else.
inline int whole_number(std::string_view digits, int least) {
  int number = 0;
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  const bool whole = read.ec == std::errc() && read.ptr == digits.data() + digits.size();
  return whole && number >= least && number <= widest_layer ? number : -1;
}

/// The number in "name<number>"; 0 where the text is something else.
inline int sized(std::string_view text, std::string_view name) {
  if (text.size() < name.size() + 3 || text.substr(0, name.size()) != name || text[name.size()] != '<' ||
      text.back() != '>') {
    return 0;
  }
  const std::string_view digits = text.substr(name.size() + 1, text.size() - name.size() - 2);
  return std::max(0, whole_number(digits, 1));
}

/// The text between "name<" and ">"; nothing where the text is something else.
inline std::optional<std::string_view> inside_of(std::string_view text, std::string_view name) {
  if (text.size() < name.size() + 2 || text.substr(0, name.size()) != name || text[name.size()] != '<' ||
      text.back() != '>') {
    return {};
  }
  return text.substr(name.size() + 1, text.size() - name.size() - 2);
}

/// "number,number,..."; -1 where one is something else.
inline std::vector<int> whole_numbers(std::string_view numbers) {
  std::vector<int> all;
  for (std::size_t begin = 0; begin <= numbers.size();) {
    const std::size_t end = std::min(numbers.find(',', begin), numbers.size());
    all.push_back(whole_number(numbers.substr(begin, end - begin), 0));
    begin = end + 1;
  }
  return all;
}

/// "features,place,place,...": the features and the places of threes into the spec. False where it is something else,
/// or the threes overlap.
inline bool take_threes(std::string_view numbers, NetworkSpec& spec) {
  const std::vector<int> all = whole_numbers(numbers);
  spec.inputs = all.front();
  spec.threes.assign(all.begin() + 1, all.end());
  int free_from = 0;
  for (const int place : spec.threes) {
    if (place < free_from) return false;
    free_from = place + 3;
  }
  return !spec.threes.empty() && free_from <= spec.inputs && spec.shown() > 0;
}

/// "Network<...>,number,..." : what it holds and the numbers; nothing where the text is something else.
inline std::optional<std::pair<std::string_view, std::string_view>> network_and_numbers(std::string_view text) {
  const std::size_t network = text.rfind('>');
  if (network == std::string_view::npos || network + 1 >= text.size() || text[network + 1] != ',') return {};
  return std::pair(text.substr(0, network + 1), text.substr(network + 2));
}

/// Dense layers, at most 3, and activations between them whose slope is from 0 to 1 (model/path_bound.hpp).
inline bool has_path_bound(const NetworkSpec& spec) {
  if (spec.layers.size() > 5 || spec.layers.size() % 2 == 0 || spec.scalar != "float") return false;
  for (std::size_t i = 0; i < spec.layers.size(); ++i) {
    const LayerSpec& layer = spec.layers[i];
    if (i % 2 == 0) {
      if (layer.size == 0 || !layer.has_bias) return false;
      continue;
    }
    if (layer.size != 0) return false;
    const std::string_view activation = activations<double>()[layer.activation].description;
    if (activation != pinnquad::Relu::description && activation != pinnquad::Tanh::description &&
        activation != pinnquad::Softplus::description) {
      return false;
    }
  }
  return true;
}

}  // namespace detail

/// A description of dense and element-wise layers, or of a part of a monotone model; nothing for any other text. Spaces
/// don't count.
inline std::optional<NetworkSpec> parse_network(const std::string& description) {
  std::string text;
  for (const char c : description) {
    if (c != ' ') text += c;
  }
  if (const auto inside = detail::inside_of(text, "pinnquad::Bounded")) {
    std::optional<NetworkSpec> spec = parse_network(std::string(*inside));
    if (!spec || spec->bounded || spec->axis_aligned) return {};
    spec->bounded = true;
    return spec;
  }
  if (const auto inside = detail::inside_of(text, "pinnquad::PathBounded")) {
    std::optional<NetworkSpec> spec = parse_network(std::string(*inside));
    if (!spec || spec->bounded || !spec->threes.empty() || spec->path_bounded || !detail::has_path_bound(*spec)) {
      return {};
    }
    spec->path_bounded = true;
    return spec;
  }
  if (const auto inside = detail::inside_of(text, "pinnquad::Withheld")) {
    const auto parts = detail::network_and_numbers(*inside);
    std::optional<NetworkSpec> spec = parts ? parse_network(std::string(parts->first)) : std::nullopt;
    if (!spec || spec->bounded || spec->path_bounded || !spec->threes.empty()) return {};
    const int shown = spec->inputs;
    if (!detail::take_threes(parts->second, *spec) || spec->shown() != shown) return {};
    return spec;
  }
  if (const auto inside = detail::inside_of(text, "pinnquad::AxisAligned")) {
    const std::size_t comma = inside->find(',');
    if (comma == std::string_view::npos) return {};
    NetworkSpec spec;
    spec.scalar = inside->substr(0, comma);
    spec.axis_aligned = true;
    LayerSpec layer;
    layer.size = 4;
    spec.layers = {layer};
    const bool known = spec.scalar == "float" || spec.scalar == "double";
    if (!known || !detail::take_threes(inside->substr(comma + 1), spec)) return {};
    return spec;
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

namespace detail {

/// The parameters of a network of all features that says the same: per dense layer weights row by row, then biases.
/// Without bounds, which the caller has taken off.
inline std::vector<double> plain_parameters(const NetworkSpec& spec, const double* own, const double* end) {
  if (spec.threes.empty()) return {own, end};
  std::vector<bool> hidden(static_cast<std::size_t>(spec.inputs), false);
  for (const int place : spec.threes) {
    for (int i = 0; i < 3; ++i) hidden[static_cast<std::size_t>(place + i)] = true;
  }
  const double* const slopes = own;
  if (spec.axis_aligned) own += 3 * spec.threes.size();
  int rows = 0;  // of the first dense layer, which is shown the features
  for (const LayerSpec& layer : spec.layers) {
    if (rows == 0) rows = layer.size;
  }
  std::vector<double> plain;
  for (int row = 0; row < rows; ++row) {
    for (const bool is_hidden : hidden) plain.push_back(is_hidden ? 0.0 : *own++);
    if (!spec.axis_aligned || row == 0) continue;
    const std::size_t first = plain.size() - hidden.size();
    for (std::size_t tap = 0; tap < spec.threes.size(); ++tap) {
      plain[first + static_cast<std::size_t>(spec.threes[tap] + row - 1)] =
          slopes[3 * tap + static_cast<std::size_t>(row) - 1];
    }
  }
  plain.insert(plain.end(), own, end);
  return plain;
}

}  // namespace detail

/// y = network(x). Parameters lie as in a block: per dense layer weights row by row, then biases.
template <class Scalar>
class RunTimeNetwork {
 public:
  /// As many parameters as the spec counts.
  RunTimeNetwork(NetworkSpec spec, const std::vector<double>& parameters) : spec_(std::move(spec)) {
    const double* own = parameters.data();
    if (spec_.bounded) {
      const auto outputs = static_cast<std::size_t>(spec_.outputs());
      for (std::size_t k = 0; k < outputs; ++k) {
        bounds_.push_back({static_cast<Scalar>(own[k]), static_cast<Scalar>(own[outputs + k])});
      }
      own += 2 * outputs;
    }
    for (const double parameter : detail::plain_parameters(spec_, own, parameters.data() + parameters.size())) {
      parameters_.push_back(static_cast<Scalar>(parameter));
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(spec_.inputs); ++i) order_.push_back(i);
    std::stable_partition(order_.begin(), order_.end(), [this](std::size_t column) {
      return std::none_of(spec_.threes.begin(), spec_.threes.end(), [column](int place) {
        const auto first = static_cast<std::size_t>(place);
        return column >= first && column < first + 3;
      });
    });
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
    return held(through_layers(std::move(x)));
  }

 private:
  template <std::size_t Count>
  std::vector<std::array<Scalar, Count>> through_layers(std::vector<std::array<Scalar, Count>> x) const {
    const Scalar* own = parameters_.data();
    std::vector<std::size_t> order = order_;
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
        for (const std::size_t column : order) {
          const Scalar weight = own[row * x.size() + column];
          for (std::size_t k = 0; k < Count; ++k) sum[k] = pinnquad::multiply_add(weight, x[column][k], sum[k]);
        }
        y[row] = sum;
      }
      own = bias + (layer.has_bias ? rows : 0);
      x = std::move(y);
      order.resize(rows);
      std::iota(order.begin(), order.end(), std::size_t{0});
    }
    return x;
  }

  /// Within the bounds, where it has some.
  template <std::size_t Count>
  std::vector<std::array<Scalar, Count>> held(std::vector<std::array<Scalar, Count>> x) const {
    for (std::size_t k = 0; k < bounds_.size(); ++k) {
      const auto [lower, upper] = bounds_[k];
      if (x[k][0] > lower && x[k][0] < upper) continue;
      const Scalar bound = x[k][0] < lower ? lower : (x[k][0] > upper ? upper : x[k][0]);
      x[k] = {};
      x[k][0] = bound;
    }
    return x;
  }

  NetworkSpec spec_;
  std::vector<std::size_t> order_;             ///< of the features in a sum: as AxisAligned adds them, its threes last
  std::vector<std::array<Scalar, 2>> bounds_;  ///< of each output, where it has some
  std::vector<Scalar> parameters_;
};

}  // namespace programs

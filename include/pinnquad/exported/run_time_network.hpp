// SPDX-License-Identifier: MIT
// A predictor that is known at run time alone, from its description (model/description.hpp), with sums in the order of
// the portable kernel: the same bits as the compiled one. No heap: the caller owns the workspace.
//   predictor := part | Sum<predictor, part>
//   part      := AxisAligned<scalar, features, place...> | Bounded<shown> | shown
//   shown     := Withheld<network, features, place...> | network
//   network   := Network<scalar, Inputs<n>, layer...>, layer := Dense<n> | DenseWithoutBias<n> | an activation
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pinnquad/exported/run_time_activation.hpp"
#include "pinnquad/nn/kernel/lane_row.hpp"
#include "pinnquad/nn/kernel/portable.hpp"

namespace pinnquad {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// A layer of a description: dense where it has outputs, else the activation of that place in Activations.
struct RunTimeLayer {
  int outputs = 0;
  bool has_bias = true;
  int activation = -1;
};

/// A part of a predictor. Its parameters lie as the compiled part's: bounds, slopes, weights row by row, biases.
struct RunTimePart {
  static constexpr int most_layers = 32;
  static constexpr int most_threes = 64;

  RunTimeLayer layers[most_layers];
  int layer_count = 0;
  int threes[most_threes] = {};  ///< where features in threes begin: not shown to it, or shown one per axis
  int three_count = 0;
  int inputs = 0;
  int outputs = 0;
  int parameter_count = 0;
  int widest = 0;             ///< most numbers between two layers
  bool axis_aligned = false;  ///< pinnquad::AxisAligned
  bool bounded = false;       ///< pinnquad::Saturated: its first parameters are lower and upper bounds of the outputs

  /// Features that all of it is shown.
  constexpr int shown() const noexcept { return inputs - 3 * three_count; }
  /// Calls visit(feature) for each of them, ascending.
  template <class Visit>
  constexpr void each_shown(const Visit& visit) const noexcept {
    int feature = 0;
    for (int i = 0; i < three_count; ++i, feature += 3) {
      while (feature < threes[i]) visit(feature++);
    }
    while (feature < inputs) visit(feature++);
  }
};

}  // namespace PINNQUAD_INSTRUCTION_SET

namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// Reads a description from left to right; spaces don't count. std::string_view::substr() may throw: it does not fly.
class DescriptionReader {
 public:
  constexpr explicit DescriptionReader(std::string_view text) noexcept : rest_(text) {}

  constexpr bool at_end() noexcept {
    skip_spaces();
    return rest_.empty();
  }
  /// Takes the text where it is next.
  constexpr bool take(std::string_view text) noexcept {
    skip_spaces();
    if (rest_.size() < text.size() || std::string_view(rest_.data(), text.size()) != text) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  /// The same of a name, where it ends there: Gelu is no GeluTanh.
  constexpr bool take_name(std::string_view name) noexcept {
    const DescriptionReader before = *this;
    if (!take(name)) return false;
    const char next = rest_.empty() ? ' ' : rest_.front();
    if ((next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z') || (next >= '0' && next <= '9')) *this = before;
    return rest_.size() != before.rest_.size();
  }
  /// A number from 0 to `most`, or -1.
  constexpr int number(int most) noexcept {
    skip_spaces();
    int value = -1;
    while (!rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9') {
      value = 10 * (value < 0 ? 0 : value) + (rest_.front() - '0');
      if (value > most) return -1;
      rest_.remove_prefix(1);
    }
    return value;
  }

 private:
  constexpr void skip_spaces() noexcept {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

/// The numbers of an entry of RunTimeNetwork::forward().
enum class RunTimeEntry {
  value_and_derivatives,  ///< a value, and its derivatives by whatever the caller moves
  lanes                   ///< a value each of so many motions
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A predictor, or the sum of a few, added from left to right.
class RunTimeNetwork {
 public:
  static constexpr int most_parts = 4;
  static constexpr int widest_layer = 1 << 14;
  static constexpr int most_parameters = 1 << 28;

  /// False, and nothing to be used, for a description of anything else than what the head of this file says.
  bool parse(std::string_view description) noexcept {
    *this = {};
    detail::DescriptionReader reader(description);
    int sums = 0;
    while (reader.take("pinnquad::Sum<")) {
      if (++sums == most_parts) return false;
    }
    if (!take_part(reader)) return false;
    for (; sums > 0; --sums) {
      if (!reader.take(",") || !take_part(reader) || !reader.take(">")) return false;
    }
    return reader.at_end();
  }

  int part_count() const noexcept { return part_count_; }
  const RunTimePart& part(int index) const noexcept { return parts_[index]; }
  bool is_double() const noexcept { return is_double_; }
  int inputs() const noexcept { return parts_[0].inputs; }
  int outputs() const noexcept { return parts_[0].outputs; }
  int parameter_count() const noexcept { return parameter_count_; }

  /// Entries of the workspace of forward().
  std::size_t workspace() const noexcept {
    int widest = outputs();
    for (int i = 0; i < part_count_; ++i) widest = parts_[i].widest > widest ? parts_[i].widest : widest;
    return std::size_t(3 * widest);
  }

  /// An entry is a value and its derivatives by whatever the caller moves: 1 for values alone.
  template <class Number, int Count>
  using Values = std::array<Number, std::size_t(Count)>;

  /// y = predictor(x), both standardised; Number is that of the parameters for the bits of the compiled predictor.
  /// Exact derivatives go with the values. At the kink of a ReLU it is the derivative from below, 0, as in
  /// nn/jacobian.hpp; of an output on its bound 0.
  template <class Number, int Count, detail::RunTimeEntry Kind = detail::RunTimeEntry::value_and_derivatives,
            class Scalar>
  void forward(const Scalar* parameters, const Values<Number, Count>* x, Values<Number, Count>* y,
               Values<Number, Count>* work) const noexcept {
    const std::size_t third = workspace() / 3;
    Values<Number, Count>* more = work + 2 * third;
    for (int i = 0; i < part_count_; ++i) {
      run<Number, Count, Kind>(parts_[i], parameters, x, i == 0 ? y : more, work, work + third);
      parameters += parts_[i].parameter_count;
      for (int k = 0; i > 0 && k < outputs(); ++k) {
        for (int c = 0; c < Count; ++c) y[k][std::size_t(c)] += more[k][std::size_t(c)];
      }
    }
  }

 private:
  bool take_scalar(detail::DescriptionReader& reader) noexcept {
    const bool is_double = reader.take("double");
    if (!is_double && !reader.take("float")) return false;
    if (part_count_ > 0 && is_double != is_double_) return false;
    is_double_ = is_double;
    return true;
  }

  /// "features, place, ...": threes that do not overlap, and a feature beside them.
  static bool take_threes(detail::DescriptionReader& reader, RunTimePart& part) noexcept {
    part.inputs = reader.number(widest_layer);
    int free_from = 0;
    while (reader.take(",")) {
      const int place = reader.number(widest_layer);
      if (place < free_from || part.three_count == RunTimePart::most_threes) return false;
      part.threes[part.three_count++] = place;
      free_from = place + 3;
    }
    return part.three_count > 0 && free_from <= part.inputs && part.shown() > 0;
  }

  bool take_network(detail::DescriptionReader& reader, RunTimePart& part) noexcept {
    if (!reader.take("pinnquad::Network<") || !take_scalar(reader) || !reader.take(",")) return false;
    if (!reader.take("pinnquad::Inputs<")) return false;
    int width = part.inputs = part.widest = reader.number(widest_layer);
    if (width < 1 || !reader.take(">")) return false;
    long long parameters = 0;
    while (reader.take(",")) {
      if (part.layer_count == RunTimePart::most_layers) return false;
      RunTimeLayer& layer = part.layers[part.layer_count++];
      layer.has_bias = !reader.take("pinnquad::DenseWithoutBias<");
      if (!layer.has_bias || reader.take("pinnquad::Dense<")) {
        layer.outputs = reader.number(widest_layer);
        if (layer.outputs < 1 || !reader.take(">")) return false;
        parameters += static_cast<long long>(width) * layer.outputs + (layer.has_bias ? layer.outputs : 0);
        width = layer.outputs;
        part.widest = width > part.widest ? width : part.widest;
      } else if (!take_activation(reader, layer)) {
        return false;
      }
    }
    part.outputs = width;
    if (parameters > most_parameters || part.layer_count == 0 || !reader.take(">")) return false;
    part.parameter_count = static_cast<int>(parameters);
    return true;
  }

  static bool take_activation(detail::DescriptionReader& reader, RunTimeLayer& layer) noexcept {
    int place = 0;
    for (const auto& known : detail::run_time_activations<float>) {
      if (reader.take_name(known.description)) {
        layer.activation = place;
        return true;
      }
      ++place;
    }
    return false;
  }

  bool take_shown(detail::DescriptionReader& reader, RunTimePart& part) noexcept {
    if (!reader.take("pinnquad::Withheld<")) return take_network(reader, part);
    if (!take_network(reader, part) || !reader.take(",")) return false;
    const int shown = part.inputs;
    return take_threes(reader, part) && part.shown() == shown && reader.take(">");
  }

  bool take_part(detail::DescriptionReader& reader) noexcept {
    RunTimePart& part = parts_[part_count_];
    if (reader.take("pinnquad::AxisAligned<")) {
      part.axis_aligned = true;
      if (!take_scalar(reader) || !reader.take(",") || !take_threes(reader, part) || !reader.take(">")) return false;
      part.outputs = 4;
      part.parameter_count = 3 * part.three_count + 4 * part.shown() + 4;
    } else if (reader.take("pinnquad::Bounded<")) {
      part.bounded = true;
      if (!take_shown(reader, part) || !reader.take(">")) return false;
      part.parameter_count += 2 * part.outputs;
    } else if (!take_shown(reader, part)) {
      return false;
    }
    const RunTimePart& first = parts_[0];
    if (part.inputs != first.inputs || part.outputs != first.outputs) return false;
    parameter_count_ += part.parameter_count;
    ++part_count_;
    return parameter_count_ <= most_parameters;
  }

  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static void run(const RunTimePart& part, const Scalar* own, const Values<Number, Count>* x, Values<Number, Count>* y,
                  Values<Number, Count>* work, Values<Number, Count>* spare) noexcept {
    if (part.axis_aligned) return run_axis_aligned<Number, Count, Kind>(part, own, x, y);
    const Scalar* const bounds = own;
    if (part.bounded) own += 2 * part.outputs;
    int width = 0;
    part.each_shown([&](int feature) { work[width++] = x[feature]; });
    for (int i = 0; i < part.layer_count; ++i) {
      const RunTimeLayer& layer = part.layers[i];
      if (layer.outputs == 0) {
        activate<Number, Count, Kind>(detail::run_time_activations<Number>[layer.activation], work, width);
        continue;
      }
      const Scalar* const biases = own + width * layer.outputs;
      for (int row = 0; row < layer.outputs; ++row) {
        spare[row] = {};
        if (layer.has_bias) begin<Kind>(static_cast<Number>(biases[row]), spare[row]);
      }
      detail::add_lane_rows(own, layer.outputs, width, work, spare);
      own = biases + (layer.has_bias ? layer.outputs : 0);
      width = layer.outputs;
      Values<Number, Count>* const before = work;
      work = spare;
      spare = before;
    }
    for (int k = 0; k < part.outputs; ++k) y[k] = work[k];
    if (part.bounded) clip<Number, Count, Kind>(bounds, part.outputs, y);
  }

  /// As AxisAligned::forward(): the intercept, the other features, then each axis' own of every tap.
  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static void run_axis_aligned(const RunTimePart& part, const Scalar* slopes, const Values<Number, Count>* x,
                               Values<Number, Count>* y) noexcept {
    const int others = part.shown();
    const Scalar* const weights = slopes + 3 * part.three_count;
    for (int row = 0; row < 4; ++row) {
      Values<Number, Count> sum{};
      begin<Kind>(static_cast<Number>(weights[4 * others + row]), sum);
      const Scalar* weight = weights + row * others;
      part.each_shown([&](int feature) { add_product(*weight++, x[feature], sum); });
      for (int tap = 0; row > 0 && tap < part.three_count; ++tap) {
        add_product(slopes[3 * tap + row - 1], x[part.threes[tap] + row - 1], sum);
      }
      y[row] = sum;
    }
  }

  /// A sum with its bias alone, no derivatives.
  template <detail::RunTimeEntry Kind, class Number, std::size_t Count>
  static void begin(Number bias, std::array<Number, Count>& sum) noexcept {
    constexpr std::size_t values = Kind == detail::RunTimeEntry::lanes ? Count : 1;
    for (std::size_t c = 0; c < values; ++c) sum[c] = bias;
  }

  template <class Scalar, class Number, std::size_t Count>
  static void add_product(Scalar weight, const std::array<Number, Count>& x, std::array<Number, Count>& sum) noexcept {
    for (std::size_t c = 0; c < Count; ++c) sum[c] = multiply_add(static_cast<Number>(weight), x[c], sum[c]);
  }

  template <class Number, int Count, detail::RunTimeEntry Kind>
  static void activate(const detail::RunTimeActivation<Number>& activation, Values<Number, Count>* values,
                       int width) noexcept {
    if constexpr (Kind == detail::RunTimeEntry::lanes || Count == 1) {
      activation.activate_all(reinterpret_cast<Number*>(values), std::size_t(width) * std::size_t(Count));
    } else {
      for (int i = 0; i < width; ++i) {
        Values<Number, Count>& entry = values[i];
        const Number slope = activation.slope(entry[0]);
        for (std::size_t c = 1; c < std::size_t(Count); ++c) entry[c] *= slope;
        entry[0] = activation.activate(entry[0]);
      }
    }
  }

  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static void clip(const Scalar* bounds, int outputs, Values<Number, Count>* y) noexcept {
    for (int k = 0; k < outputs; ++k) {
      const Number least = static_cast<Number>(bounds[k]), most = static_cast<Number>(bounds[outputs + k]);
      constexpr std::size_t values = Kind == detail::RunTimeEntry::lanes ? std::size_t(Count) : 1;
      for (std::size_t c = 0; c < values; ++c) {
        const Number value = y[k][c];
        if (value > least && value < most) continue;
        if (Kind == detail::RunTimeEntry::value_and_derivatives) y[k] = {};
        y[k][c] = value < least ? least : (value > most ? most : value);
      }
    }
  }

  RunTimePart parts_[most_parts];
  int part_count_ = 0;
  int parameter_count_ = 0;
  bool is_double_ = false;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// A predictor that is known at run time alone, from its description (model/description.hpp), with sums in the order of
// the portable kernel: the same bits as the compiled one. No heap: the caller owns the workspace.
//   predictor := part | Sum<predictor, part>
//   part      := AxisAligned<scalar, features, place...> | Bounded<shown> | shown
//   shown     := Withheld<network, features, place...> | network
//   network   := Network<scalar, Inputs<n>, layer...>
//   layer     := Dense<n> | DenseWithoutBias<n> | LayerNorm<n> | RmsNorm<n> | Glu<n> | an activation
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pinnquad/exported/description_reader.hpp"
#include "pinnquad/exported/run_time_activation.hpp"
#include "pinnquad/nn/kernel/lane_row.hpp"
#include "pinnquad/nn/kernel/portable.hpp"
#include "pinnquad/nn/layer_norm.hpp"

namespace pinnquad {
namespace detail {
inline namespace PINNQUAD_INSTRUCTION_SET {

/// The numbers of an entry of RunTimeNetwork::forward().
enum class RunTimeEntry {
  value_and_derivatives,  ///< a value, and its derivatives by whatever the caller moves
  lanes,                  ///< a value each of so many motions
  turned                  ///< a value, of parameters as RunTimeRow lays them out
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace detail

inline namespace PINNQUAD_INSTRUCTION_SET {

/// A predictor, or the sum of a few, added from left to right.
class RunTimeNetwork {
 public:
  /// A layer of a description: dense where it has outputs, a norm where it has `normalised`, Glu where it has `gated`,
  /// else the activation of that place in Activations.
  struct Layer {
    int outputs = 0;
    bool has_bias = true;
    int normalised = 0;   ///< numbers of LayerNorm, or of RmsNorm
    bool centred = true;  ///< LayerNorm
    int gated = 0;        ///< numbers that a Glu gives
    int activation = -1;
  };

  /// A part of a predictor. Its parameters lie as the compiled part's: bounds, slopes, weights row by row, biases.
  struct Part {
    static constexpr int most_layers = 32;
    static constexpr int most_threes = 64;

    Layer layers[most_layers];
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
  const Part& part(int index) const noexcept { return parts_[index]; }
  bool is_double() const noexcept { return is_double_; }
  int inputs() const noexcept { return parts_[0].inputs; }
  int outputs() const noexcept { return parts_[0].outputs; }
  int parameter_count() const noexcept { return parameter_count_; }

  /// Entries of the workspace of forward().
  std::size_t workspace() const noexcept { return workspace<float, detail::RunTimeEntry::lanes>(); }
  template <class Number, detail::RunTimeEntry Kind>
  std::size_t workspace() const noexcept {
    int widest = outputs();
    for (int i = 0; i < part_count_; ++i) widest = parts_[i].widest > widest ? parts_[i].widest : widest;
    return std::size_t(3 * rows_of<Number, Kind>(widest));
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
    const std::size_t third = workspace<Number, Kind>() / 3;
    Values<Number, Count>* more = work + 2 * third;
    for (int i = 0; i < part_count_; ++i) {
      parameters = run<Number, Count, Kind>(parts_[i], parameters, x, i == 0 ? y : more, work, work + third);
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
  static bool take_threes(detail::DescriptionReader& reader, Part& part) noexcept {
    part.inputs = reader.number(widest_layer);
    int free_from = 0;
    while (reader.take(",")) {
      const int place = reader.number(widest_layer);
      if (place < free_from || part.three_count == Part::most_threes) return false;
      part.threes[part.three_count++] = place;
      free_from = place + 3;
    }
    return part.three_count > 0 && free_from <= part.inputs && part.shown() > 0;
  }

  bool take_network(detail::DescriptionReader& reader, Part& part) noexcept {
    if (!reader.take("pinnquad::Network<") || !take_scalar(reader) || !reader.take(",")) return false;
    if (!reader.take("pinnquad::Inputs<")) return false;
    int width = part.inputs = part.widest = reader.number(widest_layer);
    if (width < 1 || !reader.take(">")) return false;
    long long parameters = 0;
    while (reader.take(",")) {
      if (part.layer_count == Part::most_layers) return false;
      Layer& layer = part.layers[part.layer_count++];
      layer.centred = reader.take("pinnquad::LayerNorm<");
      if (layer.centred || reader.take("pinnquad::RmsNorm<")) {
        layer.normalised = reader.number(width);
        if (layer.normalised < 1 || !reader.take(">")) return false;
        parameters += 2 * layer.normalised;
        continue;
      }
      if (reader.take("pinnquad::Glu<")) {
        layer.gated = reader.number(width / 2);
        if (layer.gated < 1 || !reader.take(">")) return false;
        width -= layer.gated;
        continue;
      }
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

  static bool take_activation(detail::DescriptionReader& reader, Layer& layer) noexcept {
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

  bool take_shown(detail::DescriptionReader& reader, Part& part) noexcept {
    if (!reader.take("pinnquad::Withheld<")) return take_network(reader, part);
    if (!take_network(reader, part) || !reader.take(",")) return false;
    const int shown = part.inputs;
    return take_threes(reader, part) && part.shown() == shown && reader.take(">");
  }

  bool take_part(detail::DescriptionReader& reader) noexcept {
    Part& part = parts_[part_count_];
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
    const Part& first = parts_[0];
    if (part.inputs != first.inputs || part.outputs != first.outputs) return false;
    parameter_count_ += part.parameter_count;
    ++part_count_;
    return parameter_count_ <= most_parameters;
  }

  /// Rows of a layer as they lie in the parameters: turned, they fill packs.
  template <class Number, detail::RunTimeEntry Kind>
  static constexpr int rows_of(int outputs) noexcept {
    return Kind == detail::RunTimeEntry::turned ? padded<pinnquad::NativePack<Number>>(outputs) : outputs;
  }

  /// The parameters behind those of the part.
  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static const Scalar* run(const Part& part, const Scalar* own, const Values<Number, Count>* x,
                           Values<Number, Count>* y, Values<Number, Count>* work,
                           Values<Number, Count>* spare) noexcept {
    if (part.axis_aligned) {
      run_axis_aligned<Number, Count, Kind>(part, own, x, y);
      return own + part.parameter_count;
    }
    const Scalar* const bounds = own;
    if (part.bounded) own += 2 * part.outputs;
    int width = 0;
    part.each_shown([&](int feature) { work[width++] = x[feature]; });
    for (int fill = width; fill < rows_of<Number, Kind>(width); ++fill) work[fill] = {};
    for (int i = 0; i < part.layer_count; ++i) {
      const Layer& layer = part.layers[i];
      if (layer.normalised > 0) {
        normalise<Number, Count, Kind>(layer, own, work);
        own += 2 * layer.normalised;
        continue;
      }
      if (layer.gated > 0) {
        gate<Number, Count, Kind>(layer.gated, work, width);
        width -= layer.gated;
        continue;
      }
      if (layer.outputs == 0) {
        activate<Number, Count, Kind>(detail::run_time_activations<Number>[layer.activation], work,
                                      rows_of<Number, Kind>(width));
        continue;
      }
      const int rows = rows_of<Number, Kind>(layer.outputs);
      const Scalar* const biases = own + width * rows;
      if constexpr (Kind == detail::RunTimeEntry::turned) {
        detail::sum_turned_rows(own, rows, rows, width, biases, work->data(), spare->data());
        own = biases + rows;
      } else {
        for (int row = 0; row < rows; ++row) {
          spare[row] = {};
          if (layer.has_bias) begin<Kind>(static_cast<Number>(biases[row]), spare[row]);
        }
        detail::add_lane_rows(own, rows, width, work, spare);
        own = biases + (layer.has_bias ? rows : 0);
      }
      width = layer.outputs;
      Values<Number, Count>* const before = work;
      work = spare;
      spare = before;
    }
    for (int k = 0; k < part.outputs; ++k) y[k] = work[k];
    if (part.bounded) clip<Number, Count, Kind>(bounds, part.outputs, y);
    return own;
  }

  /// As AxisAligned::forward(): the intercept, the other features, then each axis' own of every tap.
  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static void run_axis_aligned(const Part& part, const Scalar* slopes, const Values<Number, Count>* x,
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

  /// In place, as NormLayer.
  template <class Number, int Count, detail::RunTimeEntry Kind, class Scalar>
  static void normalise(const Layer& layer, const Scalar* own, Values<Number, Count>* values) noexcept {
    constexpr int rows = Kind == detail::RunTimeEntry::lanes ? Count : 1;
    const int count = layer.normalised;
    Number* const numbers = values->data();
    for (int lane = 0; lane < rows; ++lane) {
      const auto of_lane = detail::normalised<Number>(numbers + lane, count, Count, layer.centred);
      for (int c = rows; c < Count; ++c) {
        of_lane.multiply_by_jacobian(numbers + c, layer.centred);
        for (int i = 0; i < count; ++i) numbers[i * Count + c] *= static_cast<Number>(own[i]);
      }
      for (int i = 0; i < count; ++i) {
        numbers[i * Count + lane] =
            multiply_add(static_cast<Number>(own[i]), of_lane[i], static_cast<Number>(own[count + i]));
      }
    }
  }

  /// In place, as Glu.
  template <class Number, int Count, detail::RunTimeEntry Kind>
  static void gate(int count, Values<Number, Count>* values, int width) noexcept {
    constexpr std::size_t rows = Kind == detail::RunTimeEntry::lanes ? std::size_t(Count) : 1;
    for (int i = 0; i < count; ++i) {
      for (std::size_t lane = 0; lane < rows; ++lane) {
        Number& x = values[i][lane];
        const Number open = detail::logistic(values[count + i][lane]);
        for (std::size_t c = rows; c < std::size_t(Count); ++c) {
          values[i][c] = open * values[i][c] + x * open * (Number(1) - open) * values[count + i][c];
        }
        x = x * open;
      }
    }
    for (int i = 2 * count; i < width; ++i) values[i - count] = values[i];
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

  Part parts_[most_parts];
  int part_count_ = 0;
  int parameter_count_ = 0;
  bool is_double_ = false;
};

}  // namespace PINNQUAD_INSTRUCTION_SET
}  // namespace pinnquad

// SPDX-License-Identifier: MIT
// Two hashes that header and block state of a model. shape_hash: what its numbers are for. contents_hash: all of a
// header that counts. The writer makes them (deploy/header_writer.hpp); the compiler makes them again, and refuses a
// header that was edited afterwards; a block has a hash of its own beside them. They find accidents, not forgeries.
//   contents_hash = sum over the facts of FNV-1a(name, value), in words of 32 bits: no order plays a part
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/exported/model_facts.hpp"
#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/nn/scaler.hpp"
#include "pinnquad/outputs/output_schema.hpp"

namespace pinnquad {

/// The format of blocks: this library writes it and reads no other one.
inline constexpr int model_format_version = 5;

namespace detail {

/// Words that contents_hash begins with: its own format, and the records that a reader must understand.
inline constexpr int contents_format = 4;
inline constexpr std::array<std::string_view, 7> known_records = {"answer",  "commands",   "clock", "window",
                                                                  "columns", "allocation", "base"};

#if defined(__clang__) || __GNUC__ >= 11
inline constexpr bool reads_bits_of_constants = true;
#else
inline constexpr bool reads_bits_of_constants = false;  ///< then nothing is compared while compiling
#endif

/// The hash of one constant.
class ConstantHash {
 public:
  constexpr explicit ConstantHash(std::string_view name) noexcept { add(name); }

  constexpr std::uint64_t value() const noexcept { return hash_; }

  constexpr void add_letters(std::string_view text) noexcept {
    for (const char letter : text) add_word(static_cast<unsigned char>(letter));
  }
  constexpr void add(std::string_view text) noexcept {
    add_letters(text);
    add_word(0x100);  // no letter: "ab", "c" is not "a", "bc"
  }
  constexpr void add(const char* text) noexcept { add(std::string_view(text)); }
  constexpr void add(bool truth) noexcept { add_word(truth ? 1u : 0u); }
  constexpr void add(int number) noexcept { add_word(static_cast<std::uint32_t>(number)); }
  constexpr void add(CommandMeaning meaning) noexcept { add(std::string_view(to_string(meaning))); }
  constexpr void add(std::uint64_t number) noexcept {
    add_word(static_cast<std::uint32_t>(number));
    add_word(static_cast<std::uint32_t>(number >> 32));
  }
#if defined(__clang__) || __GNUC__ >= 11
  constexpr void add(float number) noexcept { add_word(__builtin_bit_cast(std::uint32_t, number)); }
  constexpr void add(double number) noexcept { add(__builtin_bit_cast(std::uint64_t, number)); }
#else
  constexpr void add(float) noexcept {}
  constexpr void add(double) noexcept {}
#endif
  template <class Value, std::size_t Size>
  constexpr void add(const std::array<Value, Size>& values) noexcept {
    if constexpr (std::is_same_v<Value, float> && reads_bits_of_constants) {
      // most of a header: in place, since a compiler counts the steps of a constant
      const float* from = values.data();
      std::uint64_t hash = hash_;
      for (std::size_t i = 0; i < Size; ++i) hash = (hash ^ __builtin_bit_cast(std::uint32_t, from[i])) * prime;
      hash_ = hash;
    } else {
      for (std::size_t i = 0; i < Size; ++i) add(values[i]);
    }
  }
  template <class Scalar, int Size>
  constexpr void add(const Scaler<Scalar, Size>& scaler) noexcept {
    add(scaler.mean);
    add(scaler.standard_deviation);
  }
  constexpr void add(const Airframe<double>& airframe) noexcept {
    each_number(airframe, [this](const auto& number) {
      if constexpr (std::is_same_v<std::decay_t<decltype(number)>, Spin>) {
        add(static_cast<int>(number));
      } else {
        add(number);
      }
    });
  }

  static constexpr std::uint64_t prime = 0x100000001b3u;

 private:
  constexpr void add_word(std::uint32_t word) noexcept { hash_ = (hash_ ^ word) * prime; }

  std::uint64_t hash_ = Fnv1a{}.hash;
};

template <class Value>
constexpr std::uint64_t constant_hash(std::string_view name, const Value& value) noexcept {
  ConstantHash hash(name);
  hash.add(value);
  return hash.value();
}

/// The letters of a description, spaces among them.
struct DescribedHash {
  ConstantHash hash;

  constexpr void add(std::string_view text) noexcept { hash.add_letters(text); }
  constexpr void add(int number) noexcept {
    if (number >= 10) add(number / 10);
    const char digit = static_cast<char>('0' + number % 10);
    hash.add_letters({&digit, 1});
  }
};
template <class T>
constexpr std::uint64_t description_hash(std::string_view name) noexcept {
  DescribedHash sink{ConstantHash(name)};
  describe<T>(sink);
  sink.hash.add(std::string_view());
  return sink.hash.value();
}
template <class Texts>
constexpr std::uint64_t texts_hash(std::string_view name, const Texts& texts) noexcept {
  ConstantHash hash(name);
  for (const auto& text : texts) hash.add(std::string_view(text));
  return hash.value();
}

/// The value that a header's contents_hash must have: of its constants, and of what its types say.
template <class M>
constexpr std::uint64_t contents_hash_of() noexcept {
  using Features = typename M::Features;
  using Map = OutputMap<typename M::Outputs>;
  using Window = WindowOf<Features>;
  std::uint64_t sum = 0;
  const auto add = [&sum](std::string_view name, const auto& value) { sum += constant_hash(name, value); };
  add("format_version", contents_format);
  add("training_data_hash", M::training_data_hash);
  add("training_rows", M::training_rows);
  if constexpr (is_detected<StatedVerdictOf, M>) {
    add("worse_than_mean", M::worse_than_mean);
    add("beats_linear_regression", M::beats_linear_regression);
  }
  add("frame", model_frame);
  sum += texts_hash("feature_names", Features::names) + texts_hash("feature_units", Features::units);
  sum += texts_hash("output_names", Map::names) + texts_hash("output_units", Map::units);
  add("vehicle_name", M::Vehicle::name);
  add("motor_torque_signs", motor_torque_signs<typename M::Vehicle>());
  add("Vehicle", airframe_value<typename M::Vehicle, double>());
  add("records", known_records);
  sum += description_hash<typename M::Network>("answer");
  add("command_meaning", M::command_meaning);
  add("command_lower", M::command_lower);
  add("command_upper", M::command_upper);
  add("sample_period_s", M::sample_period_s);
  add("lag_removed_s", M::lag_removed_s);
  add("window_taps", Window::taps);
  add("causal", Window::causal);
  sum += texts_hash("column_names", extra_column_names<Features>);
  sum += texts_hash("column_units", extra_column_units<Features>);
  add("allocation", M::allocation);
  sum += description_hash<typename BaseOf<typename M::Outputs>::type>("base");
  add("input", M::input);
  add("output", M::output);
  add("envelope_lower", M::envelope_lower);
  add("envelope_upper", M::envelope_upper);
  add("golden_features", M::golden_features);
  add("golden_commands", M::golden_commands);
  add("parameters", M::parameters);
  return sum;
}

/// True where the compiler can't read the bits of a constant.
template <class M>
constexpr bool same_contents() noexcept {
  if constexpr (reads_bits_of_constants) {
    return M::contents_hash == contents_hash_of<M>();
  } else {
    return true;
  }
}

/// All that a shape says behind its answer. `feature(i)` and `output(k)` have a `name` and a `unit`.
template <class Feature, class Output>
constexpr void absorb_shape(Fnv1a& fnv, std::size_t features, const Feature& feature, std::size_t outputs,
                            const Output& output, std::string_view vehicle_name, const TorqueSigns& signs) noexcept {
  fnv.absorb_text(model_frame);
  for (std::size_t i = 0; i < features; ++i) fnv.absorb_text(feature(i).name);
  for (std::size_t i = 0; i < features; ++i) fnv.absorb_text(feature(i).unit);
  bool one_unit = outputs > 0;
  for (std::size_t k = 0; k < outputs; ++k) {
    fnv.absorb_text(output(k).name);
    one_unit = one_unit && output(k).unit == output(0).unit;
  }
  // one unit for all is said once
  for (std::size_t k = 0; k < (one_unit ? 1 : outputs); ++k) fnv.absorb_text(output(k).unit);
  fnv.absorb_text(vehicle_name);
  for (const auto& rotor : signs) {
    for (const int sign : rotor) fnv.absorb(static_cast<unsigned char>(sign + 1));
  }
}

/// `vehicle_name` and `signs`: of the vehicle, which need not be known to the compiler.
template <class Shape>
constexpr std::uint64_t hash_of_shape(std::string_view vehicle_name, const TorqueSigns& signs) noexcept {
  using Map = OutputMap<typename Shape::Outputs>;
  Fnv1a fnv;
  absorb_description<typename Shape::Network>(fnv);
  absorb_shape(
      fnv, Shape::Features::names.size(),
      [](std::size_t i) {
        return NameAndUnit{Shape::Features::names[i], Shape::Features::units[i]};
      },
      Map::names.size(),
      [](std::size_t k) {
        return NameAndUnit{Map::names[k], Map::units[k]};
      },
      vehicle_name, signs);
  return fnv.hash;
}
}  // namespace detail

/// Names what a block's weights are for: the answer's description (model/description.hpp), frame, feature names and
/// units, output names and units, vehicle name and motor order.
template <class Shape>
inline constexpr std::uint64_t shape_hash = detail::hash_of_shape<Shape>(Shape::Vehicle::name,
                                                                         motor_torque_signs<typename Shape::Vehicle>());

}  // namespace pinnquad

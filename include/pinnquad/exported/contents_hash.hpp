// SPDX-License-Identifier: MIT
// A number over all that an exported header says: one that was edited afterwards does not compile. The writer makes it
// (deploy/header_writer.hpp), the compiler and the program compare. It finds accidents, not forgeries.
//   contents_hash = sum over the constants of FNV-1a(name, value), in words of 32 bits: no order plays a part
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <type_traits>

#include "pinnquad/core/fnv1a.hpp"
#include "pinnquad/dynamics/airframe_value.hpp"
#include "pinnquad/exported/model_records.hpp"
#include "pinnquad/nn/scaler.hpp"

namespace pinnquad {

/// The constants that count, where a header has them; `Vehicle` is its airframe's value. The model's name, and where it
/// comes from in words, may be edited. contents_hash_of() lists their values in this order.
inline constexpr std::string_view hashed_constants[] = {
    // clang-format off
    "format_version", "training_data_hash", "training_rows", "worse_than_mean", "beats_linear_regression", "frame",
    "feature_names", "feature_units", "output_names", "output_units", "vehicle_name",
    "motor_torque_signs", "Vehicle", "records", "answer", "command_meaning", "command_lower", "command_upper",
    "sample_period_s", "lag_removed_s", "window_taps", "causal", "column_names", "column_units", "allocation", "base",
    "slope_signs", "residual_lower", "residual_upper", "distance_mean", "distance_inverse_cholesky", "distance_limit",
    "input", "output", "envelope_lower", "envelope_upper", "golden_features", "golden_commands", "parameters"};
// clang-format on

namespace detail {

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

  constexpr void add(std::string_view text) noexcept {
    for (const char letter : text) add_word(static_cast<unsigned char>(letter));
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

/// The place of a name among hashed_constants, their number where it is none of them.
constexpr std::size_t hashed_place(std::string_view name) noexcept {
  std::size_t place = 0;
  while (place < std::size(hashed_constants) && hashed_constants[place] != name) ++place;
  return place;
}
constexpr bool is_hashed(std::string_view name) noexcept { return hashed_place(name) < std::size(hashed_constants); }

/// The value that the header's constant must have, from its members as they are.
template <class M>
constexpr std::uint64_t contents_hash_of() noexcept {
  std::uint64_t sum = 0;
  const auto add = [&sum](std::string_view first, const auto&... values) {  // and those that follow it
    std::size_t place = hashed_place(first);
    ((sum += constant_hash(hashed_constants[place++], values)), ...);
  };
  add("format_version", M::format_version, M::training_data_hash, M::training_rows);
  if constexpr (is_detected<StatedVerdictOf, M>) add("worse_than_mean", M::worse_than_mean, M::beats_linear_regression);
  add("frame", M::frame, M::feature_names, M::feature_units, M::output_names, M::output_units, M::vehicle_name,
      M::motor_torque_signs, airframe_value<typename M::Vehicle, double>(), M::records, M::answer, M::command_meaning,
      M::command_lower, M::command_upper, M::sample_period_s, M::lag_removed_s, M::window_taps, M::causal,
      M::column_names, M::column_units, M::allocation, M::base);
  if constexpr (is_detected<SlopeSignsOf, M>) add("slope_signs", M::slope_signs);
  if constexpr (is_detected<ResidualRangeOf, M>) add("residual_lower", M::residual_lower, M::residual_upper);
  if constexpr (is_detected<DistanceStatisticsOf, M>) {
    add("distance_mean", M::distance_mean, M::distance_inverse_cholesky, M::distance_limit);
  }
  add("input", M::input, M::output, M::envelope_lower, M::envelope_upper, M::golden_features, M::golden_commands,
      M::parameters);
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

}  // namespace detail
}  // namespace pinnquad
